// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace ps {

/// @brief A zip archive in memory, for reading: entries that are stored or deflated.
class ZipArchive {
 public:
  /// Throws ps::Error when it is none, or names an entry twice.
  /// @param bytes  must outlive this
  /// @param name   stands in messages
  ZipArchive(std::string_view bytes, std::string name);

  /// The entries' names, and their numbers in the archive.
  const std::map<std::string, std::uint64_t>& entries() const { return entries_; }
  bool has(const std::string& entry) const { return entries_.count(entry) > 0; }

  /// @brief Unpacks an entry and checks its CRC. Throws ps::Error when there is none, it is
  /// damaged, encrypted or packed another way, or longer than `most` bytes. Memory grows with what
  /// is there, not with what the entry says of its size.
  std::string read(const std::string& entry, std::size_t most) const;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };

  std::string_view bytes_;
  std::string name_;
  std::unique_ptr<zip, Close> archive_;
  std::map<std::string, std::uint64_t> entries_;
};

}  // namespace ps
