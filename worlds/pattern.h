// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "worlds/material.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Input of a pattern: the recipe of a whole sheet and the size of the sampled cells.
struct PatternFrame {
  double tone = 0.5;
  std::uint64_t seed = 0;
  double width = 1, height = 1;                    // of the sheet, metres
  Eigen::Vector2d cell = Eigen::Vector2d::Zero();  // metres; 0: the reflectance of the point
};

// The reflectance of a material and the straight edges in it, from one layout.
//
// Edges are averaged over the cell, so that the position of a step does not depend on the cells, to
// a small part of a cell; everything else is evaluated at the point.
class Pattern {
 public:
  explicit Pattern(const PatternFrame& frame) : frame_(frame) {}
  virtual ~Pattern() = default;
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  // Reflectance at metres from the corner of the sheet, not yet limited to [0, 1].
  virtual double At(double u, double v) const = 0;

  // Appends the straight edges of the layout within the window, in successive pieces that are each
  // uniform on both sides from end to end, whether or not they have contrast.
  virtual void AppendEdges(const Eigen::AlignedBox2d& window, std::vector<Segment2>* edges) const;

 protected:
  PatternFrame frame_;
};

std::unique_ptr<const Pattern> MakePattern(Material material, const PatternFrame& frame);

// One function for each family of materials, called in turn by MakePattern; nullptr: another
// family.
std::unique_ptr<const Pattern> MakeGrownPattern(Material material, const PatternFrame& frame);
std::unique_ptr<const Pattern> MakeLaidPattern(Material material, const PatternFrame& frame);
std::unique_ptr<const Pattern> MakePrintedPattern(Material material, const PatternFrame& frame);

// Share of a cell of size `cell` around x that lies within [low, high].
double Covered(double x, double low, double high, double cell);

// The part of a segment inside a box; nullopt if there is none.
std::optional<Segment2> ClipToBox(const Segment2& segment, const Eigen::AlignedBox2d& box);

}  // namespace plumbline
