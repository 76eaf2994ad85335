// SPDX-License-Identifier: BSD-3-Clause
#include "tests/nn/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ps::nn::reference {
namespace {

/// Calls f(n, y, x) for all pixels.
void for_pixels(const Shape& s, const std::function<void(int, int, int)>& f) {
  for (int n = 0; n < s.images; ++n) {
    for (int y = 0; y < s.height; ++y) {
      for (int x = 0; x < s.width; ++x) f(n, y, x);
    }
  }
}

double at(const WeightTensor& w, int a, int b, int ky, int kx) {
  const auto i = [](int v) { return static_cast<std::size_t>(v); };
  return w.values[((i(a) * w.shape[1] + i(b)) * w.shape[2] + i(ky)) * w.shape[3] + i(kx)];
}

double at(const std::vector<float>& v, int i) { return v[static_cast<std::size_t>(i)]; }
double bias_at(const std::vector<float>& bias, int i) { return bias.empty() ? 0 : at(bias, i); }
int size(const WeightTensor& w, std::size_t axis) { return static_cast<int>(w.shape[axis]); }

/// The pixels of a 3x3 (or other) window that are inside the image.
std::vector<double> window(const Values& in, int n, int y, int x, int c, const MaxPool& pool) {
  std::vector<double> inside;
  for (int v = y * pool.stride - pool.padding; v < y * pool.stride - pool.padding + pool.kernel;
       ++v) {
    for (int u = x * pool.stride - pool.padding; u < x * pool.stride - pool.padding + pool.kernel;
         ++u) {
      const bool is_inside = v >= 0 && v < in.shape.height && u >= 0 && u < in.shape.width;
      if (is_inside) inside.push_back(in.at(n, v, u, c));
    }
  }
  return inside;
}

/// (values - mean) / sqrt(variance + 1e-5), in place, `divisor` under the sum of squares
void normalise(const std::vector<double*>& values, double divisor) {
  double mean = 0, squares = 0;
  for (const double* v : values) mean += *v / static_cast<double>(values.size());
  for (const double* v : values) squares += (*v - mean) * (*v - mean);
  const double variance = values.size() > 1 ? squares / divisor : 0;
  for (double* v : values) *v = (*v - mean) / std::sqrt(variance + 1e-5);
}

/// As torch counts: whole windows, or with `ceil` any that begins inside the image or its left
/// padding.
int pooled(int size, const MaxPool& pool) {
  int count = 0;
  for (int begin = -pool.padding; size > 0; begin += pool.stride) {
    const bool whole = begin + pool.kernel <= size + pool.padding;
    const bool begins_inside =
        begin < size && begin + pool.kernel < size + pool.padding + pool.stride;
    if (!(whole || (pool.ceil && begins_inside))) break;
    ++count;
  }
  return count;
}

}  // namespace

Values::Values(const Shape& s)
    : shape(s), values(s.pixels() * static_cast<std::size_t>(s.channels)) {}

Values::Values(const TensorView& view) : Values(view.shape) {
  for_pixels(shape, [&](int n, int y, int x) {
    for (int c = 0; c < shape.channels; ++c) at(n, y, x, c) = view.pixel(n, y, x)[c];
  });
}

std::size_t Values::index(int n, int y, int x, int c) const {
  const auto i = [](int v) { return static_cast<std::size_t>(v); };
  return ((i(n) * i(shape.height) + i(y)) * i(shape.width) + i(x)) * i(shape.channels) + i(c);
}

double Values::padded(int n, int y, int x, int c) const {
  const bool inside = y >= 0 && y < shape.height && x >= 0 && x < shape.width;
  return inside ? at(n, y, x, c) : 0;
}

