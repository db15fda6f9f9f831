// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Images, depth, poses and lines of a rendered world must agree.
#include "worlds/path.h"
#include "worlds/renderer.h"
#include "worlds/scene_builder.h"
#include "worlds/true_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Camera WideCamera() {
  CameraIntrinsics intrinsics;
  intrinsics.fx = 458.2;
  intrinsics.fy = 457.5;
  intrinsics.cx = 371.4;
  intrinsics.cy = 243.6;
  intrinsics.width = 752;
  intrinsics.height = 480;
  intrinsics.model = DistortionModel::kRadTan;
  intrinsics.distortion = {-0.283, 0.0742, 0.0002, 0.00002, 0};
  return Camera(intrinsics);
}

// Boxes, posters and a carpet under an open sky: steps of brightness at edges and on surfaces, no
// lamp whose shadows would disturb them.
Scene OpenYard() {
  SceneBuilder builder(3);
  builder.SetAmbient(1);
  builder.AddFloor({-4, -4, 0}, {8, 8}, Material::kBlank, 0.35);
  builder.AddPanel({0.9, -1.1, 0.001}, {1.6, 0, 0}, {0, 2.2, 0}, {Material::kCarpet, 0.5});
  for (int i = 0; i < 6; ++i) {
    const double along = -1.5 + 0.6 * i, far = 2.2 + 0.3 * (i % 3);
    builder.AddBox({{far, along, 0}, {0.35, 0.3, 0.4 + 0.12 * i}, 0.3 * i},
                   i % 2 == 0 ? Material::kBlank : Material::kCardboard,
                   i % 3 == 0 ? 0.75 : 0.15);
    builder.AddPanel(
        {3.2 + 0.05 * i, along + 0.25, 0.6}, {0, -0.5, 0}, {0, 0, 0.7}, {Material::kPoster, 0.8});
  }
  for (const double side : {-1.0, 1.0}) {  // pictures large enough for steps far from each other
    builder.AddPanel(
        {2.6, side * 2.1 + 0.6, 0.1}, {0, -1.2, 0}, {0, 0, 1.7}, {Material::kPoster, 0.8});
  }
  return builder.Take();
}

// Plates in the light of a small lamp, over a floor and before a wall that catch their shadows.
Scene LampLitStage() {
  SceneBuilder builder(4);
  builder.SetAmbient(0.15);
  builder.AddFloor({-1, -4, 0}, {6, 8}, Material::kBlank, 0.7);
  builder.AddPanel({3.8, 2.5, 0}, {0, -5, 0}, {0, 0, 2.4}, {Material::kBlank, 0.7});
  for (int i = 0; i < 5; ++i) {  // over the floor, and before the wall
    const double along = -1.7 + 0.8 * i, turn = 0.2 * i;
    const Vector3d across(0.45 * std::cos(turn), 0.45 * std::sin(turn), 0);
    builder.AddPanel({2 + 0.15 * (i % 2), along, 0.2},
                     across,
                     0.7 * Vector3d::UnitZ().cross(across),
                     {Material::kBlank, 0.3});
    builder.AddPanel({3.6, along + 0.5, 0.7 + 0.3 * (i % 3)},
                     {0, -0.35, 0.1 * i},
                     {0, 0.05, 0.3},
                     {Material::kBlank, 0.3});
  }
  builder.AddLamp({{0.9, 0.2, 2.3}, {0, 0.02, 0}, {0.02, 0, 0}, 5});
  return builder.Take();
}

std::vector<TimedView> Views() {
  std::vector<TimedView> views;
  for (int i = 0; i < 3; ++i) {
    views.push_back({0.1 * i,
                     {CameraAttitude(0.1 - 0.12 * i, 0.2 + 0.04 * i, 0.06 * i),
                      Vector3d(0.1 * i, 0.2 - 0.25 * i, 1.1 + 0.08 * i)}});
  }
  return views;
}

float Bilinear(const Image<float>& image, const Vector2d& px) {
  const int x = static_cast<int>(px.x()), y = static_cast<int>(px.y());
  const auto ax = static_cast<float>(px.x() - x), ay = static_cast<float>(px.y() - y);
  return (1 - ay) * ((1 - ax) * image.at(x, y) + ax * image.at(x + 1, y)) +
         ay * ((1 - ax) * image.at(x, y + 1) + ax * image.at(x + 1, y + 1));
}

struct Curve {
  std::vector<Vector2d> px, across;  // places along the line and the unit normals there
};

