// SPDX-License-Identifier: BSD-3-Clause
#include "apps/start_pose.h"

#include "apps/cloud_arguments.h"
#include "io/trajectory.h"
#include "libps/scene/camera_path.h"

namespace ps::apps {

StartPose choose_start(const std::string& file, const std::string& cloud_path, const Cloud& cloud,
                       const Intrinsics& lens, const Context& context) {
  if (!file.empty()) return {read_trajectory(file).front().world_from_cam, 0};
  if (const auto found = find_beside(cloud_path, "trajectory.txt")) {
    context.say("start: first pose of " + found->string());
    return {read_trajectory(*found).front().world_from_cam, 0};
  }
  context.say("start: outside the cloud, all of it in view; --start says otherwise");
  const Framing framing = frame_cloud(cloud, lens);
  return {framing.world_from_cam, framing.distance};
}

}  // namespace ps::apps
