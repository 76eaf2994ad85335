// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "libps/geometry/depth_alignment.h"
#include "libps/geometry/free_space.h"
#include "libps/geometry/scene_cloud.h"
#include "libps/geometry/seam_colors.h"
#include "libps/geometry/splat.h"
#include "libps/outpaint/outpainter.h"
#include "libps/scene/photo_depth.h"

namespace ps {

/// The networks that make a scene; they must outlive whatever is given them.
struct SceneNetworks {
  outpaint::Outpainter::Networks outpaint;
  const models::DepthNet* depth = nullptr;
  DepthScale depth_scale;
};

struct SceneOptions {
  SceneCloudOptions cloud;
  SplatOptions splat;  ///< into the networks' view; its background is set to grey
  DepthAlignmentOptions alignment;
  SeamColorOptions colors;
  FreeSpaceOptions free_space;
  outpaint::OutpaintOptions outpaint;  ///< `view` is set to the view's number
};

/// What making one support view took and gave.
struct SupportReport {
  double missing_share = 0;  ///< of its pixels, dilated
  outpaint::OutpaintReport outpaint;
  int best = -1;       ///< the completion that was kept; -1 = nothing was missing
  bool agreed = true;  ///< its depth could be aligned to the cloud
  std::string why;     ///< why not
  double scale = 1, exponent = 1, residual = 0;  ///< of the alignment (depth_alignment.h)
  /// Median relative depth steps (depth_alignment.h): across the seam, by scale and exponent alone,
  /// and of surfaces before the seam.
  double seam_step = 0, seam_step_before = 0, seam_step_seen = 0;
  std::size_t pixels = 0;   ///< that nothing was projected to: candidates for new points
  std::size_t refused = 0;  ///< of them: would stand before what an observed view saw
  double splat_seconds = 0, outpaint_seconds = 0, depth_seconds = 0, align_seconds = 0;
};

/// @brief An outpainted view: all that adding it to the cloud takes.
struct SupportView {
  View view;    ///< colour (refined, continued), depth (aligned), the networks' lens, pose
  Mask pixels;  ///< that are to become points
  SupportReport report;
};

/// @brief One world, made of what was observed and of what was outpainted (SPEC.md 1; PixelSynth,
/// section 3). All views of the networks are through one lens, network_lens() of the photo's.
class SceneBuilder {
 public:
  /// @param lens  of the photo
  SceneBuilder(const SceneNetworks& networks, const Intrinsics& lens,
               const SceneOptions& options = {});
  ~SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;

  /// @brief Adds what a camera saw. A view whose short side is below 256 pixels is enlarged to
  /// that, so that its splats leave no holes in the networks' view. Throws ps::Error as
  /// SceneCloud::add() does.
  /// @param depth_again  gives the view's depth once more, the same; called by outpaint() where the
  /// view may tell of free space. Without it the depth is held.
  AddReport observe(const View& view, std::uint16_t number,
                    std::function<Depth()> depth_again = {});

  /// @brief Outpaints a view and makes its depth continue the cloud; the cloud stays as it is.
  /// A function of (networks, options, what was observed, cloud, pose, number). Where nothing is
  /// missing no network is run and no pixel is to be added. Of a cloud without strong colours
  /// none are outpainted (muted_colors.h).
  /// @return a view without colour when options.outpaint.progress stopped it
  SupportView outpaint(const Pose& world_from_cam, std::uint16_t number);

  /// @brief Adds the pixels of a support view that the cloud does not explain.
  AddReport add(const SupportView& support, std::uint16_t number);

  /// @brief Points that are alive; the same object until the next observe() or add().
  const Cloud& cloud();

  const Intrinsics& lens() const;  ///< the networks'

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ps
