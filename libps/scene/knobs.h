// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "libps/eval/knob.h"
#include "libps/eval/perceptual.h"
#include "libps/scene/scene_builder.h"

namespace ps {

/// @brief What knobs of outpainting are tried with; networks must outlive the knobs.
struct OutpaintKnobOptions {
  SceneNetworks networks;         ///< with all scorers: "discriminator" and "entropy"
  SceneOptions scene;             ///< its samples and scorers are what is tried
  PerceptualDistance perceptual;  ///< may be empty
  int selection_samples = 16;     ///< completions that selections choose from
};

/// @brief How many completions are drawn of a view, one being kept by consensus: 1 to 100, or until
/// settled. The target is outpainted from the input alone and rendered from the cloud, as scenes
/// are. PSNR where the input does not see the target, and of all of it (and LPIPS).
Knob samples_knob(const OutpaintKnobOptions& options);

/// @brief How much sampling is held to the nearest seen colours (outpaint::OutpaintOptions). Scores
/// as samples_knob().
Knob guidance_knob(const OutpaintKnobOptions& options);

/// @brief Which opinion chooses the completion that is kept. Scores as samples_knob().
Knob selection_knob(const OutpaintKnobOptions& options);

// A cloud is fused of input and others, and the target, which was left out, is splatted from it
// as `render` does; PSNR where any of them sees the target's surface, holes being grey. Seconds are
// of one splat.
Knob radius_knob();            ///< of splats
Knob points_per_pixel_knob();  ///< that count
Knob budget_knob();            ///< points that are kept (budget.h), planned for all these cameras
Knob image_size_knob();        ///< of the splatted picture, which is then resized to the target's

/// @brief How the refiner computes, on what it is given of the target: splats of the input. PSNR of
/// its output against what the same network, transposed, computes directly in single precision:
/// sums in another order. So the most that can be told apart is what rounding of both differs by.
/// @param refiner  its weights
Knob arithmetic_knob(const nn::Weights& refiner);

/// A depth network of some width.
struct DepthWidth {
  std::string name;
  const models::DepthNet* net = nullptr;  ///< must outlive the knob
  DepthScale scale;
  bool is_default = false;
};

/// @brief How wide the depth network is: delta_1 and AbsRel of the input's depth, scaled to its
/// median. Seconds are of photo_depth().
Knob width_knob(const std::vector<DepthWidth>& widths);

}  // namespace ps
