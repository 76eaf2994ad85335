// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zip.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "io/torch_checkpoint.h"
#include "tests/io/support.h"

/// Pickles and checkpoints, made byte by byte: each function gives the instructions that leave one
/// value on the stack.
namespace ps::maker {

using Parts = std::vector<std::string>;
using Pairs = std::vector<std::pair<std::string, std::string>>;

inline std::string joined(const Parts& parts) {
  std::string all;
  for (const std::string& part : parts) all += part;
  return all;
}

inline std::string text(const std::string& value) {
  return "X" + raw(static_cast<std::uint32_t>(value.size())) + value;
}

inline std::string number(std::int64_t value) {
  if (value >= INT32_MIN && value <= INT32_MAX) return "J" + raw(static_cast<std::int32_t>(value));
  return "\x8a\x08" + raw(value);
}

inline std::string tuple(const Parts& items) { return "(" + joined(items) + "t"; }
inline std::string list(const Parts& items) { return "](" + joined(items) + "e"; }

inline std::string items(const Pairs& pairs) {
  std::string all = "(";
  for (const auto& [key, value] : pairs) all += key + value;
  return all + "u";
}

inline std::string dict(const Pairs& pairs) { return "}" + items(pairs); }

inline std::string numbers(const std::vector<std::int64_t>& values) {
  Parts parts;
  for (const std::int64_t value : values) parts.push_back(number(value));
  return tuple(parts);
}

inline std::string global(const std::string& module, const std::string& name) {
  return "c" + module + "\n" + name + "\n";
}

inline std::string call(const std::string& global, const std::string& arguments) {
  return global + arguments + "R";
}

inline std::string ordered_dict(const Pairs& pairs) {
  return call(global("collections", "OrderedDict"), ")") + items(pairs);
}

/// Leaves the value on the stack and remembers it; remembered() gives it again.
inline std::string put(char index, const std::string& value) { return value + "q" + index; }
inline std::string remembered(char index) { return std::string("h") + index; }

inline std::string pickle(const std::string& value, char protocol = 2) {
  return std::string("\x80") + protocol + value + ".";
}

/// One run of numbers.
struct Storage {
  std::string key;
  std::string type;  ///< "FloatStorage"
  std::int64_t count = 0;
  std::string bytes;
};

inline Storage floats(const std::string& key, const std::vector<float>& values) {
  Storage storage{key, "FloatStorage", static_cast<std::int64_t>(values.size()), ""};
  for (const float value : values) storage.bytes += raw(value);
  return storage;
}

/// @param part  what a legacy pickle says besides: the key, offset and length of a part, or None
inline std::string reference(const Storage& s, const std::string& part = "") {
  return tuple({text("storage"), global("torch", s.type), text(s.key), text("cpu"), number(s.count),
                part}) +
         "Q";
}

/// @param storage  as reference() gives it
inline std::string tensor(const std::string& storage, std::int64_t offset,
                          const std::vector<std::int64_t>& shape,
                          const std::vector<std::int64_t>& strides) {
  return call(
      global("torch._utils", "_rebuild_tensor_v2"),
      tuple({storage, number(offset), numbers(shape), numbers(strides), "\x89", ordered_dict({})}));
}

/// A whole storage as a tensor with one axis.
inline std::string tensor(const Storage& s) { return tensor(reference(s), 0, {s.count}, {1}); }

using Entries = std::vector<std::pair<std::string, std::string>>;

inline std::string zip_of(const Entries& entries, bool deflated = false) {
  const Folder folder;
  zip_t* const archive = zip_open((folder / "a.zip").c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, content] : entries) {
    zip_source_t* const source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, 0);
    EXPECT_GE(index, 0);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index),
                             deflated ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  return bytes_of(folder / "a.zip");
}

inline std::string zip_checkpoint(const std::string& value, const std::vector<Storage>& storages,
                                  bool deflated = false, char protocol = 2) {
  Entries entries{{"w/data.pkl", pickle(value, protocol)}};
  for (const Storage& s : storages) entries.emplace_back("w/data/" + s.key, s.bytes);
  entries.emplace_back("w/version", "3\n");
  return zip_of(entries, deflated);
}

inline std::string legacy_checkpoint(const std::string& value, const std::vector<Storage>& storages,
                                     char protocol = 2) {
  const std::string magic = "\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19";
  Parts keys;
  for (const Storage& s : storages) keys.push_back(text(s.key));
  std::string bytes = pickle(magic, protocol) + pickle(number(1001), protocol) +
                      pickle(dict({{text("little_endian"), "\x88"}}), protocol) +
                      pickle(value, protocol) + pickle(list(keys), protocol);
  for (const Storage& s : storages) bytes += raw(s.count) + s.bytes;
  return bytes;
}

inline const Storage kSix = floats("0", {0, 1, 2, 3, 4, 5});

/// A tensor of six numbers, a scalar of another storage, and options beside.
inline std::string sample() {
  const Storage counter{"1", "LongStorage", 1, raw<std::int64_t>(7)};
  return dict({{text("state_dict"),
                ordered_dict({{text("a.weight"), tensor(reference(kSix), 0, {2, 3}, {3, 1})},
                              {text("a.count"), tensor(reference(counter), 0, {}, {})}})},
               {text("epoch"), number(150)},
               {text("opts"), dict({{text("W"), number(256)}, {text("l1"), "G" + raw(1.0)}})}});
}

inline std::vector<Storage> sample_storages() {
  return {kSix, {"1", "LongStorage", 1, raw<std::int64_t>(7)}};
}

/// Reads what was made, as the file w.pth; or the one line of what is wrong with it.
inline TensorMap parse(const std::string& bytes) { return parse_torch_checkpoint(bytes, "w.pth"); }

inline TensorMap parse(const std::string& value, const std::vector<Storage>& storages) {
  return parse(zip_checkpoint(value, storages));
}

inline std::string message(const std::string& value, const std::vector<Storage>& storages) {
  return error_of([&] { parse(value, storages); });
}

inline std::string message(const std::string& bytes) {
  return error_of([&] { parse(bytes); });
}

}  // namespace ps::maker
