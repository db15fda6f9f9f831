// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures the line front end on recorded images; prints Markdown tables:
//
//   line_front_end detectors DATA [NAME]   time, lines, repeatability, accuracy of every detector
//   line_front_end descriptors DATA        time and matching precision of our LBD and OpenCV's
//   line_front_end speed DATA              time of each step with up to 300 lines, matching
//   included line_front_end draw DATA OUT           pictures of the lines
//
// DATA holds the sequences of kSequences; those that are missing are left out.
#include "lab/bench/descriptor_precision.h"
#include "lab/bench/line_correspondence.h"
#include "lab/bench/run_bench.h"
#include "lab/bench/sequence_images.h"
#include "plumbline/base/error.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline::bench {
namespace {

constexpr int kImages = 20;
constexpr int kLines = 200;

struct DetectorSetting {
  LineDetector detector;
  const char* name;
  double scale;
};

constexpr std::array kSettings{DetectorSetting{LineDetector::kDrawing, "drawing", 1},
                               DetectorSetting{LineDetector::kDrawing, "drawing", 0.5},
                               DetectorSetting{LineDetector::kLsd, "lsd", 1},
                               DetectorSetting{LineDetector::kLsd, "lsd", 0.5},
                               DetectorSetting{LineDetector::kEdlines, "edlines", 1},
                               DetectorSetting{LineDetector::kEdlines, "edlines", 0.5}};

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<LineFeature> FrontEnd(const GrayImage& image,
                                  const ValidRegion& valid,
                                  const DetectorSetting& setting) {
  LineDetectionOptions options;
  options.detection_scale = setting.scale;
  const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
  auto lines = DetectLines(image, gradient, valid, setting.detector, kLines, options);
  DescribeLines(gradient, &lines);
  return lines;
}

struct DetectorScore {
  std::vector<double> milliseconds;
  double lines = 0;
  double length = 0;
  int expected = 0;
  int repeated = 0;
  std::vector<double> errors;
};

void ScoreWarps(const SequenceImages& images,
                std::size_t index,
                const std::vector<LineFeature>& lines,
                const DetectorSetting& setting,
                DetectorScore* score) {
  const GrayImage& image = images.left[index];
  const double min_length =
      1.1 * LineDetectionOptions{}.min_length * std::max(image.width(), image.height());
  for (const KnownWarp& warp : KnownWarps(image.width(), image.height())) {
    const WarpedImage warped = WarpImage(image, images.mask, warp, index);
    const ValidRegion valid(warped.mask);
    const auto found = FrontEnd(warped.image, valid, setting);
    auto expected = WarpLines(lines, warp, valid, min_length);
    FindSame(found, {}, &expected);
    for (const ExpectedLine& line : expected) {
      if (!line.place) continue;
      ++score->expected;
      if (line.same.empty()) continue;
      ++score->repeated;
      double least = 1e9;
      for (const int j : line.same) {
        const auto across =
            AcrossDistances(*line.place, found[static_cast<std::size_t>(j)].segment);
        least = std::min(least, std::hypot((*across)[0], (*across)[1]) / std::sqrt(2.0));
      }
      score->errors.push_back(least);
    }
  }
}

DetectorScore Score(const SequenceImages& images, const DetectorSetting& setting) {
  DetectorScore score;
  const ValidRegion valid(images.mask);
  for (std::size_t i = 0; i < images.left.size(); ++i) {
    FrontEnd(images.left[i], valid, setting);  // warm
    const double start = CpuMilliseconds();
    const auto lines = FrontEnd(images.left[i], valid, setting);
    score.milliseconds.push_back(CpuMilliseconds() - start);
    score.lines += static_cast<double>(lines.size()) / static_cast<double>(images.left.size());
    for (const LineFeature& l : lines) {
      score.length += l.segment.Length() / static_cast<double>(images.left.size());
    }
    if (i % 4 == 0) ScoreWarps(images, i, lines, setting, &score);
  }
  return score;
}

void Detectors(const std::string& data, const std::string& only) {
  fmt::print(
      "| sequence | detector | scale | CPU ms | lines | mean length px | repeated | "
      "error px, median | error px, RMS |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Sequence& sequence : kSequences) {
    const auto images = ReadImages(data, sequence, kImages);
    if (!images) continue;
    for (const DetectorSetting& setting : kSettings) {
      if (!only.empty() && only != setting.name) continue;
      const DetectorScore s = Score(*images, setting);
      const double squares =
          std::inner_product(s.errors.begin(), s.errors.end(), s.errors.begin(), 0.0);
      fmt::print("| {} | {} | {} | {:.2f} | {:.0f} | {:.0f} | {:.1f} % | {:.3f} | {:.3f} |\n",
                 sequence.name,
                 setting.name,
                 setting.scale,
                 Median(s.milliseconds),
                 s.lines,
                 s.length / std::max(1.0, s.lines),
                 100.0 * s.repeated / std::max(1, s.expected),
                 Median(s.errors),
                 std::sqrt(squares / std::max<double>(1, static_cast<double>(s.errors.size()))));
      std::fflush(stdout);
    }
  }
}

// Steps of the front end of one image, the last one with the lines of the image before it.
enum Step { kGradient, kDetection, kDescription, kMatching, kSteps };

struct StepTimes {
  std::array<std::vector<double>, kSteps + 1> milliseconds;  // the last: all together
  double lines = 0, matches = 0;
};

StepTimes TimeSteps(const SequenceImages& images, double min_length) {
  constexpr int kMostLines = 300;
  constexpr int kRepetitions = 5;
  const ValidRegion valid(images.mask);
  LineDetectionOptions options;
  options.min_length = min_length;
  StepTimes times;
  std::vector<LineFeature> before;
  for (const GrayImage& image : images.left) {
    std::array<double, kSteps + 1> best;
    best.fill(1e9);
    std::vector<LineFeature> lines;
    std::size_t matches = 0;
    for (int k = 0; k < kRepetitions; ++k) {
      std::array<double, kSteps + 1> at{CpuMilliseconds()};
      const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
      at[1] = CpuMilliseconds();
      lines = DetectLines(image, gradient, valid, LineDetector::kDrawing, kMostLines, options);
      at[2] = CpuMilliseconds();
      DescribeLines(gradient, &lines);
      at[3] = CpuMilliseconds();
      matches = MatchLines(before, lines, LineMatchOptions{}).size();
      at[4] = CpuMilliseconds();
      for (std::size_t i = 0; i < kSteps; ++i) best[i] = std::min(best[i], at[i + 1] - at[i]);
      best[kSteps] = std::min(best[kSteps], at[kSteps] - at[0]);
    }
    for (std::size_t i = 0; i <= kSteps; ++i) times.milliseconds[i].push_back(best[i]);
    times.lines += static_cast<double>(lines.size()) / static_cast<double>(images.left.size());
    times.matches += static_cast<double>(matches) / static_cast<double>(images.left.size());
    before = std::move(lines);
  }
  return times;
}

// The best of five of each image, median over the images: the time on a quiet machine.
void Speed(const std::string& data) {
  fmt::print(
      "| sequence | shortest line, of the width | lines | matches | gradient | detection | "
      "description | matching | all, ms |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Sequence& sequence : kSequences) {
    const auto images = ReadImages(data, sequence, kImages);
    if (!images) continue;
    for (const double min_length : {LineDetectionOptions{}.min_length, 0.02}) {
      const StepTimes times = TimeSteps(*images, min_length);
      fmt::print(
          "| {} | {} | {:.0f} | {:.0f} |", sequence.name, min_length, times.lines, times.matches);
      for (const auto& step : times.milliseconds) fmt::print(" {:.2f} |", Median(step));
      fmt::print("\n");
      std::fflush(stdout);
    }
  }
}

void Draw(const std::string& data, const std::string& out) {
  for (const Sequence& sequence : kSequences) {
    const auto images = ReadImages(data, sequence, 3);
    if (!images) continue;
    const GrayImage& image = images->left[1];
    for (const DetectorSetting& setting : kSettings) {
      cv::Mat canvas;
      cv::cvtColor(AsMat(image), canvas, cv::COLOR_GRAY2BGR);
      cv::resize(canvas, canvas, {}, 2, 2, cv::INTER_NEAREST);
      int color = 0;
      for (const LineFeature& l : FrontEnd(image, ValidRegion(images->mask), setting)) {
        const auto at = [](const Eigen::Vector2d& px) {
          return cv::Point(cvRound((2 * px.x() + 0.5) * 16), cvRound((2 * px.y() + 0.5) * 16));
        };
        color += 67;
        cv::line(canvas,
                 at(l.segment.start),
                 at(l.segment.end),
                 cv::Scalar(50 + color % 205, 50 + color * 5 % 205, 50 + color * 11 % 205),
                 2,
                 cv::LINE_AA,
                 4);
      }
      cv::imwrite(fmt::format("{}/{}_{}_{}.png", out, sequence.name, setting.name, setting.scale),
                  canvas);
    }
  }
}

void Main(const std::vector<std::string>& arguments) {
  cv::setNumThreads(1);
  if ((arguments.size() == 2 || arguments.size() == 3) && arguments[0] == "detectors") {
    Detectors(arguments[1], arguments.size() == 3 ? arguments[2] : "");
  } else if (arguments.size() == 2 && arguments[0] == "descriptors") {
    PrintDescriptorPrecision(arguments[1]);
  } else if (arguments.size() == 2 && arguments[0] == "speed") {
    Speed(arguments[1]);
  } else if (arguments.size() == 3 && arguments[0] == "draw") {
    Draw(arguments[1], arguments[2]);
  } else {
    throw InputError(
        "expected detectors DATA [NAME] | descriptors DATA | speed DATA | draw DATA OUT");
  }
}

}  // namespace
}  // namespace plumbline::bench

int main(int argc, char** argv) {
  return plumbline::bench::RunBench("line_front_end", [&] {
    plumbline::bench::Main({argv + 1, argv + argc});
  });
}
