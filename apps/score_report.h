// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/context.h"
#include "apps/output.h"
#include "apps/report.h"
#include "libps/eval/score_table.h"

namespace ps::apps {

/// @brief What scores come to: a row for each method (or threshold), a column for each score.
struct ScoreSummary {
  std::string corner;  ///< what the rows are: "method"
  std::vector<std::string> rows;
  std::vector<ScoreColumn> columns;
  std::vector<std::vector<Interval>> cells;  ///< by row, then column
};

/// @return intervals drawn by the program's seed
BootstrapOptions bootstrap_of(const Context& context);

ScoreSummary summary_of(const ScoreTable& table, const BootstrapOptions& options);

/// @return {value, low, high, samples}, numbers as json_number() has them
Json to_json(const Interval& interval);

/// @return the figure in so many digits; "-" for NaN
std::string figure_text(double value, int digits);

/// @return "1.2..3.4", with `to` between; empty where the interval is not known
std::string interval_text(const Interval& interval, const std::string& to, int digits);

/// @return the text, and blanks up to this width
std::string padded(const std::string& text, std::size_t width);

/// @return lines for a terminal: each figure, and below it its interval
/// @param most_columns  side by side
std::string text_of(const ScoreSummary& summary, std::size_t most_columns = 5);

/// @return {ROW: {COLUMN: {value, low, high, samples}}}; what is no number is null, what is
/// infinite "inf"
Json to_json(const ScoreSummary& summary);

/// @return the shortest number that reads back the same; empty for NaN
std::string csv_number(double value);

/// @return the text, in quotes where it needs them (RFC 4180)
std::string csv_text(const std::string& text);

/// @return JSON knows neither NaN (null) nor infinity ("inf", "-inf")
Json json_number(double value);

/// @return "AbsRel", or with a unit "PSNR, dB"
std::string title_of(const ScoreColumn& column);

/// @return a line for each cell: ROW, score, value, low, high, samples
std::string to_csv(const ScoreSummary& summary);

/// @return a line for each row of the table: method, sample, group and all scores
std::string to_csv(const ScoreTable& table);

/// @brief Adds -o,--output, for FILE.json with FILE.csv beside it.
/// @param each  whose scores stand in FILE.samples.csv: "every frame"; empty = there is none
void add_score_output(CLI::App& verb, std::string& output, const std::string& each = "");

/// @return the report of a verb: its settings, `measured`, and under `rows` what it came to
Json score_report(const CLI::App& verb, const Context& context, const Json& measured,
                  const std::string& rows, const ScoreSummary& summary);

/// @brief Fails before the work: throws as check_output_file() does unless FILE.json, FILE.csv and
/// FILE.samples.csv can be written, and ps::Error unless they are none of the inputs. An empty path
/// is none.
void check_score_files(const std::string& output,
                       const std::vector<std::filesystem::path>& inputs = {});

/// @brief Writes the report as FILE.json, the summary as FILE.csv and, where there is one, the
/// whole table as FILE.samples.csv, all or none of them. Throws ps::Error.
/// @param pictures  committed with them, if given: when that fails none of the files is there
void write_score_files(const std::string& output, const Json& report, const ScoreSummary& summary,
                       const ScoreTable* table = nullptr, OutputFolder* pictures = nullptr);

/// A run that scored.
struct ScoreRun {
  std::string output;  ///< FILE.json; empty = nothing is written
  std::string input;   ///< to be named where there is no output
  Json report;
  ScoreSummary summary;
  const ScoreTable* table = nullptr;  ///< may be null
  std::string what;                   ///< "depth of 7 frames scored"
  std::size_t most_columns = 5;       ///< side by side
  OutputFolder* pictures = nullptr;   ///< to be committed with the files; may be null
};

/// @brief The end of such a run: adds costs to the report, writes the files, prints the table, or
/// the report (--json), and says what was done. Throws ps::Error when writing or printing fails.
void end_scores(const Context& context, ScoreRun run, const Stopwatch& total);

}  // namespace ps::apps
