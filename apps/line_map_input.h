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

// Where the lines to be compared are, as far as the user named files.
struct LineMapFiles {
  std::filesystem::path reference, estimate;  // the arguments of `evaluate`
  std::optional<std::filesystem::path> true_lines, lines, surfaces;
};

// An estimated line map and the world it is compared with.
struct LineMapInput {
  std::vector<TrueLine> truth;
  std::vector<Parallelogram> surfaces;  // empty where they are not known
  std::vector<Segment3> estimate;       // in the world of the estimated trajectory
};

// Reads true lines (else lines.csv of the folder `reference`), surfaces (else surfaces.csv there)
// and the line map (.obj or .plb; else lines.obj of the folder `estimate`). nullopt where there are
// no true lines or no map of lines and no file was named; InputError where one was and another is
// missing, and for malformed files.
std::optional<LineMapInput> LoadLineMaps(const LineMapFiles& files);

// The keyframes of the run `estimate` (keyframes.txt beside its trajectory) as viewers of the true
// lines of the data set `reference`; nullopt where one of the two is a mere file. `poses` are the
// run's, compared.
std::optional<LineViewers> LoadLineViewers(const LineMapFiles& files,
                                           std::span<const EvaluatedPose> poses);

// The true world mirrored in y, to go with MirroredY of its trajectory.
void MirrorWorldY(LineMapInput& input);

// Segments in the world of the reference.
std::vector<Segment3> Transformed(const Similarity3& target_from_source,
                                  std::vector<Segment3> segments);

}  // namespace plumbline
