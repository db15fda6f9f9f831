// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "apps/stop_signal.h"
#include "make_node.h"
#include "ros2_arguments.h"
#include "ros2_transport.h"
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr const char* kHelp =
    "plumbline-ros2: SLAM on the images of ROS 2's topics (docs/ros2.md)\n"
    "\n"
    "  [-r] FROM:=TO        another name of a topic; __node:=NAME, __ns:=NAMESPACE of the node\n"
    "  -p NAME:=VALUE       a parameter\n"
    "  --params-file FILE   parameters in ROS 2's form\n";

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace plumbline::ros_node;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && (arguments[0] == "--help" || arguments[0] == "-h")) {
    std::fputs(kHelp, stdout);
    return 0;
  }
  try {
    plumbline::CatchStopSignals();
    const Ros2Settings settings = ReadRos2Settings(
        arguments,
        {Variable("ROS_DOMAIN_ID"), Variable("ROS_LOCALHOST_ONLY"), Variable("ROS_DISTRO")});
    Ros2Transport transport(settings);
    for (const std::string& note : settings.notes) transport.Log(Severity::kInfo, note);
    const auto node = MakeNode(
        transport, settings.parameters, {"", settings.sources, {"reliability", "use_sim_time"}});
    transport.Run(plumbline::StopRequested);
    return 0;
  } catch (const plumbline::InputError& error) {
    std::fprintf(stderr, "plumbline-ros2: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plumbline-ros2: %s\n", error.what());
    return 1;
  }
}
