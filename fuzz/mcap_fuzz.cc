// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/recording_fuzz.h"

// MCAP files with images and calibrations.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  OpenInvented(AsText(data, size), "x.mcap", DatasetFormat::kMcap);
  return 0;
}
