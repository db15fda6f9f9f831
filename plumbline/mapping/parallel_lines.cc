// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/parallel_lines.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace plumbline {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kSigma = 0.2 * kRadians;
constexpr double kWellKnown = 1 * kRadians;
constexpr double kNear = 2 * kRadians;
constexpr std::size_t kMinLines = 5;
constexpr std::size_t kMinViews = 3;
// In a larger map only so many keyframes are looked at: they fix its directions to a hundredth of a
// degree.
constexpr std::size_t kMostKeyFrames = 200;
constexpr std::size_t kMostLines = 1500;
constexpr double kMaxChance = 0.005;
// At larger angles the sine is not the angle, and its chi2 says nothing.
constexpr double kMinCosine = 0.9;

using Basis = Eigen::Matrix<double, 3, 2>;

// Difference of a line's direction from an axis, in a basis across the axis; zero if the two are
// too far apart to agree.
struct Deviation {
  Eigen::Vector2d angle = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  bool agrees = false;
};

// sigma: deviation of the difference, in addition to the line's covariance.
Deviation DeviationFrom(const Eigen::Vector3d& axis,
                        const Basis& across,
                        const LineDirection& line,
                        double sigma) {
  Deviation out;
  const double cosine = axis.dot(line.direction);
  if (std::abs(cosine) < kMinCosine) return out;
  out.angle = (cosine < 0 ? -1 : 1) * (across.transpose() * line.direction);
  out.covariance = across.transpose() * line.covariance * across;
  out.covariance.diagonal().array() += sigma * sigma;
  const double chi2 = out.angle.dot(out.covariance.inverse() * out.angle);
  out.agrees = chi2 <= Chi2Limit95(2);
  return out;
}

using Lines = std::vector<const LineDirection*>;

// Counts for each line the lines near it in direction, itself included, and updates the counts as
// lines are removed.
//
// The lines are sorted by the size of one component of their directions. Two directions that are
// near each other, in either sense, differ in it by no more than the chord between them, so that
// each line is compared only with those in an interval of that order.
class Votes {
 public:
  explicit Votes(const std::vector<LineDirection>& lines)
      : lines_(lines), votes_(lines.size(), 1), taken_(lines.size(), false) {
    sorted_.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      sorted_.push_back({ComponentOf(lines[i].direction), lines[i].direction, i});
    }
    std::sort(sorted_.begin(), sorted_.end(), [](const Entry& a, const Entry& b) {
      return a.component < b.component;
    });
    for (auto a = sorted_.begin(); a != sorted_.end(); ++a) {
      for (auto b = a + 1; b != sorted_.end() && b->component - a->component <= kReach; ++b) {
        const std::ptrdiff_t near = Near(a->direction, b->direction) ? 1 : 0;
        votes_[a->line] += near;
        votes_[b->line] += near;
      }
    }
  }

  void Take(const LineDirection& line) {
    taken_[static_cast<std::size_t>(&line - lines_.data())] = true;
    const double component = ComponentOf(line.direction);
    auto other = std::lower_bound(
        sorted_.begin(), sorted_.end(), component - kReach, [](const Entry& entry, double least) {
          return entry.component < least;
        });
    for (; other != sorted_.end() && other->component - component <= kReach; ++other) {
      votes_[other->line] -= Near(other->direction, line.direction) ? 1 : 0;
    }
  }

  // Returns the first of the lines with most others near them; nullptr when no line has enough.
  const LineDirection* Most() const {
    std::ptrdiff_t most = kMinLines - 1;
    const LineDirection* line = nullptr;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (taken_[i] || votes_[i] <= most) continue;
      most = votes_[i];
      line = &lines_[i];
    }
    return line;
  }

 private:
  // The chord between two directions is shorter than the angle; the rest is for rounding.
  static constexpr double kReach = 1.01 * kNear;

  struct Entry {
    double component = 0;
    Eigen::Vector3d direction;
    std::size_t line = 0;
  };

  // The component along a direction that tells the axes of the world apart, along which most lines
  // of a building may run.
  static double ComponentOf(const Eigen::Vector3d& direction) {
    return std::abs(direction.dot(Eigen::Vector3d(0.36, 0.48, 0.8)));
  }

  bool Near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return std::abs(a.dot(b)) >= near_;
  }

  const std::vector<LineDirection>& lines_;
  std::vector<std::ptrdiff_t> votes_;
  std::vector<bool> taken_;
  std::vector<Entry> sorted_;  // by component
  double near_ = math::Cos(kNear);
};

