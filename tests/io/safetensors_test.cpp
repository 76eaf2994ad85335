// SPDX-License-Identifier: BSD-3-Clause
#include "io/safetensors.h"

#include <cmath>

#include "tests/io/support.h"

namespace ps {
namespace {

std::string file(const std::string& header, const std::string& data) {
  return raw<std::uint64_t>(header.size()) + header + data;
}

std::string message(const std::string& bytes) {
  return error_of([&] { parse_safetensors(bytes, "w"); });
}

TEST(Safetensors, what_is_written_reads_back_the_same) {
  const Folder folder;
  TensorMap tensors;
  tensors["b.weight"] = FileTensor::of(std::vector<float>{1, 2, 3, 4, 5, 6}, {2, 3});
  tensors["a"] = FileTensor::of(std::vector<std::uint8_t>{7, 8, 9}, {3});
  tensors["scalar"] = FileTensor::of(std::vector<std::int32_t>{-5}, {});
  tensors["empty"] = FileTensor::of(std::vector<float>{}, {0, 4});
  write_safetensors(folder / "w.safetensors", tensors);
  const TensorMap back = read_safetensors(folder / "w.safetensors");
  ASSERT_EQ(back.size(), 4u);
  for (const auto& [name, tensor] : tensors) {
    EXPECT_EQ(back.at(name).dtype, tensor.dtype);
    EXPECT_EQ(back.at(name).shape, tensor.shape);
    EXPECT_EQ(back.at(name).bytes, tensor.bytes);
  }
  EXPECT_EQ(back.at("b.weight").elements(), 6u);
  EXPECT_EQ(back.at("scalar").elements(), 1u);
  EXPECT_EQ(back.at("empty").elements(), 0u);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Safetensors, our_file_is_aligned_and_without_gaps) {
  const Folder folder;
  TensorMap tensors;
  tensors["a"] = FileTensor::of(std::vector<std::uint8_t>{7}, {1});
  tensors["b"] = FileTensor::of(std::vector<float>{1}, {1});
  write_safetensors(folder / "w", tensors);
  const std::string bytes = bytes_of(folder / "w");
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size % 8, 0u);
  EXPECT_EQ(bytes[8], '{');
  EXPECT_EQ(bytes.substr(8 + size), raw(1.f) + "\x07");
}

TEST(Safetensors, words_beside_the_tensors_read_back_the_same) {
  const Folder folder;
  const Metadata words = {{"min_z", "0.5"}, {"what \"it\" is", "d\xc3\xa9pth\n"}};
  const TensorMap tensors = {{"a", FileTensor::of(std::vector<float>{1}, {1})}};
  write_safetensors(folder / "w", tensors, words);
  EXPECT_EQ(read_safetensors_metadata(folder / "w"), words);
  EXPECT_EQ(read_safetensors(folder / "w").at("a").as_floats(), std::vector<float>{1});
  write_safetensors(folder / "w", tensors);
  EXPECT_TRUE(read_safetensors_metadata(folder / "w").empty());
}

TEST(Safetensors, metadata_that_is_no_text_is_refused) {
  const Folder folder;
  for (const char* words : {R"({"a":1})", R"({"a":"b","c":{}})", "[\"a\"]", "\"a\"", "3"}) {
    put(folder / "w", file(R"({"__metadata__":)" + std::string(words) + "}", ""));
    EXPECT_TRUE(has(error_of([&] { read_safetensors_metadata(folder / "w"); }), "is no text"));
  }
  put(folder / "w", "short");
  EXPECT_TRUE(has(error_of([&] { read_safetensors_metadata(folder / "w"); }), "w: 5 bytes"));
}

TEST(Safetensors, every_number_converts_to_float) {
  const auto floats = [](const std::string& dtype, const std::string& data) {
    const std::string n = std::to_string(data.size());
    const std::string header = R"({"__metadata__":{"by":"hand"},"t":{"dtype":")" + dtype +
                               R"(","shape":[2],"data_offsets":[0,)" + n + "]}}";
    return parse_safetensors(file(header, data), "w").at("t").as_floats();
  };
  const std::vector<float> expected{1, 2};
  EXPECT_EQ(floats("F32", raw(1.f) + raw(2.f)), expected);
  EXPECT_EQ(floats("F64", raw(1.0) + raw(2.0)), expected);
  EXPECT_EQ(floats("F16", raw<std::uint16_t>(0x3c00) + raw<std::uint16_t>(0x4000)), expected);
  EXPECT_EQ(floats("BF16", raw<std::uint16_t>(0x3f80) + raw<std::uint16_t>(0x4000)), expected);
  EXPECT_EQ(floats("I32", raw<std::int32_t>(1) + raw<std::int32_t>(2)), expected);
  EXPECT_EQ(floats("I64", raw<std::int64_t>(1) + raw<std::int64_t>(2)), expected);
  EXPECT_EQ(floats("U8", "\x01\x02"), expected);
  EXPECT_EQ(floats("BOOL", std::string("\x01\x00", 2)), (std::vector<float>{1, 0}));
  EXPECT_TRUE(has(error_of([&] { floats("I16", std::string(4, 'a')); }), "'I16'"));
}

