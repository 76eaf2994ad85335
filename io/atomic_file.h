// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace ps {

/// @brief A file that appears whole or not at all: written beside its place, then renamed.
/// It replaces a file of that name; where the name is a symbolic link, the file that it leads to.
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
  void write(const void* data, std::size_t bytes);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Flushes, checks, and puts the file in its place. Throws ps::Error when the disk is full. Once.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

}  // namespace ps
