// SPDX-License-Identifier: BSD-3-Clause
#include "io/data_uri.h"

#include "io/photo.h"
#include "tests/io/support.h"

namespace ps {
namespace {

/// Digit by digit, bit by bit.
std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits, bytes;
  for (const char c : text) {
    const std::size_t value = digits.find(c);
    for (int k = 5; k >= 0 && value != std::string::npos; --k) bits += (value >> k & 1) ? '1' : '0';
  }
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  return bytes;
}

TEST(Base64, gives_the_standard_s_examples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  EXPECT_EQ(decoded(base64(all)), all);
}

TEST(DataUri, holds_the_image) {
  Image image(9, 14);
  for (int i = 0; i < 9 * 14; ++i) {
    const float level = static_cast<float>(i) / 126;
    image(i / 14, i % 14) = {level, 1 - level, 0.5f};
  }
  for (const bool lossless : {true, false}) {
    const std::string uri = data_uri(image, lossless);
    const std::string start = lossless ? "data:image/png;base64," : "data:image/jpeg;base64,";
    ASSERT_EQ(uri.substr(0, start.size()), start);
    const Image read = parse_photo(decoded(uri.substr(start.size())), "uri").color;
    ASSERT_EQ(read.size(), image.size());
    EXPECT_LT(cv::norm(read, image, cv::NORM_INF), lossless ? 0.003 : 0.1);
  }
  EXPECT_THROW(data_uri(Image(), true), Error);
}

}  // namespace
}  // namespace ps
