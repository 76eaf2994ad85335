// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_bytes.h"

#include <algorithm>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <utility>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/hush.h"

namespace ps {
namespace {

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kExifPrefix{"Exif\0\0", 6};
constexpr std::uint64_t kMostPixels = 1u << 28;

bool starts_with(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

[[noreturn]] void truncated(const std::string& name, const char* kind) {
  throw Error(name, std::string("the ") + kind + " is truncated", "the whole file");
}

/// @param least_bytes  fewer bytes than these cannot hold that many pixels
void check_size(std::uint64_t width, std::uint64_t height, std::uint64_t least_bytes,
                std::string_view bytes, const std::string& name) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width == 0 || height == 0) throw Error(name, "the image is " + size, "at least one pixel");
  if (width * height > kMostPixels) {
    throw Error(name, "the image is " + size, "at most 268 million pixels");
  }
  if (least_bytes > bytes.size()) {
    throw Error(name, std::to_string(bytes.size()) + " bytes cannot hold " + size + " pixels",
                "the whole file");
  }
}

/// Frame headers hold the size; C4, C8 and CC are other segments (ITU-T T.81, table B.1).
bool is_frame_header(unsigned char marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// @return where the next marker after entropy-coded data at `at` stands
std::size_t skip_entropy_coded(std::string_view bytes, std::size_t at) {
  for (; (at = bytes.find('\xFF', at)) != std::string_view::npos; ++at) {
    if (at + 1 >= bytes.size()) break;
    const auto next = static_cast<unsigned char>(bytes[at + 1]);
    const bool restart = next >= 0xD0 && next <= 0xD7;
    if (next != 0 && next != 0xFF && !restart) return at;
  }
  return bytes.size();
}

std::string_view check_jpeg(std::string_view bytes, const std::string& name) {
  std::string_view exif;
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != '\xFF') throw Error(name, "the JPEG is damaged", "a marker after a segment");
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xD9) return exif;
    if (marker == 0xFF || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {
      at += marker == 0xFF ? 1 : 2;
      continue;
    }
    if (at + 4 > bytes.size()) break;
    const std::size_t length = load_be<std::uint16_t>(bytes, at + 2);
    if (length < 2) throw Error(name, "the JPEG is damaged", "segments of two bytes at least");
    if (at + 2 + length > bytes.size()) break;
    const std::string_view segment = bytes.substr(at + 4, length - 2);
    at += 2 + length;
    if (is_frame_header(marker) && segment.size() >= 5) {
      const std::uint64_t height = load_be<std::uint16_t>(segment, 1);
      const std::uint64_t width = load_be<std::uint16_t>(segment, 3);
      // A block of 8x8 needs one bit at least in Huffman coding; half for subsampled components.
      check_size(width, height, marker < 0xC9 ? width * height / 1024 : 0, bytes, name);
    }
    if (marker == 0xE1 && exif.empty() && starts_with(segment, kExifPrefix)) {
      exif = segment.substr(kExifPrefix.size());
    }
    if (marker == 0xDA) at = skip_entropy_coded(bytes, at);
  }
  truncated(name, "JPEG");
}

std::string_view check_png(std::string_view bytes, const std::string& name) {
  std::string_view exif;
  std::size_t at = kPng.size();
  while (at + 12 <= bytes.size()) {
    const std::size_t length = load_be<std::uint32_t>(bytes, at);
    if (length > bytes.size() - at - 12) break;
    const std::string_view kind = bytes.substr(at + 4, 4);
    const std::string_view content = bytes.substr(at + 8, length);
    if (kind == "IHDR" && length >= 13) {
      const std::uint64_t width = load_be<std::uint32_t>(content, 0);
      const std::uint64_t height = load_be<std::uint32_t>(content, 4);
      const unsigned bits = static_cast<unsigned char>(content[8]);
      // Deflate makes at most 1032 bytes of one; 16 takes the channels at their fewest.
      check_size(width, height, width * height / 8 * bits / 1100, bytes, name);
    }
    if (kind == "eXIf") exif = content;
    if (kind == "IEND") return exif;
    at += 12 + length;
  }
  truncated(name, "PNG");
}

