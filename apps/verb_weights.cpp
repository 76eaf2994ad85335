// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/report.h"
#include "io/weights_file.h"
#include "libps/core/error.h"
#include "libps/models/codebook_mark.h"

namespace ps::apps {
namespace {

struct WeightsArguments {
  std::string in;
  std::string out;
  std::string type = "f32";
  std::string prefix;
  std::string codes;
};

/// One line of the table.
struct Summary {
  std::string name, type, shape;
  std::size_t elements = 0;
  std::size_t not_finite = 0;
  bool has_range = false;  ///< whether it holds a finite float
  double low = 0, high = 0, mean = 0;
};

/// What the tensors of one network come to.
struct Count {
  std::size_t tensors = 0, parameters = 0;
};

void measure(const std::vector<float>& values, Summary& summary) {
  double sum = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) {
      ++summary.not_finite;
      continue;
    }
    summary.low = summary.has_range ? std::min<double>(summary.low, value) : value;
    summary.high = summary.has_range ? std::max<double>(summary.high, value) : value;
    summary.has_range = true;
    sum += value;
  }
  if (summary.has_range)
    summary.mean = sum / static_cast<double>(values.size() - summary.not_finite);
}

std::vector<Summary> summarise(const TensorMap& tensors) {
  std::vector<Summary> summaries;
  for (const auto& [name, tensor] : tensors) {
    Summary summary;
    summary.name = name;
    summary.type = tensor.dtype;
    summary.shape = nn::to_string(tensor.shape);
    summary.elements = tensor.elements();
    if (nn::is_float_type(tensor.dtype)) measure(tensor.as_floats(), summary);
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

/// By the names' first words; integers count as tensors, not as parameters.
std::map<std::string, Count> count_modules(const std::vector<Summary>& summaries) {
  std::map<std::string, Count> modules;
  for (const Summary& summary : summaries) {
    Count& count = modules[summary.name.substr(0, summary.name.find('.'))];
    ++count.tensors;
    if (nn::is_float_type(summary.type)) count.parameters += summary.elements;
  }
  return modules;
}

Count total_of(const std::map<std::string, Count>& modules) {
  Count total;
  for (const auto& [name, count] : modules) {
    total.tensors += count.tensors;
    total.parameters += count.parameters;
  }
  return total;
}

void warn_of_bad_values(const std::vector<Summary>& summaries, const Context& context) {
  for (const Summary& summary : summaries) {
    if (summary.not_finite == 0) continue;
    context.warn("tensor '" + summary.name + "' holds NaN or infinity, " +
                 std::to_string(summary.not_finite) + " of " + std::to_string(summary.elements));
  }
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::string line(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(line.data(), line.size() + 1, format, values...);
  return line;
}

std::string table_of(const std::vector<Summary>& summaries,
                     const std::map<std::string, Count>& modules) {
  int names = 6, shapes = 5;
  for (const Summary& summary : summaries) {
    names = std::max(names, static_cast<int>(summary.name.size()));
    shapes = std::max(shapes, static_cast<int>(summary.shape.size()));
  }
  std::string text = formatted("%-*s  type  %-*s  %11s  %11s  %11s\n", names, "tensor", shapes,
                               "shape", "least", "greatest", "mean");
  for (const Summary& s : summaries) {
    std::string line = formatted("%-*s  %-4s  %-*s", names, s.name.c_str(), s.type.c_str(), shapes,
                                 s.shape.c_str());
    if (s.has_range) line += formatted("  %11.4g  %11.4g  %11.4g", s.low, s.high, s.mean);
    if (s.not_finite > 0) line += formatted("  not finite: %zu", s.not_finite);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  const Count total = total_of(modules);
  text += formatted("\n%-*s  %7s  %10s\n", names, "module", "tensors", "parameters");
  for (const auto& [name, count] : modules) {
    text += formatted("%-*s  %7zu  %10zu\n", names, name.c_str(), count.tensors, count.parameters);
  }
  return text + formatted("%-*s  %7zu  %10zu\n", names, "all", total.tensors, total.parameters);
}

Json report_of(const WeightsArguments& a, const std::vector<Summary>& summaries,
               const TensorMap& tensors, const Metadata& metadata) {
  const std::map<std::string, Count> modules = count_modules(summaries);
  const Count total = total_of(modules);
  Json json;
  json["file"] = a.in;
  json["tensors"] = total.tensors;
  json["parameters"] = total.parameters;
  for (const auto& [name, count] : modules) {
    json["modules"][name] = {{"tensors", count.tensors}, {"parameters", count.parameters}};
  }
  if (!metadata.empty()) json["metadata"] = metadata;
  json["list"] = Json::array();
  for (const Summary& s : summaries) {
    Json entry{{"name", s.name}, {"type", s.type}, {"shape", tensors.at(s.name).shape}};
    if (s.has_range) entry.update({{"least", s.low}, {"greatest", s.high}, {"mean", s.mean}});
    if (s.not_finite > 0) entry["not_finite"] = s.not_finite;
    json["list"].push_back(entry);
  }
  return json;
}

std::string lines_of(const Metadata& metadata) {
  std::string text = metadata.empty() ? "" : "\n";
  for (const auto& [key, value] : metadata) text += one_line(key + ": " + value) + "\n";
  return text;
}

void run_info(const WeightsArguments& a, const Context& context) {
  const TensorMap tensors = read_weight_tensors(a.in);
  const Metadata metadata = read_metadata(a.in);
  const std::vector<Summary> summaries = summarise(tensors);
  warn_of_bad_values(summaries, context);
  if (context.json) {
    print_report(context, report_of(a, summaries, tensors, metadata));
  } else {
    print_text(table_of(summaries, count_modules(summaries)) + lines_of(metadata));
  }
}

/// Puts the prefix before names that name no network.
TensorMap with_prefix(TensorMap tensors, const WeightsArguments& a) {
  if (a.prefix.empty()) return tensors;
  TensorMap prefixed;
  for (auto& [name, tensor] : tensors) {
    const std::string whole = names_network(name) ? name : a.prefix + "." + name;
    if (!prefixed.emplace(whole, std::move(tensor)).second) {
      throw Error(a.in, "tensor '" + name + "' would be the second one called '" + whole + "'",
                  "another --prefix");
    }
  }
  return prefixed;
}

FloatType type_of(const std::string& name) {
  return name == "f16" ? FloatType::f16 : name == "bf16" ? FloatType::bf16 : FloatType::f32;
}

/// The words beside the tensors; a PixelCNN's say which codebook it continues.
Metadata words_of(const WeightsArguments& a) {
  Metadata words = read_metadata(a.in);
  if (a.codes.empty()) return words;
  const nn::Weights autoencoder = read_weights(a.codes);
  words[models::kCodebookMark] =
      models::codebook_mark(autoencoder.get("vqvae.quantize_t.embed", {0, 0}).values);
  return words;
}

void run_convert(const WeightsArguments& a, const Context& context) {
  check_output_file(a.out, {".safetensors"});
  check_not_input(a.out, {a.in, a.codes});
  note_interrupts();
  const Metadata words = words_of(a);
  TensorMap tensors = with_prefix(read_weight_tensors(a.in), a);
  const std::vector<Summary> summaries = summarise(tensors);
  warn_of_bad_values(summaries, context);
  throw_if_interrupted();
  write_safetensors(a.out, stored_as(std::move(tensors), type_of(a.type), a.out), words);
  const Count total = total_of(count_modules(summaries));
  print_report(context, {{"input", a.in},
                         {"output", a.out},
                         {"type", a.type},
                         {"tensors", total.tensors},
                         {"parameters", total.parameters}});
  context.say(a.out + ": " + std::to_string(total.tensors) + " tensors, " +
              std::to_string(total.parameters) + " parameters as " + a.type);
}

/// A word, or words with dots between.
std::string check_prefix(const std::string& text) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  const bool fits = !text.empty() && std::all_of(text.begin(), text.end(), allowed) &&
                    text.front() != '.' && text.back() != '.';
  return fits ? "" : "'" + text + "' is no prefix; expected a name as classifier";
}

void add_info(CLI::App& weights, const Context& context) {
  auto* verb = weights.add_subcommand(
      "info", "Lists the tensors under the names that networks know them by, and counts them.");
  auto a = std::make_shared<WeightsArguments>();
  verb->add_option("file", a->in, "Safetensors, or a checkpoint of torch")
      ->required()
      ->type_name("FILE");
  verb->callback([a, &context] { run_info(*a, context); });
}

void add_convert(CLI::App& weights, const Context& context) {
  auto* verb = weights.add_subcommand(
      "convert",
      "A checkpoint of torch (zip or legacy container) or safetensors -> safetensors, under the "
      "names that networks know their tensors by. Tensors alone are read, and nothing is run.");
  auto a = std::make_shared<WeightsArguments>();
  verb->add_option("file", a->in, "Checkpoint to read")->required()->type_name("FILE");
  verb->add_option("-o,--output", a->out, "Safetensors to write")->required()->type_name("FILE");
  verb->add_option("--type", a->type, "How floats are stored: f32, f16 or bf16")
      ->type_name("TYPE")
      ->check(CLI::IsMember({"f32", "f16", "bf16"}));
  verb->add_option("--prefix", a->prefix,
                   "Put before names that name none of the networks; classifier, for a scene "
                   "classifier's own file")
      ->type_name("NAME")
      ->check(CLI::Validator(check_prefix, ""));
  verb->add_option("--codes", a->codes,
                   "Of a PixelCNN: the autoencoder that it was trained with. The file then says "
                   "so, and scene refuses another")
      ->type_name("FILE");
  verb->callback([a, &context] { run_convert(*a, context); });
}

}  // namespace

void add_weights(CLI::App& program, const Context& context) {
  auto* weights = program.add_subcommand("weights", "Lists or converts a file of weights.");
  weights->require_subcommand(1);
  add_info(*weights, context);
  add_convert(*weights, context);
}

}  // namespace ps::apps
