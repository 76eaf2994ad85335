// SPDX-License-Identifier: BSD-3-Clause
#include "io/photo.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/image_bytes.h"
#include "libps/geometry/camera.h"
#include "tests/io/support.h"

namespace ps {
namespace {

Image noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image image(height, width);
  for (cv::Vec3f& pixel : image) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(random() % 256) / 255;
  }
  return image;
}

std::string encoded(const char* extension, const cv::Mat& image, const std::vector<int>& how = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, how);
  return {bytes.begin(), bytes.end()};
}

template <class T>
std::string big(T value) {
  return raw(value, true);
}

/// A tag of an EXIF directory, big endian: SHORT (3), or RATIONAL (5) whose value lies at `value`.
std::string tag(int id, int type, std::uint32_t value) {
  return big<std::uint16_t>(id) + big<std::uint16_t>(type) + big<std::uint32_t>(1) +
         (type == 3 ? big<std::uint16_t>(value) + std::string(2, '\0') : big<std::uint32_t>(value));
}

/// A TIFF block: IFD0 with orientation and a pointer to the EXIF IFD, which has `tags`.
std::string exif_block(int orientation, const std::vector<std::string>& tags,
                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& rationals) {
  std::string block = "MM" + big<std::uint16_t>(42) + big<std::uint32_t>(8);
  block += big<std::uint16_t>(2) + tag(0x0112, 3, orientation) + tag(0x8769, 4, 38) +
           big<std::uint32_t>(0);
  block += big<std::uint16_t>(tags.size());
  for (const std::string& text : tags) block += text;
  block += big<std::uint32_t>(0);
  for (const auto& [above, below] : rationals) block += big(above) + big(below);
  return block;
}

std::string with_exif(const std::string& jpeg, const std::string& block) {
  const std::string segment = std::string("Exif\0\0", 6) + block;
  return jpeg.substr(0, 2) + "\xFF\xE1" + big<std::uint16_t>(segment.size() + 2) + segment +
         jpeg.substr(2);
}

/// Dark, but for a bright corner at the top left, twice as wide as high.
cv::Mat3b corner() {
  cv::Mat3b image(32, 48, cv::Vec3b(0, 0, 0));
  image(cv::Rect(0, 0, 16, 8)) = cv::Vec3b(255, 255, 255);
  return image;
}

TEST(Photo, png_reads_back_what_was_written) {
  const Folder folder;
  const Image image = noise(17, 9, 1);
  write_image(folder / "a.png", image);
  const Photo photo = read_photo(folder / "a.png");
  EXPECT_EQ(cv::norm(image, photo.color, cv::NORM_INF), 0);
  EXPECT_FALSE(photo.focal_px);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Photo, channels_are_red_green_blue) {
  const Folder folder;
  write_image(folder / "a.jpg", Image(16, 16, cv::Vec3f(1, 0, 0)));
  const cv::Vec3f pixel = read_photo(folder / "a.jpg").color(8, 8);
  EXPECT_NEAR(pixel[0], 1, 0.03);
  EXPECT_NEAR(pixel[2], 0, 0.03);
}

TEST(Photo, values_are_clamped_and_rounded) {
  const Folder folder;
  Image image(1, 4);
  image(0, 0) = {-1, 2, std::numeric_limits<float>::quiet_NaN()};
  image(0, 1) = {0.5f, 0.501f, std::numeric_limits<float>::infinity()};
  write_image(folder / "a.png", image);
  const Image back = read_photo(folder / "a.png").color;
  EXPECT_EQ(back(0, 0), cv::Vec3f(0, 1, 0));
  EXPECT_EQ(back(0, 1), cv::Vec3f(128 / 255.f, 128 / 255.f, 1));
}

