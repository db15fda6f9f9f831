// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_terms.h"

#include "lab/line_rivals/ba_rival_lines.h"
#include "plumbline/base/error.h"
#include "plumbline/optimization/ba_terms.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <ceres/autodiff_cost_function.h>
#include <ceres/sized_cost_function.h>

namespace plumbline {
namespace {

Eigen::Matrix3d Rotation(const double* pose) {
  return Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(pose)).toRotationMatrix();
}

// Writes the tangent's derivative in front of zeros.
template <int kRows, int kColumns, class Derived>
void WriteTangent(const Eigen::MatrixBase<Derived>& J, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>> out(jacobian);
  constexpr int kTangent = Derived::ColsAtCompileTime;
  out.template leftCols<kTangent>() = J;
  out.template rightCols<kColumns - kTangent>().setZero();
}

template <int kRows>
Eigen::Matrix<double, kRows, 3> CameraDerivative(const PointLinearization& a) {
  Eigen::Matrix<double, kRows, 3> J;
  if constexpr (kRows == 3) {
    J << a.ux, 0, a.uz, 0, a.vy, a.vz, 0, 0, a.dz;
  } else {
    J << a.ux, 0, a.uz, 0, a.vy, a.vz;
  }
  return J;
}

// J_cam [-[p]x, I].
template <int kRows>
Eigen::Matrix<double, kRows, 6> PoseDerivative(const Eigen::Matrix<double, kRows, 3>& J_cam,
                                               const Eigen::Vector3d& p) {
  Eigen::Matrix<double, kRows, 6> J;
  J << -J_cam * Skew(p), J_cam;
  return J;
}

template <int kRows>
class AnalyticPointCost final : public ceres::SizedCostFunction<kRows, 7, 3> {
 public:
  AnalyticPointCost(const RectifiedCamera& camera, const PointMeasurement& measurement)
      : camera_(camera), term_(MakePointTerm(measurement)) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Matrix3d R = Rotation(x[0]);
    const Eigen::Vector3d p =
        R * Eigen::Map<const Eigen::Vector3d>(x[1]) + Eigen::Map<const Eigen::Vector3d>(x[0] + 4);
    PointLinearization a;
    if (!LinearizePoint(camera_, term_, p, a)) return false;
    std::copy_n(a.r.data(), kRows, residuals);
    if (jacobians == nullptr) return true;
    const Eigen::Matrix<double, kRows, 3> J_cam = CameraDerivative<kRows>(a);
    if (jacobians[0] != nullptr) {
      WriteTangent<kRows, 7>(PoseDerivative<kRows>(J_cam, p), jacobians[0]);
    }
    if (jacobians[1] != nullptr) WriteTangent<kRows, 3>(J_cam * R, jacobians[1]);
    return true;
  }

 private:
  RectifiedCamera camera_;
  PointTerm term_;
};

template <int kRows>
class PosePointCost final : public ceres::SizedCostFunction<kRows, 7> {
 public:
  PosePointCost(const RectifiedCamera& camera, const PoseProblem::PointMatch& match)
      : camera_(camera), term_(MakePointTerm(match.measurement)), point_(match.point_in_world) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Vector3d p = Rotation(x[0]) * point_ + Eigen::Map<const Eigen::Vector3d>(x[0] + 4);
    PointLinearization a;
    if (!LinearizePoint(camera_, term_, p, a)) return false;
    std::copy_n(a.r.data(), kRows, residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    WriteTangent<kRows, 7>(PoseDerivative<kRows>(CameraDerivative<kRows>(a), p), jacobians[0]);
    return true;
  }

 private:
  RectifiedCamera camera_;
  PointTerm term_;
  Eigen::Vector3d point_;
};

// A line in the camera that measured it.
struct LineInCamera {
  Eigen::Matrix3d R;
  Eigen::Vector3d t, direction, moment;

  LineInCamera(const double* pose, const LineTerm& term, const BaLinePlace& line)
      : R(Rotation(pose)),
        t(pose[4] + term.shift, pose[5], pose[6]),
        direction(R * line.direction),
        moment(R * line.moment + t.cross(direction)) {}

  Eigen::Matrix<double, 2, 6> PoseDerivative(const LineLinearization& a, double shift) const {
    Eigen::Matrix<double, 2, 6> J;
    J << LinePoseRow(a.h0, moment, direction, shift).transpose(),
        LinePoseRow(a.h1, moment, direction, shift).transpose();
    return J;
  }
  // With respect to moment and direction in the world (eq. 18).
  Eigen::Matrix<double, 2, 6> LineDerivative(const LineLinearization& a) const {
    Eigen::Matrix<double, 2, 6> J;
    J << a.h0.transpose() * R, a.h0.cross(t).transpose() * R, a.h1.transpose() * R,
        a.h1.cross(t).transpose() * R;
    return J;
  }
};

// The six numbers of a line as the state of its kind.
OrthonormalLine ReadState(const double* x, std::type_identity<OrthonormalLine>) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)),
          Eigen::Map<const Eigen::Vector2d>(x + 4)};
}
Segment3 ReadState(const double* x, std::type_identity<Segment3>) {
  return {Eigen::Map<const Eigen::Vector3d>(x), Eigen::Map<const Eigen::Vector3d>(x + 3)};
}

