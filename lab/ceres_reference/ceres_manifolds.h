// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>

#include <ceres/manifold.h>

// Manifolds of poses and lines for Ceres, the reference of tests and measurements.

namespace plumbline {

// A pose is seven numbers [qx qy qz qw tx ty tz], a line six: [qx qy qz qw w1 w2]. Readers
// normalize.
void WritePose(const Rigid3& pose, double* x);
Rigid3 ReadPose(const double* x);
void WriteLine(const OrthonormalLine& line, double* x);
OrthonormalLine ReadLine(const double* x);

// Of poses: Plus(x, delta) = exp(delta) x, delta = [w, v].
class LeftRigid3Manifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

// Of lines: Plus is RetractLeft() or Retract().
template <bool kLeft>
class LineManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 6; }
  int TangentSize() const override { return 4; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

using OrthonormalLineManifold = LineManifold<false>;
using LeftOrthonormalLineManifold = LineManifold<true>;

// The manifold for terms that write derivatives with respect to the tangent into the first columns
// of their Jacobian and zeros into the others: Ceres multiplies with [I; 0], which saves the
// product of two factors, of term and manifold.
template <class Base>
class TangentManifold final : public Base {
 public:
  bool PlusJacobian(const double*, double* jacobian) const override {
    return SetIdentity(this->TangentSize(), jacobian);
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    return SetIdentity(this->AmbientSize(), jacobian);
  }

 private:
  // Row major, ones on the diagonal.
  bool SetIdentity(int columns, double* jacobian) const {
    std::fill_n(jacobian, this->AmbientSize() * this->TangentSize(), 0.0);
    for (int i = 0; i < this->TangentSize(); ++i) jacobian[i * columns + i] = 1;
    return true;
  }
};

// TangentManifold<OrthonormalLineManifold> with RetractStraight() as Plus, the update of our own
// solver. For solving only: Minus is the inverse to first order.
class StraightLineManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 6; }
  int TangentSize() const override { return 4; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override {
    return tangent_.PlusJacobian(x, jacobian);
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    return tangent_.Minus(y, x, y_minus_x);
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    return tangent_.MinusJacobian(x, jacobian);
  }

 private:
  TangentManifold<OrthonormalLineManifold> tangent_;
};

}  // namespace plumbline
