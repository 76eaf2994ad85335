// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "libps/core/error.h"
#include "libps/train/depth_net.h"
#include "libps/train/log_depth_loss.h"
#include "libps/train/reprojection.h"
#include "libps/train/stage.h"

namespace ps::train {
namespace {

constexpr double kMinZ = 0.25, kMaxZ = 25;  ///< canonical metres
constexpr int kPublishedWidth = 32, kShippedWidth = 16;

Tensor depth_of(const Tensor& raw) { return kMinZ + (kMaxZ - kMinZ) * torch::sigmoid(raw); }

/// Where depth is known; ones and zeros.
Tensor known(const Tensor& depth) { return (depth > 0).to(torch::kFloat32); }

/// The middle of the known values of each example.
Tensor masked_median(const Tensor& values, const Tensor& mask) {
  const Tensor marked = values.masked_fill(mask == 0, std::nan("")).flatten(1);
  return std::get<0>(torch::nanmedian(marked, 1)).view({-1, 1, 1, 1});
}

class DepthStage : public Stage {
 public:
  DepthStage(const TrainOptions& options, torch::Device device)
      : net_(width_of(options, kShippedWidth, kPublishedWidth), options.seed),
        adam_(on_device(net_.parameters, device), {}),
        by_depth_(options.supervision != "poses"),
        by_poses_(options.supervision != "depth") {
    if (by_depth_ && by_poses_ && options.supervision != "both") {
      throw Error("--supervision", "'" + options.supervision + "' is unknown",
                  "depth, poses or both");
    }
  }

  StageDefaults defaults() const override { return {8, 12000, 1.5e-3}; }

  Wanted wanted() const override { return {false, by_poses_, !by_poses_}; }

  Values step(const Batch& batch, torch::Generator, double learning_rate) override {
    const Tensor depth = depth_of(net_.forward(batch.color, true));
    Values values;
    Tensor loss = torch::zeros({}, depth.options());
    if (by_depth_) loss = loss + depth_loss(batch, depth, values);
    if (by_poses_) {
      const Tensor reprojection = mean_of_posed(batch, depth);
      values["reprojection"] = reprojection.item<double>();
      loss = loss + reprojection;
    }
    adam_.zero_gradients();
    loss.backward();
    values["skipped"] = adam_.step(learning_rate) ? 0 : 1;
    return values;
  }

  /// Beside the true depth, where there is any.
  static Tensor depth_loss(const Batch& batch, const Tensor& depth, Values& values) {
    const Tensor truth = torch::log(batch.depth.clamp(kMinZ, kMaxZ));
    const LogDepthLoss loss = log_depth_loss(torch::log(depth), truth, known(batch.depth));
    values["log_l1"] = loss.value.item<double>();
    values["gradient"] = loss.gradient.item<double>();
    return loss.sum;
  }

  static Tensor mean_of_posed(const Batch& batch, const Tensor& depth) {
    return reprojection_loss(batch, depth).sum() / batch.posed.sum().clamp_min(1);
  }

  void look_at(const Dataset& data) override {
    const torch::NoGradGuard guard;
    Tensor sum = torch::zeros({1, 1, data.side(), data.side()}), count = sum.clone();
    for (std::size_t group = 0; group < data.groups().size(); ++group) {
      for (const std::int64_t index : data.spread(group, 256, false)) {
        const Tensor depth = data.batch({index}, {}, torch::kCPU).depth;
        sum += torch::log(depth.clamp_min(1e-3)) * known(depth);
        count += known(depth);
      }
    }
    mean_depth_ = torch::exp(sum / count.clamp_min(1));
    ramp_ = torch::exp(sum.sum(3, true) / count.sum(3, true).clamp_min(1)).expand_as(sum);
  }

  Values test(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor all = depth_of(net_.forward(batch.color, false));
    Values values;
    if (by_poses_) values["reprojection"] = mean_of_posed(batch, all).item<double>();
    // Where nothing is known, there is nothing to be right or wrong about.
    const Tensor some = (known(batch.depth).sum({1, 2, 3}) > 0).nonzero().view({-1});
    if (some.numel() == 0) return values;
    const Tensor depth = all.index_select(0, some), truth = batch.depth.index_select(0, some);
    values.merge(scores(depth, truth, ""));
    values.merge(scores(torch::ones_like(depth), truth, "_constant"));
    for (const auto& [map, name] :
         {std::make_pair(ramp_, "_ramp"), std::make_pair(mean_depth_, "_mean")}) {
      if (!map.defined()) continue;
      values.merge(scores(map.to(depth.device()).expand_as(depth), truth, name));
    }
    return values;
  }

  /// @param name  of what guessed it, behind each score's
  static Values scores(const Tensor& depth, const Tensor& known_depth, const std::string& name) {
    const Tensor mask = known(known_depth);
    const Tensor scale = masked_median(known_depth, mask) / masked_median(depth, mask);
    const Tensor truth = known_depth.clamp_min(1e-3), scaled = depth * scale;
    const Tensor ratio = torch::max(scaled / truth, truth / scaled);
    const auto mean = [&](const Tensor& values) {
      return masked_mean(values, mask).mean().item<double>();
    };
    return {{"abs_rel" + name, mean((scaled - truth).abs() / truth)},
            {"delta1" + name, mean((ratio < 1.25).to(torch::kFloat32))},
            {"abs_rel_raw" + name, mean((depth - truth).abs() / truth)}};
  }

  std::vector<std::vector<Tensor>> pictures(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor depth = depth_of(net_.forward(batch.color, false));
    const auto grey = [](const Tensor& z) {
      if ((z > 0).sum().item<std::int64_t>() == 0)
        return torch::full_like(z, -1).expand({3, -1, -1});
      const Tensor inverse = z.clamp_min(1e-3).reciprocal();
      const double most =
          torch::quantile(inverse.masked_select(z > 0).slice(0, 0, 100000), .98).item<double>();
      return (inverse * (z > 0) / most * 2 - 1).clamp(-1, 1).expand({3, -1, -1});
    };
    std::vector<std::vector<Tensor>> rows;
    for (std::int64_t i = 0; i < batch.color.size(0); ++i) {
      rows.push_back({batch.color[i], grey(batch.depth[i]), grey(depth[i])});
    }
    return rows;
  }

  std::vector<Trained> networks() override { return {{&net_.parameters, &adam_}}; }
  std::map<std::string, std::string> metadata() const override {
    return {{"min_z", std::to_string(kMinZ)},
            {"max_z", std::to_string(kMaxZ)},
            {"canonical_focal", "1"}};
  }

 private:
  DepthNet net_;
  Adam adam_;
  bool by_depth_, by_poses_;
  Tensor mean_depth_, ramp_;  ///< of the training data: at each pixel, in each row
};

}  // namespace

std::unique_ptr<Stage> make_depth_stage(const TrainOptions& options, torch::Device device) {
  return std::make_unique<DepthStage>(options, device);
}

}  // namespace ps::train
