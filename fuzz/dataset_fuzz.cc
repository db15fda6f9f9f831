// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzzed_dataset.h"

// The entry point of the targets that open a data set.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const plumbline::FuzzedDataset dataset = plumbline::MakeFuzzedDataset();
  dataset.OpenWith(plumbline::AsText(data, size));
  return 0;
}
