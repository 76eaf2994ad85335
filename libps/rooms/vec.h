// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room.
#pragma once

#include <algorithm>
#include <cmath>

namespace ps::rooms {

/// Three floats: a place, a direction, or a linear colour.
struct Vec {
  float x = 0, y = 0, z = 0;
};

inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator-(Vec a) { return {-a.x, -a.y, -a.z}; }
inline Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec operator*(float s, Vec a) { return a * s; }
inline Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec& operator+=(Vec& a, Vec b) { return a = a + b; }
inline Vec& operator*=(Vec& a, float s) { return a = a * s; }
inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec normalized(Vec a) {
  const float l = length(a);
  return l > 0 ? a * (1 / l) : Vec{0, 1, 0};
}
inline Vec mix(Vec a, Vec b, float t) { return a * (1 - t) + b * t; }
inline float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
inline Vec min(Vec a, Vec b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec max(Vec a, Vec b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline float luminance(Vec c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float clamp01(float x) { return std::clamp(x, 0.f, 1.f); }
/// 0 below a, 1 above b, smooth between.
inline float smooth_step(float a, float b, float x) {
  const float t = clamp01((x - a) / (b - a));
  return t * t * (3 - 2 * t);
}

inline float linear_from_srgb(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_from_linear(float l) {
  return l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f;
}
inline Vec linear_from_srgb(Vec c) {
  return {linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z)};
}

/// Axes and origin: a local place (x, y, z) is x*ex + y*ey + z*ez + origin.
struct Frame {
  Vec ex = {1, 0, 0}, ey = {0, 1, 0}, ez = {0, 0, 1}, origin;

  Vec direction(Vec d) const { return ex * d.x + ey * d.y + ez * d.z; }
  Vec point(Vec p) const { return direction(p) + origin; }
  /// This frame after `local`: local's places are given in this frame.
  Frame operator*(const Frame& local) const {
    return {direction(local.ex), direction(local.ey), direction(local.ez), point(local.origin)};
  }
};

/// Not turned.
inline Frame at(float x, float y, float z) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}}; }
/// Turned about the upright axis: z goes towards x.
inline Frame turned(float angle, Vec origin = {}) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, origin};
}
inline Frame tilted_x(float angle, Vec origin = {}) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{1, 0, 0}, {0, c, s}, {0, -s, c}, origin};
}
inline Frame tilted_z(float angle, Vec origin = {}) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, origin};
}

}  // namespace ps::rooms
