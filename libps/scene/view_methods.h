// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libps/scene/scene_builder.h"
#include "libps/scene/view_renderer.h"

namespace ps {

/// A picture that a method makes of a view nobody saw.
struct MethodView {
  Image color;  ///< [0,1], of the target lens's size
  Mask seen;    ///< 1 where the input's own points are shown; all 0 for `copy`
};

/// The networks of all methods; they must outlive whatever is given them.
struct MethodNetworks {
  SceneNetworks scene;  ///< of `ours`, with the scorers that it selects by
  std::map<std::string, outpaint::Scorer> scorers;  ///< "classifier" and "discriminator"
  /// Of `rgb`: its autoencoder's codes are colours (models/color_codes.h). Without refiner or
  /// scorers it takes those of `scene`.
  outpaint::Outpainter::Networks rgb;
};

struct ViewMethodOptions {
  SceneOptions scene;
  ViewRendererOptions renderer;
};

/// @brief A way to show, of one photo with depth, what another camera would see.
class ViewMethod {
 public:
  virtual ~ViewMethod();

  /// @brief A function of (method, networks, options, arguments), whatever was shown before. Not
  /// for two threads at once.
  /// @param input  its depth should have no holes
  /// @param lens   of the target; what is outpainted is seen through it
  /// @return without a picture when options.scene.outpaint.progress stopped it
  /// Throws ps::Error as SceneBuilder and ViewRenderer do.
  virtual MethodView show(const View& input, const Intrinsics& lens,
                          const Pose& world_from_cam) = 0;
};

/// @brief The methods (PixelSynth, section 4), in this order:
///
/// - `ours`: the target is outpainted and added to the cloud, which is rendered (view_renderer.h);
/// - `one-completion`: the same with one sample; `by-likelihood`, `by-classifier`,
///   `by-discriminator`: the same, of all samples the best in the eyes of this one alone;
///   `by-both`: of classifier and discriminator, the published selection;
/// - `sequential`: the same through poses in between, 15 degrees or so apart, each added in turn;
/// - `independent`: the outpainted picture as it is, beside the cloud;
/// - `no-outpainter`: the refiner fills in (Wiles et al., SynSin, CVPR 2020);
/// - `rgb`: as `ours`, with colours as codes, instead of learnt ones;
/// - `mean-colour`, `telea`, `navier-stokes`, `nearest`: hole_fill.h, on what the cloud shows;
/// - `copy`: the input itself, as if the camera had not moved.
const std::vector<std::string>& view_method_names();

/// @return false for those that are made of depth and pose alone. Throws ps::Error naming the
/// choices for any other name.
bool needs_networks(const std::string& name);

/// @brief Throws ps::Error naming the choices for an unknown name, and saying what is missing where
/// networks that the method needs are null.
std::unique_ptr<ViewMethod> make_view_method(const std::string& name,
                                             const MethodNetworks& networks,
                                             const ViewMethodOptions& options);

}  // namespace ps
