// SPDX-License-Identifier: BSD-3-Clause
#include "io/video.h"

#include <array>
#include <cstdio>
#include <opencv2/videoio.hpp>

#include "io/mp4.h"
#include "tests/io/support.h"

namespace ps {
namespace {

void write_video(const std::filesystem::path& path, cv::Size size, int frames) {
  VideoWriter video(path, size, 25);
  for (int i = 0; i < frames; ++i) {
    const float grey = static_cast<float>(i) / static_cast<float>(frames);
    video.add(Image(size, cv::Vec3f(grey, grey, grey)));
  }
  video.close();
}

/// @return what ffprobe says of the stream; empty where there is no ffprobe
std::string probe(const std::filesystem::path& path) {
  const std::string command =
      "ffprobe -v error -select_streams v -show_entries "
      "stream=codec_name,pix_fmt,width,height -of csv=p=0 '" +
      path.string() + "' 2>&1";
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 256> text{};
  if (!pipe || std::fgets(text.data(), text.size(), pipe.get()) == nullptr) return "";
  return text.data();
}

TEST(Video, is_h264_420_of_even_size_and_plays) {
  const Folder folder;
  write_video(folder / "v.mp4", {63, 33}, 30);
  EXPECT_EQ(folder.entries(), 1);
  if (std::system("command -v ffprobe > /dev/null") == 0) {
    EXPECT_EQ(probe(folder / "v.mp4"), "h264,64,34,yuv420p\n");
  }
  cv::VideoCapture player((folder / "v.mp4").string());
  cv::Mat3b frame;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(player.read(frame)) << i;
    EXPECT_NEAR(frame(16, 31)[1], 255.0 * i / 30, 6);
  }
  EXPECT_FALSE(player.read(frame));
}

TEST(Video, the_index_is_in_front_of_the_data) {
  const Folder folder;
  write_video(folder / "v.mp4", {64, 32}, 5);
  const std::string bytes = bytes_of(folder / "v.mp4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Video, cut_off_videos_are_noticed) {
  const Folder folder;
  write_video(folder / "v.mp4", {64, 32}, 5);
  const std::string whole = bytes_of(folder / "v.mp4");
  EXPECT_EQ(index_first(whole, "v"), whole);
  for (std::size_t size = 0; size < whole.size(); size += 11) {
    EXPECT_TRUE(has(error_of([&] { index_first(whole.substr(0, size), "v"); }), "not finished"));
  }
}

TEST(Video, offsets_are_moved_with_the_data) {
  const auto box = [](const std::string& kind, const std::string& content) {
    return raw<std::uint32_t>(content.size() + 8, true) + kind + content;
  };
  const auto number = [](std::uint32_t value) { return raw(value, true); };
  const auto moov = [&](std::uint32_t a, std::uint32_t b) {
    const std::string stco = box("stco", number(0) + number(2) + number(a) + number(b));
    return box("moov", box("trak", box("mdia", box("minf", box("stbl", stco)))));
  };
  const std::string front = box("ftyp", "isom"), data = box("mdat", "framesframes");
  const auto by = static_cast<std::uint32_t>(moov(0, 0).size());
  EXPECT_EQ(index_first(front + data + moov(20, 26), "v"), front + moov(20 + by, 26 + by) + data);
  const std::string far = front + data + moov(20, 0xfffffff0u);  // would not fit 32 bits
  EXPECT_EQ(index_first(far, "v"), far);
}

TEST(Video, what_is_not_closed_leaves_no_file) {
  const Folder folder;
  {
    VideoWriter video(folder / "v.mp4", {64, 32});
    video.add(Image(32, 64, cv::Vec3f(1, 0, 0)));
    EXPECT_TRUE(has(error_of([&] { video.add(Image(10, 10)); }), "another size"));
  }
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Video, what_cannot_be_written_is_refused) {
  const Folder folder;
  EXPECT_TRUE(has(error_of([&] { VideoWriter(folder / "v.avi", {64, 32}); }), ".mp4"));
  EXPECT_TRUE(has(error_of([&] { VideoWriter(folder / "v.mp4", {0, 32}); }), "0x32"));
  EXPECT_TRUE(has(error_of([&] {
                    VideoWriter(folder / "v.mp4", {64, 32}, 0);
                  }),
                  "frames a second"));
  EXPECT_TRUE(has(error_of([&] { VideoWriter(folder / "no/v.mp4", {64, 32}); }), "folder"));
  EXPECT_TRUE(has(error_of([&] { VideoWriter(folder / "v.mp4", {64, 32}).close(); }), "no frame"));
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace ps
