// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace plumbline::ros_node {

// What a node of ROS 2 is told by its arguments and the environment.
struct Ros2Settings {
  std::string name = "plumbline";
  std::string name_space = "/";
  std::map<std::string, std::string> remappings;  // from a name to a name, both expanded
  Parameters parameters;                          // of the node, without those below
  std::map<std::string, std::string> sources;     // "node.yaml:4" of parameters of files
  std::vector<std::string> notes;                 // what is not used, a line each
  bool reliable = false;        // reliability: images reliable in place of best effort
  bool use_sim_time = false;    // timers run by /clock
  std::uint32_t domain = 0;     // ROS_DOMAIN_ID
  bool localhost_only = false;  // ROS_LOCALHOST_ONLY
  std::size_t gid_size = 16;  // bytes of a Gid in ros_discovery_info: 24 up to Humble (ROS_DISTRO)

  std::string FullName() const { return (name_space == "/" ? "" : name_space) + "/" + name; }
  // A name from / on, before and after remapping.
  std::string Expand(const std::string& topic) const;
  std::string Resolve(const std::string& topic) const;
};

// Variables of the environment; empty where they are not set.
struct Ros2Environment {
  std::string domain_id, localhost_only, distro;
};

// Reads arguments as ROS 2 has them, with or without --ros-args in front:
//
//   -r FROM:=TO, FROM:=TO    another name of a topic; __node:=NAME and __ns:=NAMESPACE of the node
//   -p NAME:=VALUE           a parameter
//   --params-file FILE       parameters of nodes in YAML (ReadParameterFile)
//   --log-level LEVEL        not used, with a note
//
// Throws InputError for all others, and for what ReadParameterFile refuses.
Ros2Settings ReadRos2Settings(std::span<const std::string> arguments,
                              const Ros2Environment& environment);

// Reads the parameters of the node into its settings, from a YAML text: groups named by its name,
// its whole name
// (/robot/plumbline) or /**, each with a group ros__parameters. Later ones replace earlier ones;
// groups of other nodes are ignored. Throws InputError "source:line: ..." for another form.
void ReadParameterFile(const std::string& text, const std::string& source, Ros2Settings& settings);

}  // namespace plumbline::ros_node
