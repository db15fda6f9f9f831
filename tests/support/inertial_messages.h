// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/bag_writer.h"
#include "tests/support/message_writer.h"
#include <cstdint>
#include <optional>
#include <string>

namespace plumbline {

// A message whose rates and forces are given along x and z; nullopt: marked as not measured.
inline std::string InertialBytes(bool cdr,
                                 std::int64_t stamp_ns,
                                 std::optional<double> rate,
                                 std::optional<double> force) {
  RosFields fields(cdr);
  fields.Header(stamp_ns, "imu");
  for (const double q : {0, 0, 0, 1}) fields.F64(q);
  for (int i = 0; i < 9; ++i) fields.F64(i == 0 ? -1 : 0);
  const auto vector = [&](double x, double z, bool measured) {
    for (const double number : {x, 0.0, z}) fields.F64(number);
    for (int i = 0; i < 9; ++i) fields.F64(i == 0 && !measured ? -1 : 0);
  };
  vector(rate.value_or(0), 0, rate.has_value());
  vector(0, force.value_or(0), force.has_value());
  return fields.Take();
}

inline void AddInertial(BagWriter& bag,
                        const std::string& topic,
                        std::int64_t stamp_ns,
                        std::optional<double> rate,
                        std::optional<double> force) {
  bag.Add(topic, "sensor_msgs/Imu", stamp_ns + 9, InertialBytes(false, stamp_ns, rate, force));
}

}  // namespace plumbline
