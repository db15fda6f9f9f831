// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/chi2.h"
#include "plumbline/solvers/epipolar_cost.h"
#include "plumbline/solvers/essential.h"
#include "plumbline/solvers/homography.h"
#include "plumbline/solvers/ray_match.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Two-view problems for RANSAC (ransac.h). They refer to the matches, which must outlive them.

// Essential matrices, Frobenius norm 1, from samples of five.
class EssentialProblem {
 public:
  using Model = Eigen::Matrix3d;

  explicit EssentialProblem(std::span<const RayMatch> matches);

  std::size_t size() const { return matches_.size(); }
  double Cost(const Model& E, double limit) const {
    return cost_.Truncated(E, kChi2OneDof95, limit);
  }
  double InlierRatio(const Model& E) const;
  // Improves E by a few steps of RefinePose under a wide loss.
  Model Improve(const Model& E) const;
  // Returns true if both are equal up to sign.
  bool Same(const Model& E, const Model& F) const;

 protected:
  std::span<const RayMatch> matches_;

 private:
  EpipolarCost cost_;
  std::vector<RayMatch> thinned_;  // subset of the matches, enough to come near the solution
};

class FivePointProblem : public EssentialProblem {
 public:
  static constexpr std::size_t kSampleSize = 5;
  using EssentialProblem::EssentialProblem;
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const;
};

class EightPointProblem : public EssentialProblem {
 public:
  static constexpr std::size_t kSampleSize = 8;
  using EssentialProblem::EssentialProblem;
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const;
};

class HomographyProblem {
 public:
  using Model = Eigen::Matrix3d;
  static constexpr std::size_t kSampleSize = 4;

  explicit HomographyProblem(std::span<const RayMatch> matches);

  std::size_t size() const { return matches_.size(); }
  std::vector<Model> Solve(const std::array<std::size_t, kSampleSize>& sample) const;
  double Cost(const Model& H, double limit) const;
  double InlierRatio(const Model& H) const;
  // Improves H by least squares on the inliers.
  Model Improve(const Model& H) const;
  bool Same(const Model&, const Model&) const { return true; }  // only the best model is kept

  Eigen::Vector3d MeanRay() const { return mean_ray_; }  // mean ray of camera a

 private:
  std::span<const RayMatch> matches_;
  Eigen::Vector3d mean_ray_ = Eigen::Vector3d::UnitZ();
};

}  // namespace plumbline
