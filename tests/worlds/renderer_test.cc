// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/renderer.h"

#include "plumbline/base/random.h"
#include "worlds/built_in/worlds.h"
#include "worlds/path.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace renderer_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

Camera SmallCamera(bool distorted) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 120;
  intrinsics.cx = 99.5;
  intrinsics.cy = 74.5;
  intrinsics.width = 200;
  intrinsics.height = 150;
  if (distorted) {
    intrinsics.model = DistortionModel::kRadTan;
    intrinsics.distortion = {-0.28, 0.07, 0.0002, 0.0001, 0};
  }
  return Camera(intrinsics);
}

RendererOptions WithTexels(const Scene& scene, double texel, int samples = 4) {
  RendererOptions options;
  options.samples = samples;
  options.texels.assign(scene.surfaces.size(), texel);
  return options;
}

Surface Painted(const Vector3d& origin, const Vector3d& u, const Vector3d& v, double tone) {
  Surface surface;
  surface.origin = origin;
  surface.side_u = u;
  surface.side_v = v;
  surface.texture.material = Material::kPaint;
  surface.texture.tone = tone;
  return surface;
}

Lamp PointLamp(const Vector3d& place, int circuit) {
  Lamp lamp;
  lamp.centre = place;
  lamp.circuit = circuit;
  return lamp;
}

// A white wall of 4 x 4 m at x = 2 and, 1 m nearer, a black one that covers y < `edge`.
Scene TwoWalls(double edge) {
  Scene scene;
  scene.ambient = 0;
  Surface white = Painted({2, -2, -2}, {0, 4, 0}, {0, 0, 4}, 2);  // white without variation
  white.glow = 1;
  const Surface black = Painted({1, -2, -2}, {0, 2 + edge, 0}, {0, 0, 4}, 0);
  scene.surfaces = {white, black};
  return scene;
}

// Looks along world x, up is world z.
Rigid3 LevelView() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(axes), Vector3d::Zero()};
}

// Depth along z at which a ray first meets a surface, by trying all.
std::optional<double> DepthByHand(const Scene& scene,
                                  const Rigid3& world_from_camera,
                                  const Vector3d& ray) {
  const Vector3d direction = world_from_camera.rotation * ray;
  std::optional<double> nearest;
  for (const Surface& surface : scene.surfaces) {
    const Vector3d normal = surface.Normal();
    const double depth =
        normal.dot(surface.origin - world_from_camera.translation) / normal.dot(direction);
    if (!(depth > 0) || (nearest && depth >= *nearest)) continue;
    const Vector3d offset = world_from_camera.translation + depth * direction - surface.origin;
    const double a = offset.dot(surface.side_u) / surface.side_u.squaredNorm();
    const double b = offset.dot(surface.side_v) / surface.side_v.squaredNorm();
    if (a >= 0 && a <= 1 && b >= 0 && b <= 1) nearest = depth;
  }
  return nearest;
}

float Bilinear(const Image<float>& image, const Vector2d& px) {
  const int x = static_cast<int>(px.x()), y = static_cast<int>(px.y());
  const auto ax = static_cast<float>(px.x() - x), ay = static_cast<float>(px.y() - y);
  return (1 - ay) * ((1 - ax) * image.at(x, y) + ax * image.at(x + 1, y)) +
         ay * ((1 - ax) * image.at(x, y + 1) + ax * image.at(x + 1, y + 1));
}

TEST(RayTable, AgreesWithTheCameraAcrossThePixel) {
  const Camera camera = SmallCamera(true);
  const RayTable table(camera);
  for (const auto& [x, y] : {std::pair{0, 0}, {199, 149}, {100, 20}, {3, 140}}) {
    for (const double d : {-0.5, 0.0, 0.4}) {
      const Eigen::Vector3f ray = table.at(x, y).At(static_cast<float>(d), static_cast<float>(-d));
      ASSERT_EQ(ray.z(), 1);
      const auto px = camera.Project(ray.cast<double>());
      ASSERT_TRUE(px);
      EXPECT_LT((*px - Vector2d(x + d, y - d)).norm(), 0.01);  // the slope is linear
    }
  }
}

