// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/parallelogram.h"

#include "plumbline/geometry/segment.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

Eigen::AlignedBox3d Parallelogram::Bounds() const {
  Eigen::AlignedBox3d box(origin);
  for (const Eigen::Vector3d& corner : {PointAt(1, 0), PointAt(0, 1), PointAt(1, 1)}) {
    box.extend(corner);
  }
  return box;
}

double Distance(const Parallelogram& parallelogram, const Eigen::Vector3d& point) {
  const Eigen::Vector3d& u = parallelogram.side_u;
  const Eigen::Vector3d& v = parallelogram.side_v;
  const Eigen::Vector3d offset = point - parallelogram.origin;
  const Eigen::Vector3d normal = u.cross(v);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const double a = offset.cross(v).dot(normal) / area2;
    const double b = u.cross(offset).dot(normal) / area2;
    if (a >= 0 && a <= 1 && b >= 0 && b <= 1)
      return std::abs(offset.dot(normal)) / std::sqrt(area2);
  }
  const Eigen::Vector3d corners[] = {parallelogram.PointAt(0, 0),
                                     parallelogram.PointAt(1, 0),
                                     parallelogram.PointAt(1, 1),
                                     parallelogram.PointAt(0, 1)};
  double nearest = Distance(Segment3{corners[3], corners[0]}, point);
  for (int i = 0; i < 3; ++i) {
    nearest = std::min(nearest, Distance(Segment3{corners[i], corners[i + 1]}, point));
  }
  return nearest;
}

}  // namespace plumbline
