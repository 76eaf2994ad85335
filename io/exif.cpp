// SPDX-License-Identifier: BSD-3-Clause
#include "io/exif.h"

#include <libexif/exif-data.h>

#include <cmath>
#include <memory>

#include "libps/core/words.h"

namespace ps {
namespace {

/// @return the first number of a tag, 0 when it is not there
double number(ExifData* data, ExifIfd ifd, ExifTag tag) {
  const ExifEntry* entry = exif_content_get_entry(data->ifd[ifd], tag);
  if (entry == nullptr || entry->components < 1 || entry->data == nullptr) return 0;
  if (entry->size < exif_format_get_size(entry->format)) return 0;
  const ExifByteOrder order = exif_data_get_byte_order(data);
  switch (entry->format) {
    case EXIF_FORMAT_SHORT:
      return exif_get_short(entry->data, order);
    case EXIF_FORMAT_LONG:
      return exif_get_long(entry->data, order);
    case EXIF_FORMAT_RATIONAL: {
      const ExifRational ratio = exif_get_rational(entry->data, order);
      return ratio.denominator == 0 ? 0 : static_cast<double>(ratio.numerator) / ratio.denominator;
    }
    default:
      return 0;
  }
}

/// FocalPlaneResolutionUnit: 2 inch (also when missing), 3 cm, 4 mm, 5 micrometre.
double millimetres(int unit) { return unit == 3 ? 10 : unit == 4 ? 1 : unit == 5 ? 0.001 : 25.4; }

}  // namespace

Exif parse_exif(std::string_view tiff) {
  Exif exif;
  if (tiff.size() < 8 || tiff.size() > 1 << 20) return exif;
  const std::string block = std::string("Exif\0\0", 6) + std::string(tiff);
  const std::unique_ptr<ExifData, void (*)(ExifData*)> data(exif_data_new(), exif_data_unref);
  if (!data) return exif;
  exif_data_unset_option(data.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
  exif_data_load_data(data.get(), reinterpret_cast<const unsigned char*>(block.data()),
                      static_cast<unsigned>(block.size()));
  const int orientation = static_cast<int>(number(data.get(), EXIF_IFD_0, EXIF_TAG_ORIENTATION));
  if (orientation >= 1 && orientation <= 8) exif.orientation = orientation;
  exif.focal_35mm = number(data.get(), EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
  exif.focal_mm = number(data.get(), EXIF_IFD_EXIF, EXIF_TAG_FOCAL_LENGTH);
  const double unit = number(data.get(), EXIF_IFD_EXIF, EXIF_TAG_FOCAL_PLANE_RESOLUTION_UNIT);
  exif.pixels_per_mm = number(data.get(), EXIF_IFD_EXIF, EXIF_TAG_FOCAL_PLANE_X_RESOLUTION) /
                       millimetres(static_cast<int>(unit));
  exif.width = number(data.get(), EXIF_IFD_EXIF, EXIF_TAG_PIXEL_X_DIMENSION);
  return exif;
}

std::optional<double> Exif::focal_px(cv::Size size) const {
  double focal = focal_35mm * std::hypot(size.width, size.height) / std::hypot(36.0, 24.0);
  if (focal == 0) {
    const double resized = width > 0 ? size.width / width : 1;
    focal = focal_mm * pixels_per_mm * resized;
  }
  const double side = std::max(size.width, size.height);
  // A tenth of the side sees 157 degrees; 200 sides see a quarter of one.
  if (!(focal >= 0.1 * side && focal <= 200 * side)) return std::nullopt;
  return focal;
}

std::string Exif::focal_doubt(cv::Size size) const {
  constexpr double kLeast = 0.5, kMost = 5000;  // millimetres; of a phone's and a telescope's lens
  if (focal_px(size)) return "";
  if (focal_35mm > 0) {
    return "a focal length of " + in_digits(focal_35mm) + " mm for 35 mm film, which cannot be";
  }
  if (!(focal_mm > 0)) return "";
  const std::string length = "a focal length of " + in_digits(focal_mm) + " mm";
  const bool believable = focal_mm >= kLeast && focal_mm <= kMost;
  if (!believable) return length + ", which cannot be";
  if (!(pixels_per_mm > 0)) return length + " but not how large the sensor is";
  return length + " at " + in_digits(pixels_per_mm) + " pixels per mm, which cannot be";
}

}  // namespace ps
