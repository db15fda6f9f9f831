// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/live/open_live_source.h"

#include "plumbline/live/capture_source.h"
#include "plumbline/live/raw_stream.h"

#include <unistd.h>

namespace plumbline {

std::unique_ptr<LiveSource> OpenLiveSource(const std::string& name, const LiveOptions& options) {
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

}  // namespace plumbline