// A fisheye lens of 200 x 200 pixels; its corners are beyond the end of the lens.
Camera Fisheye() {
  CameraIntrinsics intrinsics;
  intrinsics.width = 200;
  intrinsics.height = 200;
  intrinsics.cx = intrinsics.cy = 99.5;
  intrinsics.model = DistortionModel::kDoubleSphere;
  intrinsics.fx = intrinsics.fy = 45;
  intrinsics.distortion = {0.1, 0.6};
  return Camera(intrinsics);
}

TEST(RayTable, HasTheRaysOfALensThatSeesBesideItself) {
  const Camera camera = Fisheye();
  const RayTable table(camera);
  int beside = 0, none = 0;
  for (int y = 0; y < 200; y += 3) {
    for (int x = 0; x < 200; x += 3) {
      const RayTable::Entry& entry = table.at(x, y);
      const auto expected = camera.Ray(Vector2d(x, y));
      ASSERT_EQ(entry.seen, expected.has_value());
      none += entry.seen ? 0 : 1;
      if (!entry.seen) continue;
      EXPECT_LT((entry.ray.cast<double>() - expected->normalized()).norm(), 1e-6);
      beside += entry.ray.z() < 0 ? 1 : 0;
      const auto px = camera.Project(entry.At(0.4F, -0.3F).cast<double>());
      if (px && (entry.ray.z() > 0)) {
        EXPECT_LT((*px - Vector2d(x + 0.4, y - 0.3)).norm(), 0.02);
      }
    }
  }
  EXPECT_GT(beside, 100);
  EXPECT_GT(none, 10) << "the corners are beyond the end of the lens";
}

TEST(Renderer, AFisheyeShowsWhatStandsBesideTheCamera) {
  Scene scene;
  scene.ambient = 0;
  Surface white = Painted({-4, 1, -2}, {3.5, 0, 0}, {0, 0, 4}, 2);  // left, behind the camera alone
  white.glow = 1;
  Surface dark = Painted({1, -2, -2}, {0, 4, 0}, {0, 0, 4}, 0);  // before it
  scene.surfaces = {white, dark};
  const Renderer renderer(scene, WithTexels(scene, 0.05));
  const Camera camera = Fisheye();
  const Rendering rendering = renderer.Render(RayTable(camera), LevelView());
  const auto pixel = [&](double degrees) -> Vector2d {
    const double angle = degrees * M_PI / 180;
    return *camera.Project({-std::sin(angle), 0, std::cos(angle)});
  };
  // The wall begins 26.6 degrees behind the plane of the camera: 116.6 degrees off the axis.
  ASSERT_GT(camera.MaxAngle(), 125 * M_PI / 180);
  const Vector2d on_wall = pixel(124), before_it = pixel(105);
  EXPECT_GT(Bilinear(rendering.light, on_wall), 200);
  EXPECT_EQ(Bilinear(rendering.light, before_it), 0);
  const auto depth_at = [&](const Vector2d& px) {
    return rendering.depth.at(static_cast<int>(px.x()), static_cast<int>(px.y()));
  };
  EXPECT_EQ(depth_at(on_wall), 0) << "behind the camera";
  EXPECT_NEAR(depth_at(pixel(20)), 1, 1e-4);
  const float corner = rendering.light.at(0, 0);
  EXPECT_EQ(corner, 0);
}

TEST(Renderer, DepthIsThatOfTheNearestSurface) {
  const Scene room = MakeRoom(2).scene;
  const Renderer renderer(room, WithTexels(room, 0.05));
  const Rigid3 pose = HandHeldLoop({{3.2, 2.6, 1.5}, 1.1, 0.75, 10, 1}).WorldFromCamera(3.3);
  const Camera camera = SmallCamera(true);
  const Rendering rendering = renderer.Render(RayTable(camera), pose);
  Rng rng(1);
  int differences = 0;
  for (int i = 0; i < 300; ++i) {
    const int x = static_cast<int>(rng.Index(200)), y = static_cast<int>(rng.Index(150));
    const auto ray = camera.Unproject(Vector2d(x, y));
    ASSERT_TRUE(ray);
    const auto expected = DepthByHand(room, pose, *ray);
    ASSERT_TRUE(expected);
    // On an edge single and double precision may find different sides.
    if (std::abs(rendering.depth.at(x, y) - *expected) > 1e-4 * *expected) ++differences;
  }
  EXPECT_LE(differences, 1);
}

