// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_edge.h"

#include "plumbline/base/error.h"

#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

Similarity3 Scaling(double scale) {
  return {scale, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()};
}

}  // namespace

Similarity3 CandidateFromQueryToday(const LoopEdge& edge,
                                    double query_scale_today,
                                    double candidate_scale_today) {
  return Scaling(candidate_scale_today / edge.candidate_scale) * edge.candidate_from_query *
         Scaling(edge.query_scale / query_scale_today);
}

Matrix7d InformationOf(const LoopEdge& edge) {
  const int size = edge.covariance(6, 6) > 0 ? 7 : 6;
  Matrix7d information = Matrix7d::Zero();
  information.topLeftCorner(size, size) =
      edge.covariance.topLeftCorner(size, size).ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  return 0.5 * (information + information.transpose());
}

Similarity3 CandidateWorldFromQueryWorld(const Map& query_map,
                                         const Map& candidate_map,
                                         const LoopEdge& edge) {
  PLUMBLINE_CHECK(query_map.Knows(edge.query) && candidate_map.Knows(edge.candidate),
                  "an edge of keyframes that are not in the maps");
  const KeyFramePose query = query_map.PlaceOf(edge.query);
  const KeyFramePose candidate = candidate_map.PlaceOf(edge.candidate);
  return ToSimilarity(Inverse(candidate.cam_from_world)) *
         CandidateFromQueryToday(edge, query.scale, candidate.scale) *
         ToSimilarity(query.cam_from_world);
}

PoseWithCovariance Compose(const PoseWithCovariance& c_from_b, const PoseWithCovariance& b_from_a) {
  const Matrix7d moved = Adjoint(c_from_b.pose);
  return {c_from_b.pose * b_from_a.pose,
          c_from_b.covariance + moved * b_from_a.covariance * moved.transpose()};
}

PoseWithCovariance Inverse(const PoseWithCovariance& b_from_a) {
  const Similarity3 inverse = Inverse(b_from_a.pose);
  const Matrix7d moved = Adjoint(inverse);
  return {inverse, moved * b_from_a.covariance * moved.transpose()};
}

double ClosingChi2(const PoseWithCovariance& a_from_a) {
  const Eigen::Index size = a_from_a.covariance(6, 6) > 0 ? 7 : 6;
  const Eigen::LLT<Eigen::MatrixXd> factor(a_from_a.covariance.topLeftCorner(size, size));
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd r = LogSim3(a_from_a.pose).head(size);
  return r.dot(factor.solve(r));
}

}  // namespace plumbline
