// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arrays.h"
#include "maps.h"

// Contents of a map as new arrays. Rows are in the order of the ids.
namespace plumbline::python {

Integers PointIds(const PyMap& map);
Doubles Points(const PyMap& map);
Integers LineIds(const PyMap& map);
Doubles Lines(const PyMap& map);
Doubles LineEnds(const PyMap& map);
Doubles LineInformation(const PyMap& map);
// Poses count as exact; NaN if the observations do not determine the point.
Doubles PointCovariances(const PyMap& map);
Doubles LineEndCovariances(const PyMap& map);
Integers KeyFrameIds(const PyMap& map);
Integers KeyFrameStamps(const PyMap& map);
Doubles KeyFramePoses(const PyMap& map);
// Structured arrays, see the docstrings of Map.
py::array PointTracks(const PyMap& map);
py::array LineTracks(const PyMap& map);
void RegisterTrackTypes();

}  // namespace plumbline::python
