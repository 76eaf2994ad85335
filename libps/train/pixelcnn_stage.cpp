// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "libps/core/error.h"
#include "libps/models/codebook_mark.h"
#include "libps/outpaint/nearest_seen.h"
#include "libps/train/autoencoder.h"
#include "libps/train/completions.h"
#include "libps/train/pixel_cnn.h"
#include "libps/train/stage.h"

namespace ps::train {
namespace {

constexpr int kPublishedWidth = 80, kShippedWidth = 32;
constexpr int kCompletions = 8;        ///< on a sheet
constexpr double kKnownWeight = 0.25;  ///< of cells that are seen anyway, in the loss

/// Where each cell of a square grid lands under one of its eight symmetries.
Tensor symmetry(int which, std::int64_t side) {
  Tensor cells = torch::arange(side * side).view({side, side});
  if (which & 1) cells = cells.flip({0});
  if (which & 2) cells = cells.flip({1});
  if (which & 4) cells = cells.t();
  return cells.reshape({-1}).contiguous();
}

class PixelCnnStage : public Stage {
 public:
  PixelCnnStage(const TrainOptions& options, torch::Device device)
      : autoencoder_(read_autoencoder(options.codes, device)),
        net_(width_of(options, kShippedWidth, kPublishedWidth), autoencoder_.codes(), options.seed),
        adam_(on_device(net_.parameters, device), adam_options()) {}

  StageDefaults defaults() const override { return {16, 12000, 1e-3}; }
  Augmentation augmentation() const override { return {true, true, true}; }
  Wanted wanted() const override { return {true, false, true}; }

  Values step(const Batch& batch, torch::Generator generator, double learning_rate) override {
    const Tensor codes = codes_of(batch.color);
    // Any order may meet any picture: orders change places, and are flipped and transposed.
    const std::int64_t n = codes.size(0), side = codes.size(1);
    const Tensor other = torch::randperm(n, generator).to(codes.device());
    const int which = static_cast<int>(torch::randint(8, {1}, generator).item<std::int64_t>());
    const Tensor map = symmetry(which, side).to(codes.device());
    const Tensor order =
        map.index_select(0, batch.order.index_select(0, other).flatten()).view({n, -1});
    const Tensor unseen =
        torch::zeros_like(batch.unseen).index_copy_(1, map, batch.unseen.index_select(0, other));
    const Tensor weight = kKnownWeight + (1 - kKnownWeight) * unseen.flatten();
    const Tensor logits = net_.forward(codes, order);
    const Tensor each = torch::nn::functional::cross_entropy(
        logits, codes.flatten(),
        torch::nn::functional::CrossEntropyFuncOptions().reduction(torch::kNone));
    const Tensor loss = (each * weight).sum() / weight.sum();
    adam_.zero_gradients();
    loss.backward();
    const bool taken = adam_.step(learning_rate);
    const torch::NoGradGuard guard;
    Tensor counts = net_.parameters["code_counts"];
    counts +=
        torch::bincount(codes.flatten(), {}, counts.size(0)).to(torch::kFloat32) / codes.numel();
    constexpr double kMost = 1e4;  // steps: an f16 holds it, though a run begins with another's
    counts *= std::min(1.0, kMost / counts.sum().item<double>());
    const double bits = (each.detach() * unseen.flatten()).sum().item<double>() /
                        std::max(unseen.sum().item<double>(), 1.0) / std::log(2.0);
    return {{"loss_bits", loss.item<double>() / std::log(2.0)},
            {"missing_bits", bits},
            {"skipped", taken ? 0 : 1}};
  }

  Values test(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor codes = codes_of(batch.color), flat = codes.flatten(),
                 unseen = batch.unseen.flatten();
    const double cells = std::max(unseen.sum().item<double>(), 1.0);
    const auto bits = [&](const Tensor& probability) {
      return -(torch::log2(probability.clamp_min(1e-12)) * unseen).sum().item<double>() / cells;
    };
    const auto given = [&](const Tensor& known) {
      return torch::softmax(net_.forward(known, batch.order), 1)
          .gather(1, flat.unsqueeze(1))
          .squeeze(1);
    };
    const Tensor projected =
        torch::where(batch.unseen.view_as(codes) > 0, codes, codes_of(continued(batch)));
    const Tensor& counts = net_.parameters["code_counts"];
    const Tensor unigram = (counts / counts.sum()).index_select(0, flat);
    const Tensor copied =
        (nearest_known(codes, batch.unseen) == codes.flatten(1)).flatten().to(torch::kFloat32);
    // The best weight of copying is chosen by looking: to the baseline's advantage.
    double copy_bits = 1e9;
    for (double p = .05; p < 1; p += .05)
      copy_bits = std::min(copy_bits, bits(p * copied + (1 - p) * unigram));
    return {{"missing_bits", bits(given(codes))},
            {"missing_bits_projected", bits(given(projected))},
            {"unigram_bits", bits(unigram)},
            {"copy_bits", copy_bits},
            {"missing_share", unseen.mean().item<double>()}};
  }

