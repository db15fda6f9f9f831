// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/direct_light.h"

#include "worlds/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr int kStride = 4;

// Light of one lamp, first at the nodes: every fourth point of the grid, and its last ones.
class LightOnGrid {
 public:
  LightOnGrid(const SurfaceGrid& grid, const Lamp& lamp, const RayTracer& tracer)
      : grid_(grid),
        lamp_(lamp),
        tracer_(tracer),
        columns_(2 + (grid.columns() - 2) / kStride),
        rows_(2 + (grid.rows() - 2) / kStride),
        nodes_(columns_, rows_) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        nodes_.at(column, row) = At(std::min(column * kStride, grid_.columns() - 1),
                                    std::min(row * kStride, grid_.rows() - 1));
        brightest_ = std::max(brightest_, nodes_.at(column, row));
      }
    }
  }

  void AddTo(Image<float>& sum) const {
    if (brightest_ == 0) return;
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) AddBlock(column, row, sum);
    }
  }

 private:
  float At(int x, int y) const {
    return static_cast<float>(LightOfLamp(lamp_, grid_.At(x, y), grid_.normal(), tracer_));
  }

  // Returns true if the light is linear over a block, by the block and its neighbouring nodes: the
  // border of a shadow sharp for this grid makes it nonlinear.
  bool IsEven(int column, int row) const {
    constexpr float kBend = 0.08F;  // of the brightest; two steps of a shadow made of kLampPoints
    for (int i = -1; i <= 2; ++i) {
      for (int j = 0; j <= 1; ++j) {
        if (Bend(column + i, row + j, 1, 0) > kBend * brightest_ ||
            Bend(column + j, row + i, 0, 1) > kBend * brightest_) {
          return false;
        }
      }
    }
    return true;
  }

  // Second difference at a node along one axis; 0 beyond and on the rim.
  float Bend(int column, int row, int right, int down) const {
    if (column < right || row < down || column + right >= columns_ || row + down >= rows_) return 0;
    return std::abs(nodes_.at(column - right, row - down) + nodes_.at(column + right, row + down) -
                    2 * nodes_.at(column, row));
  }

  // The points from this node up to the next ones; the last block has its far rim too.
  void AddBlock(int column, int row, Image<float>& sum) const {
    const bool even = IsEven(column, row);
    const int x0 = column * kStride, y0 = row * kStride;
    const int x1 = std::min(x0 + kStride, grid_.columns() - 1);
    const int y1 = std::min(y0 + kStride, grid_.rows() - 1);
    for (int y = y0; y < y1 + (row + 2 == rows_); ++y) {
      for (int x = x0; x < x1 + (column + 2 == columns_); ++x) {
        sum.at(x, y) += even ? Between(column, row, Share(x, x0, x1), Share(y, y0, y1)) : At(x, y);
      }
    }
  }

  static float Share(int x, int x0, int x1) {
    return x1 > x0 ? static_cast<float>(x - x0) / static_cast<float>(x1 - x0) : 0;
  }

  float Between(int column, int row, float a, float b) const {
    const float top = std::lerp(nodes_.at(column, row), nodes_.at(column + 1, row), a);
    const float bottom = std::lerp(nodes_.at(column, row + 1), nodes_.at(column + 1, row + 1), a);
    return std::lerp(top, bottom, b);
  }

  const SurfaceGrid& grid_;
  const Lamp& lamp_;
  const RayTracer& tracer_;
  int columns_, rows_;
  Image<float> nodes_;
  float brightest_ = 0;
};

}  // namespace

SurfaceGrid::SurfaceGrid(const Surface& surface, double cell)
    : surface_(surface),
      normal_(surface.Normal()),
      columns_(2 + static_cast<int>(surface.side_u.norm() / cell)),
      rows_(2 + static_cast<int>(surface.side_v.norm() / cell)) {
  constexpr double kMargin = 0.004;  // metres
  margin_a_ = std::min(0.5, kMargin / surface.side_u.norm());
  margin_b_ = std::min(0.5, kMargin / surface.side_v.norm());
}

Vector3d SurfaceGrid::At(int x, int y) const {
  const double a = std::clamp(x / (columns_ - 1.0), margin_a_, 1 - margin_a_);
  const double b = std::clamp(y / (rows_ - 1.0), margin_b_, 1 - margin_b_);
  return surface_.PointAt(a, b) + static_cast<double>(kLampLift) * normal_;
}

std::vector<Image<float>> DirectLight(const SurfaceGrid& grid,
                                      std::span<const Lamp> lamps,
                                      std::span<const int> sources,
                                      int source_count,
                                      const RayTracer& tracer) {
  std::vector<Image<float>> sums(static_cast<std::size_t>(source_count),
                                 Image<float>(grid.columns(), grid.rows()));
  for (std::size_t k = 0; k < lamps.size(); ++k) {
    LightOnGrid(grid, lamps[k], tracer).AddTo(sums[static_cast<std::size_t>(sources[k])]);
  }
  return sums;
}

}  // namespace plumbline
