// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/report/run_files.h"
#include "plumbline/version.h"

#include "apps/run_results.h"
#include "arrays.h"
#include "bindings.h"
#include "frames.h"
#include "inertial.h"
#include "interruptible.h"
#include "maps.h"
#include "options.h"
#include "running_system.h"
#include "sensor_kind.h"
#include "texts.h"
#include "trajectories.h"
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

std::unique_ptr<RunningSystem> MakeSystem(const Calibration& calibration,
                                          const py::object& seed,
                                          const py::object& mode,
                                          const py::object& preset,
                                          const std::optional<std::filesystem::path>& imu,
                                          const py::kwargs& given) {
  const SlamOptions options = ReadRunOptions({preset, seed, mode}, given);
  std::optional<std::string> name;
  if (!preset.is_none()) name = preset.cast<std::string>();
  std::optional<InertialCalibration> inertial;
  if (imu) inertial = ReadInertialCalibration(*imu);
  if (inertial) CheckPlaceIsKnown(*inertial, imu->string());
  const py::gil_scoped_release release;
  auto system = std::make_unique<RunningSystem>(calibration, options, std::move(name));
  if (inertial) system->UseInertial(*inertial);
  return system;
}

std::int64_t ReadStamp(py::handle value) {
  if (!py::isinstance<py::int_>(value) || py::isinstance<py::bool_>(value)) {
    const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    PyErr_Clear();
    if (!index || py::isinstance<py::bool_>(value)) {
      throw InputError("stamp_ns: expected a whole number of nanoseconds, found " +
                       Describe(value));
    }
    return ReadStamp(index);
  }
  const long long stamp = PyLong_AsLongLong(value.ptr());
  if (stamp == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw InputError("stamp_ns: expected nanoseconds of 64 bits, found " +
                     py::str(value).cast<std::string>());
  }
  return stamp;
}

// A frame as it is, an image, or a pair of images, the second one by the kind of the sensor.
SensorFrame ReadImages(const Calibration& calibration, py::handle images, py::handle stamp) {
  if (py::isinstance<PyFrame>(images)) {
    if (!stamp.is_none()) {
      throw InputError("stamp_ns: expected none beside a Frame, which has its own, found " +
                       Describe(stamp));
    }
    return images.cast<const PyFrame&>().images;
  }
  SensorFrame frame;
  frame.stamp_ns = ReadStamp(stamp);
  if (!py::isinstance<py::tuple>(images) && !py::isinstance<py::list>(images)) {
    frame.left = ReadGray(images, "images");
    return frame;
  }
  const auto pair = py::reinterpret_borrow<py::sequence>(images);
  const SensorKind kind = KindOf(calibration);
  const std::size_t wanted = kind == SensorKind::kMono ? 1 : 2;
  if (pair.size() != wanted) {
    throw InputError(
        fmt::format("images: expected {} for {}, found {}", wanted, NameOf(kind), pair.size()));
  }
  frame.left = ReadGray(py::object(pair[0]), "left");
  if (kind == SensorKind::kStereo) frame.right = ReadGray(py::object(pair[1]), "right");
  if (kind == SensorKind::kRgbd) {
    frame.depth = ReadDepth(py::object(pair[1]), "depth", calibration.depth_factor);
  }
  return frame;
}

// Adds masks, one or a pair, to a frame.
void AddMasks(py::handle mask, SensorFrame& frame) {
  if (mask.is_none()) return;
  const auto read = [](const py::object& one, const char* name) {
    return one.is_none() ? nullptr : std::make_shared<const GrayImage>(ReadGray(one, name));
  };
  if (!py::isinstance<py::tuple>(mask) && !py::isinstance<py::list>(mask)) {
    frame.left_mask = read(py::reinterpret_borrow<py::object>(mask), "mask");
    return;
  }
  const auto pair = py::reinterpret_borrow<py::sequence>(mask);
  if (!frame.right || pair.size() != 2) {
    throw InputError(fmt::format("mask: expected {}, found {} masks",
                                 frame.right ? "one or two" : "one array",
                                 pair.size()));
  }
  frame.left_mask = read(py::object(pair[0]), "mask of the left image");
  frame.right_mask = read(py::object(pair[1]), "mask of the right image");
}

// Samples for a system, which must know their sensor.
std::vector<InertialSample> ReadSamplesFor(const RunningSystem& system, py::handle imu) {
  std::vector<InertialSample> samples = ReadInertialSamples(imu);
  if (imu.is_none() || system.uses_inertial()) return samples;
  throw InputError(
      "imu: expected System(..., imu=FILE) with the calibration of the sensor as well");
}

