// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/single_precision.h"

namespace plumbline {
namespace {

template <class Value>
void Round(Value& value) {
  value = InSinglePrecision(value);
}

void Round(Segment2& segment) {
  Round(segment.start);
  Round(segment.end);
}

}  // namespace

void RoundToSinglePrecision(Features& features) {
  for (PointFeature& point : features.points) {
    Round(point.px);
    Round(point.sigma_px);
  }
  for (Disparity& disparity : features.point_disparity.values()) {
    Round(disparity.px);
    Round(disparity.sigma_px);
  }
  for (LineFeature& line : features.lines) {
    Round(line.segment);
    Round(line.sigma_px);
    Round(line.response);
  }
  for (MeasuredSegment& right : features.line_right.values()) {
    Round(right.segment);
    Round(right.sigma_px);
  }
}

}  // namespace plumbline
