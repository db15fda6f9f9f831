// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_bench.h"

#include "lab/starts/sequence_truth.h"
#include "plumbline/slam/front_end.h"

#include <algorithm>
#include <map>
#include <utility>

namespace plumbline {
namespace {

// Frames with their features, extracted when first asked for.
class ExtractedFrames {
 public:
  ExtractedFrames(const Dataset& dataset, const FrontEnd& front_end)
      : dataset_(dataset), front_end_(front_end) {}

  std::optional<InitializationFrame> Get(int index) {
    const auto known = frames_.find(index);
    if (known != frames_.end()) return known->second;
    return frames_.emplace(index, Extract(index)).first->second;
  }

  void ForgetBefore(int index) { frames_.erase(frames_.begin(), frames_.lower_bound(index)); }

 private:
  std::optional<InitializationFrame> Extract(int index) const {
    auto read = dataset_.Read(static_cast<std::size_t>(index));
    if (!read) return std::nullopt;
    ExtractedFrame extracted = front_end_.Extract(*read);
    return InitializationFrame{FrameId{index},
                               extracted.stamp_ns,
                               std::move(extracted.indexed),
                               std::make_shared<const GrayImage>(std::move(extracted.images.left))};
  }

  const Dataset& dataset_;
  const FrontEnd& front_end_;
  std::map<int, std::optional<InitializationFrame>> frames_;
};

}  // namespace

std::vector<int> EveryStart(std::size_t frames, int from, int every) {
  std::vector<int> starts;
  for (int frame = from; frame + 1 < static_cast<int>(frames); frame += every) {
    starts.push_back(frame);
  }
  return starts;
}

StartRange RangeOf(const Dataset& dataset, int first, double seconds, double patience) {
  const auto begin = static_cast<std::size_t>(first);
  const auto end_of = [&](double limit) {
    std::size_t end = begin;
    while (end < dataset.size() &&
           1e-9 * static_cast<double>(dataset.stamp_ns(end) - dataset.stamp_ns(begin)) <= limit) {
      ++end;
    }
    return static_cast<int>(end);
  };
  return {first, end_of(seconds), end_of(std::max(seconds, patience))};
}

StartResults RunStarts(const Dataset& mono,
                       const std::optional<std::string>& camera,
                       const StartOptions& options,
                       const StartPlan& plan,
                       const InitializerFactory& make_initializer,
                       const std::function<bool(std::size_t done)>& progress) {
  const FrontEnd front_end(mono.calibration(), options.features);
  const SequenceTruth truth(mono, front_end.rectifier(), camera, plan.poses);
  const CameraAndPyramid imaging{front_end.rectifier().camera(), options.features.orb.scale_factor};
  ExtractedFrames extracted(mono, front_end);
  const StartFrames frames = [&extracted](int index) { return extracted.Get(index); };
  const StartTask task{frames, truth, imaging.camera, plan.limits, plan.on_map};
  StartResults results;
  for (const int first : plan.frames) {
    extracted.ForgetBefore(first);
    const auto initializer = make_initializer(imaging);
    results.records.push_back(TryStart(
        RangeOf(mono, first, plan.seconds, plan.patience), task, *initializer, results.add_ms));
    if (progress && !progress(results.records.size())) break;
  }
  return results;
}

}  // namespace plumbline
