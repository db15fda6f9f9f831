// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"

namespace plumbline {

SlamOptions SavedOptions(const AtlasContext& context, const std::string& source) {
  SlamOptions options;
  if (!context.options_yaml.empty()) {
    OptionTable(options).LoadText(context.options_yaml, source);
  }
  return options;
}

SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept) {
  try {
    SlamOptions options = SavedOptions(context, source);
    if (accept) accept(options);
    return options;
  } catch (const InputError& error) {
    remark(std::string(error.what()) + "; " + instead);
    return {};
  }
}

}  // namespace plumbline
