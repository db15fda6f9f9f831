// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_mapper.h"

#include "tests/mapping/vertical_lines.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace torn_window_test {

constexpr int kKeyFrames = 10;
constexpr double kFall = 0.6;     // metres along the lines
constexpr std::size_t kFell = 4;  // points

bool IsNew(KeyFrameId id) { return id.value >= kKeyFrames - 3; }

std::vector<Rigid3> TruePoses() {
  std::vector<Rigid3> poses;
  for (int k = 0; k < kKeyFrames; ++k) poses.push_back(PoseOnPath(8 * k));
  return poses;
}

// Points of even index are landmarks of the old keyframes, those of odd index of the new ones: each
// part has enough of its own. The vertical lines tie one to the other, and kFell landmarks, which
// are in the new keyframes where something has fallen to.
TrueMap MapThatVerticalLinesTie(SyntheticWorld& world) {
  for (std::size_t i = 0; i < kFell; ++i) {
    const Eigen::Vector3d& before = world.points[2 * i].position;
    world.points[2 * i + 1].position = before + Eigen::Vector3d(0, kFall, 0);
  }
  TrueMap scene = MakeTrueMap(world, TruePoses(), {.noise = 0.1, .missed = 0});
  MapEdit edit;
  for (const auto& [index, id] : scene.point_of) {
    const bool of_new = index % 2 == 1;
    for (const auto& [keyframe, feature] : scene.map.Find(id)->observations) {
      const bool fell = of_new && index < 2 * kFell;
      if (IsNew(keyframe) == of_new && !fell) continue;
      edit.push_back(edit::RemovePointObservation{id, keyframe});
      if (IsNew(keyframe) && fell) {
        edit.push_back(edit::AddPointObservation{scene.point_of.at(index - 1), keyframe, feature});
      }
    }
  }
  scene.map.Apply(edit);
  return scene;
}

MapEdit EditThatMakes(const Map& map) {
  MapEdit edit;
  for (const auto& [id, keyframe] : map.keyframes()) edit.push_back(edit::AddKeyFrame{keyframe});
  for (const auto& [id, point] : map.points()) edit.push_back(edit::AddPoint{point});
  for (const auto& [id, line] : map.lines()) edit.push_back(edit::AddLine{line});
  return edit;
}

// How far the mapper moves a new keyframe at most.
double LargestSlide(double max_correction) {
  SyntheticWorld world = WorldOfVerticalLines(150, 100);
  const TrueMap scene = MapThatVerticalLinesTie(world);
  MappingOptions options;
  options.window.max_correction = max_correction;
  LocalMapper mapper(world.Imaging(), {}, options);
  Map map;
  mapper.Start(map, EditThatMakes(scene.map), KeyFrameId{kKeyFrames - 1});
  map.CheckInvariants();
  double largest = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Rigid3& before = scene.map.Find(id)->frame.cam_from_world;
    if (IsNew(id)) {
      largest = std::max(largest, CentreDistance(keyframe.frame.cam_from_world, before));
    }
  }
  return largest;
}

TEST(LocalMapper, DoesNotTearNewKeyFramesOffAlongParallelLines) {
  constexpr double kNoLimit = 10;
  EXPECT_LT(LargestSlide(MappingOptions{}.window.max_correction), 0.01);
  EXPECT_GT(LargestSlide(kNoLimit), 0.9 * kFall) << "nothing pulls here";
}

}  // namespace torn_window_test
}  // namespace plumbline
