// SPDX-License-Identifier: BSD-3-Clause
// Internal to the rooms room: which build of a kernel this machine runs.
#pragma once

namespace ps::rooms {

enum class Isa { baseline, avx2, avx512 };

/// @return the widest that this machine has and the kernels are built for
inline Isa find_isa() {
#ifdef PS_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    return Isa::avx512;
  }
  if (__builtin_cpu_supports("avx2")) return Isa::avx2;
#endif
  return Isa::baseline;
}

inline Isa isa() {
  static const Isa found = find_isa();
  return found;
}

}  // namespace ps::rooms

/// The build of kernel `name` that suits this machine.
#ifdef PS_X86_KERNELS
#define PS_FITTING(name)                                      \
  (ps::rooms::isa() == ps::rooms::Isa::avx512 ? name##_avx512 \
   : ps::rooms::isa() == ps::rooms::Isa::avx2 ? name##_avx2   \
                                              : name##_baseline)
#else
#define PS_FITTING(name) name##_baseline
#endif
