// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/run_results.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/path_overlap.h"
#include "plumbline/report/html_report.h"
#include "plumbline/report/run_files.h"
#include "plumbline/report/sample_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

// Reasons of frames without a pose (FrameRecord::reason), in words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kReasonsInWords = {
    {{"too_few_features", "too few points and lines are seen, or too few with depth"},
     {"too_few_matches", "too little of what was seen before is seen again"},
     {"too_few_inliers", "what is matched contradicts itself"},
     {"pose_not_observable", "what is seen leaves a direction open"},
     {"not_relocalized", "the place is not found in the map"},
     {"map_withdrawn", "the map proved wrong"},
     {"not_mapped", "mapping failed"},
     {"dropped", "there was no time"},
     {"mask_black", "the mask leaves nothing of the image"},
     {"image_unreadable", "the image cannot be read"},
     {"image_size", "the image has another size than the calibration"},
     {"source_lost", "the source gives no images"},
     {"too_little_parallax", "the camera moves too little sideways"},
     {"ambiguous", "a plane, or motion straight ahead, has two interpretations"},
     {"too_few_frames", "too few frames in a row can be followed for a start"},
     {"inaccurate", "what is seen does not fit or is too inaccurate for a start"}}};

class ResultWriter {
 public:
  ResultWriter(const FinishedRun& run, RunFolder& folder) : run_(run), folder_(folder) {}

  WrittenResults WriteAll() {
    for (const RunFile& file : PoseFiles(run_.result)) Write(file);
    Write({"options.yaml",
           [&](const auto& path) { WriteFileAtomically(path, run_.description.options_yaml); }});
    Write(MapFile(run_.result));
    MakeLineMaps();
    NoteSignal();
    WriteSummary();
    for (const RunFile& file : DerivedFiles(run_.result)) Write(file);
    WriteReport();
    DrawViews();
    if (NoteSignal()) {  // it came after the summary was written
      WriteSummary();
      WriteReport();
    }
    if (KeepsEarlier()) return {folder_.Failures(), interrupted_, true};
    return {PutInPlace(), interrupted_};
  }

 private:
  static std::string NameOfView(std::size_t frame) {
    return fmt::format("overlay_{:06}.png", frame);
  }

  void Write(const RunFile& file) { folder_.Write(file); }

  // A lack of memory is left to the files that need the line maps, which then fail.
  void MakeLineMaps() const {
    const StopCheck stop = StepStop();
    try {
      for (const auto& [id, map] : run_.result.atlas.maps()) run_.result.LineMap(id, stop);
    } catch (const std::bad_alloc&) {
      return;
    }
  }

  // Returns true at the first observation of a signal.
  bool NoteSignal() {
    if (interrupted_) return false;
    interrupted_ = FirstStopSignal();
    if (interrupted_) description_.interrupted = interrupted_->name;
    return interrupted_.has_value();
  }

  ResourceUse Resources() const {
    ResourceUse resources = MeasureResources();
    resources.first_pose_seconds = run_.first_pose_seconds;
    resources.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - run_.start).count();
    return resources;
  }

  void WriteSummary() {
    resources_ = Resources();
    Write({"summary.json", [&](const auto& path) {
             WriteFileAtomically(
                 path, FormatSummary(description_, run_.result, run_.dataset, resources_));
           }});
  }

  void WriteReport() {
    Write({"report.html", [&](const auto& path) {
             std::vector<SampleImage> samples;
             for (const auto& [frame, view] : run_.views.views()) {
               samples.push_back(MakeSampleImage(view, NameOfView(frame)));
             }
             WriteHtmlReport(run_.result,
                             run_.dataset,
                             {description_, resources_, {}, std::move(samples)},
                             path.parent_path());
           }});
  }

  void DrawViews() {
    const StopCheck stop = StepStop();
    for (const auto& [frame, view] : run_.views.views()) {
      if (stop()) return;
      Write({NameOfView(frame),
             [&view = view](const auto& path) { WriteFeatureOverlay(view, path); }});
    }
  }

  // Returns true if an earlier run's results are more valuable: this one has no pose, or it was
  // interrupted, also at its end, or failed before its last frame, and has fewer poses of the same
  // data.
  bool KeepsEarlier() const {
    const std::optional<EarlierRun> earlier = folder_.Earlier();
    if (!earlier) return false;
    const RunCounts counts = CountRun(run_.result);
    if (counts.tracked == 0) return true;
    const bool cut_off =
        (interrupted_ && !run_.live) || run_.result.frames.size() < description_.frames_chosen;
    const bool same = !earlier->data.empty() && IsSamePath(earlier->data, description_.data_path);
    return cut_off && same && static_cast<std::size_t>(counts.in_trajectory) < earlier->poses;
  }

  std::optional<std::string> PutInPlace() {
    if (folder_.WouldLose()) {
      return fmt::format("{} ({} keeps the earlier results, {} has what could be written)",
                         *folder_.Failures(),
                         folder_.path().string(),
                         folder_.part().string());
    }
    try {
      folder_.Commit();
    } catch (const InputError& error) {
      const auto failures = folder_.Failures();
      return (failures ? *failures + "; " : std::string()) + error.what();
    }
    return folder_.Failures();
  }

  const FinishedRun& run_;
  RunFolder& folder_;
  RunDescription description_ = run_.description;
  std::optional<StopSignal> interrupted_;
  ResourceUse resources_;
};

}  // namespace

