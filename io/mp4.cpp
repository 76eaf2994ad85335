// SPDX-License-Identifier: BSD-3-Clause
#include "io/mp4.h"

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "io/bytes.h"

namespace ps {
namespace {

struct Box {
  std::string kind;
  std::size_t begin = 0;
  std::size_t header = 8;
  std::size_t size = 0;  ///< with its header
};

/// Boxes side by side in [begin, end); stops at one that is cut off.
std::vector<Box> boxes(std::string_view bytes, std::size_t begin, std::size_t end) {
  std::vector<Box> found;
  while (begin + 8 <= end) {
    Box box{std::string(bytes.substr(begin + 4, 4)), begin, 8,
            load_be<std::uint32_t>(bytes, begin)};
    if (box.size == 1 && begin + 16 <= end) {
      box.header = 16;
      box.size = load_be<std::uint64_t>(bytes, begin + 8);
    }
    if (box.size < box.header || box.size > end - begin) break;
    found.push_back(box);
    begin += box.size;
  }
  return found;
}

template <class T>
bool shift_table(std::string& bytes, std::size_t begin, std::size_t end, std::size_t by) {
  const std::size_t count = load_be<std::uint32_t>(bytes, begin + 4);
  if (count > (end - begin - 8) / sizeof(T)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = begin + 8 + i * sizeof(T);
    const std::uint64_t offset = load_be<T>(bytes, at) + by;
    if (offset > std::numeric_limits<T>::max()) return false;
    for (std::size_t b = 0; b < sizeof(T); ++b) {
      bytes[at + b] = static_cast<char>(offset >> 8 * (sizeof(T) - 1 - b));
    }
  }
  return true;
}

/// Adds `by` to all chunk offsets below the box; false when one does not fit.
bool shift_chunks(std::string& bytes, const Box& box, std::size_t by) {
  const std::size_t begin = box.begin + box.header, end = box.begin + box.size;
  if (box.kind == "stco" || box.kind == "co64") {
    if (end - begin < 8) return false;
    return box.kind == "stco" ? shift_table<std::uint32_t>(bytes, begin, end, by)
                              : shift_table<std::uint64_t>(bytes, begin, end, by);
  }
  for (const char* parent : {"moov", "trak", "mdia", "minf", "stbl"}) {
    if (box.kind != parent) continue;
    for (const Box& child : boxes(bytes, begin, end)) {
      if (!shift_chunks(bytes, child, by)) return false;
    }
  }
  return true;
}

}  // namespace

std::string index_first(std::string bytes, const std::string& name) {
  const Box *ftyp = nullptr, *moov = nullptr, *mdat = nullptr;
  const std::vector<Box> all = boxes(bytes, 0, bytes.size());
  for (const Box& box : all) {
    if (box.kind == "ftyp") ftyp = &box;
    if (box.kind == "moov") moov = &box;
    if (box.kind == "mdat") mdat = &box;
  }
  if (ftyp == nullptr || moov == nullptr || mdat == nullptr) {
    throw Error(name, "the video was not finished", "a whole MP4");
  }
  if (moov->begin < mdat->begin) return bytes;
  std::string index = bytes.substr(moov->begin, moov->size);
  if (!shift_chunks(index, {"moov", 0, moov->header, moov->size}, moov->size)) return bytes;
  const std::size_t front = ftyp->begin + ftyp->size;
  return bytes.substr(0, front) + index + bytes.substr(front, moov->begin - front) +
         bytes.substr(moov->begin + moov->size);
}

}  // namespace ps
