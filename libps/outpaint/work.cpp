// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/work.h"

namespace ps::outpaint {

Work::Work(const OutpaintOptions& options, int samples, std::size_t missing, std::size_t scorers,
           double pixels, double changed) {
  constexpr double kView = 256 * 256;  // pixels that the times are of
  encode = 11 * pixels / kView;
  sample = 0.014 * static_cast<double>(missing);
  decode = 12 * changed / kView;
  refine = 220 * changed / kView;
  refine_rest = changed < pixels ? 220 * pixels / kView : 0;
  score = 27 * static_cast<double>(scorers) * pixels / kView;
  const int asked = scorers == 0 ? 1 : options.refine_best;
  const bool few = asked > 0 && asked < samples;
  const bool screens = scorers > 0 && few && options.screen == OutpaintOptions::Screen::unrefined;
  whole = encode + refine_rest + samples * (sample + (screens ? decode + score : 0)) +
          (few ? asked : samples) * (decode + refine + score) + decode + refine;
}

}  // namespace ps::outpaint
