// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline {

// A stream of random numbers that depends on (seed, name, index) only. Each use makes its own,
// Rng(options.seed, "two_view", frame), so that a new draw in one place changes no other.
//
// The generator is xoshiro256** (Blackman and Vigna 2018), with its state filled by splitmix64. The
// distributions are our own, since those of the standard library differ from one implementation to
// another.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::string_view stream = {}, std::uint64_t index = 0) {
    std::uint64_t name_hash = 0xcbf29ce484222325U;  // FNV-1a
    for (const char c : stream) {
      name_hash = (name_hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    }
    std::uint64_t mix = seed;
    mix = SplitMix(mix) ^ name_hash;
    mix = SplitMix(mix) ^ index;
    for (std::uint64_t& word : state_) word = SplitMix(mix);
  }

  // Returns a number uniform in all 2^64 values.
  std::uint64_t Next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  // Returns a number uniform in [0, 1), with 53 bits.
  double Uniform() { return static_cast<double>(Next() >> 11U) * 0x1p-53; }
  // Returns a number uniform in [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  // Returns a number uniform in {0, ..., count - 1}, without bias. count > 0.
  std::size_t Index(std::size_t count) {
    PLUMBLINE_CHECK(count > 0, "an index into nothing");
    // The lowest 2^64 mod count values are drawn again.
    const std::uint64_t reject = (0 - static_cast<std::uint64_t>(count)) % count;
    std::uint64_t value = Next();
    while (value < reject) value = Next();
    return static_cast<std::size_t>(value % count);
  }

  // Returns a normal number with mean 0 and the given standard deviation (Box-Muller, one of the
  // two values).
  double Normal(double sigma = 1) {
    const double radius = std::sqrt(-2 * math::Log(1 - Uniform()));
    return sigma * radius * math::Cos(2 * std::numbers::pi * Uniform());
  }

  // Shuffles the values, every order equally likely (Fisher-Yates).
  template <class T>
  void Shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[Index(i)]);
  }

 private:
  static std::uint64_t SplitMix(std::uint64_t& state) {
    state += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  std::array<std::uint64_t, 4> state_{};
};

}  // namespace plumbline
