// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/geometry/se3.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace plumbline {

void PrintTo(const WorldEntry& entry, std::ostream* stream) { *stream << entry.name; }

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// What is promised of the path of a world: metres, seconds, metres per second, radians per second.
struct Promise {
  double least_length = 0, most_length = 1e3;
  double least_duration = 8, most_duration = 70;
  double most_speed = 1.5, most_turn = 1.4;
};

Promise PromiseOf(const std::string& world) {
  const std::map<std::string, Promise> promises = {
      {"lowtexture", {35, 70, 40, 80, 1.1, 1.0}},
      {"vicon_easy", {15, 35, 30, 70, 0.7, 0.8}},
      {"vicon_medium", {25, 60, 30, 60, 1.3, 1.3}},
      {"vicon_difficult", {40, 90, 30, 60, 2.3, 2.3}},
      {"office", {80, 130, 90, 130, 1.4, 1.3}},
      {"loop", {120, 180, 100, 200, 1.5, 1.3}},
      {"floors", {90, 140, 90, 150, 1.4, 1.3}},
      {"planar", {9, 15, 28, 35, 0.7, 0.5}},
      {"forward", {20, 24, 35, 40, 0.8, 0.3}},
      {"lateral", {20, 26, 30, 40, 0.9, 0.5}},
      {"rotation", {9, 13, 30, 42, 0.9, 1.1}},
      {"static", {0.01, 0.3, 30, 30, 0.05, 0.05}},
      {"lights", {27, 34, 38, 48, 1.1, 1.1}},
      {"dynamic", {20, 28, 38, 46, 0.9, 1.1}},
      {"wires", {22, 28, 34, 42, 1.1, 1.2}},
      {"degenerate", {24, 28, 36, 42, 0.9, 0.3}},
      {"town", {740, 860, 75, 110, 11, 1.1}},
  };
  const auto found = promises.find(world);
  return found == promises.end() ? Promise{} : found->second;
}

const World& Made(const WorldEntry& entry, std::uint64_t seed) {
  static std::map<std::pair<std::string, std::uint64_t>, World> made;
  const auto key = std::make_pair(std::string(entry.name), seed);
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  return made.emplace(key, entry.make(seed)).first->second;
}

// The surface in the world at a time.
Surface InWorld(const Scene& scene, const Surface& surface, double time) {
  if (!surface.body) return surface;
  const Rigid3 pose = scene.bodies[static_cast<std::size_t>(*surface.body)].world_from_body(time);
  Surface moved = surface;
  moved.origin = pose * surface.origin;
  moved.side_u = pose.rotation * surface.side_u;
  moved.side_v = pose.rotation * surface.side_v;
  return moved;
}

// How far along start -> start + way the surface is hit, where it is.
std::optional<double> Hit(const Surface& surface, const Vector3d& start, const Vector3d& way) {
  const Vector3d normal = surface.side_u.cross(surface.side_v);
  const double slope = normal.dot(way);
  if (slope == 0) return std::nullopt;
  const double share = normal.dot(surface.origin - start) / slope;
  if (share < 0) return std::nullopt;
  const Vector3d offset = start + share * way - surface.origin;
  const double a = offset.dot(surface.side_u) / surface.side_u.squaredNorm();
  const double b = offset.dot(surface.side_v) / surface.side_v.squaredNorm();
  if (a < 0 || a > 1 || b < 0 || b > 1) return std::nullopt;
  return share;
}

// The sphere around a surface: what is not near it need not be looked at closely.
struct Ball {
  Vector3d middle;
  double radius;

  explicit Ball(const Surface& surface)
      : middle(surface.PointAt(0.5, 0.5)),
        radius(0.5 * std::sqrt(surface.side_u.squaredNorm() + surface.side_v.squaredNorm())) {}
  bool IsWithin(const Vector3d& point, double reach) const {
    return (middle - point).squaredNorm() < (radius + reach) * (radius + reach);
  }
};

std::vector<Ball> BallsOf(const Scene& scene) {
  return {scene.surfaces.begin(), scene.surfaces.end()};
}

