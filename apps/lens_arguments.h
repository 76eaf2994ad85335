// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "apps/context.h"
#include "apps/report.h"
#include "io/photo.h"

namespace ps::apps {

/// The arguments that `scene` and `depth` share: which lens a photo was taken with.
struct LensArguments {
  std::string intrinsics;  ///< a file; empty = not given
  double fov = 0;          ///< degrees across; 0 = not given

  void add_to(CLI::App& verb);
};

struct PhotoLens {
  Intrinsics intrinsics;
  std::string from;  ///< "--intrinsics", "--fov", "EXIF" or "default"
};

/// @brief What the user says, else what the photo says, else 60 degrees along the long side; says
/// which.
/// @param name  the photo's, for messages
PhotoLens choose_lens(const LensArguments& arguments, const Photo& photo, const std::string& name,
                      const Context& context);

/// @return what to_json() says of the intrinsics, and `from`
Json to_json(const PhotoLens& lens);

}  // namespace ps::apps
