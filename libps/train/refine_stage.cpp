// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>

#include "libps/train/autoencoder.h"
#include "libps/train/discriminator.h"
#include "libps/train/lpips.h"
#include "libps/train/refiner.h"
#include "libps/train/stage.h"

namespace ps::train {
namespace {

constexpr int kPublishedWidth = 64, kShippedWidth = 16;  ///< g, and d of the discriminator
/// Weights of losses. By L1 alone pictures blur; without it they are sharp in the wrong places.
constexpr double kPixels = 6, kPerceptual = 1.5, kAdversarial = 0.03, kMatching = 0.5;

double psnr(const Tensor& a, const Tensor& b, const Tensor& where) {
  const Tensor error =
      ((a - b).square() * where).sum({1, 2, 3}) / (3 * where.sum({1, 2, 3})).clamp_min(1) / 4;
  return (-10 * torch::log10(error.clamp_min(1e-9))).mean().item<double>();
}

/// What the refiner is given of a pair: the projection where there is one, decoded true codes
/// elsewhere.
struct Question {
  Tensor splat;     ///< [n, 3, h, w]
  Tensor combined;  ///< [n, 3, h, w]
  Tensor seen;      ///< [n, 1, h, w] 1 = projection
  Tensor truth;     ///< [n, 3, h, w]

  Tensor input() const {
    return torch::cat({combined, seen}, 1).contiguous(torch::MemoryFormat::ChannelsLast);
  }
};

class RefineStage : public Stage {
 public:
  RefineStage(const TrainOptions& options, torch::Device device)
      : autoencoder_(read_autoencoder(options.codes, device)),
        net_(width_of(options, kShippedWidth, kPublishedWidth), options.seed),
        critic_(width_of(options, kShippedWidth, kPublishedWidth), options.seed + 1),
        adam_(on_device(net_.parameters, device), betas()),
        critic_adam_(on_device(critic_.parameters, device), betas()) {
    if (!options.features.empty()) lpips_ = std::make_unique<Lpips>(options.features, device);
  }

  StageDefaults defaults() const override { return {8, 8000, 5e-4, 5}; }
  // A splat stands beside the picture: nothing may be cropped or flipped by itself.
  Augmentation augmentation() const override { return {false, false, false}; }
  Wanted wanted() const override { return {true, false, true}; }

  Values step(const Batch& batch, torch::Generator generator, double learning_rate) override {
    const Question question = part_of(question_of(batch), generator);
    const Tensor made = net_.forward(question.input(), generator, true);
    const auto real = critic_.forward(question.truth, true);
    const Tensor critic_loss = hinge_of_discriminator(real, critic_.forward(made.detach(), false));
    critic_adam_.zero_gradients();
    critic_loss.backward();
    bool taken = critic_adam_.step(learning_rate * 2);

    const auto judged = critic_.forward(made, false);
    const auto wanted = critic_.forward(question.truth, false);
    const Tensor l1 = torch::l1_loss(made, question.truth);
    const Tensor perceptual =
        lpips_ ? lpips_->distance(made, question.truth) : torch::zeros({}, l1.options());
    const Tensor matching = feature_matching(wanted, judged);
    adam_.zero_gradients();
    (kPixels * l1 + kPerceptual * perceptual + kAdversarial * hinge_of_generator(judged) +
     kMatching * matching)
        .backward();
    taken = adam_.step(learning_rate) && taken;
    return {{"l1", l1.item<double>()},
            {"perceptual", perceptual.item<double>()},
            {"matching", matching.item<double>()},
            {"critic", critic_loss.item<double>()},
            {"skipped", taken ? 0 : 1}};
  }

  Values test(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Question question = question_of(batch);
    const Tensor made = net_.forward(question.input(), generator_of(0, 0), false);
    const Tensor everywhere = torch::ones_like(question.seen);
    Values values = {{"psnr", psnr(made, question.truth, everywhere)},
                     {"psnr_seen", psnr(made, question.truth, question.seen)},
                     {"psnr_seen_unrefined", psnr(question.splat, question.truth, question.seen)},
                     {"psnr_combined", psnr(question.combined, question.truth, everywhere)}};
    if (lpips_) {
      const auto distance = [&](const Tensor& image) {
        // What is not seen is the same in both, so that it does not count.
        return lpips_->distance(image * question.seen, question.truth * question.seen)
            .item<double>();
      };
      values["lpips_seen"] = distance(made);
      values["lpips_seen_unrefined"] = distance(question.splat);
    }
    return values;
  }

  std::vector<std::vector<Tensor>> pictures(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Question question = question_of(batch);
    const Tensor made = net_.forward(question.input(), generator_of(0, 0), false);
    std::vector<std::vector<Tensor>> rows;
    for (std::int64_t i = 0; i < made.size(0); ++i) {
      rows.push_back(
          {question.splat[i], question.combined[i].clamp(-1, 1), made[i], question.truth[i]});
    }
    return rows;
  }

  std::vector<Trained> networks() override {
    return {{&net_.parameters, &adam_}, {&critic_.parameters, &critic_adam_}};
  }

 private:
  static Adam::Options betas() {
    Adam::Options options;
    options.beta1 = 0.5;
    options.beta2 = 0.9;
    return options;
  }

  Question question_of(const Batch& batch) const {
    const torch::NoGradGuard guard;
    const Tensor codes = autoencoder_.nearest(autoencoder_.encode(batch.color));
    const Tensor decoded = autoencoder_.decode(autoencoder_.embed(codes)).clamp(-1, 1);
    const Tensor seen = 1 - batch.missing;
    return {batch.splat, batch.splat * seen + decoded * batch.missing, seen, batch.color};
  }

  /// A quarter of the picture, the same of everything.
  static Question part_of(const Question& whole, torch::Generator& generator) {
    const std::int64_t side = whole.splat.size(2) / 2;
    const Tensor at = torch::randint(side / 8 + 1, {2}, generator) * 8;
    const auto y = at[0].item<std::int64_t>(), x = at[1].item<std::int64_t>();
    const auto cut = [&](const Tensor& t) {
      return t.narrow(2, y, side).narrow(3, x, side).contiguous(torch::MemoryFormat::ChannelsLast);
    };
    return {cut(whole.splat), cut(whole.combined), cut(whole.seen), cut(whole.truth)};
  }

  Autoencoder autoencoder_;
  Refiner net_;
  Discriminator critic_;
  Adam adam_, critic_adam_;
  std::unique_ptr<Lpips> lpips_;
};

}  // namespace

std::unique_ptr<Stage> make_refine_stage(const TrainOptions& options, torch::Device device) {
  return std::make_unique<RefineStage>(options, device);
}

}  // namespace ps::train