TEST(Renderer, EdgesAreWhereTheGeometryIs) {
  for (const double edge : {-0.0311, 0.0, 0.0123, 0.05}) {
    const Renderer renderer(TwoWalls(edge), WithTexels(TwoWalls(edge), 0.02));
    const Rendering rendering = renderer.Render(RayTable(SmallCamera(false)), LevelView());
    // The black wall is at the right (y < edge): the sum over a row tells where it begins.
    const double border_px = 99.5 - 120 * edge;
    for (const int row : {40, 75, 110}) {
      double covered = 0;
      for (int x = 70; x < 130; ++x) covered += rendering.light.at(x, row) / 255;
      EXPECT_NEAR(70 - 0.5 + covered, border_px, 0.13);
    }
  }
}

TEST(Renderer, BothCamerasSeeTheSamePoints) {
  const Scene room = MakeRoom(2).scene;
  const Renderer renderer(room, WithTexels(room, 0.02));
  const Camera camera = SmallCamera(true);
  const RayTable rays(camera);
  const Rigid3 world_from_left =
      HandHeldLoop({{3.2, 2.6, 1.5}, 1.1, 0.75, 10, 1}).WorldFromCamera(5);
  const Rigid3 left_from_right{ExpSo3({0.01, 0.02, -0.01}), {0.11, 0.01, 0}};
  const Rendering left = renderer.Render(rays, world_from_left);
  const Rendering right = renderer.Render(rays, world_from_left * left_from_right);
  double aligned = 0, shifted = 0;
  int count = 0;
  for (int y = 5; y < 145; y += 2) {
    for (int x = 5; x < 195; x += 2) {
      const float depth = left.depth.at(x, y);
      const Vector3d point = depth * *camera.Unproject(Vector2d(x, y));
      const auto px = camera.Project(Inverse(left_from_right) * point);
      if (!px || px->minCoeff() < 3 || px->x() > 195 || px->y() > 145) continue;
      const double z = (Inverse(left_from_right) * point).z();
      const Vector2d nearest(std::round(px->x()), std::round(px->y()));
      const float other =
          right.depth.at(static_cast<int>(nearest.x()), static_cast<int>(nearest.y()));
      if (std::abs(other - z) > 0.02 * z) continue;  // hidden in the right image, or an edge
      aligned += std::abs(Bilinear(right.light, *px) - left.light.at(x, y));
      shifted += std::abs(Bilinear(right.light, *px + Vector2d(2, 0)) - left.light.at(x, y));
      ++count;
    }
  }
  ASSERT_GT(count, 3000);
  EXPECT_LT(aligned / count, 5.0);
  EXPECT_GT(shifted, 2.5 * aligned);
}

TEST(Renderer, ThingsThrowShadows) {
  Scene scene;
  scene.ambient = 0.1;
  scene.lamps.push_back(PointLamp({0, 0, 2}, 0));
  scene.surfaces.push_back(Painted({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.9));
  scene.surfaces.push_back(Painted({-0.3, -0.3, 0.5}, {0.6, 0, 0}, {0, 0.6, 0}, 0.9));
  const Renderer renderer(scene, WithTexels(scene, 0.02));
  // Below the plate's edge, looking down at the floor: the left of the image is in its shadow.
  const Rigid3 down{Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX())),
                    {0.4, 0, 0.4}};
  const Rendering rendering = renderer.Render(RayTable(SmallCamera(false)), down);
  const float shadow = rendering.light.at(10, 75), lit = rendering.light.at(190, 75);
  EXPECT_GT(lit, 35);
  EXPECT_LT(shadow, 0.6F * lit);
  EXPECT_GT(shadow, 15);
}

TEST(Renderer, ALargeLampThrowsASoftShadow) {
  // Over the floor a plate with its edge at x = 0; the width of the shadow's rim follows from the
  // size of the lamp: 0.5 m lamp 1 m above the plate, floor 1 m below it -> 0.5 m.
  for (const double size : {0.0, 0.5}) {
    Scene scene;
    scene.ambient = 0;
    scene.lamps.push_back({{0, 0, 2}, {0, size, 0}, {size, 0, 0}, 1, 0});
    scene.surfaces.push_back(Painted({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.9));
    scene.surfaces.push_back(Painted({-2, -2, 1}, {2, 0, 0}, {0, 4, 0}, 0.0));
    const Renderer renderer(scene, WithTexels(scene, 0.002));
    const Rigid3 down{Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX())),
                      {0, 0, 0.9}};
    const Rendering rendering = renderer.Render(RayTable(SmallCamera(false)), down);
    // Pixels between a tenth and nine tenths of the light.
    const float lit = rendering.light.at(165, 75);
    int rim = 0;
    for (int x = 0; x < 200; ++x) {
      const float share = rendering.light.at(x, 75) / lit;
      rim += share > 0.1F && share < 0.9F ? 1 : 0;
    }
    const double metres = rim * 0.9 / 120;
    if (size == 0) {
      EXPECT_LT(metres, 0.08);
    } else {
      EXPECT_NEAR(metres, 0.4, 0.08);
    }
  }
}

