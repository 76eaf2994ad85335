// SPDX-License-Identifier: BSD-3-Clause
#include "apps/stress_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "apps/chart_picture.h"
#include "apps/contact_sheet.h"
#include "apps/score_report.h"
#include "io/photo.h"

namespace ps::apps {
namespace {

constexpr std::size_t kSheetColumns = 3;
constexpr double kTie = 1.02;  ///< steps are too far apart to tell less

std::string number(double value) { return figure_text(value, 4); }

/// Of where a method breaks; "none" = it never does.
std::string breaks(const stress::Curve& curve) {
  return std::isinf(curve.breaks) ? "none" : number(curve.breaks);
}

Image sheet_at(const stress::Axis& axis, const stress::AxisResult& result, std::size_t step) {
  std::vector<SheetTile> tiles;
  const auto add = [&](const std::string& name, const Image& image) {
    const std::size_t at = tiles.size();
    if (image.empty()) return;
    tiles.push_back(
        {name, image, static_cast<int>(at / kSheetColumns), static_cast<int>(at % kSheetColumns)});
  };
  if (axis.truth) add("truth", axis.truth(axis.values[step]));
  for (const stress::Curve& curve : result.curves) {
    const stress::Step& at = curve.steps[step];
    add(curve.method + " " + number(at.score), at.picture);
  }
  return contact_sheet(tiles, 240);
}

/// Methods but ours, a row for each: the truth, just before the method breaks and just after.
Image sheet_of_others(const stress::Axis& axis, const stress::AxisResult& result) {
  std::vector<SheetTile> tiles;
  for (std::size_t m = 1; m < result.curves.size(); ++m) {
    const stress::Curve& curve = result.curves[m];
    const std::size_t after = curve.first_broken(axis), steps = curve.steps.size();
    const int row = static_cast<int>(m) - 1;
    const auto add = [&](std::size_t step, int column) {
      const stress::Step& at = curve.steps[step];
      const std::string name = curve.method + " " + number(at.value) + ": " + number(at.score);
      if (!at.picture.empty()) tiles.push_back({name, at.picture, row, column});
    };
    if (axis.truth) {
      const double value = axis.values[std::min(after, steps - 1)];
      tiles.push_back({"truth " + number(value), axis.truth(value), row, 0});
    }
    if (after > 0) add(after - 1, 1);
    if (after < steps) add(after, 2);
  }
  return contact_sheet(tiles, 240);
}

void write_picture(OutputFolder& out, const std::string& name, const Image& image) {
  if (image.empty()) return;
  out.write(name, [&](const std::filesystem::path& path) { write_image(path, image); });
}

/// Whether values rise by factors; the first may be 0, which a logarithm does not show.
bool rises_by_factors(const std::vector<double>& values) {
  constexpr double kFactors = 30;
  const double least = values[0] > 0 ? values[0] : values[1];
  return least > 0 && values.back() > kFactors * least;
}

ChartPicture chart_of(const stress::Axis& axis, const stress::AxisResult& result) {
  ChartPicture chart;
  chart.title = axis.name;
  chart.x_name = axis.unit;
  chart.y_name = axis.score + (axis.score_unit.empty() ? "" : ", " + axis.score_unit);
  chart.log_x = rises_by_factors(axis.values);
  for (const stress::Curve& curve : result.curves) {
    chart.curves.push_back({curve.method, axis.values, curve.scores()});
  }
  const std::vector<double> ends = {
      axis.values.front() > 0 || !chart.log_x ? axis.values.front() : axis.values[1],
      axis.values.back()};
  Curve limit = {"broken where " + stress::criterion_of(axis), ends, {axis.limit, axis.limit}};
  limit.dots = false;
  chart.curves.push_back(limit);
  return chart;
}

/// Axes where ours breaks before another method that is not a form of ours.
bool beaten(const StressRow& row, std::string* by) {
  const auto& curves = row.result.curves;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const bool form_of_ours = curves[i].method.rfind(curves[0].method, 0) == 0;
    if (!form_of_ours && curves[i].breaks > kTie * curves[0].breaks) {
      *by += (by->empty() ? "" : ", ") + curves[i].method;
    }
  }
  return !by->empty();
}

}  // namespace

std::vector<std::string> axis_files(const std::string& axis) {
  return {axis + ".png", axis + ".svg", axis + "-before.png", axis + "-after.png",
          axis + "-others.png"};
}

void write_axis_pictures(OutputFolder& out, StressRow& row) {
  const stress::Axis& axis = row.axis;
  const ChartPicture chart = chart_of(axis, row.result);
  const std::vector<std::string> files = axis_files(axis.name);
  out.write(files[0], [&](const auto& path) { write_chart_png(path, chart); });
  out.write(files[1], [&](const auto& path) { write_chart_svg(path, chart); });
  const std::size_t first = row.result.curves[0].first_broken(axis);
  if (first > 0) {
    write_picture(out, files[2], sheet_at(axis, row.result, first - 1));
  }
  if (first < axis.values.size()) {
    write_picture(out, files[3], sheet_at(axis, row.result, first));
  }
  write_picture(out, files[4], sheet_of_others(axis, row.result));
  for (stress::Curve& curve : row.result.curves) {
    for (stress::Step& step : curve.steps) step.picture.release();
  }
}

