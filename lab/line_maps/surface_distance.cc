// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

constexpr double kCell = 0.005, kMostCells = 200'000;
constexpr int kCellsPerChunk = 50;

// Parallelograms with their bounding boxes, for finding the one nearest to a point.
class SurfaceSearch {
 public:
  explicit SurfaceSearch(std::span<const Parallelogram> surfaces) {
    for (const Parallelogram& surface : surfaces) entries_.push_back({surface, surface.Bounds()});
  }

  double Distance(const Eigen::Vector3d& point) const {
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const Entry& entry : entries_) {
      if (entry.box.squaredExteriorDistance(point) >= nearest2) continue;
      const double distance = plumbline::Distance(entry.surface, point);
      nearest2 = std::min(nearest2, distance * distance);
    }
    return std::sqrt(nearest2);
  }

  // Returns only the surfaces that may be nearest to a point of the ball.
  SurfaceSearch Near(const Eigen::Vector3d& centre, double radius) const {
    // A point of the ball is at most `reach` - radius away from the surface that is nearest to the
    // centre.
    const double reach = Distance(centre) + 2 * radius;
    SurfaceSearch near;
    for (const Entry& entry : entries_) {
      if (entry.box.squaredExteriorDistance(centre) <= reach * reach)
        near.entries_.push_back(entry);
    }
    return near;
  }

 private:
  struct Entry {
    Parallelogram surface;
    Eigen::AlignedBox3d box;
  };

  SurfaceSearch() = default;

  std::vector<Entry> entries_;
};

struct Cell {
  double distance = 0, length = 0;
};

// Adds the cells of one piece, which are equally long and no longer than `longest`.
void AddCells(const Segment3& piece,
              double longest,
              const SurfaceSearch& surfaces,
              std::vector<Cell>& cells) {
  const auto count = static_cast<int>(std::ceil(piece.Length() / longest));
  const Eigen::Vector3d step = (piece.end - piece.start) / std::max(1, count);
  const double length = step.norm();
  for (int first = 0; first < count; first += kCellsPerChunk) {
    const int last = std::min(count, first + kCellsPerChunk);
    const Eigen::Vector3d centre = piece.start + 0.5 * (first + last) * step;
    const SurfaceSearch near = surfaces.Near(centre, 0.5 * (last - first) * length);
    for (int i = first; i < last; ++i) {
      cells.push_back({near.Distance(piece.start + (i + 0.5) * step), length});
    }
  }
}

}  // namespace

std::optional<SurfaceDistance> DistanceFromSurfaces(std::span<const Segment3> pieces,
                                                    std::span<const Parallelogram> surfaces,
                                                    double limit) {
  double total = 0;
  for (const Segment3& piece : pieces) total += piece.Length();
  if (surfaces.empty() || !(total > 0)) return std::nullopt;
  const double longest = std::max(kCell, total / kMostCells);
  const SurfaceSearch search(surfaces);
  std::vector<Cell> cells;
  for (const Segment3& piece : pieces) AddCells(piece, longest, search, cells);
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return std::pair(a.distance, a.length) < std::pair(b.distance, b.length);
  });
  SurfaceDistance result;
  double below = 0, beyond = 0;
  bool found = false;
  for (const Cell& cell : cells) {
    below += cell.length;
    if (!found && below >= 0.5 * total) {
      result.median = cell.distance;
      found = true;
    }
    if (cell.distance > limit) beyond += cell.length;
  }
  result.share_beyond = beyond / below;
  return result;
}

}  // namespace plumbline
