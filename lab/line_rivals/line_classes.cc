// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_classes.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"
#include "plumbline/matching/line_from_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

constexpr double kLongPx = 120, kShortPx = 60;
constexpr double kFarWays = 15;
constexpr double kAngle = 20 * kDegree;

template <LineClass kClass>
std::optional<MapLine> LineFromViewsWithout(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views) {
  std::optional<MapLine> line = LineFromViews(map, camera, views);
  if (line && IsInClass(kClass, map, camera, *line)) return std::nullopt;
  return line;
}

}  // namespace

bool IsInClass(LineClass which,
               const Map& map,
               const RectifiedCamera& camera,
               const MapLine& line) {
  const auto& [first_id, feature] = *line.observations.begin();
  const Frame& first = map.Find(first_id)->frame;
  const Frame& last = map.Find(line.observations.newest().first)->frame;
  const Segment2& segment = first.features().lines[static_cast<std::size_t>(feature)].segment;
  const Eigen::Vector3d centre = Inverse(first.cam_from_world).translation;
  const Eigen::Vector3d way = Inverse(last.cam_from_world).translation - centre;
  const double distance = (line.Interval().Midpoint() - centre).norm();
  const bool is_near = distance < kFarWays * way.norm();
  switch (which) {
    case LineClass::kLong:
      return segment.Length() >= kLongPx;
    case LineClass::kShort:
      return segment.Length() < kShortPx;
    case LineClass::kNear:
      return is_near;
    case LineClass::kFar:
      return !is_near;
    case LineClass::kUpright:
      return std::abs(segment.Direction().x()) < math::Sin(kAngle);
    case LineClass::kAlongMotion:
      return way.norm() > 0 && UndirectedAngle(line.line.direction, way) < kAngle;
    case LineClass::kLow:
      return segment.Midpoint().y() > 2.0 / 3 * camera.height;
  }
  return false;
}

decltype(LineMethod::line_from_views) LinesWithoutClass(const std::string& reconstruction) {
  using Maker = decltype(LineMethod::line_from_views);
  using enum LineClass;
  constexpr std::array<std::pair<LineClass, Maker>, 7> kMakers = {
      {{kLong, LineFromViewsWithout<kLong>},
       {kShort, LineFromViewsWithout<kShort>},
       {kNear, LineFromViewsWithout<kNear>},
       {kFar, LineFromViewsWithout<kFar>},
       {kUpright, LineFromViewsWithout<kUpright>},
       {kAlongMotion, LineFromViewsWithout<kAlongMotion>},
       {kLow, LineFromViewsWithout<kLow>}}};
  for (const auto& [which, make] : kMakers) {
    if (reconstruction == "without_" + NameOf(which)) return make;
  }
  return nullptr;
}

}  // namespace plumbline
