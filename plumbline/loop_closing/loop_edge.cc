// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_edge.h"

#include "plumbline/base/error.h"

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

}  // namespace plumbline