// Finds the mean direction by Gauss-Newton on the deviations of the lines that agree with it, which
// are chosen anew in each step. The lines that do not agree in the last step are left in `others`.
CommonDirection WeightedMean(const Eigen::Vector3d& start, const Lines& lines, Lines& others) {
  constexpr int kSteps = 4;
  CommonDirection mean{start, 0};
  for (int step = 0; step < kSteps; ++step) {
    const Basis across = BasisAcross(mean.direction);
    others.clear();
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (const LineDirection* line : lines) {
      const Deviation d = DeviationFrom(mean.direction, across, *line, kSigma);
      if (!d.agrees) {
        others.push_back(line);
        continue;
      }
      const Eigen::Matrix2d weight = d.covariance.inverse();
      H += weight;
      g += weight * d.angle;
    }
    if (others.size() == lines.size()) break;
    const Eigen::Matrix2d covariance = H.inverse();
    mean.direction = (mean.direction + across * covariance * g).normalized();
    mean.sigma = std::sqrt(covariance.trace());
  }
  return mean;
}

}  // namespace

double ParallelSigma() { return kSigma; }

std::optional<LineDirection> DirectionOf(const PluckerLine& line,
                                         const Eigen::Matrix4d& information) {
  const Eigen::LLT<Eigen::Matrix4d> factor(information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Matrix3d U = ToOrthonormal(line).U.toRotationMatrix();
  Eigen::Matrix<double, 3, 4> J = Eigen::Matrix<double, 3, 4>::Zero();
  J.col(0) = U.col(2);
  J.col(2) = -U.col(0);
  const Eigen::Matrix3d covariance = J * factor.solve(J.transpose());
  if (!covariance.allFinite()) return std::nullopt;
  return LineDirection{line.direction, covariance};
}

std::vector<CommonDirection> CommonDirections(const std::vector<LineDirection>& lines) {
  std::vector<LineDirection> known;
  for (const LineDirection& line : lines) {
    if (line.covariance.trace() <= kWellKnown * kWellKnown) known.push_back(line);
  }
  Votes votes(known);
  Lines left;
  for (const LineDirection& line : known) left.push_back(&line);
  std::vector<CommonDirection> out;
  while (const LineDirection* seed = votes.Most()) {
    Lines others;
    const CommonDirection mean = WeightedMean(seed->direction, left, others);
    if (left.size() - others.size() >= kMinLines) {
      out.push_back(mean);
    } else {
      others = left;
      others.erase(std::find(others.begin(), others.end(), seed));
    }
    // `others` is in the order of `left`, so that one pass finds the lines that were taken out.
    auto kept = others.begin();
    for (const LineDirection* line : left) {
      if (kept != others.end() && *kept == line) {
        ++kept;
      } else {
        votes.Take(*line);
      }
    }
    left = std::move(others);
  }
  return out;
}

namespace {

// Returns true if the item at `place` is chosen when at most `most` of `count` items, evenly
// spread, are.
bool Chosen(std::size_t place, std::size_t count, std::size_t most) {
  return place * most / count != (place + 1) * most / count;
}

// Returns the lines that enough keyframes show, one of the chosen keyframes among them, ordered by
// id.
std::vector<const MapLine*> SpreadLines(const Map& map) {
  std::vector<LineId> ids;
  std::size_t place = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (!Chosen(place++, map.keyframes().size(), kMostKeyFrames)) continue;
    for (const LineId line : keyframe.frame.lines) {
      if (line.valid()) ids.push_back(line);
    }
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<const MapLine*> lines;
  for (const LineId id : ids) {
    const MapLine* line = map.Find(id);
    if (line->observations.size() >= kMinViews) lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::vector<CommonDirection> CommonDirections(const Map& map) {
  const std::vector<const MapLine*> spread = SpreadLines(map);
  std::vector<LineDirection> lines;
  for (std::size_t i = 0; i < spread.size(); ++i) {
    if (!Chosen(i, spread.size(), kMostLines)) continue;
    if (const auto direction = DirectionOf(spread[i]->line, spread[i]->information)) {
      lines.push_back(*direction);
    }
  }
  return CommonDirections(lines);
}

std::optional<std::size_t> ParallelTo(const LineDirection& line,
                                      const std::vector<CommonDirection>& directions) {
  std::optional<std::size_t> out;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d& axis = directions[i].direction;
    const Deviation d =
        DeviationFrom(axis, BasisAcross(axis), line, math::Hypot(kSigma, directions[i].sigma));
    if (!d.agrees) continue;
    // The probability that a line of any direction passes: the area of the ellipse of directions
    // that pass, as a share of the hemisphere of all directions.
    const double chance = 0.5 * Chi2Limit95(2) * std::sqrt(d.covariance.determinant());
    if (out || chance > kMaxChance) return std::nullopt;
    out = i;
  }
  return out;
}

}  // namespace plumbline