// Kind: BaLine, BaLineLeft or BaLineEnds.
template <class Kind>
class AnalyticLineCost final : public ceres::SizedCostFunction<2, 7, 6> {
 public:
  AnalyticLineCost(const RectifiedCamera& camera, const LineMeasurement& measurement)
      : camera_(camera), term_(MakeLineTerm(camera, measurement)) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const auto state = ReadState(x[1], std::type_identity<typename Kind::State>{});
    const LineInCamera line(x[0], term_, Kind::MakePlace(state));
    LineLinearization a;
    if (!LinearizeLine(camera_, term_, line.moment, a)) return false;
    std::copy_n(a.r.data(), 2, residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      WriteTangent<2, 7>(line.PoseDerivative(a, term_.shift), jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      WriteTangent<2, 6>(line.LineDerivative(a) * Kind::MakeView(state).J, jacobians[1]);
    }
    return true;
  }

 private:
  RectifiedCamera camera_;
  LineTerm term_;
};

class PoseLineCost final : public ceres::SizedCostFunction<2, 7> {
 public:
  PoseLineCost(const RectifiedCamera& camera, const PoseProblem::LineMatch& match)
      : camera_(camera),
        term_(MakeLineTerm(camera, match.measurement)),
        line_{match.line_in_world.moment, match.line_in_world.direction} {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const LineInCamera line(x[0], term_, line_);
    LineLinearization a;
    if (!LinearizeLine(camera_, term_, line.moment, a)) return false;
    std::copy_n(a.r.data(), 2, residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    WriteTangent<2, 7>(line.PoseDerivative(a, term_.shift), jacobians[0]);
    return true;
  }

 private:
  RectifiedCamera camera_;
  LineTerm term_;
  BaLinePlace line_;
};

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Eigen::Quaternion<T> ReadQuaternion(const T* x) {
  return Eigen::Quaternion<T>(x[3], x[0], x[1], x[2]);
}

template <int kRows>
struct PointFunctor {
  RectifiedCamera camera;
  PointMeasurement m;

  template <class T>
  bool operator()(const T* pose, const T* point, T* r) const {
    const Vector3<T> p = ReadQuaternion(pose) * Vector3<T>(point[0], point[1], point[2]) +
                         Vector3<T>(pose[4], pose[5], pose[6]);
    if (p.z() < T(kMinDepth)) return false;
    r[0] = (m.px.x() - (camera.fx * p.x() / p.z() + camera.cx)) / m.sigma_px;
    r[1] = (m.px.y() - (camera.fy * p.y() / p.z() + camera.cy)) / m.sigma_px;
    if constexpr (kRows == 3) {
      r[2] = (m.disparity->px - camera.fx * camera.baseline / p.z()) / m.disparity->sigma_px;
    }
    return true;
  }
};

// Two points on a line given by its six numbers.
template <class T>
std::pair<Vector3<T>, Vector3<T>> PointsOf(const T* line, LineParametrization parametrization) {
  if (parametrization == LineParametrization::kEndpoints) {
    return {Vector3<T>(line[0], line[1], line[2]), Vector3<T>(line[3], line[4], line[5])};
  }
  const Eigen::Quaternion<T> U = ReadQuaternion(line);
  const Vector3<T> moment = (U * Vector3<T>(T(1), T(0), T(0))) * line[4];
  const Vector3<T> direction = (U * Vector3<T>(T(0), T(1), T(0))) * line[5];
  const Vector3<T> foot = direction.cross(moment) / direction.squaredNorm();
  return {foot, foot + direction};
}

// The projected line through the images of two points of the 3D line, instead of by its moment.
struct LineFunctor {
  RectifiedCamera camera;
  LineMeasurement m;
  Eigen::Matrix2d whitening;
  LineParametrization parametrization;

  template <class T>
  bool operator()(const T* pose, const T* line, T* r) const {
    const auto [start, end] = PointsOf(line, parametrization);
    const Vector3<T> shift(T(camera.ShiftInto(m.camera)), T(0), T(0));
    const Vector3<T> t(pose[4], pose[5], pose[6]);
    const Eigen::Quaternion<T> q = ReadQuaternion(pose);
    const Vector3<T> a = Homogeneous<T>(q * start + t + shift);
    const Vector3<T> b = Homogeneous<T>(q * end + t + shift);
    const Vector3<T> l = a.cross(b);
    const T norm = sqrt(l.x() * l.x() + l.y() * l.y());
    const Eigen::Matrix<T, 2, 1> distance(
        (l.x() * m.segment.start.x() + l.y() * m.segment.start.y() + l.z()) / norm,
        (l.x() * m.segment.end.x() + l.y() * m.segment.end.y() + l.z()) / norm);
    r[0] = whitening(0, 0) * distance(0);
    r[1] = whitening(1, 0) * distance(0) + whitening(1, 1) * distance(1);
    return true;
  }

