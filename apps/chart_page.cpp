// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_page.h"

#include <opencv2/imgproc.hpp>

#include "apps/page_head.h"
#include "io/data_uri.h"

namespace ps::apps {
namespace {

constexpr char kStyle[] =
    R"css(  body { margin: 0 auto; padding: 1rem; max-width: 80rem; color: #222; font: 1rem sans-serif; }
  .measured { display: flex; flex-wrap: wrap; gap: 1rem; align-items: center; }
  .measured svg { flex: 1 1 30rem; max-width: 45rem; min-width: 0; height: auto; }
  table { border-collapse: collapse; font-size: .85rem; }
  th, td { padding: .2rem .5rem; border-bottom: 1px solid #ddd; text-align: right; }
  th:first-child, td:first-child { text-align: left; }
  small { color: #666; }
  .pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(9.5rem, 1fr)); gap: .5rem; }
  figure { margin: 0; padding: .25rem; border: 3px solid transparent; }
  figure img { display: block; width: 100%; }
  figure.default { border-color: #999; }
  figure:target { border-color: #d55e00; background: #fdeee4; }
  figcaption { font-size: .85rem; }
)css";

std::string cell_of(const Interval& interval) {
  const std::string between = interval_text(interval, " to ", 4);
  return "<td>" + figure_text(interval.value, 4) +
         (between.empty() ? "" : "<br><small>" + between + "</small>") + "</td>";
}

std::string table_of(const ScoreSummary& summary) {
  std::string table = "<table>\n<tr><th>" + escaped(summary.corner) + "</th>";
  for (const ScoreColumn& column : summary.columns) {
    table += "<th>" + escaped(title_of(column)) + "</th>";
  }
  table += "</tr>\n";
  for (std::size_t r = 0; r < summary.rows.size(); ++r) {
    table += "<tr><td>" + escaped(summary.rows[r]) + "</td>";
    for (const Interval& cell : summary.cells[r]) table += cell_of(cell);
    table += "</tr>\n";
  }
  return table + "</table>\n";
}

Image small(const Image& image) {
  constexpr int kWidth = 320;
  if (image.cols <= kWidth) return image;
  Image out;
  const double scale = static_cast<double>(kWidth) / image.cols;
  cv::resize(image, out, {}, scale, scale, cv::INTER_AREA);
  return out;
}

std::string figure_of(const Image& image, const std::string& words, const std::string& attributes) {
  return "<figure" + attributes + "><img alt=\"" + escaped(words) + "\" src=\"" +
         data_uri(small(image), false) + "\"><figcaption>" + escaped(words) +
         "</figcaption></figure>\n";
}

std::string pictures_of(const KnobChart& chart) {
  std::string html;
  for (std::size_t i = 0; i < chart.result.pictures.size(); ++i) {
    const KnobPictures& pictures = chart.result.pictures[i];
    html += "<h3>" + escaped(pictures.sample) + "</h3>\n<div class=\"pictures\">\n";
    html += figure_of(pictures.input, "input", "") + figure_of(pictures.truth, "truth", "");
    for (std::size_t s = 0; s < pictures.by_setting.size(); ++s) {
      std::string attributes;
      if (i == 0) attributes += " id=\"" + anchor_of(chart, s) + "\"";
      if (chart.points[s].is_default) attributes += " class=\"default\"";
      const ScoreRow& row = chart.result.table.rows()[i * chart.points.size() + s];
      html += figure_of(pictures.by_setting[s],
                        chart.points[s].setting + ": " + figure_text(row.values[0], 4) + " s, " +
                            figure_text(row.values[1], 4) + " " + chart.knob.scores.front().unit,
                        attributes);
    }
    html += "</div>\n";
  }
  return html;
}

}  // namespace

std::string html_of(const std::vector<KnobChart>& charts, const BootstrapOptions& options,
                    const std::string& about) {
  std::string html = page_head("pixelsynth: accuracy against time", kStyle, false);
  html += "<h1>Accuracy against time</h1>\n<p>" + escaped(about) + "</p>\n";
  html +=
      "<p>Click on a dot to see its pictures. * is the default (in a ring, framed), + is on the "
      "Pareto front: no other setting is as fast and as accurate. Bars, and small figures below "
      "others in the tables, are 95 % bootstrap intervals of means; those of seconds and accuracy "
      "are without what makes a sample easy or hard for all settings alike. One sample has "
      "none.</p>\n";
  for (const KnobChart& chart : charts) {
    html += "<h2>" + escaped(chart.knob.name) + "</h2>\n<p>" + escaped(chart.knob.what) +
            "</p>\n<div class=\"measured\">\n" + svg_of(drawing_of(picture_of(chart))) +
            table_of(summary_of(chart, options)) + "</div>\n" + pictures_of(chart);
  }
  return html + "</body>\n</html>\n";
}

}  // namespace ps::apps
