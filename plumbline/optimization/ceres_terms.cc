// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ceres_terms.h"

#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

namespace plumbline {
namespace {

template <int kRows, int kCols>
using RowMajor =
    Eigen::Matrix<double, kRows, kCols, kCols == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

Rigid3 ReadPose(const double* x) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)).normalized(),
          Eigen::Map<const Eigen::Vector3d>(x + 4)};
}

void WritePose(const Rigid3& pose, double* x) {
  std::copy_n(pose.rotation.coeffs().data(), 4, x);
  std::copy_n(pose.translation.data(), 3, x + 4);
}

OrthonormalLine ReadLine(const double* x) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)).normalized(),
          Eigen::Map<const Eigen::Vector2d>(x + 4).normalized()};
}

void WriteLine(const OrthonormalLine& line, double* x) {
  std::copy_n(line.U.coeffs().data(), 4, x);
  std::copy_n(line.w.data(), 2, x + 4);
}

// Matrix of a -> q a for quaternions as [x y z w].
Eigen::Matrix4d LeftProduct(const Eigen::Vector4d& q) {
  Eigen::Matrix4d m = q(3) * Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() += Skew(q.head<3>());
  m.topRightCorner<3, 1>() += q.head<3>();
  m.bottomLeftCorner<1, 3>() -= q.head<3>().transpose();
  return m;
}

// Matrix of a -> a q.
Eigen::Matrix4d RightProduct(const Eigen::Vector4d& q) {
  Eigen::Matrix4d m = q(3) * Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() -= Skew(q.head<3>());
  m.topRightCorner<3, 1>() += q.head<3>();
  m.bottomLeftCorner<1, 3>() -= q.head<3>().transpose();
  return m;
}

Eigen::Vector4d Conjugate(const Eigen::Vector4d& q) { return {-q(0), -q(1), -q(2), q(3)}; }

// d[w, v] / d[q, t] at the pose itself.
RowMajor<6, 7> PoseMinusJacobian(const double* x) {
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(x + 4);
  const Eigen::Matrix<double, 3, 4> dw = 2 * RightProduct(Conjugate(q)).topRows<3>();
  RowMajor<6, 7> J;
  J << dw, Eigen::Matrix3d::Zero(), Skew(t) * dw, Eigen::Matrix3d::Identity();
  return J;
}

RowMajor<4, 6> LineMinusJacobian(const double* x) {
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  RowMajor<4, 6> J = RowMajor<4, 6>::Zero();
  J.topLeftCorner<3, 4>() = 2 * LeftProduct(Conjugate(q)).topRows<3>();
  J(3, 4) = -x[5];
  J(3, 5) = x[4];
  return J;
}

}  // namespace

bool LeftRigid3Manifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  WritePose(RetractLeft(ReadPose(x), Eigen::Map<const Vector6d>(delta)), x_plus_delta);
  return true;
}

bool LeftRigid3Manifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<7, 6>> J(jacobian);
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(x + 4);
  J.setZero();
  J.topLeftCorner<4, 3>() = 0.5 * RightProduct(q).leftCols<3>();
  J.bottomLeftCorner<3, 3>() = -Skew(t);
  J.bottomRightCorner<3, 3>().setIdentity();
  return true;
}

bool LeftRigid3Manifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d> out(y_minus_x);
  out = LogSe3(ReadPose(y) * Inverse(ReadPose(x)));
  return true;
}

bool LeftRigid3Manifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<6, 7>> J(jacobian);
  J = PoseMinusJacobian(x);
  return true;
}

bool OrthonormalLineManifold::Plus(const double* x,
                                   const double* delta,
                                   double* x_plus_delta) const {
  WriteLine(Retract(ReadLine(x), Eigen::Map<const Eigen::Vector4d>(delta)), x_plus_delta);
  return true;
}

bool OrthonormalLineManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<6, 4>> J(jacobian);
  const Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(x);
  J.setZero();
  J.topLeftCorner<4, 3>() = 0.5 * LeftProduct(q).leftCols<3>();
  J(4, 3) = -x[5];
  J(5, 3) = x[4];
  return true;
}

bool OrthonormalLineManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const OrthonormalLine a = ReadLine(x);
  const OrthonormalLine b = ReadLine(y);
  Eigen::Map<Eigen::Vector4d> out(y_minus_x);
  out.head<3>() = LogSo3(a.U.conjugate() * b.U);
  out(3) = std::atan2(a.w.x() * b.w.y() - a.w.y() * b.w.x(), a.w.dot(b.w));
  return true;
}

bool OrthonormalLineManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<4, 6>> J(jacobian);
  J = LineMinusJacobian(x);
  return true;
}

namespace {

// Analytic terms return J_tangent * MinusJacobian: Ceres multiplies it by PlusJacobian, which gives
// J_tangent back.
template <int kRows>
class AnalyticPointCost final : public ceres::SizedCostFunction<kRows, 7, 3> {
 public:
  AnalyticPointCost(const RectifiedCamera& camera, const PointMeasurement& measurement)
      : camera_(camera), measurement_(measurement) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const auto out = EvaluatePoint(
        camera_, ReadPose(x[0]), Eigen::Map<const Eigen::Vector3d>(x[1]), measurement_);
    if (!out) return false;
    Eigen::Map<Eigen::Matrix<double, kRows, 1>> r(residuals);
    r = out->r.template head<kRows>();
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor<kRows, 7>> J(jacobians[0]);
      J = out->J_pose.template topRows<kRows>() * PoseMinusJacobian(x[0]);
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor<kRows, 3>> J(jacobians[1]);
      J = out->J_point.template topRows<kRows>();
    }
    return true;
  }

 private:
  RectifiedCamera camera_;
  PointMeasurement measurement_;
};

