// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/context.h"

namespace ps::apps {

/// @brief Runs `pixelsynth VERB ARGS`.
/// @return 0 done, 2 wrong usage; failures are thrown
int run(int argc, char** argv);

/// @brief Prints the exception in flight as one line on stderr; to be called in a catch block.
/// @return 1. Does not return when the user interrupted the program: it ends by that signal.
int report_failure() noexcept;

/// @brief Checks that an option is a finite number in [low, high]; CLI::Range lets NaN pass.
CLI::Validator in_range(double low, double high);

/// @brief Checks that an option is a whole number in [low, high]; CLI11 takes -1 for 2^64 - 1.
CLI::Validator whole_in(std::uint64_t low, std::uint64_t high);

/// @brief Checks that a file's or folder's name is not empty.
/// @param expected  what would be right: "a folder"
CLI::Validator not_empty(const std::string& expected);

/// @brief Checks two options that bound a range: throws CLI::ValidationError when the least is more
/// than the most.
/// @param least_option, most_option  "--min-depth", "--max-depth"
void check_order(const std::string& least_option, double least, const std::string& most_option,
                 double most);

/// @brief Adds an option that takes names with commas in between, each of `choices` and once at the
/// most.
CLI::Option* add_names(CLI::App& verb, const std::string& option, std::vector<std::string>& names,
                       const std::string& help, const std::vector<std::string>& choices);

/// The highest value of options without a natural bound.
constexpr double kNoBound = 1e9;

// Each adds one verb to the program: its options, its help, and what it does.
void add_fuse(CLI::App& program, const Context& context);
void add_render(CLI::App& program, const Context& context);
void add_view(CLI::App& program, const Context& context);
void add_scene(CLI::App& program, const Context& context);
void add_depth(CLI::App& program, const Context& context);
void add_probe(CLI::App& program, const Context& context);
void add_weights(CLI::App& program, const Context& context);
void add_train(CLI::App& program, const Context& context);
void add_eval(CLI::App& program, const Context& context);
void add_stress(CLI::App& program, const Context& context);
void add_chart(CLI::App& program, const Context& context);

}  // namespace ps::apps
