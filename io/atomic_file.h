// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "libps/core/error.h"

namespace ps {

/// @brief A file could not be written: no fault of the input, and the same may succeed once there
/// is room.
class WriteError : public Error {
 public:
  /// @param file  that was to be written
  /// @param why   what came of it
  WriteError(const std::string& file, const std::string& why, const std::string& expected = "")
      : Error(file, why, expected), file_(file), why_(why) {}

  const std::string& file() const { return file_; }
  const std::string& why() const { return why_; }

 private:
  std::string file_, why_;
};

/// @brief A file that appears whole or not at all: written beside its place, then renamed.
/// It replaces a file of that name; where the name is a symbolic link, the file that it leads to.
/// What processes that were killed left in its folder is removed when the first of a process is
/// made there.
class AtomicFile {
 public:
  /// Makes no parent folder. Throws ps::Error when the folder is not there or cannot be written, or
  /// when `path` is a folder, a pipe or a device.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();  ///< removes the unfinished file
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write; same folder and extension as the place it will have.
  const std::filesystem::path& temporary() const { return temporary_; }
  void write(const void* data, std::size_t bytes);  ///< Throws ps::WriteError.
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Throws ps::WriteError, as write() does, when the disk or a limit has no room for so many bytes
  /// more: for writers of temporary() that fail and do not say why.
  void check_room(std::size_t bytes) const;
  /// Flushes, checks, and puts the file in its place, or hands it to the AtomicFiles that live on
  /// this thread. Throws ps::WriteError when the disk is full. Once.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// @brief Files that appear together or not at all. Every AtomicFile that this thread commits
/// while the object lives waits beside its place, whichever function writes it, until all are put
/// in place. One that is made while another lives joins it: its commit() hands its files to the
/// outer one. Objects end in the reverse of the order in which they were made.
class AtomicFiles {
 public:
  AtomicFiles();
  ~AtomicFiles();  ///< removes what was not committed
  AtomicFiles(const AtomicFiles&) = delete;
  AtomicFiles& operator=(const AtomicFiles&) = delete;

  /// An earlier file of this name goes when the others come.
  void remove(const std::filesystem::path& path);
  /// Puts all in their places, then calls `last`, if given, which may put something else in place.
  /// Throws ps::Error when one cannot be, and what `last` throws; then the places hold again what
  /// they held, files that is (but for those replaced before it where the file system has no hard
  /// links).
  void commit(const std::function<void()>& last = {});

 private:
  friend class AtomicFile;
  struct Waiting {
    std::filesystem::path temporary;  ///< empty: the place is to be cleared
    std::filesystem::path place;
    int descriptor = -1;           ///< of `temporary`: keeps its lock
    std::filesystem::path before;  ///< what was there, under another name
    bool is_new = false;           ///< nothing was there
  };
  void join_outer(const std::function<void()>& last);
  void place(Waiting& file);
  void undo(std::size_t count);
  void forget();

  AtomicFiles* outer_;
  std::vector<Waiting> files_;
  std::vector<std::function<void()>> last_;  ///< of those that joined
};

}  // namespace ps
