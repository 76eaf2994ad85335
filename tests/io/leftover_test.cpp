// SPDX-License-Identifier: BSD-3-Clause
#include "io/leftover.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "io/atomic_file.h"
#include "tests/io/support.h"

namespace ps {
namespace {

constexpr int kNobody = 4194305;  ///< no process has this number

std::string of_process(int process) { return ".ps-" + std::to_string(process) + "-7.txt"; }

TEST(Leftovers, are_of_the_process_that_their_name_says) {
  EXPECT_EQ(process_of("a.partial-12", "a.partial-"), 12);
  EXPECT_EQ(process_of(".ps-12-34.txt", ".ps-", "-"), 12);
  for (const char* name : {"a.partial-", "a.partial-x", "a.partial-012", "a.partial-12x",
                           "a.partial--12", "a.partial-0", "b.partial-12", "a.part"}) {
    EXPECT_EQ(process_of(name, "a.partial-"), std::nullopt) << name;
  }
  for (const char* name : {".ps-12.txt", ".ps-12", ".ps-x-1.txt", ".ps-012-1.txt"}) {
    EXPECT_EQ(process_of(name, ".ps-", "-"), std::nullopt) << name;
  }
}

TEST(Leftovers, of_processes_that_are_no_more_go_and_others_stay) {
  const Folder folder;
  const std::vector<std::string> others = {of_process(getppid()), of_process(kNobody + 1),
                                           ".ps-4194305.txt", ".ps-x-7.txt", "mine-4194305-7.txt"};
  for (const std::string& name : others) put(folder / name, "other");
  std::filesystem::create_directory(folder / ".ps-4194305-folder");
  put(folder / of_process(kNobody), "left");
  put(folder / of_process(getpid()), "left by an earlier process of our number");
  const int held = open((folder / of_process(kNobody + 1)).c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX | LOCK_NB), 0);
  AtomicFile file(folder / "a.txt");
  file.commit();
  EXPECT_FALSE(std::filesystem::exists(folder / of_process(kNobody)));
  EXPECT_FALSE(std::filesystem::exists(folder / of_process(getpid())));
  for (const std::string& name : others) EXPECT_EQ(bytes_of(folder / name), "other") << name;
  EXPECT_TRUE(std::filesystem::is_directory(folder / ".ps-4194305-folder"));
  close(held);
}

TEST(Leftovers, that_a_writer_of_this_process_waits_for_stay) {
  const Folder folder;
  AtomicFiles files;
  AtomicFile open(folder / "a.txt"), waiting(folder / "b.txt");
  waiting.commit();
  remove_leftovers(folder.path(), std::filesystem::file_type::regular,
                   [](const std::string& name) { return process_of(name, ".ps-", "-"); });
  open.commit();
  files.commit();
  EXPECT_TRUE(std::filesystem::exists(folder / "a.txt"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b.txt"));
}

}  // namespace
}  // namespace ps
