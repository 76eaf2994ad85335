// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/room.h"
#include "libps/train/classifier.h"
#include "libps/train/stage.h"

namespace ps::train {
namespace {

constexpr int kPublishedWidth = 64, kShippedWidth = 16;

class ClassifierStage : public Stage {
 public:
  ClassifierStage(const TrainOptions& options, torch::Device device)
      : net_(width_of(options, kShippedWidth, kPublishedWidth), rooms::kRoomKinds, options.seed),
        adam_(on_device(net_.parameters, device), {}) {}

  StageDefaults defaults() const override { return {32, 3000, 1e-3}; }

  Values step(const Batch& batch, torch::Generator, double learning_rate) override {
    const Tensor loss = loss_of(net_.forward(batch.color, true), batch.kind);
    adam_.zero_gradients();
    loss.backward();
    const bool taken = adam_.step(learning_rate);
    return {{"loss", loss.item<double>()}, {"skipped", taken ? 0 : 1}};
  }

  Values test(const Batch& batch) override {
    const torch::NoGradGuard guard;
    const Tensor logits = net_.forward(batch.color, false);
    const Tensor known = batch.kind >= 0;
    const double count = std::max(known.sum().item<double>(), 1.0);
    const Tensor right = (logits.argmax(1) == batch.kind).logical_and(known);
    return {{"loss", loss_of(logits, batch.kind).item<double>()},
            {"accuracy", right.sum().item<double>() / count}};
  }

  std::vector<std::vector<Tensor>> pictures(const Batch& batch) override {
    std::vector<std::vector<Tensor>> rows;
    for (std::int64_t i = 0; i < batch.color.size(0); ++i) rows.push_back({batch.color[i]});
    return rows;
  }

  std::vector<Trained> networks() override { return {{&net_.parameters, &adam_}}; }

 private:
  /// Real frames are of no known kind and do not count.
  static Tensor loss_of(const Tensor& logits, const Tensor& kind) {
    const auto ignored =
        torch::nn::functional::CrossEntropyFuncOptions().ignore_index(-1).reduction(torch::kSum);
    return torch::nn::functional::cross_entropy(logits, kind, ignored) /
           (kind >= 0).sum().clamp_min(1);
  }

  Classifier net_;
  Adam adam_;
};

}  // namespace

std::unique_ptr<Stage> make_classifier_stage(const TrainOptions& options, torch::Device device) {
  return std::make_unique<ClassifierStage>(options, device);
}

}  // namespace ps::train
