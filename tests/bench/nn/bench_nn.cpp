// SPDX-License-Identifier: BSD-3-Clause
// Operators and networks at the published widths, batch 1, beside the machine's peak and oneDNN:
// one run, one table, one JSON file. See tests/bench/README.md.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "libps/core/parallel.h"
#include "libps/nn/convolution.h"
#include "libps/nn/isa.h"
#include "tests/bench/nn/modules.h"
#include "tests/bench/nn/peers.h"

namespace ps::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kReferencePeak =
    189;  ///< GFLOP/s of the machine that the targets were written for
constexpr int kRuns = 9;

Peak peak() {
  const Peak blas = peak_of_openblas(), eigen = peak_of_eigen();
  for (const Peak& p : {blas, eigen})
    std::printf("sgemm 2048^3, %s: %.0f GFLOP/s\n", p.name.c_str(), p.gflops);
  return blas.gflops > eigen.gflops ? blas : eigen;
}

struct Error {
  double worst = 0;  ///< |difference| over the largest |value|
  static Error between(const nn::Tensor& a, const nn::Tensor& b) {
    double worst = 0, largest = 1e-30;
    const std::size_t count = a.shape().pixels() * static_cast<std::size_t>(a.shape().channels);
    for (std::size_t i = 0; i < count; ++i) {
      worst = std::max<double>(worst, std::abs(a.data()[i] - b.data()[i]));
      largest = std::max<double>(largest, std::abs(a.data()[i]));
    }
    return {worst / largest};
  }
};

const std::vector<ConvolutionCase> kConvolutions = {
    {64, 128, 128, 3, 1, 1}, {256, 128, 128, 3, 1, 1}, {128, 256, 256, 3, 1, 1},
    {256, 64, 64, 3, 1, 1},  {16, 256, 256, 3, 1, 1},  {256, 4, 64, 3, 1, 1},
    {256, 3, 64, 4, 2, 1},   {128, 64, 128, 4, 2, 1},  {8, 256, 256, 4, 2, 1},
    {64, 32, 128, 1, 1, 0},  {256, 64, 128, 1, 1, 0},  {256, 128, 3, 3, 1, 1}};

Json time_convolution(const ConvolutionCase& c, const Peak& peak) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  nn::WeightTensor weight = {
      {static_cast<std::size_t>(c.out), static_cast<std::size_t>(c.in),
       static_cast<std::size_t>(c.kernel), static_cast<std::size_t>(c.kernel)},
      {}};
  weight.values.resize(weight.elements());
  const float scale = 1 / std::sqrt(static_cast<float>(c.in * c.kernel * c.kernel));
  for (float& value : weight.values) value = normal(random) * scale;
  const std::vector<float> bias(static_cast<std::size_t>(c.out), 0.1f);
  nn::Tensor in({1, c.side, c.side, c.in});
  for (std::size_t i = 0; i < in.shape().pixels() * static_cast<std::size_t>(c.in); ++i) {
    in.data()[i] = std::max(0.0f, normal(random));
  }
  nn::Workspace workspace;
  const auto time = [&](nn::Method method, nn::Tensor& out) {
    const nn::Convolution convolution(weight, bias,
                                      {c.stride, c.padding, 1, method, nn::Storage::f32});
    out = nn::Tensor(convolution.output(in.shape()));
    return fastest(kRuns, [&] { convolution(in, out, workspace); });
  };
  nn::Tensor direct, automatic;
  const double direct_s = time(nn::Method::direct, direct);
  const double automatic_s = time(nn::Method::automatic, automatic);
  const double onednn_s = time_onednn(c);
  const auto share = [&](double s) { return s > 0 ? c.flops() / s * 1e-9 / peak.gflops : 0; };
  std::printf("%-22s %8.2f %5.0f%% %8.2f %5.0f%% %8.2f %5.0f%% %8.2f %9.1e\n", c.name().c_str(),
              direct_s * 1e3, share(direct_s) * 100, automatic_s * 1e3, share(automatic_s) * 100,
              onednn_s * 1e3, share(onednn_s) * 100, onednn_s > 0 ? automatic_s / onednn_s : 0,
              Error::between(direct, automatic).worst);
  return {{"case", c.name()},
          {"gflop", c.flops() * 1e-9},
          {"direct_ms", direct_s * 1e3},
          {"automatic_ms", automatic_s * 1e3},
          {"onednn_ms", onednn_s * 1e3},
          {"direct_of_peak", share(direct_s)},
          {"automatic_of_peak", share(automatic_s)},
          {"error", Error::between(direct, automatic).worst}};
}

struct Variant {
  const char* name;
  models::ModelOptions options;
};
const std::vector<Variant> kVariants = {
    {"f32 direct", {nn::Method::direct, nn::Storage::f32}},
    {"f32 Winograd", {nn::Method::automatic, nn::Storage::f32}},
    {"bf16 direct", {nn::Method::direct, nn::Storage::bf16}},
    {"bf16 Winograd", {nn::Method::automatic, nn::Storage::bf16}}};

