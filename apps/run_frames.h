// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"
#include "plumbline/live/live_source.h"
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

// What a run is fed with.
struct RunFrames {
  std::shared_ptr<const Dataset> dataset;  // of a live source: what is known of it, no frames
  std::vector<std::size_t> frames;         // by index in the data set
  std::shared_ptr<LiveSource> live;        // in place of a data set; may be null
  FrameSelection range;                    // of its frames
  int blur = 0;                            // box filter on every image; 0: none
  int save_every_s = 0;                    // map.plb into the part of the folder; 0: never
  std::shared_ptr<Viewer> viewer;          // that shows the run; may be null
};

// Frames that are shown with their features, kept until there is time to draw them.
class KeptViews {
 public:
  // Views are kept of some of the frames, spread evenly. Of a live source, whose
  // end nobody knows: of every n-th, where n doubles when there are too many.
  explicit KeptViews(const RunFrames& input);

  void Offer(std::size_t position, const FrameView& view);
  // The number of the frame as played, and the view.
  const std::vector<std::pair<std::size_t, FrameView>>& views() const { return views_; }

 private:
  void OfferOfMany(std::size_t position, const FrameView& view);

  std::set<std::size_t> wanted_;  // positions in the run
  std::vector<std::pair<std::size_t, FrameView>> views_;
  bool live_ = false;
  std::size_t every_ = 1;  // position that is kept, of a live source
};

// How far a run came.
struct Processed {
  std::optional<double> first_pose_seconds;  // from the start of the process
  // Why not all frames were taken, or mapping is not complete: an InputError, with what the machine
  // was short of too, or something unforeseen.
  std::exception_ptr failure;
  std::optional<std::string> not_recorded;  // why --record has no whole file
  std::vector<std::string> notes;           // what the images showed to be wrong with the data
  bool no_depth = false;                    // there were depth images, and all were zero everywhere
};

// Reads the frames and feeds them to the system until there are no more, somebody asks to stop
// (StopRequested) or something fails, then completes the mapping. Each step ends within a second
// when a signal asks for it. What there is so far is kept in the journal's files, all of it before
// the maps are adjusted at the end.
//
// Bad input in the middle, such as an image of another size, ends a run, as do memory and threads
// that run out; what was done until then is kept. Throws when that is nothing.
Processed ProcessFrames(
    const RunFrames& input, bool quiet, System& system, RunFolder& folder, KeptViews& views);

}  // namespace plumbline
