// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/shortage.h"

#include <new>
#include <system_error>

#include <opencv2/core.hpp>

namespace plumbline {

const char* ShortageOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "out of memory";
  if (const auto* opencv = dynamic_cast<const cv::Exception*>(&error)) {
    return opencv->code == cv::Error::StsNoMem ? "out of memory" : nullptr;
  }
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system == nullptr) return nullptr;
  if (system->code() == std::errc::resource_unavailable_try_again) {
    return "no further thread can be started";
  }
  return system->code() == std::errc::not_enough_memory ? "out of memory" : nullptr;
}

}  // namespace plumbline
