// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/tracker.h"

#include "tests/support/true_map.h"
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace rival_poses_test {

constexpr double kStep = 0.5;  // metres
const SensorModel kExact{.noise = 0, .flipped_bits = 0, .missed = 0};

// What one of two poses is found with.
struct Shown {
  int of_map = 0;
  int made_on_the_spot = 0;  // from the first frame
  int All() const { return of_map + made_on_the_spot; }
};

// The second frame of a map: the camera has moved to the right past a scene, with a load that it
// carries. From the prediction, which knows of no motion, the load is found alone. By appearance
// the scene is, since the pieces of the load look alike, two by two.
class SceneAndLoad {
 public:
  SceneAndLoad(const Shown& scene, const Shown& load) : scene_(scene.All()) {
    Add(scene, 0);
    Add(load, 15);
    for (int i = 0; i < load.All(); ++i) {
      world_.points[Index(scene_ + i)].descriptor =
          world_.points[Index(scene_ + i % (load.All() / 2))].descriptor;
    }
  }

  TrackingResult Track(TrackingReference reference) const {
    Rng rng(1);
    TrueMap first = MakeTrueMap(world_, {Rigid3{}}, kExact);
    MapEdit edit;
    for (const std::size_t index : not_in_map_) {
      edit.push_back(edit::RemovePoint{first.point_of.at(index)});
    }
    first.map.Apply(edit);
    SyntheticWorld today = world_;
    for (std::size_t i = Index(scene_); i < today.points.size(); ++i) {
      today.points[i].position = Inverse(Moved()) * today.points[i].position;
    }
    TrackingOptions options;
    options.reference = reference;
    Tracker tracker(world_.Imaging(), options, {world_.camera, {}, {}}, Rigid3{});
    tracker.Track(FrameId{0}, 0, first.sensed.front().indexed, nullptr);
    const auto snapshot = TakeSnapshot(first.map, KeyFrameId{0}, 1);
    const SyntheticFrame second = Sense(today, Moved(), kExact, rng);
    return tracker.Track(FrameId{1}, 50'000'000, second.indexed, snapshot.get());
  }

 private:
  static Rigid3 Moved() { return {Eigen::Quaterniond::Identity(), {-kStep, 0, 0}}; }
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }

  // On a grid of the image that begins at `offset`, 3 to 5 m away.
  void Add(const Shown& shown, double offset) {
    Rng rng(4, "scene_and_load", world_.points.size());
    for (int i = 0; i < shown.All(); ++i) {
      const Eigen::Vector2d px(90 + offset + 40 * (i % 15), 40 + offset + 40 * (i / 15));
      const Eigen::Vector3d ray((px.x() - world_.camera.cx) / world_.camera.fx,
                                (px.y() - world_.camera.cy) / world_.camera.fy,
                                1);
      if (i >= shown.of_map) not_in_map_.push_back(world_.points.size());
      world_.points.push_back({rng.Uniform(3, 5) * ray, RandomDescriptor(rng)});
    }
  }

  SyntheticWorld world_;
  int scene_;
  std::vector<std::size_t> not_in_map_;
};

// Whether the pose by which the scene is found beats the one by which the load is, with all that
// there is for it.
bool SceneWins(const Shown& scene,
               const Shown& load,
               TrackingReference reference = TrackingReference::kLocalMap) {
  const TrackingResult result = SceneAndLoad(scene, load).Track(reference);
  if (!result.cam_from_world) {
    ADD_FAILURE() << "no pose";
    return false;
  }
  const double moved = CentreDistance(*result.cam_from_world, Rigid3{});
  const bool wins = moved > 0.5 * kStep;
  EXPECT_NEAR(moved, wins ? kStep : 0, 1e-4);
  EXPECT_EQ(result.counts.inlier_points, (wins ? scene : load).All());
  return wins;
}

TEST(Tracker, PrefersThePoseThatShowsMoreOfTheMap) {
  EXPECT_TRUE(SceneWins({41, 0}, {40, 30}));
  EXPECT_FALSE(SceneWins({40, 30}, {41, 0}));
  EXPECT_FALSE(SceneWins({40, 30}, {40, 0})) << "of equals, the predicted one";
}

TEST(Tracker, PrefersThePoseThatMoreThanTwiceAsManyMatchesAgreeWith) {
  EXPECT_FALSE(SceneWins({20, 60}, {40, 0}));
  EXPECT_TRUE(SceneWins({20, 61}, {40, 0}));
  EXPECT_TRUE(SceneWins({40, 0}, {20, 60}));
  EXPECT_FALSE(SceneWins({40, 0}, {20, 61}));
}

TEST(Tracker, PrefersThePoseThatMoreMatchesAgreeWithWhereThereIsNoMap) {
  EXPECT_TRUE(SceneWins({0, 41}, {0, 40}, TrackingReference::kLastFrame));
  EXPECT_FALSE(SceneWins({0, 40}, {0, 41}, TrackingReference::kLastFrame));
}

}  // namespace rival_poses_test
}  // namespace plumbline
