// SPDX-License-Identifier: BSD-3-Clause
// `pixelsynth probe NETWORK` gives the goldens' numbers, and says in one line what it was not
// given.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "io/weights_file.h"
#include "libps/models/classifier.h"
#include "libps/models/lpips.h"
#include "libps/outpaint/sampler.h"
#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

using outpaint::Order;
using outpaint::Sampler;

const std::string kWeights = PS_DATA_DIR "/golden/weights.safetensors";

FileTensor planes_of(const nn::TensorView& view) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const nn::Shape& s = view.shape;
  std::vector<float> planes(s.pixels() * size(s.channels));
  nn::to_planes(view, planes.data());
  return FileTensor::of(planes, {size(s.images), size(s.channels), size(s.height), size(s.width)});
}

struct Outcome {
  int status = -1;
  std::string said;  ///< on stderr
  TensorMap tensors;
};

Outcome probe(const std::string& arguments, const std::string& weights, const TensorMap& in) {
  const Folder folder;
  const std::string out = folder / "out.safetensors";
  write_safetensors(folder / "in.safetensors", in);
  const std::string with = weights.empty() ? "" : " --weights '" + weights + "'";
  const std::string command = "'" PS_PROGRAM "' -q --seed 3 probe " + arguments + with + " --in '" +
                              (folder / "in.safetensors").string() + "' --out '" + out + "' 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    outcome.said += static_cast<char>(c);
  }
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  EXPECT_EQ(outcome.status == 0, std::filesystem::exists(out));
  if (outcome.status == 0) outcome.tensors = read_safetensors(out);
  return outcome;
}

TensorMap probed(const std::string& arguments, const std::string& weights, const TensorMap& in) {
  const Outcome outcome = probe(arguments, weights, in);
  EXPECT_EQ(outcome.status, 0) << outcome.said;
  EXPECT_EQ(outcome.said, "");
  return outcome.tensors;
}

std::string refused(const std::string& arguments, const std::string& weights, const TensorMap& in) {
  const Outcome outcome = probe(arguments, weights, in);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
  return outcome.said;
}

TensorMap goldens_of(const std::string& prefix) {
  TensorMap tensors;
  for (const auto& [name, tensor] : goldens()) {
    if (name.compare(0, prefix.size(), prefix) == 0) tensors[name] = tensor;
  }
  return tensors;
}

TEST(ProbeNetworks, depth_equals_its_golden) {
  const TensorMap out = probed("depth --prefix a. --min-z 2 --max-z 5", kWeights,
                               {{"a.input", planes_of(golden_picture())}});
  ASSERT_EQ(out.at("raw").shape, (std::vector<std::size_t>{1, 1, 256, 256}));
  expect_near("raw", every(5, tensor_of(out.at("raw"))), tensor_of(goldens().at("depth.raw")),
              1e-4);
  const auto raw = out.at("raw").as_floats(), depth = out.at("depth").as_floats();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    EXPECT_NEAR(depth[i], 2 + 3 / (1 + std::exp(-raw[i])), 1e-5);
  }
}

TEST(ProbeNetworks, vq_encode_equals_its_golden) {
  const TensorMap out = probed("vq-encode", kWeights, {{"input", planes_of(golden_corner())}});
  const nn::Tensor expected = tensor_of(goldens().at("vq.pre_quant"));
  const int seen = expected.shape().width;
  expect_near("pre_quant", corner_of(tensor_of(out.at("pre_quant")), seen), expected, 1e-4);
  ASSERT_EQ(out.at("codes").shape, (std::vector<std::size_t>{1, 12, 12}));
  const auto codes = ints_of(out.at("codes")), nearest = ints_of(goldens().at("vq.nearest"));
  const auto clear = bytes_of(goldens().at("vq.clear"));
  for (int y = 0; y < seen; ++y) {
    for (int x = 0; x < seen; ++x) {
      if (clear[y * seen + x] == 0) continue;
      EXPECT_EQ(codes[(12 - seen + y) * 12 + 12 - seen + x], nearest[y * seen + x]);
    }
  }
}

TEST(ProbeNetworks, vq_decode_equals_its_golden) {
  const TensorMap out = probed("vq-decode --prefix vq.", kWeights, goldens_of("vq."));
  expect_near("decoded", every(7, tensor_of(out.at("decoded"))),
              tensor_of(goldens().at("vq.decoded")), 1e-4);
}

