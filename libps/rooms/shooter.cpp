// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/shooter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libps/rooms/isa.h"
#include "libps/rooms/plane_kernel.h"
#include "libps/rooms/view_rays.h"

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kAmbientReach = 0.8f;  ///< metres within which things darken corners
constexpr float kLeastMirror = 0.02f;  ///< reflected share that is worth a ray
constexpr float kAbove = 2e-3f;        ///< metres over a surface where rays start

/// Where pixel (x, y) stands in its 4x4 block, well spread.
constexpr int kOrder[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

/// The bits of 0..15 backwards, as a fraction.
float reversed(int k) {
  return static_cast<float>((k & 1) << 3 | (k & 2) << 1 | (k & 4) >> 1 | (k & 8) >> 3) / 16.f +
         1 / 32.f;
}

/// Schlick, "An Inexpensive BRDF Model for Physically-based Rendering" (1994); rough surfaces shine
/// less at their edges.
float fresnel(const Material& m, float cosine) {
  if (m.gloss <= 0) return 0;
  if (m.gloss >= 1) return 1;
  const float k = 1 - clamp01(cosine), k2 = k * k;
  const float share = m.gloss + (1 - m.gloss) * k2 * k2 * k * std::max(0.f, 0.6f - 2 * m.roughness);
  return share > kLeastMirror ? share : 0;
}

/// For each pixel of a block: samples of the lamps, and a direction of the upper half, spread by
/// the cosine.
struct BlockSamples {
  float s[kRays], t[kRays], choice[kRays];
  Vec up[kRays];

  BlockSamples() {
    for (int k = 0; k < kRays; ++k) {
      const int o = kOrder[k];
      s[k] = (static_cast<float>(o) + 0.5f) / kRays;
      t[k] = reversed(o);
      choice[k] = (static_cast<float>(o * 7 % kRays) + 0.5f) / kRays;
      const float r = std::sqrt(t[k]), a = 2 * kPi * s[k];
      up[k] = {r * std::cos(a), r * std::sin(a), std::sqrt(1 - r * r)};
    }
  }
};

const BlockSamples kSamples;

/// Turns (x, y, z) with z up so that z stands on n: Duff et al., "Building an Orthonormal Basis,
/// Revisited" (2017).
Vec stand_on(Vec n, float x, float y, float z) {
  const float s = std::copysign(1.f, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
  return Vec{1 + s * n.x * n.x * a, s * b, -s * n.x} * x + Vec{b, s + n.y * n.y * a, -n.y} * y +
         n * z;
}

/// sRGB of what comes from a scene, straight at first, then with a shoulder.
class ToneCurve {
 public:
  ToneCurve() {
    for (int i = 0; i <= kSteps; ++i) {
      const float root = static_cast<float>(i) / kSteps, x = root * root * kMost;
      table_[i] = srgb_from_linear(x < 0.6f ? x : 0.6f + 0.4f * (1 - std::exp((0.6f - x) / 0.4f)));
    }
  }
  void apply(float* values, int count) const {
    look_({table_.data(), kSteps, kMost, true}, values, values, count);
  }

 private:
  static constexpr int kSteps = 1024;
  static constexpr float kMost = 4;
  std::array<float, kSteps + 1> table_;
  plane_kernel::Look* look_ = PS_FITTING(plane_kernel::look);
};

/// As the camera shows light: sRGB, in place.
void show(float* values, int count) {
  static const ToneCurve curve;
  curve.apply(values, count);
}

void put(float* at, Vec v) {
  at[0] = v.x;
  at[1] = v.y;
  at[2] = v.z;
}

}  // namespace

Shooter::Shooter(const Scene& scene, const Camera& camera)
    : scene_(scene), camera_(camera), eye_(eye_of(camera)), plane_(camera.width, camera.height) {}

Shot Shooter::shoot() {
  constexpr int kWide = 2 * kSide;
  for (int y = 0; y < plane_.height; y += kWide) {
    for (int x = 0; x < plane_.width; x += kWide) {
      for (const int k : {0, 1, 2, 3}) look(x + k % 2 * kSide, y + k / 2 * kSide);
      if (even(x, y, kWide) && light(x, y, 2)) continue;
      for (const int k : {0, 1, 2, 3}) light(x + k % 2 * kSide, y + k / 2 * kSide, 1);
    }
  }
  reflect();
  plane_.find_ends();
  plane_.smooth_light();
  plane_.smooth_mirror();
  const std::size_t n = plane_.pixels.size();
  Shot shot{plane_.width, plane_.height, std::vector<float>(3 * n), {}};
  for (std::size_t i = 0; i < n; ++i) {
    if (plane_.pixels[i].material) plane_.light[i] = scene_.evened(plane_.light[i]);
    put(&shot.color[3 * i], radiance(plane_.pixels[i], i) * scene_.exposure);
  }
  show(shot.color.data(), static_cast<int>(3 * n));
  smooth_edges(shot.color);
  shot.depth = std::move(plane_.depth);
  return shot;
}

Pixel Shooter::see(const Rays& rays, int i) const {
  const Surface s = surface_of(scene_, rays, i);
  const Vec to_eye = normalized(eye_ - s.position);
  const float slant = std::max(0.15f, dot(to_eye, s.flat));
  const float footprint = rays.reach[i] / camera_.fx / std::sqrt(slant) * s.uv_per_metre;
  Pixel p;
  p.material = s.material;
  p.position = s.position;
  p.normal = s.normal;
  p.flat = s.flat;
  p.albedo = albedo(*s.material, *s.pictures, s.u, s.v, footprint);
  p.reflected = fresnel(*s.material, dot(s.normal, to_eye));
  return p;
}

void Shooter::look(int x0, int y0) {
  Rays rays;
  block_rays(camera_, x0, y0, rays);
  scene_.nearest(rays);
  for (int k = 0; k < kRays; ++k) {
    if (rays.reach[k] < 0) continue;
    const std::size_t i = plane_.index(x0 + k % kSide, y0 + k / kSide);
    if (rays.face[k] < 0) {
      plane_.light[i] = scene_.sky.radiance(direction_of(rays, k));
    } else {
      plane_.depth[i] = rays.reach[k];
      plane_.pixels[i] = see(rays, k);
    }
  }
}

bool Shooter::even(int x0, int y0, int side) const {
  if (x0 + side > plane_.width || y0 + side > plane_.height) return false;
  const Pixel& first = plane_.pixels[plane_.index(x0, y0)];
  const float depth = plane_.depth[plane_.index(x0, y0)];
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      const Pixel& p = plane_.pixels[plane_.index(x, y)];
      if (!p.material || dot(p.normal, first.normal) < 0.99f ||
          std::abs(dot(first.flat, p.position - first.position)) > 0.01f * depth) {
        return false;
      }
    }
  }
  return true;
}

