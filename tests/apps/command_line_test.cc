// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_line.h"

#include "plumbline/base/error.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CommandSyntax Syntax() {
  return {"do",
          "Does.",
          {"A", "[B]"},
          {{"--set", "K=V", "sets; may be repeated"},
           {"--count", "N", "counts"},
           {"--quiet", "", "says less"}},
          {{"--tally", "--count N does the same"}}};
}

CommandLine Parse(const std::vector<std::string>& arguments) {
  return CommandLine(Syntax(), arguments);
}

std::string ParseMessage(const std::vector<std::string>& arguments) {
  try {
    Parse(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CommandLine, TakesOptionsInAnyPlaceAndForm) {
  const CommandLine line = Parse({"--set", "a=1", "x", "--quiet", "--set=b=2"});
  EXPECT_THAT(line.Values("--set"), ElementsAre("a=1", "b=2"));
  EXPECT_EQ(line.Value("--set"), "b=2");
  EXPECT_TRUE(line.Has("--quiet"));
  EXPECT_EQ(line.Positional(0), "x");
  EXPECT_EQ(line.Positional(1), "");
  EXPECT_FALSE(line.help());
}

TEST(CommandLine, TakesAllAsPositionalBehindTwoDashes) {
  const CommandLine line = Parse({"--", "--quiet", "-"});
  EXPECT_FALSE(line.Has("--quiet"));
  EXPECT_EQ(line.Positional(0), "--quiet");
  EXPECT_EQ(line.Positional(1), "-");
}

TEST(CommandLine, HelpNeedsNothingElse) { EXPECT_TRUE(Parse({"--help"}).help()); }

TEST(CommandLine, TellsWhatServesInPlaceOfARemovedOption) {
  const std::string message = "do: --tally is no option any more: --count N does the same";
  EXPECT_EQ(ParseMessage({"x", "--tally", "3"}), message);
  EXPECT_EQ(ParseMessage({"x", "--tally=3"}), message);
  EXPECT_EQ(HelpText(Syntax()).find("--tally"), std::string::npos);
}

TEST(CommandLine, NamesWrongUse) {
  EXPECT_EQ(ParseMessage({"x", "--quite"}), "do: unknown option --quite; the nearest is --quiet");
  EXPECT_EQ(ParseMessage({"x", "--elephants"}), "do: unknown option --elephants");
  EXPECT_EQ(ParseMessage({"x", "--set"}), "--set: expected K=V");
  EXPECT_EQ(ParseMessage({"x", "--quiet=1"}), "--quiet: takes no value");
  EXPECT_EQ(ParseMessage({"x", "y", "z"}), "do: unexpected argument z");
  EXPECT_THAT(ParseMessage({}), HasSubstr("do: expected A"));
}

TEST(CommandLine, MissesAValueWhereAnOptionFollows) {
  EXPECT_EQ(ParseMessage({"x", "--set", "--quiet"}),
            "--set: expected K=V, found the option --quiet; --set=--quiet is a value");
  EXPECT_EQ(ParseMessage({"x", "--count", "--set=a=1"}),
            "--count: expected N, found the option --set=a=1; --count=--set=a=1 is a value");
  EXPECT_EQ(Parse({"x", "--set=--quiet"}).Value("--set"), "--quiet");
  EXPECT_EQ(Parse({"x", "--set", "--other"}).Value("--set"), "--other");
  EXPECT_EQ(Parse({"x", "--count", "-1"}).Value("--count"), "-1");
  EXPECT_TRUE(Parse({"--set", "--help"}).help());
}

TEST(CommandLine, TakesTwoValuesOnlyOfWhatMayBeRepeated) {
  EXPECT_EQ(ParseMessage({"x", "--count", "1", "--count=2"}),
            "--count: expected it once, found '1' and '2'");
  EXPECT_EQ(ParseMessage({"x", "--count", "1", "--count", "1"}),
            "--count: expected it once, found '1' and '1'");
  EXPECT_EQ(ParseMessage({"x", "--set", "a=1", "--set", "a=2", "--quiet", "--quiet"}), "no error");
}

TEST(CommandLine, TextsThatAreEmptyAreNone) {
  EXPECT_EQ(ParseMessage({"x", "--set", ""}), "--set: expected K=V, found an empty argument");
  EXPECT_EQ(ParseMessage({"x", "--set="}), "--set: expected K=V, found an empty argument");
  EXPECT_EQ(ParseMessage({""}), "do: found an empty argument");
}

TEST(CommandLine, WhatIsRepeatedToTheUserIsShortAndPrintable) {
  const std::string megabyte(1'000'000, 'x');
  for (const std::string& message : {ParseMessage({"x", "--" + megabyte}),
                                     ParseMessage({"x", "y", "\x1b[31m\n" + megabyte}),
                                     ParseMessage({"x", "--count", megabyte})}) {
    EXPECT_LT(message.size(), 300U);
    EXPECT_EQ(message.find_first_of("\n\x1b"), std::string::npos) << message;
  }
}

TEST(CommandLine, CountsAreWholeNumbersOfARange) {
  const auto count = [](const std::string& text) {
    return Parse({"x", "--count", text}).Count("--count", 5, {1, 100});
  };
  EXPECT_EQ(Parse({"x"}).Count("--count", 5, {1, 100}), 5);
  EXPECT_EQ(count("1"), 1);
  EXPECT_EQ(count("100"), 100);
  for (const std::string text :
       {"0", "-1", "101", "2147483647", "99999999999999999999", "1e2", "5 ", "0x5", "1.0", "nan"}) {
    try {
      count(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), "--count: expected a whole number from 1 to 100, found " + text);
    }
  }
}

TEST(HelpText, ListsTheOptions) {
  const std::string help = HelpText(Syntax());
  EXPECT_THAT(help, HasSubstr("plumbline do A [B] [options]\nDoes.\n"));
  EXPECT_THAT(help, HasSubstr("--set K=V  sets; may be repeated\n  --count N  counts\n"));
}

}  // namespace
}  // namespace plumbline