class EveryWorld : public testing::TestWithParam<WorldEntry> {
 protected:
  const World& Get(std::uint64_t seed = 1) const { return Made(GetParam(), seed); }
};

TEST_P(EveryWorld, PathKeepsAwayFromEverything) {
  constexpr double kStep = 0.05, kClosest = 0.25;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World& world = Get(seed);
    const std::vector<Ball> balls = BallsOf(world.scene);
    std::optional<Vector3d> last;
    for (double time = 0; time <= world.path.duration; time += kStep) {
      const Vector3d here = world.path.world_from_camera(time).translation;
      for (std::size_t i = 0; i < world.scene.surfaces.size(); ++i) {
        const bool moves = world.scene.surfaces[i].body.has_value();
        if (!moves && !balls[i].IsWithin(here, 0.5)) continue;  // a step is shorter
        const Surface surface = InWorld(world.scene, world.scene.surfaces[i], time);
        ASSERT_GT(surface.DistanceTo(here), kClosest)
            << "seed " << seed << ", " << time << " s, surface " << i << " at "
            << surface.origin.transpose() << ", camera at " << here.transpose();
        if (!last) continue;
        const std::optional<double> hit = Hit(surface, *last, here - *last);
        ASSERT_TRUE(!hit || *hit > 1) << "through surface " << i << " at " << time << " s";
      }
      last = here;
    }
  }
}

TEST_P(EveryWorld, PathIsSmooth) {
  constexpr double kStep = 3e-3;
  const Promise promise = PromiseOf(GetParam().name);
  const CameraPath& path = Get().path;
  Rigid3 a = path.world_from_camera(0);
  std::optional<Vector6d> last;
  for (double time = kStep; time <= path.duration; time += kStep) {
    const Rigid3 b = path.world_from_camera(time);
    const Vector6d velocity = LogSe3(Inverse(a) * b) / kStep;
    ASSERT_LT(velocity.tail<3>().norm(), promise.most_speed) << time;
    ASSERT_LT(velocity.head<3>().norm(), promise.most_turn) << time;
    // A jump of velocity would show as one of v / kStep: hundreds.
    if (last) {
      ASSERT_LT((velocity - *last).norm() / kStep, 60) << time;
    }
    last = velocity;
    a = b;
  }
}

TEST_P(EveryWorld, PathIsAsLongAsPromised) {
  constexpr double kStep = 0.05;
  const Promise promise = PromiseOf(GetParam().name);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CameraPath& path = Get(seed).path;
    double length = 0;
    for (double time = kStep; time <= path.duration; time += kStep) {
      length += (path.world_from_camera(time).translation -
                 path.world_from_camera(time - kStep).translation)
                    .norm();
    }
    EXPECT_GE(length, promise.least_length);
    EXPECT_LE(length, promise.most_length);
    EXPECT_GE(path.duration, promise.least_duration);
    EXPECT_LE(path.duration, promise.most_duration);
  }
}

bool IsUnderTheSky(const WorldEntry& entry) { return entry.name == std::string("town"); }

// Nowhere the camera can look is there nothing, but over the horizon of those under the sky.
TEST_P(EveryWorld, IsClosedAllAround) {
  const World& world = Get();
  for (int i = 0; i < 400; ++i) {
    const double time = world.path.duration * i / 400;
    const Rigid3 pose = world.path.world_from_camera(time);
    // Spread over the field of view by two irrational steps.
    const double u = std::fmod(0.5 + i * std::numbers::phi, 1.0);
    const double v = std::fmod(0.5 + i * std::numbers::sqrt2, 1.0);
    const Vector3d way = pose.rotation * Vector3d(1.9 * (u - 0.5), 1.2 * (v - 0.5), 1);
    if (IsUnderTheSky(GetParam()) && way.z() > -0.02 * way.norm()) continue;
    const bool hit = std::any_of(
        world.scene.surfaces.begin(), world.scene.surfaces.end(), [&](const Surface& surface) {
          return Hit(InWorld(world.scene, surface, time), pose.translation, way).has_value();
        });
    ASSERT_TRUE(hit) << time << " s, from " << pose.translation.transpose() << " towards "
                     << way.transpose();
  }
}