bool Shooter::light(int x0, int y0, int stride) {
  Lit lit[kRays];
  Rays rays;
  clear(rays);
  bool any = false;
  for (int k = 0; k < kRays; ++k) {
    const int x = x0 + k % kSide * stride, y = y0 + k / kSide * stride;
    if (x >= plane_.width || y >= plane_.height) continue;
    const Pixel& p = plane_.pixels[plane_.index(x, y)];
    if (!p.material) continue;
    any = true;
    lit[k].space = &scene_.space_at(p.position);
    lit[k].position = p.position + p.flat * kAbove;
    lit[k].normal = p.normal;
    lit[k].s = kSamples.s[k];
    lit[k].t = kSamples.t[k];
    lit[k].choice = kSamples.choice[k];
    const Vec up = kSamples.up[k];  // to find what darkens a corner
    set_ray(rays, k, lit[k].position, stand_on(p.flat, up.x, up.y, up.z), kAmbientReach);
  }
  if (!any) return true;
  scene_.nearest(rays);
  add_direct(scene_, lit);
  float quarters[4] = {};  // each has samples of all lamps, spread alike
  for (int k = 0; k < kRays; ++k) {
    if (!lit[k].space) continue;
    float open = 1;
    if (rays.face[k] >= 0) {
      const float near = 1 - rays.reach[k] / kAmbientReach;
      open = 1 - 0.9f * near * std::sqrt(near);
    }
    const int x = x0 + k % kSide * stride, y = y0 + k / kSide * stride;
    const Pixel& p = plane_.pixels[plane_.index(x, y)];
    const Vec ambient = lit[k].space->probes.irradiance(p.position, p.normal);
    const Vec light = (lit[k].irradiance + ambient * open) * (1 / kPi);
    quarters[k % kSide / 2 + k / kSide / 2 * 2] += luminance(light);
    for (int j = 0; j < stride * stride; ++j) {
      plane_.light[plane_.index(x + j % stride, y + j / stride)] = light;
    }
  }
  const auto [least, most] = std::minmax_element(quarters, quarters + 4);
  return *most <= 1.3f * *least;
}

