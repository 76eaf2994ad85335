// SPDX-License-Identifier: BSD-3-Clause
#include "io/lzf.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace ps {
namespace {

constexpr std::size_t kLongestRun = 32;
constexpr std::size_t kLongestCopy = 264;
constexpr std::size_t kFarthest = 8192;
constexpr int kHashBits = 15;

std::size_t hash_of_three(const char* at) {
  std::uint32_t three = 0;
  std::memcpy(&three, at, 3);
  return three * 2654435761u >> (32 - kHashBits);
}

void append_runs(std::string_view bytes, std::string& out) {
  while (!bytes.empty()) {
    const std::size_t length = std::min(bytes.size(), kLongestRun);
    out += static_cast<char>(length - 1);
    out.append(bytes.substr(0, length));
    bytes.remove_prefix(length);
  }
}

/// Three bits of length, or seven and a byte more; thirteen bits of distance.
void append_copy(std::size_t length, std::size_t distance, std::string& out) {
  const std::size_t code = length - 2, back = distance - 1;
  out += static_cast<char>(std::min<std::size_t>(code, 7) << 5 | back >> 8);
  if (code >= 7) out += static_cast<char>(code - 7);
  out += static_cast<char>(back & 0xff);
}

/// How many bytes at `at` are those at `from`, which is before it.
std::size_t common_length(std::string_view plain, std::size_t from, std::size_t at) {
  const std::size_t most = std::min(plain.size() - at, kLongestCopy);
  std::size_t length = 0;
  while (length < most && plain[from + length] == plain[at + length]) ++length;
  return length;
}

}  // namespace

std::string lzf_compress(std::string_view plain) {
  std::string out;
  out.reserve(plain.size() + plain.size() / kLongestRun + 1);
  // Where three bytes of that hash came last, counted from 1; 0 = nowhere.
  std::vector<std::uint32_t> last(std::size_t{1} << kHashBits, 0);
  std::size_t written = 0, at = 0;
  while (at + 2 < plain.size()) {
    std::uint32_t& place = last[hash_of_three(&plain[at])];
    const std::size_t before = place;
    place = static_cast<std::uint32_t>(at + 1);
    const std::size_t distance = at + 1 - before;
    const bool near = before > 0 && distance <= kFarthest;
    const std::size_t length = near ? common_length(plain, before - 1, at) : 0;
    if (length < 3) {
      ++at;
      continue;
    }
    append_runs(plain.substr(written, at - written), out);
    append_copy(length, distance, out);
    const std::size_t end = at + length;
    for (++at; at < end && at + 2 < plain.size(); ++at) {
      last[hash_of_three(&plain[at])] = static_cast<std::uint32_t>(at + 1);
    }
    written = at = end;
  }
  append_runs(plain.substr(written), out);
  return out;
}

std::optional<std::string> lzf_decompress(std::string_view packed, std::size_t size) {
  std::string out(size, '\0');
  std::size_t at = 0, done = 0;
  const auto next = [&] { return static_cast<unsigned char>(packed[at++]); };
  while (at < packed.size()) {
    const std::size_t control = next();
    if (control < kLongestRun) {
      const std::size_t length = control + 1;
      if (length > packed.size() - at || length > size - done) return {};
      std::memcpy(&out[done], &packed[at], length);
      at += length;
      done += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (packed.size() - at < (length == 7 ? 2 : 1)) return {};
    if (length == 7) length += next();
    length += 2;
    const std::size_t distance = ((control & 31) << 8 | next()) + 1;
    if (distance > done || length > size - done) return {};
    // Byte by byte: what is copied may begin in what is copied.
    for (const std::size_t end = done + length; done < end; ++done)
      out[done] = out[done - distance];
  }
  if (done != size) return {};
  return out;
}

}  // namespace ps