  template <class T>
  Vector3<T> Homogeneous(const Vector3<T>& p) const {
    return {camera.fx * p.x() + camera.cx * p.z(), camera.fy * p.y() + camera.cy * p.z(), p.z()};
  }
};

// Ends of a line and their distances from the measured line, in pixels.
struct ProjectedEndsFunctor {
  RectifiedCamera camera;
  LineMeasurement m;
  Eigen::Matrix2d whitening;
  LineParametrization parametrization;
  LineInterval interval;

  template <class T>
  bool operator()(const T* pose, const T* line, T* r) const {
    auto [start, end] = PointsOf(line, parametrization);
    if (parametrization != LineParametrization::kEndpoints) {
      const Vector3<T> along = (end - start).normalized();
      end = start + along * T(interval.end);
      start += along * T(interval.start);
    }
    T distance[2];
    if (!Distance(pose, start, distance[0]) || !Distance(pose, end, distance[1])) return false;
    r[0] = whitening(0, 0) * distance[0];
    r[1] = whitening(1, 0) * distance[0] + whitening(1, 1) * distance[1];
    return true;
  }

  template <class T>
  bool Distance(const T* pose, const Vector3<T>& point, T& distance) const {
    const Vector3<T> p = ReadQuaternion(pose) * point +
                         Vector3<T>(pose[4] + camera.ShiftInto(m.camera), pose[5], pose[6]);
    if (p.z() < T(kMinDepth)) return false;
    const Eigen::Vector2d along = m.segment.Direction();
    const T dx = camera.fx * p.x() / p.z() + camera.cx - m.segment.start.x();
    const T dy = camera.fy * p.y() / p.z() + camera.cy - m.segment.start.y();
    distance = along.x() * dy - along.y() * dx;
    return true;
  }
};

Eigen::Matrix2d Whitening(const RectifiedCamera& camera, const LineMeasurement& measurement) {
  const LineTerm term = MakeLineTerm(camera, measurement);
  Eigen::Matrix2d whitening;
  whitening << term.w00, 0, term.w10, term.w11;
  return whitening;
}

template <int kRows>
std::unique_ptr<ceres::CostFunction> MakePointCostOf(const RectifiedCamera& camera,
                                                     const PointMeasurement& measurement,
                                                     CeresDerivatives derivatives) {
  if (derivatives == CeresDerivatives::kAnalytic) {
    return std::make_unique<AnalyticPointCost<kRows>>(camera, measurement);
  }
  using Cost = ceres::AutoDiffCostFunction<PointFunctor<kRows>, kRows, 7, 3>;
  return std::make_unique<Cost>(new PointFunctor<kRows>{camera, measurement});
}

}  // namespace

std::unique_ptr<ceres::CostFunction> MakePointCost(const RectifiedCamera& camera,
                                                   const PointMeasurement& measurement,
                                                   CeresDerivatives derivatives) {
  return measurement.disparity ? MakePointCostOf<3>(camera, measurement, derivatives)
                               : MakePointCostOf<2>(camera, measurement, derivatives);
}

std::unique_ptr<ceres::CostFunction> MakeLineCost(const RectifiedCamera& camera,
                                                  const LineMeasurement& measurement,
                                                  CeresDerivatives derivatives,
                                                  LineParametrization line) {
  if (derivatives == CeresDerivatives::kAutomatic) {
    using Cost = ceres::AutoDiffCostFunction<LineFunctor, 2, 7, 6>;
    return std::make_unique<Cost>(
        new LineFunctor{camera, measurement, Whitening(camera, measurement), line});
  }
  if (line == LineParametrization::kEndpoints) {
    return std::make_unique<AnalyticLineCost<BaLineEnds>>(camera, measurement);
  }
  if (line == LineParametrization::kPluckerLeft) {
    return std::make_unique<AnalyticLineCost<BaLineLeft>>(camera, measurement);
  }
  return std::make_unique<AnalyticLineCost<BaLine>>(camera, measurement);
}

std::unique_ptr<ceres::CostFunction> MakeProjectedEndsCost(const RectifiedCamera& camera,
                                                           const LineMeasurement& measurement,
                                                           LineParametrization line,
                                                           const LineInterval& interval) {
  using Cost = ceres::AutoDiffCostFunction<ProjectedEndsFunctor, 2, 7, 6>;
  return std::make_unique<Cost>(new ProjectedEndsFunctor{
      camera, measurement, Whitening(camera, measurement), line, interval});
}

std::unique_ptr<ceres::CostFunction> MakePosePointCost(const RectifiedCamera& camera,
                                                       const PoseProblem::PointMatch& match) {
  PLUMBLINE_CHECK(match.point_covariance.isZero(0), "the reference knows exact points only");
  if (match.measurement.disparity) return std::make_unique<PosePointCost<3>>(camera, match);
  return std::make_unique<PosePointCost<2>>(camera, match);
}

std::unique_ptr<ceres::CostFunction> MakePoseLineCost(const RectifiedCamera& camera,
                                                      const PoseProblem::LineMatch& match) {
  return std::make_unique<PoseLineCost>(camera, match);
}

}  // namespace plumbline
