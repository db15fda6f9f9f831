// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/merge_atlases.h"
#include "arrays.h"
#include "bindings.h"
#include "interruptible.h"
#include "maps.h"
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// A similarity as a matrix (4, 4): rotation times scale, translation.
Similarity3 ReadSimilarity(py::handle value, const char* name) {
  const Doubles array = ReadDoubles(value, name, {4, 4});
  Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
  // Negative for a mirror, 0 for a flat matrix: the remainder is then no rotation.
  const double scale = std::cbrt(matrix.topLeftCorner<3, 3>().determinant());
  const bool scaled = scale > 0 && std::abs(scale - 1) > 1e-9;
  if (scaled) matrix.topLeftCorner<3, 3>() /= scale;
  const Rigid3 motion = ReadPose(ToArray(matrix), name);
  return {scaled ? scale : 1.0, motion.rotation, motion.translation};
}

Integers PairsOf(const std::vector<LoopEdge>& overlap) {
  Integers array({static_cast<py::ssize_t>(overlap.size()), py::ssize_t{2}});
  std::int64_t* out = array.mutable_data();
  for (const LoopEdge& edge : overlap) {
    *out++ = edge.candidate.value;
    *out++ = edge.query.value;
  }
  return array;
}

py::tuple Merge(const PyAtlas& first, const PyAtlas& second, const py::object& transform) {
  std::optional<Similarity3> given;
  if (!transform.is_none()) given = ReadSimilarity(transform, "transform");
  MergedAtlases merged;
  std::vector<std::string> remarks;
  RunInterruptibly([&](const StopCheck&) {
    merged = MergeAtlases(
        {"first", *first.saved}, {"second", *second.saved}, given, [&](const std::string& remark) {
          remarks.push_back(remark);
        });
  });
  py::dict told;
  told["first_from_second"] = ToArray(merged.first_from_second.Matrix());
  told["pairs"] = PairsOf(merged.overlap);
  told["ties"] = merged.ties;
  told["remarks"] = remarks;
  return py::make_tuple(PyAtlas{std::make_shared<const SavedAtlas>(std::move(merged.saved))}, told);
}

}  // namespace

void BindMapMerging(py::module_& module) {
  module.def("merge_maps",
             &Merge,
             py::arg("first"),
             py::arg("second"),
             py::arg("transform") = py::none(),
             R"(merge_maps(first, second, transform=None) -> (Atlas, dict)

One map of the active maps of two atlases of the same camera, in the world of the first, as
`plumbline map merge` makes it. transform (4, 4): first_from_second, a similarity (with measured
depth a motion); None: it is found by the places that both show, their landmarks become one, and the
whole map is adjusted. Raises InputError where that is not certain. Ids of the second are moved
behind those of the first. Ctrl-C raises KeyboardInterrupt when the work is done.

The dictionary: "first_from_second" (4, 4), "pairs" (N, 2) int64, ids of keyframes of the first and
of the second (in the merged map) that show the same place, the surest first, "ties", the number of
keyframes of the second fused with the first, "remarks", what makes the result worth less. New
arrays; the atlases that went in stay as they are.)");
}

}  // namespace plumbline::python
