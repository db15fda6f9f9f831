// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/report/sample_image.h"
#include "plumbline/slam/system.h"

#include "tests/support/moving_poster.h"
#include <string>
#include <utility>

namespace plumbline {

// The poster as a data set, with its true poses.
class PosterDataset : public Dataset {
 public:
  explicit PosterDataset(int frames, bool with_truth = true, const std::string& name = "poster")
      : Dataset(Info(frames, with_truth, name)) {}
  explicit PosterDataset(DatasetInfo info) : Dataset(std::move(info)) {}
  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    return poster_.Frame(static_cast<int>(i));
  }

 private:
  static DatasetInfo Info(int frames, bool with_truth, const std::string& name) {
    DatasetInfo info;
    info.name = name;
    info.sensor = SensorKind::kStereo;
    info.calibration = MovingPoster::MakeCalibration();
    GroundTruth truth;
    for (int i = 0; i < frames; ++i) {
      info.stamps_ns.push_back(MovingPoster::StampNs(i));
      truth.poses.push_back({MovingPoster::StampNs(i),
                             {Eigen::Quaterniond::Identity(), {i * MovingPoster::kStep, 0, 0}}});
    }
    if (with_truth) info.ground_truth = truth;
    return info;
  }

  MovingPoster poster_;
};

// Six frames of the poster: the third skipped, the fifth lost.
class PosterRun {
 public:
  explicit PosterRun(const SlamOptions& options = {}) {
    System system(MovingPoster::MakeCalibration(), options);
    const MovingPoster poster;
    for (int i = 0; i < 6; ++i) {
      if (i == 2) {
        system.Skip(MovingPoster::StampNs(i), "image_unreadable");
      } else {
        system.Process(i == 4 ? MovingPoster::BlindFrame(i) : poster.Frame(i));
        if (i == 3) sample_ = MakeSampleImage(system.view(), "overlay_000003.png");
      }
    }
    view_ = system.view();
    result_ = system.Finish();
  }
  const RunResult& result() const { return result_; }
  // Of the last frame.
  const FrameView& view() const { return view_; }
  // Of the fourth frame.
  const SampleImage& sample() const { return sample_; }

 private:
  RunResult result_;
  FrameView view_;
  SampleImage sample_;
};

}  // namespace plumbline
