// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>

#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/probe.h"
#include "apps/program.h"
#include "apps/report.h"
#include "libps/core/error.h"
#include "libps/geometry/splat.h"

namespace ps::apps {
namespace {

struct SplatArguments {
  ProbeFiles files;
  int size = 256;
  SplatOptions splat;
};

/// @return points of the published rasteriser's plane (x left, y up, in [-1,1]; SPEC.md 4) in
/// pixels; one whose numbers are not all finite has depth 0, at which none is drawn
PlanePoints read_points(const SplatArguments& a, const Context& context) {
  const ProbeInput in(a.files);
  const FileTensor &points = in.take("points"), &features = in.take("features");
  const std::size_t count = points.shape.empty() ? 0 : points.shape[0];
  if (points.shape != std::vector<std::size_t>{count, 3} ||
      features.shape != std::vector<std::size_t>{3, count}) {
    throw Error(a.files.in, "the tensors' shapes do not fit", "points [N,3] and features [3,N]");
  }
  const std::vector<float> xyz = points.as_floats(), colors = features.as_floats();
  PlanePoints plane;
  std::size_t skipped = 0;
  const double half = a.size / 2.0;
  for (std::size_t i = 0; i < count; ++i) {
    plane.u.push_back(static_cast<float>((1.0 - xyz[3 * i]) * half - 0.5));
    plane.v.push_back(static_cast<float>((1.0 - xyz[3 * i + 1]) * half - 0.5));
    plane.z.push_back(xyz[3 * i + 2]);
    plane.color.emplace_back(colors[i], colors[count + i], colors[2 * count + i]);
    const cv::Vec3f& c = plane.color.back();
    if (!std::isfinite(plane.u[i] + plane.v[i] + plane.z[i] + c[0] + c[1] + c[2])) {
      plane.z[i] = 0;
      ++skipped;
    }
  }
  if (skipped > 0) {
    context.warn(a.files.in + ": " + std::to_string(skipped) +
                 " points are not finite and are left out");
  }
  return plane;
}

/// Interleaved colours to planes: [1, 3, S, S].
FileTensor planes_of(const Image& image) {
  std::vector<float> values;
  values.reserve(image.total() * 3);
  for (int c = 0; c < 3; ++c) {
    for (const cv::Vec3f& pixel : image) values.push_back(pixel[c]);
  }
  const auto rows = static_cast<std::size_t>(image.rows),
             cols = static_cast<std::size_t>(image.cols);
  return FileTensor::of(values, {1, 3, rows, cols});
}

TensorMap tensors_of(const Splat& splat) {
  const auto side = static_cast<std::size_t>(splat.color.rows);
  std::vector<std::uint8_t> background, dilated;
  for (const std::uint8_t hit : splat.hit) background.push_back(hit == 0);
  dilated.assign(splat.missing.begin(), splat.missing.end());
  std::vector<std::int32_t> count(splat.count.begin(), splat.count.end()), nearest;
  for (const cv::Vec4i& four : splat.nearest) nearest.insert(nearest.end(), four.val, four.val + 4);
  TensorMap tensors;
  tensors["image"] = planes_of(splat.color);
  tensors["count"] = FileTensor::of(count, {1, side, side});
  tensors["idx4"] = FileTensor::of(nearest, {1, side, side, 4});
  tensors["bg_raw"] = FileTensor::of(background, {1, side, side});
  tensors["bg_dilated"] = FileTensor::of(dilated, {1, side, side});
  return tensors;
}

void run_splat(const SplatArguments& a, const Context& context) {
  check_output_file(a.files.out, {".safetensors"});
  check_not_input(a.files.out, {a.files.in});
  note_interrupts();
  const PlanePoints points = read_points(a, context);
  SplatOptions options = a.splat;
  options.near = 0;
  options.count_hits = true;
  const Stopwatch watch;
  const Splat result = splat_plane(points, {a.size, a.size}, options);
  const double seconds = watch.seconds();
  throw_if_interrupted();
  write_safetensors(a.files.out, tensors_of(result));
  print_report(context,
               {{"points", points.z.size()}, {"size", a.size}, {"splat_seconds", seconds}});
  context.say(a.files.out + ": " + std::to_string(points.z.size()) + " points");
}

}  // namespace

void add_probe_splat(CLI::App& probe, const Context& context) {
  auto* verb = probe.add_subcommand(
      "splat",
      "points [N,3] (x left, y up, z depth; the square image spans -1 to 1) and features [3,N] in "
      "[-1,1] -> image [1,3,S,S], count [1,S,S], idx4 [1,S,S,4], bg_raw and bg_dilated [1,S,S].");
  auto a = std::make_shared<SplatArguments>();
  add_files(*verb, a->files);
  verb->add_option("--size", a->size, "Side of the image in pixels")
      ->type_name("S")
      ->check(whole_in(1, 8192));
  verb->add_option("--radius", a->splat.radius, "Radius of a splat in pixels")
      ->type_name("PX")
      ->check(in_range(0.01, 64));
  verb->add_option("--points-per-pixel", a->splat.points_per_pixel,
                   "Only the nearest so many points of a pixel count")
      ->type_name("N")
      ->check(whole_in(1, 65536));
  verb->callback([a, &context] { run_splat(*a, context); });
}

}  // namespace ps::apps
