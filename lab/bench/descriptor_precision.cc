// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/descriptor_precision.h"

#include "lab/bench/line_correspondence.h"
#include "lab/bench/sequence_images.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/line_descriptor/descriptor.hpp>

namespace plumbline::bench {
namespace {

constexpr double kRecall = 0.9;

enum class Method { kOurs, kOpenCv };

// Lines with the descriptors of both methods.
struct View {
  GrayImage image;
  std::vector<LineFeature> ours;
  std::vector<LineFeature> opencv;
  double ours_ms = 0;
  double opencv_ms = 0;

  const std::vector<LineFeature>& With(Method method) const {
    return method == Method::kOurs ? ours : opencv;
  }
};

void DescribeByOpenCv(const GrayImage& image, std::vector<LineFeature>* lines) {
  std::vector<cv::line_descriptor::KeyLine> keys(lines->size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Segment2& s = (*lines)[i].segment;
    cv::line_descriptor::KeyLine& key = keys[i];
    key.class_id = static_cast<int>(i);
    key.octave = 0;
    key.startPointX = key.sPointInOctaveX = static_cast<float>(s.start.x());
    key.startPointY = key.sPointInOctaveY = static_cast<float>(s.start.y());
    key.endPointX = key.ePointInOctaveX = static_cast<float>(s.end.x());
    key.endPointY = key.ePointInOctaveY = static_cast<float>(s.end.y());
    key.pt = {0.5F * (key.startPointX + key.endPointX), 0.5F * (key.startPointY + key.endPointY)};
    key.lineLength = static_cast<float>(s.Length());
    key.numOfPixels = static_cast<int>(std::ceil(s.Length()));
    key.angle = static_cast<float>(std::atan2(s.end.y() - s.start.y(), s.end.x() - s.start.x()));
    key.size = key.lineLength;
    key.response = 1;
  }
  cv::Mat descriptors;
  const auto method = cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor();
  method->compute(AsMat(image), keys, descriptors);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    static_assert(sizeof(Descriptor) == 32);
    std::memcpy((*lines)[static_cast<std::size_t>(keys[i].class_id)].descriptor.data(),
                descriptors.ptr(static_cast<int>(i)),
                sizeof(Descriptor));
  }
}

View Describe(GrayImage image, const ValidRegion& valid) {
  View view;
  const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
  view.ours = DetectLines(image, gradient, valid, LineDetector::kDrawing, 200, {});
  view.opencv = view.ours;
  DescribeLines(gradient, &view.ours);  // warm
  const double start = CpuMilliseconds();
  DescribeLines(gradient, &view.ours);
  const double middle = CpuMilliseconds();
  DescribeByOpenCv(image, &view.opencv);
  view.ours_ms = middle - start;
  view.opencv_ms = CpuMilliseconds() - middle;
  view.image = std::move(image);
  return view;
}

// The nearest neighbour of a line: its distance, its ratio to the next, and whether it is right.
struct Nearest {
  double distance = 0;
  double ratio = 0;
  bool right = false;
};

struct Tally {
  int with_match = 0;  // lines that have a counterpart
  std::vector<Nearest> nearest;

  // Precision among the pairs accepted, best `key` first, to find kRecall of the counterparts.
  // nullopt if that recall is never reached.
  std::optional<double> PrecisionAtRecall(double Nearest::*key) const {
    std::vector<Nearest> sorted = nearest;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const Nearest& a, const Nearest& b) {
      return a.*key < b.*key;
    });
    int right = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      right += sorted[i].right ? 1 : 0;
      if (right >= kRecall * with_match) return right / static_cast<double>(i + 1);
    }
    return std::nullopt;
  }
  // Area under the curve of precision over recall, by distance.
  double AveragePrecision() const {
    std::vector<Nearest> sorted = nearest;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Nearest& a, const Nearest& b) {
      return a.distance < b.distance;
    });
    int right = 0;
    double sum = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (!sorted[i].right) continue;
      ++right;
      sum += right / static_cast<double>(i + 1);
    }
    return sum / std::max(1, with_match);
  }
  double Right() const {
    const auto right =
        std::count_if(nearest.begin(), nearest.end(), [](const Nearest& n) { return n.right; });
    return static_cast<double>(right) / std::max(1, with_match);
  }
};

// `near_only`: only among lines that the tracker's search would compare.
void Add(const std::vector<LineFeature>& a,
         const std::vector<LineFeature>& b,
         const std::vector<ExpectedLine>& expected,
         bool near_only,
         Tally* tally) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!expected[i].place || (expected[i].same.empty() && expected[i].unclear)) continue;
    if (!expected[i].same.empty()) ++tally->with_match;
    int best = 257;
    int second = 257;
    int index = -1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (near_only && !LinesCompatible(a[i].segment, b[j].segment, {})) continue;
      const int distance = HammingDistance(a[i].descriptor, b[j].descriptor);
      if (distance < best) {
        second = best;
        best = distance;
        index = static_cast<int>(j);
      } else if (distance < second) {
        second = distance;
      }
    }
    if (index < 0) continue;
    const auto& same = expected[i].same;
    const bool right = std::find(same.begin(), same.end(), index) != same.end();
    tally->nearest.push_back(
        {static_cast<double>(best), best / std::max(1.0, static_cast<double>(second)), right});
  }
}