TEST(Renderer, SurfacesLightEachOther) {
  // A lamp shines on the floor only; the wall beside gets its light from there.
  Scene scene;
  scene.ambient = 0;
  scene.lamps.push_back({{1, 0, 1}, {0, 0.2, 0}, {0.2, 0, 0}, 1, 0});
  scene.surfaces.push_back(Painted({0, -2, 0}, {2, 0, 0}, {0, 4, 0}, 0.9));
  scene.surfaces.push_back(Painted({2, 2, 0.001}, {0, -4, 0}, {0, 0, 4}, 0.9));
  const auto brightness = [&](double tone) {
    scene.surfaces[0].texture.tone = tone;
    const Renderer renderer(scene, WithTexels(scene, 0.02));
    const Rigid3 high{LevelView().rotation, {0.5, 0, 2.5}};  // above the lamp's half space
    return renderer.Render(RayTable(SmallCamera(false)), high).light.at(100, 70);
  };
  EXPECT_NEAR(brightness(0), 0, 0.01);
  const float half = brightness(0.4), whole = brightness(0.8);
  EXPECT_GT(half, 1);
  EXPECT_NEAR(whole / half, 2, 0.1);
}

TEST(Renderer, CircuitsSwitchLampsAndGlow) {
  Scene scene = TwoWalls(0);
  scene.ambient = 0;
  scene.surfaces[0].circuit = 1;
  scene.surfaces[1] = Painted({1, 0, -2}, {0, -2, 0}, {0, 0, 4}, 0.5);  // towards the lamp
  scene.lamps.push_back(PointLamp({0, 0, 0}, 1));
  scene.circuits.push_back({[](double time) { return time; }});
  const Renderer renderer(scene, WithTexels(scene, 0.02));
  const RayTable rays(SmallCamera(false));
  const auto at = [&](double time) {
    return renderer.Render(rays, [](double) { return LevelView(); }, {time, 0, 0});
  };
  const Rendering off = at(0), half = at(0.5), on = at(1);
  for (const int x : {20, 180}) {
    EXPECT_EQ(off.light.at(x, 75), 0);
    EXPECT_GT(on.light.at(x, 75), 10);
    EXPECT_NEAR(half.light.at(x, 75), 0.5F * on.light.at(x, 75), 1e-3);
  }
}

TEST(Renderer, BlurIsTheMeanOverTheTimeTheShutterIsOpen) {
  // Sideways past the edge: within the blur the light rises linearly from black to white.
  const Scene scene = TwoWalls(0);
  const Renderer renderer(scene, WithTexels(scene, 0.02));
  const RayTable rays(SmallCamera(false));
  const double speed = 2, exposure = 0.1;  // 0.2 m: 24 pixels at 1 m
  const auto path = [&](double time) {
    return Rigid3{LevelView().rotation, {0, speed * (time - 5), 0}};
  };
  const Rendering blurred = renderer.Render(rays, path, {5, exposure, 0});
  const float white = renderer.Render(rays, LevelView()).light.at(30, 75);
  EXPECT_NEAR(blurred.light.at(84, 75), white, 0.03 * white);
  EXPECT_NEAR(blurred.light.at(115, 75), 0, 0.03 * white);
  for (int x = 90; x < 110; ++x) {
    EXPECT_NEAR(blurred.light.at(x, 75), white * (111.5 - x) / 24, 0.06 * white) << x;
  }
  // Steps, the ghosts of too few times, would stand out in the second difference.
  for (int x = 91; x < 109; ++x) {
    const float bend =
        blurred.light.at(x - 1, 75) - 2 * blurred.light.at(x, 75) + blurred.light.at(x + 1, 75);
    EXPECT_LT(std::abs(bend), 0.05F * white) << x;
  }
}

