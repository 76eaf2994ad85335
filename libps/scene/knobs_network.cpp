// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/random.h"
#include "libps/eval/depth_metrics.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "libps/models/refiner.h"
#include "libps/scene/knob_clock.h"
#include "libps/scene/knobs.h"
#include "libps/scene/network_view.h"

namespace ps {
namespace {

/// @param values  of square kernels, one after another
void transpose(std::vector<float>& values, std::size_t side) {
  for (std::size_t k = 0; k + side * side <= values.size(); k += side * side) {
    for (std::size_t y = 0; y < side; ++y) {
      for (std::size_t x = 0; x < y; ++x) {
        std::swap(values[k + y * side + x], values[k + x * side + y]);
      }
    }
  }
}

/// The network that makes of a transposed picture the transposed output.
nn::Weights transposed(const nn::Weights& weights) {
  std::map<std::string, nn::WeightTensor> tensors = weights.tensors();
  for (auto& [name, tensor] : tensors) {
    if (tensor.shape.size() != 4 || tensor.shape[2] != tensor.shape[3]) continue;
    transpose(tensor.values, tensor.shape[2]);
    // Spectral norms multiply the kernels, in rows, by this vector.
    const std::size_t end = name.rfind("_orig");
    if (end == std::string::npos) continue;
    const auto vector = tensors.find(name.substr(0, end) + "_v");
    if (vector != tensors.end()) transpose(vector->second.values, tensor.shape[2]);
  }
  return {weights.name(), std::move(tensors)};
}

cv::Mat as_mat(const nn::TensorView& tensor) {
  return cv::Mat(tensor.shape.height, tensor.shape.width, CV_32FC(tensor.shape.channels),
                 tensor.pixel(0));
}

/// What the refiner is given: one picture, whether it is known, and noise.
struct RefinerInput {
  nn::Tensor picture;
  std::vector<float> noise;
};

RefinerInput refiner_input(const KnobSample& sample, std::size_t noise_count) {
  SplatOptions options;
  options.background = {.5f, .5f, .5f};
  const Intrinsics lens = network_lens(sample.input.intrinsics);
  const Splat seen = splat(lift(sample.input), lens, sample.target.world_from_cam, options);
  RefinerInput input = {nn::Tensor({1, lens.height, lens.width, 4}), {}};
  for (std::size_t i = 0; i < input.picture.shape().pixels(); ++i) {
    float* to = input.picture.data() + 4 * i;
    for (int c = 0; c < 3; ++c) to[c] = seen.color.ptr<cv::Vec3f>()[i][c] * 2 - 1;
    to[3] = seen.missing.data[i] != 0 ? 0.f : 1.f;
  }
  for (std::size_t i = 0; i < noise_count; ++i) {
    const auto place = static_cast<std::uint32_t>(i);
    input.noise.push_back(static_cast<float>(random_normal(0, {place, 0, 0, 0})[0]));
  }
  return input;
}

nn::Tensor refined(const models::Refiner& refiner, const RefinerInput& input,
                   nn::Workspace& workspace) {
  nn::Shape shape = input.picture.shape();
  shape.channels = 3;
  nn::Tensor output(shape);
  refiner.forward(input.picture, input.noise.data(), output, workspace);
  return output;
}

/// What the transposed network makes directly.
cv::Mat nearly_exact(const models::Refiner& of_transposed, const RefinerInput& input,
                     nn::Workspace& workspace) {
  const nn::Shape& shape = input.picture.shape();
  RefinerInput turned = {nn::Tensor({1, shape.width, shape.height, shape.channels}), input.noise};
  cv::Mat to = as_mat(turned.picture);
  cv::transpose(as_mat(input.picture), to);
  const nn::Tensor output = refined(of_transposed, turned, workspace);
  cv::Mat exact;
  cv::transpose(as_mat(output), exact);
  return exact;
}

/// dB; outputs reach from -1 to 1.
double psnr_of(const nn::Tensor& output, const cv::Mat& exact) {
  const double error = cv::norm(as_mat(output), exact, cv::NORM_L2);
  const double root_mean_square =
      error / std::sqrt(static_cast<double>(exact.total()) * exact.channels());
  return 20 * std::log10(2 / root_mean_square);
}

/// Near is bright; both by the truth's range.
Image shown(const Depth& depth, const Depth& truth) {
  std::vector<float> known;
  for (const float z : truth) {
    if (z > 0 && std::isfinite(z)) known.push_back(z);
  }
  Image image = Image::zeros(depth.size());
  if (known.empty()) return image;
  std::sort(known.begin(), known.end());
  const float nearest = known[known.size() / 50], farthest = known[known.size() - 1];
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth(y, x);
      if (!(z > 0)) continue;
      const float share = (1 / z - 1 / farthest) / (1 / nearest - 1 / farthest + 1e-9f);
      image(y, x) = cv::Vec3f::all(std::clamp(share, 0.f, 1.f));
    }
  }
  return image;
}

}  // namespace

Knob arithmetic_knob(const nn::Weights& weights) {
  Knob knob = {"arithmetic",
               "How the refiner's convolutions are computed, and how its weights are kept.",
               "one forward of the refiner",
               {{"PSNR against exact", "dB", true}},
               {{"f32 direct"}, {"f32 Winograd", true}, {"bf16 weights"}},
               5,
               {}};
  models::ModelOptions direct, automatic, half;
  direct.method = nn::Method::direct;
  half.storage = nn::Storage::bf16;
  const auto refiners = std::make_shared<std::vector<models::Refiner>>();
  for (const models::ModelOptions& options : {direct, automatic, half}) {
    refiners->emplace_back(weights, options);
  }
  const auto other = std::make_shared<models::Refiner>(transposed(weights), direct);
  const auto workspace = std::make_shared<nn::Workspace>();
  knob.prepare = [=](const KnobSample& sample) {
    const auto input = std::make_shared<RefinerInput>(refiner_input(sample, other->noise_count()));
    const cv::Mat exact = nearly_exact(*other, *input, *workspace);
    cv::Mat truth;
    exact.convertTo(truth, CV_32F, 0.5, 0.5);
    return KnobBench{
        Image(truth), [=](std::size_t s) {
          KnobTrial trial;
          nn::Tensor output;
          trial.seconds = seconds_of([&] { output = refined((*refiners)[s], *input, *workspace); });
          trial.scores = {psnr_of(output, exact)};
          trial.picture = from_network(output);
          return trial;
        }};
  };
  return knob;
}

Knob width_knob(const std::vector<DepthWidth>& widths) {
  Knob knob = {"width",
               "Width of the depth network.",
               "the depth of one photo",
               {{"delta_1", "", true}, {"AbsRel", "", false}},
               {},
               3,
               {}};
  for (const DepthWidth& width : widths) knob.settings.push_back({width.name, width.is_default});
  knob.prepare = [widths](const KnobSample& sample) {
    const auto input = std::make_shared<View>(sample.input);
    return KnobBench{shown(input->depth, input->depth), [=](std::size_t s) {
                       KnobTrial trial;
                       Depth depth;
                       trial.seconds = seconds_of([&] {
                         depth = photo_depth(*widths[s].net, input->color, input->intrinsics,
                                             widths[s].scale);
                       });
                       depth = median_scaled(depth, input->depth);
                       const DepthErrors errors = depth_errors(depth, input->depth);
                       trial.scores = {errors.delta[0], errors.abs_rel};
                       trial.picture = shown(depth, input->depth);
                       return trial;
                     }};
  };
  return knob;
}

}  // namespace ps
