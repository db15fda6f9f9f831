// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace plumbline {

// Returns the number of samples, at most `most`, needed to draw one of inliers alone.
inline int SamplesNeeded(double inlier_ratio, int sample_size, int most) {
  constexpr double kConfidence = 0.999;  // probability of drawing a sample of inliers
  const double good = math::Pow(std::clamp(inlier_ratio, 0.0, 1.0), sample_size);
  if (good >= 1) return 1;
  if (good <= 1e-12) return most;
  const double needed = math::Log(1 - kConfidence) / math::Log1p(-good);
  return static_cast<int>(std::clamp(std::ceil(needed), 1.0, static_cast<double>(most)));
}

// Returns `count` different indices below `size`, which must be at least `count`.
template <std::size_t kCount>
std::array<std::size_t, kCount> DrawSample(std::size_t size, Rng& rng) {
  std::array<std::size_t, kCount> sample;
  for (std::size_t i = 0; i < kCount;) {
    sample[i] = rng.Index(size);
    const auto drawn = sample.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(sample.begin(), drawn, sample[i]) == drawn) ++i;
  }
  return sample;
}

template <class Model>
struct ScoredModel {
  Model model;
  double cost = 0;
};

// LO-RANSAC (Chum, Matas and Kittler 2003) with the truncated cost of MSAC (Torr and Zisserman
// 2000). It tries models of random samples. Every new best model is improved from all data, and the
// number of samples adapts to its inliers. The computation of a cost stops as soon as it exceeds
// the limit that matters.
//
// `Problem` provides
//   using Model = ...;
//   static constexpr std::size_t kSampleSize;
//   std::size_t size() const;
//   std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const;
//   double Cost(const Model&, double limit) const;  // any number above limit once above it
//   double InlierRatio(const Model&) const;
//   Model Improve(const Model&) const;              // from all data, near the model
//   bool Same(const Model&, const Model&) const;    // for `keep`
//
// The result is the best model, then those models whose cost is within `keep` times its cost and
// that differ from every better one. `guesses` are tried before any sample.
template <class Problem>
class Ransac {
 public:
  using Model = typename Problem::Model;
  using Scored = ScoredModel<Model>;

  Ransac(const Problem& problem, int most_samples, double keep)
      : problem_(problem), most_samples_(most_samples), keep_(keep) {}

  std::vector<Scored> Run(std::span<const Model> guesses, Rng& rng) {
    for (const Model& guess : guesses) Consider(guess);
    if (problem_.size() < Problem::kSampleSize) return Best();
    int needed = Needed();
    for (int i = 0; i < needed; ++i) {
      const auto sample = DrawSample<Problem::kSampleSize>(problem_.size(), rng);
      for (const Model& model : problem_.Solve(sample)) {
        if (Consider(model)) needed = Needed();
      }
    }
    return Best();
  }

 private:
  static constexpr std::size_t kMostKept = 4;

  int Needed() const {
    if (kept_.empty()) return most_samples_;
    const double ratio = problem_.InlierRatio(kept_.front().model);
    return SamplesNeeded(ratio, static_cast<int>(Problem::kSampleSize), most_samples_);
  }

  double Limit() const {
    return kept_.empty() ? std::numeric_limits<double>::infinity() : keep_ * kept_.front().cost;
  }

  // Tries a model. Returns true if it is the new best.
  bool Consider(const Model& model) {
    const double cost = problem_.Cost(model, Limit());
    if (!(cost < Limit())) return false;
    const bool best = kept_.empty() || cost < kept_.front().cost;
    if (!best) {
      Keep({model, cost});
      return false;
    }
    Scored improved{problem_.Improve(model), 0};
    improved.cost = problem_.Cost(improved.model, cost);
    Keep(improved.cost < cost ? std::move(improved) : Scored{model, cost});
    return true;
  }

  // Keeps a model in the order of cost; of equivalent models (Problem::Same) only the best stays.
  void Keep(Scored scored) {
    for (const Scored& other : kept_) {
      if (other.cost <= scored.cost && problem_.Same(other.model, scored.model)) return;
    }
    std::erase_if(kept_, [&](const Scored& other) {
      return other.cost > scored.cost && problem_.Same(other.model, scored.model);
    });
    const auto place =
        std::upper_bound(kept_.begin(), kept_.end(), scored, [](const Scored& a, const Scored& b) {
          return a.cost < b.cost;
        });
    kept_.insert(place, std::move(scored));
    if (kept_.size() > kMostKept) kept_.pop_back();
  }

  std::vector<Scored> Best() {
    std::erase_if(kept_, [limit = Limit()](const Scored& s) { return s.cost > limit; });
    return std::move(kept_);
  }

  const Problem& problem_;
  int most_samples_;
  double keep_;
  std::vector<Scored> kept_;
};

}  // namespace plumbline
