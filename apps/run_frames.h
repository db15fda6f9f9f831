// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/inertial/inertial_recording.h"
#include "plumbline/io/live/live_source.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/report/run_journal.h"
#include "plumbline/slam/system.h"

#include "apps/frame_input.h"
#include <cstddef>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

class Viewer;

// Input of a run.
struct RunFrames {
  std::shared_ptr<const Dataset> dataset;  // of a live source: its description, without frames
  std::vector<std::size_t> frames;         // by index in the data set
  std::shared_ptr<LiveSource> live;        // replaces a data set; may be null
  FrameSelection range;                    // of the live source's frames
  // the inertial sensor; null: none
  std::shared_ptr<const InertialRecording> inertial;
  int blur = 0;  // box filter on every image; 0: none
  // interval of writing map.plb into the part of the folder; 0: never
  int save_every_s = 0;
  std::shared_ptr<Viewer> viewer;  // displays the run; may be null
};

// Frames to be shown with their features, stored until they can be drawn.
class KeptViews {
 public:
  // Stores views of some of the frames, spread evenly; of a live source, whose length is unknown,
  // of every n-th, where n doubles when there are too many.
  explicit KeptViews(const RunFrames& input);

  void Offer(std::size_t position, const FrameView& view);
  // Number of the frame as played, and its view.
  const std::vector<std::pair<std::size_t, FrameView>>& views() const { return views_; }

 private:
  void OfferOfMany(std::size_t position, const FrameView& view);

  std::set<std::size_t> wanted_;  // positions in the run
  std::vector<std::pair<std::size_t, FrameView>> views_;
  bool live_ = false;
  std::size_t every_ = 1;  // interval of stored positions, for a live source
};

// Progress of a run at its end.
struct Processed {
  std::optional<double> first_pose_seconds;  // from the start of the process
  RunResult result;
  // Reason why not all frames were taken, or mapping is not complete: an InputError, also for a
  // lack of memory or threads, or something unexpected.
  std::exception_ptr failure;
  std::optional<std::string> not_recorded;  // reason why --record has no complete file
  std::vector<std::string> notes;           // faults of the data found in the images
  // true if there were depth images, all of them zero everywhere
  bool no_depth = false;
};

// Reads the frames and feeds them to the system until there are no more, a stop is requested
// (StopRequested) or something fails, then completes the mapping. Each step ends within a second
// after a signal. Intermediate results are kept in the journal's files, all of them before the
// final adjustment of the maps.
//
// A lack of memory or threads in the middle ends a run; results so far are kept. Throws if there
// are none.
Processed ProcessFrames(
    const RunFrames& input, bool quiet, System& system, RunFolder& folder, KeptViews& views);

}  // namespace plumbline
