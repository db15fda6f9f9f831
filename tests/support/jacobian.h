// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include <Eigen/Core>

namespace plumbline {

// Derivative of f: R^n -> R^m (fixed sizes) at x by central differences. With functions of size 1
// and the default step the error is about 1e-10; five points allow a large step.
template <class Function, int kInputs>
auto NumericJacobian(const Function& f,
                     const Eigen::Matrix<double, kInputs, 1>& x,
                     double step = 1e-3) {
  using Output = typename std::decay_t<decltype(f(x))>::PlainObject;
  constexpr int kOutputs = Output::RowsAtCompileTime;
  Eigen::Matrix<double, kOutputs, kInputs> J;
  for (int i = 0; i < kInputs; ++i) {
    const auto at = [&](double offset) -> Output {
      Eigen::Matrix<double, kInputs, 1> moved = x;
      moved(i) += offset;
      return f(moved);
    };
    J.col(i) = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
  }
  return J;
}

}  // namespace plumbline
