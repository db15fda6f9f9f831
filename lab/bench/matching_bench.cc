// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/features/extractor.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/matching/projection_search.h"
#include "worlds/sequence.h"

#include "tests/support/data_folder.h"
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

// Matching of points and lines, from one image to the next and from left to right. The images are
// two neighbouring pairs of EuRoC MH_01 if the data is found (PLUMBLINE_DATA), otherwise of the
// rendered room, as the label says.

namespace plumbline {
namespace {

constexpr const char* kRecorded = "euroc/MH_01_easy_first250";
constexpr int kFirstFrame = 100;

// Features of one image.
struct View {
  ImagePyramid pyramid;
  std::vector<PointFeature> points;
  std::vector<LineFeature> lines;
};

View Extract(const GrayImage& image) {
  const FeatureOptions options;
  const ValidRegion whole(image.width(), image.height());
  View view;
  view.pyramid = BuildOrbPyramid(image, options.orb);
  view.points = ExtractOrb(view.pyramid, whole, options.point_count, options.orb);
  const GradientImage gradient = ComputeGradient(image);
  view.lines =
      DetectLines(image, gradient, whole, options.line_detector, options.line_count, options.line);
  DescribeLines(gradient, &view.lines);
  return view;
}

struct Scene {
  const char* images;
  RectifiedCamera camera;
  View left, right, next_left;
};

std::array<SensorFrame, 2> RecordedFrames(const Dataset& dataset) {
  std::array<SensorFrame, 2> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    auto frame = dataset.Read(kFirstFrame + i);
    PLUMBLINE_CHECK(static_cast<bool>(frame), "a frame that can be read");
    out[i] = std::move(*frame);
  }
  return out;
}

std::array<SensorFrame, 2> RenderedFrames(const SyntheticSequence& sequence) {
  std::array<SensorFrame, 2> out;
  for (int i = 0; i < 2; ++i) {
    SensorFrame& frame = out[static_cast<std::size_t>(i)];
    frame.stamp_ns = sequence.StampNs(kFirstFrame + i);
    frame.left = sequence.RenderImage(kFirstFrame + i, 0);
    frame.right = sequence.RenderImage(kFirstFrame + i, 1);
  }
  return out;
}

Scene MakeScene(const char* images,
                const Calibration& calibration,
                std::array<SensorFrame, 2> frames) {
  const Rectifier rectifier(calibration);
  const RectifiedFrame first = rectifier.Apply(std::move(frames[0]));
  const RectifiedFrame second = rectifier.Apply(std::move(frames[1]));
  return {images,
          rectifier.camera(),
          Extract(first.left),
          Extract(first.right.value()),
          Extract(second.left)};
}

const Scene& TheScene() {
  static const Scene scene = [] {
    if (const auto folder = FindData(kRecorded)) {
      const auto dataset = OpenDataset(*folder, {});
      return MakeScene("MH_01", dataset->calibration(), RecordedFrames(*dataset));
    }
    const SyntheticSequence room("room", {}, 2);
    return MakeScene("rendered room", room.calibration(), RenderedFrames(room));
  }();
  return scene;
}

void Report(
    benchmark::State& state, const Scene& scene, std::size_t a, std::size_t b, std::size_t found) {
  state.SetLabel(scene.images);
  state.counters["from"] = static_cast<double>(a);
  state.counters["to"] = static_cast<double>(b);
  state.counters["found"] = static_cast<double>(found);
}

template <class T>
std::size_t CountFound(const std::vector<std::optional<T>>& items) {
  std::size_t n = 0;
  for (const auto& item : items) n += item.has_value();
  return n;
}

// Tracking: each point of the one frame is looked for around its place in the next.
void PointsByProjection(benchmark::State& state) {
  const Scene& scene = TheScene();
  const double octave_scale = OrbOptions{}.scale_factor;
  std::vector<std::optional<ProjectedPoint>> predicted;
  for (const PointFeature& p : scene.left.points) {
    predicted.push_back(
        ProjectedPoint{p.px, 0, p.octave, std::pow(octave_scale, p.octave), p.descriptor});
  }
  FrameFeatures next;
  next.features.points = scene.next_left.points;
  next.features.point_disparity.resize(next.features.points.size());
  std::vector<Eigen::Vector2d> places;
  for (const PointFeature& p : next.features.points) places.push_back(p.px);
  next.point_grid = PointGrid(places, scene.camera.width, scene.camera.height);
  const std::vector<bool> taken(next.features.points.size(), false);
  ProjectionSearchOptions options;
  options.point_radius_px = static_cast<double>(state.range(0));
  std::vector<LandmarkMatch> matches;
  for (auto _ : state) matches = MatchProjectedPoints(next, predicted, taken, options);
  Report(state, scene, predicted.size(), next.features.points.size(), matches.size());
}

void LinesByProjection(benchmark::State& state) {
  const Scene& scene = TheScene();
  std::vector<std::optional<ProjectedLine>> predicted;
  for (const LineFeature& line : scene.left.lines) {
    predicted.push_back(ProjectedLine{line.segment, line.descriptor});
  }
  FrameFeatures next;
  next.features.lines = scene.next_left.lines;
  next.features.line_right.resize(next.features.lines.size());
  const std::vector<bool> taken(next.features.lines.size(), false);
  std::vector<LandmarkMatch> matches;
  for (auto _ : state) matches = MatchProjectedLines(next, predicted, taken, {});
  Report(state, scene, predicted.size(), next.features.lines.size(), matches.size());
}

void StereoPoints(benchmark::State& state) {
  const Scene& scene = TheScene();
  const ValidRegion whole(scene.camera.width, scene.camera.height);
  std::vector<std::optional<Disparity>> found;
  for (auto _ : state) {
    found = MatchStereoPoints(
        scene.camera, scene.left.points, {scene.left.pyramid, scene.right.pyramid, whole}, {});
  }
  Report(state, scene, scene.left.points.size(), 0, CountFound(found));
}

void StereoLines(benchmark::State& state) {
  const Scene& scene = TheScene();
  std::vector<std::optional<MeasuredSegment>> found;
  for (auto _ : state) {
    found = MatchStereoLines(scene.camera, scene.left.lines, scene.right.lines, {});
  }
  Report(state, scene, scene.left.lines.size(), scene.right.lines.size(), CountFound(found));
}

// All against all, both ways.
void PointsBruteForce(benchmark::State& state) {
  const Scene& scene = TheScene();
  std::vector<FeatureMatch> found;
  for (auto _ : state) found = MatchPoints(scene.left.points, scene.next_left.points, {});
  Report(state, scene, scene.left.points.size(), scene.next_left.points.size(), found.size());
}

// Descriptors alone: any place will do.
void LinesBruteForce(benchmark::State& state) {
  const Scene& scene = TheScene();
  const LineMatchOptions options{
      .max_angle_deg = 180, .max_offset_px = 10000, .max_shift_px = 0, .min_length_ratio = 0};
  std::vector<FeatureMatch> found;
  for (auto _ : state) {
    found = MatchLines(scene.left.lines, scene.next_left.lines, options);
  }
  Report(state, scene, scene.left.lines.size(), scene.next_left.lines.size(), found.size());
}

// The Hamming distance alone, for each pair of descriptors.
template <class Feature>
void Distances(benchmark::State& state,
               const std::vector<Feature>& from,
               const std::vector<Feature>& to) {
  int sum = 0;
  for (auto _ : state) {
    for (const Feature& a : from) {
      for (const Feature& b : to) sum += HammingDistance(a.descriptor, b.descriptor);
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(from.size() * to.size()));
  state.SetLabel(TheScene().images);
}
void HammingOfPoints(benchmark::State& state) {
  Distances(state, TheScene().left.points, TheScene().next_left.points);
}
void HammingOfLines(benchmark::State& state) {
  Distances(state, TheScene().left.lines, TheScene().next_left.lines);
}

BENCHMARK(PointsByProjection)->ArgName("radius")->Arg(4)->Arg(15)->Unit(benchmark::kMicrosecond);
BENCHMARK(LinesByProjection)->Unit(benchmark::kMicrosecond);
BENCHMARK(StereoPoints)->Unit(benchmark::kMicrosecond);
BENCHMARK(StereoLines)->Unit(benchmark::kMicrosecond);
BENCHMARK(PointsBruteForce)->Unit(benchmark::kMicrosecond);
BENCHMARK(LinesBruteForce)->Unit(benchmark::kMicrosecond);
BENCHMARK(HammingOfPoints)->Unit(benchmark::kMicrosecond);
BENCHMARK(HammingOfLines)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumbline
