// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/ab_page.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "apps/verb_eval.h"
#include "io/data_uri.h"
#include "io/image_listing.h"
#include "io/photo.h"
#include "libps/core/error.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

namespace fs = std::filesystem;

struct EvalAbArguments {
  std::string a, b, inputs, output;
  std::string question = "Which picture looks more like a photo?";
  std::vector<std::string> names;
  int pairs = 0;
  int sentinels = -1;
  bool lossless = false;
};

using FilesByStem = std::map<std::string, fs::path>;

FilesByStem files_in(const std::string& folder) {
  FilesByStem files;
  for (const fs::path& file : ImageListing(folder).files) {
    if (!files.emplace(file.stem().string(), file).second) {
      throw Error(file.string(), "another image has its name", "one image for each name");
    }
  }
  return files;
}

/// Names that both folders have, of which `--pairs` are drawn.
std::vector<std::string> names_in_both(const EvalAbArguments& args, const FilesByStem& a,
                                       const FilesByStem& b, const Context& context) {
  std::vector<std::string> names;
  for (const auto& [name, file] : a) {
    if (b.count(name) > 0) names.push_back(name);
  }
  if (names.empty())
    throw Error(args.b, "no image has the name of one in " + args.a, "equal names");
  const std::size_t alone = a.size() + b.size() - 2 * names.size();
  if (alone > 0) {
    context.warn(counted(alone, "image is", "images are") + " in one folder alone");
  }
  const std::size_t most = args.pairs > 0 ? static_cast<std::size_t>(args.pairs) : names.size();
  std::vector<std::string> drawn;
  for (const std::size_t i : shuffled(names.size(), context.seed, 3)) {
    if (drawn.size() < most) drawn.push_back(names[i]);
  }
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

const fs::path& input_of(const std::string& name, const FilesByStem& inputs,
                         const std::string& folder) {
  const auto found = inputs.find(name);
  if (found == inputs.end()) throw Error(folder, "has no image " + name, "one for each pair");
  return found->second;
}

/// What the sentinels of one pair need.
struct Broken {
  bool a = false, b = false;
};

AbPair read_pair(const std::string& name, const fs::path& a_file, const fs::path& b_file,
                 const Broken& broken, std::uint64_t seed, bool lossless) {
  const Image a = read_photo(a_file).color, b = read_photo(b_file).color;
  if (a.size() != b.size()) {
    throw Error(b_file.string(),
                "is " + std::to_string(b.cols) + "x" + std::to_string(b.rows) + " pixels, " +
                    a_file.string() + " " + std::to_string(a.cols) + "x" + std::to_string(a.rows),
                "one size, which tells nobody whose a picture is");
  }
  AbPair pair = {name, data_uri(a, lossless), data_uri(b, lossless), "", "", ""};
  if (broken.a) pair.broken_a = data_uri(broken_copy(a, seed), lossless);
  if (broken.b) pair.broken_b = data_uri(broken_copy(b, seed), lossless);
  return pair;
}

std::string name_of_folder(const std::string& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

AbPage make_page(const EvalAbArguments& args, const Context& context) {
  const FilesByStem a = files_in(args.a), b = files_in(args.b);
  const FilesByStem inputs = args.inputs.empty() ? FilesByStem() : files_in(args.inputs);
  const std::vector<std::string> names = names_in_both(args, a, b, context);
  const std::size_t sentinels = args.sentinels >= 0 ? static_cast<std::size_t>(args.sentinels)
                                                    : std::max<std::size_t>(2, names.size() / 5);
  AbPage page;
  page.name_a = args.names.empty() ? name_of_folder(args.a) : args.names[0];
  page.name_b = args.names.empty() ? name_of_folder(args.b) : args.names[1];
  page.question = args.question;
  page.seed = context.seed;
  page.trials = plan_ab_study(names.size(), sentinels, context.seed);
  std::vector<Broken> broken(names.size());
  for (const AbTrial& trial : page.trials) {
    if (trial.sentinel) (trial.of_b ? broken[trial.pair].b : broken[trial.pair].a) = true;
  }
  Progress progress(context, "pairs", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    page.pairs.push_back(
        read_pair(name, a.at(name), b.at(name), broken[i], context.seed + i, args.lossless));
    if (!args.inputs.empty()) {
      page.pairs.back().input =
          data_uri(read_photo(input_of(name, inputs, args.inputs)).color, args.lossless);
    }
    progress.update(i + 1);
  }
  return page;
}

void run_eval_ab(const EvalAbArguments& args, const Context& context) {
  if (!args.names.empty() && args.names.size() != 2) {
    throw CLI::ValidationError("--names", "expected two names, as ours,theirs");
  }
  check_output_file(args.output, {".html", ".htm"});
  std::error_code ignored;
  if (fs::equivalent(args.a, args.b, ignored)) {
    throw Error(args.b, "is " + args.a + ", A's folder", "pictures of another method");
  }
  note_interrupts();
  const Stopwatch total;
  const AbPage page = make_page(args, context);
  throw_if_interrupted();
  const std::string html = html_of(page);
  write_text(args.output, html);
  const auto sentinels = std::count_if(page.trials.begin(), page.trials.end(),
                                       [](const AbTrial& trial) { return trial.sentinel; });
  Json report = {{"output", args.output},
                 {"a", page.name_a},
                 {"b", page.name_b},
                 {"pairs", page.pairs.size()},
                 {"trials", page.trials.size()},
                 {"sentinels", sentinels},
                 {"mebibytes", static_cast<double>(html.size()) / (1 << 20)}};
  add_costs(report, total);
  end_run(context, report, args.output,
          counted(page.trials.size(), "question") + " about " + counted(page.pairs.size(), "pair"));
}

void add_options(CLI::App& verb, EvalAbArguments& a) {
  verb.add_option("a", a.a, "Pictures of method A")->required()->type_name("A_DIR");
  verb.add_option("b", a.b, "Pictures of method B, equally named and of equal sizes")
      ->required()
      ->type_name("B_DIR");
  verb.add_option("-o,--output", a.output, "The page to write: .html")
      ->required()
      ->type_name("FILE");
  verb.add_option("--inputs", a.inputs, "Photos that both were made of, equally named, to be shown")
      ->type_name("DIR");
  verb.add_option("--names", a.names, "What the result calls the methods (default: the folders)")
      ->delimiter(',')
      ->type_name("A,B");
  verb.add_option("--question", a.question, "What is asked")->type_name("TEXT");
  verb.add_option("--pairs", a.pairs, "At most so many pairs, drawn by the seed; 0 = all")
      ->type_name("N")
      ->check(whole_in(0, 100000));
  verb.add_option("--sentinels", a.sentinels,
                  "So many questions whose answer is known (default: one for five pairs, two at "
                  "least)")
      ->type_name("N")
      ->default_str("")
      ->check(whole_in(0, 100000));
  verb.add_flag("--lossless", a.lossless, "Embed PNG instead of JPEG of quality 95");
}

}  // namespace

void add_eval_ab(CLI::App& eval, const Context& context) {
  auto* verb = eval.add_subcommand(
      "ab",
      "Writes one web page that asks people which of two methods' pictures is better: blind, left "
      "and right by chance, each pair twice with sides exchanged (a pair counts when both votes "
      "agree), with sentinels whose answer is known. It needs no other file and no network; the "
      "result is JSON, shown at the end and offered as a file.");
  auto a = std::make_shared<EvalAbArguments>();
  add_options(*verb, *a);
  verb->callback([a, &context] { run_eval_ab(*a, context); });
}

}  // namespace ps::apps
