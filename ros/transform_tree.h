// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/recordings/transform_message.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace plumbline::ros_node {

// The frames of /tf and /tf_static, each with its parent. Transforms of the last ten seconds are
// kept. All functions may be called in any thread.
class TransformTree {
 public:
  // Takes the transforms of a message; those of /tf_static hold at any time.
  void Add(const std::vector<TransformMessage>& transforms, bool is_static);

  // Returns target_from_source: at a time, interpolated between the transforms before and after it,
  // or by the newest ones. Returns the reason if there is none.
  Expected<Rigid3, std::string> Find(const std::string& target,
                                     const std::string& source,
                                     std::optional<std::int64_t> stamp_ns = std::nullopt) const;

 private:
  struct Frame {
    std::string parent;
    bool is_static = false;
    std::map<std::int64_t, Rigid3> parent_from_frame;  // by time
  };
  // A frame among the ancestors of another, itself included.
  struct Ancestor {
    std::string name;
    Rigid3 from_frame;
  };

  Expected<std::vector<Ancestor>, std::string> AncestorsOf(
      const std::string& name, std::optional<std::int64_t> stamp_ns) const;

  mutable std::mutex mutex_;
  std::map<std::string, Frame> frames_;
};

}  // namespace plumbline::ros_node
