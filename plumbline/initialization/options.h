// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

enum class InitializationMethod { kRank1, kRank1Klt, kTwoView };
constexpr auto EnumNames(std::type_identity<InitializationMethod>) {
  return std::array{std::pair{InitializationMethod::kRank1, "rank1"},
                    std::pair{InitializationMethod::kRank1Klt, "rank1_klt"},
                    std::pair{InitializationMethod::kTwoView, "two_view"}};
}

struct InitializationOptions {
  InitializationMethod method = InitializationMethod::kRank1;
  int frames = 3;  // m of the first paper: frames after the reference that are solved together
};

template <class Visitor>
void VisitFields(Visitor&& visit, InitializationOptions& o) {
  visit("method",
        o.method,
        "of a monocular start: rank1 (factorization of several frames, completed by geometric "
        "interpolation), rank1_klt (of tracks alive in all frames), two_view (homography or "
        "essential matrix of two frames)");
  visit("frames", o.frames, "frames after the reference that are solved together", Range{2, 30});
}

}  // namespace plumbline
