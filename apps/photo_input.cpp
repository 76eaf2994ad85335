// SPDX-License-Identifier: BSD-3-Clause
#include "apps/photo_input.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "libps/scene/photo_depth.h"

namespace ps::apps {

Photo take_photo(const std::string& file, const Context& context, WantedPixels wanted) {
  Photo photo = ps::read_photo(file, wanted);
  check_photo(photo.color, file);
  if (photo.transparent > 0) {
    std::ostringstream share;
    share << std::fixed << std::setprecision(1) << std::max(100 * photo.transparent, .1);
    context.warn(file + ": " + share.str() +
                 " % of its pixels are transparent; the colours stored under them are taken");
  }
  return photo;
}

}  // namespace ps::apps
