// SPDX-License-Identifier: BSD-3-Clause
// Every stage, on two rooms and with networks of a few channels.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "io/weights_file.h"
#include "libps/models/autoencoder.h"
#include "libps/models/classifier.h"
#include "libps/models/codebook_mark.h"
#include "libps/models/depth_net.h"
#include "libps/models/discriminator.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"
#include "libps/train/depth_net.h"
#include "libps/train/room_examples.h"
#include "libps/train/train.h"
#include "tests/train/support.h"

namespace fs = std::filesystem;

namespace ps::train {
namespace {

class Training : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = fs::temp_directory_path() / ("ps_train_" + std::to_string(getpid()));
    for (const char* part : {"train", "test"}) {
      fs::create_directories(folder() / "data" / part);
      write_safetensors(folder() / "data" / part / "rooms-0000.safetensors",
                        to_shard(room_pairs(part[1] == 'r' ? 1 : 2, {}, 2)));
    }
    TrainOptions codes = options("vqvae", "codes");
    codes.width = 8;
    train(codes, {});
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  static fs::path& folder() {
    static fs::path path;
    return path;
  }

  static TrainOptions options(const std::string& stage, const std::string& out) {
    TrainOptions o;
    o.stage = stage;
    o.train = folder() / "data" / "train";
    o.test = folder() / "data" / "test";
    o.out = folder() / out;
    o.codes = folder() / "codes" / "weights.safetensors";
    o.width = 2;
    o.batch = 2;
    o.steps = 4;
    o.test_count = 2;
    return o;
  }

