// SPDX-License-Identifier: BSD-3-Clause
#include "io/torch_tensor.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "io/text.h"
#include "libps/core/error.h"

namespace ps {
namespace {

using Kind = PickleValue::Kind;

constexpr std::size_t kMostAxes = 64;  // torch's own limit
constexpr std::size_t kMostNumbers = std::size_t{1}
                                     << 56;  // so that sums and bytes cannot overflow
constexpr std::string_view kTensor = "torch._utils._rebuild_tensor_v2";
constexpr std::string_view kOldTensor = "torch._utils._rebuild_tensor";
constexpr std::string_view kParameter = "torch._utils._rebuild_parameter";

/// What calls may stand in a checkpoint: of tensors, and of plain values in options beside them.
constexpr std::string_view kCalls[] = {
    kTensor,
    kOldTensor,
    kParameter,
    "torch.Size",
    "torch.device",
    "torch.serialization._get_layout",
    "collections.OrderedDict",
    "collections.defaultdict",
    "collections.Counter",
    "collections.deque",
    "copy_reg._reconstructor",
    "copyreg._reconstructor",
    "_codecs.encode",
    "__builtin__.set",
    "__builtin__.frozenset",
    "__builtin__.bytearray",
    "__builtin__.complex",
    "__builtin__.slice",
    "__builtin__.xrange",
    "builtins.set",
    "builtins.frozenset",
    "builtins.bytearray",
    "builtins.complex",
    "builtins.slice",
    "builtins.range",
    "datetime.date",
    "datetime.datetime",
    "datetime.timedelta",
    "numpy.dtype",
    "numpy.core.multiarray.scalar",
    "numpy.core.multiarray._reconstruct",
    "numpy._core.multiarray.scalar",
    "numpy._core.multiarray._reconstruct",
    "pathlib.PosixPath",
    "pathlib.PurePosixPath",
    "pathlib.WindowsPath",
    "pathlib.PureWindowsPath",
    "types.SimpleNamespace",
};

struct StorageType {
  std::string_view global;
  std::string_view dtype;
  std::size_t element;
};

constexpr StorageType kStorageTypes[] = {
    {"torch.FloatStorage", "F32", 4},     {"torch.HalfStorage", "F16", 2},
    {"torch.BFloat16Storage", "BF16", 2}, {"torch.DoubleStorage", "F64", 8},
    {"torch.LongStorage", "I64", 8},      {"torch.IntStorage", "I32", 4},
    {"torch.ShortStorage", "I16", 2},     {"torch.CharStorage", "I8", 1},
    {"torch.ByteStorage", "U8", 1},       {"torch.BoolStorage", "BOOL", 1},
};

/// @return a count, offset, size or stride
std::size_t to_count(const PickleValue& value, const char* what, const std::string& where) {
  const auto number = static_cast<std::size_t>(value.integer);
  if (value.kind != Kind::integer || value.integer < 0 || number > kMostNumbers) {
    throw Error(where, std::string(what) + " is unsound", "a number from 0 to 2^56");
  }
  return number;
}

std::vector<std::size_t> to_counts(const PickleValue& value, const char* what,
                                   const std::string& where) {
  if (value.kind != Kind::tuple || value.items.size() > kMostAxes) {
    throw Error(where, std::string(what) + " is unsound", "a tuple of up to 64 numbers");
  }
  std::vector<std::size_t> counts;
  for (const PickleValue* item : value.items) counts.push_back(to_count(*item, what, where));
  return counts;
}

const StorageType& storage_type(const PickleValue& global, const std::string& where) {
  const auto type = std::find_if(std::begin(kStorageTypes), std::end(kStorageTypes),
                                 [&](const StorageType& t) { return t.global == global.text; });
  if (global.kind == Kind::global && type != std::end(kStorageTypes)) return *type;
  throw Error(where, "a storage's type " + in_quotes(global.text) + " is not read",
              "torch.FloatStorage, HalfStorage, BFloat16Storage, LongStorage, ...");
}

/// The number of elements; throws when one of them lies outside the storage's part.
std::size_t checked_count(const TorchTensor& t, std::size_t offset, const std::string& where) {
  std::size_t count = 1, last = offset;
  for (std::size_t axis = 0; axis < t.shape.size(); ++axis) {
    if (t.shape[axis] == 0) return 0;
  }
  for (std::size_t axis = 0; axis < t.shape.size(); ++axis) {
    const std::size_t steps = t.shape[axis] - 1, stride = t.strides[axis];
    if (stride != 0 && steps > kMostNumbers / stride) last = kMostNumbers;
    last = std::min(kMostNumbers, last + std::min(kMostNumbers, steps * stride));
    if (count > kMostNumbers / t.shape[axis]) throw Error(where, "it has too many elements");
    count *= t.shape[axis];
  }
  if (last < t.storage.part) return count;
  throw Error(where, "it reaches outside its storage",
              "a view of " + std::to_string(t.storage.part) + " numbers");
}

/// Whether the elements lie in the storage in their order, without gaps.
bool is_contiguous(const TorchTensor& tensor) {
  std::size_t expected = 1;
  for (std::size_t axis = tensor.shape.size(); axis-- > 0;) {
    if (tensor.shape[axis] == 1) continue;
    if (tensor.strides[axis] != expected) return false;
    expected *= tensor.shape[axis];
  }
  return true;
}

/// Calls `visit` with the place in the storage of each element, in order.
template <class Visit>
void for_each_place(const TorchTensor& tensor, Visit visit) {
  std::vector<std::size_t> index(tensor.shape.size(), 0);
  std::size_t place = tensor.first;
  for (std::size_t i = 0; i < tensor.count; ++i) {
    visit(i, place);
    for (std::size_t axis = index.size(); axis-- > 0;) {
      place += tensor.strides[axis];
      if (++index[axis] < tensor.shape[axis]) break;
      place -= tensor.strides[axis] * tensor.shape[axis];
      index[axis] = 0;
    }
  }
}

}  // namespace

bool is_torch_call(std::string_view global) {
  return std::find(std::begin(kCalls), std::end(kCalls), global) != std::end(kCalls);
}

bool is_torch_storage(const PickleValue& persistent) {
  const PickleValue& id = *persistent.items[0];
  return id.kind == Kind::tuple && !id.items.empty() && id.items[0]->text == "storage";
}

TorchStorage torch_storage(const PickleValue& persistent, const std::string& where) {
  // ("storage", type, key, device, count); of a legacy pickle also (key, first, count) or None of a
  // part.
  const auto& id = persistent.items[0]->items;
  if (!is_torch_storage(persistent) || id.size() < 5 || id.size() > 6 ||
      id[2]->kind != Kind::text) {
    throw Error(where, "it names something that is no storage", "one of torch");
  }
  const StorageType& type = storage_type(*id[1], where);
  TorchStorage storage{id[2]->text, type.dtype, type.element, 0, 0, 0};
  storage.count = storage.part = to_count(*id[4], "a storage's length", where);
  if (id.size() == 5 || id[5]->kind == Kind::none) return storage;
  const auto& part = id[5]->items;
  if (id[5]->kind != Kind::tuple || part.size() != 3) {
    throw Error(where, "a storage's part is unsound", "its key, offset and length");
  }
  storage.first = to_count(*part[1], "a storage's offset", where);
  storage.part = to_count(*part[2], "a storage's length", where);
  if (storage.first > storage.count || storage.part > storage.count - storage.first) {
    throw Error(where, "a storage's part reaches outside it", "a part of it");
  }
  return storage;
}

bool is_torch_tensor(const PickleValue& value) {
  return value.is_call_of(kTensor) || value.is_call_of(kOldTensor) || value.is_call_of(kParameter);
}

TorchTensor torch_tensor(const PickleValue& value, const std::string& where) {
  const PickleValue* made = &value;  // a parameter is made of a tensor
  while (made->is_call_of(kParameter) && !made->items[1]->items.empty()) {
    made = made->items[1]->items[0];
  }
  const auto* const arguments =
      made->is_call_of(kTensor) || made->is_call_of(kOldTensor) ? &made->items[1]->items : nullptr;
  if (arguments == nullptr || arguments->size() < 4 || (*arguments)[0]->kind != Kind::persistent) {
    throw Error(where, "it is made of something else than a storage",
                "storage, offset, shape and strides");
  }
  TorchTensor tensor;
  tensor.storage = torch_storage(*(*arguments)[0], where);
  const std::size_t offset = to_count(*(*arguments)[1], "its offset", where);
  tensor.shape = to_counts(*(*arguments)[2], "its shape", where);
  tensor.strides = to_counts(*(*arguments)[3], "its strides", where);
  if (tensor.shape.size() != tensor.strides.size()) {
    throw Error(where, "its strides do not fit its shape", "one for each axis");
  }
  tensor.count = checked_count(tensor, offset, where);
  tensor.first = tensor.storage.first + offset;
  return tensor;
}

FileTensor gather(const TorchTensor& tensor, std::string_view storage, bool swap) {
  const std::size_t element = tensor.storage.element;
  FileTensor out{std::string(tensor.storage.dtype), tensor.shape, {}};
  out.bytes.resize(tensor.bytes());
  if (tensor.count == 0) return out;
  if (is_contiguous(tensor)) {
    std::memcpy(out.bytes.data(), &storage[tensor.first * element], out.bytes.size());
  } else {
    for_each_place(tensor, [&](std::size_t i, std::size_t place) {
      std::memcpy(&out.bytes[i * element], &storage[place * element], element);
    });
  }
  for (std::size_t i = 0; swap && i < out.bytes.size(); i += element) {
    std::reverse(&out.bytes[i], &out.bytes[i] + element);
  }
  return out;
}

}  // namespace ps
