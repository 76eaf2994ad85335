// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/shot.h"

#include <cmath>
#include <string>

#include "libps/core/error.h"
#include "libps/rooms/light.h"
#include "libps/rooms/view_rays.h"

namespace ps::rooms {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kSide = 4;               ///< a packet is 4x4 pixels
constexpr float kAmbientReach = 0.8f;  ///< metres within which things darken corners
constexpr int kExtra = 3;              ///< rays more for a pixel at an edge

/// What a pixel sees, kept until all light is known.
struct Pixel {
  const Material* material = nullptr;  ///< null = outside
  const std::vector<Picture>* pictures = nullptr;
  Vec position, normal, flat;
  Vec albedo;
  float uv_per_metre = 1;
  float fresnel = 0;
};

struct Frames {
  int width, height;
  std::vector<Pixel> pixels;
  std::vector<Vec> light;   ///< irradiance / pi
  std::vector<Vec> mirror;  ///< what surfaces reflect
};

/// Where pixel (x, y) stands in its 4x4 block, well spread.
constexpr int kOrder[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

float reversed(int k) {  // bits of 0..15, as a fraction
  return static_cast<float>((k & 1) << 3 | (k & 2) << 1 | (k & 4) >> 1 | (k & 8) >> 3) / 16.f +
         1 / 32.f;
}

float footprint(const Camera& camera, const Pixel& p, Vec eye, float depth) {
  const Vec to = normalized(p.position - eye);
  const float slant = std::max(0.15f, std::abs(dot(to, p.flat)));
  return depth / camera.fx / std::sqrt(slant) * p.uv_per_metre;
}

float fresnel(const Material& m, float cosine) {
  if (m.gloss <= 0) return 0;
  if (m.gloss >= 1) return 1;
  const float k = 1 - clamp01(cosine), k2 = k * k;
  return m.gloss + (1 - m.gloss) * k2 * k2 * k * std::max(0.f, 0.6f - 2 * m.roughness);
}

/// Rotates a direction of the upper half (z up) to stand on n.
Vec stand_on(Vec n, float x, float y, float z) {
  const float s = std::copysign(1.f, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
  return Vec{1 + s * n.x * n.x * a, s * b, -s * n.x} * x + Vec{b, s + n.y * n.y * a, -n.y} * y +
         n * z;
}

class Shooter {
 public:
  Shooter(const Scene& scene, const Camera& camera)
      : scene_(scene), camera_(camera), eye_(eye_of(camera)) {
    const std::size_t n = static_cast<std::size_t>(camera.width) * camera.height;
    f_ = {camera.width, camera.height, std::vector<Pixel>(n), std::vector<Vec>(n),
          std::vector<Vec>(n)};
    shot_ = {camera.width, camera.height, std::vector<float>(3 * n), std::vector<float>(n)};
  }

  Shot shoot() {
    for (int y = 0; y < f_.height; y += kSide) {
      for (int x = 0; x < f_.width; x += kSide) {
        look(x, y);
        light(x, y);
      }
    }
    reflect();
    smooth(f_.light, 0);
    smooth(f_.mirror, 0.04f);
    for (std::size_t i = 0; i < f_.light.size(); ++i) {
      if (f_.pixels[i].material) f_.light[i] = scene_.evened(f_.light[i]);
    }
    std::vector<Vec> colors(f_.pixels.size());
    for (std::size_t i = 0; i < colors.size(); ++i)
      colors[i] = shown(radiance(f_.pixels[i], i, f_.pixels[i].albedo));
    smooth_edges(colors);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      shot_.color[3 * i] = colors[i].x;
      shot_.color[3 * i + 1] = colors[i].y;
      shot_.color[3 * i + 2] = colors[i].z;
    }
    return std::move(shot_);
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * f_.width + x; }

  Pixel see(const Rays& rays, int i, float depth) const {
    Pixel p;
    const Surface s = surface_of(scene_, rays, i);
    p.material = s.material;
    p.pictures = s.pictures;
    p.position = s.position;
    p.normal = s.normal;
    p.flat = s.flat;
    p.uv_per_metre = s.uv_per_metre;
    p.albedo = albedo(*s.material, *s.pictures, s.u, s.v, footprint(camera_, p, eye_, depth));
    return p;
  }

  void look(int x0, int y0) {
    Rays rays;
    clear(rays);
    for (int k = 0; k < kRays; ++k) {
      const int x = x0 + k % kSide, y = y0 + k / kSide;
      if (x < f_.width && y < f_.height) {
        set_ray(rays, k, eye_, ray_of(camera_, static_cast<float>(x), static_cast<float>(y)),
                kFarthest);
      }
    }
    scene_.nearest(rays);
    for (int k = 0; k < kRays; ++k) {
      const int x = x0 + k % kSide, y = y0 + k / kSide;
      if (x >= f_.width || y >= f_.height) continue;
      const std::size_t i = index(x, y);
      if (rays.face[k] < 0) {
        f_.light[i] =
            scene_.sky.radiance({rays.direction[0][k], rays.direction[1][k], rays.direction[2][k]});
        continue;
      }
      shot_.depth[i] = rays.reach[k];
      Pixel& p = f_.pixels[i];
      p = see(rays, k, rays.reach[k]);
      p.fresnel = fresnel(*p.material, dot(p.normal, normalized(eye_ - p.position)));
    }
  }

  /// Light on a block of pixels, each with its own sample of every lamp.
  void light(int x0, int y0) {
    Lit lit[kRays];
    Rays rays;
    clear(rays);
    bool any = false;
    for (int k = 0; k < kRays; ++k) {
      const int x = x0 + k % kSide, y = y0 + k / kSide;
      if (x >= f_.width || y >= f_.height) continue;
      const Pixel& p = f_.pixels[index(x, y)];
      if (!p.material) continue;
      any = true;
      lit[k].space = &scene_.space_at(p.position);
      lit[k].position = p.position + p.flat * 2e-3f;
      lit[k].normal = p.normal;
      const int o = kOrder[k];
      lit[k].s = (static_cast<float>(o) + 0.5f) / 16;
      lit[k].t = reversed(o);
      lit[k].choice = (static_cast<float>(o * 7 % 16) + 0.5f) / 16;
      // Cosine-spread directions for the corners' darkness.
      const float r = std::sqrt(lit[k].t), a = 2 * kPi * lit[k].s;
      set_ray(rays, k, lit[k].position,
              stand_on(p.flat, r * std::cos(a), r * std::sin(a), std::sqrt(1 - r * r)),
              kAmbientReach);
    }
    if (!any) return;
    scene_.nearest(rays);
    add_direct(scene_, lit);
    for (int k = 0; k < kRays; ++k) {
      if (!lit[k].space) continue;
      const Pixel& p = f_.pixels[index(x0 + k % kSide, y0 + k / kSide)];
      float open = 1;
      if (rays.face[k] >= 0) {
        const float near = 1 - rays.reach[k] / kAmbientReach;
        open = 1 - 0.9f * near * std::sqrt(near);
      }
      const Vec ambient = lit[k].space->probes.irradiance(p.position, p.normal);
      f_.light[index(x0 + k % kSide, y0 + k / kSide)] =
          (lit[k].irradiance + ambient * open) * (1 / kPi);
    }
  }

  /// Radiance of surfaces that packets of rays met, by probes and one sample of the lamps.
  void reflect() {
    std::vector<std::size_t> todo;
    for (std::size_t i = 0; i < f_.pixels.size(); ++i) {
      if (f_.pixels[i].fresnel > 0.012f) todo.push_back(i);
    }
    for (std::size_t first = 0; first < todo.size(); first += kRays) {
      const int count = static_cast<int>(std::min<std::size_t>(kRays, todo.size() - first));
      Rays rays;
      clear(rays);
      for (int k = 0; k < count; ++k) {
        const std::size_t i = todo[first + k];
        const Pixel& p = f_.pixels[i];
        const Vec in = normalized(p.position - eye_);
        Vec out = in - p.normal * (2 * dot(in, p.normal));
        const int o = kOrder[i / f_.width % 4 * 4 + i % f_.width % 4];
        const float a = 2 * kPi * reversed(o),
                    r = p.material->roughness * std::sqrt((static_cast<float>(o) + 0.5f) / 16);
        out += stand_on(normalized(out), r * std::cos(a), r * std::sin(a), 0);
        if (dot(out, p.flat) <= 0.01f) out += p.flat * (0.02f - dot(out, p.flat));
        set_ray(rays, k, p.position + p.flat * 2e-3f, out, kFarthest);
      }
      scene_.nearest(rays);
      Lit lit[kRays];
      Vec colors[kRays], emission[kRays];
      for (int k = 0; k < count; ++k) {
        if (rays.face[k] < 0) continue;
        const Surface s = surface_of(scene_, rays, k);
        lit[k].space = &scene_.space_at(s.position);
        lit[k].position = s.position + s.flat * 2e-3f;
        lit[k].normal = s.normal;
        colors[k] = albedo(*s.material, *s.pictures, s.u, s.v, 0.02f);
        emission[k] = s.material->emission;
      }
      add_direct(scene_, lit);
      for (int k = 0; k < count; ++k) {
        Vec& out = f_.mirror[todo[first + k]];
        if (!lit[k].space) {
          out = scene_.sky.radiance(
              {rays.direction[0][k], rays.direction[1][k], rays.direction[2][k]});
          continue;
        }
        const Vec ambient = lit[k].space->probes.irradiance(lit[k].position, lit[k].normal);
        out = colors[k] * (lit[k].irradiance + ambient) * (1 / kPi) + emission[k];
      }
    }
  }

  static bool same_surface(const Pixel& a, const Pixel& b, float depth) {
    if (!a.material || !b.material) return false;
    return dot(a.normal, b.normal) > 0.93f &&
           std::abs(dot(a.flat, b.position - a.position)) < 0.012f * depth;
  }

  /// The mean over 4x4 pixels of one surface, in which each sample of a lamp occurs once.
  void smooth(std::vector<Vec>& image, float least_roughness) {
    static const float weight[5] = {0.5f, 1, 1, 1, 0.5f};
    std::vector<Vec> before;
    for (const int step : {1, f_.width}) {
      before = image;
      for (int y = 0; y < f_.height; ++y) {
        for (int x = 0; x < f_.width; ++x) {
          const std::size_t i = index(x, y);
          const Pixel& p = f_.pixels[i];
          if (!p.material || p.material->roughness < least_roughness) continue;
          if (least_roughness > 0 && p.fresnel <= 0.012f) continue;
          Vec sum;
          float total = 0;
          for (int k = -2; k <= 2; ++k) {
            const int at = (step == 1 ? x : y) + k;
            if (at < 0 || at >= (step == 1 ? f_.width : f_.height)) continue;
            const std::size_t j = i + static_cast<std::ptrdiff_t>(k) * step;
            if (k != 0 && !same_surface(p, f_.pixels[j], shot_.depth[i])) continue;
            if (least_roughness > 0 && f_.pixels[j].fresnel <= 0.012f) continue;
            sum += before[j] * weight[k + 2];
            total += weight[k + 2];
          }
          image[i] = sum * (1 / total);
        }
      }
    }
  }

  /// What a surface with this colour sends to the eye, in the light of pixel i.
  Vec radiance(const Pixel& p, std::size_t i, Vec color) const {
    if (!p.material) return f_.light[i];
    const Material& m = *p.material;
    const float share = f_.pixels[i].fresnel > 0.012f ? f_.pixels[i].fresnel : 0;
    Vec out = color * f_.light[i] * (1 - share);
    const Vec tint = m.gloss > 0.1f && m.gloss < 1 ? mix(Vec{1, 1, 1}, color, 0.6f) : Vec{1, 1, 1};
    if (share > 0) out += f_.mirror[i] * tint * share;
    return out + m.emission * (m.pattern == Pattern::picture ? color : Vec{1, 1, 1});
  }

  Vec shown(Vec radiance) const {
    const auto curve = [](float x) {  // straight, then a shoulder
      return srgb_from_linear(
          clamp01(x < 0.6f ? x : 0.6f + 0.4f * (1 - std::exp((0.6f - x) / 0.4f))));
    };
    radiance *= scene_.exposure;
    return {curve(radiance.x), curve(radiance.y), curve(radiance.z)};
  }

  bool at_edge(int x, int y) const {
    const std::size_t i = index(x, y);
    const Pixel& p = f_.pixels[i];
    const auto differs = [&](std::size_t j) {
      const Pixel& q = f_.pixels[j];
      return p.material != q.material || (p.material && !same_surface(p, q, shot_.depth[i]));
    };
    return (x > 0 && differs(i - 1)) || (x + 1 < f_.width && differs(i + 1)) ||
           (y > 0 && differs(i - f_.width)) || (y + 1 < f_.height && differs(i + f_.width));
  }

  /// More rays where surfaces meet; their light is that of the nearest pixel of the same surface.
  void smooth_edges(std::vector<Vec>& colors) {
    static const float offset[kExtra][2] = {{-0.33f, -0.1f}, {0.1f, 0.33f}, {0.25f, -0.33f}};
    std::vector<std::size_t> todo;
    for (int y = 0; y < f_.height; ++y) {
      for (int x = 0; x < f_.width; ++x) {
        if (at_edge(x, y)) todo.push_back(index(x, y));
      }
    }
    std::vector<Vec> sums(todo.size());
    for (std::size_t t = 0; t < todo.size(); ++t) sums[t] = colors[todo[t]];
    for (const auto& o : offset) {
      for (std::size_t first = 0; first < todo.size(); first += kRays) {
        const int count = static_cast<int>(std::min<std::size_t>(kRays, todo.size() - first));
        Rays rays;
        clear(rays);
        for (int k = 0; k < count; ++k) {
          const std::size_t i = todo[first + k];
          set_ray(rays, k, eye_,
                  ray_of(camera_, static_cast<float>(i % f_.width) + o[0],
                         static_cast<float>(i / f_.width) + o[1]),
                  kFarthest);
        }
        scene_.nearest(rays);
        for (int k = 0; k < count; ++k) sums[first + k] += extra(rays, k, todo[first + k]);
      }
    }
    for (std::size_t t = 0; t < todo.size(); ++t) colors[todo[t]] = sums[t] * (1.f / (kExtra + 1));
  }

  Vec extra(const Rays& rays, int k, std::size_t i) const {
    if (rays.face[k] < 0) {
      return shown(
          scene_.sky.radiance({rays.direction[0][k], rays.direction[1][k], rays.direction[2][k]}));
    }
    Pixel p = see(rays, k, rays.reach[k]);
    const int x0 = static_cast<int>(i % f_.width), y0 = static_cast<int>(i / f_.width);
    std::size_t best = i;
    float least = 1e9f;
    for (int y = std::max(0, y0 - 1); y <= std::min(f_.height - 1, y0 + 1); ++y) {
      for (int x = std::max(0, x0 - 1); x <= std::min(f_.width - 1, x0 + 1); ++x) {
        const std::size_t j = index(x, y);
        const Pixel& q = f_.pixels[j];
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
    return shown(radiance(p, best, p.albedo));
  }

  const Scene& scene_;
  const Camera& camera_;
  Vec eye_;
  Frames f_;
  Shot shot_;
};

void check(const Camera& c) {
  if (c.width <= 0 || c.height <= 0 || c.width > 16384 || c.height > 16384) {
    throw Error("camera size", std::to_string(c.width) + "x" + std::to_string(c.height),
                "1 to 16384 pixels");
  }
  if (!(c.fx > 0) || !(c.fy > 0)) throw Error("camera", "a focal length is not positive", "pixels");
}

}  // namespace

Shot shoot(const Room& room, const Camera& camera) {
  check(camera);
  return Shooter(room.scene(), camera).shoot();
}

std::vector<float> shoot_depth(const Room& room, const Camera& camera) {
  check(camera);
  std::vector<float> depth(static_cast<std::size_t>(camera.width) * camera.height);
  const Vec eye = eye_of(camera);
  for (int y0 = 0; y0 < camera.height; y0 += kSide) {
    for (int x0 = 0; x0 < camera.width; x0 += kSide) {
      Rays rays;
      clear(rays);
      for (int k = 0; k < kRays; ++k) {
        const int x = x0 + k % kSide, y = y0 + k / kSide;
        if (x < camera.width && y < camera.height) {
          set_ray(rays, k, eye, ray_of(camera, static_cast<float>(x), static_cast<float>(y)),
                  kFarthest);
        }
      }
      room.scene().nearest(rays);
      for (int k = 0; k < kRays; ++k) {
        if (rays.face[k] < 0) continue;
        depth[static_cast<std::size_t>(y0 + k / kSide) * camera.width + x0 + k % kSide] =
            rays.reach[k];
      }
    }
  }
  return depth;
}

std::vector<std::uint8_t> seen_from(const Room& room, const Camera& a, const Camera& b,
                                    const std::vector<float>& depth_b) {
  check(a);
  check(b);
  const std::size_t n = static_cast<std::size_t>(b.width) * b.height;
  if (depth_b.size() != n) {
    throw Error("seen_from", std::to_string(depth_b.size()) + " depths", std::to_string(n));
  }
  std::vector<std::uint8_t> seen(n);
  const Vec eye_a = eye_of(a), eye_b = eye_of(b);
  for (std::size_t first = 0; first < n; first += kRays) {
    Rays rays;
    clear(rays);
    for (int k = 0; k < kRays && first + k < n; ++k) {
      const std::size_t i = first + k;
      if (!(depth_b[i] > 0)) continue;
      const Vec p =
          eye_b +
          ray_of(b, static_cast<float>(i % b.width), static_cast<float>(i / b.width)) * depth_b[i];
      const Vec in_a = to_camera(a, p);
      if (in_a.z <= 1e-3f) continue;
      const float x = in_a.x / in_a.z * a.fx + a.cx, y = in_a.y / in_a.z * a.fy + a.cy;
      if (x < -0.5f || y < -0.5f || x > static_cast<float>(a.width) - 0.5f ||
          y > static_cast<float>(a.height) - 0.5f)
        continue;
      set_ray(rays, k, eye_a, p - eye_a, 1 - std::max(1e-3f, 2e-3f / length(p - eye_a)));
      seen[i] = 1;
    }
    room.scene().nearest(rays);  // lamps block the view, if not the light
    for (int k = 0; k < kRays && first + k < n; ++k) {
      if (rays.face[k] >= 0) seen[first + k] = 0;
    }
  }
  return seen;
}

}  // namespace ps::rooms
