// SPDX-License-Identifier: BSD-3-Clause
#include "io/torch_checkpoint.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "io/bytes.h"
#include "io/pickle.h"
#include "io/text.h"
#include "io/torch_tensor.h"
#include "io/torch_values.h"
#include "io/zip_archive.h"

namespace ps {
namespace {

using Kind = PickleValue::Kind;

constexpr std::string_view kZipMagic("PK\3\4", 4);
constexpr std::string_view kTarMagic("ustar");
constexpr std::size_t kTarMagicAt = 257;
constexpr char kPickleMagic = '\x80';
constexpr std::size_t kLongestPickle = std::size_t{64} << 20;
constexpr std::string_view kLegacyMagic("\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19", 10);
constexpr std::int64_t kLegacyVersion = 1001;

bool is_tar(std::string_view bytes) {
  return bytes.size() >= kTarMagicAt + kTarMagic.size() &&
         bytes.substr(kTarMagicAt, kTarMagic.size()) == kTarMagic;
}

/// @brief Bytes that may still be unpacked or copied. Tensors may share a storage and a view may
/// repeat it, and zeros deflate well: a little file could ask for any amount of memory.
class Budget {
 public:
  explicit Budget(std::size_t file_size)
      : left_((std::size_t{64} << 20) + std::min(file_size, kMostFile) * 16) {}

  void take(std::size_t bytes, const std::string& where) {
    if (bytes > left_) throw Error(where, "it needs far more memory than the file has bytes");
    left_ -= bytes;
  }

 private:
  static constexpr std::size_t kMostFile = std::size_t{1} << 58;
  std::size_t left_;
};

/// @return the bytes of a storage, which may lie in `buffer`
using Fetch = std::function<std::string_view(const TorchStorage&, const std::string& where,
                                             std::string& buffer)>;

struct Wanted {
  std::string name;
  std::string where;
  TorchTensor tensor;
};

/// Storage by storage, so that only one is unpacked at a time.
TensorMap gather_all(std::vector<Wanted> wanted, Budget& budget, bool swap, const Fetch& fetch) {
  std::stable_sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) {
    return a.tensor.storage.key < b.tensor.storage.key;
  });
  TensorMap tensors;
  std::string buffer;
  std::string_view bytes;
  const TorchStorage* held = nullptr;
  for (const Wanted& w : wanted) {
    const TorchStorage& storage = w.tensor.storage;
    if (held == nullptr || held->key != storage.key || held->bytes() != storage.bytes()) {
      budget.take(storage.bytes(), w.where);
      bytes = fetch(storage, w.where, buffer);
      held = &storage;
    }
    budget.take(w.tensor.bytes(), w.where);
    if (!tensors.emplace(w.name, gather(w.tensor, bytes, swap)).second) {
      throw Error(w.where, "it is there twice", "it once");
    }
  }
  return tensors;
}

TensorMap tensors_of(const Pickle& pickle, std::size_t file_size, bool swap,
                     const std::string& name, const Fetch& fetch) {
  std::vector<Wanted> wanted;
  for (const auto& [path, value] : find_tensors(pickle.root(), name)) {
    const std::string where = name + ", tensor " + in_quotes(path, kLongestTensorName);
    wanted.push_back({path, where, torch_tensor(*value, where)});
  }
  if (wanted.empty()) throw Error(name, "holds no tensors", "a checkpoint with a state dict");
  Budget budget(file_size);
  return gather_all(std::move(wanted), budget, swap, fetch);
}

// The zip container (torch 1.6 and later): NAME/data.pkl, NAME/data/KEY, NAME/byteorder.

/// @return the entries' folder, with its slash
std::string folder_of(const ZipArchive& zip, const std::string& name) {
  constexpr std::string_view kPickle = "data.pkl";
  std::vector<std::string> folders;
  for (const auto& [entry, index] : zip.entries()) {
    const std::size_t slash = entry.rfind('/');
    const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
    if (entry.substr(begin) == kPickle) folders.push_back(entry.substr(0, begin));
  }
  if (folders.size() == 1) return folders.front();
  throw Error(name, "the archive has " + std::to_string(folders.size()) + " entries data.pkl",
              "one, as torch.save writes");
}

TensorMap parse_zip(std::string_view bytes, const std::string& name) {
  const ZipArchive zip(bytes, name);
  const std::string folder = folder_of(zip, name);
  const std::string pickled = zip.read(folder + "data.pkl", kLongestPickle);
  const std::string order =
      zip.has(folder + "byteorder") ? zip.read(folder + "byteorder", 16) : "little";
  if (order != "little" && order != "big") {
    throw Error(name, "its byte order is " + in_quotes(order), "little or big");
  }
  const Pickle pickle(pickled, 0, name + ", data.pkl", is_torch_call);
  const auto fetch = [&](const TorchStorage& storage, const std::string& where,
                         std::string& buffer) -> std::string_view {
    buffer = zip.read(folder + "data/" + std::string(storage.key), storage.bytes());
    if (buffer.size() == storage.bytes()) return buffer;
    throw Error(where, "its storage has " + std::to_string(buffer.size()) + " bytes",
                std::to_string(storage.bytes()));
  };
  return tensors_of(pickle, bytes.size(), order == "big", name, fetch);
}

