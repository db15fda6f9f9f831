// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/open_live_source.h"

#include "plumbline/io/datasets/frame_preparation.h"

#include <utility>
#include <variant>

#include <unistd.h>

namespace plumbline {
namespace {

// A source whose frames are prepared.
class PreparedSource : public LiveSource {
 public:
  PreparedSource(std::unique_ptr<LiveSource> source,
                 FramePreparation preparation,
                 const ImageTurn& turn)
      : LiveSource(Prepared(source->info(), preparation, turn)),
        source_(std::move(source)),
        preparation_(std::move(preparation)) {}

  LiveEvent Next() override {
    LiveEvent event = source_->Next();
    if (auto* frame = std::get_if<SensorFrame>(&event)) {
      *frame = preparation_.Apply(std::move(*frame));
    }
    return event;
  }

 private:
  std::unique_ptr<LiveSource> source_;
  FramePreparation preparation_;
};

std::unique_ptr<LiveSource> OpenByKind(const std::string& name, const LiveOptions& options) {
  const auto kind = LiveKindOf(name);
  PLUMBLINE_CHECK(kind.has_value(), "the name of a live source");
  if (*kind != LiveKind::kStandardInput) return OpenCapture(name, *kind, options);
  if (options.side_by_side) {
    throw InputError(
        "--side-by-side: expected a camera, found standard input, whose header names "
        "both images");
  }
  return OpenRawStream(STDIN_FILENO, options);
}

}  // namespace

std::unique_ptr<LiveSource> OpenLiveSource(const std::string& name, const LiveOptions& options) {
  std::unique_ptr<LiveSource> source = OpenByKind(name, options);
  const ImageTurn turn{TurnOf(options.rotate)};
  try {
    FramePreparation preparation(
        source->info().calibration, turn.orientation, PreparationOf(options));
    if (preparation.IsIdentity()) return source;
    return std::make_unique<PreparedSource>(std::move(source), std::move(preparation), turn);
  } catch (const InputError& error) {
    throw InputError(source->info().name + ": " + error.what());
  }
}

}  // namespace plumbline