std::string_view check_webp(std::string_view bytes, const std::string& name) {
  if (load<std::uint32_t>(bytes.data() + 4) > bytes.size() - 8) truncated(name, "WebP");
  std::size_t at = 12;
  if (bytes.size() >= 30 && bytes.substr(at, 4) == "VP8X") {  // the other kinds hold 14 bits a side
    check_size((load<std::uint32_t>(&bytes[24]) & 0xffffff) + 1,
               load<std::uint32_t>(&bytes[26]) / 256 + 1, 0, bytes, name);
  }
  while (at + 8 <= bytes.size()) {
    const std::size_t length = load<std::uint32_t>(bytes.data() + at + 4);
    if (length > bytes.size() - at - 8) break;
    if (bytes.substr(at, 4) == "EXIF") {
      const std::string_view exif = bytes.substr(at + 8, length);
      return starts_with(exif, kExifPrefix) ? exif.substr(kExifPrefix.size()) : exif;
    }
    at += 8 + length + length % 2;
  }
  return {};
}

using Size = std::pair<std::uint64_t, std::uint64_t>;

std::uint64_t magnitude(std::int32_t value) {
  return static_cast<std::uint64_t>(std::abs(static_cast<std::int64_t>(value)));
}

std::optional<Size> size_of_bmp(std::string_view bytes) {
  if (bytes.size() < 26) return {};
  const char* at = bytes.data() + 18;
  if (load<std::uint32_t>(bytes.data() + 14) == 12) {
    return Size(load<std::uint16_t>(at), load<std::uint16_t>(at + 2));
  }
  return Size(magnitude(load<std::int32_t>(at)), magnitude(load<std::int32_t>(at + 4)));
}

/// Two numbers after the kind; comments may stand before each.
std::optional<Size> size_of_pnm(std::string_view bytes) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::uint64_t numbers[2] = {};
  std::size_t at = 2;
  for (std::uint64_t& number : numbers) {
    while (at < bytes.size() && !digit(bytes[at])) {
      at = bytes[at] == '#' ? bytes.find('\n', at) : at + 1;
    }
    if (at >= bytes.size()) return {};
    for (; at < bytes.size() && digit(bytes[at]); ++at) {
      number = std::min<std::uint64_t>(number * 10 + (bytes[at] - '0'), UINT32_MAX);
    }
  }
  return Size(numbers[0], numbers[1]);
}

/// Tags 256 and 257 of the first directory.
std::optional<Size> size_of_tiff(std::string_view bytes) {
  const bool swap = bytes[0] == 'M';
  if (bytes.size() < 8) return {};
  const std::size_t begin = load<std::uint32_t>(bytes.data() + 4, swap);
  if (begin + 2 > bytes.size()) return {};
  const std::size_t entries = load<std::uint16_t>(bytes.data() + begin, swap);
  Size size;
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t offset = begin + 2 + 12 * i;
    if (offset + 12 > bytes.size()) break;
    const char* at = bytes.data() + offset;
    const auto tag = load<std::uint16_t>(at, swap), type = load<std::uint16_t>(at + 2, swap);
    const std::uint64_t value =
        type == 3 ? load<std::uint16_t>(at + 8, swap) : load<std::uint32_t>(at + 8, swap);
    if (tag == 256) size.first = value;
    if (tag == 257) size.second = value;
  }
  if (size.first == 0 || size.second == 0) return {};
  return size;
}

/// The attribute dataWindow: first and last column and row.
std::optional<Size> size_of_exr(std::string_view bytes) {
  constexpr std::string_view kWindow{"dataWindow\0box2i\0\x10\0\0\0", 21};
  const std::size_t found = bytes.find(kWindow);
  if (found == std::string_view::npos || found + kWindow.size() + 16 > bytes.size()) return {};
  std::int64_t box[4];
  for (std::size_t i = 0; i < 4; ++i) {
    box[i] = load<std::int32_t>(bytes.data() + found + kWindow.size() + 4 * i);
  }
  if (box[2] < box[0] || box[3] < box[1]) return {};
  return Size(box[2] - box[0] + 1, box[3] - box[1] + 1);
}

