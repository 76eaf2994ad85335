// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/probe.h"
#include "apps/program.h"
#include "apps/report.h"
#include "io/weights_file.h"
#include "libps/core/error.h"
#include "libps/models/autoencoder.h"
#include "libps/models/classifier.h"
#include "libps/models/depth_net.h"
#include "libps/models/discriminator.h"
#include "libps/models/lpips.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"

namespace ps::apps {
namespace {

struct NetworkArguments {
  ProbeFiles files;
  std::string weights;
  double min_z = 1, max_z = 100;
  bool matterport = false;
};

/// One run of one network.
struct Job {
  const NetworkArguments& arguments;
  const ProbeInput in;
  const nn::Weights weights;
  TensorMap out = {};
  nn::Workspace workspace = {};
  double seconds = 0;  ///< of the forward alone

  void time(const std::function<void()>& forward) {
    const Stopwatch watch;
    forward();
    seconds = watch.seconds();
  }
};

int side(const FileTensor& tensor, std::size_t axis) {
  return static_cast<int>(tensor.shape.at(axis));
}

nn::Tensor image_of(const Job& job, const std::string& name) {
  const FileTensor& planes = job.in.take(name, {0, 3, 0, 0});
  nn::Tensor image({side(planes, 0), side(planes, 2), side(planes, 3), 3});
  nn::from_planes(planes.as_floats().data(), image);
  return image;
}

FileTensor planes_of(const nn::TensorView& view) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const nn::Shape& s = view.shape;
  std::vector<float> planes(s.pixels() * size(s.channels));
  nn::to_planes(view, planes.data());
  return FileTensor::of(planes, {size(s.images), size(s.channels), size(s.height), size(s.width)});
}

nn::Tensor like(const nn::Tensor& tensor, int channels) {
  nn::Shape shape = tensor.shape();
  shape.channels = channels;
  return nn::Tensor(shape);
}

void run_depth(Job& job) {
  const models::DepthNet net(job.weights);
  const nn::Tensor image = image_of(job, "input");
  const nn::Tensor raw = like(image, 1);
  job.time([&] { net.forward(image, raw, job.workspace); });
  job.out["raw"] = planes_of(raw);
  models::depth_of_raw(raw, static_cast<float>(job.arguments.min_z),
                       static_cast<float>(job.arguments.max_z), raw);
  job.out["depth"] = planes_of(raw);
}

void run_vq_encode(Job& job) {
  const models::Autoencoder net(job.weights);
  const nn::Tensor image = image_of(job, "input");
  const nn::Tensor pre_quant(net.grid(image.shape()));
  std::vector<std::int32_t> codes(pre_quant.shape().pixels());
  job.time([&] {
    net.encode(image, pre_quant, job.workspace);
    net.quantise(pre_quant, codes.data());
  });
  job.out["pre_quant"] = planes_of(pre_quant);
  const auto& shape = job.out["pre_quant"].shape;
  job.out["codes"] = FileTensor::of(codes, {shape[0], shape[2], shape[3]});
}

void run_vq_decode(Job& job) {
  const models::Autoencoder net(job.weights);
  const FileTensor& grid = job.in.take("codes", {0, 0, 0});
  const auto codes = job.in.codes("codes", {0, 0, 0});
  constexpr int kCell = models::Autoencoder::kCell;
  const nn::Tensor image({side(grid, 0), side(grid, 1) * kCell, side(grid, 2) * kCell, 3});
  job.time([&] { net.decode(codes.data(), image, job.workspace); });
  job.out["decoded"] = planes_of(image);
}

void run_pixel_cnn(Job& job) {
  const models::PixelCnn net(job.weights);
  const FileTensor& grid = job.in.take("codes", {0, 0, 0});
  const std::size_t cells = grid.shape[1] * grid.shape[2];
  const auto mask = [&](const char* name) { return mask_of(job.in.take(name, {9, cells})); };
  models::LocalMasks masks;
  if (job.in.has("bg256")) {
    const outpaint::Order order = order_of(job.in);
    if (order.height != side(grid, 1) || order.width != side(grid, 2)) {
      throw Error(job.arguments.files.in,
                  "bg256 has " + std::to_string(order.height) + "x" + std::to_string(order.width) +
                      " cells, codes " + std::to_string(side(grid, 1)) + "x" +
                      std::to_string(side(grid, 2)),
                  "8 pixels of bg256 along each side of a code");
    }
    masks = order.masks;
  } else {
    masks = {mask("mask_init"), mask("mask_undilated"), mask("mask_dilated")};
  }
  auto codes = job.in.codes("codes", {0, 0, 0});
  if (job.in.has("missing")) {
    const auto missing = mask_of(job.in.take("missing", {grid.shape[1], grid.shape[2]}));
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (missing[i % cells] != 0) codes[i] = -1;
    }
  }
  const nn::Tensor logits({side(grid, 0), side(grid, 1), side(grid, 2), net.codes()});
  job.time([&] { net.forward(codes.data(), masks, logits, job.workspace); });
  job.out["logits"] = planes_of(logits);
}

void run_refine(Job& job) {
  const models::Refiner net(job.weights, {},
                            job.arguments.matterport ? models::Refiner::Output::tanh_of_net
                                                     : models::Refiner::Output::tanh_of_sum);
  const nn::Tensor image = image_of(job, "combined");
  const nn::Shape& s = image.shape();
  const auto images = static_cast<std::size_t>(s.images);
  const auto background =
      mask_of(job.in.take("bg_dilated", {images, static_cast<std::size_t>(s.height),
                                         static_cast<std::size_t>(s.width)}));
  const std::size_t rows = models::Refiner::kNoiseRows * images;
  const auto noise =
      job.in.take("noise", {rows, net.noise_count() / models::Refiner::kNoiseRows}).as_floats();
  const nn::Tensor input = like(image, 4), output = like(image, 3);
  for (std::size_t i = 0; i < background.size(); ++i) {
    std::copy_n(image.view().pixel(i), 3, input.view().pixel(i));
    input.view().pixel(i)[3] = background[i] == 0 ? 1.f : 0.f;
  }
  job.time([&] { net.forward(input, noise.data(), output, job.workspace); });
  job.out["output"] = planes_of(output);
}