void Shooter::reflect() {
  std::vector<std::uint32_t> todo;
  for (int y = 0; y < plane_.height; y += kSide) {  // by blocks: rays of a packet stay together
    for (int x = 0; x < plane_.width; x += kSide) {
      for (int k = 0; k < kRays; ++k) {
        const int px = x + k % kSide, py = y + k / kSide;
        if (px >= plane_.width || py >= plane_.height) continue;
        const std::size_t i = plane_.index(px, py);
        if (plane_.pixels[i].reflected > 0) todo.push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  for (std::size_t first = 0; first < todo.size(); first += kRays) {
    reflect(&todo[first], static_cast<int>(std::min<std::size_t>(kRays, todo.size() - first)));
  }
}

void Shooter::reflect(const std::uint32_t* pixels, int count) {
  Rays rays;
  clear(rays);
  for (int k = 0; k < count; ++k) {
    const Pixel& p = plane_.pixels[pixels[k]];
    const Vec in = normalized(p.position - eye_);
    Vec out = in - p.normal * (2 * dot(in, p.normal));
    const std::uint32_t x = pixels[k] % plane_.width, y = pixels[k] / plane_.width;
    const int o = kOrder[y % kSide * kSide + x % kSide];
    const float a = 2 * kPi * reversed(o);
    const float r = p.material->roughness * std::sqrt((static_cast<float>(o) + 0.5f) / 16);
    out += stand_on(normalized(out), r * std::cos(a), r * std::sin(a), 0);
    if (dot(out, p.flat) <= 0.01f) out += p.flat * (0.02f - dot(out, p.flat));
    set_ray(rays, k, p.position + p.flat * kAbove, out, kFarthest);
  }
  scene_.nearest(rays);
  Lit lit[kRays];
  Vec colors[kRays], emission[kRays];
  for (int k = 0; k < count; ++k) {
    if (rays.face[k] < 0) continue;
    const Surface s = surface_of(scene_, rays, k);
    lit[k].space = &scene_.space_at(s.position);
    lit[k].position = s.position + s.flat * kAbove;
    lit[k].normal = s.normal;
    colors[k] = albedo(*s.material, *s.pictures, s.u, s.v, 0.02f);
    emission[k] = s.material->emission;
  }
  add_direct(scene_, lit);
  for (int k = 0; k < count; ++k) {
    Vec& out = plane_.mirror[pixels[k]];
    if (!lit[k].space) {
      out = scene_.sky.radiance(direction_of(rays, k));
      continue;
    }
    const Vec ambient = lit[k].space->probes.irradiance(lit[k].position, lit[k].normal);
    out = colors[k] * scene_.evened((lit[k].irradiance + ambient) * (1 / kPi)) + emission[k];
    out = min(out, Vec{1, 1, 1} * (4 / scene_.exposure));  // one bright speck is grain
  }
}

Vec Shooter::radiance(const Pixel& p, std::size_t i) const {
  if (!p.material) return plane_.light[i];
  const Material& m = *p.material;
  const float share = plane_.pixels[i].reflected;
  Vec out = p.albedo * plane_.light[i] * (1 - share);
  if (share > 0) {
    const bool metal = m.gloss > 0.1f && m.gloss < 1;
    out += plane_.mirror[i] * (metal ? mix(Vec{1, 1, 1}, p.albedo, 0.6f) : Vec{1, 1, 1}) * share;
  }
  return out + m.emission * (m.pattern == Pattern::picture ? p.albedo : Vec{1, 1, 1});
}

void Shooter::smooth_edges(std::vector<float>& colors) const {
  constexpr int kExtra = 3;
  static const float offset[kExtra][2] = {{-0.33f, -0.1f}, {0.1f, 0.33f}, {0.25f, -0.33f}};
  const std::vector<std::uint32_t> todo = plane_.edges();
  for (std::size_t first = 0; first < todo.size(); first += kRays) {
    const int count = static_cast<int>(std::min<std::size_t>(kRays, todo.size() - first));
    Vec sums[kRays];
    for (int k = 0; k < count; ++k) {
      const float* c = &colors[3 * static_cast<std::size_t>(todo[first + k])];
      sums[k] = {c[0], c[1], c[2]};
    }
    for (const auto& o : offset) {
      Rays rays;
      clear(rays);
      for (int k = 0; k < count; ++k) {
        const std::uint32_t i = todo[first + k];
        set_ray(rays, k, eye_,
                ray_of(camera_, static_cast<float>(i % plane_.width) + o[0],
                       static_cast<float>(i / plane_.width) + o[1]),
                kFarthest);
      }
      scene_.nearest(rays);
      float more[3 * kRays];
      for (int k = 0; k < count; ++k) {
        put(more + 3 * k, extra(rays, k, todo[first + k]) * scene_.exposure);
      }
      show(more, 3 * count);
      for (int k = 0; k < count; ++k) sums[k] += {more[3 * k], more[3 * k + 1], more[3 * k + 2]};
    }
    for (int k = 0; k < count; ++k) {
      put(&colors[3 * static_cast<std::size_t>(todo[first + k])], sums[k] * (1.f / (kExtra + 1)));
    }
  }
}

/// Its light is that of the pixel around whose surface is likest.
Vec Shooter::extra(const Rays& rays, int k, std::size_t i) const {
  if (rays.face[k] < 0) return scene_.sky.radiance(direction_of(rays, k));
  const Pixel p = see(rays, k);
  const int x0 = static_cast<int>(i % plane_.width), y0 = static_cast<int>(i / plane_.width);
  std::size_t best = i;
  float least = 1e9f;
  for (int y = std::max(0, y0 - 1); y <= std::min(plane_.height - 1, y0 + 1); ++y) {
    for (int x = std::max(0, x0 - 1); x <= std::min(plane_.width - 1, x0 + 1); ++x) {
      const std::size_t j = plane_.index(x, y);
      const Pixel& q = plane_.pixels[j];
      if (!q.material) continue;
      const Vec away = q.position - p.position;
      const float cost = dot(away, away) + (1 - dot(p.normal, q.normal)) * 4 +
                         (p.material == q.material ? 0.f : 1.f);
      if (cost < least) {
        least = cost;
        best = j;
      }
    }
  }
  return plane_.pixels[best].material ? radiance(p, best) : p.albedo;
}

}  // namespace ps::rooms