void PrintTallies(const std::string& name, const std::array<std::array<Tally, 2>, 2>& tallies) {
  const auto percent = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.1f} %", 100 * *value) : std::string("not reached");
  };
  for (const bool near_only : {false, true}) {
    for (const Method method : {Method::kOurs, Method::kOpenCv}) {
      const Tally& t = tallies[near_only ? 1 : 0][static_cast<std::size_t>(method)];
      fmt::print("| {} | {} | {} | {} | {:.1f} % | {} | {} | {:.1f} % |\n",
                 name,
                 near_only ? "near" : "whole image",
                 method == Method::kOurs ? "ours" : "OpenCV",
                 t.with_match,
                 100 * t.Right(),
                 percent(t.PrecisionAtRecall(&Nearest::distance)),
                 percent(t.PrecisionAtRecall(&Nearest::ratio)),
                 100 * t.AveragePrecision());
    }
  }
}

void AddAll(const View& a,
            const View& b,
            const std::vector<ExpectedLine>& expected,
            std::array<std::array<Tally, 2>, 2>* tallies) {
  for (const bool near_only : {false, true}) {
    for (const Method method : {Method::kOurs, Method::kOpenCv}) {
      Add(a.With(method),
          b.With(method),
          expected,
          near_only,
          &(*tallies)[near_only ? 1 : 0][static_cast<std::size_t>(method)]);
    }
  }
}

// The disparities of both ends of a left line from a dense disparity image: a straight line fitted
// robustly to the disparities beside the segment, on the nearer side of a step.
std::optional<std::array<double, 2>> EndDisparities(const cv::Mat& disparity,
                                                    const Segment2& segment) {
  constexpr int kSamples = 24;
  constexpr double kTolerance = 0.75;
  const Eigen::Vector2d d = segment.Direction();
  const Eigen::Vector2d normal(-d.y(), d.x());
  std::vector<Eigen::Vector2d> samples;  // place along the segment, disparity
  for (int i = 0; i < kSamples; ++i) {
    const double t = (i + 0.5) / kSamples;
    double most = 0;
    for (int across = -4; across <= 4; across += 2) {
      const Eigen::Vector2d px =
          segment.start + t * (segment.end - segment.start) + across * normal;
      const cv::Point pixel(cvRound(px.x()), cvRound(px.y()));
      if (!cv::Rect(0, 0, disparity.cols, disparity.rows).contains(pixel)) continue;
      most = std::max(most, disparity.at<std::int16_t>(pixel) / 16.0);
    }
    if (most > 1) samples.emplace_back(t, most);
  }
  std::array<double, 2> best{};
  std::size_t best_count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + samples.size() / 3 + 1; j < samples.size(); ++j) {
      const double slope = (samples[j].y() - samples[i].y()) / (samples[j].x() - samples[i].x());
      const double start = samples[i].y() - slope * samples[i].x();
      const auto count = static_cast<std::size_t>(
          std::count_if(samples.begin(), samples.end(), [&](const Eigen::Vector2d& s) {
            return std::abs(s.y() - start - slope * s.x()) < kTolerance;
          }));
      if (count <= best_count) continue;
      best_count = count;
      best = {start, start + slope};
    }
  }
  if (static_cast<double>(best_count) < 0.7 * kSamples || std::min(best[0], best[1]) < 1)
    return std::nullopt;
  return best;
}

// Stereo images of MH_01 with true poses of the rectified left camera.
class TrueStereo {
 public:
  explicit TrueStereo(const std::string& data)
      : dataset_(OpenDataset(data + "/" + kSequences[0].folder)),
        rectifier_(dataset_->calibration()),
        valid_(rectifier_.left_mask()),
        poses_(dataset_->info().ground_truth->OfCamera(dataset_->calibration())) {}

  std::size_t size() const { return dataset_->size(); }
  const ValidRegion& valid() const { return valid_; }

  std::optional<RectifiedFrame> Read(std::size_t i) const {
    auto frame = dataset_->Read(i);
    if (!frame) return std::nullopt;
    return rectifier_.Apply(std::move(*frame));
  }

