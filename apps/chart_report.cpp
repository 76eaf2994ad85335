// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "libps/core/parallel.h"

namespace ps::apps {
namespace {

bool on_front(const KnobChart& chart, std::size_t setting) {
  return std::find(chart.front.begin(), chart.front.end(), setting) != chart.front.end();
}

/// Whether seconds differ by so much that a logarithmic axis shows them better.
bool spread_out(const std::vector<TradeoffPoint>& points) {
  constexpr double kRatio = 4;
  const auto [least, most] = std::minmax_element(
      points.begin(), points.end(), [](const TradeoffPoint& a, const TradeoffPoint& b) {
        return a.seconds.value < b.seconds.value;
      });
  return least->seconds.value > 0 && most->seconds.value > kRatio * least->seconds.value;
}

void add_interval(std::string& line, const Interval& interval) {
  for (const double value : {interval.value, interval.low, interval.high}) {
    line += "," + csv_number(value);
  }
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

}  // namespace

KnobChart chart_of(const Knob& knob, KnobResult result, const BootstrapOptions& options) {
  std::vector<TradeoffPoint> points = points_of(knob, result.table, options);
  std::vector<std::size_t> front = pareto_front(points);
  return {knob, std::move(result), std::move(points), std::move(front)};
}

std::string anchor_of(const KnobChart& chart, std::size_t setting) {
  return chart.knob.name + "-" + std::to_string(setting + 1);
}

ChartPicture picture_of(const KnobChart& chart) {
  Curve dots, front;
  const bool intervals = std::any_of(chart.points.begin(), chart.points.end(),
                                     [](const auto& p) { return !std::isnan(p.accuracy.low); });
  dots.name = intervals ? "settings, with 95 % intervals" : "settings";
  dots.line = false;
  front.name = "Pareto front";
  front.dots = false;
  ChartPicture picture;
  for (std::size_t s = 0; s < chart.points.size(); ++s) {
    const TradeoffPoint& point = chart.points[s];
    dots.x.push_back(point.seconds.value);
    dots.left.push_back(point.seconds.low);
    dots.right.push_back(point.seconds.high);
    dots.y.push_back(point.accuracy.value);
    dots.low.push_back(point.accuracy.low);
    dots.high.push_back(point.accuracy.high);
    dots.labels.push_back(point.setting);
    dots.links.push_back("#" + anchor_of(chart, s));
    if (point.is_default) {
      picture.marked = {{point.seconds.value, point.accuracy.value, "default"}};
    }
  }
  for (const std::size_t s : chart.front) {
    front.x.push_back(chart.points[s].seconds.value);
    front.y.push_back(chart.points[s].accuracy.value);
  }
  picture.title = chart.knob.name;
  picture.x_name = "seconds: " + chart.knob.timed;
  picture.y_name = title_of(chart.knob.scores.front());
  picture.log_x = spread_out(chart.points);
  picture.curves = {dots, front};
  return picture;
}

ScoreSummary summary_of(const KnobChart& chart, const BootstrapOptions& options) {
  ScoreSummary summary;
  summary.corner = chart.knob.name;
  summary.columns = chart.result.table.columns();
  summary.columns.insert(summary.columns.begin() + 2,
                         {"change", chart.knob.scores.front().unit, true});
  for (std::size_t s = 0; s < chart.points.size(); ++s) {
    const TradeoffPoint& point = chart.points[s];
    summary.rows.push_back(point.setting + (point.is_default ? " *" : "") +
                           (on_front(chart, s) ? " +" : ""));
    summary.cells.push_back({point.seconds, point.accuracy, point.change});
    for (std::size_t c = 2; c < chart.result.table.columns().size(); ++c) {
      summary.cells.back().push_back(chart.result.table.mean(point.setting, c, options));
    }
  }
  return summary;
}

std::string to_csv(const std::vector<KnobChart>& charts) {
  std::string text =
      "knob,setting,default,front,score,seconds,seconds_low,seconds_high,accuracy,accuracy_low,"
      "accuracy_high,change,change_low,change_high,samples\n";
  for (const KnobChart& chart : charts) {
    for (std::size_t s = 0; s < chart.points.size(); ++s) {
      const TradeoffPoint& point = chart.points[s];
      text += csv_text(point.knob) + "," + csv_text(point.setting) + "," +
              (point.is_default ? "1" : "0") + "," + (on_front(chart, s) ? "1" : "0") + "," +
              csv_text(title_of(chart.knob.scores.front()));
      for (const Interval& interval : {point.seconds, point.accuracy, point.change}) {
        add_interval(text, interval);
      }
      text += "," + std::to_string(point.accuracy.samples) + "\n";
    }
  }
  return text;
}

Json to_json(const std::vector<KnobChart>& charts) {
  Json json = Json::object();
  for (const KnobChart& chart : charts) {
    Json points = Json::array();
    for (std::size_t s = 0; s < chart.points.size(); ++s) {
      const TradeoffPoint& point = chart.points[s];
      points.push_back({{"setting", point.setting},
                        {"default", point.is_default},
                        {"front", on_front(chart, s)},
                        {"seconds", to_json(point.seconds)},
                        {"accuracy", to_json(point.accuracy)},
                        {"change", to_json(point.change)}});
    }
    json[chart.knob.name] = {{"what", chart.knob.what},
                             {"seconds_of", chart.knob.timed},
                             {"accuracy", title_of(chart.knob.scores.front())},
                             {"repeats", chart.knob.repeats},
                             {"points", points}};
  }
  return json;
}

Json machine_report() {
  double load = 0;
  const bool known = getloadavg(&load, 1) == 1;
  return {{"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"threads", threads()},
          {"load_before", known ? Json(std::round(100 * load) / 100) : Json()}};
}

Image grid_of(const std::vector<Image>& pictures, int columns) {
  if (pictures.empty()) return {};
  const cv::Size size = pictures.front().size();
  const int count = static_cast<int>(pictures.size());
  const int across = std::min(columns, count), rows = (count + across - 1) / across;
  Image grid(rows * size.height, across * size.width, cv::Vec3f::all(1));
  for (int i = 0; i < count; ++i) {
    const cv::Point corner(i % across * size.width, i / across * size.height);
    pictures[static_cast<std::size_t>(i)].copyTo(grid(cv::Rect(corner, size)));
  }
  return grid;
}

}  // namespace ps::apps