double Values::largest() const {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

Values convolution(const Values& in, const WeightTensor& weight, const std::vector<float>& bias,
                   const ConvolutionCase& o) {
  const int k = size(weight, 2);
  const auto length = [&](int l) {
    const int reach = o.dilation * (k - 1) + 1;
    return l + 2 * o.padding < reach ? 0 : (l + 2 * o.padding - reach) / o.stride + 1;
  };
  Values out(
      Shape{in.shape.images, length(in.shape.height), length(in.shape.width), size(weight, 0)});
  for_pixels(out.shape, [&](int n, int y, int x) {
    for (int c = 0; c < out.shape.channels; ++c) {
      double sum = bias_at(bias, c);
      for (int i = 0; i < in.shape.channels; ++i) {
        for (int ky = 0; ky < k; ++ky) {
          for (int kx = 0; kx < k; ++kx) {
            sum +=
                at(weight, c, i, ky, kx) * in.padded(n, y * o.stride - o.padding + ky * o.dilation,
                                                     x * o.stride - o.padding + kx * o.dilation, i);
          }
        }
      }
      out.at(n, y, x, c) = sum;
    }
  });
  return out;
}

Values transposed_convolution(const Values& in, const WeightTensor& weight,
                              const std::vector<float>& bias) {
  Values out(Shape{in.shape.images, 2 * in.shape.height, 2 * in.shape.width, size(weight, 1)});
  for_pixels(out.shape, [&](int n, int y, int x) {
    for (int c = 0; c < out.shape.channels; ++c) out.at(n, y, x, c) = bias_at(bias, c);
  });
  for_pixels(in.shape, [&](int n, int y, int x) {  // every input is spread over 4x4 outputs
    for (int ky = 0; ky < 4; ++ky) {
      for (int kx = 0; kx < 4; ++kx) {
        const int v = 2 * y - 1 + ky, u = 2 * x - 1 + kx;
        if (v < 0 || v >= out.shape.height || u < 0 || u >= out.shape.width) continue;
        for (int i = 0; i < in.shape.channels; ++i) {
          for (int c = 0; c < out.shape.channels; ++c) {
            out.at(n, v, u, c) += in.at(n, y, x, i) * at(weight, i, c, ky, kx);
          }
        }
      }
    }
  });
  return out;
}

Values masked_convolution(const Values& in, const std::vector<std::uint8_t>& mask,
                          const WeightTensor& weight, const std::vector<float>& bias,
                          int dilation) {
  Shape shape = in.shape;
  shape.channels = size(weight, 0);
  Values out(shape);
  for_pixels(shape, [&](int n, int y, int x) {
    for (int c = 0; c < shape.channels; ++c) {
      double sum = bias_at(bias, c);
      for (int k = 0; k < 9; ++k) {
        const int cell = (k * shape.height + y) * shape.width + x;
        if (!mask[static_cast<std::size_t>(cell)]) continue;
        for (int i = 0; i < in.shape.channels; ++i) {
          sum += at(weight, c, i, k / 3, k % 3) *
                 in.padded(n, y + (k / 3 - 1) * dilation, x + (k % 3 - 1) * dilation, i);
        }
      }
      out.at(n, y, x, c) = sum;
    }
  });
  return out;
}

Values linear(const Values& in, const WeightTensor& weight, const std::vector<float>& bias) {
  Shape shape = in.shape;
  shape.channels = size(weight, 0);
  Values out(shape);
  for_pixels(shape, [&](int n, int y, int x) {
    for (int c = 0; c < shape.channels; ++c) {
      double sum = bias_at(bias, c);
      for (int i = 0; i < in.shape.channels; ++i) {
        sum +=
            static_cast<double>(at(weight.values, c * in.shape.channels + i)) * in.at(n, y, x, i);
      }
      out.at(n, y, x, c) = sum;
    }
  });
  return out;
}

Values map(const Values& in, const std::function<double(double)>& f) {
  Values out = in;
  for (double& v : out.values) v = f(v);
  return out;
}

Values map(const Values& a, const Values& b, const std::function<double(double, double)>& f) {
  Values out = a;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = f(a.values[i], b.values[i]);
  return out;
}

Values activation(const Values& in, double slope) {
  return map(in, [slope](double x) { return x < 0 ? slope * x : x; });
}

Values scale_shift(const Values& in, const std::vector<float>& scale,
                   const std::vector<float>& shift) {
  Values out = in;
  for_pixels(in.shape, [&](int n, int y, int x) {
    for (int c = 0; c < in.shape.channels; ++c) {
      out.at(n, y, x, c) = in.at(n, y, x, c) * at(scale, c) + at(shift, c);
    }
  });
  return out;
}

double elu(double x) { return x < 0 ? std::expm1(x) : x; }
double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

Values concat_elu(const Values& in) {
  Shape shape = in.shape;
  shape.channels *= 2;
  Values out(shape);
  for_pixels(shape, [&](int n, int y, int x) {
    for (int c = 0; c < in.shape.channels; ++c) {
      out.at(n, y, x, c) = elu(in.at(n, y, x, c));
      out.at(n, y, x, in.shape.channels + c) = elu(-in.at(n, y, x, c));
    }
  });
  return out;
}

Values instance_norm(const Values& in) {
  Values out = in;
  for (int n = 0; n < in.shape.images; ++n) {
    for (int c = 0; c < in.shape.channels; ++c) {
      std::vector<double*> plane;
      plane.reserve(in.values.size());
      for (int y = 0; y < in.shape.height; ++y) {
        for (int x = 0; x < in.shape.width; ++x) plane.push_back(&out.at(n, y, x, c));
      }
      normalise(plane, static_cast<double>(plane.size()));
    }
  }
  return out;
}

Values positional_norm(const Values& in) {
  Values out = in;
  for_pixels(in.shape, [&](int n, int y, int x) {
    std::vector<double*> channels;
    channels.reserve(in.values.size());
    for (int c = 0; c < in.shape.channels; ++c) channels.push_back(&out.at(n, y, x, c));
    normalise(channels, in.shape.channels - 1);
  });
  return out;
}

Values softmax(const Values& in, double temperature) {
  Values out = in;
  for_pixels(in.shape, [&](int n, int y, int x) {
    double most = -std::numeric_limits<double>::infinity(), sum = 0;
    for (int c = 0; c < in.shape.channels; ++c) most = std::max(most, in.at(n, y, x, c));
    for (int c = 0; c < in.shape.channels; ++c) {
      out.at(n, y, x, c) = std::exp((in.at(n, y, x, c) - most) / temperature);
      sum += out.at(n, y, x, c);
    }
    for (int c = 0; c < in.shape.channels; ++c) out.at(n, y, x, c) /= sum;
  });
  return out;
}

Values upsample_bilinear_2x(const Values& in) {
  Values out(Shape{in.shape.images, 2 * in.shape.height, 2 * in.shape.width, in.shape.channels});
  for_pixels(out.shape, [&](int n, int y, int x) {
    const double v = std::clamp((y + 0.5) / 2 - 0.5, 0.0, in.shape.height - 1.0);
    const double u = std::clamp((x + 0.5) / 2 - 0.5, 0.0, in.shape.width - 1.0);
    const int y0 = static_cast<int>(v), x0 = static_cast<int>(u);
    const int y1 = std::min(y0 + 1, in.shape.height - 1), x1 = std::min(x0 + 1, in.shape.width - 1);
    const double b = v - y0, a = u - x0;
    for (int c = 0; c < in.shape.channels; ++c) {
      out.at(n, y, x, c) = (1 - b) * ((1 - a) * in.at(n, y0, x0, c) + a * in.at(n, y0, x1, c)) +
                           b * ((1 - a) * in.at(n, y1, x0, c) + a * in.at(n, y1, x1, c));
    }
  });
  return out;
}

Values average_pool(const Values& in, bool count_padding) {
  const MaxPool pool = {3, 2, 1, false};
  Values out(Shape{in.shape.images, pooled(in.shape.height, pool), pooled(in.shape.width, pool),
                   in.shape.channels});
  for_pixels(out.shape, [&](int n, int y, int x) {
    for (int c = 0; c < in.shape.channels; ++c) {
      const std::vector<double> inside = window(in, n, y, x, c, pool);
      double sum = 0;
      for (const double v : inside) sum += v;
      out.at(n, y, x, c) = sum / (count_padding ? 9 : static_cast<double>(inside.size()));
    }
  });
  return out;
}

Values max_pool(const Values& in, const MaxPool& pool) {
  Values out(Shape{in.shape.images, pooled(in.shape.height, pool), pooled(in.shape.width, pool),
                   in.shape.channels});
  for_pixels(out.shape, [&](int n, int y, int x) {
    for (int c = 0; c < in.shape.channels; ++c) {
      const std::vector<double> inside = window(in, n, y, x, c, pool);
      out.at(n, y, x, c) = *std::max_element(inside.begin(), inside.end());
    }
  });
  return out;
}

Values global_average(const Values& in) {
  Values out(Shape{in.shape.images, 1, 1, in.shape.channels});
  const double pixels = static_cast<double>(in.shape.height) * in.shape.width;
  for_pixels(in.shape, [&](int n, int y, int x) {
    for (int c = 0; c < in.shape.channels; ++c) out.at(n, 0, 0, c) += in.at(n, y, x, c) / pixels;
  });
  return out;
}

std::vector<std::int32_t> nearest_codes(const Values& in, const WeightTensor& embed) {
  std::vector<std::int32_t> codes;
  const int count = size(embed, 1);
  for_pixels(in.shape, [&](int n, int y, int x) {
    double least = std::numeric_limits<double>::infinity();
    int best = 0;
    for (int k = 0; k < count; ++k) {
      double square = 0;
      for (int c = 0; c < in.shape.channels; ++c) {
        const double d = in.at(n, y, x, c) - at(embed.values, c * count + k);
        square += d * d;
      }
      if (square < least) {
        least = square;
        best = k;
      }
    }
    codes.push_back(best);
  });
  return codes;
}

}  // namespace ps::nn::reference