std::string breaking_table(const std::vector<StressRow>& rows) {
  std::string text;
  for (const StressRow& row : rows) {
    text += padded(row.axis.name, 16) + " " + padded(row.axis.unit, 18);
    for (const stress::Curve& curve : row.result.curves) {
      text += "  " + curve.method + " " + breaks(curve);
    }
    std::string by;
    text += beaten(row, &by) ? "  *\n" : "\n";
  }
  return text;
}

std::vector<std::string> stress_notes(const std::vector<StressRow>& rows) {
  std::vector<std::string> notes;
  for (const StressRow& row : rows) {
    const stress::Curve& ours = row.result.curves[0];
    const std::string& name = row.axis.name;
    for (const std::size_t i : ours.jumps) {
      notes.push_back("note: " + name + ": ours gets worse at once from " +
                      number(ours.steps[i - 1].value) + " (" + number(ours.steps[i - 1].score) +
                      ") to " + number(ours.steps[i].value) + " (" + number(ours.steps[i].score) +
                      ")");
    }
    if (ours.first_broken(row.axis) > 0) continue;
    notes.push_back("note: " + name + ": ours is broken before anything goes wrong, its score is " +
                    number(ours.steps[0].score));
  }
  return notes;
}

std::string stress_markdown(const std::vector<StressRow>& rows, const std::string& data) {
  std::string text = "# Stress\n\nWhere each method breaks on " + data +
                     ", one thing going wrong at a time; none = not within the values tried.\n\n| "
                     "axis | unit | broken where | ours | others "
                     "|\n|---|---|---|---|---|\n";
  for (const StressRow& row : rows) {
    const auto& curves = row.result.curves;
    text += "| " + row.axis.name + " | " + row.axis.unit + " | " + stress::criterion_of(row.axis) +
            " | **" + breaks(curves[0]) + "** | ";
    for (std::size_t i = 1; i < curves.size(); ++i) {
      text += (i > 1 ? ", " : "") + curves[i].method + " " + breaks(curves[i]);
    }
    text += " |\n";
  }
  std::string beaten_list, jumps, violations;
  for (const StressRow& row : rows) {
    std::string by;
    if (beaten(row, &by)) beaten_list += "- " + row.axis.name + ": " + by + " breaks later.\n";
    for (const std::size_t i : row.result.curves[0].jumps) {
      jumps += "- " + row.axis.name + ": jump towards " + number(row.axis.values[i]) + ".\n";
    }
    for (const stress::Violation& v : row.result.violations) {
      violations +=
          "- " + v.axis + ", " + v.method + ", at " + number(v.value) + ": " + v.what + "\n";
    }
  }
  const auto list = [](const std::string& lines) { return lines.empty() ? "None.\n" : lines; };
  text += "\n## Where another breaks later, by more than 2 %\n" + list(beaten_list) +
          "\n## Jumps of ours\n" + list(jumps) + "\n## Violations\n" + list(violations) +
          "\n## Axes\n";
  for (const StressRow& row : rows) {
    const std::string& name = row.axis.name;
    text += "\n### " + name + "\n" + row.axis.what + "; broken where " +
            stress::criterion_of(row.axis) + ".\n\n![curves](" + name + ".png)\n";
    const std::size_t first = row.result.curves[0].first_broken(row.axis);
    if (first > 0) text += "![just before](" + name + "-before.png)\n";
    if (first < row.axis.values.size()) text += "![just after](" + name + "-after.png)\n";
    text += "![each other just before and just after it breaks](" + name + "-others.png)\n";
  }
  return text;
}

Json to_json(const std::vector<StressRow>& rows) {
  Json axes = Json::object();
  for (const StressRow& row : rows) {
    Json methods = Json::object();
    for (const stress::Curve& curve : row.result.curves) {
      Json scores = Json::array(), refused = Json::object();
      for (const stress::Step& step : curve.steps) {
        scores.push_back(json_number(step.score));
        if (!step.refused.empty()) refused[number(step.value)] = step.refused;
      }
      methods[curve.method] = {{"breaks", json_number(curve.breaks)}, {"scores", scores}};
      if (!refused.empty()) methods[curve.method]["refused"] = refused;
    }
    Json jumps = Json::array(), violations = Json::array();
    for (const std::size_t i : row.result.curves[0].jumps) jumps.push_back(row.axis.values[i]);
    for (const stress::Violation& v : row.result.violations) {
      violations.push_back({{"method", v.method}, {"value", v.value}, {"what", v.what}});
    }
    axes[row.axis.name] = {{"what", row.axis.what},
                           {"unit", row.axis.unit},
                           {"score", row.axis.score},
                           {"score_unit", row.axis.score_unit},
                           {"limit", row.axis.limit},
                           {"geometry", row.axis.geometry},
                           {"values", row.axis.values},
                           {"methods", methods},
                           {"jumps", jumps},
                           {"violations", violations}};
  }
  return axes;
}

std::string to_csv(const std::vector<StressRow>& rows) {
  std::string text = "axis,method,value,score\n";
  for (const StressRow& row : rows) {
    for (const stress::Curve& curve : row.result.curves) {
      for (const stress::Step& step : curve.steps) {
        text += csv_text(row.axis.name) + "," + csv_text(curve.method) + "," +
                csv_number(step.value) + "," + csv_number(step.score) + "\n";
      }
    }
  }
  return text;
}

}  // namespace ps::apps
