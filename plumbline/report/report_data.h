// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/sample_image.h"
#include "plumbline/report/shown_frames.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/run_result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumbline {

// Data of the page in addition to that of System and Dataset.
struct ReportContext {
  RunDescription description;
  ResourceUse resources;
  std::string date;  // shown verbatim
  std::vector<SampleImage> samples;
  // The page shows every n-th frame of a run with more frames than this (ShownFrames).
  std::size_t most_frames = ShownFrames::kMost;
};

// Returns all data of report.html as one JSON object with the keys of report_page.js: "run" (source
// and options), "counts" (of all frames), "frames" (columns, one row for each displayed frame, with
// its number), "stages" (times, of the same rows; statistics of all frames), "scene" (maps,
// trajectories, errors, loops and the like; arrays of float32 in base64, metres, relative to
// "origin"), "samples" (images as data: URIs, with their features), "lens" (what is used of it,
// with its outline in the image as delivered; null if all of it is). References to frames are rows,
// except in "keyframe_frames" and "relative_to", which have numbers of frames.
//
// Text that is not UTF-8 is repaired.
//
//   cost  O(frames + landmarks)
std::string FormatReportData(const RunResult& result,
                             const Dataset& dataset,
                             const ReportContext& context);

}  // namespace plumbline
