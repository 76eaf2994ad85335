// SPDX-License-Identifier: BSD-3-Clause
#include "io/pickle.h"

#include <set>

#include "tests/io/checkpoint_maker.h"

namespace ps {
namespace {

using namespace maker;
using namespace std::string_literals;
using Kind = PickleValue::Kind;

bool only_sets(std::string_view global) { return global == "builtins.set"; }

/// Reads the instructions of one value and hands it to `look`.
template <class Look>
void read(const std::string& value, Look look, char protocol = 2) {
  const std::string bytes = pickle(value, protocol);
  const Pickle read(bytes, 0, "p", only_sets);
  EXPECT_EQ(read.end(), bytes.size());
  look(read.root());
}

std::string refusal(const std::string& value) {
  return error_of([&] { read(value, [](const PickleValue&) {}); });
}

TEST(Pickle, integers_of_every_kind_are_read) {
  const auto is = [](const std::string& value, std::int64_t expected) {
    read(value, [&](const PickleValue& v) {
      EXPECT_EQ(v.kind, Kind::integer);
      EXPECT_EQ(v.integer, expected);
    });
  };
  is("K\xff", 255);
  is("M\x01\x02", 513);
  is("J\xfe\xff\xff\xff", -2);
  is("\x8a\x00"s, 0);
  is("\x8a\x01\x80", -128);
  is("\x8a\x02\xff\x00"s, 255);
  is("\x8a\x08"s + raw(INT64_MIN), INT64_MIN);
  is("\x8b\x02\x00\x00\x00\x01\x02"s, 513);
  read("\x8a\x09"s + std::string(9, '\1'), [](const PickleValue& v) {
    EXPECT_EQ(v.kind, Kind::long_integer);
    EXPECT_EQ(v.text, std::string(9, '\1'));
  });
}

TEST(Pickle, texts_and_bytes_of_every_kind_are_read) {
  const auto is = [](const std::string& value, Kind kind) {
    read(value, [&](const PickleValue& v) {
      EXPECT_EQ(v.kind, kind);
      EXPECT_EQ(v.text, "abc");
    });
  };
  is("X\3\0\0\0abc"s, Kind::text);
  is("\x8c\3abc", Kind::text);
  is("\x8d\3\0\0\0\0\0\0\0abc"s, Kind::text);
  is("T\3\0\0\0abc"s, Kind::text);
  is("U\3abc", Kind::text);
  is("B\3\0\0\0abc"s, Kind::bytes);
  is("C\3abc", Kind::bytes);
  is("\x8e\3\0\0\0\0\0\0\0abc"s, Kind::bytes);
}

TEST(Pickle, containers_of_every_kind_are_read) {
  const auto is = [](const std::string& value, Kind kind, std::size_t size) {
    read(value, [&](const PickleValue& v) {
      EXPECT_EQ(v.kind, kind);
      ASSERT_EQ(v.items.size(), size);
      for (std::size_t i = 0; i < size; ++i) {
        EXPECT_EQ(v.items[i]->integer, static_cast<std::int64_t>(i));
      }
    });
  };
  is(")", Kind::tuple, 0);
  is("(t", Kind::tuple, 0);
  is("(K\0K\1K\2K\3t"s, Kind::tuple, 4);
  is("K\0\x85"s, Kind::tuple, 1);
  is("K\0K\1\x86"s, Kind::tuple, 2);
  is("K\0K\1K\2\x87"s, Kind::tuple, 3);
  is("]K\0a"s, Kind::list, 1);
  is("](K\0K\1e"s, Kind::list, 2);
  is("}K\0K\1s"s, Kind::dict, 2);
  is("}(K\0K\1K\2K\3u"s, Kind::dict, 4);
  is("\x8f(K\0K\1\x90"s, Kind::set, 2);
  is("(K\0K\1\x91"s, Kind::set, 2);
}

TEST(Pickle, constants_and_frames_are_read) {
  read("\x95\x08\0\0\0\0\0\0\0(N\x88\x89G\0\0\0\0\0\0\0\0t"s, [](const PickleValue& v) {
    ASSERT_EQ(v.items.size(), 4u);
    EXPECT_EQ(v.items[0]->kind, Kind::none);
    EXPECT_EQ(v.items[1]->kind, Kind::boolean);
    EXPECT_EQ(v.items[1]->integer, 1);
    EXPECT_EQ(v.items[2]->integer, 0);
    EXPECT_EQ(v.items[3]->kind, Kind::real);
  });
}

TEST(Pickle, remembered_values_are_the_same) {
  for (const std::string& again : {"q\7h\7"s, "r\7\0\0\0j\7\0\0\0"s, "\x94h\0"s, "q\7j\7\0\0\0"s}) {
    read("]" + again + "\x86", [](const PickleValue& v) { EXPECT_EQ(v.items[0], v.items[1]); });
  }
  read("]r\xff\xff\xff\xff", [](const PickleValue& v) { EXPECT_EQ(v.kind, Kind::list); });
}

TEST(Pickle, names_are_read_both_ways) {
  for (const std::string& name : {global("a.b", "C"), "\x8c\3a.b\x8c\1C\x93"s}) {
    read(name, [](const PickleValue& v) {
      EXPECT_EQ(v.kind, Kind::global);
      EXPECT_EQ(v.text, "a.b.C");
    });
  }
}

TEST(Pickle, objects_are_described_and_not_made) {
  const std::string os = global("os", "system");
  for (const std::string& object : {os + "(" + text("exit") + "t\x81"s, os + ")}\x92"s,
                                    os + ")\x81}b"s, os + ")\x81(K\1e"s, os + ")\x81}(K\1K\2ub"s}) {
    read(object, [](const PickleValue& v) { EXPECT_EQ(v.kind, Kind::object); });
  }
  read(call(global("builtins", "set"), tuple({list({})})) + "(K\1K\2u}b", [](const PickleValue& v) {
    EXPECT_TRUE(v.is_call_of("builtins.set"));
    EXPECT_EQ(v.items.size(), 4u);
  });
}

TEST(Pickle, calls_that_are_not_known_are_refused_by_name_and_nothing_runs) {
  const Folder folder;
  const std::string command = text("touch " + (folder / "ran").string());
  for (const auto& [module, name] : {std::pair<std::string, std::string>{"os", "system"},
                                     {"posix", "system"},
                                     {"builtins", "eval"},
                                     {"subprocess", "Popen"}}) {
    const std::string message = refusal(call(global(module, name), tuple({command})));
    EXPECT_TRUE(has(message, "p: pickle instruction REDUCE of '" + module + "." + name + "'"));
    EXPECT_TRUE(has(
        message,
        "byte " + std::to_string(pickle(global(module, name) + "(" + command + "t").size() - 1)));
  }
  EXPECT_EQ(folder.entries(), 0);
  EXPECT_TRUE(has(refusal(call(call(global("builtins", "set"), ")"), ")")), "no name"));
  EXPECT_TRUE(has(refusal(call(text("os.system"), ")")), "no name"));
  EXPECT_TRUE(has(refusal(call(global("builtins", "set"), "N")), "no tuple"));
}

TEST(Pickle, every_other_instruction_is_refused_by_name_and_place) {
  const auto is = [](const std::string& value, const std::string& name) {
    EXPECT_TRUE(has(refusal("N" + value), "instruction " + name + ", at byte 3, is refused"));
  };
  is("0", "POP");
  is("1", "POP_MARK");
  is("2", "DUP");
  is("ios\nsystem\n", "INST");
  is("o", "OBJ");
  is("P1\n", "PERSID");
  is("\x82\1", "EXT1");
  is("\x83\1\0"s, "EXT2");
  is("\x84\1\0\0\0"s, "EXT4");
  is("I1\n", "INT");
  is("L1L\n", "LONG");
  is("F1\n", "FLOAT");
  is("S'a'\n", "STRING");
  is("Va\n", "UNICODE");
  is("d", "DICT");
  is("l", "LIST");
  is("g1\n", "GET");
  is("p1\n", "PUT");
  is("\x96\0\0\0\0\0\0\0\0"s, "BYTEARRAY8");
  is("\x97", "NEXT_BUFFER");
  is("\x98", "READONLY_BUFFER");
  is("\xff", "number 255");
}

TEST(Pickle, whatever_the_machine_cannot_do_is_an_error) {
  EXPECT_TRUE(has(refusal(""), "does not end with one value"));
  EXPECT_TRUE(has(refusal("NN"), "does not end with one value"));
  EXPECT_TRUE(has(refusal("N("), "does not end with one value"));
  EXPECT_TRUE(has(refusal("t"), "a mark that is not there"));
  EXPECT_TRUE(has(refusal("\x85"), "a value that is not there"));
  EXPECT_TRUE(has(refusal("N(\x85"), "a value that is not there"));
  EXPECT_TRUE(has(refusal("q\1"), "a value that is not there"));
  EXPECT_TRUE(has(refusal("(e"), "a value that is not there"));
  EXPECT_TRUE(has(refusal("h\1"), "never put"));
  EXPECT_TRUE(has(refusal("Nq\1j\2\0\0\0"s), "never put"));
  EXPECT_TRUE(has(refusal("N(e"), "another kind"));
  EXPECT_TRUE(has(refusal("](NNu"), "another kind"));
  EXPECT_TRUE(has(refusal("}(Nu"), "without a value"));
  EXPECT_TRUE(has(refusal("}Nb"), "a state"));
  EXPECT_TRUE(has(refusal("N)\x81"), "no class"));
  EXPECT_TRUE(has(refusal("NN\x93"), "no text"));
  EXPECT_TRUE(has(refusal("c" + std::string(300, 'a')), "does not end"));
  EXPECT_TRUE(has(refusal(global(std::string(200, 'a'), std::string(200, 'a'))), "does not end"));
  EXPECT_TRUE(has(refusal("\x80\x06N"), "protocol"));
}

TEST(Pickle, sizes_that_are_not_there_are_errors_at_once) {
  for (const std::string& huge :
       {"X\xff\xff\xff\xff"s, "\x8d"s + raw(UINT64_MAX), "\x8e"s + raw(INT64_MAX),
        "B\xff\xff\xff\xff"s, "\x8b\xff\xff\xff\x7f"s, "\x8c\xff"s}) {
    EXPECT_TRUE(has(refusal(huge), "ends too early"));
  }
  EXPECT_TRUE(has(refusal("T\xff\xff\xff\xff"s), "negative"));
  EXPECT_TRUE(has(refusal("\x8b\xff\xff\xff\xff"s), "negative"));
}

TEST(Pickle, values_may_nest_as_deep_as_they_like) {
  constexpr std::size_t kDeep = 500'000;
  const PickleValue* value = nullptr;
  const std::string bytes = pickle(std::string(kDeep, ']') + std::string(kDeep - 1, 'a'));
  const Pickle deep(bytes, 0, "p", only_sets);
  std::size_t depth = 0;
  for (value = &deep.root(); !value->items.empty(); value = value->items[0]) ++depth;
  EXPECT_EQ(depth, kDeep - 1);
}

TEST(Pickle, values_may_hold_themselves) {
  read("]q\1h\1a", [](const PickleValue& v) { EXPECT_EQ(v.items[0], &v); });
}

TEST(Pickle, endless_instructions_are_refused) {
  EXPECT_TRUE(has(refusal(std::string(5'000'000, '(')), "more than 4000000 instructions"));
}

TEST(Pickle, it_may_begin_and_end_inside_a_file) {
  const std::string bytes = "before" + pickle("K\5") + "after";
  const Pickle read(bytes, 6, "p", only_sets);
  EXPECT_EQ(read.root().integer, 5);
  EXPECT_EQ(read.end(), bytes.size() - 5);
  const std::string bad = "before" + pickle("o");
  EXPECT_TRUE(has(error_of([&] { Pickle(bad, 6, "p", only_sets); }), "byte 8"));
}

}  // namespace
}  // namespace ps
