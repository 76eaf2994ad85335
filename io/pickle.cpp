// SPDX-License-Identifier: BSD-3-Clause
#include "io/pickle.h"

#include <array>

#include "io/pickle_machine.h"

namespace ps {
namespace {

using Kind = PickleValue::Kind;
using Machine = PickleMachine;

constexpr std::size_t kMostInstructions = 4'000'000;  // a large network has 100,000
constexpr int kLatestProtocol = 5;
constexpr unsigned char kStop = '.';

struct Instruction {
  unsigned char byte;
  const char* name;
  void (*run)(Machine& m);  ///< null: refused
};

void protocol(Machine& m) {
  if (m.take<std::uint8_t>() > kLatestProtocol) m.fail("is of an unknown protocol");
}

void global(Machine& m) {
  const std::string_view module = m.take_line();
  m.push_global(module, m.take_line());
}

/// All of Python's pickletools but STOP. clang-format would spread each over three lines.
// clang-format off
constexpr Instruction kInstructions[] = {
    {0x80, "PROTO", protocol},
    {0x95, "FRAME", [](Machine& m) { m.take_bytes(8); }},
    {'N', "NONE", [](Machine& m) { m.push_none(); }},
    {0x88, "NEWTRUE", [](Machine& m) { m.push_boolean(true); }},
    {0x89, "NEWFALSE", [](Machine& m) { m.push_boolean(false); }},
    {'J', "BININT", [](Machine& m) { m.push_integer(m.take<std::int32_t>()); }},
    {'K', "BININT1", [](Machine& m) { m.push_integer(m.take<std::uint8_t>()); }},
    {'M', "BININT2", [](Machine& m) { m.push_integer(m.take<std::uint16_t>()); }},
    {0x8a, "LONG1", [](Machine& m) { m.push_long(m.take<std::uint8_t>()); }},
    {0x8b, "LONG4", [](Machine& m) { m.push_long(m.take_size()); }},
    {'G', "BINFLOAT", [](Machine& m) { m.take_bytes(8); m.push(Kind::real); }},
    {'X', "BINUNICODE", [](Machine& m) { m.push_text(Kind::text, m.take<std::uint32_t>()); }},
    {0x8c, "SHORT_BINUNICODE", [](Machine& m) { m.push_text(Kind::text, m.take<std::uint8_t>()); }},
    {0x8d, "BINUNICODE8", [](Machine& m) { m.push_text(Kind::text, m.take<std::uint64_t>()); }},
    {'T', "BINSTRING", [](Machine& m) { m.push_text(Kind::text, m.take_size()); }},
    {'U', "SHORT_BINSTRING", [](Machine& m) { m.push_text(Kind::text, m.take<std::uint8_t>()); }},
    {'B', "BINBYTES", [](Machine& m) { m.push_text(Kind::bytes, m.take<std::uint32_t>()); }},
    {'C', "SHORT_BINBYTES", [](Machine& m) { m.push_text(Kind::bytes, m.take<std::uint8_t>()); }},
    {0x8e, "BINBYTES8", [](Machine& m) { m.push_text(Kind::bytes, m.take<std::uint64_t>()); }},
    {'(', "MARK", [](Machine& m) { m.mark(); }},
    {')', "EMPTY_TUPLE", [](Machine& m) { m.push_empty_tuple(); }},
    {'t', "TUPLE", [](Machine& m) { m.push_items(Kind::tuple, m.pop_to_mark()); }},
    {0x85, "TUPLE1", [](Machine& m) { m.push_items(Kind::tuple, m.pop(1)); }},
    {0x86, "TUPLE2", [](Machine& m) { m.push_items(Kind::tuple, m.pop(2)); }},
    {0x87, "TUPLE3", [](Machine& m) { m.push_items(Kind::tuple, m.pop(3)); }},
    {']', "EMPTY_LIST", [](Machine& m) { m.push(Kind::list); }},
    {'a', "APPEND", [](Machine& m) { m.add(Kind::list, m.pop(1)); }},
    {'e', "APPENDS", [](Machine& m) { m.add(Kind::list, m.pop_to_mark()); }},
    {'}', "EMPTY_DICT", [](Machine& m) { m.push(Kind::dict); }},
    {'s', "SETITEM", [](Machine& m) { m.add(Kind::dict, m.pop(2)); }},
    {'u', "SETITEMS", [](Machine& m) { m.add(Kind::dict, m.pop_to_mark()); }},
    {0x8f, "EMPTY_SET", [](Machine& m) { m.push(Kind::set); }},
    {0x90, "ADDITEMS", [](Machine& m) { m.add(Kind::set, m.pop_to_mark()); }},
    {0x91, "FROZENSET", [](Machine& m) { m.push_items(Kind::set, m.pop_to_mark()); }},
    {'q', "BINPUT", [](Machine& m) { m.put(m.take<std::uint8_t>()); }},
    {'r', "LONG_BINPUT", [](Machine& m) { m.put(m.take<std::uint32_t>()); }},
    {0x94, "MEMOIZE", [](Machine& m) { m.put_next(); }},
    {'h', "BINGET", [](Machine& m) { m.get(m.take<std::uint8_t>()); }},
    {'j', "LONG_BINGET", [](Machine& m) { m.get(m.take<std::uint32_t>()); }},
    {'c', "GLOBAL", global},
    {0x93, "STACK_GLOBAL", [](Machine& m) { m.push_stack_global(); }},
    {'R', "REDUCE", [](Machine& m) { m.call(); }},
    {'b', "BUILD", [](Machine& m) { m.set_state(); }},
    {0x81, "NEWOBJ", [](Machine& m) { m.make_object(1); }},
    {0x92, "NEWOBJ_EX", [](Machine& m) { m.make_object(2); }},
    {'Q', "BINPERSID", [](Machine& m) { m.push_persistent(); }},
    // Text of protocol 0, what no pickler writes for plain values, and what reaches outside.
    {'0', "POP", nullptr}, {'1', "POP_MARK", nullptr}, {'2', "DUP", nullptr},
    {'F', "FLOAT", nullptr}, {'I', "INT", nullptr}, {'L', "LONG", nullptr},
    {'S', "STRING", nullptr}, {'V', "UNICODE", nullptr}, {'d', "DICT", nullptr},
    {'l', "LIST", nullptr}, {'g', "GET", nullptr}, {'p', "PUT", nullptr},
    {'P', "PERSID", nullptr}, {'i', "INST", nullptr}, {'o', "OBJ", nullptr},
    {0x82, "EXT1", nullptr}, {0x83, "EXT2", nullptr}, {0x84, "EXT4", nullptr},
    {0x96, "BYTEARRAY8", nullptr}, {0x97, "NEXT_BUFFER", nullptr},
    {0x98, "READONLY_BUFFER", nullptr},
};
// clang-format on

/// The instructions by their bytes; null where there is none.
constexpr std::array<const Instruction*, 256> by_byte() {
  std::array<const Instruction*, 256> table{};
  for (const Instruction& instruction : kInstructions) table[instruction.byte] = &instruction;
  return table;
}

void run(Machine& machine) {
  static constexpr std::array<const Instruction*, 256> kTable = by_byte();
  for (std::size_t count = 0;; ++count) {
    const unsigned char byte = machine.next_instruction();
    if (byte == kStop) return machine.stop();
    if (count == kMostInstructions) {
      machine.fail("has more than " + std::to_string(kMostInstructions) + " instructions");
    }
    const Instruction* const instruction = kTable[byte];
    if (instruction == nullptr) machine.refuse("number " + std::to_string(byte));
    if (instruction->run == nullptr) machine.refuse(instruction->name);
    instruction->run(machine);
  }
}

}  // namespace

bool PickleValue::is_call_of(std::string_view global) const {
  return kind == Kind::call && items[0]->text == global;
}

Pickle::Pickle(std::string_view bytes, std::size_t begin, const std::string& where,
               KnownCall known_call) {
  PickleMachine machine(bytes, begin, where, known_call, *this);
  run(machine);
}

}  // namespace ps
