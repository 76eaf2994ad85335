// SPDX-License-Identifier: BSD-3-Clause
// Internal to the pickle reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/bytes.h"
#include "io/pickle.h"

namespace ps {

/// @brief What the instructions of a pickle work on: its bytes, a stack of descriptions with marks,
/// and a memo. Every member function throws ps::Error when it cannot do what it says.
class PickleMachine {
 public:
  using Kind = PickleValue::Kind;
  using Items = std::vector<const PickleValue*>;

  PickleMachine(std::string_view bytes, std::size_t begin, const std::string& where,
                Pickle::KnownCall known_call, Pickle& out);

  /// Begins an instruction: messages name its place. @return its byte
  unsigned char next_instruction();
  /// Hands the one value that is left, and the place, to the Pickle.
  void stop();

  [[noreturn]] void fail(const std::string& what) const;
  /// Refuses the instruction as a whole. @param what  "REDUCE", or with what it would do
  [[noreturn]] void refuse(const std::string& what) const;

  /// @return a number that the instruction carries
  template <class T>
  T take() {
    return load<T>(take_bytes(sizeof(T)).data());
  }
  std::uint64_t take_size();  ///< of 4 bytes, with a sign
  std::string_view take_bytes(std::uint64_t count);
  std::string_view take_line();

  void push_none() { stack_.push_back(none_); }
  void push_boolean(bool value) { stack_.push_back(value ? true_ : false_); }
  void push_integer(std::int64_t value) { push(Kind::integer)->integer = value; }
  void push_long(std::uint64_t size);  ///< takes `size` bytes: little-endian, two's complement
  void push_text(Kind kind, std::uint64_t size);  ///< takes `size` bytes
  void push_empty_tuple() { stack_.push_back(empty_tuple_); }
  void push_items(Kind kind, Items items) { push(kind)->items = std::move(items); }
  PickleValue* push(Kind kind);

  void mark() { marks_.push_back(stack_.size()); }
  Items pop(std::size_t count);
  Items pop_to_mark();

  /// Adds to what is on top of the stack: a container of this kind, or an object, where keys of a
  /// call are kept (an OrderedDict is made by a call) and all else is not.
  void add(Kind kind, const Items& items);

  void put(std::uint64_t index) { memo_[index] = top(); }
  void put_next() { put(memo_.size()); }
  void get(std::uint64_t index);

  void push_global(std::string_view module, std::string_view name);
  void push_stack_global();
  void call();
  void make_object(std::size_t arguments);  ///< of a class below so many arguments
  void set_state();
  void push_persistent();

 private:
  PickleValue* make(Kind kind);
  PickleValue* top() const;

  std::string_view bytes_;
  std::size_t next_;    // byte to be read
  std::size_t at_ = 0;  // byte where the instruction began
  const std::string& where_;
  Pickle::KnownCall known_call_;
  Pickle& out_;
  std::vector<PickleValue*> stack_;
  std::vector<std::size_t> marks_;  // the stack's size at each; nothing below the last is popped
  std::unordered_map<std::uint64_t, PickleValue*> memo_;
  PickleValue *none_, *true_, *false_, *empty_tuple_;  // made once, as they are never changed
};

}  // namespace ps
