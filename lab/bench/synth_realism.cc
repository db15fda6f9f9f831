// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the images of rendered and recorded sequences: detected and matched features, gradients,
// spectrum, brightness, noise. Prints a Markdown table.
//
//   synth_realism FOLDER[=CAMERA]...
//
// CAMERA is the name or file of a camera if the folder has none.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/orb.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline::bench {
namespace {

constexpr std::size_t kPairs = 12;
constexpr int kAll = 20'000;  // features asked for: more than there are
constexpr double kPixels = 1e5;

// Sums over the images of a sequence; Mean divides.
struct Numbers {
  int images = 0, pairs = 0;
  double corners = 0, lines = 0, long_lines = 0;  // for 100 000 pixels
  double corners_again = 0, lines_again = 0;      // share found again in the next image
  std::array<double, 4> gradients{};              // grey levels per pixel, see kShares
  double slope = 0, mean = 0, deviation = 0, noise = 0;
};
constexpr std::array kShares{0.5, 0.9, 0.99, 0.999};

double Quantile(std::vector<float> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return static_cast<double>(*place);
}

// Share of the features of `a` whose best match in `b` has them as its best match.
template <class Feature, class Near>
double ShareFoundAgain(const std::vector<Feature>& a,
                       const std::vector<Feature>& b,
                       int max_distance,
                       const Near& near) {
  if (a.empty()) return 0;
  const auto best = [&](const Feature& feature, const std::vector<Feature>& others) {
    std::optional<std::size_t> index;
    int least = max_distance + 1;
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (!near(feature, others[i])) continue;
      const int distance = HammingDistance(feature.descriptor, others[i].descriptor);
      if (distance >= least) continue;
      least = distance;
      index = i;
    }
    return index;
  };
  int found = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto there = best(a[i], b);
    if (there && best(b[*there], a) == i) ++found;
  }
  return static_cast<double>(found) / static_cast<double>(a.size());
}

struct ImageFeatures {
  std::vector<PointFeature> corners;
  std::vector<LineFeature> lines;
};

ImageFeatures FindFeatures(const GrayImage& image, const ValidRegion& valid) {
  ImageFeatures features;
  OrbOptions orb;
  orb.fast_min_threshold = kCornerContrast;  // the same demand everywhere
  features.corners = ExtractOrb(BuildOrbPyramid(image, orb), valid, kAll, orb);
  const GradientImage gradient = ComputeGradient(image, kLineBlurPx);
  features.lines = DetectLines(image, gradient, valid, LineDetector::kDrawing, kAll, {});
  DescribeLines(gradient, &features.lines);
  return features;
}

void AddFoundAgain(const ImageFeatures& a, const ImageFeatures& b, Numbers* numbers) {
  constexpr double kReachPx = 60, kTurn = 10 * std::numbers::pi / 180;
  constexpr int kPointDistance = 64, kLineDistance = 80;
  numbers->corners_again += ShareFoundAgain(
      a.corners, b.corners, kPointDistance, [](const PointFeature& p, const PointFeature& q) {
        return (p.px - q.px).norm() < kReachPx;
      });
  numbers->lines_again += ShareFoundAgain(
      a.lines, b.lines, kLineDistance, [](const LineFeature& p, const LineFeature& q) {
        return (p.segment.Midpoint() - q.segment.Midpoint()).norm() < kReachPx &&
               UndirectedAngle(p.segment.Direction(), q.segment.Direction()) < kTurn;
      });
  ++numbers->pairs;
}

// Exponent of the power spectrum over frequency, averaged over directions: a straight line through
// log power over log frequency between 0.02 and 0.25 cycles per pixel.
double SpectrumSlope(const cv::Mat& image) {
  const int size = std::min(image.rows, image.cols) / 2 * 2;
  cv::Mat part =
      image(cv::Rect((image.cols - size) / 2, (image.rows - size) / 2, size, size)).clone();
  part -= cv::mean(part)[0];
  cv::Mat window;
  cv::createHanningWindow(window, part.size(), CV_32F);
  part = part.mul(window);
  cv::Mat spectrum;
  cv::dft(part, spectrum, cv::DFT_COMPLEX_OUTPUT);
  constexpr int kBins = 24;
  constexpr double kLow = 0.02, kHigh = 0.25;
  std::array<double, kBins> power{}, count{};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double fx = static_cast<double>(x <= size / 2 ? x : x - size) / size;
      const double fy = static_cast<double>(y <= size / 2 ? y : y - size) / size;
      const double f = std::hypot(fx, fy);
      if (f < kLow || f >= kHigh) continue;
      const auto bin =
          static_cast<std::size_t>(kBins * std::log(f / kLow) / std::log(kHigh / kLow));
      const auto value = spectrum.at<cv::Vec2f>(y, x);
      power[bin] += static_cast<double>(value[0] * value[0] + value[1] * value[1]);
      ++count[bin];
    }
  }
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (count[i] == 0 || power[i] == 0) continue;
    const double x = std::log(kHigh / kLow) * (static_cast<double>(i) + 0.5) / kBins;
    const double y = std::log(power[i] / count[i]);
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// Standard deviation of the noise in the flattest parts of the image: of 8 x 8 blocks, by the mean
// size of a filter that removes planes and parabolas (Immerkaer, CVIU 1996), the lowest tenth.
// Blocks near black or white are left out.
double NoiseLevel(const cv::Mat& image) {
  const cv::Mat kernel = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat filtered;
  cv::filter2D(image, filtered, CV_32F, kernel);
  filtered = cv::abs(filtered);
  constexpr int kBlock = 8;
  std::vector<float> levels;
  for (int y = kBlock; y + 2 * kBlock <= image.rows; y += kBlock) {
    for (int x = kBlock; x + 2 * kBlock <= image.cols; x += kBlock) {
      const cv::Rect block(x, y, kBlock, kBlock);
      const double brightness = cv::mean(image(block))[0];
      if (brightness < 25 || brightness > 230) continue;
      levels.push_back(
          static_cast<float>(std::sqrt(std::numbers::pi / 2) / 6 * cv::mean(filtered(block))[0]));
    }
  }
  return levels.empty() ? 0 : Quantile(std::move(levels), 0.1);
}

