// SPDX-License-Identifier: BSD-3-Clause
#include "io/torch_values.h"

#include "io/text.h"
#include "io/torch_tensor.h"
#include "libps/core/error.h"

namespace ps {
namespace {

using Kind = PickleValue::Kind;
using Entry = std::pair<const PickleValue*, const PickleValue*>;

constexpr int kDeepest = 64;
constexpr std::size_t kMostTensors = 100'000;
constexpr std::size_t kMostVisits = 1'000'000;  // shared values are met more than once

void append_pairs(const std::vector<const PickleValue*>& items, std::size_t first,
                  std::vector<Entry>& entries) {
  for (std::size_t i = first; i + 1 < items.size(); i += 2) {
    entries.emplace_back(items[i], items[i + 1]);
  }
}

bool is_sequence(const PickleValue& value) {
  return value.kind == Kind::list || value.kind == Kind::tuple;
}

bool is_dict(const PickleValue& value) {
  return value.kind == Kind::dict || value.is_call_of("collections.OrderedDict") ||
         value.is_call_of("collections.defaultdict");
}

/// Keys and values of a dict. Python 2 made an OrderedDict of a list of lists of two.
std::vector<Entry> entries_of(const PickleValue& dict) {
  std::vector<Entry> entries;
  if (dict.kind == Kind::dict) {
    append_pairs(dict.items, 0, entries);
    return entries;
  }
  const auto& arguments = dict.items[1]->items;
  if (!arguments.empty() && is_sequence(*arguments[0])) {
    for (const PickleValue* pair : arguments[0]->items) {
      if (is_sequence(*pair) && pair->items.size() == 2) append_pairs(pair->items, 0, entries);
    }
  }
  append_pairs(dict.items, 2, entries);
  return entries;
}

class Finder {
 public:
  explicit Finder(const std::string& where) : where_(where) {}

  void visit(const PickleValue& value, const std::string& path, int depth) {
    if (is_torch_tensor(value)) found.emplace_back(path.empty() ? "tensor" : path, &value);
    if (found.size() > kMostTensors) throw Error(where_, "has too many tensors", "fewer");
    if (!is_sequence(value) && !is_dict(value)) return;
    if (depth == kDeepest) throw Error(where_, "its values nest too deep", "no more than 64 deep");
    if (is_sequence(value)) {
      for (std::size_t i = 0; i < value.items.size(); ++i) {
        enter(*value.items[i], path, std::to_string(i), depth);
      }
      return;
    }
    for (const auto& [key, child] : entries_of(value)) {
      if (key->kind == Kind::text) enter(*child, path, key->text, depth);
      if (key->kind == Kind::integer) enter(*child, path, std::to_string(key->integer), depth);
    }
  }

  std::vector<std::pair<std::string, const PickleValue*>> found;

 private:
  void enter(const PickleValue& child, const std::string& path, std::string_view key, int depth) {
    if (++visits_ > kMostVisits) throw Error(where_, "has too many values", "fewer");
    if (!is_sequence(child) && !is_dict(child) && !is_torch_tensor(child)) return;
    if (path.size() + key.size() >= kLongestTensorName) {
      throw Error(where_, "the name " + in_quotes(key) + " is too long");
    }
    visit(child, path.empty() ? std::string(key) : path + "." + std::string(key), depth + 1);
  }

  const std::string& where_;
  std::size_t visits_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, const PickleValue*>> find_tensors(const PickleValue& root,
                                                                     const std::string& where) {
  const PickleValue* from = &root;
  for (const char* key : {"model_state_dict", "state_dict"}) {
    if (!is_dict(root)) break;
    for (const auto& [name, value] : entries_of(root)) {
      if (name->kind == Kind::text && name->text == key && is_dict(*value)) from = value;
    }
  }
  Finder finder(where);
  finder.visit(*from, "", 0);
  return std::move(finder.found);
}

}  // namespace ps