FrameRecord Process(
    RunningSystem& system, py::handle images, py::handle stamp, py::handle mask, py::handle imu) {
  SensorFrame frame = ReadImages(system.calibration(), images, stamp);
  AddMasks(mask, frame);
  const std::vector<InertialSample> samples = ReadSamplesFor(system, imu);
  const py::gil_scoped_release release;
  system.AddInertial(samples);
  return system.Process(std::move(frame));
}

void Feed(
    RunningSystem& system, py::handle images, py::handle stamp, py::handle mask, py::handle imu) {
  SensorFrame frame = ReadImages(system.calibration(), images, stamp);
  AddMasks(mask, frame);
  const std::vector<InertialSample> samples = ReadSamplesFor(system, imu);
  const py::gil_scoped_release release;
  system.AddInertial(samples);
  system.Feed(std::move(frame));
}

PyAtlas SnapshotOf(RunningSystem& system) {
  const py::gil_scoped_release release;
  return {std::make_shared<const SavedAtlas>(system.CopyMaps())};
}

std::vector<std::string> ContinueIn(RunningSystem& system, const PyAtlas& atlas, bool read_only) {
  const py::gil_scoped_release release;
  return system.Continue(*atlas.saved, read_only);
}

void CheckMapId(const RunResult& finished, const std::optional<std::int64_t>& map) {
  if (!map || finished.atlas.maps().contains(MapId{*map})) return;
  throw InputError(fmt::format("map: expected the id of a map, found {}", *map));
}

using TrajectoryOf = Trajectory (RunResult::*)(MapId) const;

template <TrajectoryOf of>
PoseList TrajectoryIn(RunningSystem& system, const std::optional<std::int64_t>& map) {
  return system.WithFinished("trajectory", [&](const RunResult& finished) {
    CheckMapId(finished, map);
    const auto id = map ? MapId{*map} : finished.MainMap();
    return PoseList{id ? (finished.*of)(*id) : Trajectory()};
  });
}

py::tuple CovariancesIn(RunningSystem& system, const std::optional<std::int64_t>& map) {
  return system.WithFinished("causal_covariances", [&](const RunResult& finished) {
    CheckMapId(finished, map);
    const auto id = map ? MapId{*map} : finished.MainMap();
    std::vector<StampedCovariance> known;
    if (id) known = finished.CausalCovariances(*id);
    std::vector<std::int64_t> stamps;
    Doubles covariances({static_cast<py::ssize_t>(known.size()), py::ssize_t{6}, py::ssize_t{6}});
    double* out = covariances.mutable_data();
    for (const StampedCovariance& pose : known) {
      stamps.push_back(pose.stamp_ns);
      out = std::copy_n(pose.covariance.data(), pose.covariance.size(), out);  // symmetric
    }
    return py::make_tuple(ToArray(stamps), covariances);
  });
}

py::dict PlaceDict(const Recognition& place) {
  py::dict dict;
  dict["frame"] = place.frame.value;
  dict["keyframe"] = place.keyframe.value;
  dict["older"] = place.older.value;
  dict["points"] = place.points;
  dict["lines"] = place.lines;
  dict["log10_chance"] = place.log10_chance;
  dict["moved"] = place.moved;
  dict["turned_deg"] = place.turned_deg;
  dict["scale"] = place.scale;
  return dict;
}

py::dict JoinDict(const MapJoin& join) {
  py::dict dict = PlaceDict(join.place);
  dict["kept"] = join.kept.value;
  dict["gone"] = join.gone.value;
  return dict;
}

py::dict RelocalizationDict(const Relocalization& found) {
  py::dict dict;
  dict["frame"] = found.frame.value;
  dict["keyframe"] = found.keyframe.value;
  dict["points"] = found.points;
  dict["lines"] = found.lines;
  return dict;
}

py::dict EventsOf(RunningSystem& system) {
  MapEvents events;
  {
    const py::gil_scoped_release release;
    events = system.Events();
  }
  py::list loops, joins, relocalizations;
  for (const Recognition& loop : events.loops) loops.append(PlaceDict(loop));
  for (const MapJoin& join : events.joins) joins.append(JoinDict(join));
  for (const Relocalization& found : events.relocalizations) {
    relocalizations.append(RelocalizationDict(found));
  }
  py::dict dict;
  dict["loops"] = loops;
  dict["joins"] = joins;
  dict["relocalizations"] = relocalizations;
  return dict;
}

