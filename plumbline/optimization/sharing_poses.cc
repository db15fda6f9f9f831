// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/sharing_poses.h"

#include "plumbline/base/index.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// Which poses show each landmark, and which landmarks each pose shows. A pose that shows a landmark
// twice is there twice.
struct Sightings {
  Sightings(std::size_t landmarks, std::size_t poses) : poses_of(landmarks), landmarks_of(poses) {}

  void Add(int landmark, int pose) {
    poses_of[Index(landmark)].push_back(pose);
    landmarks_of[Index(pose)].push_back(landmark);
  }

  std::vector<std::vector<int>> poses_of, landmarks_of;
};

}  // namespace

BlockPattern SharingPoses(const BaProblem& problem, const StopCheck& stop) {
  const std::size_t poses = problem.poses.size();
  Sightings points(problem.points.size(), poses), lines(problem.lines.size(), poses);
  for (const auto& o : problem.point_observations) points.Add(o.point, o.pose);
  for (const auto& o : problem.line_observations) lines.Add(o.line, o.pose);
  BlockPattern pattern(poses);
  std::vector<int> known_by(poses, -1);  // the last pose in whose row each pose is
  for (int pose = 0; pose < static_cast<int>(poses) && !IsToStop(stop); ++pose) {
    std::vector<int>& earlier = pattern[Index(pose)];
    for (const Sightings* sightings : {&points, &lines}) {
      for (const int landmark : sightings->landmarks_of[Index(pose)]) {
        for (const int other : sightings->poses_of[Index(landmark)]) {
          if (other >= pose || known_by[Index(other)] == pose) continue;
          known_by[Index(other)] = pose;
          earlier.push_back(other);
        }
      }
    }
    std::sort(earlier.begin(), earlier.end());
  }
  return pattern;
}

}  // namespace plumbline