TEST_P(EveryWorld, SurfacesAreRectangles) {
  const Scene& scene = Get().scene;
  EXPECT_LE(scene.surfaces.size(), 14000U);
  for (const Surface& surface : scene.surfaces) {
    const double u = surface.side_u.norm(), v = surface.side_v.norm();
    EXPECT_GT(std::min(u, v), 1e-3) << surface.origin.transpose();
    EXPECT_LT(std::abs(surface.side_u.dot(surface.side_v)), 1e-9 * u * v);
    EXPECT_GE(surface.texture.tone, 0);
    EXPECT_LE(surface.texture.tone, 1);
  }
  for (const Segment3& edge : scene.edges) EXPECT_GT((edge.end - edge.start).norm(), 1e-3);
  for (const Lamp& lamp : scene.lamps) EXPECT_GE(lamp.power, 0);
}

// Every edge runs along the rim of some surface, wholly or in part.
TEST_P(EveryWorld, EdgesLieOnRims) {
  const Scene& scene = Get().scene;
  const auto on_rim = [](const Surface& surface, const Vector3d& point) {
    if (surface.DistanceTo(point) > 1e-6) return false;
    const Vector3d offset = point - surface.origin;
    const double u = surface.side_u.norm(), v = surface.side_v.norm();
    const double a = offset.dot(surface.side_u) / u, b = offset.dot(surface.side_v) / v;
    return std::min({a, u - a, b, v - b}) < 1e-6;
  };
  const std::vector<Ball> balls = BallsOf(scene);
  for (std::size_t i = 0; i < scene.edges.size(); ++i) {
    const Vector3d middle = 0.5 * (scene.edges[i].start + scene.edges[i].end);
    bool found = false;
    for (std::size_t k = 0; k < scene.surfaces.size() && !found; ++k) {
      found = balls[k].IsWithin(middle, 1e-6) && on_rim(scene.surfaces[k], middle);
    }
    EXPECT_TRUE(found) << "edge " << i << " at " << middle.transpose();
  }
}

// Middle of what two parallel surfaces share where they lie in one plane.
std::optional<Vector3d> SharedPlace(const Surface& one,
                                    const Surface& other,
                                    const Vector3d& normal) {
  constexpr double kApart = 0.0015, kLeast = 0.002;
  if (std::abs(normal.dot(other.origin - one.origin)) > kApart) return std::nullopt;
  const Vector3d u = one.side_u.normalized(), v = one.side_v.normalized();
  // Only rectangles turned alike: others would have to be met by a far-fetched chance.
  const double turn = std::abs(u.dot(other.side_u.normalized()));
  if (turn > 1e-6 && turn < 1 - 1e-6) return std::nullopt;
  const Vector3d a = other.PointAt(0, 0) - one.origin, b = other.PointAt(1, 1) - one.origin;
  const double left = std::max(0.0, std::min(a.dot(u), b.dot(u)));
  const double right = std::min(one.side_u.norm(), std::max(a.dot(u), b.dot(u)));
  const double low = std::max(0.0, std::min(a.dot(v), b.dot(v)));
  const double high = std::min(one.side_v.norm(), std::max(a.dot(v), b.dot(v)));
  if (right - left < kLeast || high - low < kLeast) return std::nullopt;
  return one.origin + 0.5 * (left + right) * u + 0.5 * (low + high) * v;
}

