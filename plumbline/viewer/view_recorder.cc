// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/view_recorder.h"

namespace plumbline {

ViewRecorder::ViewRecorder(const std::filesystem::path& path) : file_(path) {
  for (const FoxgloveChannel& channel : FoxgloveChannels()) {
    file_.AddChannel({std::string(channel.topic),
                      "protobuf",
                      std::string(channel.type),
                      "protobuf",
                      FoxgloveSchemas()});
  }
}

void ViewRecorder::Record(ViewState& state) {
  const std::int64_t stamp_ns = state.stamp_ns();
  for (unsigned i = 0; i < kStreams; ++i) {
    const SharedBytes message = state.Next(static_cast<Stream>(i), cursor_, stamp_ns);
    if (message) file_.Write(static_cast<std::uint16_t>(i), stamp_ns, *message);
  }
}

}  // namespace plumbline