TEST(Safetensors, halves_keep_subnormals_and_infinities) {
  FileTensor tensor{"F16", {3}, {}};
  for (const int byte : {0x01, 0x00, 0x00, 0x7c, 0x00, 0xfc})
    tensor.bytes.push_back(static_cast<std::byte>(byte));
  const std::vector<float> values = tensor.as_floats();
  EXPECT_EQ(values[0], std::ldexp(1.f, -24));
  EXPECT_EQ(values[1], HUGE_VALF);
  EXPECT_EQ(values[2], -HUGE_VALF);
}

TEST(Safetensors, headers_that_are_unsound_are_refused) {
  const auto entry = [](const std::string& body) {
    return file("{\"t\":{" + body + "}}", "abcdefgh");
  };
  EXPECT_TRUE(has(message(raw<std::uint64_t>(1ull << 60) + "{}"), "truncated"));
  EXPECT_TRUE(has(message(file("[]", "")), "no JSON object"));
  EXPECT_TRUE(has(message(file("{", "")), "JSON"));
  EXPECT_TRUE(has(message(file("{\"t\":1}", "")), "no dtype"));
  EXPECT_TRUE(has(message(file("{\"t\":" + std::string(100000, '['), "")), "nests too deep"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F32","shape":[2])")), "data_offsets"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F3","shape":[2],"data_offsets":[0,8])")), "'F3'"));
  EXPECT_TRUE(
      has(message(entry(R"("dtype":"F32","shape":[3],"data_offsets":[0,8])")), "do not fit"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F32","shape":[-2],"data_offsets":[0,8])")), "'-2'"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F32","shape":[2.5],"data_offsets":[0,8])")), "'2.5'"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F32","shape":[2],"data_offsets":[8,0])")), "outside"));
  EXPECT_TRUE(has(message(entry(R"("dtype":"F32","shape":[2],"data_offsets":[4,12])")), "outside"));
  EXPECT_TRUE(
      has(message(entry(R"("dtype":"F32","shape":[4294967296,4294967296,2],"data_offsets":[0,0])")),
          "do not fit"));
  EXPECT_TRUE(has(message(file(R"({"a":{"dtype":"U8","shape":[4],"data_offsets":[0,4]},
    "b":{"dtype":"U8","shape":[4],"data_offsets":[3,7]}})",
                               "abcdefgh")),
                  "overlaps"));
  EXPECT_TRUE(has(message(file(R"({"a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]},
    "a":{"dtype":"U8","shape":[1],"data_offsets":[1,2]}})",
                               "ab")),
                  "twice"));
}

TEST(Safetensors, every_truncation_is_an_error) {
  const Folder folder;
  write_safetensors(folder / "w", {{"t", FileTensor::of(std::vector<float>{1, 2, 3}, {3})}});
  const std::string whole = bytes_of(folder / "w");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    message(whole.substr(0, size));
    put(folder / "cut", whole.substr(0, size));
    EXPECT_TRUE(has(error_of([&] { read_safetensors(folder / "cut"); }), "cut"));
  }
}

TEST(Safetensors, unsound_tensors_are_not_written) {
  const Folder folder;
  EXPECT_TRUE(has(error_of([] { FileTensor::of(std::vector<float>{1}, {2}); }), "shape"));
  error_of([&] { write_safetensors(folder / "w", {{"t", {"F32", {2}, {}}}}); });
  error_of([&] { write_safetensors(folder / "w", {{"t", {"odd", {0}, {}}}}); });
  error_of([&] { FileTensor{"F32", {2}, {}}.as_floats(); });
  EXPECT_TRUE(
      has(error_of([&] {
            write_safetensors(folder / "w", {{"\xff", FileTensor::of(std::vector<float>{1}, {1})}});
          }),
          "w"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Safetensors, the_reference_weights_read) {
  PS_NEED_SHARED("reference/weights.safetensors");
  const TensorMap tensors = read_safetensors(shared("reference/weights.safetensors"));
  EXPECT_GT(tensors.size(), 100u);
}

}  // namespace
}  // namespace ps