// Of two surfaces in one plane it is chance which is seen.
TEST_P(EveryWorld, NoTwoSurfacesAreSeenInOnePlace) {
  const World& world = Get();
  const std::vector<Surface>& surfaces = world.scene.surfaces;
  std::vector<Vector3d> eyes;
  for (double time = 0; time <= world.path.duration; time += world.path.duration / 24) {
    eyes.push_back(world.path.world_from_camera(time).translation);
  }
  // What hides a place is most often a face of the same body, added just before or after.
  const auto hides = [&](std::size_t n, const Vector3d& eye, const Vector3d& point) {
    if (surfaces[n].body) return false;
    const std::optional<double> hit = Hit(surfaces[n], eye, point - eye);
    return hit && *hit < 1 - 1e-9;
  };
  const auto seen = [&](const Vector3d& point, std::size_t i, std::size_t k) {
    std::vector<std::size_t> order;
    for (const std::size_t middle : {i, k}) {
      for (std::size_t n = std::max<std::size_t>(middle, 6) - 6; n <= middle + 6; ++n) {
        if (n < surfaces.size()) order.push_back(n);
      }
    }
    for (std::size_t n = 0; n < surfaces.size(); ++n) order.push_back(n);
    return std::any_of(eyes.begin(), eyes.end(), [&](const Vector3d& eye) {
      return std::none_of(order.begin(), order.end(), [&](std::size_t n) {
        return n != i && n != k && hides(n, eye, point);
      });
    });
  };
  std::vector<Vector3d> normals;
  for (const Surface& surface : surfaces) normals.push_back(surface.Normal());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (std::size_t k = i + 1; k < surfaces.size(); ++k) {
      if (surfaces[i].body || surfaces[k].body) continue;
      if (std::abs(normals[i].dot(normals[k])) < 0.99999) continue;
      const std::optional<Vector3d> shared = SharedPlace(surfaces[i], surfaces[k], normals[i]);
      if (!shared) continue;
      EXPECT_FALSE(seen(*shared, i, k))
          << "surfaces " << i << " and " << k << " at " << shared->transpose();
    }
  }
}

TEST_P(EveryWorld, IsAFunctionOfTheSeed) {
  const World& one = Get();
  const World again = GetParam().make(1);
  const World& other = Get(2);
  ASSERT_EQ(one.scene.surfaces.size(), again.scene.surfaces.size());
  for (std::size_t i = 0; i < one.scene.surfaces.size(); ++i) {
    const Surface& a = one.scene.surfaces[i];
    const Surface& b = again.scene.surfaces[i];
    ASSERT_TRUE(a.origin == b.origin && a.side_u == b.side_u && a.side_v == b.side_v);
    ASSERT_EQ(a.texture.seed, b.texture.seed);
  }
  const auto pose = [](const World& world) { return world.path.world_from_camera(3.7); };
  EXPECT_EQ(pose(one).translation, pose(again).translation);
  EXPECT_NE(one.scene.surfaces.front().texture.seed, other.scene.surfaces.front().texture.seed);
  const Rigid3 a = pose(one), b = pose(other);
  EXPECT_TRUE((a.translation - b.translation).norm() > 1e-6 ||
              AngularDistance(a.rotation, b.rotation) > 1e-6);
}

TEST_P(EveryWorld, SaysWhatItIs) {
  EXPECT_EQ(FindWorld(GetParam().name).name, std::string(GetParam().name));
  EXPECT_GT(std::string(GetParam().help).size(), 10U);
  EXPECT_GT(std::string(GetParam().purpose).size(), 10U);
}

INSTANTIATE_TEST_SUITE_P(Worlds,
                         EveryWorld,
                         testing::ValuesIn(Worlds().begin(), Worlds().end()),
                         [](const testing::TestParamInfo<WorldEntry>& tested) {
                           return std::string(tested.param.name);
                         });

// Walls and floors, that is what is large, bear no texture; ceilings do.
TEST(LowTexture, IsBlankWhereItIsLarge) {
  constexpr double kLarge = 3;  // square metres
  int large = 0;
  for (const Surface& surface : Made(FindWorld("lowtexture"), 1).scene.surfaces) {
    if (surface.side_u.norm() * surface.side_v.norm() < kLarge) continue;
    ++large;
    EXPECT_EQ(surface.texture.material,
              surface.Normal().z() < -0.5 ? Material::kAcoustic : Material::kBlank);
  }
  EXPECT_GT(large, 10);
}

