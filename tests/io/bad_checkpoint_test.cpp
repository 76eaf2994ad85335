// SPDX-License-Identifier: BSD-3-Clause
#include "io/torch_checkpoint.h"
#include "tests/io/checkpoint_maker.h"

namespace ps {
namespace {

using namespace maker;
using namespace std::string_literals;
using Floats = std::vector<float>;

TEST(BadCheckpoint, every_truncation_is_an_error) {
  for (const std::string& whole : {zip_checkpoint(sample(), sample_storages()),
                                   legacy_checkpoint(sample(), sample_storages())}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_TRUE(has(message(whole.substr(0, size)), "w.pth"));
    }
  }
}

TEST(BadCheckpoint, any_damaged_byte_is_an_error_or_leaves_sound_tensors) {
  for (const std::string& whole : {zip_checkpoint(sample(), sample_storages()),
                                   legacy_checkpoint(sample(), sample_storages())}) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
      try {
        for (const auto& [name, tensor] : parse(damaged)) {
          EXPECT_EQ(tensor.as_floats().size(), tensor.elements());
        }
      } catch (const Error&) {
      }
    }
  }
}

TEST(BadCheckpoint, a_hostile_file_is_refused_and_runs_nothing) {
  const Folder folder;
  const std::string run =
      call(global("posix", "system"), tuple({text("touch " + (folder / "ran").string())}));
  for (const std::string& value :
       {run, dict({{text("state_dict"), dict({{text("a"), tensor(kSix)}})}, {text("opts"), run}}),
        dict({{text("a"), tensor(kSix)}, {text("b"), run}}),
        dict({{text("a"), call(global("torch._utils", "_rebuild_tensor_v2"), tuple({run}))}}),
        dict({{run, tensor(kSix)}}), call(global("collections", "OrderedDict"), tuple({run}))}) {
    EXPECT_TRUE(has(message(value, {kSix}), "'posix.system'"));
    EXPECT_TRUE(has(message(legacy_checkpoint(value, {kSix})), "'posix.system'"));
  }
  EXPECT_EQ(folder.entries(), 0);
}

TEST(BadCheckpoint, objects_are_no_tensors) {
  const std::string object = global("torch", "Tensor") + ")\x81";
  EXPECT_TRUE(has(message(dict({{text("a"), object}}), {kSix}), "no tensors"));
  const std::string made = call(global("torch._utils", "_rebuild_tensor_v2"),
                                tuple({object, number(0), numbers({6}), numbers({1})}));
  EXPECT_TRUE(has(message(dict({{text("a.b"), made}}), {kSix}), "'a.b'"));
  const std::string empty = call(global("torch._utils", "_rebuild_parameter"), ")");
  EXPECT_TRUE(has(message(dict({{text("a.b"), empty}}), {kSix}), "'a.b'"));
}

TEST(BadCheckpoint, tensors_that_leave_their_storage_are_named) {
  const auto refusal = [](std::int64_t offset, const std::vector<std::int64_t>& shape,
                          const std::vector<std::int64_t>& strides) {
    const std::string value =
        dict({{text("net.layer.weight"), tensor(reference(kSix), offset, shape, strides)}});
    const std::string said = message(value, {kSix});
    EXPECT_TRUE(has(said, "w.pth, tensor 'net.layer.weight': "));
    EXPECT_EQ(message(legacy_checkpoint(value, {kSix})), said);
    return said;
  };
  constexpr std::int64_t kHuge = std::int64_t{1} << 55;
  EXPECT_TRUE(has(refusal(0, {7}, {1}), "reaches outside"));
  EXPECT_TRUE(has(refusal(1, {2, 3}, {3, 1}), "reaches outside"));
  EXPECT_TRUE(has(refusal(6, {}, {}), "reaches outside"));
  EXPECT_TRUE(has(refusal(0, {2}, {6}), "reaches outside"));
  EXPECT_TRUE(has(refusal(0, {kHuge, kHuge}, {kHuge, kHuge}), "too many"));
  EXPECT_TRUE(has(refusal(0, {257, 257}, {kHuge, kHuge}), "reaches outside"));
  EXPECT_TRUE(has(refusal(kHuge, {6}, {1}), "reaches outside"));
  EXPECT_TRUE(has(refusal(-1, {6}, {1}), "offset"));
  EXPECT_TRUE(has(refusal(0, {-6}, {1}), "shape"));
  EXPECT_TRUE(has(refusal(0, {6}, {-1}), "strides"));
  EXPECT_TRUE(has(refusal(0, {INT64_MAX}, {0}), "shape"));
  EXPECT_TRUE(has(refusal(0, {6}, {1, 1}), "strides"));
  EXPECT_TRUE(
      has(refusal(0, std::vector<std::int64_t>(65, 1), std::vector<std::int64_t>(65, 1)), "shape"));
}

