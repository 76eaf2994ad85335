// SPDX-License-Identifier: BSD-3-Clause
#include "io/weights_file.h"

#include <cmath>
#include <limits>

#include "tests/io/checkpoint_maker.h"

namespace ps {
namespace {

using namespace maker;
using Floats = std::vector<float>;

FileTensor of(const Floats& values) { return FileTensor::of(values, {values.size()}); }

nn::Weights one(const Floats& values) { return {"w", {{"t", {{values.size()}, values}}}}; }

/// Written as `type` and read again.
Floats back(const Floats& values, FloatType type) {
  const Folder folder;
  write_weights(folder / "w.safetensors", one(values), type);
  return read_weights(folder / "w.safetensors").tensors().at("t").values;
}

TEST(WeightsFile, names_lose_what_stands_before_the_network) {
  const auto is = [](const std::string& name, const std::string& expected) {
    EXPECT_EQ(project_name(name), expected);
  };
  for (const char* network :
       {"pts_regressor", "vqvae", "outpaint2", "projector", "netD", "classifier"}) {
    const std::string name = std::string(network) + ".conv1.bias";
    is(name, name);
    is("model.module." + name, name);
    is("model." + name, name);
    is("a.b.c." + name, name);
    EXPECT_TRUE(names_network(name));
  }
  is("netD.netD.netD.discriminator_0.model0.0.bias", "netD.discriminator_0.model0.0.bias");
  is("netD.netD", "netD.netD");  // the second is the tensor
  is("vqvae.netD.netD.a", "vqvae.netD.netD.a");
  is("model.module.a.weight", "a.weight");
  is("module.a.weight", "a.weight");
  is("model.a.weight", "a.weight");
  is("module.model.a", "model.a");
  is("model", "model");
  is("lin0.model.1.weight", "lin0.model.1.weight");
  is("model.module.vqvae", "vqvae");  // a tensor of that name is no network
  is("my_vqvae.a", "my_vqvae.a");
  is("", "");
  is("...", "...");
  EXPECT_FALSE(names_network("vqvae"));
  EXPECT_FALSE(names_network("conv1.weight"));
}

TEST(WeightsFile, names_that_become_one_are_refused) {
  const Folder folder;
  write_safetensors(folder / "w", {{"model.vqvae.a", of({1})}, {"module.vqvae.a", of({2})}});
  const std::string said = error_of([&] { read_weights(folder / "w"); });
  EXPECT_TRUE(has(said, "tensor 'module.vqvae.a': another one is also called 'vqvae.a'"));
  write_safetensors(folder / "w", {{"a\tb", of({1})}});
  EXPECT_TRUE(has(error_of([&] { read_weights(folder / "w"); }), "printable"));
  write_safetensors(folder / "w", {{"model.", of({1})}});
  EXPECT_TRUE(has(error_of([&] { read_weights(folder / "w"); }), "empty"));
}

TEST(WeightsFile, the_kind_of_file_is_told_by_its_content) {
  const Folder folder;
  const Storage storage = floats("0", {1, 2});
  const std::string value = dict({{text("module.t"), tensor(storage)}});
  put(folder / "zip.safetensors", zip_checkpoint(value, {storage}));
  put(folder / "legacy", legacy_checkpoint(value, {storage}));
  write_safetensors(folder / "plain.pth", {{"module.t", of({1, 2})}});
  for (const char* name : {"zip.safetensors", "legacy", "plain.pth"}) {
    const nn::Weights weights = read_weights(folder / name);
    EXPECT_EQ(weights.get("t", {2}).values, (Floats{1, 2}));
    EXPECT_EQ(weights.name(), (folder / name).string());
    const std::string bytes = bytes_of(folder / name);
    EXPECT_EQ(parse_weights(bytes, "w").get("t", {2}).values, (Floats{1, 2}));
  }
  put(folder / "nothing", "");
  EXPECT_TRUE(has(error_of([&] { read_weights(folder / "nothing"); }), "nothing"));
  EXPECT_TRUE(has(error_of([&] { read_weights(folder / "absent"); }), "absent"));
  put(folder / "text", "a photo, perhaps");
  EXPECT_TRUE(has(error_of([&] { read_weights(folder / "text"); }), "text"));
}

TEST(WeightsFile, words_beside_the_weights_are_kept_and_a_checkpoint_has_none) {
  const Folder folder;
  const Metadata words = {{"min_z", "0.5"}, {"max_z", "20"}};
  write_weights(folder / "w", one({1}), FloatType::f16, words);
  EXPECT_EQ(read_metadata(folder / "w"), words);
  ps::put(folder / "c", zip_checkpoint(sample(), sample_storages()));
  EXPECT_TRUE(read_metadata(folder / "c").empty());
}

TEST(WeightsFile, every_float_is_read_and_integers_are_refused_where_they_are_asked_for) {
  const Folder folder;
  FileTensor half{"F16", {1}, {std::byte{0}, std::byte{0x3e}}};
  FileTensor brain{"BF16", {1}, {std::byte{0xc0}, std::byte{0x3f}}};
  FileTensor wide{"F64", {1}, {}};
  for (const char c : raw(1.5)) wide.bytes.push_back(static_cast<std::byte>(c));
  FileTensor odd{"I16", {1}, {std::byte{1}, std::byte{0}}};
  write_safetensors(folder / "w", {{"f32", of({1.5f})},
                                   {"f16", half},
                                   {"bf16", brain},
                                   {"f64", wide},
                                   {"i16", odd},
                                   {"u8", FileTensor::of(std::vector<std::uint8_t>{1}, {1})}});
  const nn::Weights weights = read_weights(folder / "w");
  for (const char* name : {"f32", "f16", "bf16", "f64"}) {
    EXPECT_EQ(weights.vector(name, 1), Floats{1.5f}) << name;
  }
  EXPECT_TRUE(has(error_of([&] { weights.vector("i16", 1); }), "'i16' is of type I16"));
  EXPECT_TRUE(has(error_of([&] { weights.vector("u8", 1); }), "'u8' is of type U8"));
}

TEST(WeightsFile, a_value_that_is_not_finite_is_named_when_it_is_asked_for) {
  const Folder folder;
  write_safetensors(folder / "w",
                    {{"model.module.vqvae.a", of({1})}, {"model.module.vqvae.b", of({1, NAN})}});
  const nn::Weights weights = read_weights(folder / "w");
  EXPECT_EQ(weights.vector("vqvae.a", 1), Floats{1});
  EXPECT_TRUE(
      has(error_of([&] { weights.vector("vqvae.b", 2); }), "w: tensor 'vqvae.b' holds NaN"));
}

TEST(WeightsFile, f32_comes_back_bit_for_bit) {
  const Floats values{0.f, -0.f, 1e-45f, -1e-40f, 3.4028235e38f, 1.f / 3};
  const Floats read = back(values, FloatType::f32);
  EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(float)), 0);
}

