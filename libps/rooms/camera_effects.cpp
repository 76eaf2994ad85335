// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/camera_effects.h"

#include <array>
#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/rooms/dice.h"
#include "libps/rooms/effects_kernel.h"
#include "libps/rooms/isa.h"
#include "libps/rooms/plane_kernel.h"

namespace ps::rooms {
namespace {

float* row_of(Shot& s, int y) { return &s.color[static_cast<std::size_t>(y) * s.width * 3]; }

/// A function of [0, 1.5) by table.
class Table {
 public:
  template <typename F>
  explicit Table(F f) {
    for (int i = 0; i <= kSteps; ++i) values_[i] = f(kMost * static_cast<float>(i) / kSteps);
  }
  /// Puts the function in the place of each x.
  void apply(float* x, int count) const {
    PS_FITTING(plane_kernel::look)({values_.data(), kSteps, kMost, false}, x, x, count);
  }

 private:
  static constexpr int kSteps = 1024;
  static constexpr float kMost = 1.5f;
  std::array<float, kSteps + 1> values_;
};

/// Exposure, colour of the light, corners, contrast, saturation.
void tone(Shot& s, Dice& d, const EffectOptions& o) {
  // Gains act on light; a power of 2.2 is near enough to sRGB.
  const auto gain_of = [](float gain) { return std::pow(gain, 1 / 2.2f); };
  const float gain = std::exp2(d.normal() * 0.5f * o.exposure);
  const float red = 1 + 0.5f * o.white_balance * d.normal();
  const float blue = 1 + 0.5f * o.white_balance * d.normal();
  const float gains[3] = {gain_of(gain * red), gain_of(gain), gain_of(gain * blue)};
  const float corner = d.chance(0.6f) ? o.vignetting * d.unit() : 0;
  const float gamma = std::exp2(o.contrast * d.range(-0.4f, 1));
  const float curve = o.contrast * d.range(-0.2f, 1.4f);
  const float saturation = 1 + o.saturation * d.range(-0.6f, 1.2f);
  const Table light_left([&](float r2) { return gain_of(1 - corner * 0.5f * std::min(r2, 2.f)); });
  const Table contrast([&](float x) {
    const float q = std::pow(clamp01(x), gamma);
    return mix(q, q * q * (3 - 2 * q), curve);
  });
  const float mx = 0.5f * static_cast<float>(s.width - 1);
  const float my = 0.5f * static_cast<float>(s.height - 1);
  std::vector<float> light(s.width);
  for (int y = 0; y < s.height; ++y) {
    const float b = (static_cast<float>(y) - my) / (my + 1);
    for (int x = 0; x < s.width; ++x) {
      const float a = (static_cast<float>(x) - mx) / (mx + 1);
      light[x] = (a * a + b * b) * 0.7f;
    }
    light_left.apply(light.data(), s.width);
    PS_FITTING(effects_kernel::tint)(row_of(s, y), light.data(), gains, saturation, s.width);
    contrast.apply(row_of(s, y), 3 * s.width);
  }
}

constexpr int kMostReach = 8;

/// A row of pixels with its first and last repeated kMostReach times.
void widen(const float* row, int width, float* wide) {
  for (int x = -kMostReach; x < width + kMostReach; ++x) {
    const float* p = row + 3 * std::clamp(x, 0, width - 1);
    std::copy(p, p + 3, wide + 3 * (x + kMostReach));
  }
}

/// A small kernel along each axis: sigma pixels, in x and in y.
std::vector<float> blurred(const Shot& s, float sigma_x, float sigma_y) {
  std::vector<float> image = s.color, out = image;
  for (const bool along_x : {true, false}) {
    const float sigma = along_x ? sigma_x : sigma_y;
    if (sigma < 0.2f) continue;
    const int reach = std::min(kMostReach, static_cast<int>(2.5f * sigma + 1));
    float weight[2 * kMostReach + 1], total = 0;
    for (int k = -reach; k <= reach; ++k) {
      const float q = static_cast<float>(k) / sigma;
      total += weight[k + kMostReach] = std::exp(-0.5f * q * q);
    }
    const std::size_t row = static_cast<std::size_t>(s.width) * 3;
    std::vector<float> wide(row + 6 * kMostReach);  // a row whose ends go on
    const float* taps[2 * kMostReach + 1];
    for (int y = 0; y < s.height; ++y) {
      if (along_x) widen(&image[y * row], s.width, wide.data());
      for (int k = -reach; k <= reach; ++k) {
        taps[k + reach] = along_x ? &wide[3 * (kMostReach + k)]
                                  : &image[std::clamp(y + k, 0, s.height - 1) * row];
      }
      PS_FITTING(effects_kernel::weigh)
      (taps, weight + kMostReach - reach, 2 * reach + 1, total, &out[y * row],
       static_cast<int>(row));
    }
    std::swap(image, out);
  }
  return image;
}

void focus(Shot& s, Dice& d, const EffectOptions& o) {
  if (o.blur > 0 && d.chance(0.6f)) {
    const float sigma = o.blur * d.unit() * d.unit() * 1.3f;
    const float motion = d.chance(0.3f) ? o.blur * d.range(0.4f, 2.2f) : 0;
    const bool across = d.chance(0.7f);
    s.color = blurred(s, sigma + (across ? motion : 0), sigma + (across ? 0 : motion));
  }
  if (o.sharpening > 0 && d.chance(0.6f)) {
    const float amount = o.sharpening * d.unit();
    const std::vector<float> soft = blurred(s, 1, 1);
    for (std::size_t i = 0; i < soft.size(); ++i)
      s.color[i] = clamp01(s.color[i] + amount * (s.color[i] - soft[i]));
  }
}

/// Many cheap numbers: a congruential generator, its upper half (O'Neill, "PCG", 2014, after the
/// same thought), several at a time.
effects_kernel::Streams streams_from(std::uint64_t state) {
  constexpr std::uint64_t kTimes = 6364136223846793005u, kPlus = 1442695040888963407u;
  effects_kernel::Streams streams{{}, 1, 0};
  for (std::uint64_t& s : streams.state) {
    s = state = state * kTimes + kPlus;
    streams.leap *= kTimes;
    streams.add = streams.add * kTimes + kPlus;
  }
  return streams;
}

void grain(Shot& s, Dice& d, const EffectOptions& o) {
  if (o.noise <= 0 || d.chance(0.2f)) return;
  const float sigma = o.noise * d.unit() * d.unit(), colored = d.unit();
  const std::uint64_t high = d.bits(), low = d.bits();
  effects_kernel::Streams streams = streams_from(high << 32 | low);
  PS_FITTING(effects_kernel::grain)
  (&streams, s.color.data(), sigma, colored, static_cast<int>(s.color.size() / 3));
}

using Block = std::array<float, 64>;

/// Of the 8x8 cosine transform, by frequency, then place.
Block cosines() {
  Block b;
  for (int k = 0; k < 8; ++k) {
    for (int i = 0; i < 8; ++i) {
      b[k * 8 + i] = (k == 0 ? std::sqrt(0.125f) : 0.5f) *
                     static_cast<float>(std::cos((2 * i + 1) * k * 3.14159265358979 / 16));
    }
  }
  return b;
}

Block transposed(const Block& block) {
  Block b;
  for (int i = 0; i < 64; ++i) b[i] = block[i % 8 * 8 + i / 8];
  return b;
}

/// Quantises 8x8 blocks of luma and colour as JPEG does, finer frequencies coarser.
void quantise(Shot& s, Dice& d, const EffectOptions& o) {
  static const Block basis = cosines(), inverse = transposed(basis);
  if (o.jpeg <= 0 || d.chance(0.3f)) return;
  const float coarse = o.jpeg * d.unit() * 0.02f;
  Block steps[2];  // of luma, of colour
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < 64; ++i) {
      steps[c][i] =
          coarse * static_cast<float>(c + 1) * (1 + 0.6f * static_cast<float>(i % 8 + i / 8)) +
          1e-5f;
    }
  }
  const int stride = (s.width + 7) / 8 * 8;  // blocks at the edges repeat the last pixels
  std::vector<float> planes[3];
  for (auto& p : planes) p.resize(8 * static_cast<std::size_t>(stride));
  for (int y0 = 0; y0 < s.height; y0 += 8) {
    for (int y = 0; y < 8; ++y) {
      float* const at[3] = {&planes[0][y * stride], &planes[1][y * stride], &planes[2][y * stride]};
      const float* row = row_of(s, std::min(y0 + y, s.height - 1));
      PS_FITTING(effects_kernel::part)(row, at[0], at[1], at[2], s.width);
      for (float* p : at) std::fill(p + s.width, p + stride, p[s.width - 1]);
    }
    for (int c = 0; c < 3; ++c) {
      for (int x = 0; x < s.width; x += 8) {
        PS_FITTING(effects_kernel::quantise)
        (&planes[c][x], stride, basis.data(), inverse.data(), steps[c > 0 ? 1 : 0].data());
      }
    }
    for (int y = 0; y < 8 && y0 + y < s.height; ++y) {
      PS_FITTING(effects_kernel::join)
      (&planes[0][y * stride], &planes[1][y * stride], &planes[2][y * stride], row_of(s, y0 + y),
       s.width);
    }
  }
}

}  // namespace

void degrade(Shot& shot, std::uint64_t seed, const EffectOptions& options) {
  if (shot.width < 0 || shot.height < 0 ||
      shot.color.size() != static_cast<std::size_t>(shot.width) * shot.height * 3) {
    throw Error("degrade", std::to_string(shot.color.size()) + " colours",
                "three for each of " + std::to_string(shot.width) + "x" +
                    std::to_string(shot.height) + " pixels");
  }
  if (shot.color.empty()) return;
  Dice d(seed, 4);
  tone(shot, d, options);
  focus(shot, d, options);
  grain(shot, d, options);
  quantise(shot, d, options);
}

}  // namespace ps::rooms