void AddImage(const GrayImage& image, Numbers* numbers) {
  cv::Mat values;
  AsMat(image).convertTo(values, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(values, mean, deviation);
  numbers->mean += mean[0];
  numbers->deviation += deviation[0];
  numbers->slope += SpectrumSlope(values);
  numbers->noise += NoiseLevel(values);
  cv::Mat dx, dy, size;
  const cv::Mat across = (cv::Mat_<float>(1, 3) << -0.5, 0, 0.5);
  cv::filter2D(values, dx, CV_32F, across);
  cv::filter2D(values, dy, CV_32F, across.t());
  cv::magnitude(dx, dy, size);
  const std::vector<float> sizes(size.begin<float>(), size.end<float>());
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    numbers->gradients[i] += Quantile(sizes, kShares[i]);
  }
  ++numbers->images;
}

Numbers Measure(const Dataset& dataset) {
  const Rectifier rectifier(dataset.calibration());
  const ValidRegion valid(rectifier.left_mask());
  Numbers numbers;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const std::size_t frame = (2 * i + 1) * (dataset.size() - 1) / (2 * kPairs);
    std::vector<ImageFeatures> features;
    for (const std::size_t k : {frame, frame + 1}) {
      auto read = dataset.Read(k);
      if (!read) continue;
      if (k == frame) AddImage(read->left, &numbers);
      const GrayImage image = rectifier.Apply(std::move(*read)).left;
      features.push_back(FindFeatures(image, valid));
      if (k != frame) continue;
      const double area = static_cast<double>(image.width()) * image.height() / kPixels;
      numbers.corners += static_cast<double>(features[0].corners.size()) / area;
      numbers.lines += static_cast<double>(features[0].lines.size()) / area;
      numbers.long_lines += static_cast<double>(std::count_if(features[0].lines.begin(),
                                                              features[0].lines.end(),
                                                              [](const LineFeature& line) {
                                                                return line.segment.Length() > 60;
                                                              })) /
                            area;
    }
    if (features.size() == 2) AddFoundAgain(features[0], features[1], &numbers);
  }
  return numbers;
}

void PrintHeader() {
  fmt::print(
      "| sequence | corners | lines | > 60 px | corners again | lines again | gradient 50 % | 90 % "
      "| 99 % | 99.9 % | spectrum | mean | deviation | noise |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void Print(const std::string& name, const Numbers& numbers) {
  const double n = std::max(1, numbers.images), pairs = std::max(1, numbers.pairs);
  fmt::print(
      "| {} | {:.0f} | {:.1f} | {:.1f} | {:.0f} % | {:.0f} % | {:.1f} | {:.1f} | {:.0f} | {:.0f} | "
      "{:.2f} | {:.0f} | {:.0f} | {:.1f} |\n",
      name,
      numbers.corners / n,
      numbers.lines / n,
      numbers.long_lines / n,
      100 * numbers.corners_again / pairs,
      100 * numbers.lines_again / pairs,
      numbers.gradients[0] / n,
      numbers.gradients[1] / n,
      numbers.gradients[2] / n,
      numbers.gradients[3] / n,
      numbers.slope / n,
      numbers.mean / n,
      numbers.deviation / n,
      numbers.noise / n);
  std::fflush(stdout);
}

void Main(const std::vector<std::string>& arguments) {
  cv::setNumThreads(1);
  if (arguments.empty()) throw InputError("expected FOLDER[=CAMERA]...");
  PrintHeader();
  for (const std::string& argument : arguments) {
    const std::size_t equals = argument.find('=');
    DatasetOptions options;
    if (equals != std::string::npos) options.camera = argument.substr(equals + 1);
    const auto dataset = OpenDataset(argument.substr(0, equals), options);
    if (dataset->size() < 2) throw InputError(argument + ": expected two images, found fewer");
    Print(dataset->info().name, Measure(*dataset));
  }
}

}  // namespace
}  // namespace plumbline::bench

int main(int argc, char** argv) {
  return plumbline::bench::RunBench("synth_realism", [&] {
    plumbline::bench::Main({argv + 1, argv + argc});
  });
}
