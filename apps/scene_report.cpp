// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_report.h"

#include <fstream>

#include "apps/peak_memory.h"

namespace ps::apps {
namespace {

/// Appends `before` + the text under `key` of each entry + `after`; a text that is no plain name is
/// none of ours.
void append_names(const Json& entries, const char* key, const std::string& before,
                  const std::string& after, std::vector<std::string>* names) {
  if (!entries.is_array()) return;
  for (const Json& entry : entries) {
    if (!entry.is_object() || !entry.contains(key) || !entry[key].is_string()) continue;
    const auto name = entry[key].get<std::string>();
    // A '#' would be taken for a number.
    if (name.find_first_of("/#") == std::string::npos) names->push_back(before + name + after);
  }
}

}  // namespace

void end_stage(Json& report, const std::string& stage, const Stopwatch& watch) {
  report["seconds"][stage] = watch.seconds();
  report["peak_memory_mib_after"][stage] = peak_memory_mib();
}

Json to_json(const AddReport& r) {
  return {{"lifted", r.lifted},
          {"explained", r.explained},
          {"duplicates", r.duplicates},
          {"added", r.added},
          {"replaced", r.replaced}};
}

Json to_json(const std::string& name, const SupportReport& r, int samples) {
  Json json = {{"view", name}, {"missing_share", r.missing_share}};
  if (r.best < 0) {
    json["skipped"] = "nothing is missing";
    return json;
  }
  const outpaint::OutpaintReport& o = r.outpaint;
  json["cells"] = {{"sampled", o.missing_cells}, {"spared", o.cells - o.missing_cells}};
  json["completions"] = {
      {"drawn", o.drawn}, {"spared", samples - o.drawn}, {"refined", o.refined}, {"kept", r.best}};
  json["depth"] = {{"agreed", r.agreed},
                   {"scale", r.scale},
                   {"exponent", r.exponent},
                   {"residual", r.residual},
                   {"seam_step", r.seam_step},
                   {"seam_step_before_blend", r.seam_step_before},
                   {"seam_step_seen", r.seam_step_seen}};
  if (!r.agreed) json["depth"]["why"] = r.why;
  json["pixels"] = {{"to_add", r.pixels}, {"refused_in_free_space", r.refused}};
  json["seconds"] = {{"splat", r.splat_seconds},   {"encode", o.encode_seconds},
                     {"sample", o.sample_seconds}, {"decode", o.decode_seconds},
                     {"refine", o.refine_seconds}, {"score", o.score_seconds},
                     {"depth", r.depth_seconds},   {"align", r.align_seconds}};
  return json;
}

std::vector<std::string> pictures_of_earlier_scene(const std::filesystem::path& folder) {
  std::ifstream file(folder / "report.json");
  const Json report = Json::parse(file, nullptr, false);
  std::vector<std::string> names;
  if (!report.is_object()) return names;
  if (report.contains("views")) append_names(report["views"], "view", "views/", ".png", &names);
  if (report.contains("videos")) append_names(report["videos"], "video", "", "", &names);
  return names;
}

Json to_json(const SecondPose& found) {
  return {{"from", "auto"},
          {"matches", found.matches},
          {"inliers", found.inliers},
          {"reprojection_error", found.reprojection_error},
          {"depth_error", found.depth_error},
          {"depth_scale", found.depth_scale},
          {"depth_spread", found.depth_spread}};
}

}  // namespace ps::apps
