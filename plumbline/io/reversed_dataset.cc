// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/reversed_dataset.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace plumbline {
namespace {

DatasetInfo Reversed(DatasetInfo info, const std::vector<std::size_t>& frames) {
  const std::vector<std::int64_t> recorded = std::move(info.stamps_ns);
  const std::int64_t mirror_ns = recorded.at(frames.front()) + recorded.at(frames.back());
  info.time_mirror_ns = mirror_ns;
  info.stamps_ns.clear();
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    info.stamps_ns.push_back(mirror_ns - recorded.at(*frame));
  }
  if (info.ground_truth) {
    info.ground_truth->poses = TimeReversed(std::move(info.ground_truth->poses), mirror_ns);
  }
  return info;
}

class ReversedDataset : public Dataset {
 public:
  ReversedDataset(std::unique_ptr<Dataset> recorded, std::vector<std::size_t> frames)
      : Dataset(Reversed(recorded->info(), frames)),
        recorded_(std::move(recorded)),
        frames_(std::move(frames)) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    Expected<SensorFrame, ImageFailure> read = recorded_->Read(frames_.at(size() - 1 - i));
    if (!read) return read;
    SensorFrame frame = *std::move(read);
    frame.stamp_ns = stamp_ns(i);
    return frame;
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    return recorded_->ReadColor(frames_.at(size() - 1 - i));
  }

 private:
  std::unique_ptr<Dataset> recorded_;
  std::vector<std::size_t> frames_;  // indices in recorded_, ascending
};

}  // namespace

std::unique_ptr<Dataset> PlayedBackwards(std::unique_ptr<Dataset> recorded,
                                         std::vector<std::size_t> frames) {
  PLUMBLINE_CHECK(!frames.empty() && std::is_sorted(frames.begin(), frames.end()),
                  "frames to play backwards in order");
  if (recorded->info().format == DatasetFormat::kVideo) {
    throw InputError(recorded->info().path.string() +
                     ": expected image files to play backwards, found a video, which can be read "
                     "in its order only");
  }
  return std::make_unique<ReversedDataset>(std::move(recorded), std::move(frames));
}

}  // namespace plumbline
