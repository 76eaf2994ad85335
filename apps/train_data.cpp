// SPDX-License-Identifier: BSD-3-Clause
#include "apps/train_data.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/frame_list.h"
#include "apps/interrupt.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "io/furniture.h"
#include "io/rgbd_folder.h"
#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "libps/scene/room_view.h"
#include "libps/train/room_examples.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

constexpr int kPairsPerRoom = 4, kRoomsPerShard = 64;
constexpr int kPairsPerShard = kPairsPerRoom * kRoomsPerShard;

struct DataArguments {
  std::string output, furniture;
  int rooms = 0;
  std::string rgbd, frames;
  int pairs_per_frame = 8;
  int most_apart = 6;
  bool poses_only = false;
};

fs::path shard_path(const DataArguments& a, const std::string& group, int number) {
  char name[64];
  std::snprintf(name, sizeof name, "%s-%04d.safetensors", group.c_str(), number);
  return fs::path(a.output) / name;
}

/// Shards that are there already are kept, so that a run that was stopped goes on.
/// @param pairs  how many in all   @param make  makes pair i
template <class Make>
int write_shards(const DataArguments& a, const std::string& group, int batches, int per_shard,
                 const Context& context, const Make& make) {
  std::error_code failed;
  fs::create_directories(a.output, failed);
  if (failed) throw Error(a.output, failed.message(), "a folder that can be made");
  const int shards = (batches + per_shard - 1) / per_shard;
  Progress progress(context, group, static_cast<std::size_t>(batches));
  int made = 0;
  for (int shard = 0; shard < shards; ++shard) {
    const fs::path path = shard_path(a, group, shard);
    const int first = shard * per_shard, count = std::min(per_shard, batches - first);
    if (!fs::exists(path)) {
      std::vector<std::vector<train::ExamplePair>> parts(static_cast<std::size_t>(count));
      parallel_for(parts.size(),
                   [&](std::size_t i) { parts[i] = make(first + static_cast<int>(i)); });
      std::vector<train::ExamplePair> pairs;
      for (auto& part : parts) {
        for (auto& pair : part) pairs.push_back(std::move(pair));
      }
      write_safetensors(path, train::to_shard(pairs));
      made += static_cast<int>(pairs.size());
    }
    progress.update(static_cast<std::size_t>(first + count));
  }
  return made;
}

int write_rooms(const DataArguments& a, const Context& context) {
  rooms::RoomOptions options;
  std::vector<rooms::Model> models;
  if (!a.furniture.empty()) {
    models = read_furniture(a.furniture).models;
    context.say(std::to_string(models.size()) + " pieces of furniture");
  }
  const rooms::Furniture furniture(models);
  if (!models.empty()) options.furniture = &furniture;
  return write_shards(a, train::kRooms, a.rooms, kRoomsPerShard, context, [&](int i) {
    return train::room_pairs(room_number(context.seed, static_cast<std::uint64_t>(i)), options,
                             kPairsPerRoom);
  });
}

int write_frames(const DataArguments& a, const Context& context) {
  const std::vector<RgbdFolder> folders = {open_rgbd_folder(a.rgbd, nullptr, !a.poses_only)};
  FrameChoice choice;
  if (!a.frames.empty()) parse_frames(a.frames, choice);
  const std::vector<ChosenFrame> used = choose_frames(folders, choice).used;
  if (used.size() < 2) throw Error(a.rgbd, "there are not two frames", "another --frames");
  const int count = static_cast<int>(used.size());
  const auto load = [&](int i) {
    return load_frame(folders[0], used[static_cast<std::size_t>(i)].frame);
  };
  const std::string group = a.poses_only ? train::kPosed : train::kFrames;
  return write_shards(a, group, count * a.pairs_per_frame, kPairsPerShard, context, [&](int i) {
    const int at = i % count;
    const std::array<std::uint32_t, 4> place = {static_cast<std::uint32_t>(i), 0, 0x66726du, 0};
    // Another frame, before or after it.
    int step = 1 + static_cast<int>(random_unit(context.seed, place) * a.most_apart);
    if (random_bits(context.seed, place)[2] % 2 == 0) step = -step;
    if (at + step < 0 || at + step >= count) step = -step;
    const int other = std::clamp(at + step, 0, count - 1);
    const std::uint64_t seed = context.seed * 1000000 + static_cast<std::uint64_t>(i);
    return std::vector<train::ExamplePair>{train::frame_pair(load(other), load(at), seed)};
  });
}

void run_data(const DataArguments& a, const Context& context) {
  if ((a.rooms > 0) == !a.rgbd.empty()) {
    throw CLI::ValidationError("train data", "expected either --rooms or --rgbd");
  }
  if (a.poses_only && a.rgbd.empty()) {
    throw CLI::ValidationError("--poses-only", "the depth of rooms is known; expected --rgbd");
  }
  note_interrupts();
  const Stopwatch total;
  const int made = a.rooms > 0 ? write_rooms(a, context) : write_frames(a, context);
  Json report = {{"output", a.output},
                 {"pairs", made},
                 {"images_per_second", 2 * made / std::max(total.seconds(), 1e-3)}};
  add_costs(report, total);
  end_run(context, report, a.output, std::to_string(made) + " pairs of views");
}

}  // namespace

void add_train_data(CLI::App& train, const Context& context) {
  auto* verb = train.add_subcommand("data",
                                    "Examples to train on: pairs of views of procedural rooms, or "
                                    "of the frames of an RGB-D folder. "
                                    "Shards that are there already are kept. --seed decides what "
                                    "is seen: never train and test on the same.");
  auto a = std::make_shared<DataArguments>();
  verb->add_option("-o,--output", a->output, "Folder of shards")->required()->type_name("DIR");
  verb->add_option("--rooms", a->rooms, "So many rooms, eight views of each")
      ->type_name("N")
      ->check(whole_in(0, 1000000));
  verb->add_option("--furniture", a->furniture,
                   "Sweet Home 3D catalogues (.sh3f) to furnish the rooms from")
      ->type_name("FILE|DIR");
  verb->add_option("--rgbd", a->rgbd, "Folder of real frames")->type_name("DIR");
  verb->add_option("--frames", a->frames, "Timestamps A:B of it, both included")->type_name("A:B");
  verb->add_option("--pairs-per-frame", a->pairs_per_frame, "Squares cut out of each frame")
      ->type_name("N")
      ->check(whole_in(1, 1000));
  verb->add_option("--most-apart", a->most_apart,
                   "Frames from the first of a pair to the second, at most")
      ->type_name("N")
      ->check(whole_in(1, 1000));
  verb->add_flag("--poses-only", a->poses_only,
                 "Of real frames, do not look at depth/, which need not be there: for `train depth "
                 "--supervision poses|both`");
  verb->callback([a, &context] { run_data(*a, context); });
}

}  // namespace ps::apps
