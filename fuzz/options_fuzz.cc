// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"

#include "fuzz/input_folder.h"
#include <string>

// Configuration files and, after a first '=', single settings.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumbline;
  const std::string text(AsText(data, size));
  static SlamOptions options;
  static OptionTable table(options);
  options = SlamOptions();
  try {
    if (!text.starts_with('=')) {
      table.LoadText(text, "input");
      return 0;
    }
    table.Set(text.substr(1));
  } catch (const InputError&) {
    return 0;
  }
  SlamOptions copy;
  OptionTable written(copy);
  written.LoadText(table.Dump(), "written");
  PLUMBLINE_CHECK(written.Dump() == table.Dump(), "options come back as they were");
  return 0;
}
