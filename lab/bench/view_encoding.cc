// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Cost of displaying a large map: a made-up map of 300,000 points and 20,000 lines, some of which
// change between updates, as by local adjustment.
//
//   view_encoding
//
// Prints a Markdown table: processor time of comparing the map (in the mapping thread), of taking
// over the changes and of encoding them (in the viewer's), and the bytes of an update. Results:
// docs/benchmarks.md.
#include "plumbline/base/random.h"
#include "plumbline/viewer/map_comparison.h"
#include "plumbline/viewer/viewed_map.h"

#include <cstdio>
#include <ctime>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr int kKeyFrames = 300, kPointsEach = 1000, kLinesEach = 67;
constexpr int kLooks = 20;

double ProcessorMs() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Keyframes in a row, each with landmarks of its own around it.
Atlas MakeLargeMap() {
  Rng rng(1, "view_encoding");
  Atlas atlas;
  Map& map = atlas.Start();
  Features features;
  features.points.resize(kPointsEach);
  features.point_disparity.resize(kPointsEach);
  features.lines.resize(kLinesEach);
  features.line_right.resize(kLinesEach);
  const RectifiedCamera camera{400, 400, 320, 240, 0.1, 640, 480};
  const auto indexed = IndexFeatures(camera, std::move(features));
  for (int k = 0; k < kKeyFrames; ++k) {
    const KeyFrameId id = map.NextKeyFrameId();
    KeyFrame keyframe;
    keyframe.id = id;
    keyframe.frame.id = FrameId{k};
    keyframe.frame.indexed = indexed;
    keyframe.frame.points.resize(kPointsEach);
    keyframe.frame.lines.resize(kLinesEach);
    keyframe.frame.cam_from_world.translation.x() = -0.3 * k;
    MapEdit edit = {edit::AddKeyFrame{keyframe}};
    const auto place = [&] {
      return Eigen::Vector3d(0.3 * k + rng.Uniform(-4, 4), rng.Uniform(-2, 2), rng.Uniform(2, 10));
    };
    for (int i = 0; i < kPointsEach; ++i) {
      MapPoint point;
      point.id = PointId{std::int64_t{k} * kPointsEach + i};
      point.position = place();
      point.created_by = id;
      point.observations.emplace(id, i);
      edit.push_back(edit::AddPoint{std::move(point)});
    }
    for (int i = 0; i < kLinesEach; ++i) {
      MapLine line;
      line.id = LineId{std::int64_t{k} * kLinesEach + i};
      line.line = LineThroughPoints(place(), place());
      line.end = 1;
      line.created_by = id;
      line.observations.emplace(id, i);
      edit.push_back(edit::AddLine{std::move(line)});
    }
    map.Apply(edit);
  }
  return atlas;
}

// The first of the landmarks move, by more than anybody overlooks.
void MoveSome(Map& map, int points) {
  MapEdit edit;
  for (auto it = map.points().rbegin(); points-- > 0 && it != map.points().rend(); ++it) {
    edit.push_back(edit::MovePoint{it->first, it->second.position + Eigen::Vector3d(0.1, 0, 0)});
  }
  map.Apply(edit);
}

struct Cost {
  double compare = 0, take = 0, encode = 0;  // ms
  double bytes = 0;
};

Cost LookOnce(MapComparison& comparison, ViewedMap& viewed, const Atlas& atlas) {
  const std::uint64_t before = viewed.version();
  const double start = ProcessorMs();
  const MapChanges changes = comparison.Compare(atlas);
  const double compared = ProcessorMs();
  viewed.Take(changes);
  const double taken = ProcessorMs();
  const std::size_t bytes = viewed.DeltaSince(before).bytes().size();
  return {compared - start, taken - compared, ProcessorMs() - taken, static_cast<double>(bytes)};
}

void Print(const char* what, const Cost& cost) {
  std::fputs(fmt::format("| {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} |\n",
                         what,
                         cost.compare,
                         cost.take,
                         cost.encode,
                         cost.bytes)
                 .c_str(),
             stdout);
}

void Run() {
  Atlas atlas = MakeLargeMap();
  MapComparison comparison(SessionId{0});
  ViewedMap viewed;
  std::puts("| update | compare [ms] | take [ms] | encode [ms] | bytes |\n|---|---|---|---|---|");
  Print("everything", LookOnce(comparison, viewed, atlas));
  while (comparison.HasMore()) LookOnce(comparison, viewed, atlas);
  for (const int points : {0, 1000, 5000, kKeyFrames * kPointsEach}) {
    Cost mean;
    for (int i = 0; i < kLooks; ++i) {
      MoveSome(atlas.active(), points);
      const Cost cost = LookOnce(comparison, viewed, atlas);
      mean.compare += cost.compare / kLooks;
      mean.take += cost.take / kLooks;
      mean.encode += cost.encode / kLooks;
      mean.bytes += cost.bytes / kLooks;
    }
    Print(fmt::format("{} points moved", points).c_str(), mean);
  }
}

}  // namespace
}  // namespace plumbline

int main() {
  plumbline::Run();
  return 0;
}