// The image of a line at places about 3 px apart; nullopt unless all are well inside.
std::optional<Curve> ImageOf(const Segment3& line, const Camera& camera, const Rigid3& pose) {
  constexpr int kPlaces = 60;
  const Rigid3 camera_from_world = Inverse(pose);
  Curve curve;
  for (int i = 0; i <= kPlaces; ++i) {
    const double share = 0.05 + 0.9 * i / kPlaces;
    const auto px =
        camera.Project(camera_from_world * (line.start + share * (line.end - line.start)));
    if (!px || px->minCoeff() < 12 || px->x() > 739 || px->y() > 467) return std::nullopt;
    curve.px.push_back(*px);
  }
  for (int i = 0; i <= kPlaces; ++i) {
    const Vector2d along = curve.px[static_cast<std::size_t>(std::min(i + 1, kPlaces))] -
                           curve.px[static_cast<std::size_t>(std::max(i - 1, 0))];
    curve.across.push_back(Vector2d(-along.y(), along.x()).normalized());
  }
  return curve;
}

// Mean brightness at a distance across the line.
double Beside(const Image<float>& light, const Curve& curve, double distance) {
  double sum = 0;
  for (std::size_t i = 0; i < curve.px.size(); ++i) {
    sum += static_cast<double>(Bilinear(light, curve.px[i] + distance * curve.across[i]));
  }
  return sum / static_cast<double>(curve.px.size());
}

// Where the brightness across a line steps, pixels from the line: the centre of the steepest part.
// nullopt unless it is one clear step between two even sides.
std::optional<double> StepAcross(const Image<float>& light, const Curve& curve) {
  constexpr double kStride = 0.1;
  constexpr int kCount = 81, kSide = 20, kHalfWindow = 12;  // 8 px, of which 2 at each side
  std::array<double, kCount> profile{};
  for (int i = 0; i < kCount; ++i) {
    profile[static_cast<std::size_t>(i)] = Beside(light, curve, kStride * (i - kCount / 2));
  }
  const auto [left_low, left_high] = std::minmax_element(profile.begin(), profile.begin() + kSide);
  const auto [right_low, right_high] = std::minmax_element(profile.end() - kSide, profile.end());
  const double step = 0.5 * (*right_low + *right_high - *left_low - *left_high);
  if (std::abs(step) < 12) return std::nullopt;
  if (*left_high - *left_low + *right_high - *right_low > 0.2 * std::abs(step)) {
    return std::nullopt;
  }
  const auto slope = [&](int i) {
    return (profile[static_cast<std::size_t>(i) + 1] - profile[static_cast<std::size_t>(i)]) / step;
  };
  int steepest = kSide;
  for (int i = kSide; i + kSide < kCount; ++i) {
    if (slope(i) > slope(steepest)) steepest = i;
  }
  double weight = 0, moment = 0;
  for (int i = steepest - kHalfWindow; i <= steepest + kHalfWindow; ++i) {
    weight += slope(i);
    moment += slope(i) * kStride * (i + 0.5 - kCount / 2);
  }
  return moment / weight;
}

// Whether another line comes close to the middle of this one; steps side by side blur into one.
bool IsAlone(const Segment3& line,
             const std::vector<TrueLine>& lines,
             const Camera& camera,
             const Rigid3& pose) {
  constexpr double kDistancePx = 6;
  const Rigid3 camera_from_world = Inverse(pose);
  const double depth = (camera_from_world * line.Midpoint()).z();
  const double radius = kDistancePx * depth / camera.intrinsics().fx;
  const auto near_line = [&](const TrueLine& other) {
    // Across the viewing ray; along it distance does not count.
    const Vector3d ray = (line.Midpoint() - pose.translation).normalized();
    const Segment3 sight{line.Midpoint() - 0.5 * ray, line.Midpoint() + 0.5 * ray};
    return (other.segment.Midpoint() - line.Midpoint()).norm() > 1e-9 &&
           StretchWithin(sight, other.segment, radius).has_value();
  };
  return std::none_of(lines.begin(), lines.end(), near_line);
}

struct Offsets {
  std::vector<double> values;

