// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/kernels/elementwise.h"

#include "libps/nn/kernels/kernels.h"

namespace ps::nn {
namespace {

typedef uint32_t Words __attribute__((vector_size(kVectorBytes)));  ///< wraps around

/// e^x = 2^n (1 + q): n a whole number, x - n ln 2 within +-ln 2 / 2.
struct Split {
  Floats q;  ///< e^(x - n ln 2) - 1, to about an ulp of itself
  Words n;
};

/// @param x  within +-150, so that n has 8 bits and n * kLn2High is exact; or NaN, which q becomes
inline Split split(Floats x) {
  constexpr float kRound =
      12582912;  // 1.5 * 2^23: a small number added to it is rounded to a whole one
  constexpr float kLog2e = 1.44269504f;
  constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
  const Floats rounded = x * kLog2e + kRound;
  const Floats n = rounded - kRound;
  const Floats r = (x - n * kLn2High) - n * kLn2Low;
  // Minimax for (e^r - 1 - r) / r^2, weighted so that e^r - 1 is within 1.4e-8 of itself.
  Floats p = all(1.39464962401e-3f);
  p = multiply_add(p, r, all(8.36661058722e-3f));
  p = multiply_add(p, r, all(4.16662814100e-2f));
  p = multiply_add(p, r, all(1.66665427941e-1f));
  p = multiply_add(p, r, all(5.00000006208e-1f));
  return {multiply_add(r * r, p, r), (Words)rounded - (Words)all(kRound)};
}

/// 2^n for n in [-127, 127]; 0 at -127
inline Floats power_of_two(Words n) { return (Floats)((n + 127) << 23); }

inline Floats exponential(Floats x) {
  x = x > 89.0f ? all(89) : x;      // above, infinity
  x = x < -104.0f ? all(-104) : x;  // below, 0
  const Split s = split(x);
  // 2^n in two steps: neither leaves the normal numbers, and the product is rounded once.
  const Words half = (Words)((Ints)s.n >> 1);
  return (1.0f + s.q) * power_of_two(half) * power_of_two(s.n - half);
}

/// e^x - 1 for x that are not positive
inline Floats exponential_minus_1(Floats x) {
  x = x < -30.0f ? all(-30) : x;  // -1 already
  const Split s = split(x);
  const Floats scale = power_of_two(s.n);
  return multiply_add(scale, s.q, scale - 1.0f);
}

inline Floats absolute(Floats x) { return (Floats)((Words)x & 0x7fffffffu); }

inline Floats hyperbolic_tangent(Floats x) {
  const Floats m = exponential_minus_1(-2.0f * absolute(x));
  const Floats size = -m / (2.0f + m);
  return (Floats)((Words)size | ((Words)x & 0x80000000u));
}

inline Floats logistic(Floats x) {
  const Floats e = exponential(-absolute(x));
  return (x < 0.0f ? e : all(1)) / (1.0f + e);
}

inline Floats unit(Floats x) { return x < 0.0f ? exponential_minus_1(x) : x; }

inline Floats larger(Floats a, Floats b) {
  return ((a > b) | (a != a)) ? a : b;  // a NaN of either stays
}

/// out = f(in...), value by value; the last ones go through the same operations as all others.
template <class F, class... In>
inline void each(float* out, size_t count, F f, const In*... in) {
  size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) store(out + i, f(load(in + i)...));
  if (i < count) {
    const int left = static_cast<int>(count - i);
    store_part(out + i, f(load_part(in + i, left)...), left);
  }
}

}  // namespace

void PS_KERNEL(activate)(const float* in, float* out, size_t count, float slope) {
  each(
      out, count, [s = all(slope)](Floats x) { return activated(x, s); }, in);
}

void PS_KERNEL(elu)(const float* in, float* out, size_t count, float sign) {
  each(
      out, count, [s = all(sign)](Floats x) { return unit(x * s); }, in);
}

void PS_KERNEL(tanh)(const float* in, float* out, size_t count) {
  each(
      out, count, [](Floats x) { return hyperbolic_tangent(x); }, in);
}

void PS_KERNEL(sigmoid)(const float* in, float* out, size_t count) {
  each(
      out, count, [](Floats x) { return logistic(x); }, in);
}

void PS_KERNEL(exp)(const float* in, float* out, size_t count) {
  each(
      out, count, [](Floats x) { return exponential(x); }, in);
}

void PS_KERNEL(scale_shift)(const float* in, const float* scale, const float* shift, float* out,
                            size_t count, float slope) {
  const auto f = [s = all(slope)](Floats x, Floats a, Floats b) {
    return activated(multiply_add(x, a, b), s);
  };
  each(out, count, f, in, scale, shift);
}

void PS_KERNEL(add)(const float* a, const float* b, float* out, size_t count, float slope) {
  each(
      out, count, [s = all(slope)](Floats x, Floats y) { return activated(x + y, s); }, a, b);
}

void PS_KERNEL(gated_add)(const float* base, const float* value, const float* gate, float* out,
                          size_t count) {
  const auto f = [](Floats x, Floats v, Floats g) { return multiply_add(v, logistic(g), x); };
  each(out, count, f, base, value, gate);
}

void PS_KERNEL(mix)(const float* a, const float* b, float wa, float wb, float* out, size_t count) {
  const auto f = [p = all(wa), q = all(wb)](Floats x, Floats y) {
    return multiply_add(p, x, q * y);
  };
  each(out, count, f, a, b);
}

void PS_KERNEL(maximum)(const float* a, const float* b, float* out, size_t count) {
  each(
      out, count, [](Floats x, Floats y) { return larger(x, y); }, a, b);
}

}  // namespace ps::nn