TEST(WeightsFile, f16_rounds_to_nearest_even) {
  const float tiny = std::ldexp(1.f, -24);  // the least subnormal half
  const Floats given{1,
                     1 + std::ldexp(1.f, -11),      // halfway, to even: down
                     1 + 3 * std::ldexp(1.f, -11),  // halfway, to even: up
                     1 + std::ldexp(1.f, -11) + std::ldexp(1.f, -20),
                     tiny,
                     tiny / 2,     // halfway to 0, which is even
                     tiny * 1.5f,  // halfway, to even: up
                     tiny * 0.51f,
                     65504,                                               // the greatest
                     65519,                                               // still rounds down
                     -std::ldexp(1.f, -14) * (1 - std::ldexp(1.f, -10)),  // greatest subnormal
                     1e-30f};
  const Floats expected{1,
                        1,
                        1 + std::ldexp(1.f, -9),
                        1 + std::ldexp(1.f, -10),
                        tiny,
                        0,
                        2 * tiny,
                        tiny,
                        65504,
                        65504,
                        given[10],
                        0};
  EXPECT_EQ(back(given, FloatType::f16), expected);
}

TEST(WeightsFile, bf16_rounds_to_nearest_even) {
  const float least = std::ldexp(1.f, -133);  // the least subnormal
  const Floats given{1,
                     1 + std::ldexp(1.f, -8),
                     1 + 3 * std::ldexp(1.f, -8),
                     1 + std::ldexp(1.f, -8) + std::ldexp(1.f, -20),
                     least,
                     least / 2,
                     least * 1.5f,
                     std::ldexp(1.f, -127) + std::ldexp(1.f, -149),
                     -3.3895314e38f};
  const Floats expected{1, 1,         1 + std::ldexp(1.f, -6), 1 + std::ldexp(1.f, -7), least,
                        0, 2 * least, std::ldexp(1.f, -127),   -3.3895314e38f};
  EXPECT_EQ(back(given, FloatType::bf16), expected);
}

TEST(WeightsFile, infinities_and_nan_stay_what_they_are) {
  for (const FloatType type : {FloatType::f32, FloatType::f16, FloatType::bf16}) {
    const Floats read = back({HUGE_VALF, -HUGE_VALF, NAN}, type);
    EXPECT_EQ(read[0], HUGE_VALF);
    EXPECT_EQ(read[1], -HUGE_VALF);
    EXPECT_TRUE(std::isnan(read[2]));
  }
}