/// @return what the header says; empty when it is unsound, which the decoder will say
std::optional<Size> size_of_others(std::string_view bytes) {
  if (starts_with(bytes, "BM")) return size_of_bmp(bytes);
  if (starts_with(bytes, {"II*\0", 4}) || starts_with(bytes, {"MM\0*", 4})) {
    return size_of_tiff(bytes);
  }
  if (starts_with(bytes, "\x76\x2f\x31\x01")) return size_of_exr(bytes);
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
  return pnm ? size_of_pnm(bytes) : std::nullopt;
}

/// The kinds that are decoded. OpenCV knows more, and by some of them damaged files end the program
/// (GDCM by an assertion on DICOM).
bool is_known(std::string_view bytes) {
  if (bytes.substr(std::min<std::size_t>(bytes.size(), 128), 4) == "DICM") return false;
  constexpr std::string_view kKinds[] = {"\xFF\xD8\xFF", kPng,   {"II*\0", 4},      {"MM\0*", 4},
                                         "BM",           "RIFF", "\x76\x2f\x31\x01"};
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
  return pnm || std::any_of(std::begin(kKinds), std::end(kKinds),
                            [&](std::string_view kind) { return starts_with(bytes, kind); });
}

}  // namespace

std::string_view check_image_bytes(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw Error(name, "is empty", "an image");
  if (starts_with(bytes, "\xFF\xD8\xFF")) return check_jpeg(bytes, name);
  if (starts_with(bytes, kPng)) return check_png(bytes, name);
  if (starts_with(bytes, "RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP") {
    return check_webp(bytes, name);
  }
  if (const auto size = size_of_others(bytes)) {
    check_size(size->first, size->second, 0, bytes, name);
  }
  return {};
}

bool has_alpha(std::string_view bytes) {
  if (starts_with(bytes, kPng)) {  // the kind of colour, or a chunk that makes some transparent
    if (bytes.size() > 25 && (bytes[25] & 4) != 0) return true;
    std::size_t at = kPng.size();
    while (at + 12 <= bytes.size() && bytes.substr(at + 4, 4) != "IDAT") {
      if (bytes.substr(at + 4, 4) == "tRNS") return true;
      at += 12 + std::size_t{load_be<std::uint32_t>(bytes, at)};
    }
    return false;
  }
  if (bytes.size() < 30 || !starts_with(bytes, "RIFF") || bytes.substr(8, 4) != "WEBP")
    return false;
  if (bytes.substr(12, 4) == "VP8X") return (bytes[20] & 0x10) != 0;
  return bytes.substr(12, 4) == "VP8L" && (bytes[24] & 0x10) != 0;
}

cv::Mat decode_image(std::string_view bytes, int flags, const std::string& name) {
  check_image_bytes(bytes, name);
  if (!is_known(bytes)) {
    throw Error(name, "is not an image of a known kind", "JPEG, PNG, TIFF, WebP, BMP or PNM");
  }
  if (bytes.size() > INT_MAX) throw Error(name, "is larger than 2 GiB", "a smaller image");
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  const Hush hush;
  cv::Mat image = cv::imdecode(raw, flags);
  if (image.empty()) {
    throw Error(name, "cannot be decoded: damaged, truncated, or of an unusual kind",
                "a whole image");
  }
  check_size(static_cast<std::uint64_t>(image.cols), static_cast<std::uint64_t>(image.rows), 0,
             bytes, name);
  return image;
}

void encode_image(const std::filesystem::path& path, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(path.extension().string(), image, bytes)) {
    throw Error(path.string(), "OpenCV cannot encode it");
  }
  AtomicFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

cv::Mat3b to_bgr8(const Image& image) {
  const auto to_byte = [](float value) {
    return static_cast<unsigned char>(value > 0 ? (value < 1 ? value * 255 + 0.5f : 255) : 0);
  };
  cv::Mat3b out(image.size());
  for (int y = 0; y < image.rows; ++y) {
    const cv::Vec3f* from = image[y];
    cv::Vec3b* to = out[y];
    for (int x = 0; x < image.cols; ++x) {
      to[x] = {to_byte(from[x][2]), to_byte(from[x][1]), to_byte(from[x][0])};
    }
  }
  return out;
}

}  // namespace ps