  /// Truth, projection, true codes decoded, and completions: beside what is seen, as the program
  /// would make them.
  std::vector<std::vector<Tensor>> pictures(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const auto decoded = [&](const Tensor& codes) {
      return autoencoder_.decode(autoencoder_.embed(codes)).clamp(-1, 1);
    };
    const Tensor image = decoded(codes_of(batch.color)), seen = codes_of(continued(batch));
    std::vector<std::vector<Tensor>> rows;
    for (std::int64_t i = 0; i < image.size(0); ++i) {
      rows.push_back({batch.color[i], batch.splat[i], image[i]});
      const Tensor made = decoded(
          completions(net_.parameters, seen[i], batch.order[i], batch.unseen[i], kCompletions));
      for (std::int64_t k = 0; k < kCompletions; ++k) {
        rows.back().push_back(torch::where(batch.missing[i] > 0, made[k], batch.splat[i]));
      }
    }
    return rows;
  }

  std::vector<Trained> networks() override { return {{&net_.parameters, &adam_}}; }

  std::map<std::string, std::string> metadata() const override {
    const Tensor embed = autoencoder_.parameters["quantize_t.embed"]
                             .detach()
                             .to(torch::kCPU, torch::kFloat32)
                             .contiguous();
    const auto* values = embed.data_ptr<float>();
    return {{models::kCodebookMark, models::codebook_mark({values, values + embed.numel()})}};
  }

 private:
  static Adam::Options adam_options() {
    Adam::Options options;
    options.beta2 = 0.999;
    return options;
  }

  Tensor codes_of(const Tensor& picture) const {
    const torch::NoGradGuard guard;
    return autoencoder_.nearest(autoencoder_.encode(picture));
  }

  /// What the program encodes: the projection, with the nearest colours where it is missing.
  static Tensor continued(const Batch& batch) {
    const Tensor missing = batch.missing.cpu().to(torch::kUInt8).contiguous();
    const auto h = missing.size(2), w = missing.size(3);
    std::vector<Tensor> pictures;
    for (std::int64_t i = 0; i < missing.size(0); ++i) {
      const cv::Mat1b mask(static_cast<int>(h), static_cast<int>(w),
                           missing[i].data_ptr<std::uint8_t>());
      const cv::Mat1i nearest = outpaint::nearest_seen(mask);
      const Tensor from =
          nearest.empty()
              ? torch::arange(h * w)
              : torch::from_blob(nearest.data, {h * w}, torch::kInt32).to(torch::kInt64);
      pictures.push_back(batch.splat[i]
                             .flatten(1)
                             .index_select(1, from.to(batch.splat.device()))
                             .view({-1, h, w}));
    }
    return torch::stack(pictures).contiguous(torch::MemoryFormat::ChannelsLast);
  }

  /// The code of the known cell that is nearest to each cell: [n, cells].
  static Tensor nearest_known(const Tensor& codes, const Tensor& unseen) {
    const std::int64_t side = codes.size(1), cells = side * side;
    const Tensor cell = torch::arange(cells, codes.options());
    const Tensor y = torch::div(cell, side, "floor"), x = cell - y * side;
    const Tensor distance =
        ((y.unsqueeze(1) - y).square() + (x.unsqueeze(1) - x).square()).to(torch::kFloat32);
    std::vector<Tensor> found;
    for (std::int64_t i = 0; i < codes.size(0); ++i) {
      const Tensor nearest = (distance + unseen[i].unsqueeze(0) * 1e6).argmin(1);
      found.push_back(codes[i].flatten().index_select(0, nearest));
    }
    return torch::stack(found);
  }

  Autoencoder autoencoder_;
  PixelCnn net_;
  Adam adam_;
};

}  // namespace

std::unique_ptr<Stage> make_pixelcnn_stage(const TrainOptions& options, torch::Device device) {
  return std::make_unique<PixelCnnStage>(options, device);
}

}  // namespace ps::train