// The legacy container: pickles of a magic number, a version, the machine's properties, the values
// and the storages' keys; then for each key a count (64 bits) and so many numbers, little-endian.

using Storages = std::map<std::string_view, std::string_view>;

/// The storages that the values name, wherever they do: all must be known, to pass over the bytes.
std::map<std::string_view, TorchStorage> named_storages(const Pickle& values,
                                                        const std::string& name) {
  std::map<std::string_view, TorchStorage> named;
  for (const PickleValue* value : values.persistent()) {
    if (!is_torch_storage(*value)) continue;
    const TorchStorage storage = torch_storage(*value, name);
    const auto [place, added] = named.emplace(storage.key, storage);
    if (!added && place->second.bytes() != storage.bytes()) {
      throw Error(name, "storage " + in_quotes(storage.key) + " has two lengths", "one");
    }
  }
  return named;
}

Storages cut_storages(std::string_view bytes, const Pickle& values, const Pickle& keys,
                      const std::string& name) {
  const std::map<std::string_view, TorchStorage> named = named_storages(values, name);
  Storages storages;
  if (keys.root().kind != Kind::list) throw Error(name, "its storages have no list of keys");
  std::string_view rest = bytes.substr(keys.end());
  for (const PickleValue* key : keys.root().items) {
    const std::string where = name + ", storage " + in_quotes(key->text);
    const auto found = named.find(key->text);
    if (found == named.end()) throw Error(where, "no value names it", "a storage of a tensor");
    const std::size_t size = found->second.bytes();
    if (rest.size() < sizeof(std::uint64_t) || rest.size() - sizeof(std::uint64_t) < size) {
      throw Error(where, "the file is truncated", std::to_string(size) + " bytes of numbers");
    }
    if (load<std::uint64_t>(rest.data()) != found->second.count) {
      throw Error(where, "its length is not what tensors say",
                  std::to_string(found->second.count) + " numbers");
    }
    rest.remove_prefix(sizeof(std::uint64_t));
    if (!storages.emplace(key->text, rest.substr(0, size)).second) {
      throw Error(where, "it is there twice", "it once");
    }
    rest.remove_prefix(size);
  }
  return storages;
}

TensorMap parse_legacy(std::string_view bytes, const std::string& name) {
  const Pickle magic(bytes, 0, name, is_torch_call);
  if (magic.root().kind != Kind::long_integer || magic.root().text != kLegacyMagic) {
    throw Error(name, "is a pickle but no torch checkpoint", "a file that torch.save wrote");
  }
  const Pickle version(bytes, magic.end(), name, is_torch_call);
  if (version.root().kind != Kind::integer || version.root().integer != kLegacyVersion) {
    throw Error(name, "is a torch checkpoint of an unknown version", "1001");
  }
  const Pickle machine(bytes, version.end(), name, is_torch_call);
  const Pickle values(bytes, machine.end(), name, is_torch_call);
  const Pickle keys(bytes, values.end(), name, is_torch_call);
  const Storages storages = cut_storages(bytes, values, keys, name);
  const auto fetch = [&](const TorchStorage& storage, const std::string& where, std::string&) {
    const auto found = storages.find(storage.key);
    if (found != storages.end()) return found->second;
    throw Error(where, "its storage is missing", "the numbers of " + in_quotes(storage.key));
  };
  return tensors_of(values, bytes.size(), false, name, fetch);
}

}  // namespace

bool is_torch_checkpoint(std::string_view head) {
  const bool safetensors = head.size() > 8 && head[8] == '{';
  return !safetensors && (head.substr(0, kZipMagic.size()) == kZipMagic || is_tar(head) ||
                          (!head.empty() && head[0] == kPickleMagic));
}

TensorMap parse_torch_checkpoint(std::string_view bytes, const std::string& name) {
  return guarded(name, [&] {
    if (bytes.substr(0, kZipMagic.size()) == kZipMagic) return parse_zip(bytes, name);
    if (!bytes.empty() && bytes[0] == kPickleMagic) return parse_legacy(bytes, name);
    if (is_tar(bytes)) {
      throw Error(name, "is a tar, as torch before 0.1.10 wrote them",
                  "a checkpoint that a later torch saved");
    }
    throw Error(name, "is no torch checkpoint", "a zip archive or pickles, as torch.save writes");
  });
}

TensorMap read_torch_checkpoint(const std::filesystem::path& path) {
  return guarded(path.string(), [&] {
    const FileBytes file(path);
    return parse_torch_checkpoint(file.view(), path.string());
  });
}

}  // namespace ps
