// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/image_motion.h"

#include "plumbline/base/median.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {
namespace {

constexpr std::size_t kNearest = 7;
// Scale of the robust loss: from what turns and changes of scale do to a mere shift down to what is
// larger than the parallax that an affine map leaves, and smaller than the error of a wrong match.
constexpr std::array<double, 8> kScalesPx{160, 80, 40, 20, 10, 10, 10, 10};

Eigen::Vector2d MedianShift(std::span<const PixelPair> matches) {
  std::vector<double> x;
  std::vector<double> y;
  for (const PixelPair& m : matches) {
    x.push_back(m.to.x() - m.from.x());
    y.push_back(m.to.y() - m.from.y());
  }
  return {UpperMedian(std::move(x)), UpperMedian(std::move(y))};
}

}  // namespace

ImageMotion::ImageMotion(std::span<const PixelPair> matches) {
  if (matches.empty()) return;
  for (const PixelPair& m : matches) origin_ += m.from / static_cast<double>(matches.size());
  shift_ = origin_ + MedianShift(matches);
  for (const double scale : kScalesPx) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    for (const PixelPair& m : matches) {
      const double error = (Affine(m.from) - m.to).squaredNorm() / (scale * scale);
      const double weight = 1 / ((1 + error) * (1 + error));  // Geman-McClure
      const Eigen::Vector3d row = (m.from - origin_).homogeneous();
      normal += weight * row * row.transpose();
      right += weight * row * m.to.transpose();
    }
    const Eigen::LLT<Eigen::Matrix3d> factor(normal);
    if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-9)) break;
    const Eigen::Matrix<double, 3, 2> solution = factor.solve(right);
    linear_ = solution.topRows<2>().transpose();
    shift_ = solution.row(2).transpose();
  }
  for (const PixelPair& m : matches) {
    places_.push_back(m.from);
    leftovers_.emplace_back(m.to - Affine(m.from));
  }
}

Eigen::Vector2d ImageMotion::operator()(const Eigen::Vector2d& px) const {
  if (places_.size() < kNearest) return Affine(px);
  std::array<double, kNearest> distances;
  std::array<std::size_t, kNearest> nearest{};
  distances.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < places_.size(); ++i) {  // kept in order by insertion
    const double distance = (places_[i] - px).squaredNorm();
    if (!(distance < distances.back())) continue;
    std::size_t k = kNearest - 1;
    for (; k > 0 && distances[k - 1] > distance; --k) {
      distances[k] = distances[k - 1];
      nearest[k] = nearest[k - 1];
    }
    distances[k] = distance;
    nearest[k] = i;
  }
  std::array<double, kNearest> x;
  std::array<double, kNearest> y;
  for (std::size_t k = 0; k < kNearest; ++k) {
    x[k] = leftovers_[nearest[k]].x();
    y[k] = leftovers_[nearest[k]].y();
  }
  return Affine(px) + Eigen::Vector2d(UpperMedian(x), UpperMedian(y));
}

}  // namespace plumbline
