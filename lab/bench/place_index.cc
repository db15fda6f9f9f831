// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Time and memory of an index of places as it grows: place_index [KEYFRAMES...]. The load is
// generated: a camera that passes landmarks, each of them seen by 20 keyframes in a row with a part
// of the bits the other way. Descriptors come in clumps, as those of images do. For each number of
// keyframes: time to add one and to make the index anew, time of a query for a place seen before
// and for one never seen, bytes, and how often the place seen before comes first.
#include "plumbline/loop_closing/place_index.h"

#include "plumbline/base/random.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::int64_t kSeenBy = 20;      // keyframes in a row that see a landmark
constexpr std::uint64_t kClumps = 20000;  // of descriptors
constexpr double kWithinClump = 0.25;     // bits that differ from the clump's
constexpr double kBetweenViews = 0.08;    // bits that differ from view to view

// Each bit is set with this probability, to a 16th.
std::uint64_t SparseBits(Rng& rng, double probability) {
  const auto sixteenths = static_cast<unsigned>(16 * probability + 0.5);
  std::uint64_t bits = 0;
  for (unsigned mask = 1; mask < 16; mask *= 2) {
    bits = (sixteenths & mask) != 0 ? bits | rng.Next() : bits & rng.Next();
  }
  return bits;
}

void Disturb(Rng& rng, double probability, Descriptor& descriptor) {
  for (std::uint64_t& word : descriptor) word ^= SparseBits(rng, probability);
}

Descriptor LandmarkDescriptor(std::string_view kind, std::uint64_t landmark) {
  Rng rng(1, kind, landmark);
  Rng clump(2, kind, rng.Index(kClumps));
  Descriptor descriptor{};
  for (std::uint64_t& word : descriptor) word = clump.Next();
  Disturb(rng, kWithinClump, descriptor);
  return descriptor;
}

// Features of keyframe `keyframe` of a walk; another `view` sees the same landmarks differently.
template <class Feature>
std::vector<Feature> FeaturesAt(std::string_view kind,
                                std::int64_t keyframe,
                                std::uint64_t view,
                                std::int64_t count) {
  std::vector<Feature> features;
  Rng rng(view, kind, static_cast<std::uint64_t>(keyframe));
  const std::int64_t first = keyframe * count / kSeenBy;  // a twentieth is new each time
  for (std::int64_t i = first; i < first + count; ++i) {
    Feature feature;
    feature.descriptor = LandmarkDescriptor(kind, static_cast<std::uint64_t>(i));
    feature.response = static_cast<decltype(feature.response)>(rng.Uniform(0, 65535));
    Disturb(rng, kBetweenViews, feature.descriptor);
    features.push_back(feature);
  }
  return features;
}

Features View(std::int64_t keyframe, std::uint64_t view) {
  Features features;
  features.points = FeaturesAt<PointFeature>("points", keyframe, view, PlaceIndex::kPoints);
  features.lines = FeaturesAt<LineFeature>("lines", keyframe, view, PlaceIndex::kLines);
  return features;
}

// CPU time of this thread.
template <class Work>
double Milliseconds(const Work& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

struct QueryFigures {
  double median_ms = 0;
  double worst_ms = 0;
  double right = 0;  // share of queries whose first candidate sees the place
  double score = 0;  // mean of the first
};

QueryFigures MeasureQueries(const PlaceIndex& index, std::int64_t first, std::int64_t last) {
  constexpr std::int64_t kQueries = 51;
  std::vector<double> times;
  QueryFigures figures;
  for (std::int64_t q = 0; q < kQueries; ++q) {
    const std::int64_t place = first + (last - first) * q / kQueries;
    const Features image = View(place, 99);
    std::vector<PlaceCandidate> found;
    times.push_back(
        Milliseconds([&] { found = index.Query(image, 5, [](KeyFrameId) { return true; }); }));
    if (found.empty()) continue;
    figures.right += std::abs(found[0].id.value - place) < kSeenBy / 2 ? 1.0 / kQueries : 0;
    figures.score += found[0].score / kQueries;
  }
  std::sort(times.begin(), times.end());
  figures.median_ms = times[times.size() / 2];
  figures.worst_ms = times.back();
  return figures;
}

void Grow(PlaceIndex& index, std::int64_t keyframes) {
  double adding = 0;
  const auto before = static_cast<std::int64_t>(index.size());
  for (std::int64_t k = before; k < keyframes; ++k) {
    const Features features = View(k, 1);
    adding += Milliseconds([&] { index.Add(KeyFrameId{k}, features); });
  }
  const QueryFigures known = MeasureQueries(index, 0, keyframes);
  const QueryFigures unknown = MeasureQueries(index, 10'000'000, 10'100'000);
  fmt::print(
      "{:7} keyframes: add {:.3f} ms; query, known place {:.2f} ms (worst {:.2f}), first right "
      "{:.0f} %, score {:.3f}; unknown {:.2f} ms (worst {:.2f}), score {:.4f}; {:.1f} kB a "
      "keyframe\n",
      keyframes,
      adding / static_cast<double>(keyframes - before),
      known.median_ms,
      known.worst_ms,
      100 * known.right,
      known.score,
      unknown.median_ms,
      unknown.worst_ms,
      unknown.score,
      static_cast<double>(index.Memory()) / 1000 / static_cast<double>(index.size()));
}

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  std::vector<std::int64_t> sizes;
  for (int i = 1; i < count; ++i) sizes.push_back(std::max(1, std::atoi(arguments[i])));
  if (sizes.empty()) sizes = {1'000, 10'000, 100'000};
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  plumbline::PlaceIndex index;
  for (const std::int64_t size : sizes) plumbline::Grow(index, size);
  return 0;
}
