// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_points.h"

#include "plumbline/base/processor.h"
#include "plumbline/features/grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <tuple>

namespace plumbline {
namespace {

struct Best {
  int index = -1;
  int distance = 257;
  int second = 257;
};

bool SimilarShape(const PointFeature& a, const PointFeature& b, const PointMatchOptions& options) {
  if (std::abs(a.octave - b.octave) > options.max_octave_step) return false;
  if (options.max_angle_deg <= 0) return true;
  const double difference = std::remainder(double{a.angle} - double{b.angle}, 2 * std::numbers::pi);
  return std::abs(difference) <= options.max_angle_deg * std::numbers::pi / 180;
}

// Descriptors word by word: the first words of all descriptors, then the second words, and so on.
class DescriptorWords {
 public:
  explicit DescriptorWords(const std::vector<PointFeature>& set)
      : count_(set.size()), words_(kWords * set.size()) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t k = 0; k < kWords; ++k) words_[k * count_ + i] = set[i].descriptor[k];
    }
  }

  std::size_t size() const { return count_; }
  const std::uint64_t* words(std::size_t k) const { return words_.data() + k * count_; }

 private:
  static constexpr std::size_t kWords = std::tuple_size_v<Descriptor>;
  std::size_t count_;
  std::vector<std::uint64_t> words_;
};

// Computes the Hamming distances of one descriptor from many, several at once. Bits are counted by
// adding neighbouring fields, as CountBits does.
struct DistancesFrom {
  [[gnu::always_inline]] static inline void Run(const Descriptor& query,
                                                const DescriptorWords& set,
                                                std::uint32_t* distances) {
    constexpr std::uint64_t kEverySecond = 0x5555555555555555, kPairs = 0x3333333333333333,
                            kNibbles = 0x0f0f0f0f0f0f0f0f, kBytes = 0x00ff00ff00ff00ff;
    const std::uint64_t* const words[] = {set.words(0), set.words(1), set.words(2), set.words(3)};
    const Descriptor own = query;
    ForBlocks<8>(
        static_cast<int>(set.size()), [&](int first, auto size) __attribute__((always_inline)) {
          std::uint32_t block[size];
          for (int i = 0; i < size; ++i) {
            std::uint64_t sums = 0;  // sum of the bits of each byte
            for (std::size_t k = 0; k < 4; ++k) {
              std::uint64_t word = words[k][first + i] ^ own[k];
              word -= word >> 1U & kEverySecond;
              word = (word & kPairs) + (word >> 2U & kPairs);
              sums += (word + (word >> 4U)) & kNibbles;
            }
            sums = (sums & kBytes) + (sums >> 8U & kBytes);
            sums += sums >> 32U;
            sums += sums >> 16U;
            block[i] = static_cast<std::uint32_t>(sums & 0xffffU);
          }
          std::memcpy(distances + first, block, sizeof block);
        });
  }
};

// Finds the best point for each query among all points of a set, or among those near it.
class CandidateSearch {
 public:
  CandidateSearch(const std::vector<PointFeature>& set, double radius)
      : set_(set), words_(radius > 0 ? std::vector<PointFeature>() : set) {
    distances_.resize(words_.size());
    if (radius <= 0 || set.empty()) return;
    std::vector<Eigen::Vector2d> positions;
    positions.reserve(set.size());
    Eigen::Vector2d extent = Eigen::Vector2d::Ones();
    for (const PointFeature& p : set) {
      positions.push_back(p.px);
      extent = extent.cwiseMax(p.px);
    }
    // Points moved by a motion of few matches may be anywhere. Those beyond this limit are in the
    // grid's last cells.
    constexpr double kLargest = 32768;
    extent = extent.cwiseMin(kLargest);
    const int cell = std::clamp(static_cast<int>(radius), 8, 256);
    grid_ = PointGrid(
        positions, static_cast<int>(extent.x()) + 1, static_cast<int>(extent.y()) + 1, cell);
  }

  Best Find(const PointFeature& query, const PointMatchOptions& options) {
    Best best;
    const auto offer = [&](int i, int distance) {
      if (distance < best.distance) {
        best.second = best.distance;
        best.distance = distance;
        best.index = i;
      } else {
        best.second = std::min(best.second, distance);
      }
    };
    if (options.radius_px > 0) {
      const auto place_of = [&](int i) -> const auto& {
        return set_[static_cast<std::size_t>(i)].px;
      };
      grid_.InWindow(query.px, Eigen::Vector2d::Constant(options.radius_px), place_of, &near_);
      for (const int i : near_) {
        const PointFeature& other = set_[static_cast<std::size_t>(i)];
        if (!SimilarShape(query, other, options)) continue;
        offer(i, HammingDistance(query.descriptor, other.descriptor));
      }
      return best;
    }
    RunBest<DistancesFrom>(query.descriptor, words_, distances_.data());
    for (std::size_t i = 0; i < distances_.size(); ++i) {
      const auto distance = static_cast<int>(distances_[i]);
      if (distance >= best.second || !SimilarShape(query, set_[i], options)) continue;
      offer(static_cast<int>(i), distance);
    }
    return best;
  }

 private:
  const std::vector<PointFeature>& set_;
  DescriptorWords words_;  // filled if all points are candidates
  std::vector<std::uint32_t> distances_;
  std::vector<int> near_;
  PointGrid grid_;
};

}  // namespace

std::vector<FeatureMatch> MatchPoints(const std::vector<PointFeature>& a,
                                      const std::vector<PointFeature>& b,
                                      const PointMatchOptions& options) {
  CandidateSearch in_b(b, options.radius_px);
  CandidateSearch in_a(a, options.radius_px);
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Best best = in_b.Find(a[i], options);
    if (best.index < 0 || best.distance > options.max_distance) continue;
    if (options.ratio < 1 && best.distance >= options.ratio * best.second) continue;
    const auto j = static_cast<std::size_t>(best.index);
    if (in_a.Find(b[j], options).index != static_cast<int>(i)) continue;
    matches.push_back({static_cast<int>(i), best.index, best.distance});
  }
  return matches;
}

}  // namespace plumbline
