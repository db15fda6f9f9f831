// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/ros2_arguments.h"

#include "plumbline/base/error.h"

#include "ros/node_parameters.h"
#include "tests/io/scratch_folder.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

using testing::HasSubstr;

Ros2Settings Read(const std::vector<std::string>& arguments,
                  const Ros2Environment& environment = {}) {
  return ReadRos2Settings(arguments, environment);
}

TEST(Ros2Arguments, NameTopicsAsNodesOfRos2Do) {
  const Ros2Settings plain = Read({});
  EXPECT_EQ(plain.Resolve("left/image"), "/left/image");
  EXPECT_EQ(plain.Resolve("~/pose"), "/plumbline/pose");
  EXPECT_EQ(plain.Resolve("/tf"), "/tf");
  const Ros2Settings named = Read({"--ros-args",
                                   "-r",
                                   "__ns:=/robot",
                                   "--remap",
                                   "__node:=slam",
                                   "-r",
                                   "left/image:=/cam0/image_raw",
                                   "right/image:=cam1",
                                   "/tf:=tf",
                                   "~/pose:=where"});
  EXPECT_EQ(named.FullName(), "/robot/slam");
  EXPECT_EQ(named.Resolve("left/image"), "/cam0/image_raw");
  EXPECT_EQ(named.Resolve("right/image"), "/robot/cam1");
  EXPECT_EQ(named.Resolve("/tf"), "/robot/tf");
  EXPECT_EQ(named.Resolve("~/pose"), "/robot/where");
  EXPECT_EQ(named.Resolve("~/odometry"), "/robot/slam/odometry");
  // Each name is replaced once: a pair may be swapped.
  const Ros2Settings swapped = Read({"left/image:=right/image", "right/image:=left/image"});
  EXPECT_EQ(swapped.Resolve("left/image"), "/right/image");
  EXPECT_EQ(swapped.Resolve("right/image"), "/left/image");
}

TEST(Ros2Arguments, ReadTheEnvironment) {
  const Ros2Settings settings = Read({}, {"42", "1", "humble"});
  EXPECT_EQ(settings.domain, 42U);
  EXPECT_TRUE(settings.localhost_only);
  EXPECT_EQ(settings.gid_size, 24U);
  EXPECT_EQ(Read({}, {"", "0", "jazzy"}).gid_size, 16U);
  EXPECT_FALSE(Read({}, {"", "0", ""}).localhost_only);
}

TEST(Ros2Arguments, ReadParametersInTheirOrder) {
  const ScratchFolder folder;
  const std::string file = folder
                               .Write("node.yaml",
                                      "/**:\n"
                                      "  ros__parameters: {use_sim_time: true, sensor: mono}\n"
                                      "other:\n"
                                      "  ros__parameters: {sensor: sonar}\n"
                                      "plumbline:\n"
                                      "  ros__parameters:\n"
                                      "    sensor: stereo\n"
                                      "    reliability: reliable\n"
                                      "    map_period: 2\n"
                                      "    map_file: '17'\n"
                                      "    options: {features: {line_count: 100}}\n")
                               .string();
  const Ros2Settings settings =
      Read({"--ros-args", "--params-file", file, "-p", "queue_size:=7", "-p", "load:=true"});
  EXPECT_TRUE(settings.reliable);
  const NodeParameters parameters = ReadParameters(settings.parameters, {"", settings.sources});
  EXPECT_EQ(parameters.slam.sensor, "stereo");
  EXPECT_EQ(parameters.map_period, 2);
  EXPECT_EQ(parameters.map_file, "17");
  EXPECT_EQ(parameters.queue_size, 7);
  EXPECT_TRUE(parameters.load);
  ASSERT_EQ(parameters.slam.options.size(), 1U);
  EXPECT_EQ(parameters.slam.options[0].key, "features.line_count");
  EXPECT_EQ(parameters.slam.options[0].text, "100");
  EXPECT_EQ(parameters.slam.options[0].where, file + ":11: options.features.line_count");
}

