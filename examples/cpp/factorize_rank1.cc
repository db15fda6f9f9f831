// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds where cameras stand and how far points are, all at once, from rays and rotations.
#include <iostream>

#include <plumbline/initialization/rank1_factorization.h>

int main() {
  using namespace plumbline;
  std::vector<Eigen::Vector3d> points;  // in the frame of the reference camera
  for (int i = 0; i < 12; ++i) points.emplace_back(i % 4 - 1.5, i / 4 - 1, 4 + i % 3);
  std::vector<Eigen::Vector2d> reference;
  for (const auto& point : points) reference.push_back(point.hnormalized());
  std::vector<Rank1View> views;
  for (int k = 1; k <= 3; ++k) {  // 10 cm to the right each time
    const Eigen::Vector3d centre(0.1 * k, 0.02 * k * k, 0);
    Rank1View view{Eigen::Quaterniond::Identity(), centre.normalized(), {}, {}};
    for (const auto& point : points) view.points.push_back((point - centre).hnormalized());
    view.sigmas.assign(points.size(), 1e-3);
    views.push_back(view);
  }
  const auto solution = FactorizeRank1(reference, views);
  if (!solution) return 1;                             // too little was seen
  const double unit = 0.3 / solution->centres[2].x();  // of the map; one camera cannot know it
  for (const auto& centre : solution->centres)
    std::cout << "camera " << (unit * centre).transpose() << "\n";
  std::cout << "first point at " << unit / solution->inverse_distances[0] << " m\n";
}
