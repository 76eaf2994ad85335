// SPDX-License-Identifier: BSD-3-Clause
// Rooms a second and images a second on one core, at 256x256.
#include <benchmark/benchmark.h>

#include "libps/rooms/camera_effects.h"
#include "libps/rooms/shot.h"

namespace rooms = ps::rooms;

namespace {

constexpr int kRooms = 16;

const std::vector<rooms::Room>& some_rooms() {
  static const std::vector<rooms::Room> all = [] {
    std::vector<rooms::Room> v;
    for (int i = 0; i < kRooms; ++i) v.emplace_back(i);
    return v;
  }();
  return all;
}

const std::vector<rooms::Camera>& some_cameras() {
  static const std::vector<rooms::Camera> all = [] {
    std::vector<rooms::Camera> v;
    for (int i = 0; i < kRooms; ++i) v.push_back(rooms::random_camera(some_rooms()[i], i));
    return v;
  }();
  return all;
}

void make_room(benchmark::State& state) {
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(rooms::Room(seed++ % kRooms));
  state.SetItemsProcessed(state.iterations());
}

void find_camera(benchmark::State& state) {
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rooms::random_camera(some_rooms()[seed % kRooms], seed));
    ++seed;
  }
  state.SetItemsProcessed(state.iterations());
}

void shoot(benchmark::State& state) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rooms::shoot(some_rooms()[i % kRooms], some_cameras()[i % kRooms]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}

void shoot_depth(benchmark::State& state) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        rooms::shoot_depth(some_rooms()[i % kRooms], some_cameras()[i % kRooms]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}

void degrade(benchmark::State& state) {
  rooms::Shot shot = rooms::shoot(some_rooms()[0], some_cameras()[0]);
  std::uint64_t seed = 0;
  for (auto _ : state) rooms::degrade(shot, seed++);
  state.SetItemsProcessed(state.iterations());
}

/// What a trainer asks for: a room, four views of it, each degraded.
void training_images(benchmark::State& state) {
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const rooms::Room room(seed % kRooms);
    for (int k = 0; k < 4; ++k) {
      rooms::Shot shot = rooms::shoot(room, rooms::random_camera(room, 4 * seed + k));
      rooms::degrade(shot, 4 * seed + k);
      benchmark::DoNotOptimize(shot);
    }
    ++seed;
  }
  state.SetItemsProcessed(4 * state.iterations());
}

}  // namespace

// Each measurement goes over all rooms.
BENCHMARK(make_room)->Iterations(2 * kRooms)->Unit(benchmark::kMillisecond);
BENCHMARK(find_camera)->Iterations(8 * kRooms)->Unit(benchmark::kMillisecond);
BENCHMARK(shoot)->Iterations(4 * kRooms)->Unit(benchmark::kMillisecond);
BENCHMARK(shoot_depth)->Iterations(8 * kRooms)->Unit(benchmark::kMillisecond);
BENCHMARK(degrade)->Iterations(4 * kRooms)->Unit(benchmark::kMillisecond);
BENCHMARK(training_images)->Iterations(2 * kRooms)->Unit(benchmark::kMillisecond);

int main(int argc, char** argv) {
  some_cameras();  // not to be measured
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
