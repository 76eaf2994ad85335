// SPDX-License-Identifier: BSD-3-Clause
// What holds for the forward of every network.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <new>

#include "libps/core/parallel.h"
#include "libps/models/autoencoder.h"
#include "libps/models/classifier.h"
#include "libps/models/depth_net.h"
#include "libps/models/discriminator.h"
#include "libps/models/lpips.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"
#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace {

std::atomic<std::size_t> taken{0};  ///< bytes asked of operator new

void* take(std::size_t bytes) {
  taken += bytes;
  void* memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return take(bytes); }
void* operator new[](std::size_t bytes) { return take(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace ps::models {
namespace {

/// A network by name, and one forward of it into `out`.
struct Forward {
  const char* name;
  nn::Shape out;
  std::function<std::function<void(const nn::TensorView& out, nn::Workspace&)>()> make;
};
void PrintTo(const Forward& forward, std::ostream* out) { *out << forward.name; }

nn::Tensor waves(const nn::Shape& shape) {
  nn::Tensor tensor(shape);
  for (std::size_t i = 0; i < shape.pixels() * static_cast<std::size_t>(shape.channels); ++i) {
    tensor.data()[i] = std::sin(0.05f * static_cast<float>(i % 1009));
  }
  return tensor;
}

template <class Body>
auto shared_body(Body&& body) {
  return [kept = std::make_shared<std::decay_t<Body>>(std::forward<Body>(body))](
             const nn::TensorView& out, nn::Workspace& workspace) { (*kept)(out, workspace); };
}

std::vector<Forward> all_forwards() {
  using View = const nn::TensorView&;
  using Space = nn::Workspace&;
  return {
      {"depth",
       {1, 256, 256, 1},
       [] {
         return shared_body([net = DepthNet(random_depth_net(4)), in = waves({1, 256, 256, 3})](
                                View out, Space space) { net.forward(in, out, space); });
       }},
      {"encode",
       {1, 16, 8, 8},
       [] {
         return shared_body(
             [net = Autoencoder(random_autoencoder(16, 8, 4, 32)), in = waves({1, 128, 64, 3})](
                 View out, Space space) { net.encode(in, out, space); });
       }},
      {"decode",
       {1, 128, 64, 3},
       [] {
         return shared_body([net = Autoencoder(random_autoencoder(16, 8, 4, 32)),
                             codes = std::vector<std::int32_t>(16 * 8, 3)](View out, Space space) {
           net.decode(codes.data(), out, space);
         });
       }},
      {"pixel_cnn",
       {2, 8, 8, 20},
       [] {
         const std::vector<std::uint8_t> mask(9 * 64, 1);
         return shared_body([net = PixelCnn(random_pixel_cnn(8, 20)),
                             masks = LocalMasks{mask, mask, mask},
                             codes = std::vector<std::int32_t>(128, 3)](View out, Space space) {
           net.forward(codes.data(), masks, out, space);
         });
       }},
      {"refiner",
       {1, 64, 32, 3},
       [] {
         return shared_body([net = Refiner(random_refiner(8)), in = waves({1, 64, 32, 4}),
                             noise = std::vector<float>(320, 0.5f)](View out, Space space) {
           net.forward(in, noise.data(), out, space);
         });
       }},
      {"discriminator",
       {2, 1, 1, 1},
       [] {
         return shared_body(
             [net = Discriminator(random_discriminator(8)), in = waves({2, 64, 96, 3})](
                 View out, Space space) { net.score(in, out.data, space); });
       }},
      {"classifier",
       {1, 1, 1, 7},
       [] {
         return shared_body([net = Classifier(random_classifier(8, 7)), in = waves({1, 96, 64, 3})](
                                View out, Space space) { net.forward(in, out, space); });
       }},
      {"lpips",
       {2, 1, 1, 1},
       [] {
         return shared_body([net = Lpips(random_lpips(4)), a = waves({2, 64, 48, 3}),
                             b = nn::Tensor({2, 64, 48, 3})](View out, Space space) {
           net.distance(a, b, out.data, space);
         });
       }},
  };
}

class EveryForward : public testing::TestWithParam<Forward> {};

TEST_P(EveryForward, takes_no_memory_after_the_first) {
  const auto run = GetParam().make();
  const nn::Tensor out(GetParam().out);
  nn::Workspace workspace;
  set_threads(1);  // of several, one may have nothing to do in the first
  run(out, workspace);
  const std::size_t held = workspace.bytes();
  EXPECT_GT(held, 0u);
  const std::size_t before = taken;
  run(out, workspace);
  EXPECT_EQ(workspace.bytes(), held);
  EXPECT_LT(taken - before, 4096u) << "more than the closures of parallel loops";
  set_threads(0);
}

TEST_P(EveryForward, gives_the_same_bytes_again_whatever_the_threads_and_the_workspace_held) {
  const auto run = GetParam().make();
  const nn::Tensor first(GetParam().out), second(GetParam().out);
  nn::Workspace workspace;
  run(first, workspace);
  {  // what is left in the workspace must not matter
    const nn::Workspace::Scope scope(workspace);
    const std::size_t floats = workspace.bytes() / sizeof(float) / 2;
    std::fill_n(workspace.take(floats), floats, NAN);
  }
  for (const int count : {1, 2, 3}) {
    set_threads(count);
    run(second, workspace);
    const Difference d = difference(second, first);
    EXPECT_EQ(d.worst, 0) << count << " threads";
    EXPECT_GT(d.largest, 0) << "nothing was written";
  }
  set_threads(0);
}

INSTANTIATE_TEST_SUITE_P(networks, EveryForward, testing::ValuesIn(all_forwards()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace ps::models
