// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/processor.h"

#include "plumbline/base/random.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>

namespace plumbline {
namespace processor_test {

constexpr std::size_t kNumbers = 101;
struct Numbers {
  std::array<float, kNumbers> a, b, c;
  std::array<std::uint8_t, kNumbers> bytes;
};

// What fused multiply-add and another order of a sum would change.
struct Mixed {
  [[gnu::always_inline]] static inline int Run(const Numbers& in,
                                               std::array<float, kNumbers>& out) {
    int sum = 0;
    for (std::size_t i = 0; i < kNumbers; ++i) out[i] = in.a[i] * in.b[i] + in.c[i];
    for (std::size_t i = 0; i < kNumbers; ++i) sum += std::abs(in.bytes[i] - 100);
    return sum;
  }
};

TEST(Processor, AKernelGivesTheSameOnBothPaths) {
  Rng rng(1, "processor");
  Numbers in;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    in.a[i] = static_cast<float>(rng.Uniform(-3, 3));
    in.b[i] = static_cast<float>(rng.Uniform(-3, 3));
    in.c[i] = static_cast<float>(rng.Uniform(-3, 3));
    in.bytes[i] = static_cast<std::uint8_t>(rng.Index(256));
  }
  std::array<float, kNumbers> anywhere, best, avx2;
  const int sum = RunAnywhere<Mixed>(in, anywhere);
  EXPECT_EQ(RunBest<Mixed>(in, best), sum);
  EXPECT_EQ(best, anywhere);
  EXPECT_EQ(in.a[7] * in.b[7] + in.c[7], anywhere[7]);
  if (!HasAvx2()) GTEST_SKIP() << "a processor without AVX2";
  EXPECT_EQ(RunWithAvx2<Mixed>(in, avx2), sum);
  EXPECT_EQ(avx2, anywhere);
}

}  // namespace processor_test
}  // namespace plumbline
