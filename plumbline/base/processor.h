// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>

#if defined(__x86_64__)
#if defined(__clang__)
// NOLINTNEXTLINE(bugprone-reserved-identifier)
#define _Bool bool  // glibc's header has C's name, which GCC alone knows in C++
#include <sys/platform/x86.h>
#undef _Bool
#else
#include <sys/platform/x86.h>
#endif
#define PLUMBLINE_TARGET_AVX2 [[gnu::target("avx2,popcnt")]]
#else
#define PLUMBLINE_TARGET_AVX2
#endif

namespace plumbline {

// Returns true if the processor has AVX2 and POPCNT and the C library reports them:
// GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2 hides them here as it does in the library.
inline bool HasAvx2() {
#if defined(__x86_64__)
  static const bool kHas = CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(POPCNT);
  return kHas;
#else
  return false;
#endif
}

// Calls Kernel::Run, compiled for every processor of the architecture.
template <class Kernel, class... Arguments>
auto RunAnywhere(Arguments&&... arguments) {
  return Kernel::Run(std::forward<Arguments>(arguments)...);
}

// Calls Kernel::Run, compiled for AVX2 without fused multiply-add. The same operations in the same
// order round in the same way, so that the bytes equal those of RunAnywhere. Requires HasAvx2().
template <class Kernel, class... Arguments>
PLUMBLINE_TARGET_AVX2 auto RunWithAvx2(Arguments&&... arguments) {
  return Kernel::Run(std::forward<Arguments>(arguments)...);
}

// Calls Kernel::Run in the version that is fastest on this processor. Run must be a static function
// of plain loops that is always inlined ([[gnu::always_inline]] inline); functions that it calls
// are compiled for AVX2, too, if they are inlined. Cost beyond the kernel's: a branch.
template <class Kernel, class... Arguments>
auto RunBest(Arguments&&... arguments) {
  return HasAvx2() ? RunWithAvx2<Kernel>(std::forward<Arguments>(arguments)...)
                   : RunAnywhere<Kernel>(std::forward<Arguments>(arguments)...);
}

// Calls block(first, size) so that 0 to count - 1 are covered. `size` is a constant, kBlock, and
// the last block overlaps the one before if count is no multiple of it; if count < kBlock, all
// blocks have size 1. It is for kernels whose remainder after the last whole vector would take as
// long as all the vectors. A block must not write what another block reads.
template <int kBlock, class Block>
[[gnu::always_inline]] inline void ForBlocks(int count, const Block& block) {
  if (count < kBlock) {
    for (int i = 0; i < count; ++i) block(i, std::integral_constant<int, 1>{});
    return;
  }
  for (int i = 0; i + kBlock <= count; i += kBlock) {
    block(i, std::integral_constant<int, kBlock>{});
  }
  if (count % kBlock != 0) block(count - kBlock, std::integral_constant<int, kBlock>{});
}

}  // namespace plumbline
