// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/probe.h"
#include "apps/program.h"
#include "apps/report.h"
#include "io/weights_file.h"
#include "libps/core/error.h"
#include "libps/outpaint/sampler.h"

namespace ps::apps {
namespace {

struct SampleArguments {
  ProbeFiles files;
  std::string weights;
  bool greedy = false;
  double temperature = 0.5;
  int completion = 0;
};

TensorMap tensors_of(const outpaint::Order& order) {
  const auto height = static_cast<std::size_t>(order.height),
             width = static_cast<std::size_t>(order.width);
  std::vector<std::int32_t> pairs;
  for (const int cell : order.cells) {
    pairs.push_back(cell / order.width);
    pairs.push_back(cell % order.width);
  }
  TensorMap tensors;
  tensors["distance32"] = FileTensor::of(order.distance, {height, width});
  tensors["order"] = FileTensor::of(pairs, {order.size(), 2});
  tensors["missing32"] = FileTensor::of(order.missing, {1, height, width});
  tensors["mask_init"] = FileTensor::of(order.masks.first, {9, order.size()});
  tensors["mask_undilated"] = FileTensor::of(order.masks.later, {9, order.size()});
  tensors["mask_dilated"] = FileTensor::of(order.masks.dilated, {9, order.size()});
  return tensors;
}

void finish(const ProbeFiles& files, const TensorMap& tensors, const Json& report,
            const Context& context) {
  throw_if_interrupted();
  write_safetensors(files.out, tensors);
  print_report(context, report);
  context.say(files.out + ": " + std::to_string(report.at("missing").get<std::size_t>()) +
              " missing cells");
}

void run_order(const ProbeFiles& files, const Context& context) {
  check_output_file(files.out, {".safetensors"});
  check_not_input(files.out, {files.in});
  note_interrupts();
  const outpaint::Order order = order_of(ProbeInput(files));
  const auto missing = std::count(order.missing.begin(), order.missing.end(), 1);
  finish(files, tensors_of(order), {{"module", "order"}, {"missing", missing}}, context);
}

void run_sample(const SampleArguments& a, const Context& context) {
  check_output_file(a.files.out, {".safetensors"});
  check_not_input(a.files.out, {a.files.in, a.weights});
  note_interrupts();
  const ProbeInput in(a.files);
  const outpaint::Order order = order_of(in);
  const auto height = static_cast<std::size_t>(order.height),
             width = static_cast<std::size_t>(order.width);
  const models::PixelCnn net(read_weights(a.weights));
  outpaint::Sampler sampler(net, order, in.codes("codes", {1, height, width}));
  outpaint::SampleOptions options;
  options.temperature = a.greedy ? 0 : a.temperature;
  options.seed = context.seed;
  options.progress = unless_interrupted;
  const Stopwatch watch;
  const outpaint::Completion completion = sampler.sample(a.completion, 1, options).at(0);
  const double seconds = watch.seconds();
  std::vector<std::int32_t> tokens;
  for (const int cell : order.cells) {
    const auto at = static_cast<std::size_t>(cell);
    if (!order.missing[at]) continue;
    tokens.insert(tokens.end(), {cell / order.width, cell % order.width, completion.codes[at]});
  }
  TensorMap tensors;
  tensors["tokens"] = FileTensor::of(tokens, {tokens.size() / 3, 3});
  tensors["codes_out"] = FileTensor::of(completion.codes, {1, height, width});
  finish(a.files, tensors,
         {{"module", "sample"},
          {"missing", sampler.missing()},
          {"levels", sampler.levels()},
          {"log_likelihood", completion.log_likelihood},
          {"sample_seconds", seconds}},
         context);
}

}  // namespace

void add_probe_outpaint(CLI::App& probe, const Context& context) {
  auto* order = probe.add_subcommand(
      "order",
      "bg256 [1,H,W] (not 0: background), sides multiples of 8 -> distance32 [h,w], order [hw,2] "
      "(row, column), missing32 [1,h,w], mask_init, mask_undilated and mask_dilated [9,hw].");
  auto files = std::make_shared<ProbeFiles>();
  add_files(*order, *files);
  order->callback([files, &context] { run_order(*files, context); });

  auto* sample = probe.add_subcommand(
      "sample",
      "codes [1,h,w] and bg256 [1,8h,8w] -> tokens [n,3] (row, column, code, as sampled) and "
      "codes_out [1,h,w].");
  auto a = std::make_shared<SampleArguments>();
  add_files(*sample, a->files);
  sample->add_option("--weights", a->weights, "Weights: safetensors or a torch checkpoint")
      ->required()
      ->type_name("FILE");
  auto* greedy = sample->add_flag("--greedy", a->greedy, "Take the likeliest code (temperature 0)");
  sample->add_option("--temperature", a->temperature, "0 = greedy")
      ->type_name("T")
      ->excludes(greedy)
      ->check(in_range(0, 2));
  sample->add_option("--completion", a->completion, "Which completion of the seed's")
      ->type_name("N")
      ->check(whole_in(0, 1000000));
  sample->callback([a, &context] { run_sample(*a, context); });
}

}  // namespace ps::apps
