// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/run_folder.h"
#include "worlds/sequence.h"
#include "worlds/world_catalog.h"
#include "worlds/write_sequence.h"

#include "apps/command_line.h"
#include "arrays.h"
#include "bindings.h"
#include "frames.h"
#include "interruptible.h"
#include "iteration.h"
#include "options.h"
#include "texts.h"
#include "trajectories.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

int Threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

SynthOptions ReadSynthOptions(const std::string& world, const py::kwargs& given) {
  SynthOptions options = OpenWorld(world).defaults;
  SetOptions(given, options);
  return options;
}

std::shared_ptr<SyntheticSequence> MakeSequence(const std::string& world, const py::kwargs& given) {
  const SynthOptions options = ReadSynthOptions(world, given);
  const py::gil_scoped_release release;
  return std::make_shared<SyntheticSequence>(world, options, Threads());
}

PyFrame RenderFrame(const SyntheticSequence& sequence, py::ssize_t index) {
  const auto size = static_cast<py::ssize_t>(sequence.size());
  if (index < -size || index >= size) {
    throw py::index_error(
        fmt::format("frame: expected -{} to {}, found {}", size, size - 1, index));
  }
  const auto i = static_cast<int>(index < 0 ? index + size : index);
  const py::gil_scoped_release release;
  const Rendering left = sequence.RenderIdeal(i, 0);
  PyFrame frame;
  frame.images.stamp_ns = sequence.StampNs(i);
  frame.images.left = sequence.Sense(left.light, i, 0);
  frame.images.right = sequence.RenderImage(i, 1);
  frame.images.depth = sequence.SenseDepthOf(left.depth, i);
  return frame;
}

// Thrown if the progress callback requests a stop.
struct Stopped {};

int WriteWorld(const std::string& world,
               const std::filesystem::path& folder,
               const std::string& format_name,
               const py::kwargs& given) {
  const SynthOptions options = ReadSynthOptions(world, given);
  const auto format = ParseChoice<SequenceFormat>("format", format_name);
  if (!OpenWorld(world).text.empty()) CheckApart(folder, std::array{RunInput{world}});
  int frames = 0;
  RunInterruptibly([&](const StopCheck& stop) {
    CheckSequenceFolder(folder);
    const SyntheticSequence sequence(world, options, Threads());
    frames = sequence.size();
    try {
      WriteSequence(sequence, format, folder, Threads(), [&](int) {
        if (stop()) throw Stopped();
      });
    } catch (const Stopped&) {
      return;  // RunInterruptibly raises
    }
  });
  return frames;
}

py::dict ListWorlds() {
  py::dict worlds;
  for (const WorldEntry& world : Worlds()) worlds[py::str(world.name)] = world.help;
  return worlds;
}

Doubles TrueLines(const SyntheticSequence& sequence) {
  std::vector<Segment3> segments;
  {
    const py::gil_scoped_release release;
    for (const TrueLine& line : sequence.Lines(Threads())) segments.push_back(line.segment);
  }
  return ToArray(segments);
}

}  // namespace

void BindSynth(py::module_& module) {
  py::class_<SyntheticSequence, std::shared_ptr<SyntheticSequence>>(
      module, "Synth", R"(A recording of
an invented world, rendered frame by frame as it is asked for: stereo pairs with depth, exact poses
and lines. len(), indices and iteration give Frame.)")
      .def(py::init(&MakeSequence),
           py::arg("world"),
           R"(Synth(world, **options)

A world of worlds(). options: those of `plumbline synth`, such as frames=10, scale=0.5, seed=2.
Raises InputError with the program's message.)")
      .def("__len__", &SyntheticSequence::size)
      .def("__repr__",
           [](const SyntheticSequence& s) {
             return fmt::format("<Synth {}: {} frames>", s.world(), s.size());
           })
      .def("__iter__", &IterateByIndex)
      .def("__getitem__", &RenderFrame, py::arg("index"), "The frame, rendered now, with depth.")
      .def_property_readonly("calibration", &SyntheticSequence::calibration)
      .def_property_readonly("world", &SyntheticSequence::world)
      .def_property_readonly(
          "ground_truth",
          [](const SyntheticSequence& s) { return PoseList{s.GroundTruth()}; },
          "Trajectory of the left camera, a pose for each frame.")
      .def("true_lines", &TrueLines, R"(true_lines() -> numpy.ndarray

(N, 2, 3) ends of the lines of the world that the left camera sees, metres. A new array.)");
  module.def("worlds", &ListWorlds, "worlds() -> dict of str: str\n\nNames and what is in them.");
  module.def("render",
             &WriteWorld,
             py::arg("world"),
             py::arg("path"),
             py::arg("format") = "euroc",
             R"(render(world, path, format="euroc", **options) -> int

Renders a world into a folder, as `plumbline synth`: "euroc" (stereo) or "tum" (RGB-D), with ground
truth. Returns the number of frames. Ctrl-C raises KeyboardInterrupt.)");
}

}  // namespace plumbline::python
