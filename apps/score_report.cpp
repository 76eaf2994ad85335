// SPDX-License-Identifier: BSD-3-Clause
#include "apps/score_report.h"

#include <algorithm>
#include <cmath>

#include "apps/output.h"
#include "apps/program.h"
#include "io/atomic_file.h"
#include "libps/core/error.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

constexpr std::size_t kLineWidth = 100;

void append_line(std::string& text, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

/// One column of the terminal's table: its title, then for each row the figure and the interval.
struct TextColumn {
  std::string title;
  std::vector<std::string> values, intervals;
  std::size_t width = 0;
};

TextColumn text_column(const ScoreSummary& summary, std::size_t c) {
  TextColumn column;
  column.title = title_of(summary.columns[c]);
  column.width = column.title.size();
  for (const std::vector<Interval>& row : summary.cells) {
    const Interval& cell = row[c];
    column.values.push_back(figure_text(cell.value, 4));
    column.intervals.push_back(interval_text(cell, "..", 3));
    column.width =
        std::max({column.width, column.values.back().size(), column.intervals.back().size()});
  }
  column.width += 2;
  return column;
}

std::string text_of_columns(const ScoreSummary& summary, const std::vector<TextColumn>& columns,
                            std::size_t first_width) {
  std::string text, line = padded(summary.corner, first_width);
  for (const TextColumn& column : columns) line += padded(column.title, column.width);
  append_line(text, line);
  for (std::size_t r = 0; r < summary.rows.size(); ++r) {
    std::string values = padded(summary.rows[r], first_width), intervals(first_width, ' ');
    for (const TextColumn& column : columns) {
      values += padded(column.values[r], column.width);
      intervals += padded(column.intervals[r], column.width);
    }
    append_line(text, values);
    if (intervals.find_first_not_of(' ') != std::string::npos) append_line(text, intervals);
  }
  return text;
}

std::filesystem::path summary_file(const std::string& output) { return beside(output, "csv"); }
std::filesystem::path samples_file(const std::string& output) {
  return beside(output, "samples.csv");
}

}  // namespace

std::string csv_number(double value) { return std::isnan(value) ? "" : in_digits(value, 9); }

std::string figure_text(double value, int digits) {
  return std::isnan(value) ? "-" : in_digits(value, digits);
}

std::string interval_text(const Interval& interval, const std::string& to, int digits) {
  if (std::isnan(interval.low)) return "";
  return in_digits(interval.low, digits) + to + in_digits(interval.high, digits);
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string title_of(const ScoreColumn& column) {
  return column.unit.empty() ? column.name : column.name + ", " + column.unit;
}

Json json_number(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json to_json(const Interval& interval) {
  return {{"value", json_number(interval.value)},
          {"low", json_number(interval.low)},
          {"high", json_number(interval.high)},
          {"samples", interval.samples}};
}

BootstrapOptions bootstrap_of(const Context& context) {
  BootstrapOptions options;
  options.seed = context.seed;
  return options;
}

ScoreSummary summary_of(const ScoreTable& table, const BootstrapOptions& options) {
  ScoreSummary summary = {"method", table.methods(), table.columns(), {}};
  for (const std::string& method : table.methods()) {
    std::vector<Interval> row;
    for (std::size_t c = 0; c < table.columns().size(); ++c) {
      row.push_back(table.mean(method, c, options));
    }
    summary.cells.push_back(std::move(row));
  }
  return summary;
}

std::string text_of(const ScoreSummary& summary, std::size_t most_columns) {
  std::size_t first_width = summary.corner.size();
  for (const std::string& row : summary.rows) first_width = std::max(first_width, row.size());
  first_width += 2;
  std::string text;
  std::vector<TextColumn> columns;
  std::size_t width = first_width;
  for (std::size_t c = 0; c < summary.columns.size(); ++c) {
    TextColumn column = text_column(summary, c);
    const bool wide = width + column.width > kLineWidth || columns.size() == most_columns;
    if (!columns.empty() && wide) {
      text += text_of_columns(summary, columns, first_width) + "\n";
      columns.clear();
      width = first_width;
    }
    width += column.width;
    columns.push_back(std::move(column));
  }
  return text + text_of_columns(summary, columns, first_width);
}

Json to_json(const ScoreSummary& summary) {
  Json json = Json::object();
  for (std::size_t r = 0; r < summary.rows.size(); ++r) {
    Json& row = json[summary.rows[r]] = Json::object();
    for (std::size_t c = 0; c < summary.columns.size(); ++c) {
      row[title_of(summary.columns[c])] = to_json(summary.cells[r][c]);
    }
  }
  return json;
}

std::string to_csv(const ScoreSummary& summary) {
  std::string text = csv_text(summary.corner) + ",score,value,low,high,samples\n";
  for (std::size_t r = 0; r < summary.rows.size(); ++r) {
    for (std::size_t c = 0; c < summary.columns.size(); ++c) {
      const Interval& cell = summary.cells[r][c];
      text += csv_text(summary.rows[r]) + "," + csv_text(title_of(summary.columns[c])) + "," +
              csv_number(cell.value) + "," + csv_number(cell.low) + "," + csv_number(cell.high) +
              "," + std::to_string(cell.samples) + "\n";
    }
  }
  return text;
}

std::string to_csv(const ScoreTable& table) {
  std::string text = "method,sample,group";
  for (const ScoreColumn& column : table.columns()) text += "," + csv_text(title_of(column));
  text += "\n";
  for (const ScoreRow& row : table.rows()) {
    text += csv_text(row.method) + "," + csv_text(row.sample) + "," + std::to_string(row.group);
    for (const double value : row.values) text += "," + csv_number(value);
    text += "\n";
  }
  return text;
}

void add_score_output(CLI::App& verb, std::string& output, const std::string& each) {
  verb.add_option("-o,--output", output,
                  each.empty() ? "F.json; also writes F.csv, the table"
                               : "F.json; also writes F.csv, the table, and F.samples.csv, " + each)
      ->type_name("FILE")
      ->check(not_empty("a name ending in .json"));
}

Json score_report(const CLI::App& verb, const Context& context, const Json& measured,
                  const std::string& rows, const ScoreSummary& summary) {
  Json report = {{"settings", settings_of(verb, context)}};
  report.update(measured);
  report[rows] = to_json(summary);
  return report;
}

void check_score_files(const std::string& output,
                       const std::vector<std::filesystem::path>& inputs) {
  if (output.empty()) return;
  check_output_file(output, {".json"});
  for (const std::filesystem::path& file :
       {std::filesystem::path(output), summary_file(output), samples_file(output)}) {
    check_output_file(file, {});
    check_not_input(file, inputs);
  }
}

void write_score_files(const std::string& output, const Json& report, const ScoreSummary& summary,
                       const ScoreTable* table, OutputFolder* pictures) {
  AtomicFiles files;
  write_text(summary_file(output), to_csv(summary));
  if (table != nullptr) write_text(samples_file(output), to_csv(*table));
  write_json(output, report);
  files.commit(pictures == nullptr ? std::function<void()>() : [=] { pictures->commit(); });
}

void end_scores(const Context& context, ScoreRun run, const Stopwatch& total) {
  add_costs(run.report, total);
  if (!run.output.empty()) {
    write_score_files(run.output, run.report, run.summary, run.table, run.pictures);
  } else if (run.pictures != nullptr) {
    run.pictures->commit();
  }
  if (!context.json) print_text(text_of(run.summary, run.most_columns));
  end_run(context, run.report, run.output.empty() ? run.input : run.output, run.what);
}

}  // namespace ps::apps
