// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "make_node.h"
#include "ros1_transport.h"
#include <cstdio>
#include <exception>

#include <ros/ros.h>

int main(int argc, char** argv) {
  using namespace plumbline::ros_node;
  ros::init(argc, argv, "plumbline");
  try {
    Ros1Transport transport;
    const auto node = MakeNode(transport, transport.ReadParameters(), {"~"});
    ros::spin();
    return 0;
  } catch (const plumbline::InputError& error) {
    std::fprintf(stderr, "plumbline_node: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plumbline_node: %s\n", error.what());
    return 1;
  }
}
