// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "transform_tree.h"

#include "plumbline/base/units.h"

#include <algorithm>
#include <iterator>

namespace plumbline::ros_node {
namespace {

constexpr std::int64_t kMemoryNs = 10 * kNsPerSecond;
// More are not taken, or the oldest go: names and stamps come from the network.
constexpr std::size_t kMostFrames = 10'000, kMostMotions = 20'000;

std::optional<Rigid3> At(const std::map<std::int64_t, Rigid3>& motions, std::int64_t stamp_ns) {
  const auto after = motions.lower_bound(stamp_ns);
  if (after == motions.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == motions.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double share = static_cast<double>(stamp_ns - before->first) /
                       static_cast<double>(after->first - before->first);
  return Rigid3{before->second.rotation.slerp(share, after->second.rotation),
                (1 - share) * before->second.translation + share * after->second.translation};
}

// Names from the time before tf2 begin with a slash.
std::string FrameName(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

}  // namespace

void TransformTree::Add(const std::vector<TransformMessage>& transforms, bool is_static) {
  const std::lock_guard lock(mutex_);
  for (const TransformMessage& transform : transforms) {
    const std::string parent = FrameName(transform.parent), child = FrameName(transform.child);
    if (parent == child || (frames_.size() >= kMostFrames && !frames_.contains(child))) continue;
    Frame& frame = frames_[child];
    auto& motions = frame.parent_from_frame;
    // Another parent, or a bag that is played anew: what was known is no longer true.
    const bool anew =
        frame.parent != parent || frame.is_static || is_static ||
        (!motions.empty() && transform.stamp_ns + kMemoryNs < motions.rbegin()->first);
    if (anew) motions.clear();
    frame.parent = parent;
    frame.is_static = is_static;
    motions[transform.stamp_ns] = transform.parent_from_child;
    motions.erase(motions.begin(), motions.lower_bound(motions.rbegin()->first - kMemoryNs));
    if (motions.size() > kMostMotions) motions.erase(motions.begin());
  }
}

Expected<std::vector<TransformTree::Ancestor>, std::string> TransformTree::AncestorsOf(
    const std::string& name, std::optional<std::int64_t> stamp_ns) const {
  std::vector<Ancestor> ancestors = {{name, Rigid3()}};
  for (auto found = frames_.find(name); found != frames_.end();
       found = frames_.find(ancestors.back().name)) {
    const Frame& frame = found->second;
    if (ancestors.size() > frames_.size()) return "the frames of " + name + " are a circle";
    const std::optional<Rigid3> motion = frame.is_static || !stamp_ns
                                             ? frame.parent_from_frame.rbegin()->second
                                             : At(frame.parent_from_frame, *stamp_ns);
    if (!motion) return found->first + " has no transform to " + frame.parent + " at that time";
    const Rigid3 from_frame = *motion * ancestors.back().from_frame;
    ancestors.push_back({frame.parent, from_frame});
  }
  return ancestors;
}

Expected<Rigid3, std::string> TransformTree::Find(const std::string& target,
                                                  const std::string& source,
                                                  std::optional<std::int64_t> stamp_ns) const {
  const std::lock_guard lock(mutex_);
  const auto of_source = AncestorsOf(FrameName(source), stamp_ns);
  if (!of_source) return of_source.error();
  const auto of_target = AncestorsOf(FrameName(target), stamp_ns);
  if (!of_target) return of_target.error();
  for (const Ancestor& above_source : *of_source) {
    for (const Ancestor& above_target : *of_target) {
      if (above_source.name != above_target.name) continue;
      return Inverse(above_target.from_frame) * above_source.from_frame;
    }
  }
  return std::string("no transforms lead from one to the other");
}

}  // namespace plumbline::ros_node
