// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/line_map.h"

#include "apps/command_outputs.h"
#include "bindings.h"
#include "interruptible.h"
#include "iteration.h"
#include "map_arrays.h"
#include "map_export.h"
#include "texts.h"
#include "trajectories.h"
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

PyAtlas LoadMaps(const std::filesystem::path& path) {
  const py::gil_scoped_release release;
  return {std::make_shared<const SavedAtlas>(LoadAtlas(path)), std::filesystem::absolute(path)};
}

void SaveMaps(const PyAtlas& atlas, const std::filesystem::path& path) {
  CheckOutput("path", path, {}, MapFileKind());
  const py::gil_scoped_release release;
  SaveAtlas(path, atlas.saved->atlas, atlas.saved->context);
}

std::vector<PyMap> MapsOf(const PyAtlas& atlas) {
  std::vector<PyMap> maps;
  for (const auto& [id, map] : atlas.saved->atlas.maps()) {
    maps.push_back({atlas.saved, &map, atlas.file});
  }
  return maps;
}

// By place in the list.
PyMap MapAt(const PyAtlas& atlas, py::ssize_t index) {
  const std::vector<PyMap> maps = MapsOf(atlas);
  const auto size = static_cast<py::ssize_t>(maps.size());
  if (index < -size || index >= size) {
    throw py::index_error(fmt::format("map: expected -{} to {}, found {}", size, size - 1, index));
  }
  return maps[static_cast<std::size_t>(index < 0 ? index + size : index)];
}

std::optional<PyMap> ActiveMap(const PyAtlas& atlas) {
  const Map* map = atlas.saved->atlas.Find(atlas.saved->atlas.active_id());
  if (map == nullptr) return std::nullopt;
  return PyMap{atlas.saved, map, atlas.file};
}

py::dict LineMapOf(const PyMap& map) {
  std::vector<MappedLine> lines;
  RunInterruptibly([&](const StopCheck& stop) { lines = MappedLinesOf(map, stop); });
  std::vector<Segment3> segments;
  std::vector<double> sigmas;
  std::vector<std::int64_t> keyframes;
  for (const MappedLine& line : lines) {
    segments.push_back(line.segment);
    sigmas.push_back(line.sigma);
    keyframes.push_back(line.keyframes);
  }
  py::dict dict;
  dict["segments"] = ToArray(segments);
  dict["sigmas"] = ToArray(sigmas);
  dict["keyframes"] = ToArray(keyframes);
  return dict;
}

template <class Make>
auto Frozen(const Make& make) {
  return [make](const PyMap& map) { return ReadOnly(make(map)); };
}

// Outputs of a map other than its arrays.
void BindMapOutputs(py::class_<PyMap>& bound) {
  bound
      .def(
          "keyframe_trajectory",
          [](const PyMap& map) { return PoseList{KeyFrameTrajectoryOf(map)}; },
          "keyframe_trajectory() -> Trajectory\n\nOf the left camera; of one time the oldest.")
      .def("line_map", LineMapOf, R"(line_map() -> dict

The lines fit to be given out (docs/methods/line-map.md), as the run had it: "segments" (N, 2, 3) in
the world, "sigmas" (N,) of the worse end across, "keyframes" (N,) that show it. New arrays.)")
      .def(
          "export",
          [](const PyMap& map,
             const std::filesystem::path& path,
             const std::string& format,
             std::optional<ImageSource> images,
             const std::string& frames,
             std::optional<PoseSource> trajectory,
             bool undistort) {
            ExportMap(
                map, path, format, {std::move(images), frames, std::move(trajectory), undistort});
          },
          py::arg("path"),
          py::arg("format"),
          py::arg("images") = py::none(),
          py::arg("frames") = "keyframes",
          py::arg("trajectory") = py::none(),
          py::arg("undistort") = false,
          R"(export(path, format, images=None, frames="keyframes", trajectory=None, undistort=False)

Writes what `plumbline map export` writes: "ply", "obj", "dxf", "tum" (the keyframes), "colmap" or
"nerfstudio" (new folders). images: the data that the map was made from, a Dataset or a path; they
give ply, colmap and nerfstudio their images and colours. frames: "keyframes", "all" for all frames
with a pose as well, or "every:N" for every N-th of these; their poses are trajectory, a Trajectory
or a file (None: trajectory.txt beside the file of the map). undistort: images without distortion
also where the format has a model of the lens. Ctrl-C raises KeyboardInterrupt, and
nothing is written. Raises InputError where anything else than an export of this form would be
replaced.)")
      .def("__repr__", [](const PyMap& map) {
        return fmt::format("<Map {}: {} keyframes, {} points, {} lines>",
                           map.map->id().value,
                           map.map->keyframes().size(),
                           map.map->points().size(),
                           map.map->lines().size());
      });
}

