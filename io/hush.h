// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ps {

/// @brief For programs whose failures are to be one line: from now on, what the process prints
/// through `stderr` or `std::cerr` while an image is decoded is dropped. OpenCV, libjpeg and libpng
/// print there; what cannot be decoded is thrown as ps::Error. What writes to the file descriptor is
/// not held back, as the program's own messages do, from any thread. Without this call nothing is
/// dropped.
void hush_decoders();

/// While one lives, and after hush_decoders(), nothing is printed. Any thread may hold one.
class Hush {
 public:
  Hush();
  ~Hush();
  Hush(const Hush&) = delete;
  Hush& operator=(const Hush&) = delete;

 private:
  bool counts_ = false;
};

}  // namespace ps
