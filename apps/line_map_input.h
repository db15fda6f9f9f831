// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/line_visibility.h"
#include "plumbline/geometry/parallelogram.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/geometry/true_line.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// Files of the lines to compare, as far as named by the user.
struct LineMapFiles {
  std::filesystem::path reference, estimate;  // the arguments of `evaluate`
  std::optional<std::filesystem::path> true_lines, lines, surfaces;
};

// An estimated line map and its reference world.
struct LineMapInput {
  std::vector<TrueLine> truth;
  std::vector<Parallelogram> surfaces;  // empty if unknown
  std::vector<Segment3> estimate;       // in the world of the estimated trajectory
};

// Reads true lines (default: lines.csv of the folder `reference`), surfaces (default: surfaces.csv
// there) and the line map (.obj or .plb; default: lines.obj of the folder `estimate`). Returns
// nullopt if there are no true lines or no line map and no file was named; throws InputError if one
// was named and another is missing, and for malformed files.
std::optional<LineMapInput> LoadLineMaps(const LineMapFiles& files);

// Returns the keyframes of the run `estimate` (keyframes.txt beside its trajectory) as viewers of
// the true lines of the data set `reference`; nullopt if one of the two is a plain file. `poses`
// are the compared ones of the run.
std::optional<LineViewers> LoadLineViewers(const LineMapFiles& files,
                                           std::span<const EvaluatedPose> poses);

// The true world mirrored in y, to go with MirroredY of its trajectory.
void MirrorWorldY(LineMapInput& input);

// Segments in the world of the reference.
std::vector<Segment3> Transformed(const Similarity3& target_from_source,
                                  std::vector<Segment3> segments);

}  // namespace plumbline