void run_discriminator(Job& job) {
  const models::Discriminator net(job.weights);
  const nn::Tensor image = image_of(job, "fake");
  std::vector<float> scores(static_cast<std::size_t>(image.shape().images));
  job.time([&] { net.score(image, scores.data(), job.workspace); });
  job.out["D_Fake"] = FileTensor::of(scores, {scores.size()});
  const auto shapes = net.shapes(image.shape());
  const nn::Tensor large(shapes[0].back()), small(shapes[1].back());
  models::Discriminator::Maps maps;
  maps[0].back() = large;
  maps[1].back() = small;
  net.forward(image, maps, job.workspace);
  job.out["scale0.layer4"] = planes_of(large);
  job.out["scale1.layer4"] = planes_of(small);
}

void run_lpips(Job& job) {
  const models::Lpips net(job.weights);
  const nn::Tensor a = image_of(job, "a"), b = image_of(job, "b");
  std::vector<float> distances(static_cast<std::size_t>(a.shape().images));
  job.time([&] { net.distance(a, b, distances.data(), job.workspace); });
  job.out["distance"] = FileTensor::of(distances, {distances.size()});
}

void run_classifier(Job& job) {
  const models::Classifier net(job.weights);
  const nn::Tensor image = image_of(job, "input");
  const nn::Tensor logits({image.shape().images, 1, 1, net.classes()});
  job.time([&] { net.forward(image, logits, job.workspace); });
  const auto images = static_cast<std::size_t>(image.shape().images),
             classes = static_cast<std::size_t>(net.classes());
  const std::vector<float> values(logits.data(), logits.data() + images * classes);
  job.out["logits"] = FileTensor::of(values, {images, classes});
}

struct Module {
  const char* name;
  const char* help;
  void (*run)(Job&);
};

constexpr Module kModules[] = {
    {"depth", "input [N,3,H,W], RGB in [-1,1], sides multiples of 256 -> raw and depth [N,1,H,W].",
     run_depth},
    {"vq-encode",
     "input [N,3,H,W], RGB in [-1,1], sides multiples of 8 -> pre_quant [N,E,H/8,W/8] and codes "
     "[N,H/8,W/8].",
     run_vq_encode},
    {"vq-decode", "codes [N,h,w] -> decoded [N,3,8h,8w], RGB about [-1,1].", run_vq_decode},
    {"pixelcnn",
     "codes [N,h,w] (below 0: not yet sampled), bg256 [1,8h,8w] (not 0: background) or mask_init, "
     "mask_undilated and mask_dilated [9,hw] (0: hidden), and if it is there missing [h,w] (not 0: "
     "not yet sampled) -> logits [N,K,h,w].",
     run_pixel_cnn},
    {"refine",
     "combined [N,3,H,W], RGB in [-1,1], sides multiples of 4, bg_dilated [N,H,W] (not 0: "
     "background) and noise [16N,20] -> output [N,3,H,W].",
     run_refine},
    {"discriminator",
     "fake [N,3,H,W], RGB in [-1,1] -> D_Fake [N], higher looks more real, and of each scale D "
     "itself: scale0.layer4 and scale1.layer4 [N,1,h,w].",
     run_discriminator},
    {"lpips", "a and b [N,3,H,W], RGB in [-1,1] -> distance [N].", run_lpips},
    {"classifier",
     "input [N,3,H,W], RGB less ImageNet's means over its deviations -> logits [N,classes].",
     run_classifier},
};

void run(const Module& module, const NetworkArguments& a, const Context& context) {
  check_output_file(a.files.out, {".safetensors"});
  check_not_input(a.files.out, {a.files.in, a.weights});
  if (a.min_z >= a.max_z) throw Error("--min-z", "is not below --max-z", "a lesser depth");
  note_interrupts();
  Job job{a, ProbeInput(a.files), read_weights(a.weights)};
  module.run(job);
  throw_if_interrupted();
  check_finite(job.out, a.weights);
  write_safetensors(a.files.out, job.out);
  print_report(context, {{"module", module.name}, {"forward_seconds", job.seconds}});
  context.say(a.files.out + ": " + module.name);
}

}  // namespace

void add_probe_networks(CLI::App& probe, const Context& context) {
  for (const Module& module : kModules) {
    auto* verb = probe.add_subcommand(module.name, module.help);
    auto a = std::make_shared<NetworkArguments>();
    add_files(*verb, a->files);
    verb->add_option("--weights", a->weights, "Weights: safetensors or a torch checkpoint")
        ->required()
        ->type_name("FILE");
    if (module.run == run_depth) {
      verb->add_option("--min-z", a->min_z, "Least depth")->type_name("M")->check(in_range(0, 1e6));
      verb->add_option("--max-z", a->max_z, "Greatest depth")
          ->type_name("M")
          ->check(in_range(0, 1e6));
    }
    if (module.run == run_refine) {
      verb->add_flag("--matterport", a->matterport,
                     "Add the image behind tanh, as the Matterport weights want it");
    }
    verb->callback([a, &module, &context] { run(module, *a, context); });
  }
}

}  // namespace ps::apps