TEST(BadCheckpoint, memory_is_bounded_by_the_file) {
  constexpr std::int64_t kMany = 50'000'000;
  EXPECT_TRUE(has(message(dict({{text("t"), tensor(reference(kSix), 0, {kMany}, {0})}}), {kSix}),
                  "'t': it needs far more memory"));
  Pairs copies;
  const Storage large = floats("0", Floats(250'000, 1));
  for (int i = 0; i < 100; ++i) {
    copies.emplace_back(text("t" + std::to_string(i)), tensor(large));
  }
  EXPECT_TRUE(has(message(dict(copies), {large}), "far more memory"));
  const Storage bomb{"0", "ByteStorage", 100'000'000, std::string(100'000'000, '\0')};
  const std::string bytes = zip_checkpoint(dict({{text("t"), tensor(bomb)}}), {bomb}, true);
  EXPECT_LT(bytes.size(), 200'000u);
  EXPECT_TRUE(has(message(bytes), "'t': it needs far more memory"));
}

TEST(BadCheckpoint, values_that_share_and_share_again_are_refused) {
  std::string value = put(0, dict({{text("t"), tensor(kSix)}}));
  for (char i = 0; i < 40; ++i) {
    value = put(static_cast<char>(i + 1), dict({{text("a"), value}, {text("b"), remembered(i)}}));
  }
  EXPECT_TRUE(has(message(value, {kSix}), "w.pth: "));
  const std::string itself = "]q\1(h\1" + tensor(kSix) + "e";
  EXPECT_TRUE(has(message(itself, {kSix}), "nest too deep"));
  const std::string deep(100'000, ']');
  const std::string nested = deep + std::string(99'999, 'a');
  EXPECT_TRUE(has(message(nested, {}), "nest too deep"));
  const std::string beside =
      dict({{text("state_dict"), dict({{text("t"), tensor(kSix)}})}, {text("opts"), nested}});
  EXPECT_EQ(parse(beside, {kSix}).size(), 1u);
  const std::string longest(2000, 'n');
  EXPECT_TRUE(has(message(dict({{text(longest), tensor(kSix)}}), {kSix}), "too long"));
}

TEST(BadCheckpoint, names_that_are_there_twice_are_refused) {
  const std::string twice = dict({{text("a.b"), tensor(kSix)}, {text("a.b"), tensor(kSix)}});
  EXPECT_TRUE(has(message(twice, {kSix}), "tensor 'a.b': it is there twice"));
  const std::string same =
      dict({{text("a.b"), tensor(kSix)}, {text("a"), dict({{text("b"), tensor(kSix)}})}});
  EXPECT_TRUE(has(message(same, {kSix}), "tensor 'a.b': it is there twice"));
}

TEST(BadCheckpoint, archives_that_lie_are_refused) {
  const std::string value = pickle(dict({{text("t"), tensor(kSix)}}));
  const auto with = [&](const Entries& more) {
    Entries entries{{"w/data.pkl", value}};
    entries.insert(entries.end(), more.begin(), more.end());
    return zip_of(entries);
  };
  EXPECT_TRUE(has(message(with({})), "'w/data/0': is missing"));
  EXPECT_TRUE(has(message(with({{"w/data/0", kSix.bytes.substr(1)}})), "'t': its storage has 23"));
  EXPECT_TRUE(has(message(with({{"w/data/0", kSix.bytes + "a"}})), "longer than 24"));
  EXPECT_TRUE(has(message(with({{"v/data.pkl", value}})), "2 entries data.pkl"));
  EXPECT_TRUE(has(message(zip_of({{"w/data/0", kSix.bytes}})), "0 entries data.pkl"));
  std::string twice = with({{"w/data/0", kSix.bytes}, {"w/data/1", kSix.bytes}});
  for (std::size_t at = 0; (at = twice.find("w/data/1", at)) != std::string::npos;)
    twice[at + 7] = '0';
  EXPECT_TRUE(has(message(twice), "twice"));
  std::string damaged = with({{"w/data/0", kSix.bytes}});
  damaged[damaged.find(kSix.bytes) + 5] ^= 1;
  EXPECT_TRUE(has(message(damaged), "'w/data/0': is damaged"));
}

TEST(BadCheckpoint, legacy_storages_that_lie_are_refused) {
  const std::string value = dict({{text("t"), tensor(kSix)}});
  Storage other = kSix;
  other.key = "5";
  EXPECT_TRUE(has(message(legacy_checkpoint(value, {other})), "'5': no value names it"));
  EXPECT_TRUE(has(message(legacy_checkpoint(value, {})), "'t': its storage is missing"));
  EXPECT_TRUE(has(message(legacy_checkpoint(value, {kSix, kSix})), "twice"));
  other = kSix;
  other.count = 5;
  EXPECT_TRUE(has(message(legacy_checkpoint(value, {other})), "length"));
  other = kSix;
  other.count = std::int64_t{1} << 50;
  const std::string huge = dict({{text("t"), tensor(reference(other), 0, {6}, {1})}});
  EXPECT_TRUE(has(message(legacy_checkpoint(huge, {other})), "truncated"));
  EXPECT_TRUE(has(message(huge, {kSix}), "'t': it needs far more memory"));
  const std::string both = dict({{text("t"), tensor(kSix)}, {text("u"), tensor(other)}});
  EXPECT_TRUE(has(message(legacy_checkpoint(both, {kSix})), "two lengths"));
}

TEST(BadCheckpoint, other_files_are_told_apart) {
  EXPECT_TRUE(has(message(""), "no torch checkpoint"));
  EXPECT_TRUE(has(message("a photo"), "no torch checkpoint"));
  EXPECT_TRUE(has(message(std::string(257, 'a') + "ustar" + std::string(250, 'a')), "is a tar"));
  EXPECT_TRUE(has(message(pickle(dict({}))), "a pickle but no torch checkpoint"));
  EXPECT_TRUE(has(message(legacy_checkpoint("N", {})), "holds no tensors"));
  std::string later = legacy_checkpoint(sample(), sample_storages());
  later[later.find(raw(1001))] = 1;
  EXPECT_TRUE(has(message(later), "version"));
  EXPECT_TRUE(is_torch_checkpoint(later));
  EXPECT_TRUE(is_torch_checkpoint(zip_checkpoint("N", {})));
  EXPECT_FALSE(is_torch_checkpoint(raw<std::uint64_t>(0x280) + "{"));  // begins as a pickle does
  EXPECT_FALSE(is_torch_checkpoint(raw<std::uint64_t>(0x04034b50) + "{"));  // or as a zip
  EXPECT_FALSE(is_torch_checkpoint(""));
}

}  // namespace
}  // namespace ps