  /// Trains, and looks at what is told and written.
  static nn::Weights trained(const std::string& stage, const std::string& score) {
    TrainOptions o = options(stage, stage);
    if (stage == "pixelcnn") o.width = 4;
    int sheets = 0;
    std::int64_t last = 0;
    const TrainReport report = train(o, [&](const TrainEvent& event) {
      last = event.step;
      if (event.sheet != nullptr && event.sheet->rgb.size() > 0) ++sheets;
      return true;
    });
    EXPECT_EQ(last, 4);
    EXPECT_EQ(sheets, 1);
    EXPECT_EQ(report.scores.count("rooms_" + score), 1u);
    EXPECT_NE(bytes_of(o.out / "log.csv").find("4,test,rooms_" + score), std::string::npos);
    EXPECT_EQ(read_metadata(report.weights).at("stage"), stage);
    return read_weights(report.weights);
  }
};

TEST_F(Training, makes_an_autoencoder_that_models_reads) {
  EXPECT_EQ(models::Autoencoder(trained("vqvae", "psnr")).codes(), 512);
}

TEST_F(Training, makes_a_depth_net_that_models_reads) {
  const models::DepthNet net(trained("depth", "abs_rel"));
  EXPECT_EQ(read_metadata(folder() / "depth" / "weights.safetensors").at("canonical_focal"), "1");
}

TEST_F(Training, makes_a_refiner_and_a_discriminator_that_models_reads) {
  const nn::Weights weights = trained("refine", "psnr_seen");
  const models::Refiner refiner(weights);
  const models::Discriminator discriminator(weights);
  EXPECT_GT(refiner.noise_count(), 0u);
}

TEST_F(Training, makes_a_pixel_cnn_that_models_reads) {
  const models::PixelCnn net(trained("pixelcnn", "missing_bits"));
  EXPECT_EQ(net.codes(), 512);
  const auto read = read_weights(options("pixelcnn", "pixelcnn").codes);
  const std::vector<float> embed = read.tensors().at("vqvae.quantize_t.embed").values;
  EXPECT_EQ(read_metadata(folder() / "pixelcnn" / "weights.safetensors").at(models::kCodebookMark),
            models::codebook_mark(embed));
}

TEST_F(Training, shows_eight_completions_of_each_view) {
  TrainOptions o = options("pixelcnn", "sheet");
  o.width = 4;
  o.steps = 1;
  cv::Size size;
  train(o, [&](const TrainEvent& event) {
    if (event.sheet != nullptr) size = {event.sheet->width, event.sheet->height};
    return true;
  });
  // Truth, projection, true codes, completions; a row for each of the two test views.
  EXPECT_EQ(size, cv::Size((3 + 8) * 256, 2 * 256));
}

TEST_F(Training, published_widths_can_be_asked_for_and_runs_scaled) {
  TrainOptions o = options("depth", "paper");
  o.width = kPaperWidth;
  o.steps = 0;
  o.steps_scale = 1e-9;
  const TrainReport report = train(o, {});
  EXPECT_EQ(report.steps, 1);
  EXPECT_EQ(report.parameters, DepthNet(32, 0).parameters.count());
}

TEST_F(Training, makes_a_classifier_that_models_reads) {
  EXPECT_EQ(models::Classifier(trained("classifier", "accuracy")).classes(), 8);
}

TEST_F(Training, goes_on_to_the_same_bytes_after_an_interruption) {
  TrainOptions whole = options("depth", "whole"), part = options("depth", "part");
  train(whole, {});
  part.stop_after = 1;
  train(part, {});
  part.stop_after = 2;
  train(part, {});
  part.stop_after = 0;
  EXPECT_EQ(train(part, {}).steps, 4);
  for (const char* file : {"checkpoint.safetensors", "weights.safetensors"}) {
    EXPECT_EQ(bytes_of(whole.out / file), bytes_of(part.out / file)) << file;
  }
}

TEST_F(Training, of_a_decoder_keeps_the_codes) {
  TrainOptions o = options("vqvae", "decoder");
  o.width = 8;
  o.keep_codes = true;
  EXPECT_NE(message_of(o).find("--keep-codes"), std::string::npos);
  o.init = o.codes;
  o.arithmetic = "bf16";
  train(o, {});
  const nn::Weights before = read_weights(o.init),
                    after = read_weights(o.out / "weights.safetensors");
  const auto same = [&](const std::string& name) {
    return before.tensors().at(name).values == after.tensors().at(name).values;
  };
  TrainOptions other = o;
  other.keep_codes = false;
  EXPECT_NE(message_of(other).find("--keep-codes"), std::string::npos);
  other = o;
  other.arithmetic = "f32";
  EXPECT_NE(message_of(other).find("--arithmetic bf16"), std::string::npos);
  EXPECT_TRUE(same("vqvae.quantize_t.embed"));
  EXPECT_TRUE(same("vqvae.enc_b.blocks.0.weight"));
  EXPECT_TRUE(same("vqvae.quantize_conv_t.bias"));
  EXPECT_FALSE(same("vqvae.dec.blocks.6.weight"));
}

TEST_F(Training, of_completions_in_colours_needs_no_autoencoder) {
  TrainOptions o = options("pixelcnn", "colours");
  o.width = 4;
  o.codes = kColors;
  o.arithmetic = "bf16";
  const TrainReport report = train(o, {});
  EXPECT_GT(report.scores.at("rooms_missing_bits"), 0);
  TrainOptions other = o;
  other.codes = folder() / "codes" / "weights.safetensors";
  EXPECT_NE(message_of(other).find("--codes"), std::string::npos);
  o.arithmetic = "decimal";
  EXPECT_NE(message_of(o).find("'decimal'"), std::string::npos);
}

TEST_F(Training, stops_when_told_to_and_can_be_gone_on_with) {
  const TrainOptions o = options("depth", "stopped");
  TrainOptions often = o;
  often.test_every = 2;
  EXPECT_EQ(train(often, [](const TrainEvent&) { return false; }).steps, 2);
  EXPECT_EQ(train(o, {}).steps, 4);
}

TEST_F(Training, another_seed_makes_another_network) {
  TrainOptions one = options("depth", "seed1"), two = options("depth", "seed2");
  one.steps = two.steps = 1;
  two.seed = 2;
  train(one, {});
  train(two, {});
  EXPECT_NE(bytes_of(one.out / "weights.safetensors"), bytes_of(two.out / "weights.safetensors"));
}

TEST_F(Training, begins_with_given_weights) {
  TrainOptions o = options("depth", "begun");
  o.steps = 1;
  o.learning_rate = 1e-12;
  o.seed = 3;
  o.init = folder() / "seed_init" / "weights.safetensors";
  TrainOptions first = options("depth", "seed_init");
  first.steps = 1;
  train(first, {});
  train(o, {});
  const auto conv = [](const fs::path& file) {
    return read_weights(file).get("pts_regressor.conv3.weight", {0, 0, 4, 4}).values;
  };
  const auto a = conv(o.init), b = conv(o.out / "weights.safetensors");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-5);
}

TEST_F(Training, bad_input_is_named) {
  TrainOptions o = options("nothing", "bad");
  EXPECT_NE(message_of(o).find("'nothing'"), std::string::npos);
  o = options("depth", "bad");
  o.train = folder() / "codes";
  EXPECT_NE(message_of(o).find("there is no color"), std::string::npos);
  o.train = folder() / "empty";
  EXPECT_NE(message_of(o).find("there are no examples"), std::string::npos);
  o = options("pixelcnn", "bad");
  o.codes.clear();
  EXPECT_NE(message_of(o).find("--codes"), std::string::npos);
  o.codes = folder() / "data" / "train" / "rooms-0000.safetensors";
  EXPECT_NE(message_of(o).find("weights of a VQ-VAE"), std::string::npos);
  o = options("depth", "codes");  // a run of another stage
  EXPECT_NE(message_of(o).find("not of stage depth"), std::string::npos);
  o = options("depth", "bad");
  o.device = "abacus";
  EXPECT_NE(message_of(o).find("'abacus'"), std::string::npos);
}

}  // namespace
}  // namespace ps::train
