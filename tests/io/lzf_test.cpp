// SPDX-License-Identifier: BSD-3-Clause
#include "io/lzf.h"

#include <pcl/io/lzf.h>

#include "tests/io/support.h"

namespace ps {
namespace {

/// Bytes of few kinds, in which runs and repetitions of every length and distance turn up.
std::string random_bytes(std::size_t size, unsigned kinds, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes;
  while (bytes.size() < size) {
    const std::size_t length = random() % 400;
    const std::size_t back = bytes.empty() ? 0 : random() % bytes.size() + 1;
    for (std::size_t i = 0; i < length; ++i) {
      const bool copy = back > 0 && seed % 2 == 0;
      bytes += copy ? bytes[bytes.size() - back] : static_cast<char>(random() % kinds);
    }
    bytes += static_cast<char>(random() % kinds);
  }
  bytes.resize(size);
  return bytes;
}

std::vector<std::string> samples() {
  std::vector<std::string> all = {"", "a", "ab", "aaa", std::string(100000, 'x')};
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const unsigned kinds : {1u, 2u, 5u, 256u}) {
      all.push_back(random_bytes(seed < 30 ? seed : 3000 * seed, kinds, seed));
    }
  }
  return all;
}

TEST(Lzf, reads_back_and_grows_by_a_byte_in_32_at_most) {
  for (const std::string& plain : samples()) {
    const std::string packed = lzf_compress(plain);
    EXPECT_LE(packed.size(), plain.size() + (plain.size() + 31) / 32);
    ASSERT_EQ(lzf_decompress(packed, plain.size()), plain);
  }
  EXPECT_LT(lzf_compress(std::string(100000, 'x')).size(), 1200u);
}

TEST(Lzf, pcl_reads_what_we_compress) {
  for (const std::string& plain : samples()) {
    if (plain.empty()) continue;
    const std::string packed = lzf_compress(plain);
    std::string back(plain.size(), '\0');
    const unsigned size = pcl::lzfDecompress(packed.data(), static_cast<unsigned>(packed.size()),
                                             back.data(), static_cast<unsigned>(back.size()));
    ASSERT_EQ(size, plain.size());
    ASSERT_EQ(back, plain);
  }
}

TEST(Lzf, we_read_what_pcl_compresses) {
  for (const std::string& plain : samples()) {
    std::string packed(plain.size() * 2 + 100, '\0');
    const unsigned size = pcl::lzfCompress(plain.data(), static_cast<unsigned>(plain.size()),
                                           packed.data(), static_cast<unsigned>(packed.size()));
    if (size == 0) continue;  // it gives up on few bytes
    packed.resize(size);
    ASSERT_EQ(lzf_decompress(packed, plain.size()), plain);
  }
}

TEST(Lzf, damaged_and_truncated_data_are_refused) {
  const std::string plain = random_bytes(2000, 3, 8), packed = lzf_compress(plain);
  for (std::size_t size = 0; size < packed.size(); ++size) {
    EXPECT_FALSE(lzf_decompress(packed.substr(0, size), plain.size()));
  }
  EXPECT_FALSE(lzf_decompress(packed, plain.size() - 1));
  EXPECT_FALSE(lzf_decompress(packed, plain.size() + 1));
  EXPECT_FALSE(lzf_decompress(std::string("\x20\x00", 2), 3));  // a copy of what is not there
  EXPECT_FALSE(lzf_decompress("\x20", 3));
  EXPECT_FALSE(lzf_decompress("\xe0\x01", 10));
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    std::string damaged = packed;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    lzf_decompress(damaged, plain.size());  // whatever it says, it stays within its bounds
  }
}

}  // namespace
}  // namespace ps
