// SPDX-License-Identifier: BSD-3-Clause
// LPIPS gives its authors' distances, and those of an obvious version.
#include "libps/models/lpips.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/photo.h"
#include "io/weights_file.h"
#include "tests/models/support.h"
#include "tests/nn/reference.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

namespace slow = nn::reference;

nn::Tensor picture(const std::string& name) {
  const Image image = read_photo(shared("weights/lpips/" + name)).color;
  nn::Tensor tensor({1, image.rows, image.cols, 3});
  float* to = tensor.data();
  for (const cv::Vec3f& pixel : image) {
    for (int c = 0; c < 3; ++c) *to++ = 2 * pixel[c] - 1;
  }
  return tensor;
}

class LpipsReference : public testing::TestWithParam<Setting> {};

TEST_P(LpipsReference, gives_the_authors_distances) {
  PS_NEED_SHARED("weights/lpips/lpips_squeeze_v0.1.safetensors");
  const Lpips net(read_weights(shared("weights/lpips/lpips_squeeze_v0.1.safetensors")),
                  GetParam().options);
  nn::Workspace workspace;
  const nn::Tensor reference = picture("ex_ref.png");
  const double bound = is_exact(GetParam()) ? 1e-4 : 1e-2;
  for (const auto& [name, expected] :
       {std::pair<const char*, double>{"ex_p0.png", 0.7110476}, {"ex_p1.png", 0.1479016}}) {
    float distance;
    net.distance(reference, picture(name), &distance, workspace);
    std::printf("  %s: %.7f, off by %.1e\n", name, distance, std::abs(distance - expected));
    EXPECT_NEAR(distance, expected, bound);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, LpipsReference, testing::ValuesIn(all_settings()), name_of);

/// SqueezeNet 1.1 and the distance as their papers say, operator by operator.
class SlowLpips {
 public:
  explicit SlowLpips(const nn::Weights& weights) : weights_(weights) {}

  double distance(const nn::TensorView& a, const nn::TensorView& b) const {
    const auto of_a = features(a), of_b = features(b);
    double sum = 0;
    for (std::size_t k = 0; k < of_a.size(); ++k) {
      const auto& weight = tensor("lin" + std::to_string(k) + ".model.1.weight").values;
      const slow::Values x = normalised(of_a[k]), y = normalised(of_b[k]);
      for (std::size_t i = 0; i < x.values.size(); ++i) {
        const double d = x.values[i] - y.values[i];
        sum += d * d * weight[i % weight.size()] / static_cast<double>(x.shape.pixels());
      }
    }
    return sum;
  }

  /// Of fire 9, each channel's mean over the pixels.
  std::vector<double> pooled(const nn::TensorView& image) const {
    const slow::Values last = features(image).back();
    const auto channels = static_cast<std::size_t>(last.shape.channels);
    std::vector<double> means(channels);
    for (std::size_t i = 0; i < last.values.size(); ++i) {
      means[i % channels] += last.values[i] / static_cast<double>(last.shape.pixels());
    }
    return means;
  }

 private:
  const nn::WeightTensor& tensor(const std::string& name) const {
    return weights_.tensors().at(name);
  }
  slow::Values layer(const slow::Values& x, const std::string& name, int stride,
                     int padding) const {
    return slow::activation(slow::convolution(x, tensor(name + ".weight"),
                                              tensor(name + ".bias").values, {stride, padding, 1}),
                            0);
  }
  slow::Values fire(const slow::Values& x, int index) const {
    const std::string name = "net." + std::to_string(index) + ".";
    const slow::Values narrow = layer(x, name + "squeeze", 1, 0),
                       one = layer(narrow, name + "expand1x1", 1, 0),
                       three = layer(narrow, name + "expand3x3", 1, 1);
    nn::Shape shape = one.shape;
    shape.channels += three.shape.channels;
    slow::Values both(shape);
    for (int y = 0; y < shape.height; ++y) {
      for (int u = 0; u < shape.width; ++u) {
        for (int c = 0; c < shape.channels; ++c) {
          const int split = one.shape.channels;
          both.at(0, y, u, c) = c < split ? one.at(0, y, u, c) : three.at(0, y, u, c - split);
        }
      }
    }
    return both;
  }
  std::vector<slow::Values> features(const nn::TensorView& image) const {
    slow::Values x = slow::scale_shift(slow::Values(image), {1 / .458f, 1 / .448f, 1 / .450f},
                                       {.030f / .458f, .088f / .448f, .188f / .450f});
    const auto pool = [&] { x = slow::max_pool(x, {3, 2, 0, true}); };
    std::vector<slow::Values> kept;
    kept.push_back(x = layer(x, "net.0", 2, 0));
    pool();
    x = fire(x, 3);
    kept.push_back(x = fire(x, 4));
    pool();
    x = fire(x, 6);
    kept.push_back(x = fire(x, 7));
    pool();
    for (int i = 9; i <= 12; ++i) kept.push_back(x = fire(x, i));
    return kept;
  }
  static slow::Values normalised(slow::Values x) {
    const auto channels = static_cast<std::size_t>(x.shape.channels);
    for (std::size_t i = 0; i < x.values.size(); i += channels) {
      double squares = 0;
      for (std::size_t c = 0; c < channels; ++c) squares += x.values[i + c] * x.values[i + c];
      for (std::size_t c = 0; c < channels; ++c) x.values[i + c] /= std::sqrt(squares) + 1e-10;
    }
    return x;
  }

  const nn::Weights& weights_;
};

TEST(Lpips, equals_an_obvious_version_at_several_sizes) {
  const nn::Weights weights = random_lpips(8);
  const Lpips net(weights);
  const SlowLpips expected(weights);
  nn::Workspace workspace;
  for (const auto& [height, width] : {std::pair<int, int>{64, 64}, {50, 41}, {17, 17}, {18, 40}}) {
    nn::Tensor a({2, height, width, 3}), b(a.shape());
    for (std::size_t i = 0; i < a.shape().pixels() * 3; ++i) {
      a.data()[i] = std::sin(0.05f * static_cast<float>(i % 1009));
      b.data()[i] = std::cos(0.04f * static_cast<float>(i % 997));
    }
    float distances[2];
    net.distance(a, b, distances, workspace);
    for (int i = 0; i < 2; ++i) {
      const double wanted = expected.distance(a.view().images(i, 1), b.view().images(i, 1));
      EXPECT_GT(wanted, 0.01);
      EXPECT_NEAR(distances[i], wanted, 1e-5 * wanted) << height << "x" << width;
    }
  }
}

TEST(Lpips, features_equal_those_of_an_obvious_version) {
  const nn::Weights weights = random_lpips(8);
  const Lpips net(weights);
  const SlowLpips expected(weights);
  nn::Workspace workspace;
  for (const auto& [height, width] : {std::pair<int, int>{64, 50}, {17, 17}}) {
    nn::Tensor images({2, height, width, 3});
    for (std::size_t i = 0; i < images.shape().pixels() * 3; ++i) {
      images.data()[i] = std::sin(0.05f * static_cast<float>(i % 1009));
    }
    const auto count = static_cast<std::size_t>(net.feature_count());
    ASSERT_EQ(count, 64u);
    std::vector<float> features(2 * count);
    net.features(images, features.data(), workspace);
    for (std::size_t n = 0; n < 2; ++n) {
      const auto wanted = expected.pooled(images.view().images(static_cast<int>(n), 1));
      const double most = *std::max_element(wanted.begin(), wanted.end());
      EXPECT_GT(most, 0.01);
      for (std::size_t c = 0; c < count; ++c) {
        EXPECT_NEAR(features[n * count + c], wanted[c], 1e-5 * most);
      }
    }
  }
}

TEST(Lpips, is_zero_for_the_same_image_and_the_same_both_ways) {
  const Lpips net(random_lpips(8));
  nn::Workspace workspace;
  nn::Tensor a({1, 32, 32, 3}), b(a.shape());
  for (std::size_t i = 0; i < a.shape().pixels() * 3; ++i) {
    a.data()[i] = std::sin(static_cast<float>(i));
  }
  float same, there, back;
  net.distance(a, a, &same, workspace);
  net.distance(a, b, &there, workspace);
  net.distance(b, a, &back, workspace);
  EXPECT_EQ(same, 0);
  EXPECT_GT(there, 0);
  EXPECT_EQ(there, back);
}

TEST(Lpips, refuses_what_does_not_fit) {
  const Lpips net(random_lpips(8));
  nn::Workspace workspace;
  float distance;
  const auto measure = [&](const nn::Shape& a, const nn::Shape& b) {
    return error_of([&] { net.distance(nn::Tensor(a), nn::Tensor(b), &distance, workspace); });
  };
  EXPECT_TRUE(has(measure({1, 16, 32, 3}, {1, 16, 32, 3}), "at least 17 pixels"));
  EXPECT_TRUE(has(measure({1, 32, 32, 3}, {1, 32, 33, 3}), "the second image has the shape"));
  EXPECT_TRUE(has(error_of([&] {
                    net.features(nn::Tensor({1, 16, 32, 3}), &distance, workspace);
                  }),
                  "at least 17 pixels"));
  auto tensors = random_lpips(8).tensors();
  tensors.erase("lin4.model.1.weight");
  EXPECT_TRUE(has(error_of([&] { Lpips(nn::Weights("w", tensors)); }), "'lin4.model.1.weight'"));
}

}  // namespace
}  // namespace ps::models