class AnalyticLineCost final : public ceres::SizedCostFunction<2, 7, 6> {
 public:
  AnalyticLineCost(const RectifiedCamera& camera, const LineMeasurement& measurement)
      : camera_(camera), measurement_(measurement) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const auto out = EvaluateLine(camera_, ReadPose(x[0]), ReadLine(x[1]), measurement_);
    if (!out) return false;
    Eigen::Map<Eigen::Vector2d> r(residuals);
    r = out->r;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor<2, 7>> J(jacobians[0]);
      J = out->J_pose * PoseMinusJacobian(x[0]);
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor<2, 6>> J(jacobians[1]);
      J = out->J_line * LineMinusJacobian(x[1]);
    }
    return true;
  }

 private:
  RectifiedCamera camera_;
  LineMeasurement measurement_;
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

// The projected line through the images of two points of the 3D line, instead of by its moment.
struct LineFunctor {
  RectifiedCamera camera;
  LineMeasurement m;
  Eigen::Matrix2d whitening;

  template <class T>
  bool operator()(const T* pose, const T* line, T* r) const {
    const Eigen::Quaternion<T> U = ReadQuaternion(line);
    const Vector3<T> moment = (U * Vector3<T>(T(1), T(0), T(0))) * line[4];
    const Vector3<T> direction = (U * Vector3<T>(T(0), T(1), T(0))) * line[5];
    const Vector3<T> foot = direction.cross(moment) / direction.squaredNorm();
    const Vector3<T> shift(T(m.in_right_camera ? -camera.baseline : 0.0), T(0), T(0));
    const Vector3<T> t(pose[4], pose[5], pose[6]);
    const Eigen::Quaternion<T> q = ReadQuaternion(pose);
    const Vector3<T> a = Homogeneous<T>(q * foot + t + shift);
    const Vector3<T> b = Homogeneous<T>(q * (foot + direction) + t + shift);
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

ceres::LossFunction* MakeLoss(double huber) {
  return std::isfinite(huber) ? new ceres::HuberLoss(huber) : nullptr;
}

// The numbers Ceres works on.
struct Blocks {
  std::vector<std::array<double, 7>> poses;
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<double, 6>> lines;
};

Blocks MakeBlocks(const BaProblem& problem) {
  Blocks blocks;
  for (const auto& pose : problem.poses) {
    WritePose(pose.cam_from_world, blocks.poses.emplace_back().data());
  }
  for (const auto& p : problem.points) blocks.points.push_back({p.x(), p.y(), p.z()});
  for (const auto& line : problem.lines) WriteLine(line, blocks.lines.emplace_back().data());
  return blocks;
}

void AddTerms(const BaProblem& problem,
              const CeresBaOptions& options,
              Blocks& blocks,
              ceres::Problem& out) {
  for (std::size_t i = 0; i < blocks.poses.size(); ++i) {
    out.AddParameterBlock(blocks.poses[i].data(), 7, new LeftRigid3Manifold);
    if (problem.poses[i].fixed) out.SetParameterBlockConstant(blocks.poses[i].data());
  }
  for (auto& line : blocks.lines) {
    out.AddParameterBlock(line.data(), 6, new OrthonormalLineManifold);
  }
  for (const auto& o : problem.point_observations) {
    const double huber = o.measurement.disparity ? options.huber.disparity : options.huber.point;
    out.AddResidualBlock(
        MakePointCost(problem.camera, o.measurement, options.derivatives).release(),
        MakeLoss(huber),
        blocks.poses[static_cast<std::size_t>(o.pose)].data(),
        blocks.points[static_cast<std::size_t>(o.point)].data());
  }
  for (const auto& o : problem.line_observations) {
    out.AddResidualBlock(MakeLineCost(problem.camera, o.measurement, options.derivatives).release(),
                         MakeLoss(options.huber.line),
                         blocks.poses[static_cast<std::size_t>(o.pose)].data(),
                         blocks.lines[static_cast<std::size_t>(o.line)].data());
  }
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
                                                  CeresDerivatives derivatives) {
  if (derivatives == CeresDerivatives::kAnalytic) {
    return std::make_unique<AnalyticLineCost>(camera, measurement);
  }
  const LineTerm term = MakeLineTerm(camera, measurement);
  Eigen::Matrix2d whitening;
  whitening << term.w00, 0, term.w10, term.w11;
  using Cost = ceres::AutoDiffCostFunction<LineFunctor, 2, 7, 6>;
  return std::make_unique<Cost>(new LineFunctor{camera, measurement, whitening});
}

CeresBaResult SolveWithCeres(const BaProblem& problem, const CeresBaOptions& options) {
  Blocks blocks = MakeBlocks(problem);
  ceres::Problem terms;
  AddTerms(problem, options, blocks, terms);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.num_threads = 1;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = 0;
  solver.gradient_tolerance = 0;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &terms, &summary);
  CeresBaResult result;
  for (const auto& x : blocks.poses) result.poses.push_back(ReadPose(x.data()));
  for (const auto& x : blocks.points) result.points.emplace_back(x[0], x[1], x[2]);
  for (const auto& x : blocks.lines) result.lines.push_back(ReadLine(x.data()));
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  return result;
}

}  // namespace plumbline
