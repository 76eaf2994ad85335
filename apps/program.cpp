// SPDX-License-Identifier: BSD-3-Clause
#include "apps/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <sstream>
#include <string>

#include "apps/interrupt.h"
#include "apps/report.h"
#include "io/hush.h"
#include "libps/core/parallel.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

void add_common_options(CLI::App& program, Context& context) {
  program.option_defaults()->always_capture_default();
  program.add_flag("-v,--verbose", context.verbose, "Say more on stderr");
  program.add_flag("-q,--quiet", context.quiet,
                   "Say nothing but errors on stderr; results on stdout stay");
  program.add_option("--seed", context.seed, "Seed of everything that is drawn at random")
      ->type_name("N")
      ->check(whole_in(0, UINT64_MAX));
  program.add_option("--threads", context.threads, "Threads to use; 0 = one for each core")
      ->type_name("N")
      ->check(whole_in(0, 1024));
  program.add_flag("--json", context.json, "Print the report as JSON on stdout");
  program.set_version_flag("--version", "pixelsynth " PS_VERSION);
  program.fallthrough();  // so that these are also taken after the verb
}

/// A standard stream that the caller closed must not become the number of a file that we write:
/// what is printed there fails instead. open() takes the lowest number that is free.
void hold_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// Libraries below us must not write to the terminal: one failure is one line.
void hush_libraries() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
  hush_decoders();
}

/// --help, --version
int answer(const CLI::App& program, const CLI::Success& asked) {
  std::ostringstream text;
  const int status = program.exit(asked, text, text);
  print_text(text.str());
  return status;
}

/// CLI11 says "--radius: At Most 1 required but received 2".
std::string in_our_words(const CLI::ParseError& error) {
  const std::string text = one_line(error.what());
  const std::size_t at = text.find(": At Most 1 required but received ");
  return at == std::string::npos ? text : text.substr(0, at) + " can be given once";
}

int report_usage(const CLI::App& program, const CLI::ParseError& error) {
  std::string verb;  // with the one inside it, as "eval views"
  for (const CLI::App* at = &program; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    verb += " " + at->get_name();
  }
  std::fprintf(stderr, "pixelsynth%s: %s; see pixelsynth%s --help\n", verb.c_str(),
               in_our_words(error).c_str(), verb.c_str());
  return 2;
}

int fail(const char* message) noexcept {
  dprintf(STDERR_FILENO, "pixelsynth: %s\n", message);
  return 1;
}

}  // namespace

int run(int argc, char** argv) {
  hold_standard_streams();
  hush_libraries();
  Context context;
  CLI::App program(
      "pixelsynth: photos and RGB-D frames to one coloured point cloud, seen from anywhere.\n"
      "Exit status: 0 done, 1 failed (one line on stderr says why), 2 wrong usage.",
      "pixelsynth");
  add_common_options(program, context);
  program.parse_complete_callback([&] { set_threads(context.threads); });
  add_scene(program, context);
  add_depth(program, context);
  add_fuse(program, context);
  add_render(program, context);
  add_view(program, context);
  add_probe(program, context);
  add_weights(program, context);
  add_train(program, context);
  add_eval(program, context);
  add_stress(program, context);
  add_chart(program, context);
  program.require_subcommand(0, 1);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return answer(program, asked);
  } catch (const CLI::ParseError& error) {
    return report_usage(program, error);
  }
  context.flush();
  if (program.get_subcommands().empty()) print_text(program.help());
  return 0;
}

CLI::Validator in_range(double low, double high) {
  const std::string range = high < kNoBound ? in_digits(low) + " to " + in_digits(high)
                            : low > 0       ? "more than 0"
                                            : "0 or more";
  const auto check = [=](const std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool number = end != text.c_str() && *end == '\0' && std::isfinite(value);
    if (number && value >= low && value <= high) return "";
    return "'" + text + "' is out of range; expected " + range;
  };
  return CLI::Validator(check, high < kNoBound ? range : "");
}

CLI::Validator whole_in(std::uint64_t low, std::uint64_t high) {
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  const auto check = [=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && value >= low && value <= high) return "";
    return "'" + text + "' is not right; expected a whole number from " + range;
  };
  return CLI::Validator(check, high < UINT64_MAX ? range : "");
}

CLI::Validator not_empty(const std::string& expected) {
  return CLI::Validator(
      [=](const std::string& text) {
        return text.empty() ? "the name is empty; expected " + expected : "";
      },
      "");
}

void check_order(const std::string& least_option, double least, const std::string& most_option,
                 double most) {
  if (least <= most) return;
  throw CLI::ValidationError(least_option, in_digits(least) + " is more than " + most_option + " " +
                                               in_digits(most) + "; expected at most that");
}

CLI::Option* add_names(CLI::App& verb, const std::string& option, std::vector<std::string>& names,
                       const std::string& help, const std::vector<std::string>& choices) {
  CLI::Option* const added = verb.add_option(option, names, help)
                                 ->delimiter(',')
                                 ->allow_extra_args(false)
                                 ->type_name("NAME,...")
                                 ->check(CLI::IsMember(choices));
  return added->check([added](const std::string& name) -> std::string {
    const std::vector<std::string>& given = added->results();
    if (std::count(given.begin(), given.end(), name) < 2) return "";
    return name + " is given twice; expected each once";
  });
}

int report_failure() noexcept try { throw; } catch (const Interrupted& interrupted) {
  fail(interrupted.what());
  die_of_interrupt();
} catch (const std::bad_alloc&) {
  return fail("out of memory; try fewer or smaller views, or a smaller --size");
} catch (const cv::Exception& error) {
  if (error.code == cv::Error::StsNoMem) return fail("out of memory; try a smaller --size");
  return fail(("OpenCV: " + one_line(error.err)).c_str());
} catch (const std::exception& error) {
  return fail(one_line(error.what()).c_str());
} catch (...) {
  return fail("unknown failure");
}

}  // namespace ps::apps
