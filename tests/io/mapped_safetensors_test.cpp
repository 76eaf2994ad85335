// SPDX-License-Identifier: BSD-3-Clause
#include "io/mapped_safetensors.h"

#include <algorithm>
#include <cstring>

#include "io/safetensors.h"
#include "tests/io/support.h"

namespace ps {
namespace {

TEST(MappedSafetensors, hold_what_read_safetensors_reads) {
  const Folder folder;
  TensorMap tensors;
  tensors["b"] = FileTensor::of(std::vector<float>{1, 2, 3, 4, 5, 6}, {2, 3});
  tensors["a"] = FileTensor::of(std::vector<std::uint8_t>{7, 8, 9}, {3});
  tensors["empty"] = FileTensor::of(std::vector<float>{}, {0, 4});
  write_safetensors(folder / "w", tensors, {{"who", "me"}});
  MappedSafetensors first(folder / "w");
  const MappedSafetensors mapped(std::move(first));
  ASSERT_EQ(mapped.tensors().size(), 3u);
  for (const auto& [name, tensor] : read_safetensors(folder / "w")) {
    const MappedSafetensors::Tensor& other = mapped.tensors().at(name);
    EXPECT_EQ(other.dtype, tensor.dtype);
    EXPECT_EQ(other.shape, tensor.shape);
    EXPECT_TRUE(std::equal(tensor.bytes.begin(), tensor.bytes.end(), other.data)) << name;
  }
}

TEST(MappedSafetensors, stay_as_they_were_when_the_file_is_replaced) {
  const Folder folder;
  write_safetensors(folder / "w", {{"a", FileTensor::of(std::vector<float>{1}, {1})}});
  const MappedSafetensors mapped(folder / "w");
  write_safetensors(folder / "w", {{"a", FileTensor::of(std::vector<float>{2}, {1})}});
  float value = 0;
  std::memcpy(&value, mapped.tensors().at("a").data, 4);
  EXPECT_EQ(value, 1);
}

TEST(MappedSafetensors, refuse_what_is_unsound_or_not_aligned) {
  const Folder folder;
  const auto message = [&](const std::string& bytes) {
    put(folder / "w", bytes);
    return error_of([&] { MappedSafetensors mapped(folder / "w"); });
  };
  const auto file = [](const std::string& header, const std::string& data) {
    return raw<std::uint64_t>(header.size()) + header + data;
  };
  EXPECT_TRUE(has(message(""), "a safetensors file"));
  EXPECT_TRUE(has(message("12345678901234567890"), "no safetensors file"));
  // The data begin at byte 63.
  const std::string odd = R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})";
  ASSERT_NE((8 + odd.size()) % 4, 0u);
  EXPECT_TRUE(has(message(file(odd, "1234")), "'a' is not aligned"));
  EXPECT_TRUE(has(error_of([&] { MappedSafetensors mapped(folder / "absent"); }), "absent"));
}

}  // namespace
}  // namespace ps