TEST(ProbeNetworks, pixelcnn_equals_its_golden_with_and_without_missing_codes) {
  TensorMap in = goldens_of("pixelcnn.");
  expect_near("logits_masked",
              every(8, tensor_of(probed("pixelcnn --prefix pixelcnn.", kWeights, in).at("logits"))),
              tensor_of(in.at("pixelcnn.logits_masked")), 1, 5e-3);
  in.erase("pixelcnn.missing");
  expect_near(
      "logits_full",
      every(16, tensor_of(probed("pixelcnn --prefix pixelcnn.", kWeights, in).at("logits"))),
      tensor_of(in.at("pixelcnn.logits_full")), 1, 5e-3);
}

TEST(ProbeNetworks, refine_equals_its_golden) {
  TensorMap in = goldens_of("refine.");
  in["refine.combined"] = planes_of(golden_corner());
  const TensorMap out = probed("refine --prefix refine.", kWeights, in);
  const nn::Tensor expected = tensor_of(goldens().at("refine.output"));
  expect_near("output", corner_of(tensor_of(out.at("output")), expected.shape().width), expected,
              1e-4);
  const auto other = probed("refine --prefix refine. --matterport", kWeights, in).at("output");
  EXPECT_GT(difference(tensor_of(other), tensor_of(out.at("output"))).worst, 1e-3);
}

TEST(ProbeNetworks, discriminator_equals_its_golden) {
  const Folder folder;
  const std::string weights = folder / "both.safetensors";
  auto tensors = golden_weights().tensors();
  for (const auto& [name, tensor] : golden_weights().tensors()) {
    const std::string second = "netD.discriminator_1";
    if (name.compare(0, second.size(), second) == 0) {
      tensors["netD.discriminator_0" + name.substr(second.size())] = tensor;
    }
  }
  write_weights(weights, nn::Weights("both", tensors), FloatType::f32);
  const TensorMap out = probed("discriminator", weights, {{"fake", planes_of(golden_picture())}});
  expect_near("logits", tensor_of(out.at("scale1.layer4")),
              tensor_of(goldens().at("discriminator.scale1")), 1e-4);
  double score = 0;
  for (const char* name : {"scale0.layer4", "scale1.layer4"}) {
    const auto logits = out.at(name).as_floats();
    for (const float d : logits) {
      score += std::max(0.0, 1.0 + d) / static_cast<double>(2 * logits.size());
    }
  }
  EXPECT_NEAR(out.at("D_Fake").as_floats().at(0), score, 1e-5);
}

TEST(ProbeNetworks, lpips_and_classifier_give_what_the_library_gives) {
  const Folder folder;
  const std::string weights = folder / "w.safetensors";
  const nn::Tensor a = golden_corner(), b(a.shape());
  nn::Workspace workspace;
  write_weights(weights, random_lpips(8), FloatType::f32);
  float distance;
  Lpips(random_lpips(8)).distance(a, b, &distance, workspace);
  EXPECT_EQ(probed("lpips", weights, {{"a", planes_of(a)}, {"b", planes_of(b)}})
                .at("distance")
                .as_floats(),
            std::vector<float>{distance});

  write_weights(weights, random_classifier(4, 6), FloatType::f32);
  nn::Tensor logits({1, 1, 1, 6});
  Classifier(random_classifier(4, 6)).forward(a, logits, workspace);
  const FileTensor out = probed("classifier", weights, {{"input", planes_of(a)}}).at("logits");
  EXPECT_EQ(out.shape, (std::vector<std::size_t>{1, 6}));
  EXPECT_EQ(out.as_floats(), std::vector<float>(logits.data(), logits.data() + 6));
}

FileTensor golden_background_tensor() { return FileTensor::of(golden_background(), {1, 256, 256}); }

TEST(ProbeOutpaint, order_equals_its_golden) {
  const TensorMap out = probed("order", "", {{"bg256", golden_background_tensor()}});
  for (const char* name : {"order", "distance32", "missing32"}) {
    const FileTensor& expected = goldens().at(std::string("order.") + name);
    EXPECT_EQ(out.at(name).shape, expected.shape) << name;
    EXPECT_EQ(out.at(name).bytes, expected.bytes) << name;
  }
  EXPECT_EQ(out.at("mask_dilated").shape, (std::vector<std::size_t>{9, 1024}));
}