TEST(Photo, grey_alpha_and_16_bits_become_rgb) {
  EXPECT_EQ(parse_photo(encoded(".png", cv::Mat1b(4, 4, 51)), "a").color(1, 1),
            cv::Vec3f(0.2f, 0.2f, 0.2f));
  EXPECT_EQ(parse_photo(encoded(".png", cv::Mat4b(4, 4, cv::Vec4b(0, 0, 255, 7))), "a").color(1, 1),
            cv::Vec3f(1, 0, 0));
  const cv::Vec3w wide(0, 13107, 65535);
  for (const char* extension : {".png", ".tiff"}) {
    EXPECT_EQ(parse_photo(encoded(extension, cv::Mat_<cv::Vec3w>(4, 4, wide)), "a").color(1, 1),
              cv::Vec3f(1, 13107 / 65535.f, 0));
  }
}

TEST(Photo, exif_orientation_is_applied_once) {
  // Where the top left corner of the stored image is in the upright one (CIPA DC-008, Orientation).
  const std::pair<bool, bool> right_bottom[] = {{false, false}, {true, false},  {true, true},
                                                {false, true},  {false, false}, {true, false},
                                                {true, true},   {false, true}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const std::string jpeg = with_exif(encoded(".jpg", corner()), exif_block(orientation, {}, {}));
    const Image image = parse_photo(jpeg, "a.jpg").color;
    const bool turned = orientation >= 5;
    ASSERT_EQ(image.size(), turned ? cv::Size(32, 48) : cv::Size(48, 32)) << orientation;
    const auto [right, bottom] = right_bottom[orientation - 1];
    const int x = right ? image.cols - 3 : 2, y = bottom ? image.rows - 3 : 2;
    EXPECT_GT(image(y, x)[0], 0.9) << orientation;
    EXPECT_LT(image(image.rows - 1 - y, image.cols - 1 - x)[0], 0.1) << orientation;
    // The bright corner is longer along the stored rows.
    const int along = right ? image.cols - 13 : 12, down = bottom ? image.rows - 13 : 12;
    EXPECT_EQ(image(y, along)[0] > 0.5, !turned) << orientation;
    EXPECT_EQ(image(down, x)[0] > 0.5, turned) << orientation;
  }
}

TEST(Photo, of_more_pixels_than_wanted_is_averaged_and_keeps_its_lens) {
  const cv::Mat3b stripes = [] {
    cv::Mat3b image(64, 98, cv::Vec3b(0, 0, 0));
    for (int x = 0; x < image.cols; x += 2) image.col(x) = cv::Vec3b(200, 100, 50);
    return image;
  }();
  const std::string png = encoded(".png", stripes);
  const Photo whole = parse_photo(png, "a");
  EXPECT_EQ(whole.size, stripes.size());
  const Photo half = parse_photo(png, "a", {49, 1});
  EXPECT_EQ(half.size, stripes.size());
  ASSERT_EQ(half.color.size(), cv::Size(49, 32));
  EXPECT_NEAR(half.color(10, 10)[0], 25 / 255.f, 1e-6);
  EXPECT_NEAR(half.color(10, 10)[2], 100 / 255.f, 1e-6);
  for (const WantedPixels wanted : {WantedPixels{50, 1}, {49, 33}, {0, 1}, {200, 100}}) {
    EXPECT_EQ(cv::norm(parse_photo(png, "a", wanted).color, whole.color, cv::NORM_INF), 0);
  }
  const std::string block = exif_block(6, {tag(0xA405, 3, 28)}, {});
  const Photo turned = parse_photo(with_exif(encoded(".jpg", stripes), block), "a.jpg", {30, 1});
  EXPECT_EQ(turned.size, cv::Size(64, 98));
  EXPECT_EQ(turned.color.size(), cv::Size(21, 32));
  EXPECT_NEAR(*turned.focal_px, intrinsics_from_focal_35mm(98, 64, 28).fx, 1e-9);
}

