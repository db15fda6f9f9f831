// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/trajectory_io.h"

#include "fuzz/input_folder.h"

namespace {

const plumbline::InputFolder& Folder() {
  static const plumbline::InputFolder folder;
  static const auto times = folder.Write("times.txt", "0\n0.1\n0.2\n");
  return folder;
}

}  // namespace

// Trajectories of all formats; one that was read can be written in TUM form and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  const std::filesystem::path file = Folder().Write("input.txt", AsText(data, size));
  LoadedTrajectory loaded;
  try {
    const LoadedTrajectory reference = ReadTrajectory(file, BadRows::kLeaveOut);
    PLUMBLINE_CHECK(!reference.poses.empty(), "a reference has poses");
    loaded = ReadTrajectory(file);
    // Nothing is left out of a file without faults.
    PLUMBLINE_CHECK(reference.poses.size() == loaded.poses.size(), "the same poses");
  } catch (const InputError&) {
    return 0;
  }
  const LoadedTrajectory again =
      ReadTrajectory(Folder().Write("written.txt", FormatTum(loaded.poses)));
  PLUMBLINE_CHECK(again.poses.size() == loaded.poses.size(), "poses come back");
  return 0;
}