TEST(ProbeOutpaint, sample_gives_what_the_library_gives) {
  const std::vector<std::int32_t> codes = ints_of(goldens().at("pixelcnn.codes"));
  std::vector<std::uint8_t> background = golden_background();
  const Order order = outpaint::order_of(cv::Mat1b(256, 256, background.data()));
  const PixelCnn net(golden_weights());
  const TensorMap in = {{"codes", goldens().at("pixelcnn.codes")},
                        {"bg256", golden_background_tensor()}};
  for (const double temperature : {0.0, 1.2}) {
    outpaint::SampleOptions options;
    options.seed = 3;
    options.temperature = temperature;
    const auto expected = Sampler(net, order, codes).sample(2, 1, options)[0];
    const TensorMap out =
        probed("sample --completion 2 " +
                   (temperature > 0 ? std::string("--temperature 1.2") : "--greedy"),
               kWeights, in);
    EXPECT_EQ(ints_of(out.at("codes_out")), expected.codes);
    const auto tokens = ints_of(out.at("tokens"));
    std::size_t at = 0;
    for (const int cell : order.cells) {
      if (!order.missing[static_cast<std::size_t>(cell)]) continue;
      ASSERT_LT(at + 2, tokens.size());
      EXPECT_EQ(tokens[at] * 32 + tokens[at + 1], cell);
      EXPECT_EQ(tokens[at + 2], expected.codes[static_cast<std::size_t>(cell)]);
      at += 3;
    }
    EXPECT_EQ(at, tokens.size());
  }
}

TEST(ProbeOutpaint, say_what_they_were_not_given) {
  EXPECT_TRUE(has(refused("order", "", {{"bg", golden_background_tensor()}}), "bg256"));
  EXPECT_TRUE(
      has(refused("order", "", {{"bg256", FileTensor::of(std::vector<float>(12), {1, 3, 4})}}),
          "multiples of 8"));
  EXPECT_TRUE(
      has(refused("sample", kWeights,
                  {{"bg256", golden_background_tensor()}, {"codes", goldens().at("vq.clear")}}),
          "[1, 32, 32]"));
}

TEST(ProbeNetworks, refuse_what_is_no_number_and_depths_in_the_wrong_order) {
  nn::Tensor picture = golden_picture();
  picture.data()[5] = NAN;
  EXPECT_TRUE(has(refused("depth", kWeights, {{"input", planes_of(picture)}}), "'input' holds"));
  picture.data()[5] = 0;
  EXPECT_TRUE(has(refused("depth --min-z 5 --max-z 2", kWeights, {{"input", planes_of(picture)}}),
                  "--min-z"));
}

TEST(ProbeNetworks, never_write_over_what_they_read) {
  const Folder folder;
  const std::string file = folder / "in.safetensors", link = folder / "link.safetensors";
  write_safetensors(file, {{"input", planes_of(golden_picture())}});
  std::filesystem::create_symlink(file, link);
  const std::string before = ps::bytes_of(std::filesystem::path(file));
  const std::string command = "'" PS_PROGRAM "' -q probe depth --weights '" + kWeights +
                              "' --in '" + file + "' --out '" + link + "' 2>/dev/null";
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_EQ(ps::bytes_of(std::filesystem::path(file)), before);
}

TEST(ProbeNetworks, say_what_they_were_not_given) {
  const FileTensor corner = planes_of(golden_corner());
  EXPECT_TRUE(has(refused("depth", kWeights, {{"image", corner}}),
                  "in.safetensors: has no tensor 'input'; it has image"));
  EXPECT_TRUE(has(refused("depth", kWeights, {{"input", corner}}), "multiples of 256"));
  EXPECT_TRUE(has(refused("vq-encode", kWeights, {{"input", goldens().at("vq.codes")}}),
                  "tensor 'input' has the shape [1, 32, 32]; expected [any, 3, any, any]"));
  EXPECT_TRUE(has(refused("vq-decode", kWeights,
                          {{"codes", FileTensor::of(std::vector<std::int32_t>{600}, {1, 1, 1})}}),
                  "600"));
  EXPECT_TRUE(has(refused("vq-decode", kWeights,
                          {{"codes", FileTensor::of(std::vector<float>{NAN}, {1, 1, 1})}}),
                  "code"));
  TensorMap in = goldens_of("pixelcnn.");
  in["pixelcnn.mask_dilated"] = goldens().at("vq.codes");
  EXPECT_TRUE(has(refused("pixelcnn --prefix pixelcnn.", kWeights, in),
                  "'pixelcnn.mask_dilated' has the shape [1, 32, 32]; expected [9, 1024]"));
  in = {{"combined", corner},
        {"bg_dilated", goldens().at("refine.bg_dilated")},
        {"noise", goldens().at("vq.decoded")}};
  EXPECT_TRUE(has(refused("refine", kWeights, in), "tensor 'noise' has the shape"));
  in = {{"a", corner}, {"b", planes_of(golden_picture())}};
  EXPECT_TRUE(has(refused("lpips", kWeights, in), "weights.safetensors: tensor 'net.0.weight' is"));
  EXPECT_TRUE(
      has(refused("classifier", PS_DATA_DIR "/README.md", {{"input", corner}}), "README.md"));
  EXPECT_TRUE(has(refused("classifier", "absent.pth", {{"input", corner}}), "absent.pth"));
}

}  // namespace
}  // namespace ps::models
