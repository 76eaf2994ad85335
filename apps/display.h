// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

namespace ps::apps {

/// @brief An X display to draw on: the one DISPLAY names or, for pictures, a virtual one (Xvfb),
/// which ends with this object.
class Display {
 public:
  enum class Need { window, picture };

  /// Throws ps::Error that says what to install or set when there is none.
  explicit Display(Need need);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  pid_t server_ = 0;  ///< of Xvfb; 0 = none was started
};

}  // namespace ps::apps
