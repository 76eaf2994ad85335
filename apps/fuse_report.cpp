// SPDX-License-Identifier: BSD-3-Clause
#include "apps/fuse_report.h"

#include <algorithm>

#include "apps/scene_report.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

Json to_json(const FrameStudy& study, const FrameList& frames, double tolerance) {
  Json refused = Json::array(), all = Json::array();
  for (std::size_t i = 0; i < study.words.size(); ++i) {
    const FrameWord& word = study.words[i];
    const std::string name = frames.used[i].frame.color.string();
    if (word.refused) refused.push_back(name);
    all.push_back({{"frame", name},
                   {"gain", {word.gain[0], word.gain[1], word.gain[2]}},
                   {"scale", word.scale},
                   {"contradicted", word.contradicted},
                   {"alone", word.alone}});
  }
  return {{"refused", refused},
          {"gave_up", study.gave_up},
          {"spread", study.spread},
          {"tolerance_relative", tolerance},
          {"frames", all}};
}

}  // namespace

std::size_t Fused::refused() const {
  if (!study) return 0;
  return static_cast<std::size_t>(std::count_if(study->words.begin(), study->words.end(),
                                                [](const FrameWord& w) { return w.refused; }));
}

Json report_of(const Fused& fused, const FrameList& frames) {
  const FuseReport& sum = fused.report;
  Json report = summary_of(fused.cloud);
  report["views"] = sum.views;
  report["without_depth"] = sum.empty - fused.refused();
  report["refused"] = fused.refused();
  report["held_out"] = frames.held_out.size();
  report["pixels"] = to_json(sum.pixels);
  report["contradicted"] = sum.contradicted;
  report["seconds"] = {{"load", sum.load_seconds}, {"add", sum.add_seconds}};
  if (fused.study) report["study"] = to_json(*fused.study, frames, fused.tolerance_relative);
  return report;
}

void warn_of(const Fused& fused, const Context& context) {
  const auto warn = [&](std::size_t count, const std::string& one, const std::string& many) {
    if (count > 0) context.warn(counted(count, one, many));
  };
  if (fused.study && fused.study->gave_up) {
    context.warn(
        "the study gave up: too many frames contradict each other for anybody to tell which are "
        "right; none is left out and nothing is evened out");
  }
  warn(fused.refused(), "frame is left out, as the others contradict it: its pose must be wrong",
       "frames are left out, as the others contradict them: their poses must be wrong");
  if (fused.study) {
    const auto& words = fused.study->words;
    const auto alone = static_cast<std::size_t>(
        std::count_if(words.begin(), words.end(), [](const FrameWord& w) { return w.alone; }));
    if (words.size() > 1) {
      warn(
          alone,
          "frame shares no surface with the others: nobody can tell whether its pose is right",
          "frames share no surface with the others: nobody can tell whether their poses are right");
    }
  }
  const std::string which = fused.study ? ", or none that its neighbours share," : " at all";
  warn(fused.report.empty - fused.refused(), "frame has no depth" + which + " and is left out",
       "frames have no depth" + which + " and are left out");
  warn(fused.scaled, "depth image is of another size than its photo; scaled to the photo's size",
       "depth images are of another size than their photos; scaled to the photos' size");
}

}  // namespace ps::apps
