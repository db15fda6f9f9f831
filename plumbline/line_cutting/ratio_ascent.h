// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace plumbline {

struct RatioAscentOptions {
  int max_iterations = 100;
  // Largest remaining entry of the projected gradient.
  double gradient_tolerance = 1e-4;
  double step_tolerance = 1e-5;  // largest change of a ratio in the last iteration
};

template <int kSize>
struct RatioAscent {
  Eigen::Matrix<double, kSize, 1> ratios;
  double value = 0;
  int iterations = 0;
  bool converged = false;
};

// Finds a local maximum of a function of ratios in [0, 1] from `start`, by the spectral projected
// gradient method (Birgin, Martinez and Raydan 2000). Steps go along the gradient, clipped to the
// box; their length follows from the last change of the gradient (Barzilai and Borwein 1988). A
// step may lower the value, but not below the least of the last kMemory values: without this
// freedom such steps become slow on long ridges. Returns the best ratios visited, never worse than
// the start. `objective(ratios, gradient)` returns the value and sets the gradient. Deterministic.
template <int kSize, class Objective>
class RatioAscender {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;

  RatioAscender(const Objective& objective, const RatioAscentOptions& options)
      : objective_(objective), options_(options) {}

  RatioAscent<kSize> From(const Vector& start) {
    RatioAscent<kSize> found = Run(start, kMemory);
    if (at_.value >= found.value) return found;
    // The ascent has reached a lower maximum: it restarts from the best ratios, upwards only.
    const int before = found.iterations;
    found = Run(found.ratios, 1);
    found.iterations += before;
    return found;
  }

 private:
  static constexpr std::size_t kMemory = 6;
  static constexpr double kArmijo = 1e-4, kShortest = 1e-6, kLongest = 1e4;

  struct Point {
    Vector ratios, gradient;
    double value = 0;
  };

  static Vector Clip(const Vector& ratios) { return ratios.cwiseMax(0.0).cwiseMin(1.0); }
  static double Greatest(const Vector& v) { return v.template lpNorm<Eigen::Infinity>(); }

  RatioAscent<kSize> Run(const Vector& start, std::size_t memory) {
    at_.ratios = at_.gradient = start;
    at_.value = objective_(at_.ratios, at_.gradient);
    std::array<double, kMemory> recent;
    recent.fill(at_.value);
    RatioAscent<kSize> best{start, at_.value};
    if (!std::isfinite(at_.value)) return best;
    double length = 0.1 / std::max(1e-12, Greatest(at_.gradient));
    while (best.iterations < options_.max_iterations && !best.converged) {
      best.converged =
          Greatest(Clip(at_.ratios + at_.gradient) - at_.ratios) < options_.gradient_tolerance;
      const Point before = at_;
      if (best.converged || !Step(length, *std::min_element(recent.begin(), recent.end()))) break;
      ++best.iterations;
      recent[static_cast<std::size_t>(best.iterations) % memory] = at_.value;
      if (memory == 1) recent.fill(at_.value);
      if (at_.value > best.value) best = {at_.ratios, at_.value, best.iterations};
      const Vector step = at_.ratios - before.ratios;
      best.converged = Greatest(step) < options_.step_tolerance;
      const double curvature = step.dot(before.gradient - at_.gradient);
      length =
          curvature > 0 ? std::clamp(step.squaredNorm() / curvature, 1e-8, kLongest) : kLongest;
    }
    return best;
  }

  // Returns false if no part of the step is good enough. `least` is the lowest allowed value.
  bool Step(double length, double least) {
    const Vector direction = Clip(at_.ratios + length * at_.gradient) - at_.ratios;
    const double slope = at_.gradient.dot(direction);
    Point next{at_.ratios, at_.gradient};
    for (double part = 1; part > kShortest;) {
      next.ratios = at_.ratios + part * direction;
      next.value = objective_(next.ratios, next.gradient);
      if (next.value >= least + kArmijo * part * slope) {
        at_ = next;
        return true;
      }
      // Maximum of the parabola through both values and the slope, kept away from both ends.
      const double best = 0.5 * part * part * slope / (at_.value + part * slope - next.value);
      part = std::isfinite(best) ? std::clamp(best, 0.1 * part, 0.5 * part) : 0.1 * part;
    }
    return false;
  }

  const Objective& objective_;
  RatioAscentOptions options_;
  Point at_;
};

template <int kSize, class Objective>
RatioAscent<kSize> Ascend(const Objective& objective,
                          const Eigen::Matrix<double, kSize, 1>& start,
                          const RatioAscentOptions& options = {}) {
  return RatioAscender<kSize, Objective>(objective, options).From(start);
}

}  // namespace plumbline
