// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "live_slam.h"
#include "messages.h"
#include "transport.h"
#include <memory>

namespace plumbline::ros_node {

// Publishes a map, latched: ~/points (PointCloud2), ~/lines (a marker of segments) and ~/path (the
// base at the keyframes, as corrected by now), all in the map's frame.
class MapPublisher {
 public:
  explicit MapPublisher(Transport& transport);

  // Whether somebody listens.
  bool IsWanted() const;
  // In any thread.
  void Publish(const MapView& map,
               const Rigid3& base_from_camera,
               const MessageHeader& header) const;

 private:
  bool cdr_;
  std::unique_ptr<Publication> points_, lines_, path_;
};

}  // namespace plumbline::ros_node
