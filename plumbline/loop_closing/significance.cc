// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/significance.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace plumbline {
namespace {

// Counts points by the shift that takes them to a feature. Votes are kept in cells of the plane of
// shifts, four of which make a window of the search's size.
class ShiftVotes {
 public:
  ShiftVotes(const RectifiedCamera& camera, double cell_px)
      : cell_px_(cell_px),
        columns_(2 * (static_cast<int>(camera.width / cell_px) + 2)),
        rows_(2 * (static_cast<int>(camera.height / cell_px) + 2)),
        votes_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0),
        last_(votes_.size(), -1) {}

  // Counts a vote for the cell of a shift. A voter counts only once in a cell.
  void Vote(int voter, const Eigen::Vector2d& shift) {
    const int x = static_cast<int>(std::floor(shift.x() / cell_px_)) + columns_ / 2;
    const int y = static_cast<int>(std::floor(shift.y() / cell_px_)) + rows_ / 2;
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
    const std::size_t cell = Cell(x, y);
    if (last_[cell] == voter) return;
    last_[cell] = voter;
    ++votes_[cell];
  }

  // Returns the most votes in any window of two by two cells. Windows within `near` cells of the
  // zero shift are left out, because the right relative pose gets its votes there.
  int Most(int near) const {
    int most = 0;
    for (int y = 0; y + 1 < rows_; ++y) {
      for (int x = 0; x + 1 < columns_; ++x) {
        if (std::abs(x + 1 - columns_ / 2) <= near && std::abs(y + 1 - rows_ / 2) <= near) continue;
        most = std::max(most,
                        votes_[Cell(x, y)] + votes_[Cell(x + 1, y)] + votes_[Cell(x, y + 1)] +
                            votes_[Cell(x + 1, y + 1)]);
      }
    }
    return most;
  }

 private:
  std::size_t Cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  double cell_px_;
  int columns_, rows_;
  std::vector<int> votes_;
  std::vector<int> last_;  // the last voter of each cell
};

}  // namespace

double Log10BinomialTail(int trials, int successes, double p) {
  if (successes <= 0 || p >= 1) return 0;
  if (successes > trials || p <= 0) return -std::numeric_limits<double>::infinity();
  const double log_odds = math::Log(p) - math::Log1p(-p);
  double term = trials * math::Log1p(-p);  // logarithm of the probability of no success
  double largest = 0;
  std::vector<double> terms;
  for (int k = 0; k <= trials; ++k) {
    if (k > 0) term += math::Log(static_cast<double>(trials - k + 1) / k) + log_odds;
    if (k < successes) continue;
    largest = terms.empty() ? term : std::max(largest, term);
    terms.push_back(term);
  }
  double sum = 0;
  for (const double t : terms) sum += math::Exp(t - largest);
  return std::min(0.0, (largest + math::Log(sum)) / math::Log(10.0));
}

int BestShiftedMatches(const RectifiedCamera& camera,
                       const FrameFeatures& image,
                       const std::vector<std::optional<ProjectedPoint>>& points,
                       int max_distance,
                       double radius_px) {
  // Cells around the zero shift, whose votes belong to the right relative pose.
  constexpr int kNear = 3;
  ShiftVotes votes(camera, radius_px);
  for (std::size_t l = 0; l < points.size(); ++l) {
    if (!points[l]) continue;
    for (const PointFeature& feature : image.features.points) {
      if (std::abs(feature.octave - points[l]->octave) > 1) continue;
      if (HammingDistance(feature.descriptor, points[l]->descriptor) > max_distance) continue;
      votes.Vote(static_cast<int>(l), feature.px - points[l]->px);
    }
  }
  return votes.Most(kNear);
}

}  // namespace plumbline
