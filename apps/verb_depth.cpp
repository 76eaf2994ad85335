// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "apps/depth_model.h"
#include "apps/interrupt.h"
#include "apps/lens_arguments.h"
#include "apps/output.h"
#include "apps/photo_input.h"
#include "apps/program.h"
#include "apps/report.h"
#include "io/atomic_file.h"
#include "io/depth_file.h"
#include "io/photo.h"

namespace ps::apps {
namespace {

using Path = std::filesystem::path;

/// What 16 bits of millimetres hold.
constexpr float kLeast = 0.001f, kMost = 65.535f;

struct DepthArguments {
  std::string photo;
  std::string output;
  std::string weights;
  LensArguments lens;
};

/// @return the depths that these shares of all pixels, in [0,1], are nearer than
std::vector<float> quantiles(const Depth& depth, const std::vector<double>& shares) {
  std::vector<float> values(depth.begin(), depth.end()), found;
  for (const double share : shares) {
    const double at = share * static_cast<double>(values.size() - 1);
    const auto value = values.begin() + static_cast<std::ptrdiff_t>(at);
    std::nth_element(values.begin(), value, values.end());
    found.push_back(*value);
  }
  return found;
}

/// Near is red, far is blue, by 1 / depth; the last hundredths at either end are not told apart.
Image colored(const Depth& depth) {
  const std::vector<float> ends = quantiles(depth, {0.02, 0.98});
  const double near = 1.0 / ends[0], far = 1.0 / ends[1];
  const double scale = near > far ? 255 / (near - far) : 0;
  cv::Mat inverse = 1 / depth, bytes, bgr, rgb;
  inverse.convertTo(bytes, CV_8U, scale, -far * scale);
  cv::applyColorMap(bytes, bgr, cv::COLORMAP_TURBO);
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  rgb.convertTo(rgb, CV_32F, 1.0 / 255);
  return rgb;
}

void check_outputs(const DepthArguments& a, const DepthModel& model) {
  for (const Path& path :
       {Path(a.output), beside(a.output, "preview.png"), beside(a.output, "report.json")}) {
    check_not_input(path, {a.photo, a.lens.intrinsics, model.weights});
  }
}

void run_depth(const DepthArguments& a, const Context& context) {
  const Path preview = beside(a.output, "preview.png"),
             report_file = beside(a.output, "report.json");
  check_output_file(a.output, {".png", ".pfm"});
  check_output_file(preview, {});
  check_output_file(report_file, {});
  note_interrupts();
  const Stopwatch total;
  const DepthModel model = load_depth_model(a.weights, context);
  check_outputs(a, model);
  const Photo photo = take_photo(a.photo, context);
  const PhotoLens lens = choose_lens(a.lens, photo, a.photo, context);
  const Stopwatch watch;
  Depth depth = photo_depth(model.net, photo.color, lens.intrinsics, model.scale);
  const double estimate_seconds = watch.seconds();
  throw_if_interrupted();

  const std::vector<float> range = quantiles(depth, {0, 0.5, 1});
  Json report = {{"output", a.output},
                 {"preview", preview.string()},
                 {"lens", to_json(lens)},
                 {"scale", scale_report(model, lens.intrinsics)},
                 {"depth", {{"least", range[0]}, {"median", range[1]}, {"greatest", range[2]}}}};
  const Image picture = colored(depth);
  if (extension_of(a.output) == ".png") {
    const int clipped = cv::countNonZero(depth > kMost);
    report["clipped"] = clipped;
    if (clipped > 0) {
      context.warn(std::to_string(clipped) +
                   " pixels are farther than 65.535 m, all that 16 bits "
                   "of millimetres hold, and are set to that; -o FILE.pfm has no such limit");
    }
    depth = cv::min(cv::max(depth, kLeast), kMost);
  }
  report["seconds"] = {{"estimate", estimate_seconds}};
  add_costs(report, total);
  AtomicFiles files;
  write_image(preview, picture);
  write_json(report_file, report);
  write_depth(a.output, depth);
  files.commit();
  end_run(context, report, a.output,
          "depth of " + std::to_string(depth.cols) + "x" + std::to_string(depth.rows) +
              " pixels, estimated (metres are not promised)");
}

}  // namespace

void add_depth(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "depth",
      "Estimates a photo's depth: D.png of the photo's size in 16-bit millimetres (or D.pfm in "
      "metres), D.preview.png in colours (near is red) and D.report.json.\n"
      "Any size, aspect and focal length. Metric depth is not promised: proportions are "
      "estimated, and metres follow from the focal length, by --intrinsics, --fov or EXIF.");
  auto a = std::make_shared<DepthArguments>();
  verb->add_option("photo", a->photo, "Photo: JPEG, PNG, TIFF, WebP, ...")
      ->required()
      ->type_name("PHOTO");
  verb->add_option("-o,--output", a->output, "D.png or D.pfm")->required()->type_name("FILE");
  a->lens.add_to(*verb);
  add_weights_option(*verb, a->weights);
  verb->callback([a, &context] { run_depth(*a, context); });
}

}  // namespace ps::apps
