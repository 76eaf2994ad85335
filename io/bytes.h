// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: files as bytes, and numbers in them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "libps/core/error.h"

namespace ps {

/// @brief A regular file open for reading, by position.
class InputFile {
 public:
  /// Throws ps::Error when there is no such file, it is a folder or a device, or may not be read.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::size_t size() const { return size_; }
  /// Reads exactly `bytes` from `offset`; throws ps::Error when the file ends before.
  void read(std::size_t offset, void* to, std::size_t bytes) const;
  /// @return the file's size() bytes, mapped for reading; the caller unmaps them; null when it is
  /// empty
  void* map() const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

/// @brief A whole file in memory.
class FileBytes {
 public:
  /// Throws ps::Error as InputFile does, and when the file is empty.
  explicit FileBytes(const std::filesystem::path& path);
  std::string_view view() const { return {data_.get(), size_}; }

 private:
  std::size_t size_ = 0;
  std::unique_ptr<char[]> data_;
};

/// @return the number stored at `at`, which need not be aligned
/// @param swap  whether it is stored in the other byte order than this machine's
template <class T>
T load(const char* at, bool swap = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, at, sizeof(T));
  if (swap) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// @return the big-endian number at `at` (PNG, JPEG, MP4)
template <class T>
T load_be(std::string_view bytes, std::size_t at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[at + i]));
  }
  return value;
}

/// @return `text` on one line
std::string one_line(std::string text);

/// @brief Runs `body`; whatever it throws leaves as a ps::Error that names `where`.
template <class Body>
auto guarded(const std::string& where, Body&& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(where, "there is not enough memory for it", "something smaller");
  } catch (const std::exception& error) {
    throw Error(where, one_line(error.what()));
  }
}

}  // namespace ps