Json time_module(const Module& module, const Peak& peak) {
  Json rows = Json::array();
  nn::Tensor exact;
  for (const Variant& variant : kVariants) {
    auto out = nn::Tensor();
    nn::Workspace workspace;
    const auto forward = module.make(variant.options, &out);
    const double seconds = fastest(kRuns, [&] { forward(workspace); });
    if (rows.empty()) {
      exact = nn::Tensor(out.shape());
      std::copy_n(out.data(), out.shape().pixels() * static_cast<std::size_t>(out.shape().channels),
                  exact.data());
    }
    const double error = Error::between(exact, out).worst;
    const double share = module.gflop / seconds / peak.gflops;
    const double target = module.target_ms * kReferencePeak / peak.gflops;
    std::printf("%-20s %-14s %8.1f ms %5.0f%% of peak  error %8.1e  scratch %5.1f MiB",
                module.name.c_str(), variant.name, seconds * 1e3, share * 100, error,
                static_cast<double>(workspace.bytes()) / (1 << 20));
    if (target > 0) std::printf("  target %.1f ms", target);
    std::printf("\n");
    rows.push_back({{"module", module.name},
                    {"variant", variant.name},
                    {"ms", seconds * 1e3},
                    {"gflop", module.gflop},
                    {"of_peak", share},
                    {"error", error},
                    {"target_ms", target},
                    {"scratch_bytes", workspace.bytes()}});
  }
  return rows;
}

double peak_memory_mib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Milliseconds of one forward as `pixelsynth` computes it.
void time_widths() {
  for (const Module& module : modules_of_widths()) {
    nn::Tensor out;
    nn::Workspace workspace;
    const auto forward = module.make({}, &out);
    std::printf("%s: %.2f ms\n", module.name.c_str(),
                fastest(kRuns, [&] { forward(workspace); }) * 1e3);
  }
}

/// A process that runs one module and nothing else, so that its peak memory is the module's.
void memory_of(const std::string& name) {
  const double before = peak_memory_mib();
  for (const Module& module : modules()) {
    if (module.name != name) continue;
    nn::Tensor out;
    nn::Workspace workspace;
    const auto forward = module.make({}, &out);
    forward(workspace);
    std::printf("%s: peak %.0f MiB, %.0f of them before it began\n", name.c_str(),
                peak_memory_mib(), before);
    return;
  }
  std::printf("there is no module '%s'\n", name.c_str());
}

void run(const std::string& json_file, const std::string& only) {
  std::printf("instruction set %s, %d threads\n", nn::to_string(nn::isa()).c_str(), threads());
  const Peak peak = bench::peak();
  Json json = {{"isa", nn::to_string(nn::isa())},
               {"threads", threads()},
               {"sgemm", peak.name},
               {"sgemm_gflops", peak.gflops},
               {"convolutions", Json::array()},
               {"modules", Json::array()}};
  std::printf("\n%-22s %15s %15s %15s %8s %9s\n%22s %8s %6s %8s %6s %8s %6s %8s\n", "convolution",
              "direct", "default", "oneDNN", "default", "error of", "", "ms", "peak", "ms", "peak",
              "ms", "peak", "/oneDNN");
  for (const ConvolutionCase& c : kConvolutions)
    if (only.empty()) json["convolutions"].push_back(time_convolution(c, peak));
  std::printf("\n");
  for (const Module& module : modules()) {
    if (!only.empty() && module.name != only) continue;
    for (const Json& row : time_module(module, peak)) json["modules"].push_back(row);
  }
  bench::peak();
  if (!json_file.empty()) std::ofstream(json_file) << json.dump(1) << '\n';
}

}  // namespace
}  // namespace ps::bench

int main(int argc, char** argv) {
  CLI::App app("Times operators and networks.");
  std::string json, memory, isa, only;
  int threads = 0;
  bool widths = false;
  app.add_flag("--widths", widths, "Only what three widths of each network take");
  app.add_option("--json", json, "File to write");
  app.add_option("--only", only, "Only this module");
  app.add_option("--memory", memory, "Only the peak memory of this module");
  app.add_option("--isa", isa, "baseline, avx2 or avx512");
  app.add_option("--threads", threads, "0 = one for each core");
  CLI11_PARSE(app, argc, argv);
  if (threads > 0) ps::set_threads(threads);
  for (const ps::nn::Isa one : ps::nn::available_isas()) {
    if (to_string(one) == isa) ps::nn::set_isa(one);
  }
  if (widths) {
    ps::bench::time_widths();
  } else if (!memory.empty()) {
    ps::bench::memory_of(memory);
  } else {
    ps::bench::run(json, only);
  }
}
