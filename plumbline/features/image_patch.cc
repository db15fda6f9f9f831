// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/image_patch.h"

#include "plumbline/geometry/symmetric_matrix.h"

#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace plumbline {

std::optional<PatchSamples> SamplePatch(const GrayImage& image,
                                        const Eigen::Vector2d& centre,
                                        const Eigen::Matrix2d& axes,
                                        int radius) {
  const Eigen::Vector2d reach = radius * axes.cwiseAbs().rowwise().sum();
  if (!((centre - reach).minCoeff() >= 0) || !(centre.x() + reach.x() < image.width() - 1) ||
      !(centre.y() + reach.y() < image.height() - 1)) {
    return std::nullopt;
  }
  const int side = 2 * radius + 1;
  PatchSamples samples(side * side);
  Eigen::Index next = 0;
  for (int v = -radius; v <= radius; ++v) {
    for (int u = -radius; u <= radius; ++u) {
      const Eigen::Vector2d px = centre + axes * Eigen::Vector2d(u, v);
      const int x = static_cast<int>(px.x());
      const int y = static_cast<int>(px.y());
      const double fx = px.x() - x;
      const double fy = px.y() - y;
      const std::uint8_t* row = image.row(y) + x;
      const std::uint8_t* below = image.row(y + 1) + x;
      samples(next++) =
          (1 - fy) * ((1 - fx) * row[0] + fx * row[1]) + fy * ((1 - fx) * below[0] + fx * below[1]);
    }
  }
  return samples;
}

bool NormalizePatch(PatchSamples& samples) {
  samples -= samples.mean();
  const double length = samples.matrix().norm();
  if (!(length > std::sqrt(static_cast<double>(samples.size())))) return false;
  samples /= length;
  return true;
}

bool ImagePatch::IsRound(double min_roundness) const {
  const Eigen::Vector2d values = EigenvaluesOf<2>(tensor);
  return values(0) > min_roundness * values(1);
}

std::optional<ImagePatch> MakePatch(const PatchSamples& wide, int radius) {
  const int side = 2 * radius + 1;
  ImagePatch patch{radius, PatchSamples(side * side), {}, {}};
  patch.gradient.resize(side * side, 2);
  Eigen::Index next = 0;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u, ++next) {
      const Eigen::Index at = static_cast<Eigen::Index>(v + 1) * (side + 2) + u + 1;
      patch.samples(next) = wide(at);
      patch.gradient(next, 0) = (wide(at + 1) - wide(at - 1)) / 2;
      patch.gradient(next, 1) = (wide(at + side + 2) - wide(at - side - 2)) / 2;
    }
  }
  patch.samples -= patch.samples.mean();
  const double length = patch.samples.matrix().norm();
  PatchSamples normalized = patch.samples;
  if (!NormalizePatch(normalized)) return std::nullopt;
  patch.samples = normalized;
  patch.gradient /= length;
  const auto centred = (patch.gradient.rowwise() - patch.gradient.colwise().mean()).eval();
  patch.tensor = centred.transpose() * centred;
  return patch;
}

std::optional<PatchPlace> AlignShift(const ImagePatch& patch,
                                     const GrayImage& image,
                                     const Eigen::Vector2d& start,
                                     const Eigen::Matrix2d& axes,
                                     const PatchShiftLimits& limits) {
  const Eigen::LDLT<Eigen::Matrix2d> tensor(patch.tensor);
  const Eigen::Matrix2d inverse_axes = axes.inverse();
  Eigen::Vector2d px = start;
  for (int i = 0; i < limits.max_iterations; ++i) {
    auto seen = SamplePatch(image, px, axes, patch.radius);
    if (!seen || !NormalizePatch(*seen)) return std::nullopt;
    const double correlation = (*seen * patch.samples).sum();
    const Eigen::Vector2d step =
        tensor.solve(patch.gradient.transpose() * (*seen - patch.samples).matrix());
    px -= axes * step;
    const Eigen::Vector2d shift = inverse_axes * (px - start);
    if (shift.norm() > limits.max_shift_px) return std::nullopt;
    if (step.norm() > limits.converged_px) continue;
    if (correlation < limits.min_correlation) return std::nullopt;
    // Both patches have the length one, so that the sum of squared residuals is 2 - 2 *
    // correlation. Shift, brightness and contrast, four numbers, were estimated from the samples.
    constexpr double kEstimated = 4;
    const double variance =
        2 * (1 - correlation) / (static_cast<double>(patch.samples.size()) - kEstimated);
    return PatchPlace{px, shift, variance * tensor.solve(Eigen::Matrix2d::Identity())};
  }
  return std::nullopt;
}

}  // namespace plumbline
