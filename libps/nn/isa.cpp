// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/isa.h"

#include <algorithm>
#include <atomic>

#include "libps/core/error.h"
#include "libps/nn/kernels/kernels.h"

namespace ps::nn {
namespace {

bool can_run(Isa isa) {
  if (isa == Isa::baseline) return true;
#ifdef PS_X86_KERNELS
  if (isa == Isa::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#else
  return false;
#endif
}

std::atomic<Isa>& chosen() {
  static std::atomic<Isa> isa{available_isas().back()};
  return isa;
}

}  // namespace

std::vector<Isa> available_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::baseline, Isa::avx2, Isa::avx512}) {
    if (can_run(isa)) isas.push_back(isa);
  }
  return isas;
}

Isa isa() { return chosen(); }

void set_isa(Isa isa) {
  if (!can_run(isa)) throw Error("instruction set", to_string(isa), "one that this machine has");
  chosen() = isa;
}

std::string to_string(Isa isa) {
  return isa == Isa::baseline ? "baseline" : isa == Isa::avx2 ? "avx2" : "avx512";
}

const Kernels& kernels() {
#ifdef PS_X86_KERNELS
  if (isa() == Isa::avx512) return kernels_avx512();
  if (isa() == Isa::avx2) return kernels_avx2();
#endif
  return kernels_baseline();
}

}  // namespace ps::nn