TEST(Vicon, HasMoreBlurTheFasterItIsFlown) {
  double last = 0;
  for (const char* name : {"vicon_easy", "vicon_medium", "vicon_difficult"}) {
    SynthOptions options;
    FindWorld(name).adjust(options);
    EXPECT_GT(options.shutter_ms, last);
    last = options.shutter_ms;
  }
}

// How much of the second half of a path shows what was seen 20 s and more before.
double ShareSeenAgain(const CameraPath& path) {
  int seen = 0, all = 0;
  for (double time = 0.5 * path.duration; time < path.duration; time += 0.5) {
    const Rigid3 now = path.world_from_camera(time);
    bool again = false;
    for (double earlier = 0; earlier < time - 20 && !again; earlier += 0.25) {
      const Rigid3 then = path.world_from_camera(earlier);
      again = (now.translation - then.translation).norm() < 1 &&
              AngularDistance(now.rotation, then.rotation) < 0.6;
    }
    ++all;
    seen += again ? 1 : 0;
  }
  return static_cast<double>(seen) / all;
}

TEST(Office, ComesBackToWhatItHasSeen) {
  EXPECT_GT(ShareSeenAgain(Made(FindWorld("office"), 1).path), 0.3);
}

void ExpectASecondWayAlongWhatTheFirstHasSeen(const World& world) {
  ASSERT_TRUE(world.second_path);
  int near = 0, all = 0;
  double apart = 0;
  for (double time = 0; time < world.second_path->duration; time += 0.5) {
    const Rigid3 now = world.second_path->world_from_camera(time);
    double nearest = 1.3;
    for (double before = 0; before < world.path.duration; before += 0.25) {
      const Rigid3 then = world.path.world_from_camera(before);
      if (AngularDistance(now.rotation, then.rotation) > 0.6) continue;
      nearest = std::min(nearest, (now.translation - then.translation).norm());
    }
    ++all;
    near += nearest < 1.3;
    apart += nearest;
  }
  EXPECT_GT(near, 0.9 * all);
  EXPECT_GT(apart, 0.1 * all);  // another way, not the same one again
}

TEST(Office, IsVisitedASecondTimeByAnotherWayAlongWhatTheFirstHasSeen) {
  ExpectASecondWayAlongWhatTheFirstHasSeen(Made(FindWorld("office"), 1));
}

TEST(LowTexture, IsVisitedASecondTimeByAnotherWayAlongWhatTheFirstHasSeen) {
  ExpectASecondWayAlongWhatTheFirstHasSeen(Made(FindWorld("lowtexture"), 1));
}

// In the second round the camera comes within a metre of where it was, looking alike.
TEST(Loop, IsWalkedTwice) {
  const CameraPath& path = Made(FindWorld("loop"), 1).path;
  constexpr double kStep = 0.25, kLeastApart = 40;
  for (double time = 5; time < 0.45 * path.duration; time += 1) {
    const Rigid3 then = path.world_from_camera(time);
    bool again = false;
    for (double later = time + kLeastApart; later < path.duration && !again; later += kStep) {
      const Rigid3 now = path.world_from_camera(later);
      again = (now.translation - then.translation).norm() < 1 &&
              AngularDistance(now.rotation, then.rotation) < 0.6;
    }
    EXPECT_TRUE(again) << time << " s at " << then.translation.transpose();
  }
}

