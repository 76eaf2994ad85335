// SPDX-License-Identifier: BSD-3-Clause
#include "apps/frames_arguments.h"

#include <algorithm>
#include <map>

#include "apps/program.h"
#include "libps/core/error.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

constexpr std::size_t kParts = 20;  ///< of a walk

std::vector<int> groups_of(std::vector<int> groups) {
  const bool one_world =
      std::all_of(groups.begin(), groups.end(), [&](int group) { return group == groups.front(); });
  const std::size_t parts = std::min(kParts, groups.size());
  for (std::size_t i = 0; one_world && i < groups.size(); ++i) {
    groups[i] = static_cast<int>(i * parts / groups.size());
  }
  return groups;
}

}  // namespace

void FramesArguments::add_to(CLI::App& verb, const std::string& standard) {
  verb.add_option("data", data,
                  "An RGB-D folder, TUM RGB-D, 7-Scenes, RealEstate10K (text file with a folder of "
                  "photos), or rooms:SEED:COUNT, views of procedural rooms" +
                      (standard.empty() ? "" : " (default: " + standard + ")"))
      ->required(standard.empty())
      ->type_name("DATA");
  verb.add_option("--frames", frames,
                  "Only frames from A to B, both included, by timestamp or frame number; A: and :B "
                  "are open")
      ->type_name("A:B");
  verb.add_option("--every", choice.every, "Only every Nth of these frames of each world")
      ->type_name("N")
      ->check(whole_in(1, 1000000));
  verb.add_option("--depth-scale", depth_scale,
                  "Units of the depth files in a metre (default: 5000 for TUM, else 1000)")
      ->type_name("S")
      ->check(in_range(1e-6, kNoBound));
}

std::vector<int> ChosenFrames::worlds() const {
  std::vector<int> worlds;
  for (const std::size_t i : chosen) worlds.push_back(all.frames[i].world);
  return worlds;
}

ChosenFrames choose_posed_frames(const FramesArguments& a, const Context& context) {
  FrameChoice choice = a.choice;
  if (!a.frames.empty()) parse_frames(a.frames, choice);
  ChosenFrames result;
  result.all = open_posed_frames(a.data, a.depth_scale);
  std::map<int, int> in_range;  // by world
  for (std::size_t i = 0; i < result.all.frames.size(); ++i) {
    const PosedFrame& frame = result.all.frames[i];
    if (choice.first && frame.stamp < *choice.first) continue;
    if (choice.last && frame.stamp > *choice.last) continue;
    if (in_range[frame.world]++ % choice.every == 0) result.chosen.push_back(i);
  }
  if (result.chosen.empty()) {
    throw Error("--frames", "no frame is in " + a.frames,
                "a range within that of the frames' timestamps");
  }
  result.groups = groups_of(result.worlds());
  context.detail(a.data + ": " + result.all.layout + ", " + std::to_string(result.chosen.size()) +
                 " of " + counted(result.all.frames.size(), "frame"));
  if (result.all.skipped > 0) {
    context.warn(a.data + ": " + counted(result.all.skipped, "frame lacks", "frames lack") +
                 " a photo, a depth or a pose; left out");
  }
  for (const std::string& line : result.all.assumed) context.warn(a.data + ": " + line);
  return result;
}

Json frames_report(const FramesArguments& a, const ChosenFrames& frames) {
  return {{"data", a.data},
          {"layout", frames.all.layout},
          {"frames", frames.chosen.size()},
          {"skipped", frames.all.skipped},
          {"assumed", frames.all.assumed}};
}

}  // namespace ps::apps
