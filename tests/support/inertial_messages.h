// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/bag_writer.h"
#include "tests/support/message_writer.h"
#include <cstdint>
#include <optional>
#include <string>

namespace plumbline {

// Adds a message of ROS 1 whose rates and forces are given along x and z; nullopt: marked as not
// measured.
inline void AddInertial(BagWriter& bag,
                        const std::string& topic,
                        std::int64_t stamp_ns,
                        std::optional<double> rate,
                        std::optional<double> force) {
  bag.Add(topic,
          "sensor_msgs/Imu",
          stamp_ns + 9,
          InertialMessageOf(Dialect::kRos1, stamp_ns, rate, force));
}

}  // namespace plumbline
