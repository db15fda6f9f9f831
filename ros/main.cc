// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "node.h"
#include <cstdio>
#include <exception>

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "plumbline");
  try {
    plumbline::ros_node::Node node{ros::NodeHandle(), ros::NodeHandle("~")};
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
