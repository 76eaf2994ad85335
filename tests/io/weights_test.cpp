// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/weights.h"

#include <cmath>
#include <limits>

#include "tests/io/support.h"

namespace ps::nn {
namespace {

using Floats = std::vector<float>;
using Tensors = std::map<std::string, WeightTensor>;

constexpr std::size_t kAny = Weights::kAny;
const float kNaN = std::numeric_limits<float>::quiet_NaN();

Weights weights(const Tensors& tensors) { return {"w.pth", tensors}; }

TEST(Weights, tensors_are_found_by_name_and_shape) {
  const Weights w = weights({{"a.weight", {{2, 3}, {1, 2, 3, 4, 5, 6}}}, {"scalar", {{}, {7}}}});
  EXPECT_TRUE(w.has("a.weight"));
  EXPECT_FALSE(w.has("a"));
  EXPECT_TRUE(w.has_prefix("a."));
  EXPECT_TRUE(w.has_prefix("a.weight"));
  EXPECT_FALSE(w.has_prefix("a.weights"));
  EXPECT_FALSE(w.has_prefix("b"));
  EXPECT_FALSE(w.has_prefix("t"));
  EXPECT_EQ(w.get("a.weight", {2, 3}).values, (Floats{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(w.get("a.weight", {kAny, 3}).shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(w.get("scalar", {}).values, Floats{7});
}

TEST(Weights, a_failed_lookup_names_file_tensor_and_shapes) {
  Tensors tensors{{"a.weight", {{2, 3}, {1, 2, 3, 4, 5, 6}}},
                  {"empty", {{0, 3}, {}}},
                  {"nan", {{2}, {1, kNaN}}},
                  {"infinite", {{2}, {-HUGE_VALF, 1}}},
                  {"counter", {{}, {}, "I64"}}};
  const Weights w = weights(tensors);
  const auto said = [&](const std::string& name, const std::vector<std::size_t>& shape) {
    return error_of([&] { w.get(name, shape); });
  };
  EXPECT_EQ(said("absent", {kAny, 3}),
            "w.pth: tensor 'absent' is missing; expected the shape [any, 3]");
  EXPECT_EQ(said("a.weight", {3, 2}),
            "w.pth: tensor 'a.weight' has the shape [2, 3]; expected the shape [3, 2]");
  EXPECT_TRUE(has(said("a.weight", {2, 3, 1}), "[2, 3, 1]"));
  EXPECT_TRUE(has(said("a.weight", {}), "[2, 3]; expected the shape []"));
  EXPECT_TRUE(has(said("empty", {kAny, 3}), "'empty' has the shape [0, 3]"));
  EXPECT_TRUE(has(said("nan", {2}), "'nan' holds NaN (value 1 of 2)"));
  EXPECT_TRUE(has(said("infinite", {2}), "'infinite' holds infinity (value 0 of 2)"));
  EXPECT_TRUE(has(said("counter", {}), "'counter' is of type I64"));
}

TEST(Weights, tensors_whose_values_do_not_fill_their_shape_are_refused) {
  const auto said = [](const WeightTensor& tensor) {
    return error_of([&] { weights({{"a", tensor}}); });
  };
  EXPECT_TRUE(has(said({{2, 3}, {1}}), "'a' has 1 values"));
  EXPECT_TRUE(has(said({{}, {}}), "'a'"));
  EXPECT_TRUE(has(said({{std::size_t{1} << 40, std::size_t{1} << 40}, {}}), "'a'"));
}

TEST(Weights, a_plain_weight_is_taken_as_it_is) {
  const Weights w = weights({{"a.weight", {{1, 2}, {1, 2}}}, {"a.weight_v", {{2}, {9, 9}}}});
  EXPECT_EQ(w.layer("a", {1, 2}).values, (Floats{1, 2}));
  EXPECT_TRUE(has(error_of([&] { w.layer("b", {1, 2}); }), "'b.weight' is missing"));
  EXPECT_TRUE(has(error_of([&] { w.layer("a", {2, 1}); }), "'a.weight' has the shape"));
}

Tensors spectral() {
  return {{"a.weight_orig", {{2, 1, 1, 3}, {1, 2, 3, 4, 5, 6}}},
          {"a.weight_u", {{2}, {0.5f, -1}}},
          {"a.weight_v", {{3}, {1, 0, 2}}}};
}

TEST(Weights, spectral_norm_divides_by_u_M_v) {
  // M v = (7, 16), u . (7, 16) = -12.5
  const WeightTensor layer = weights(spectral()).layer("a", {2, 1, 1, 3});
  EXPECT_EQ(layer.shape, (std::vector<std::size_t>{2, 1, 1, 3}));
  EXPECT_EQ(layer.values, (Floats{-0.08f, -0.16f, -0.24f, -0.32f, -0.4f, -0.48f}));
}

TEST(Weights, spectral_norm_is_summed_in_double) {
  // In float, 2^24 + 1 - 2^24 is 0.
  const Weights w = weights({{"a.weight_orig", {{1, 3}, {16777216, 1, -16777216}}},
                             {"a.weight_u", {{1}, {1}}},
                             {"a.weight_v", {{3}, {1, 1, 1}}}});
  EXPECT_EQ(w.layer("a", {1, 3}).values, (Floats{16777216, 1, -16777216}));
}

TEST(Weights, an_unsound_spectral_norm_names_its_tensor) {
  const auto said = [](const std::string& name, const WeightTensor& tensor) {
    Tensors tensors = spectral();
    tensors[name] = tensor;
    return error_of([&] { weights(tensors).layer("a", {2, 1, 1, 3}); });
  };
  EXPECT_TRUE(has(said("a.weight_u", {{3}, {1, 1, 1}}), "'a.weight_u' has the shape [3]"));
  EXPECT_TRUE(has(said("a.weight_v", {{2}, {1, 1}}), "'a.weight_v' has the shape [2]"));
  EXPECT_TRUE(has(said("a.weight_v", {{3}, {0, 0, 0}}), "'a.weight_orig' is 0"));
  EXPECT_TRUE(has(said("a.weight_v", {{3}, {1, kNaN, 0}}), "'a.weight_v' holds NaN"));
  EXPECT_TRUE(has(said("a.weight_v", {{3}, {1e-40f, 0, 0}}), "'a.weight_orig' over"));
  Tensors tensors = spectral();
  tensors.erase("a.weight_u");
  EXPECT_TRUE(has(error_of([&] {
                    weights(tensors).layer("a", {2, 1, 1, 3});
                  }),
                  "'a.weight_u' is missing; expected the shape [2]"));
}

TEST(Weights, weight_norm_scales_rows_to_g) {
  const Weights w = weights({{"a.weight_g", {{2, 1}, {10, -2}}},
                             {"a.weight_v", {{2, 2}, {3, 4, 0, 0.5f}}},
                             {"b.weight_g", {{1, 1, 1}, {1}}},
                             {"b.weight_v", {{1, 2, 2}, {1e30f, 1e30f, 1e30f, -1e30f}}}});
  EXPECT_EQ(w.layer("a", {2, kAny}).values, (Floats{6, 8, 0, -2}));
  EXPECT_EQ(w.layer("b", {1, 2, 2}).values, (Floats{0.5f, 0.5f, 0.5f, -0.5f}));  // squares fit
}

TEST(Weights, an_unsound_weight_norm_names_its_tensor) {
  const auto said = [](const WeightTensor& g, const WeightTensor& v) {
    return error_of([&] { weights({{"a.weight_g", g}, {"a.weight_v", v}}).layer("a", {2, 2}); });
  };
  EXPECT_TRUE(has(said({{2}, {1, 1}}, {{2, 2}, {1, 1, 1, 1}}), "'a.weight_g' has the shape [2]"));
  EXPECT_TRUE(has(said({{2, 1}, {1, 1}}, {{2, 2}, {1, 1, 0, 0}}), "row 1 of tensor 'a.weight_v'"));
  EXPECT_TRUE(has(said({{2, 1}, {1, 1}}, {{1, 2}, {1, 1}}), "'a.weight_v' has the shape [1, 2]"));
  EXPECT_TRUE(has(error_of([] {
                    weights({{"a.weight_g", {{1, 1}, {1}}}}).layer("a", {1, 1});
                  }),
                  "'a.weight_v' is missing"));
  EXPECT_TRUE(has(error_of([] {
                    weights({{"a.weight_v", {{1, 1}, {1}}}}).layer("a", {1, 1});
                  }),
                  "'a.weight_g' is missing"));
}

TEST(Weights, vectors_may_be_absent_where_that_is_allowed) {
  const Weights w = weights({{"bias", {{2}, {1, 2}}}});
  EXPECT_EQ(w.vector("bias", 2), (Floats{1, 2}));
  EXPECT_EQ(w.vector("bias", kAny), (Floats{1, 2}));
  EXPECT_EQ(w.vector("absent", 3, true), Floats(3));
  EXPECT_TRUE(has(error_of([&] { w.vector("absent", 3); }), "'absent' is missing"));
  EXPECT_TRUE(has(error_of([&] { w.vector("bias", 3, true); }), "'bias' has the shape [2]"));
}

TEST(Weights, batch_norm_is_a_scale_and_a_shift) {
  const Tensors tensors{{"n.weight", {{2}, {3, -1}}},
                        {"n.bias", {{2}, {0.5f, 1}}},
                        {"n.running_mean", {{2}, {2, -4}}},
                        {"n.running_var", {{2}, {0.25f, 0}}}};
  const ScaleShift norm = batch_norm(weights(tensors), "n", 2);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto of = [&](const char* name) {
      return tensors.at(std::string("n.") + name).values[c];
    };
    const double deviation = std::sqrt(of("running_var") + 1e-5);
    const double y = (3.0 - of("running_mean")) / deviation * of("weight") + of("bias");
    EXPECT_NEAR(3.0 * norm.scale[c] + norm.shift[c], y, 1e-6 * std::abs(y));
  }
  Tensors negative = tensors;
  negative["n.running_var"].values[1] = -0.5f;
  EXPECT_TRUE(
      has(error_of([&] { batch_norm(weights(negative), "n", 2); }), "'n.running_var' holds -0.5"));
  EXPECT_TRUE(has(error_of([&] { batch_norm(weights(tensors), "n", 3); }), "'n.weight'"));
}

}  // namespace
}  // namespace ps::nn