TEST(Photo, tiff_orientation_is_applied_once) {  // by OpenCV itself
  for (const int orientation : {1, 3, 6, 8}) {
    const std::string pixels =
        "\xFF\xFF\xFF" + std::string(15, '\0');  // 3x2, bright at the top left
    std::string tiff = std::string("MM\0*", 4) + big<std::uint32_t>(8 + pixels.size()) + pixels;
    const std::pair<int, int> tags[] = {{256, 3}, {257, 2}, {258, 8},           {259, 1},
                                        {262, 2}, {273, 8}, {274, orientation}, {277, 3},
                                        {278, 2}, {279, 18}};
    tiff += big<std::uint16_t>(std::size(tags));
    for (const auto& [id, value] : tags) tiff += tag(id, 3, value);
    const Image image = parse_photo(tiff + big<std::uint32_t>(0), "a.tiff").color;
    ASSERT_EQ(image.size(), orientation > 4 ? cv::Size(2, 3) : cv::Size(3, 2)) << orientation;
    const bool right = orientation == 3 || orientation == 6,
               bottom = orientation == 3 || orientation == 8;
    EXPECT_EQ(image(bottom ? image.rows - 1 : 0, right ? image.cols - 1 : 0)[0], 1) << orientation;
  }
}

TEST(Photo, unsound_orientations_are_upright) {
  for (const int orientation : {0, 9, 65535}) {
    const std::string jpeg = with_exif(encoded(".jpg", corner()), exif_block(orientation, {}, {}));
    EXPECT_EQ(parse_photo(jpeg, "a.jpg").color.size(), cv::Size(48, 32));
  }
}

TEST(Photo, focal_length_from_35mm_equivalent_goes_by_the_diagonal) {
  const std::string block = exif_block(6, {tag(0xA405, 3, 28)}, {});
  const Photo photo = parse_photo(with_exif(encoded(".jpg", corner()), block), "a.jpg");
  ASSERT_TRUE(photo.focal_px);
  EXPECT_NEAR(*photo.focal_px, intrinsics_from_focal_35mm(48, 32, 28).fx, 1e-9);
}

TEST(Photo, focal_length_from_the_focal_plane_follows_a_resized_photo) {
  // 5 mm, 2000 pixels per centimetre, on a frame 96 pixels wide: the photo has half of them.
  const std::uint32_t values = 38 + 2 + 4 * 12 + 4;
  const std::string block = exif_block(
      1,
      {tag(0x920A, 5, values), tag(0xA002, 3, 96), tag(0xA20E, 5, values + 8), tag(0xA210, 3, 3)},
      {{50, 10}, {2000, 1}});
  const Photo photo = parse_photo(with_exif(encoded(".jpg", corner()), block), "a.jpg");
  ASSERT_TRUE(photo.focal_px);
  EXPECT_NEAR(*photo.focal_px, 5 * 200 / 2.0, 1e-9);
}

TEST(Photo, transparent_pixels_are_told_and_keep_their_colours) {
  const cv::Mat3b plain = corner();
  cv::Mat alpha(plain.size(), CV_8UC1, cv::Scalar(255)), four;
  const auto with = [&](const char* extension, const std::vector<int>& how) {
    cv::merge(std::vector<cv::Mat>{plain, alpha}, four);
    return parse_photo(encoded(extension, four, how), extension);
  };
  for (const auto& [extension, how] :
       {std::make_pair(".png", std::vector<int>{}), {".webp", {cv::IMWRITE_WEBP_QUALITY, 101}}}) {
    alpha.setTo(255);
    const Photo opaque = with(extension, how);
    EXPECT_EQ(opaque.transparent, 0);
    alpha.row(0).setTo(128);
    const Photo photo = with(extension, how);
    EXPECT_DOUBLE_EQ(photo.transparent, 1. / plain.rows) << extension;
    EXPECT_EQ(cv::norm(photo.color, opaque.color, cv::NORM_INF), 0) << extension;
    EXPECT_EQ(cv::norm(photo.color, parse_photo(encoded(".png", plain), "a").color, cv::NORM_INF),
              0)
        << extension;
  }
  EXPECT_EQ(parse_photo(encoded(".png", plain), "a").transparent, 0);
  // Lossy WebP, and 16 bits a channel.
  EXPECT_GT(with(".webp", {cv::IMWRITE_WEBP_QUALITY, 80}).transparent, 0);
  cv::Mat deep;
  four.convertTo(deep, CV_16U, 257);
  const Photo sixteen = parse_photo(encoded(".png", deep), "a.png");
  EXPECT_DOUBLE_EQ(sixteen.transparent, 1. / plain.rows);
  EXPECT_EQ(cv::norm(sixteen.color, parse_photo(encoded(".png", plain), "a").color, cv::NORM_INF),
            0);
}

