// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.h"

#include <sys/stat.h>

#include "io/text.h"
#include "tests/io/support.h"

namespace ps {
namespace {

void put_atomic(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

TEST(AtomicFile, appears_at_commit_and_not_before) {
  const Folder folder;
  AtomicFile file(folder / "a.txt");
  file.write("text");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  EXPECT_EQ(file.temporary().parent_path(), folder.path());
  EXPECT_EQ(file.temporary().extension(), ".txt");
  file.commit();
  EXPECT_EQ(bytes_of(folder / "a.txt"), "text");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, leaves_nothing_when_not_committed) {
  const Folder folder;
  { AtomicFile(folder / "a.txt").write("half"); }
  EXPECT_EQ(folder.entries(), 0);
  put(folder / "a.txt", "old");
  { AtomicFile(folder / "a.txt").write("half"); }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
}

TEST(AtomicFile, replaces_a_file_and_has_usual_permissions) {
  const Folder folder;
  put(folder / "a.txt", "old");
  AtomicFile file(folder / "a.txt");
  file.write("new");
  file.commit();
  EXPECT_EQ(bytes_of(folder / "a.txt"), "new");
  const mode_t mask = umask(0);
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST(AtomicFile, writes_through_a_link) {
  const Folder folder;
  put(folder / "real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  AtomicFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(bytes_of(folder / "real.txt"), "new");
}

TEST(AtomicFile, refuses_folders_devices_and_missing_folders) {
  const Folder folder;
  EXPECT_TRUE(has(error_of([&] { AtomicFile file(folder.path()); }), "folder"));
  EXPECT_TRUE(has(error_of([&] { AtomicFile file("/dev/null"); }), "device"));
  EXPECT_TRUE(has(error_of([&] { AtomicFile file(folder / "no/a.txt"); }), "existing folder"));
  EXPECT_TRUE(has(error_of([&] { AtomicFile file(""); }), "file name"));
  error_of([&] { AtomicFile file(folder / (std::string("a.") + std::string(300, 'x'))); });
  EXPECT_EQ(folder.entries(), 0);
}

TEST(AtomicFiles, appear_together_at_commit) {
  const Folder folder;
  put(folder / "b.txt", "old");
  put(folder / "stale.txt", "old");
  {
    AtomicFiles files;
    put_atomic(folder / "a.txt", "a");
    put_atomic(folder / "b.txt", "b");
    files.remove(folder / "stale.txt");
    files.remove(folder / "absent.txt");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    EXPECT_EQ(bytes_of(folder / "b.txt"), "old");
    files.commit();
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "a");
  EXPECT_EQ(bytes_of(folder / "b.txt"), "b");
  EXPECT_EQ(folder.entries(), 2);
  put_atomic(folder / "a.txt", "alone again");
  EXPECT_EQ(bytes_of(folder / "a.txt"), "alone again");
}

TEST(AtomicFiles, leave_nothing_when_not_committed) {
  const Folder folder;
  put(folder / "a.txt", "old");
  {
    AtomicFiles files;
    put_atomic(folder / "a.txt", "a");
    put_atomic(folder / "b.txt", "b");
    files.remove(folder / "a.txt");
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFiles, leave_what_was_there_when_one_cannot_be_put_in_place) {
  const Folder folder;
  put(folder / "a.txt", "old");
  put(folder / "stale.txt", "old");
  {
    AtomicFiles files;
    put_atomic(folder / "a.txt", "a");
    put_atomic(folder / "b.txt", "b");
    files.remove(folder / "stale.txt");
    put_atomic(folder / "c.txt", "c");
    std::filesystem::create_directory(folder / "c.txt");
    EXPECT_TRUE(has(error_of([&] { files.commit(); }), "c.txt: cannot be put in place"));
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
  EXPECT_EQ(bytes_of(folder / "stale.txt"), "old");
  EXPECT_EQ(folder.entries(), 3);
}

TEST(AtomicFiles, made_inside_others_join_them) {
  const Folder folder;
  put(folder / "b.txt", "old");
  put(folder / "stale.txt", "old");
  {
    AtomicFiles outer;
    put_atomic(folder / "a.txt", "a");
    bool called = false;
    {
      AtomicFiles inner;
      put_atomic(folder / "b.txt", "b");
      inner.remove(folder / "stale.txt");
      inner.commit([&] { called = true; });
    }
    EXPECT_FALSE(called);
    EXPECT_EQ(bytes_of(folder / "b.txt"), "old");
    { AtomicFiles().remove(folder / "a.txt"); }  // not committed: forgotten
    put_atomic(folder / "c.txt", "c");
    outer.commit();
    EXPECT_TRUE(called);
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "a");
  EXPECT_EQ(bytes_of(folder / "b.txt"), "b");
  EXPECT_EQ(bytes_of(folder / "c.txt"), "c");
  EXPECT_EQ(folder.entries(), 3);
}

TEST(AtomicFiles, that_joined_others_go_with_them) {
  const Folder folder;
  put(folder / "a.txt", "old");
  {
    AtomicFiles outer;
    AtomicFiles inner;
    put_atomic(folder / "a.txt", "a");
    put_atomic(folder / "b.txt", "b");
    inner.commit();
    EXPECT_EQ(folder.entries(), 3);
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFiles, are_taken_back_when_what_comes_last_throws) {
  const Folder folder;
  put(folder / "a.txt", "old");
  {
    AtomicFiles files;
    put_atomic(folder / "a.txt", "a");
    put_atomic(folder / "b.txt", "b");
    const auto last = [&] {
      EXPECT_EQ(bytes_of(folder / "a.txt"), "a");
      throw Error("last", "failed");
    };
    EXPECT_EQ(error_of([&] { files.commit(last); }), "last: failed");
  }
  EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, says_why_there_is_no_room) {
  const Folder folder;
  AtomicFile file(folder / "a.txt");
  file.write("text");
  file.check_room(100);
  const auto message = error_of([&] { file.check_room(std::size_t{1} << 62); });
  EXPECT_TRUE(has(message, "a.txt: writing failed: File too large")) << message;
}

TEST(LineReader, counts_lines_of_either_ending_and_skips_the_byte_order_mark) {
  LineReader lines("\xEF\xBB\xBF one\r\n\n# two\n three", "f");
  std::string_view line;
  ASSERT_TRUE(lines.next_content(line));
  EXPECT_EQ(line, " one");
  ASSERT_TRUE(lines.next_content(line));
  EXPECT_EQ(line, " three");
  EXPECT_EQ(lines.where(), "f:4");
  EXPECT_FALSE(lines.next(line));
}

TEST(Numbers, are_whole_tokens_that_read_back_the_same) {
  EXPECT_EQ(to_number<double>("+1.5e2"), 150.0);
  EXPECT_FALSE(to_number<double>("1.5x"));
  EXPECT_FALSE(to_number<double>(""));
  EXPECT_FALSE(to_number<int>("1.5"));
  EXPECT_FALSE(to_number<int>("99999999999"));
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::ldexp(static_cast<double>(random()), static_cast<int>(i % 200) - 100);
    std::string text;
    append_number(text, value);
    EXPECT_EQ(to_number<double>(text), value);
  }
}

}  // namespace
}  // namespace ps
