// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/line_method.h"

#include <array>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {

// Classes of lines that a run can leave out, to see which one does harm (lines.reconstruction
// without_long and so on).
enum class LineClass {
  kLong,     // 120 px or more, in the first keyframe that shows it
  kShort,    // less than 60 px
  kNear,     // its middle is nearer than 15 times the way between the first and the last keyframe
  kFar,      // no nearer than that
  kUpright,  // in the image within 20 degrees of a column
  kAlongMotion,  // in space within 20 degrees of that way
  kLow,          // its middle is in the lowest third of the image: on a road, mostly
};
constexpr auto EnumNames(std::type_identity<LineClass> /*of*/) {
  return std::array{std::pair{LineClass::kLong, "long"},
                    std::pair{LineClass::kShort, "short"},
                    std::pair{LineClass::kNear, "near"},
                    std::pair{LineClass::kFar, "far"},
                    std::pair{LineClass::kUpright, "upright"},
                    std::pair{LineClass::kAlongMotion, "along_motion"},
                    std::pair{LineClass::kLow, "low"}};
}

// Returns true if a line, with its observations, belongs to the class.
bool IsInClass(LineClass which, const Map& map, const RectifiedCamera& camera, const MapLine& line);

// Returns a method that makes lines from several keyframes like LineFromViews, but for those of the
// class; nullptr if `reconstruction` is no such name.
decltype(LineMethod::line_from_views) LinesWithoutClass(const std::string& reconstruction);

}  // namespace plumbline