TEST(Ros2Arguments, AreRefusedInOneLine) {
  const ScratchFolder folder;
  const std::string flat = folder.Write("flat.yaml", "\nplumbline:\n  sensor: mono\n").string();
  const std::string list = folder.Write("list.yaml", "[1]\n").string();
  const std::string values =
      folder.Write("values.yaml", "plumbline:\n  ros__parameters: [1]\n").string();
  const std::string own =
      folder.Write("own.yaml", "/**:\n  ros__parameters:\n    reliability: some\n").string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--verbose"}, "expected -r, -p, --params-file or NAME:=NAME, found '--verbose'"},
      {{"image"}, "expected NAME:=VALUE, found 'image'"},
      {{"-p"}, "expected a value after -p, found none"},
      {{"image:=a b"}, "expected a name of letters, digits, _ and /, found 'a b'"},
      {{"-p", "reliability:=some"}, "reliability: expected best_effort or reliable, found some"},
      {{"-p", "sensor:=[a"}, "-p sensor:"},
      {{"--params-file", flat}, flat + ":2: expected a group ros__parameters in 'plumbline'"},
      {{"--params-file", values},
       values + ":1: expected a group ros__parameters in 'plumbline', found a list"},
      {{"--params-file", own}, own + ":3: reliability: expected best_effort or reliable"},
      {{"-r", "__node:=a/b"}, "__node: expected a name of letters, digits and _, found 'a/b'"},
      {{"--log-level"}, "expected a value after --log-level, found none"},
      {{"--params-file", list}, list + ":1: expected groups named after nodes"},
      {{"--params-file", "/nowhere.yaml"}, "/nowhere.yaml"},
  };
  for (const auto& [arguments, message] : cases) {
    const std::string said = MessageOf([&, &words = arguments] { Read(words); });
    EXPECT_THAT(said, HasSubstr(message));
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
  EXPECT_THAT(MessageOf([] {
                Read({}, {"233", "", ""});
              }),
              HasSubstr("ROS_DOMAIN_ID: expected a whole number from 0 to 232, found '233'"));
  EXPECT_THAT(MessageOf([] {
                Read({}, {"", "maybe", ""});
              }),
              HasSubstr("ROS_LOCALHOST_ONLY: expected 0 or 1, found 'maybe'"));
}

TEST(Ros2Arguments, TellThatLogLevelsAreNotUsed) {
  const Ros2Settings settings = Read({"--ros-args", "--log-level", "debug", "-p", "sensor:=mono"});
  EXPECT_THAT(settings.notes, testing::ElementsAre("--log-level debug is not used"));
  EXPECT_TRUE(settings.parameters.contains("sensor"));
}

TEST(NodeParameters, AreNamedByTheirFile) {
  const ParameterNames names{"", {{"sensor", "n.yaml:4"}, {"kamera", "n.yaml:5"}}, {"reliability"}};
  EXPECT_EQ(MessageOf([&] {
              ReadParameters({{"sensor", true}}, names);
            }),
            "n.yaml:4: sensor: expected a text, found a truth value");
  EXPECT_THAT(MessageOf([&] {
                ReadParameters({{"kamera", true}}, names);
              }),
              testing::AllOf(HasSubstr("n.yaml:5: kamera: expected a parameter of this node ("),
                             HasSubstr("reliability"),
                             testing::EndsWith("; did you mean 'camera'?")));
}

TEST(NodeParameters, AreCheckedByNameAndType) {
  const std::vector<std::pair<Parameters, std::string>> cases = {
      {{{"sensor", std::int64_t{3}}}, "~sensor: expected a text, found a whole number"},
      {{{"map_period", std::string("often")}}, "~map_period: expected a number, found a text"},
      {{{"options", ListValue{}}}, "~options: expected a group, found a list"},
      {{{"load", true}}, "~map_file: expected a file to load, found none"},
      {{{"image_transport", std::string("theora")}},
       "~image_transport: expected raw or compressed, found theora"},
  };
  for (const auto& [parameters, message] : cases) {
    EXPECT_EQ(MessageOf([&, &all = parameters] { ReadParameters(all, {"~"}); }), message);
  }
}

}  // namespace
}  // namespace plumbline::ros_node
