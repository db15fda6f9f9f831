// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/pairwise_consistency.h"

#include "plumbline/base/ids.h"
#include "plumbline/loop_closing/loop_edge.h"

#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

PoseWithCovariance Measured(const PoseGraphEdge& edge) {
  const Eigen::Index size = edge.information(6, 6) > 0 ? 7 : 6;
  PoseWithCovariance pose{edge.to_from};
  pose.covariance.topLeftCorner(size, size) = edge.information.topLeftCorner(size, size)
                                                  .ldlt()
                                                  .solve(Eigen::MatrixXd::Identity(size, size));
  return pose;
}

// Searches by branch and bound over the members in ascending order.
class CliqueSearch {
 public:
  explicit CliqueSearch(const std::vector<std::vector<bool>>& joined) : joined_(joined) {}

  std::vector<int> Run() {
    std::vector<int> all(joined_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    Extend(all);
    return std::move(best_);
  }

 private:
  void Extend(const std::vector<int>& candidates) {
    if (current_.size() > best_.size()) best_ = current_;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (current_.size() + candidates.size() - i <= best_.size()) return;
      std::vector<int> rest;
      for (std::size_t j = i + 1; j < candidates.size(); ++j) {
        if (joined_[Index(candidates[i])][Index(candidates[j])]) rest.push_back(candidates[j]);
      }
      current_.push_back(candidates[i]);
      Extend(rest);
      current_.pop_back();
    }
  }

  const std::vector<std::vector<bool>>& joined_;
  std::vector<int> current_, best_;
};

}  // namespace

double CycleChi2(OdometryWays& odometry, const PoseGraphEdge& a, const PoseGraphEdge& b) {
  const auto query_a_from_b = odometry.Along(a.from, b.from);
  const auto candidate_b_from_a = odometry.Along(b.to, a.to);
  if (!query_a_from_b || !candidate_b_from_a) return 0;
  const PoseWithCovariance candidate_a_from_b =
      Compose(Compose(Measured(a), *query_a_from_b), Inverse(Measured(b)));
  return ClosingChi2(Compose(candidate_a_from_b, *candidate_b_from_a));
}

std::vector<int> LargestConsistentSet(const std::vector<std::vector<bool>>& consistent) {
  return CliqueSearch(consistent).Run();
}

}  // namespace plumbline