TEST(Photo, focal_lengths_that_cannot_be_are_left_out) {
  const std::uint32_t values = 38 + 2 + 2 * 12 + 4;
  const std::string zero =
      exif_block(1, {tag(0x920A, 5, values), tag(0xA20E, 5, values + 8)}, {{50, 0}, {0, 0}});
  EXPECT_FALSE(parse_photo(with_exif(encoded(".jpg", corner()), zero), "a.jpg").focal_px);
  const std::string huge = exif_block(1, {tag(0xA405, 3, 65535)}, {});
  EXPECT_FALSE(parse_photo(with_exif(encoded(".jpg", corner()), huge), "a.jpg").focal_px);
  const std::string cut = exif_block(1, {tag(0xA405, 3, 28)}, {}).substr(0, 45);
  EXPECT_FALSE(parse_photo(with_exif(encoded(".jpg", corner()), cut), "a.jpg").focal_px);
}

TEST(Photo, focal_lengths_that_are_no_help_are_told) {
  const auto doubt = [](const std::string& block) {
    return parse_photo(with_exif(encoded(".jpg", corner()), block), "a.jpg").focal_doubt;
  };
  const auto millimetres = [](std::uint32_t tenths) {
    return exif_block(1, {tag(0x920A, 5, 38 + 2 + 12 + 4)}, {{tenths, 10}});
  };
  EXPECT_EQ(doubt(exif_block(1, {}, {})), "");
  EXPECT_EQ(doubt(exif_block(1, {tag(0xA405, 3, 28)}, {})), "");
  EXPECT_EQ(doubt(exif_block(1, {tag(0xA405, 3, 9999)}, {})),
            "a focal length of 9999 mm for 35 mm film, which cannot be");
  EXPECT_EQ(doubt(millimetres(1)), "a focal length of 0.1 mm, which cannot be");
  EXPECT_EQ(doubt(millimetres(100000)), "a focal length of 10000 mm, which cannot be");
  EXPECT_EQ(doubt(millimetres(42)), "a focal length of 4.2 mm but not how large the sensor is");
}

TEST(Photo, every_truncation_is_an_error) {
  cv::Mat3b image(40, 56);
  cv::randu(image, 0, 256);
  cv::blur(image, image, {5, 5});
  const std::string photos[] = {encoded(".jpg", image),
                                encoded(".jpg", image, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}),
                                encoded(".jpg", image, {cv::IMWRITE_JPEG_RST_INTERVAL, 2}),
                                encoded(".png", image),
                                encoded(".webp", image),
                                encoded(".bmp", image)};
  for (const std::string& whole : photos) {
    EXPECT_EQ(parse_photo(whole, "a").color.size(), image.size());
    for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 37) {
      EXPECT_TRUE(has(error_of([&] { parse_photo(whole.substr(0, size), "a.jpg"); }), "a.jpg: "));
    }
    if (whole[0] != 'B') error_of([&] { parse_photo(whole.substr(0, whole.size() - 1), "a.jpg"); });
  }
}

TEST(Photo, sizes_that_so_few_bytes_cannot_hold_are_refused) {
  std::string png = encoded(".png", cv::Mat3b(8, 8, cv::Vec3b(1, 2, 3)));
  png.replace(16, 8, big<std::uint32_t>(15000) + big<std::uint32_t>(15000));
  EXPECT_TRUE(has(error_of([&] { parse_photo(png, "a.png"); }), "cannot hold 15000x15000"));
  png.replace(16, 8, big<std::uint32_t>(2147483647) + big<std::uint32_t>(2147483647));
  EXPECT_TRUE(has(error_of([&] { parse_photo(png, "a.png"); }), "2147483647x2147483647"));
  std::string jpeg = encoded(".jpg", cv::Mat3b(8, 8, cv::Vec3b(1, 2, 3)));
  const std::size_t frame = jpeg.find("\xFF\xC0");
  jpeg.replace(frame + 5, 4, "\x27\x10\x27\x10");
  EXPECT_TRUE(has(error_of([&] { parse_photo(jpeg, "a.jpg"); }), "cannot hold 10000x10000"));
  jpeg.replace(frame + 5, 4, "\xFF\xDC\xFF\xDC");
  EXPECT_TRUE(has(error_of([&] { parse_photo(jpeg, "a.jpg"); }), "at most 268 million"));
}

