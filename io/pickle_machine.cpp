// SPDX-License-Identifier: BSD-3-Clause
#include "io/pickle_machine.h"

#include "io/text.h"

namespace ps {
namespace {

constexpr std::size_t kLongestName = 255;

}  // namespace

PickleMachine::PickleMachine(std::string_view bytes, std::size_t begin, const std::string& where,
                             Pickle::KnownCall known_call, Pickle& out)
    : bytes_(bytes), next_(begin), where_(where), known_call_(known_call), out_(out) {
  none_ = make(Kind::none);
  true_ = make(Kind::boolean);
  true_->integer = 1;
  false_ = make(Kind::boolean);
  empty_tuple_ = make(Kind::tuple);
}

unsigned char PickleMachine::next_instruction() {
  at_ = next_;
  return take<unsigned char>();
}

void PickleMachine::stop() {
  if (stack_.size() != 1 || !marks_.empty()) fail("does not end with one value");
  out_.root_ = stack_.front();
  out_.end_ = next_;
}

void PickleMachine::fail(const std::string& what) const {
  throw Error(where_, "the pickle " + what + ", at byte " + std::to_string(at_));
}

void PickleMachine::refuse(const std::string& what) const {
  throw Error(where_, "pickle instruction " + what + ", at byte " + std::to_string(at_) +
                          ", is refused: no tensor needs it");
}

std::string_view PickleMachine::take_bytes(std::uint64_t count) {
  if (count > bytes_.size() - next_) fail("ends too early");
  const std::string_view taken = bytes_.substr(next_, count);
  next_ += taken.size();
  return taken;
}

std::uint64_t PickleMachine::take_size() {
  const auto size = take<std::int32_t>();
  if (size < 0) fail("has a negative size");
  return static_cast<std::uint64_t>(size);
}

std::string_view PickleMachine::take_line() {
  const std::size_t end = bytes_.substr(next_, kLongestName + 1).find('\n');
  if (end == std::string_view::npos) fail("has a name that does not end");
  return take_bytes(end + 1).substr(0, end);
}

void PickleMachine::push_long(std::uint64_t size) {
  if (size > sizeof(std::int64_t)) return push_text(Kind::long_integer, size);
  const std::string_view digits = take_bytes(size);
  const bool negative = !digits.empty() && (digits.back() & 0x80) != 0;
  std::uint64_t value = negative ? ~std::uint64_t{0} : 0;
  for (std::size_t i = digits.size(); i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(digits[i]);
  }
  push_integer(static_cast<std::int64_t>(value));
}

void PickleMachine::push_text(Kind kind, std::uint64_t size) {
  const std::string_view text = take_bytes(size);
  push(kind)->text = text;
}

PickleValue* PickleMachine::make(Kind kind) {
  PickleValue& value = out_.values_.emplace_back();
  value.kind = kind;
  return &value;
}

PickleValue* PickleMachine::push(Kind kind) {
  stack_.push_back(make(kind));
  return stack_.back();
}

PickleValue* PickleMachine::top() const {
  if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) {
    fail("takes a value that is not there");
  }
  return stack_.back();
}

PickleMachine::Items PickleMachine::pop(std::size_t count) {
  Items items(count);
  for (std::size_t i = count; i-- > 0;) {
    items[i] = top();
    stack_.pop_back();
  }
  return items;
}

PickleMachine::Items PickleMachine::pop_to_mark() {
  if (marks_.empty()) fail("takes a mark that is not there");
  const auto first = stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back());
  const Items items(first, stack_.end());
  stack_.erase(first, stack_.end());
  marks_.pop_back();
  return items;
}

void PickleMachine::add(Kind kind, const Items& items) {
  if (kind == Kind::dict && items.size() % 2 != 0) fail("has a key without a value");
  PickleValue* const target = top();
  const bool described = target->kind == Kind::call || target->kind == Kind::object;
  if (target->kind != kind && !described) fail("adds to a value of another kind");
  if (target->kind == kind || (target->kind == Kind::call && kind == Kind::dict)) {
    target->items.insert(target->items.end(), items.begin(), items.end());
  }
}

void PickleMachine::get(std::uint64_t index) {
  const auto found = memo_.find(index);
  if (found == memo_.end()) fail("gets a value that was never put");
  stack_.push_back(found->second);
}

void PickleMachine::push_global(std::string_view module, std::string_view name) {
  if (module.size() + name.size() >= kLongestName) fail("has a name that does not end");
  std::string& whole = out_.names_.emplace_back(module);
  whole += '.';
  whole += name;
  push(Kind::global)->text = whole;
}

void PickleMachine::push_stack_global() {
  const Items names = pop(2);
  if (names[0]->kind != Kind::text || names[1]->kind != Kind::text) {
    fail("has a name that is no text");
  }
  push_global(names[0]->text, names[1]->text);
}

void PickleMachine::call() {
  Items call = pop(2);
  if (call[0]->kind != Kind::global) fail("calls what has no name");
  if (call[1]->kind != Kind::tuple) fail("calls with arguments that are no tuple");
  if (!known_call_(call[0]->text)) refuse("REDUCE of " + in_quotes(call[0]->text));
  push_items(Kind::call, std::move(call));
}

void PickleMachine::make_object(std::size_t arguments) {
  if (pop(arguments + 1)[0]->kind != Kind::global) fail("makes an object of what is no class");
  push(Kind::object);
}

void PickleMachine::set_state() {
  pop(1);
  if (top()->kind != Kind::call && top()->kind != Kind::object) {
    fail("gives a state to what has none");
  }
}

void PickleMachine::push_persistent() {
  push_items(Kind::persistent, pop(1));
  out_.persistent_.push_back(top());
}

}  // namespace ps
