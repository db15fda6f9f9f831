// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/commands.h"
#include "tests/io/scratch_folder.h"
#include "tests/lab/consistency/consistent_run.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace consistency_test {

using testing::HasSubstr;

struct ConsistentRun {
  ScratchFolder folder;

  ConsistentRun() { WriteConsistentRun(folder); }
  // What the command prints with these options.
  std::string Output(std::vector<std::string> options) const {
    options.insert(options.begin(), {(folder / "s").string(), (folder / "run").string()});
    testing::internal::CaptureStdout();
    EXPECT_EQ(ConsistencyCommand(options), 0);
    return testing::internal::GetCapturedStdout();
  }
};

TEST(ConsistencyCommand, ShowsClassesWithEnoughErrors) {
  const ConsistentRun run;
  const std::string table = run.Output({});
  EXPECT_THAT(table, HasSubstr("point           all"));
  EXPECT_EQ(table.find("causal_1s"), std::string::npos);  // 11 motions
  EXPECT_THAT(run.Output({"--least", "5"}), HasSubstr("causal_1s"));
}

TEST(ConsistencyCommand, WritesJsonOfAllClasses) {
  const ConsistentRun run;
  const auto printed = nlohmann::json::parse(run.Output({"--json", "-"}));
  EXPECT_EQ(printed.at(0).at("kind"), "point");
  EXPECT_NEAR(printed.at(0).at("inside"), 0.9, 0.04);
  const auto file = run.folder / "shares.json";
  run.Output({"--json", file.string(), "--poses", "run"});
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(ConsistencyCommand, NamesWhatIsWrong) {
  const ConsistentRun run;
  const std::string sequence = (run.folder / "s").string(), out = (run.folder / "run").string();
  const auto message = [&](const std::vector<std::string>& arguments) {
    return MessageOf([&] { ConsistencyCommand(arguments); });
  };
  EXPECT_THAT(message({sequence, out, "--poses", "mine"}), HasSubstr("expected truth or run"));
  EXPECT_THAT(message({sequence, out, "--json", out + "/map.plb"}), HasSubstr("map.plb"));
  run.folder.Write("run/map.plb", "");
  EXPECT_THAT(message({sequence, out}), HasSubstr("map.plb"));
}

}  // namespace consistency_test
}  // namespace plumbline
