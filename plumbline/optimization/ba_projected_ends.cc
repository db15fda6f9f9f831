// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ba_projected_ends.h"

namespace plumbline {
namespace {

inline Segment3 ToCamera(const BaPose& pose, const Segment3& ends) {
  return {pose.R * ends.start + pose.cam_from_world.translation,
          pose.R * ends.end + pose.cam_from_world.translation};
}

}  // namespace

template <class ViewOfEnds>
double BaProjectedTerms<ViewOfEnds>::Chi2(const RectifiedCamera&,
                                          const BaPose& pose,
                                          const Place& place,
                                          const Term& term) {
  Eigen::Vector2d r;
  if (!WhitenedEndDistances(term, ToCamera(pose, place), r)) {
    return std::numeric_limits<double>::infinity();
  }
  return r.squaredNorm();
}

template <class ViewOfEnds>
bool BaProjectedTerms<ViewOfEnds>::Add(const RectifiedCamera&,
                                       const BaPose& pose,
                                       const View& view,
                                       const Term& term,
                                       double huber,
                                       const Target& target) {
  const Segment3 ends = ToCamera(pose, view.ends);
  ProjectedEndsLinearization a;
  if (!LinearizeProjectedEnds(term, ends, a)) return false;
  const double w = HuberWeight(a.r.squaredNorm(), huber);
  using Row = Eigen::Matrix<double, kDof, 1>;
  const Row c0 = view.Row(pose.R.transpose() * a.h0, Eigen::Vector3d::Zero());
  const Row c1 = view.Row(pose.R.transpose() * a.h1_start, pose.R.transpose() * a.h1_end);
  const Row wc0 = w * c0;
  const Row wc1 = w * c1;
  target.landmark.V.noalias() += wc0 * c0.transpose() + wc1 * c1.transpose();
  target.landmark.g += a.r(0) * wc0 + a.r(1) * wc1;
  if (target.pose == nullptr) return true;
  const auto [a0, a1] = PoseRows(a, ends);
  const Vector6d wa0 = w * a0;
  const Vector6d wa1 = w * a1;
  target.pose->H.noalias() += wa0 * a0.transpose() + wa1 * a1.transpose();
  target.pose->g += a.r(0) * wa0 + a.r(1) * wa1;
  target.W->noalias() += a0 * wc0.transpose() + a1 * wc1.transpose();
  return true;
}

std::array<BaLineEnd::Term, 2> BaLineEnd::MakeTerms(const RectifiedCamera& camera,
                                                    const LineMeasurement& measurement) {
  const ProjectedEndsTerm term = MakeProjectedEndsTerm(camera, measurement);
  return {Term{term.w00 * term.line, term.shift}, Term{term.w11 * term.line, term.shift}};
}

double BaLineEnd::Chi2(const RectifiedCamera&,
                       const BaPose& pose,
                       const Place& place,
                       const Term& term) {
  const Eigen::Vector3d p = pose.R * place + pose.cam_from_world.translation;
  if (!(p.z() > kMinDepth) || term.line.isZero(0)) return std::numeric_limits<double>::infinity();
  const double r = (term.line.dot(p) + term.line.x() * term.shift) / p.z();
  return r * r;
}

bool BaLineEnd::Add(const RectifiedCamera&,
                    const BaPose& pose,
                    const View& view,
                    const Term& term,
                    double huber,
                    const Target& target) {
  const Eigen::Vector3d p = pose.R * view.point + pose.cam_from_world.translation;
  if (!(p.z() > kMinDepth) || term.line.isZero(0)) return false;
  const double iz = 1 / p.z();
  const double r = (term.line.dot(p) + term.line.x() * term.shift) * iz;
  Eigen::Vector3d g = term.line * iz;
  g.z() -= r * iz;
  const double w = HuberWeight(r * r, huber);
  const Eigen::Vector3d c = pose.R.transpose() * g;
  const Eigen::Vector3d wc = w * c;
  target.landmark.V.noalias() += wc * c.transpose();
  target.landmark.g += r * wc;
  if (target.pose == nullptr) return true;
  Vector6d a;
  a << p.cross(g), g;
  const Vector6d wa = w * a;
  target.pose->H.noalias() += wa * a.transpose();
  target.pose->g += r * wa;
  target.W->noalias() += a * wc.transpose();
  return true;
}

template struct BaProjectedTerms<PointEndsView>;
template struct BaProjectedTerms<LineEndsView>;

}  // namespace plumbline
