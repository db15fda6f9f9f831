// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/ba_projected_ends.h"

namespace plumbline {
namespace {

inline Segment3 ToCamera(const BaPose& pose, const Segment3& ends) {
  return {pose.ToCamera(ends.start), pose.ToCamera(ends.end)};
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
  AddTwoRows<kDof>(w, a.r, c0, c1, target, [&] { return PoseRows(a, ends); });
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
  const Eigen::Vector3d p = pose.ToCamera(place);
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
  const Eigen::Vector3d p = pose.ToCamera(view.point);
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