  double Quantile(double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
};

// How far the steps of the images lie from the true lines, by kind of line; pixels.
struct LineOffsets {
  std::array<Offsets, kTrueLineKinds> signed_px, distances_px;
};

LineOffsets MeasureOffsets(const Scene& scene, double texel) {
  const Camera camera = WideCamera();
  const std::vector<TimedView> views = Views();
  const std::vector<TrueLine> lines = TrueLines(scene, camera, views, {}, 2);
  const Renderer renderer(
      scene,
      {.samples = 16, .texels = std::vector<double>(scene.surfaces.size(), texel), .threads = 2});
  const RayTable rays(camera);
  LineOffsets offsets;
  for (std::size_t frame = 0; frame < views.size(); ++frame) {
    const Rendering rendering = renderer.Render(rays, views[frame].world_from_camera);
    const auto now = static_cast<int>(frame);
    for (const TrueLine& line : lines) {
      const bool seen =
          std::any_of(line.visible->begin(), line.visible->end(), [now](const FrameRange& range) {
            return range.first <= now && now <= range.last;
          });
      if (!seen) continue;
      const auto curve = ImageOf(line.segment, camera, views[frame].world_from_camera);
      if (!curve || !IsAlone(line.segment, lines, camera, views[frame].world_from_camera)) continue;
      const auto step = StepAcross(rendering.light, *curve);
      if (!step) continue;
      const auto kind = static_cast<std::size_t>(line.kind);
      offsets.signed_px[kind].values.push_back(*step);
      offsets.distances_px[kind].values.push_back(std::abs(*step));
    }
  }
  return offsets;
}

// What is left: texture and light that change beside the step, and sampling.
void ExpectOnTheSteps(LineOffsets offsets, TrueLineKind kind) {
  const auto k = static_cast<std::size_t>(kind);
  ASSERT_GT(offsets.signed_px[k].values.size(), 20U) << k;
  EXPECT_LT(std::abs(offsets.signed_px[k].Quantile(0.5)), 0.05) << k;
  EXPECT_LT(offsets.distances_px[k].Quantile(0.5), 0.1) << k;
  EXPECT_LT(offsets.distances_px[k].Quantile(0.9), 0.2) << k;
}

TEST(GroundTruth, LinesLieOnTheStepsOfTheImage) {
  const LineOffsets offsets = MeasureOffsets(OpenYard(), 0.003);
  ExpectOnTheSteps(offsets, TrueLineKind::kGeometry);
  ExpectOnTheSteps(offsets, TrueLineKind::kTexture);
}

// As finely as light is kept.
TEST(GroundTruth, ShadowLinesLieOnTheShadowsOfTheImage) {
  ExpectOnTheSteps(MeasureOffsets(LampLitStage(), 0.002), TrueLineKind::kShadow);
}

TEST(GroundTruth, DepthOfOneViewIsThatOfAnother) {
  const Scene scene = OpenYard();
  const Camera camera = WideCamera();
  const std::vector<TimedView> views = Views();
  const Renderer renderer(
      scene,
      {.samples = 1, .texels = std::vector<double>(scene.surfaces.size(), 0.05), .threads = 2});
  const RayTable rays(camera);
  const Rigid3 &world_from_a = views[0].world_from_camera,
               &world_from_b = views[1].world_from_camera;
  const Rendering a = renderer.Render(rays, world_from_a), b = renderer.Render(rays, world_from_b);
  const Rigid3 b_from_a = Inverse(world_from_b) * world_from_a;
  int compared = 0, equal = 0;
  for (int y = 0; y < camera.height(); y += 3) {
    for (int x = 0; x < camera.width(); x += 3) {
      if (a.depth.at(x, y) == 0) continue;
      const Vector3d point =
          b_from_a * (static_cast<double>(a.depth.at(x, y)) * *camera.Unproject(Vector2d(x, y)));
      const auto px = camera.Project(point);
      if (!px || px->minCoeff() < 1 || px->x() > 750 || px->y() > 478) continue;
      const int x0 = static_cast<int>(px->x()), y0 = static_cast<int>(px->y());
      // On a plane the inverse depth is linear in the ray, and nearly so in the pixel.
      Image<float> inverse(2, 2);
      for (int k = 0; k < 4; ++k) {
        inverse.at(k % 2, k / 2) = 1 / b.depth.at(x0 + k % 2, y0 + k / 2);
      }
      const auto [low, high] = std::minmax_element(inverse.data(), inverse.data() + 4);
      if (!(*high < 1.03F * *low)) continue;  // an edge
      const auto ax = static_cast<float>(px->x() - x0), ay = static_cast<float>(px->y() - y0);
      const float there = (1 - ay) * ((1 - ax) * inverse.at(0, 0) + ax * inverse.at(1, 0)) +
                          ay * ((1 - ax) * inverse.at(0, 1) + ax * inverse.at(1, 1));
      const double ratio = point.z() * static_cast<double>(there);
      if (ratio > 1.02) continue;  // hidden in b
      ++compared;
      if (std::abs(ratio - 1) < 0.001) ++equal;
    }
  }
  EXPECT_GT(compared, 15'000);
  EXPECT_GT(equal, 0.995 * compared) << compared;
}

TEST(GroundTruth, TheLinesDoNotDependOnThreads) {
  const Scene scene = OpenYard();
  const Camera camera = WideCamera();
  const std::vector<TimedView> views = Views();
  const auto one = TrueLines(scene, camera, views, {}, 1),
             two = TrueLines(scene, camera, views, {}, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].segment.start, two[i].segment.start);
    EXPECT_EQ(one[i].segment.end, two[i].segment.end);
    EXPECT_EQ(one[i].kind, two[i].kind);
    EXPECT_EQ(one[i].visible, two[i].visible);
  }
}

}  // namespace
}  // namespace plumbline
