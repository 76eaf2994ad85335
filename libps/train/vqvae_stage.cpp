// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "libps/core/error.h"
#include "libps/train/autoencoder.h"
#include "libps/train/stage.h"

namespace ps::train {
namespace {

constexpr int kShippedWidth = 64;
constexpr double kCommitment = 0.25;

Autoencoder::Widths widths_of(const TrainOptions& options) {
  if (options.width == kPaperWidth) return {};
  const int channels = width_of(options, kShippedWidth, 0);
  return {channels, channels / 2, channels / 2, 512};
}

/// The network looks no further than some cells, so a quarter of a picture teaches as much of what
/// it shows, and four times as many pictures are seen.
Tensor random_part(const Tensor& color, torch::Generator& generator) {
  const std::int64_t side = color.size(2) / 2;
  const Tensor at = torch::randint(side + 1, {2}, generator);
  return color.narrow(2, at[0].item<std::int64_t>(), side)
      .narrow(3, at[1].item<std::int64_t>(), side)
      .contiguous(torch::MemoryFormat::ChannelsLast);
}

class VqvaeStage : public Stage {
 public:
  VqvaeStage(const TrainOptions& options, torch::Device device)
      : net_(widths_of(options), options.seed),
        adam_(on_device(net_.parameters, device), {}),
        keep_codes_(options.keep_codes) {
    if (keep_codes_ && options.init.empty()) {
      throw Error("--keep-codes", "there are no codes to keep", "--init with weights of a VQ-VAE");
    }
  }

  StageDefaults defaults() const override { return {24, 8000, 1e-3}; }

  Values step(const Batch& batch, torch::Generator generator, double learning_rate) override {
    const Tensor color = random_part(batch.color, generator);
    if (keep_codes_) return decoder_step(color, learning_rate);
    const Tensor pre_quant = net_.encode(color);
    const Tensor codes = net_.nearest(pre_quant);
    const Tensor embedded = net_.embed(codes);
    const Tensor commitment = torch::mse_loss(pre_quant, embedded);
    const Tensor image = net_.decode(pre_quant + (embedded - pre_quant).detach());
    const Tensor l2 = torch::mse_loss(image, color);
    adam_.zero_gradients();
    (l2 + kCommitment * commitment).backward();
    const bool taken = adam_.step(learning_rate);
    net_.move_codebook(pre_quant, codes, generator);
    return {{"l2", l2.item<double>()},
            {"commitment", commitment.item<double>()},
            {"skipped", taken ? 0 : 1}};
  }

  /// The encoder has no gradient and stays as it is.
  Values decoder_step(const Tensor& color, double learning_rate) {
    Tensor embedded;
    {
      const torch::NoGradGuard guard;
      embedded = net_.embed(net_.nearest(net_.encode(color)));
    }
    const Tensor l2 = torch::mse_loss(net_.decode(embedded), color);
    adam_.zero_gradients();
    l2.backward();
    return {{"l2", l2.item<double>()}, {"skipped", adam_.step(learning_rate) ? 0 : 1}};
  }

  Values test(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor codes = net_.nearest(net_.encode(batch.color));
    const Tensor image = net_.decode(net_.embed(codes)).clamp(-1, 1);
    const Tensor error = (image - batch.color).square().mean({1, 2, 3}) / 4;
    const auto n = net_.parameters["quantize_t.cluster_size"].size(0);
    const Tensor used = torch::bincount(codes.flatten(), {}, n);
    const Tensor share = used.to(torch::kFloat64) / used.sum();
    const double entropy = -(share * torch::log2(share.clamp_min(1e-12))).sum().item<double>();
    return {{"psnr", (-10 * torch::log10(error)).mean().item<double>()},
            {"code_bits", entropy},
            {"codes_of_batch", (used > 0).sum().item<double>()}};
  }

  std::vector<std::vector<Tensor>> pictures(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor image = net_.decode(net_.embed(net_.nearest(net_.encode(batch.color))));
    std::vector<std::vector<Tensor>> rows;
    for (std::int64_t i = 0; i < batch.color.size(0); ++i) {
      rows.push_back({batch.color[i], image[i].clamp(-1, 1)});
    }
    return rows;
  }

  std::vector<Trained> networks() override { return {{&net_.parameters, &adam_}}; }

 private:
  Autoencoder net_;
  Adam adam_;
  bool keep_codes_;
};

}  // namespace

std::unique_ptr<Stage> make_vqvae_stage(const TrainOptions& options, torch::Device device) {
  return std::make_unique<VqvaeStage>(options, device);
}

}  // namespace ps::train