// Of the events since the last call, each with its "kind", by the frame they belong to.
py::list NewEventsOf(RunningSystem& system) {
  const MapEvents events = system.TakeEvents();
  std::vector<std::pair<FrameId, py::dict>> sorted;
  const auto add = [&](const char* kind, FrameId frame, py::dict dict) {
    dict["kind"] = kind;
    sorted.emplace_back(frame, std::move(dict));
  };
  for (const Recognition& loop : events.loops) add("loop", loop.frame, PlaceDict(loop));
  for (const MapJoin& join : events.joins) add("join", join.place.frame, JoinDict(join));
  for (const Relocalization& found : events.relocalizations) {
    add("relocalization", found.frame, RelocalizationDict(found));
  }
  std::stable_sort(
      sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  py::list list;
  for (const auto& [frame, dict] : sorted) list.append(dict);
  return list;
}

// The files of `plumbline run --out`, without data known only to programs (exit by a signal).
WrittenResults WriteFiles(RunningSystem& system,
                          RunFolder& folder,
                          const Dataset& dataset,
                          std::size_t frames_chosen,
                          RunInertial& inertial,
                          const std::vector<std::string>& arguments) {
  const py::gil_scoped_release release;
  SlamOptions options = system.options();
  folder.Keep();
  RunDescription description{PLUMBLINE_VERSION,
                             dataset.info().path.string(),
                             OptionTable(options).Dump(),
                             options.slam.seed,
                             arguments};
  description.frames_chosen = frames_chosen;
  description.preset = system.preset();
  return system.WithFinished("save", [&](const RunResult& finished) {
    description.notes = inertial.notes();
    const std::vector<std::string>& after = inertial.NotesAfter(finished);
    description.notes.insert(description.notes.end(), after.begin(), after.end());
    return WriteResults({finished,
                         dataset,
                         system.views(),
                         std::move(description),
                         system.first_pose_seconds(),
                         system.start()},
                        folder);
  });
}

// Returns where the files are, and a note, or None, if that is not where they were to be.
py::tuple WriteRun(RunningSystem& system,
                   RunFolder& folder,
                   const std::shared_ptr<Dataset>& dataset,
                   std::size_t frames_chosen,
                   RunInertial& inertial,
                   const std::vector<std::string>& arguments) {
  const WrittenResults written =
      WriteFiles(system, folder, *dataset, frames_chosen, inertial, arguments);
  if (written.failure) throw InputError(*written.failure);
  if (!written.earlier_kept) return py::make_tuple(folder.path(), py::none());
  return py::make_tuple(folder.part(), ToText(NoteOfEarlierKept(folder)));
}

std::unique_ptr<RunFolder> OpenFolder(const std::filesystem::path& folder,
                                      const Dataset& dataset,
                                      const std::optional<std::filesystem::path>& map) {
  std::vector<RunInput> inputs = {{dataset.info().path}};
  if (map) inputs.push_back({*map, true});
  if (dataset.info().ground_truth) inputs.push_back({dataset.info().ground_truth->path});
  CheckApart(folder, inputs);
  return std::make_unique<RunFolder>(folder);
}

void BindRecord(py::module_& module) {
  py::class_<FrameRecord>(module, "FrameResult", "What came of one frame.")
      .def_property_readonly("index", [](const FrameRecord& r) { return r.id.value; })
      .def_readonly("stamp_ns", &FrameRecord::stamp_ns)
      .def_property_readonly(
          "status",
          [](const FrameRecord& r) { return NameOf(r.status); },
          "\"tracked\", \"lost\", \"initializing\" or \"skipped\"")
      .def_readonly(
          "reason", &FrameRecord::reason, "Why there is no pose; empty where there is one.")
      .def_readonly("keyframe", &FrameRecord::keyframe)
      .def_property_readonly(
          "map",
          [](const FrameRecord& r) -> std::optional<std::int64_t> {
            if (!r.map.valid()) return std::nullopt;
            return r.map.value;
          },
          "Id of the map that the pose was reported in, or None.")
      .def_property_readonly(
          "world_from_camera",
          [](const FrameRecord& r) -> py::object {
            if (!r.causal_world_from_camera) return py::none();
            return ToArray(*r.causal_world_from_camera);
          },
          "(4, 4) of the left camera as delivered, as first reported, or None; a new array.")
      .def_property_readonly(
          "covariance",
          [](const FrameRecord& r) -> py::object {
            if (!r.causal_covariance) return py::none();
            return ToArray(*r.causal_covariance);
          },
          "(6, 6) of world_from_camera relative to the map, of x, y, z and the rotation about x, "
          "y, z "
          "along the axes of the world, metres (with one camera: the map's unit) and radians; None "
          "where there is no pose, or it starts a map; a new array.")
      .def_property_readonly("matched_points",
                             [](const FrameRecord& r) { return r.counts.matched_points; })
      .def_property_readonly("matched_lines",
                             [](const FrameRecord& r) { return r.counts.matched_lines; })
      .def_property_readonly("inlier_points",
                             [](const FrameRecord& r) { return r.counts.inlier_points; })
      .def_property_readonly("inlier_lines",
                             [](const FrameRecord& r) { return r.counts.inlier_lines; })
      .def_property_readonly(
          "times_ms",
          [](const FrameRecord& r) {
            py::dict times;
            for (const StageTime& time : r.times) times[py::str(time.stage)] = time.milliseconds;
            return times;
          },
          "Milliseconds of each stage, \"total\" from the frame's arrival to its pose; after_* are "
          "stages since.")
      .def("__repr__", [](const FrameRecord& r) {
        return fmt::format("<FrameResult {}: {}{}>",
                           r.id.value,
                           NameOf(r.status),
                           r.reason.empty() ? "" : ", " + r.reason);
      });
}

void BindFeeding(py::class_<RunningSystem>& system) {
  system
      .def(py::init(&MakeSystem),
           py::arg("calibration"),
           py::arg("seed") = py::none(),
           py::arg("mode") = py::none(),
           py::arg("preset") = py::none(),
           py::arg("imu") = py::none(),
           R"(System(calibration, seed=None, mode=None, preset=None, imu=None, **options)

seed: of the random numbers; mode: "inline", "lockstep" or "live" (slam.seed and slam.mode). preset:
the system of a paper, "rippl" or "good-line-cutting", to which options are added. imu: a file that
tells of an inertial sensor (imu: of a camera file), whose samples come with the frames.
options: groups as dictionaries, features={"line_count": 100}, or dotted keys,
**{"features.line_count": 100}. Raises InputError with the program's message.)")
      .def("process",
           &Process,
           py::arg("images"),
           py::arg("stamp_ns") = py::none(),
           py::arg("mask") = py::none(),
           py::arg("imu") = py::none(),
           R"(process(images, stamp_ns=None, mask=None, imu=None) -> FrameResult

Takes a frame and waits until it is tracked. images: a Frame (its own stamp), an array of uint8
(rows, columns), a pair (left, right), or (left, depth) with depth in metres (float) or in 16 bits
over the calibration's depth_factor. They are copied, and may be changed at once. stamp_ns: whole
nanoseconds, later than the frame before. mask: an array of uint8 like the image, 0 where nothing is
to be used, or a pair of them. imu: samples since the frame before, up to this one: (N, 7), stamp in
nanoseconds, rates in rad/s, forces in m/s^2. The GIL is released meanwhile.)")
      .def("feed",
           &Feed,
           py::arg("images"),
           py::arg("stamp_ns") = py::none(),
           py::arg("mask") = py::none(),
           py::arg("imu") = py::none(),
           R"(feed(images, stamp_ns=None, mask=None, imu=None)

Takes a frame, images, stamp_ns, mask and imu as process() does, and does not wait until it is tracked: with
slam.mode lockstep tracking is up to two frames behind, with live frames may be dropped. results()
tells what came of the frames.)")
      .def("skip",
           &RunningSystem::Skip,
           py::arg("stamp_ns"),
           py::arg("reason"),
           py::call_guard<py::gil_scoped_release>(),
           "skip(stamp_ns, reason)\n\nTakes note of a frame that could not be read.")
      .def("results",
           &RunningSystem::TakeRecords,
           py::call_guard<py::gil_scoped_release>(),
           R"(results() -> list of FrameResult

What came of the frames that were tracked since the last call, in order. Those that process()
returned are left out.)");
}

void BindContinuing(py::class_<RunningSystem>& system) {
  system.def("continue_in",
             &ContinueIn,
             py::arg("atlas"),
             py::arg("read_only") = false,
             R"(continue_in(atlas, read_only=False) -> list of str

Before the first frame: goes on in the active map of an Atlas, where the camera is looked for.
read_only: only localizes, and changes nothing. Returns what makes the map harder to use.)");
}

void BindResults(py::class_<RunningSystem>& system) {
  const auto map = py::arg("map") = py::none();
  system
      .def(
          "finish",
          [](RunningSystem& running) {
            RunInterruptibly([&](const StopCheck& stop) { running.Finish(stop); });
          },
          R"(finish()

Completes the mapping and adjusts the maps; no more frames after that. Ctrl-C cuts the adjustment
short and raises KeyboardInterrupt; the system is finished then, too.)")
      .def_property_readonly("finished", &RunningSystem::finished)
      .def("maps", &SnapshotOf, R"(maps() -> Atlas

A copy of the maps as they are when mapping has done what was handed over so far; at any time after
the first frame. Changes no result but of live runs.)")
      .def("events", &EventsOf, R"(events() -> dict

What changed maps at large so far, when mapping has done what was handed over; at any time. Three
lists of dictionaries, in order: "loops" that were closed, maps that were joined ("joins"),
"relocalizations" of a lost camera. All have "frame" (index), "keyframe" (id), "points" and "lines"
(numbers that agree); loops and joins "older" (the keyframe that shows the same), "log10_chance" (of
so much agreement by chance), "moved" (metres, with one camera the map's unit), "turned_deg" and
"scale" (how the map around the keyframe was corrected); joins "kept" and "gone" (ids of maps).)")
      .def("new_events", &NewEventsOf, R"(new_events() -> list of dict

The events since the last call that are known by now, without waiting for mapping. They are the
dictionaries of events(), each with its "kind": "loop", "join" or "relocalization". None is missing
after finish(); how soon one is told depends on the machine's speed.)")
      .def("trajectory",
           &TrajectoryIn<&RunResult::FinalTrajectory>,
           map,
           R"(trajectory(map=None) -> Trajectory

After finish(): all frames with a pose, in the map with this id (None: where most frames are).)")
      .def("causal_trajectory",
           &TrajectoryIn<&RunResult::CausalTrajectory>,
           map,
           "causal_trajectory(map=None) -> Trajectory\n\nPoses as first reported.")
      .def("keyframe_trajectory",
           &TrajectoryIn<&RunResult::KeyFrameTrajectory>,
           map,
           "keyframe_trajectory(map=None) -> Trajectory\n\nFinal poses of the keyframes.")
      .def_property_readonly(
          "main_map",
          [](RunningSystem& running) {
            return running.WithFinished("main_map",
                                        [](const RunResult& s) -> std::optional<std::int64_t> {
                                          if (!s.MainMap()) return std::nullopt;
                                          return s.MainMap()->value;
                                        });
          },
          "After finish(): id of the map in which most frames have a pose, or None.")
      .def_property_readonly("calibration", &RunningSystem::calibration)
      .def_property_readonly(
          "options",
          [](const RunningSystem& running) {
            SlamOptions options = running.options();
            return ValuesOf(OptionTable(options));
          },
          "All options in groups; a new dictionary.");
}

}  // namespace

void BindSystem(py::module_& module) {
  BindRecord(module);
  py::class_<RunningSystem> system(
      module, "System", R"(The whole of SLAM for one camera: feed frames
in order, then finish(). Poses are world_from_camera of the left camera as delivered; the world is
that camera at the first keyframe of each map. One thread at a time; several systems may run in
several threads. With the modes lockstep (the default) and live it has threads, which fork() does
not copy: in a forked child it never answers. Make systems in the child, or use processes that
start anew (multiprocessing's "spawn").)");
  BindFeeding(system);
  BindContinuing(system);
  BindResults(system);
  system.def("causal_covariances",
             &CovariancesIn,
             py::arg("map") = py::none(),
             R"(causal_covariances(map=None) -> (numpy.ndarray, numpy.ndarray)

After finish(): stamps (N,) in nanoseconds and covariances (N, 6, 6) of the poses of
causal_trajectory(), as FrameResult.covariance; those that start a map have none. New arrays.)");
  system.def("__repr__", [](const RunningSystem& running) {
    return fmt::format("<System, {}, {}>",
                       NameOf(KindOf(running.calibration())),
                       running.finished() ? "finished" : "runs");
  });
  system.def("_keep_views", &RunningSystem::KeepViews);
  py::class_<RunFolder>(module, "_RunFolder").def(py::init(&OpenFolder));
  module.def("_write_run", &WriteRun);
}

}  // namespace plumbline::python