TEST(Photo, more_than_2_to_the_28_pixels_are_refused_by_the_header) {
  const auto refused = [](const std::string& bytes) {
    return has(error_of([&] { check_image_bytes(bytes, "a"); }), "the image is 20000x20000; exp");
  };
  const cv::Mat3b small(8, 8, cv::Vec3b(1, 2, 3));
  std::string bmp = encoded(".bmp", small);
  bmp.replace(18, 8, raw(std::int32_t{20000}) + raw(std::int32_t{-20000}));
  EXPECT_TRUE(refused(bmp));
  EXPECT_TRUE(refused("P6 # 1 2\n20000\n# 3\n20000 255\n"));
  for (const bool big_endian : {false, true}) {
    const auto entry = [&](std::uint16_t tag) {
      return raw(tag, big_endian) + raw(std::uint16_t{4}, big_endian) +
             raw(std::uint32_t{1}, big_endian) + raw(std::uint32_t{20000}, big_endian);
    };
    EXPECT_TRUE(refused((big_endian ? std::string("MM\0*", 4) : std::string("II*\0", 4)) +
                        raw(std::uint32_t{8}, big_endian) + raw(std::uint16_t{2}, big_endian) +
                        entry(256) + entry(257)));
  }
  EXPECT_TRUE(refused("\x76\x2f\x31\x01" + std::string("\2\0\0\0", 4) +
                      std::string("dataWindow\0box2i\0\x10\0\0\0", 21) + raw(-5) + raw(-5) +
                      raw(19994) + raw(19994)));
  EXPECT_TRUE(refused("RIFF" + raw(std::uint32_t{22}) + "WEBPVP8X" + raw(std::uint32_t{10}) +
                      raw(std::uint32_t{0}) + "\x1f\x4e" + std::string(1, '\0') + "\x1f\x4e" +
                      std::string(1, '\0')));
}

TEST(Photo, other_files_are_errors) {
  const Folder folder;
  EXPECT_TRUE(has(error_of([&] { read_photo(folder / "no.jpg"); }), "no.jpg"));
  put(folder / "a.jpg", "");
  EXPECT_TRUE(has(error_of([&] { read_photo(folder / "a.jpg"); }), "empty"));
  put(folder / "a.jpg", "this is text");
  EXPECT_TRUE(has(error_of([&] { read_photo(folder / "a.jpg"); }), "not an image"));
  EXPECT_TRUE(has(error_of([&] { read_photo(folder.path()); }), "folder"));
  std::string dicom(200, '\0');  // OpenCV hands these to GDCM, which aborts
  dicom.replace(128, 4, "DICM");
  EXPECT_TRUE(has(error_of([&] { parse_photo(dicom, "a"); }), "known kind"));
  EXPECT_TRUE(
      has(error_of([&] { parse_photo(encoded(".tiff", cv::Mat3f(4, 4)), "a"); }), "8 or 16 bits"));
}

TEST(Photo, unwritable_images_leave_no_file) {
  const Folder folder;
  EXPECT_TRUE(has(error_of([&] { write_image(folder / "a.gif", noise(4, 4, 1)); }), "'.gif'"));
  EXPECT_TRUE(has(error_of([&] { write_image(folder / "a.png", Image()); }), "no pixels"));
  EXPECT_TRUE(has(error_of([&] { write_image(folder / "a.jpg", Image(1, 70000)); }), "a.jpg"));
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace ps
