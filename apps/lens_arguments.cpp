// SPDX-License-Identifier: BSD-3-Clause
#include "apps/lens_arguments.h"

#include <algorithm>

#include "apps/program.h"
#include "io/intrinsics_file.h"

namespace ps::apps {

void LensArguments::add_to(CLI::App& verb) {
  auto* file = verb.add_option("--intrinsics", intrinsics,
                               "Lens: Open3D JSON, COLMAP cameras.txt or 3x3 text")
                   ->type_name("FILE");
  verb.add_option("--fov", fov,
                  "Lens: horizontal field of view in degrees (default: from EXIF, else 60 along "
                  "the long side)")
      ->type_name("DEG")
      ->check(in_range(1, 179))
      ->excludes(file)
      ->default_str("");
}

PhotoLens choose_lens(const LensArguments& arguments, const Photo& photo, const std::string& name,
                      const Context& context) {
  constexpr double kDefaultFov = 60;
  const auto [width, height] = photo.size;
  if (!arguments.intrinsics.empty()) {
    return {read_intrinsics(arguments.intrinsics, width, height), "--intrinsics"};
  }
  if (arguments.fov != 0) return {intrinsics_from_fov(width, height, arguments.fov), "--fov"};
  // Along the long side: a camera held upright is the same camera.
  const int side = std::max(width, height);
  const double focal = intrinsics_from_fov(side, side, kDefaultFov).fx;
  Intrinsics lens = {width, height, focal, focal, (width - 1) / 2.0, (height - 1) / 2.0};
  if (photo.focal_px) {
    lens.fx = lens.fy = *photo.focal_px;
    check(lens, name + ": EXIF focal length");
    context.detail("lens: the photo's EXIF focal length");
    return {lens, "EXIF"};
  }
  const std::string why = photo.focal_doubt.empty()
                              ? "the photo does not say"
                              : "the photo's EXIF tells of " + photo.focal_doubt;
  context.say_once("lens: 60 degrees along the long side, as " + why +
                   "; --intrinsics or --fov does");
  return {lens, "default"};
}

Json to_json(const PhotoLens& lens) {
  Json json = to_json(lens.intrinsics);
  json["from"] = lens.from;
  return json;
}

}  // namespace ps::apps