TEST(Renderer, ARollingShutterShearsWhatMoves) {
  const Scene scene = TwoWalls(0);
  const Renderer renderer(scene, WithTexels(scene, 0.02));
  const RayTable rays(SmallCamera(false));
  const auto path = [&](double time) { return Rigid3{LevelView().rotation, {0, 2 * time, 0}}; };
  const Rendering rolling = renderer.Render(rays, path, {0, 0, 0.1});
  const float white = renderer.Render(rays, LevelView()).light.at(30, 75);
  const auto border = [&](int row) {
    double covered = 0;
    for (int x = 60; x < 140; ++x) covered += static_cast<double>(rolling.light.at(x, row) / white);
    return 60 - 0.5 + covered;
  };
  // The edge at y = 0 stands at -y of the camera: 120 pixels a metre, to the right as it moves
  // left.
  for (const int row : {5, 75, 145}) {
    const double time = ((row + 0.5) / 150 - 0.5) * 0.1;
    EXPECT_NEAR(border(row), 99.5 + 120 * 2 * time, 0.3) << row;
  }
}

TEST(Renderer, BodiesMoveAndThrowShadows) {
  Scene scene;
  scene.ambient = 0;
  scene.lamps.push_back({{0, 0, 3}, {0, 0.1, 0}, {0.1, 0, 0}, 3, 0});
  scene.surfaces.push_back(Painted({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 0.9));
  Surface plate = Painted({-0.2, -0.2, 0}, {0.4, 0, 0}, {0, 0.4, 0}, 0.5);
  plate.body = 0;
  scene.surfaces.push_back(plate);
  scene.bodies.push_back({[](double time) {
    return Rigid3{Eigen::Quaterniond::Identity(), {time, 0, 1}};
  }});
  const Renderer renderer(scene, WithTexels(scene, 0.02));
  const RayTable rays(SmallCamera(false));
  const Rigid3 down{Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX())),
                    {0, 0, 2}};
  const auto at = [&](double time) {
    return renderer.Render(rays, [&](double) { return down; }, {time, 0, 0});
  };
  const auto pixel = [](double x, double depth) {
    return static_cast<int>(std::lround(99.5 + 120 * x / depth));
  };
  for (const double time : {-0.5, 0.4}) {
    const Rendering rendering = at(time);
    EXPECT_NEAR(rendering.depth.at(pixel(time, 1), 75), 1, 1e-4);
    EXPECT_NEAR(rendering.depth.at(pixel(-time, 1), 75), 2, 1e-4);
    EXPECT_GT(rendering.light.at(pixel(time, 1), 75), 10);  // lit itself
    // Its shadow on the floor is 1.5 times as far from the axis as the plate; seen from the side,
    // where the plate is out of view.
    const Rigid3 beside{down.rotation, {0, 1.1, 2}};
    const Rendering view = renderer.Render(rays, [&](double) { return beside; }, {time, 0, 0});
    const float shadow = view.light.at(pixel(1.5 * time, 2), 140);
    const float mirrored = view.light.at(pixel(-1.5 * time, 2), 140);
    EXPECT_LT(shadow, 0.35F * mirrored) << time;
  }
  EXPECT_FALSE(renderer.Sees({0.4, 0, 2}, {0.4, 0, 0.5}, 0, 0.4));
  EXPECT_TRUE(renderer.Sees({0.4, 0, 2}, {0.4, 0, 0.5}, 0, -0.5));
  EXPECT_FALSE(renderer.Sees({0.4, 0, 2}, {0.4, 0, -0.5}, 0, -0.5));
}

// The sky is as bright as the light that comes from it; with an open shutter, too.
TEST(Renderer, WhereThereIsNothingThereIsTheSky) {
  Scene scene;
  scene.ambient = 0.6;
  const Renderer renderer(scene, {});
  const RayTable rays(SmallCamera(false));
  for (const double exposure : {0.0, 0.01}) {
    const Rendering rendering =
        renderer.Render(rays, [](double) { return LevelView(); }, {0, exposure, 0});
    EXPECT_NEAR(rendering.light.at(100, 75), 0.6 * 255, 1e-3);
    EXPECT_EQ(rendering.depth.at(100, 75), 0);
  }
}

}  // namespace renderer_test
}  // namespace plumbline
