// SPDX-License-Identifier: BSD-3-Clause
#include "apps/start_pose.h"

#include "io/trajectory.h"
#include "libps/scene/camera_path.h"

namespace ps::apps {

StartPose choose_start(const std::string& file, const CloudArguments& arguments, const Cloud& cloud,
                       const Intrinsics& lens, const Context& context) {
  if (!file.empty()) return {read_trajectory(file).front().world_from_cam, 0};
  if (const auto found = find_beside(arguments.cloud, "trajectory.txt")) {
    context.say("start: first pose of " + found->string());
    return {read_trajectory(*found).front().world_from_cam, 0};
  }
  context.say("start: outside the cloud, with " + arguments.up +
              " up; --up or --start says otherwise");
  const Framing framing = frame_cloud(cloud, lens, arguments.up);
  return {framing.world_from_cam, framing.distance};
}

}  // namespace ps::apps