WrittenResults WriteResults(const FinishedRun& run, RunFolder& folder) {
  return ResultWriter(run, folder).WriteAll();
}

std::string NoteOfEarlierKept(const RunFolder& folder) {
  return fmt::format(
      "{} keeps the results of an earlier run, which has more poses; {} has those of this one",
      folder.path().string(),
      folder.part().string());
}

std::optional<std::string> WhyNoPose(const FrameLog& frames, bool no_depth) {
  std::map<std::string, int> counts;
  for (const FrameRecord& frame : frames) {
    if (frame.status == FrameStatus::kTracked) return std::nullopt;
    ++counts[frame.reason];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  std::string why = "no frame has a pose";
  if (most != counts.end()) {
    const auto known =
        std::find_if(kReasonsInWords.begin(), kReasonsInWords.end(), [&](const auto& reason) {
          return reason.first == most->first;
        });
    const std::string words =
        known == kReasonsInWords.end() ? "" : fmt::format("{} ", known->second);
    why +=
        fmt::format(": {}({}) in {} of {} frames", words, most->first, most->second, frames.size());
  }
  return no_depth ? why + "; depth is zero everywhere" : why;
}

namespace {

// Prints the correction of the lens that the run found, from one pixel on.
void PrintLens(const RunResult& result) {
  const auto main = result.MainMap();
  const Map* map = main ? result.atlas.Find(*main) : nullptr;
  const double border_px = map != nullptr ? map->correction().lens.border_px() : 0;
  if (std::abs(border_px) < 1) return;
  std::cout << fmt::format(
      "lens: corrected by {:.1f} px at the image's side, beyond the "
      "calibration\n",
      border_px);
}

}  // namespace

void PrintResult(const RunResult& result, const Dataset& dataset, const std::string& folder) {
  const RunCounts counts = CountRun(result);
  std::cout << fmt::format(
      "frames {}: {} tracked, {} lost, {} skipped{}{}\n",
      counts.frames,
      counts.tracked,
      counts.lost,
      counts.skipped,
      counts.dropped > 0 ? fmt::format(" ({} dropped)", counts.dropped) : std::string(),
      counts.initializing > 0 ? fmt::format(", {} before a map", counts.initializing)
                              : std::string());
  if (counts.shed_mapping + counts.shed_lines + counts.shed_points > 0) {
    std::cout << fmt::format(
        "load was reduced to keep up with the camera: in {} frames less mapping, in {} fewer lines "
        "as well, in {} fewer lines and points as well\n",
        counts.shed_mapping,
        counts.shed_lines,
        counts.shed_points);
  }
  if (counts.demoted > 0) {
    std::cout << fmt::format("mapping left out {}\n", Counted(counts.demoted, "keyframe"));
  }
  const auto made = std::count_if(result.frames.begin(),
                                  result.frames.end(),
                                  [](const FrameRecord& frame) { return frame.keyframe; });
  std::cout << fmt::format(
      "map: {}{}, {}, {}{}\n",
      Counted(counts.keyframes, "keyframe"),
      made > counts.keyframes ? fmt::format(" (of {} made)", made) : std::string(),
      Counted(counts.points, "point"),
      Counted(counts.lines, "line"),
      counts.maps > 1 ? fmt::format(" (largest of {} maps)", counts.maps) : std::string());
  PrintLens(result);
  if (const auto gyroscope = DescribeGyroscope(result)) std::cout << *gyroscope << '\n';
  const auto error = CompareWithGroundTruth(result, dataset);
  if (error) {
    const double scale = error->reference_from_estimate.scale;
    const bool mono = dataset.sensor() == SensorKind::kMono;
    std::cout << fmt::format(
        "ATE {:.4f} m RMSE{} over {} poses, coverage {:.1f} %\n",
        error->ate.rmse,
        mono ? fmt::format(" (scale {:.4g})", scale) : std::string(),
        error->poses.size(),
        100.0 * static_cast<double>(error->estimated) / std::max(counts.frames, 1));
  } else if (counts.tracked > 0 && !dataset.info().ground_truth_fault) {  // told at the start
    std::cout << "no errors: " << WhyNoErrors(dataset.info()) << '\n';
  }
  std::cout << "results in " << Printable(folder, kLongestMessage) << '\n';
}

}  // namespace plumbline
