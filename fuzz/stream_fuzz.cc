// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/live/open_live_source.h"

#include "fuzz/input_folder.h"
#include <string>
#include <variant>

#include <fcntl.h>
#include <unistd.h>

// Frames on standard input, of a pair of 4x2 pixels where the header says what the camera file
// does.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  static const InputFolder folder;
  static const LiveOptions options{
      .camera =
          folder
              .Write("camera.yaml",
                     "size: [4, 2]\nintrinsics: [5, 5, 2, 1]\nrectified: true\nbaseline: 0.1\n"
                     "right:\n  size: [4, 2]\n  intrinsics: [5, 5, 2, 1]\n")
              .string()};
  const std::filesystem::path stream = folder.Write("stream", AsText(data, size));
  const int descriptor = ::open(stream.c_str(), O_RDONLY | O_CLOEXEC);
  PLUMBLINE_CHECK(descriptor >= 0, "the file was just written");
  try {
    const auto source = OpenRawStream(descriptor, options);
    while (!std::holds_alternative<SourceEnd>(source->Next())) {
    }
  } catch (const InputError&) {
  }
  ::close(descriptor);
  return 0;
}
