// SPDX-License-Identifier: BSD-3-Clause
#include "apps/part.h"
#include "apps/viewer.h"

namespace ps::apps {

void show(const Cloud& cloud, const ViewerOptions& options) {
  function_of_part<decltype(pixelsynth_show)>("viewer", "pixelsynth_show")(cloud, options);
}

Image snapshot(const Cloud& cloud, const ViewerOptions& options) {
  Image picture;
  function_of_part<decltype(pixelsynth_snapshot)>("viewer", "pixelsynth_snapshot")(cloud, options,
                                                                                   &picture);
  return picture;
}

}  // namespace ps::apps