TEST(WeightsFile, numbers_too_large_for_a_type_name_their_tensor) {
  const Folder folder;
  const auto said = [&](float value, FloatType type) {
    return error_of([&] { write_weights(folder / "w", one({1, value}), type); });
  };
  EXPECT_TRUE(has(said(65520, FloatType::f16), "w, tensor 't': its value 65520"));
  EXPECT_TRUE(has(said(-1e38f, FloatType::f16), "f16"));
  EXPECT_TRUE(has(said(std::numeric_limits<float>::max(), FloatType::bf16), "bf16"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(WeightsFile, only_floats_change_their_type) {
  FileTensor wide{"F64", {1}, {}};
  for (const char c : raw(0.25)) wide.bytes.push_back(static_cast<std::byte>(c));
  const FileTensor counter = FileTensor::of(std::vector<std::int32_t>{123456789}, {});
  const TensorMap stored =
      stored_as({{"a", of({0.5f})}, {"w", wide}, {"count", counter}}, FloatType::f16, "w");
  EXPECT_EQ(stored.at("a").dtype, "F16");
  EXPECT_EQ(stored.at("w").dtype, "F16");
  EXPECT_EQ(stored.at("w").as_floats(), Floats{0.25f});
  EXPECT_EQ(stored.at("count").dtype, "I32");
  EXPECT_EQ(stored.at("count").bytes, counter.bytes);
}

TEST(WeightsFile, long_names_are_named_whole) {
  const Folder folder;
  const std::string name = "outpaint2.down_layers.0.u_stream.0.nin_skip.lin_a.weight_v";
  const Storage storage = floats("0", {1});
  const std::string value = dict({{text(name), tensor(reference(storage), 1, {1}, {1})}});
  EXPECT_TRUE(has(error_of([&] { parse_weights(zip_checkpoint(value, {storage}), "w"); }), name));
  const std::string header =
      "{\"" + name + R"(":{"dtype":"F32","shape":[1],"data_offsets":[0,8]}})";
  const std::string file = raw<std::uint64_t>(header.size()) + header + "12345678";
  EXPECT_TRUE(has(error_of([&] { parse_weights(file, "w"); }), name));
}

TEST(WeightsFile, what_python_s_pickle_and_zipfile_write_is_read) {
  const std::filesystem::path seeds = PS_DATA_DIR "/../tests/fuzz/corpus/checkpoint";
  for (const char* name : {"zip_2", "zip_4", "zip_deflated", "legacy_2", "legacy_4"}) {
    const nn::Weights weights = read_weights(seeds / name);
    EXPECT_EQ(weights.tensors().size(), 6u) << name;
    EXPECT_EQ(weights.get("vqvae.a.weight", {2, 3}).values, (Floats{0, 1, 2, 3, 4, 5})) << name;
    EXPECT_EQ(weights.get("vqvae.a.weight_t", {3, 2}).values, (Floats{0, 3, 1, 4, 2, 5})) << name;
    EXPECT_EQ(weights.vector("vqvae.a.bias", 2), (Floats{0.5f, -0.5f})) << name;
    EXPECT_EQ(weights.vector("netD.d", 1), Floats{0.25f}) << name;
    EXPECT_TRUE(weights.has("flag")) << name;
  }
  for (const char* name : {"zip_nested", "legacy_3", "legacy_5"}) {
    const nn::Weights weights = read_weights(seeds / name);
    EXPECT_EQ(weights.get("net.layers.1.0", {2, 2}).values, (Floats{4, 4, 5, 5})) << name;
  }
}

TEST(WeightsFile, the_reference_weights_read_under_the_projects_names) {
  PS_NEED_SHARED("reference/weights.safetensors");
  const nn::Weights weights = read_weights(shared("reference/weights.safetensors"));
  EXPECT_EQ(weights.tensors().size(), 549u);
  weights.layer("pts_regressor.conv1", {4, 3, 4, 4});
  weights.layer("outpaint2.nin_out.lin_a", {512, 16});
  weights.layer("netD.discriminator_1.model4.0", {1, 64, 4, 4});
  weights.get("vqvae.quantize_t.embed", {16, 512});
  batch_norm(weights, "pts_regressor.batch_norm4_0", 16);
  for (const auto& [name, tensor] : weights.tensors()) {
    EXPECT_FALSE(has(name, "module")) << name;
  }
}

TEST(WeightsFile, real_checkpoints_read_as_weights) {
  PS_NEED_SHARED("weights/torch_checkpoints/zip_with_options.pth");
  const auto path = shared("weights/torch_checkpoints/zip_with_options.pth");
  const nn::Weights weights = read_weights(path);
  EXPECT_EQ(weights.get("a.weight", {4, 3, 3, 3}).values.front(), -0.07664429396390915f);
  EXPECT_EQ(weights.vector("half", 3).front(), -0.5859375f);
  EXPECT_TRUE(has(error_of([&] { weights.get("bn.num_batches_tracked", {}); }), "I64"));
}

}  // namespace
}  // namespace ps
