// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/classifier.h"

#include <cmath>

#include "tests/models/support.h"
#include "tests/nn/reference.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

namespace slow = nn::reference;

/// ResNet-18 as the paper draws it, operator by operator.
class SlowClassifier {
 public:
  explicit SlowClassifier(const nn::Weights& weights) : weights_(weights) {}

  slow::Values forward(const slow::Values& input) const {
    slow::Values x = relu(normed(input, "conv1", "bn1", 2, 3));
    x = slow::max_pool(x, {3, 2, 1, false});
    for (int stage = 1; stage <= 4; ++stage) {
      for (int i = 0; i < 2; ++i) {
        x = block(x, "layer" + std::to_string(stage) + "." + std::to_string(i) + ".",
                  stage > 1 && i == 0 ? 2 : 1);
      }
    }
    return slow::linear(slow::global_average(x), tensor("fc.weight"), tensor("fc.bias").values);
  }

 private:
  static slow::Values relu(const slow::Values& x) { return slow::activation(x, 0); }
  const nn::WeightTensor& tensor(const std::string& name) const {
    return weights_.tensors().at("classifier." + name);
  }

  slow::Values normed(const slow::Values& x, const std::string& convolution,
                      const std::string& norm, int stride, int padding) const {
    slow::Values y =
        slow::convolution(x, tensor(convolution + ".weight"), {}, {stride, padding, 1});
    for (std::size_t i = 0; i < y.values.size(); ++i) {
      const std::size_t c = i % static_cast<std::size_t>(y.shape.channels);
      const auto of = [&](const char* name) { return tensor(norm + name).values[c]; };
      y.values[i] = (y.values[i] - of(".running_mean")) / std::sqrt(of(".running_var") + 1e-5) *
                        of(".weight") +
                    of(".bias");
    }
    return y;
  }

  slow::Values block(const slow::Values& x, const std::string& name, int stride) const {
    const slow::Values inner = relu(normed(x, name + "conv1", name + "bn1", stride, 1));
    const slow::Values y = normed(inner, name + "conv2", name + "bn2", 1, 1);
    const bool changes = stride > 1 || x.shape.channels != y.shape.channels;
    const slow::Values straight =
        changes ? normed(x, name + "downsample.0", name + "downsample.1", stride, 0) : x;
    return relu(slow::map(y, straight, [](double a, double b) { return a + b; }));
  }

  const nn::Weights& weights_;
};

nn::Tensor waves(const nn::Shape& shape) {
  nn::Tensor tensor(shape);
  for (std::size_t i = 0; i < shape.pixels() * static_cast<std::size_t>(shape.channels); ++i) {
    tensor.data()[i] = std::sin(0.05f * static_cast<float>(i % 1009));
  }
  return tensor;
}

class ClassifierAgainstSlow : public testing::TestWithParam<Setting> {};

TEST_P(ClassifierAgainstSlow, equals_it_at_several_sizes) {
  const nn::Weights weights = random_classifier(8, 11);
  const Classifier net(weights, GetParam().options);
  ASSERT_EQ(net.classes(), 11);
  const SlowClassifier expected(weights);
  nn::Workspace workspace;
  for (const nn::Shape& shape : {nn::Shape{2, 64, 64, 3}, {1, 75, 50, 3}, {1, 1, 1, 3}}) {
    const nn::Tensor input = waves(shape);
    nn::Tensor logits({shape.images, 1, 1, 11}), slow_logits(logits.shape());
    net.forward(input, logits, workspace);
    const slow::Values values = expected.forward(slow::Values(input));
    std::copy(values.values.begin(), values.values.end(), slow_logits.data());
    expect_near("logits", logits, slow_logits, is_exact(GetParam()) ? 1e-5 : 3e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, ClassifierAgainstSlow, testing::ValuesIn(all_settings()),
                         name_of);

TEST(Classifier, normalises_as_it_was_trained) {
  nn::Tensor image({1, 1, 2, 3});
  const float black[] = {-1, -1, -1}, white[] = {1, 1, 1};
  std::copy_n(black, 3, image.view().pixel(0));
  std::copy_n(white, 3, image.view().pixel(1));
  Classifier::normalise(image, image);
  const double mean[] = {0.485, 0.456, 0.406}, deviation[] = {0.229, 0.224, 0.225};
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(image.view().pixel(0)[c], -mean[c] / deviation[c], 1e-6);
    EXPECT_NEAR(image.view().pixel(1)[c], (1 - mean[c]) / deviation[c], 1e-6);
  }
}

TEST(Classifier, reads_names_with_and_without_a_prefix) {
  const nn::Weights weights = random_classifier(2, 3);
  std::map<std::string, nn::WeightTensor> bare;
  for (const auto& [name, tensor] : weights.tensors()) bare[name.substr(11)] = tensor;
  const nn::Tensor input = waves({1, 32, 32, 3});
  nn::Workspace workspace;
  nn::Tensor a({1, 1, 1, 3}), b({1, 1, 1, 3});
  Classifier(weights).forward(input, a, workspace);
  Classifier(nn::Weights("bare", bare)).forward(input, b, workspace);
  EXPECT_EQ(difference(a, b).worst, 0);
}

TEST(Classifier, refuses_what_does_not_fit) {
  const Classifier net(random_classifier(2, 3));
  nn::Workspace workspace;
  nn::Tensor logits({1, 1, 1, 3}), input({1, 32, 32, 3});
  EXPECT_TRUE(has(error_of([&] {
                    net.forward(input, nn::Tensor({1, 1, 1, 4}), workspace);
                  }),
                  "logits has the shape"));
  EXPECT_TRUE(has(error_of([&] {
                    net.forward(nn::Tensor({1, 32, 32, 1}), logits, workspace);
                  }),
                  "3 channels"));
  auto tensors = random_classifier(2, 3).tensors();
  tensors.erase("classifier.layer3.0.downsample.1.running_mean");
  EXPECT_TRUE(has(error_of([&] { Classifier(nn::Weights("w", tensors)); }),
                  "'classifier.layer3.0.downsample.1.running_mean'"));
}

}  // namespace
}  // namespace ps::models
