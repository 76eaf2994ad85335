// SPDX-License-Identifier: BSD-3-Clause
#include "io/torch_checkpoint.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/io/checkpoint_maker.h"

namespace ps {
namespace {

using namespace maker;
using namespace std::string_literals;
using Floats = std::vector<float>;

void expect_sample(const TensorMap& tensors) {
  ASSERT_EQ(tensors.size(), 2u);
  const FileTensor& weight = tensors.at("a.weight");
  EXPECT_EQ(weight.dtype, "F32");
  EXPECT_EQ(weight.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(weight.as_floats(), (Floats{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(tensors.at("a.count").dtype, "I64");
  EXPECT_TRUE(tensors.at("a.count").shape.empty());
  EXPECT_EQ(tensors.at("a.count").as_floats(), Floats{7});
}

TEST(TorchCheckpoint, both_containers_give_the_same_tensors) {
  for (const char protocol : {2, 3, 4, 5}) {
    expect_sample(parse(zip_checkpoint(sample(), sample_storages(), false, protocol)));
    expect_sample(parse(zip_checkpoint(sample(), sample_storages(), true, protocol)));
    expect_sample(parse(legacy_checkpoint(sample(), sample_storages(), protocol)));
  }
  const Folder folder;
  put(folder / "w.pth", legacy_checkpoint(sample(), sample_storages()));
  expect_sample(read_torch_checkpoint(folder / "w.pth"));
}

TEST(TorchCheckpoint, every_type_of_storage_is_read) {
  const auto is = [](const std::string& type, const std::string& dtype, const std::string& bytes) {
    const Storage storage{"0", type, 2, bytes};
    const TensorMap tensors = parse(dict({{text("t"), tensor(storage)}}), {storage});
    EXPECT_EQ(tensors.at("t").dtype, dtype);
    const auto* const first = reinterpret_cast<const char*>(tensors.at("t").bytes.data());
    EXPECT_EQ(std::string(first, tensors.at("t").bytes.size()), bytes);
  };
  is("FloatStorage", "F32", raw(1.f) + raw(2.f));
  is("DoubleStorage", "F64", raw(1.0) + raw(2.0));
  is("HalfStorage", "F16", "abcd");
  is("BFloat16Storage", "BF16", "abcd");
  is("LongStorage", "I64", "abcdefghijklmnop");
  is("IntStorage", "I32", "abcdefgh");
  is("ShortStorage", "I16", "abcd");
  is("CharStorage", "I8", "ab");
  is("ByteStorage", "U8", "ab");
  is("BoolStorage", "BOOL", "\1\0"s);
  const Storage complex{"0", "ComplexFloatStorage", 1, std::string(8, 'a')};
  EXPECT_TRUE(has(message(dict({{text("t"), tensor(complex)}}), {complex}), "ComplexFloat"));
}

TEST(TorchCheckpoint, views_of_any_strides_become_whole_tensors) {
  const auto floats_of = [](std::int64_t offset, const std::vector<std::int64_t>& shape,
                            const std::vector<std::int64_t>& strides) {
    const std::string value = dict({{text("t"), tensor(reference(kSix), offset, shape, strides)}});
    const Floats zip = parse(value, {kSix}).at("t").as_floats();
    EXPECT_EQ(parse(legacy_checkpoint(value, {kSix})).at("t").as_floats(), zip);
    return zip;
  };
  EXPECT_EQ(floats_of(0, {3, 2}, {1, 3}), (Floats{0, 3, 1, 4, 2, 5}));    // transposed
  EXPECT_EQ(floats_of(1, {2, 2}, {3, 1}), (Floats{1, 2, 4, 5}));          // columns cut out
  EXPECT_EQ(floats_of(1, {3}, {2}), (Floats{1, 3, 5}));                   // every second
  EXPECT_EQ(floats_of(4, {2, 3}, {1, 0}), (Floats{4, 4, 4, 5, 5, 5}));    // repeated
  EXPECT_EQ(floats_of(2, {1, 4, 1}, {99, 1, 99}), (Floats{2, 3, 4, 5}));  // one long
  EXPECT_EQ(floats_of(0, {1, 3, 2}, {6, 1, 3}), (Floats{0, 3, 1, 4, 2, 5}));
  EXPECT_EQ(floats_of(5, {}, {}), Floats{5});
  EXPECT_EQ(floats_of(6, {0, 4}, {4, 1}), Floats{});
}

TEST(TorchCheckpoint, storages_may_be_shared) {
  const std::string value = dict({{text("z"), tensor(put(1, reference(kSix)), 0, {2}, {1})},
                                  {text("a"), tensor(remembered(1), 4, {2}, {1})},
                                  {text("same"), put(2, tensor(reference(kSix), 2, {2}, {1}))},
                                  {text("again"), remembered(2)}});
  for (const std::string& bytes :
       {zip_checkpoint(value, {kSix}), legacy_checkpoint(value, {kSix})}) {
    const TensorMap tensors = parse(bytes);
    EXPECT_EQ(tensors.at("z").as_floats(), (Floats{0, 1}));
    EXPECT_EQ(tensors.at("a").as_floats(), (Floats{4, 5}));
    EXPECT_EQ(tensors.at("same").as_floats(), (Floats{2, 3}));
    EXPECT_EQ(tensors.at("again").as_floats(), (Floats{2, 3}));
  }
}

TEST(TorchCheckpoint, legacy_storages_may_be_parts) {
  const auto part = [](std::int64_t first, std::int64_t count) {
    return dict(
        {{text("t"),
          tensor(reference(kSix, tuple({text("9"), number(first), number(count)})), 1, {2}, {1})}});
  };
  EXPECT_EQ(parse(legacy_checkpoint(part(2, 3), {kSix})).at("t").as_floats(), (Floats{3, 4}));
  EXPECT_TRUE(has(message(legacy_checkpoint(part(2, 2), {kSix})), "'t': it reaches outside"));
  EXPECT_TRUE(has(message(legacy_checkpoint(part(5, 3), {kSix})), "part reaches outside"));
  const std::string none = dict({{text("t"), tensor(reference(kSix, "N"), 0, {6}, {1})}});
  EXPECT_EQ(parse(legacy_checkpoint(none, {kSix})).at("t").elements(), 6u);
}

TEST(TorchCheckpoint, big_endian_archives_are_turned_round) {
  const Storage storage{"0", "FloatStorage", 2, raw(1.5f, true) + raw(-2.f, true)};
  const std::string value = pickle(dict({{text("t"), tensor(storage)}}));
  const auto with = [&](const std::string& order) {
    return zip_of({{"w/data.pkl", value}, {"w/data/0", storage.bytes}, {"w/byteorder", order}});
  };
  EXPECT_EQ(parse(with("big")).at("t").as_floats(), (Floats{1.5f, -2}));
  EXPECT_NE(parse(with("little")).at("t").as_floats(), (Floats{1.5f, -2}));
  EXPECT_TRUE(has(message(with("middle")), "'middle'"));
}

TEST(TorchCheckpoint, a_state_dict_is_taken_alone) {
  const std::string t = tensor(reference(kSix), 0, {6}, {1});
  const auto names = [](const std::string& value) {
    std::string all;
    for (const auto& [name, tensor] : parse(value, {kSix})) all += name + " ";
    return all;
  };
  const std::string optimizer = dict({{text("state"), dict({{number(0), t}})}});
  EXPECT_EQ(names(dict({{text("state_dict"), dict({{text("a"), t}})}, {text("o"), optimizer}})),
            "a ");
  EXPECT_EQ(
      names(dict({{text("model_state_dict"), dict({{text("a"), t}})}, {text("o"), optimizer}})),
      "a ");
  EXPECT_EQ(names(dict({{text("model"), dict({{text("a"), t}})}, {text("o"), optimizer}})),
            "model.a o.state.0 ");
  EXPECT_EQ(names(dict({{text("state_dict"), dict({{text("a"), dict({{text("b"), t}})}})}})),
            "a.b ");
  EXPECT_EQ(names(list({t, tuple({"N", t})})), "0 1.1 ");
  EXPECT_EQ(names(t), "tensor ");
}

TEST(TorchCheckpoint, ordered_dicts_of_python_2_are_read) {
  const std::string pairs =
      list({list({"U\1a", tensor(reference(kSix), 0, {1}, {1})}),
            list({"U\1b", tensor(reference(kSix), 5, {1}, {1})}), list({"U\1c"})});
  const std::string value = call(global("collections", "OrderedDict"), tuple({pairs})) +
                            dict({{text("_metadata"), dict({})}}) + "b";
  const TensorMap tensors = parse(value, {kSix});
  ASSERT_EQ(tensors.size(), 2u);
  EXPECT_EQ(tensors.at("b").as_floats(), Floats{5});
}

TEST(TorchCheckpoint, parameters_are_tensors) {
  const std::string parameter = call(global("torch._utils", "_rebuild_parameter"),
                                     tuple({tensor(kSix), "\x88", ordered_dict({})}));
  EXPECT_EQ(parse(dict({{text("p"), parameter}}), {kSix}).at("p").elements(), 6u);
}

TEST(TorchCheckpoint, options_of_any_kind_are_passed_over) {
  const std::string space =
      global("argparse", "Namespace") + ")\x81" + dict({{text("W"), number(256)}}) + "b";
  const std::string scalar =
      call(global("numpy.core.multiarray", "scalar"),
           tuple({call(global("numpy", "dtype"), tuple({text("f8"), "\x89", "\x88"})) +
                      tuple({number(3), text("<"), "N"}) + "b",
                  call(global("_codecs", "encode"), tuple({text("12345678"), text("latin1")}))}));
  const std::string value =
      dict({{text("opts"), space},
            {text("best"), scalar},
            {text("where"), call(global("pathlib", "PosixPath"), tuple({text("/")}))},
            {text("names"), call(global("__builtin__", "set"), tuple({list({text("a")})}))},
            {text("type"), global("torch", "float32")},
            {text("state_dict"), dict({{text("a"), tensor(kSix)}})}});
  EXPECT_EQ(parse(value, {kSix}).size(), 1u);
  EXPECT_EQ(parse(legacy_checkpoint(value, {kSix})).size(), 1u);
}

// Files that torch itself wrote.

TEST(TorchCheckpoint, the_sums_of_real_files_with_options_are_as_expected) {
  PS_NEED_SHARED("weights/torch_checkpoints/expected.json");
  const auto expected =
      nlohmann::json::parse(bytes_of(shared("weights/torch_checkpoints/expected.json")));
  for (const char* file : {"zip_with_options.pth", "legacy_with_options.pth"}) {
    const TensorMap tensors =
        read_torch_checkpoint(shared("weights/torch_checkpoints") / std::string(file));
    EXPECT_EQ(tensors.size(), expected.size());
    for (const auto& [name, is] : expected.items()) {
      ASSERT_EQ(tensors.count(name), 1u) << name;
      const Floats values = tensors.at(name).as_floats();
      EXPECT_EQ(tensors.at(name).shape, is["shape"].get<std::vector<std::size_t>>());
      EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), is["sum"].get<double>(),
                  1e-12);
      EXPECT_EQ(values.front(), is["first"].get<float>());
      EXPECT_EQ(values.back(), is["last"].get<float>());
    }
  }
}

TEST(TorchCheckpoint, real_files_hold_what_the_same_weights_as_safetensors_hold) {
  PS_NEED_SHARED("weights/torch_checkpoints/squeezenet_backbone.pth");
  PS_NEED_SHARED("weights/lpips/lpips_squeeze_v0.1.safetensors");
  const TensorMap expected =
      read_safetensors(shared("weights/lpips/lpips_squeeze_v0.1.safetensors"));
  const auto same = [&](const std::string& file, const std::string& prefix) {
    const TensorMap tensors = read_torch_checkpoint(shared("weights/torch_checkpoints") / file);
    for (const auto& [name, tensor] : tensors) {
      const auto found = expected.find(prefix + name);
      EXPECT_TRUE(found != expected.end()) << name;
      if (found == expected.end()) continue;
      EXPECT_EQ(tensor.shape, found->second.shape) << name;
      EXPECT_EQ(tensor.bytes, found->second.bytes) << name;
    }
    return tensors.size();
  };
  EXPECT_EQ(same("squeezenet_backbone.pth", "net.") + same("lpips_lin_squeeze.pth", ""),
            expected.size());
}

}  // namespace
}  // namespace ps
