// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace ps {

/// @brief A value that a pickle describes. Calls and objects are described too: nothing is ever
/// looked up, made or called.
struct PickleValue {
  enum class Kind : std::uint8_t {
    none,
    boolean,
    integer,
    long_integer,  ///< of more than 64 bits
    real,          ///< its number is not kept
    text,
    bytes,
    tuple,
    list,
    set,
    dict,
    global,      ///< a class or a function, by name
    call,        ///< what a function or class would return
    object,      ///< what a class would make of arguments and state that are not kept
    persistent,  ///< something outside the pickle
  };

  Kind kind = Kind::none;
  std::int64_t integer = 0;  ///< of an integer or a boolean
  /// Of text and bytes; of a long integer, little-endian; of a global its name: "os.system".
  std::string_view text;
  /// tuple, list, set: the elements. dict: key, value, key, value, ... call: what is called, the
  /// tuple of arguments, and then keys and values as in a dict. persistent: the tuple that names
  /// it.
  std::vector<const PickleValue*> items;

  /// @return whether this is the result of calling the global of this name
  bool is_call_of(std::string_view global) const;
};

/// @brief A pickle (Python's pickle module, protocols 2 to 5), read by a machine that knows only
/// the instructions that plain values, and descriptions of objects, need.
class Pickle {
 public:
  /// @return whether a call of the global of this name may stand in the pickle, as a description
  using KnownCall = bool (*)(std::string_view global);

  /// @brief Reads one pickle, up to its STOP. Memory is in proportion to its bytes and bounded.
  /// Throws ps::Error, with the offset in `bytes`, on an instruction that is not known, a call that
  /// is not known, and whatever the machine cannot do.
  /// @param bytes  must outlive this: texts point into them
  /// @param begin  where in `bytes` the pickle begins
  /// @param where  the file, for messages
  Pickle(std::string_view bytes, std::size_t begin, const std::string& where, KnownCall known_call);
  Pickle(const Pickle&) = delete;
  Pickle& operator=(const Pickle&) = delete;

  const PickleValue& root() const { return *root_; }
  std::size_t end() const { return end_; }  ///< offset of the byte after STOP
  /// All values of kind persistent, wherever they ended up.
  const std::vector<const PickleValue*>& persistent() const { return persistent_; }

 private:
  friend class PickleMachine;

  std::deque<PickleValue> values_;  // values point at each other, in circles too; none owns another
  std::deque<std::string> names_;
  std::vector<const PickleValue*> persistent_;
  const PickleValue* root_ = nullptr;
  std::size_t end_ = 0;
};

}  // namespace ps