// Of the way through the upper storey most looks as the lower one does 3.2 m below, and what
// was seen of the lower one is seen again.
TEST(Floors, AreAlike) {
  constexpr double kUp = 3.2;
  const World& world = Made(FindWorld("floors"), 1);
  const auto height = [&](double time) {
    return world.path.world_from_camera(time).translation.z();
  };
  int above = 0, alike = 0, again = 0, below_again = 0;
  bool was_above = false;
  for (double time = 0; time < world.path.duration; time += 0.5) {
    const Rigid3 now = world.path.world_from_camera(time);
    const bool is_above = height(time) > kUp + 1.2, is_below = height(time) < 1.8;
    was_above = was_above || is_above;
    if (!is_above && !(is_below && was_above)) continue;
    const Vector3d down = is_above ? Vector3d(0, 0, -kUp) : Vector3d(0, 0, 0);
    bool found = false;
    for (double before = 0; before < time - 10 && !found; before += 0.25) {
      const Rigid3 then = world.path.world_from_camera(before);
      found = (now.translation + down - then.translation).norm() < 1 &&
              AngularDistance(now.rotation, then.rotation) < 0.6;
    }
    (is_above ? above : below_again) += 1;
    (is_above ? alike : again) += found ? 1 : 0;
  }
  EXPECT_GT(above, 50);
  EXPECT_GT(alike, 0.75 * above);
  EXPECT_GT(below_again, 50);
  EXPECT_GT(again, 0.75 * below_again);
  // The same textures in the same places, but for little.
  std::map<std::uint64_t, int> seeds;
  int twice = 0;
  for (const Surface& surface : world.scene.surfaces) ++seeds[surface.texture.seed];
  for (const auto& [seed, count] : seeds) twice += count > 1 ? 1 : 0;
  EXPECT_GT(twice, 0.8 * static_cast<double>(seeds.size()));
  EXPECT_LT(twice, static_cast<double>(seeds.size()));
}

// Metres of a path within a lane's breadth of where it was 15 s and more before, looking the same
// way or the other one.
double LengthPassedAgain(const CameraPath& path, bool same_way) {
  constexpr double kStep = 0.2, kLeastApart = 15, kNear = 4;
  double length = 0;
  for (double time = kLeastApart; time < path.duration; time += kStep) {
    const Rigid3 now = path.world_from_camera(time);
    const Vector3d ahead = now.rotation * Vector3d::UnitZ();
    bool again = false;
    for (double earlier = 0; earlier < time - kLeastApart && !again; earlier += kStep) {
      const Rigid3 then = path.world_from_camera(earlier);
      const double facing = ahead.dot(then.rotation * Vector3d::UnitZ());
      again = (now.translation - then.translation).norm() < kNear &&
              (same_way ? facing > 0.9 : facing < -0.9);
    }
    if (!again) continue;
    length += (path.world_from_camera(time + kStep).translation - now.translation).norm();
  }
  return length;
}

TEST(Town, PassesTwoStreetsAgainAndOneAgainstTheFirstTime) {
  const CameraPath& path = Made(FindWorld("town"), 1).path;
  const double same = LengthPassedAgain(path, true), against = LengthPassedAgain(path, false);
  EXPECT_GT(same, 120);  // two of some 75 m between their crossings
  EXPECT_LT(same, 230);
  EXPECT_GT(against, 40);  // one of 60 m
  EXPECT_LT(against, 90);
}

TEST(Town, IsRecordedByACarLikeKittis) {
  SynthOptions options;
  FindWorld("town").adjust(options);
  EXPECT_EQ(options.camera, SynthCamera::kKitti);
  EXPECT_EQ(options.rate_hz, 10);
  EXPECT_EQ(options.baseline, 0.537);
  EXPECT_FALSE(options.distortion);
}

TEST(Town, SeedsMakeOtherStreets) {
  const World &one = Made(FindWorld("town"), 1), &other = Made(FindWorld("town"), 2);
  EXPECT_NE(one.scene.surfaces.size(), other.scene.surfaces.size());
  EXPECT_GT(
      (one.path.world_from_camera(30).translation - other.path.world_from_camera(30).translation)
          .norm(),
      1);
  EXPECT_GE(one.scene.bodies.size(), 2U);  // traffic
}

TEST(Worlds, ViconIsTheMediumOne) {
  EXPECT_EQ(FindWorld("vicon").name, std::string("vicon_medium"));
}

TEST(Worlds, UnknownNameIsAnErrorThatListsThem) {
  try {
    FindWorld("atlantis");
    FAIL() << "found";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lowtexture"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace plumbline
