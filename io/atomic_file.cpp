// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <random>
#include <set>
#include <system_error>

#include "io/leftover.h"
#include "libps/core/error.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

/// Throws unless `path` is free or a regular file; follows a link, so that the link stays one.
fs::path checked_place(const fs::path& path) {
  std::error_code error;
  if (path.filename().empty()) throw Error(path.string(), "names no file", "a file name");
  const fs::path place = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const fs::file_status status = fs::status(place, error);
  if (fs::is_directory(status)) throw Error(path.string(), "is a folder", "a file name");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(path.string(), "is a pipe or a device", "a file name");
  }
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    throw Error(path.string(), "its folder does not exist", "an existing folder");
  }
  return place;
}

[[noreturn]] void fail(const fs::path& path, const char* doing, int code) {
  throw WriteError(path.string(), doing + std::generic_category().message(code));
}

constexpr char kBegin[] = ".ps-";

/// The numbers, of this process and by chance, come first, as a long name must keep its extension.
fs::path name_beside(const fs::path& path) {
  std::random_device random;
  return path.parent_path() / (kBegin + std::to_string(getpid()) + "-" + std::to_string(random()) +
                               path.extension().string());
}

void remove_leftovers_once(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  const std::lock_guard<std::mutex> lock(mutex);
  std::error_code ignored;
  const fs::path known = fs::canonical(folder, ignored);
  if (!seen.insert(known).second) return;
  const auto name = [](const std::string& text) { return process_of(text, kBegin, "-"); };
  remove_leftovers(known, fs::file_type::regular, name);
}

/// Those that the files of this thread wait in.
thread_local AtomicFiles* together = nullptr;

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(checked_place(path)) {
  remove_leftovers_once(path_.has_parent_path() ? path_.parent_path() : fs::path("."));
  // open() and not mkstemp(): the file gets the permissions that the user's umask asks for.
  for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
    temporary_ = name_beside(path_);
    descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) fail(path_, "cannot be written: ", errno);
  flock(descriptor_, LOCK_EX | LOCK_NB);  // tells others that it is in use
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "writing failed: ", errno);
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::check_room(std::size_t bytes) const {
  const off_t end = lseek(descriptor_, 0, SEEK_END);
  const int code = posix_fallocate(descriptor_, end, static_cast<off_t>(bytes));
  if (code != 0) fail(path_, "writing failed: ", code);
}

void AtomicFile::commit() {
  if (fsync(descriptor_) != 0) fail(path_, "writing failed: ", errno);
  if (together != nullptr) {
    together->files_.push_back({temporary_, path_, descriptor_, {}, false});
  } else if (rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail(path_, "cannot be put in place: ", errno);
  } else {
    close(descriptor_);
  }
  descriptor_ = -1;
}

AtomicFiles::AtomicFiles() : outer_(together) { together = this; }

AtomicFiles::~AtomicFiles() {
  together = outer_;
  for (const Waiting& file : files_) {
    if (!file.temporary.empty()) unlink(file.temporary.c_str());
  }
  forget();
}

void AtomicFiles::remove(const fs::path& path) { files_.push_back({{}, path, -1, {}, false}); }

void AtomicFiles::forget() {
  for (const Waiting& file : files_) {
    if (file.descriptor >= 0) close(file.descriptor);
  }
  files_.clear();
  last_.clear();
}

void AtomicFiles::join_outer(const std::function<void()>& last) {
  outer_->files_.insert(outer_->files_.end(), files_.begin(), files_.end());
  outer_->last_.insert(outer_->last_.end(), last_.begin(), last_.end());
  if (last) outer_->last_.push_back(last);
  files_.clear();
  last_.clear();
}

void AtomicFiles::place(Waiting& file) {
  const fs::path before = name_beside(file.place);
  if (link(file.place.c_str(), before.c_str()) == 0) file.before = before;
  file.is_new = file.before.empty() && errno == ENOENT;
  const bool clears = file.temporary.empty();
  const int result =
      clears ? unlink(file.place.c_str()) : rename(file.temporary.c_str(), file.place.c_str());
  if (result == 0 || (clears && errno == ENOENT)) return;
  const int code = errno;
  if (!file.before.empty()) unlink(file.before.c_str());
  fail(file.place, clears ? "cannot be removed: " : "cannot be put in place: ", code);
}

void AtomicFiles::commit(const std::function<void()>& last) {
  if (outer_ != nullptr) return join_outer(last);
  std::size_t placed = 0;
  try {
    for (; placed < files_.size(); ++placed) place(files_[placed]);
    for (const auto& one : last_) one();
    if (last) last();
  } catch (...) {
    undo(placed);
    throw;
  }
  for (const Waiting& file : files_) {
    if (!file.before.empty()) unlink(file.before.c_str());
  }
  forget();
}

/// Of the first `count` files, which are in place.
void AtomicFiles::undo(std::size_t count) {
  for (std::size_t i = count; i-- > 0;) {
    const Waiting& file = files_[i];
    if (!file.before.empty()) {
      rename(file.before.c_str(), file.place.c_str());
    } else if (file.is_new && !file.temporary.empty()) {
      unlink(file.place.c_str());
    }
  }
}

}  // namespace ps