  // Positions of the lines of frame i in frame j.
  std::vector<ExpectedLine> Project(const RectifiedFrame& frame,
                                    const std::vector<LineFeature>& lines,
                                    std::size_t i,
                                    std::size_t j) const {
    std::vector<ExpectedLine> expected(lines.size());
    const auto pose_i = WorldFromRectified(i);
    const auto pose_j = WorldFromRectified(j);
    if (!pose_i || !pose_j || !frame.right) return expected;
    const Rigid3 j_from_i = Inverse(*pose_j) * *pose_i;
    const cv::Mat disparity = Disparities(frame);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const auto ends = EndDisparities(disparity, lines[k].segment);
      if (!ends) continue;
      const auto start = Move(lines[k].segment.start, (*ends)[0], j_from_i);
      const auto end = Move(lines[k].segment.end, (*ends)[1], j_from_i);
      if (!start || !end) continue;
      expected[k].place = Segment2{*start, *end};
    }
    return expected;
  }

 private:
  std::optional<Rigid3> WorldFromRectified(std::size_t i) const {
    const auto pose = InterpolateAt(poses_, dataset_->stamp_ns(i), 100'000'000);
    if (!pose) return std::nullopt;
    const Rigid3 left_from_rectified(rectifier_.rectified_left_from_left().conjugate(),
                                     Eigen::Vector3d::Zero());
    return *pose * left_from_rectified;
  }

  static cv::Mat Disparities(const RectifiedFrame& frame) {
    constexpr int kDisparities = 128;
    constexpr int kWindow = 5;
    const auto matcher = cv::StereoSGBM::create(
        0, kDisparities, kWindow, 8 * kWindow * kWindow, 32 * kWindow * kWindow, 1, 0, 10, 100, 2);
    cv::Mat disparity;
    matcher->compute(AsMat(frame.left), AsMat(*frame.right), disparity);
    return disparity;
  }

  std::optional<Eigen::Vector2d> Move(const Eigen::Vector2d& px,
                                      double disparity,
                                      const Rigid3& to) const {
    const RectifiedCamera& camera = rectifier_.camera();
    const double depth = camera.fx * camera.baseline / disparity;
    const Eigen::Vector3d ray(
        (px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy, 1);
    const Eigen::Vector3d point = to * Eigen::Vector3d(depth * ray);
    if (point.z() < 0.1) return std::nullopt;
    const Eigen::Vector2d moved(camera.fx * point.x() / point.z() + camera.cx,
                                camera.fy * point.y() / point.z() + camera.cy);
    if (!valid_.Contains(moved, 4)) return std::nullopt;
    return moved;
  }

  std::unique_ptr<Dataset> dataset_;
  Rectifier rectifier_;
  ValidRegion valid_;
  Trajectory poses_;
};

void PrintReprojection(const std::string& data) {
  const TrueStereo stereo(data);
  constexpr SameLineLimits kLimits{3, 4, 0.5};
  double ours_ms = 0;
  double opencv_ms = 0;
  std::size_t lines = 0;
  for (const std::size_t apart : {std::size_t{1}, std::size_t{5}, std::size_t{10}}) {
    std::array<std::array<Tally, 2>, 2> tallies;
    for (std::size_t i = 5; i + apart < stereo.size(); i += 12) {
      const auto first = stereo.Read(i);
      const auto second = stereo.Read(i + apart);
      if (!first || !second) continue;
      const View a = Describe(first->left, stereo.valid());
      const View b = Describe(second->left, stereo.valid());
      auto expected = stereo.Project(*first, a.ours, i, i + apart);
      FindSame(b.ours, kLimits, &expected);
      AddAll(a, b, expected, &tallies);
      ours_ms += a.ours_ms + b.ours_ms;
      opencv_ms += a.opencv_ms + b.opencv_ms;
      lines += a.ours.size() + b.ours.size();
    }
    PrintTallies(fmt::format("MH_01, {} frames apart", apart), tallies);
  }
  fmt::print(
      "\nMicroseconds a line: ours {:.2f} (gradient excluded), OpenCV {:.2f} (with its own)\n\n",
      1e3 * ours_ms / static_cast<double>(lines),
      1e3 * opencv_ms / static_cast<double>(lines));
}

void PrintWarps(const std::string& data) {
  for (const Sequence& sequence : kSequences) {
    const auto images = ReadImages(data, sequence, 5);
    if (!images) continue;
    std::array<std::array<Tally, 2>, 2> tallies;
    const ValidRegion whole(images->mask);
    for (std::size_t i = 0; i < images->left.size(); ++i) {
      const GrayImage& image = images->left[i];
      const View a = Describe(image, whole);
      for (const KnownWarp& warp : KnownWarps(image.width(), image.height())) {
        const WarpedImage warped = WarpImage(image, images->mask, warp, i);
        const ValidRegion valid(warped.mask);
        const View b = Describe(warped.image, valid);
        auto expected = WarpLines(a.ours, warp, valid, 20);
        FindSame(b.ours, {}, &expected);
        AddAll(a, b, expected, &tallies);
      }
    }
    PrintTallies(fmt::format("{}, known warps", sequence.name), tallies);
  }
}

}  // namespace

void PrintDescriptorPrecision(const std::string& data) {
  fmt::print(
      "| pairs | candidates | descriptor | lines with a counterpart | nearest is right | "
      "precision at 90 % recall, by distance | by ratio | average precision "
      "|\n|---|---|---|---|---|---|---|---|\n");
  PrintWarps(data);
  PrintReprojection(data);
}

}  // namespace plumbline::bench
