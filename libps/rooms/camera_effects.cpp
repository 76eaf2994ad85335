// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/camera_effects.h"

#include <array>
#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/rooms/dice.h"

namespace ps::rooms {
namespace {

float& channel(Shot& s, int x, int y, int c) {
  return s.color[(static_cast<std::size_t>(y) * s.width + x) * 3 + c];
}

/// A function of [0, 1.5) by table.
class Table {
 public:
  template <typename F>
  explicit Table(F f) {
    for (int i = 0; i <= kSteps; ++i) values_[i] = f(kMost * static_cast<float>(i) / kSteps);
  }
  float operator()(float x) const {
    const float at = std::clamp(x / kMost, 0.f, 0.9999f) * kSteps;
    const int i = static_cast<int>(at);
    return mix(values_[i], values_[i + 1], at - static_cast<float>(i));
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
  for (int y = 0; y < s.height; ++y) {
    for (int x = 0; x < s.width; ++x) {
      const float a = (static_cast<float>(x) - mx) / (mx + 1);
      const float b = (static_cast<float>(y) - my) / (my + 1);
      const float light = light_left((a * a + b * b) * 0.7f);
      float* p = &channel(s, x, y, 0);
      float v[3];
      for (int c = 0; c < 3; ++c) v[c] = std::min(1.f, p[c] * gains[c] * light);
      const float grey = 0.3f * v[0] + 0.59f * v[1] + 0.11f * v[2];
      for (int c = 0; c < 3; ++c) p[c] = contrast(clamp01(grey + (v[c] - grey) * saturation));
    }
  }
}

/// A small kernel along each axis: sigma pixels, in x and in y.
constexpr int kMostReach = 8;
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
    for (int y = 0; y < s.height; ++y) {
      for (int x = 0; x < s.width; ++x) {
        float sum[3] = {0, 0, 0};
        for (int k = -reach; k <= reach; ++k) {
          const int i = along_x ? std::clamp(x + k, 0, s.width - 1) : x;
          const int j = along_x ? y : std::clamp(y + k, 0, s.height - 1);
          const float* p = &image[(static_cast<std::size_t>(j) * s.width + i) * 3];
          for (int c = 0; c < 3; ++c) sum[c] += weight[k + kMostReach] * p[c];
        }
        for (int c = 0; c < 3; ++c)
          out[(static_cast<std::size_t>(y) * s.width + x) * 3 + c] = sum[c] / total;
      }
    }
    image = out;
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
/// same thought).
class Grain {
 public:
  explicit Grain(Dice& d) : state_(static_cast<std::uint64_t>(d.bits()) << 32 | d.bits()) {}
  /// About N(0, 1): a sum of four.
  float normal() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    const std::uint64_t x = state_ ^ state_ >> 29;
    float sum = 0;
    for (const int shift : {0, 16, 32, 48}) sum += static_cast<float>(x >> shift & 0xffff);
    return (sum * 0x1p-16f - 2) * 1.7320508f;
  }

 private:
  std::uint64_t state_;
};

void grain(Shot& s, Dice& d, const EffectOptions& o) {
  if (o.noise <= 0 || d.chance(0.2f)) return;
  const float sigma = o.noise * d.unit() * d.unit(), colored = d.unit();
  Grain random(d);
  for (std::size_t i = 0; i < s.color.size(); i += 3) {
    const float shared = random.normal();
    for (int c = 0; c < 3; ++c) {
      const float light = s.color[i + c];
      const float n = mix(shared, random.normal(), colored);
      s.color[i + c] = clamp01(light + sigma * n * (1.2f - 0.8f * light));
    }
  }
}

using Block = std::array<float, 64>;

/// The 8x8 cosine transform, rows then columns; `back` undoes it.
void transform(Block& block, bool back) {
  static const Block basis = [] {
    Block b;
    for (int k = 0; k < 8; ++k) {
      for (int i = 0; i < 8; ++i) {
        b[k * 8 + i] = (k == 0 ? std::sqrt(0.125f) : 0.5f) *
                       static_cast<float>(std::cos((2 * i + 1) * k * 3.14159265358979 / 16));
      }
    }
    return b;
  }();
  for (int pass = 0; pass < 2; ++pass) {
    Block out;
    for (int r = 0; r < 8; ++r) {
      for (int k = 0; k < 8; ++k) {
        float sum = 0;
        for (int i = 0; i < 8; ++i)
          sum += block[r * 8 + i] * (back ? basis[i * 8 + k] : basis[k * 8 + i]);
        out[k * 8 + r] = sum;  // transposed: the second pass does the columns
      }
    }
    block = out;
  }
}

/// Quantises 8x8 blocks of luma and colour as JPEG does, finer frequencies coarser.
void quantise(Shot& s, Dice& d, const EffectOptions& o) {
  if (o.jpeg <= 0 || d.chance(0.3f)) return;
  const float coarse = o.jpeg * d.unit() * 0.02f;
  for (int y0 = 0; y0 < s.height; y0 += 8) {
    for (int x0 = 0; x0 < s.width; x0 += 8) {
      Block planes[3];
      for (int i = 0; i < 64; ++i) {
        const float* p =
            &channel(s, std::min(x0 + i % 8, s.width - 1), std::min(y0 + i / 8, s.height - 1), 0);
        const float luma = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];
        planes[0][i] = luma;
        planes[1][i] = p[2] - luma;
        planes[2][i] = p[0] - luma;
      }
      for (int c = 0; c < 3; ++c) {
        transform(planes[c], false);
        for (int i = 0; i < 64; ++i) {
          const float step =
              coarse * (c == 0 ? 1 : 2) * (1 + 0.6f * static_cast<float>(i % 8 + i / 8)) + 1e-5f;
          planes[c][i] = std::nearbyint(planes[c][i] / step) * step;
        }
        transform(planes[c], true);
      }
      for (int i = 0; i < 64; ++i) {
        const int x = x0 + i % 8, y = y0 + i / 8;
        if (x >= s.width || y >= s.height) continue;
        float* p = &channel(s, x, y, 0);
        const float luma = planes[0][i], blue = planes[1][i] + luma, red = planes[2][i] + luma;
        p[0] = clamp01(red);
        p[1] = clamp01((luma - 0.299f * red - 0.114f * blue) / 0.587f);
        p[2] = clamp01(blue);
      }
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
  Dice d(seed, 4);
  tone(shot, d, options);
  focus(shot, d, options);
  grain(shot, d, options);
  quantise(shot, d, options);
}

}  // namespace ps::rooms