void BindMap(py::module_& module) {
  py::class_<PyMap> bound(
      module, "Map", R"(Keyframes, points and lines of one connected world at one
moment. Nothing of it changes: its arrays are read-only copies.

World: the left camera at the first keyframe; metres, or with one camera a unit of its own.
Rows are in the order of the ids.)");
  bound.def_property_readonly("id", [](const PyMap& map) { return map.map->id().value; })
      .def_property_readonly("point_ids", Frozen(PointIds), "(N,) int64; a read-only copy.")
      .def_property_readonly("points", Frozen(Points), "(N, 3) in the world; a read-only copy.")
      .def_property_readonly("line_ids", Frozen(LineIds), "(N,) int64; a read-only copy.")
      .def_property_readonly("lines", Frozen(Lines), R"((N, 6) Pluecker coordinates in the world:
moment m = X x d for every point X of the line, then direction d, |d| = 1. A read-only copy.)")
      .def_property_readonly("line_ends", Frozen(LineEnds), R"((N, 2, 3) ends of the piece that was
seen, in the world. A read-only copy.)")
      .def_property_readonly("line_information", Frozen(LineInformation), R"((N, 4, 4) information
(inverse covariance) of each line in the tangent of its orthonormal form, with the poses fixed.
A read-only copy.)")
      .def_property_readonly(
          "point_covariances", Frozen(PointCovariances), R"((N, 3, 3) of the points, from all their
observations with the poses taken as known; NaN where they do not determine the point. Computed
when asked for. A read-only copy.)")
      .def_property_readonly(
          "line_end_covariances", Frozen(LineEndCovariances), R"((N, 2, 3, 3) of line_ends, from
line_information: across the line what is known of it; along the line, where nothing is measured,
the sum of the variances across it. Of use to cut_lines, turned into the camera. Computed when
asked for. A read-only copy.)")
      .def_property_readonly("keyframe_ids", Frozen(KeyFrameIds), "(N,) int64; a read-only copy.")
      .def_property_readonly(
          "keyframe_stamps_ns", Frozen(KeyFrameStamps), "(N,) int64; a read-only copy.")
      .def_property_readonly("keyframe_poses", Frozen(KeyFramePoses), R"((N, 4, 4) world_from_camera
of the rectified left camera, that of `camera`. A read-only copy.)")
      .def_property_readonly(
          "point_tracks", Frozen(PointTracks), R"(Which keyframe shows which point
where: structured array of point and keyframe (ids), feature (its number in the keyframe), octave,
px (2,) in the rectified image, corrected for what was learned of the lens, sigma_px, disparity and
disparity_sigma (NaN: not measured). Ordered by point, then keyframe. A read-only copy.)")
      .def_property_readonly("line_tracks", Frozen(LineTracks), R"(Which keyframe shows which line
where: structured array of line and keyframe (ids), feature, octave, start (2,) and end (2,) in the
rectified, corrected image, sigma_px across. Ordered by line, then keyframe. A read-only copy.)")
      .def_property_readonly(
          "camera",
          [](const PyMap& map) { return map.saved->context.camera; },
          "The rectified camera that all features were measured with.");
  BindMapOutputs(bound);
}

}  // namespace

void BindMaps(py::module_& module) {
  RegisterTrackTypes();
  BindMap(module);
  py::class_<PyAtlas>(module, "Atlas", R"(The maps of a run, of a file or as they were at one
moment; nothing of it changes. len(), indices and iteration give Map.)")
      .def("__len__", [](const PyAtlas& atlas) { return atlas.saved->atlas.maps().size(); })
      .def("__getitem__", &MapAt, py::arg("index"))
      .def("__iter__", &IterateByIndex)
      .def_property_readonly(
          "active", ActiveMap, "The Map to go on with; None where there is none.")
      .def("save", &SaveMaps, py::arg("path"), R"(save(path)

Writes a map file (map.plb). Raises InputError where a result of a run, or anything else than a map,
would be replaced.)")
      .def("__repr__", [](const PyAtlas& atlas) {
        return fmt::format("<Atlas of {} maps>", atlas.saved->atlas.maps().size());
      });
  module.def("load_map",
             &LoadMaps,
             py::arg("path"),
             "load_map(path) -> Atlas\n\nReads a map file (map.plb of a run).");
}

}  // namespace plumbline::python
