// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"

#include "plumbline/base/error.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace options_io_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

enum class Shape { kRound, kSquare };
constexpr auto EnumNames(std::type_identity<Shape>) {
  return std::array{std::pair{Shape::kRound, "round"}, std::pair{Shape::kSquare, "square"}};
}

struct InnerOptions {
  double huber_px = 2.45;
  int iterations = 10;
};

template <class Visitor>
void VisitFields(Visitor&& visit, InnerOptions& o) {
  visit("huber_px", o.huber_px, "Huber threshold [px]", Range{0, 100});
  visit("iterations", o.iterations, "iterations per solve", Range{1});
}

std::vector<RemovedOption> RemovedOptions(std::type_identity<InnerOptions> /*of*/) {
  return {FixedAt("damping", 0.5, "kDamping"),
          {"loss.kind", "it is fixed at huber (HuberLoss)", "huber"},
          {"kernel", "loss.kind took its place"}};
}

struct OuterOptions {
  bool lines = true;
  Shape shape = Shape::kRound;
  std::string title = "a \"b\" # c";
  std::uint64_t seed = 0;
  InnerOptions ba;
  std::int64_t offset = -3;
  std::string search = "near";
};

template <class Visitor>
void VisitFields(Visitor&& visit, OuterOptions& o) {
  visit("lines", o.lines, "use lines");
  visit("shape", o.shape, "shape of things");
  visit("title", o.title, "title");
  visit("seed", o.seed, "seed of all randomness");
  visit("ba", o.ba, "bundle adjustment");
  visit("offset", o.offset, "offset");
  visit("search", o.search, "how to look: near (around the last place)", Methods{{"near", "far"}});
}

const std::vector<AddedMethod> kMore = {{"search", "wide", "everywhere"},
                                        {"of.another.struct", "wide", "everywhere"}};

std::string ErrorOfYaml(const std::string& yaml) {
  OuterOptions options;
  OptionTable table(options);
  try {
    table.LoadText(yaml, "my.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorOfSet(const std::string& assignment) {
  OuterOptions options;
  OptionTable table(options);
  try {
    table.Set(assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OptionTable, ListsKeysInOrder) {
  OuterOptions options;
  EXPECT_THAT(
      OptionTable(options).Keys(),
      ElementsAre(
          "lines", "shape", "title", "seed", "ba.huber_px", "ba.iterations", "offset", "search"));
}

TEST(OptionTable, ReadsEveryType) {
  OuterOptions options;
  OptionTable(options).LoadText(
      "lines: false\nshape: square\ntitle: x y\nseed: 18446744073709551615\n"
      "ba:\n  huber_px: 1e-3\n  iterations: 3\noffset: -9\n",
      "my.yaml");
  EXPECT_FALSE(options.lines);
  EXPECT_EQ(options.shape, Shape::kSquare);
  EXPECT_EQ(options.title, "x y");
  EXPECT_EQ(options.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(options.ba.huber_px, 1e-3);
  EXPECT_EQ(options.ba.iterations, 3);
  EXPECT_EQ(options.offset, -9);
}

TEST(OptionTable, LaterSettingsReplaceEarlierOnes) {
  OuterOptions options;
  OptionTable table(options);
  table.LoadText("ba: {huber_px: 1}\nseed: 4", "a.yaml");
  table.LoadText("ba.huber_px: 2", "b.yaml");
  table.Set("seed=5");
  table.Set("seed=6");
  table.Set("title=a=b");
  EXPECT_EQ(options.ba.huber_px, 2);
  EXPECT_EQ(options.seed, 6U);
  EXPECT_EQ(options.title, "a=b");
}

TEST(OptionTable, AcceptsEmptyFilesAndGroups) {
  EXPECT_EQ(ErrorOfYaml(""), "no error");
  EXPECT_EQ(ErrorOfYaml("# only a comment\n"), "no error");
  EXPECT_EQ(ErrorOfYaml("ba:\n  # huber_px: 1\nseed: 1\n"), "no error");
}

TEST(OptionTable, DumpIsAConfigOfTheSameValues) {
  OuterOptions options;
  options.lines = false;
  options.shape = Shape::kSquare;
  options.title = "tab\t\"quoted\" \\ # : {";
  options.seed = 12345678901234567890U;
  options.ba.huber_px = std::nextafter(0.1, 1);
  options.offset = std::numeric_limits<std::int64_t>::min();
  const std::string dump = OptionTable(options).Dump();

  OuterOptions copy;
  OptionTable table(copy);
  table.LoadText(dump, "dump");
  EXPECT_EQ(copy.lines, options.lines);
  EXPECT_EQ(copy.shape, options.shape);
  EXPECT_EQ(copy.title, options.title);
  EXPECT_EQ(copy.seed, options.seed);
  EXPECT_EQ(copy.ba.huber_px, options.ba.huber_px);
  EXPECT_EQ(copy.offset, options.offset);
  EXPECT_EQ(table.Dump(), dump);
}

TEST(OptionTable, DumpExplainsTheOptions) {
  OuterOptions options;
  const std::string dump = OptionTable(options).Dump();
  EXPECT_THAT(dump, HasSubstr("lines: true  # use lines (true | false)\n"));
  EXPECT_THAT(dump, HasSubstr("shape: round  # shape of things (round | square)\n"));
  EXPECT_THAT(dump, HasSubstr("\nba:  # bundle adjustment\n"));
  EXPECT_THAT(dump, HasSubstr("  huber_px: 2.45  # Huber threshold [px] (0 to 100)\n"));
  EXPECT_THAT(dump, HasSubstr("  iterations: 10  # iterations per solve (at least 1)\n"));
}

TEST(OptionTable, DumpsSomeOptionsWithTheirGroups) {
  OuterOptions options;
  const std::string dump = OptionTable(options).Dump(
      [](const OptionField& field) { return field.key == "ba.huber_px" || field.key == "seed"; });
  EXPECT_THAT(dump, HasSubstr("seed: "));
  EXPECT_THAT(dump, HasSubstr("\nba:  # bundle adjustment\n  huber_px: 2.45  # "));
  EXPECT_THAT(dump, Not(HasSubstr("iterations")));
  EXPECT_THAT(dump, Not(HasSubstr("lines")));
  OuterOptions copy;
  OptionTable(copy).LoadText(dump, "dump");  // a valid config
}

TEST(OptionTable, BadYamlIsNamedByFileLineKeyAndWhatIsAllowed) {
  struct Case {
    std::string yaml;
    std::string message;
  };
  const std::vector<Case> cases = {
      {"seed: 1\nsede: 2", "my.yaml:2: unknown option 'sede'; did you mean 'seed'?"},
      {"ba:\n  hubber_px: 2",
       "my.yaml:2: unknown option 'ba.hubber_px'; did you mean 'ba.huber_px'?"},
      {"quite_another_thing: 2", "my.yaml:1: unknown option 'quite_another_thing'"},
      {"\nba:\n  huber_px: 101",
       "my.yaml:3: ba.huber_px: expected a number, 0 to 100, found '101'"},
      {"ba: {huber_px: nan}", "my.yaml:1: ba.huber_px: expected a number, 0 to 100, found 'nan'"},
      {"ba: {huber_px: 2px}", "my.yaml:1: ba.huber_px: expected a number, 0 to 100, found '2px'"},
      {"ba: {iterations: 0}",
       "my.yaml:1: ba.iterations: expected a whole number, at least 1, found '0'"},
      {"ba: {iterations: 2.5}",
       "my.yaml:1: ba.iterations: expected a whole number, at least 1, found '2.5'"},
      {"ba: {iterations: 99999999999}",
       "my.yaml:1: ba.iterations: expected a whole number, at least 1, found '99999999999'"},
      {"seed: -1", "my.yaml:1: seed: expected a whole number, at least 0, found '-1'"},
      {"lines: yes", "my.yaml:1: lines: expected true or false, found 'yes'"},
      {"shape: oval", "my.yaml:1: shape: expected one of round | square, found 'oval'"},
      {"shape: [round]", "my.yaml:1: shape: expected one of round | square, found '[...]'"},
      {"seed:", "my.yaml:1: seed: expected a whole number, at least 0, found ''"},
      {"ba: 3", "my.yaml:1: ba: expected a group of options, found '3'"},
      {"seed: {a: 1}", "my.yaml:1: unknown option 'seed.a'"},
      {"- 1\n- 2", "my.yaml:1: expected options as 'key: value', found other YAML"},
      {"seed: 1\nba: [1, 2", "my.yaml:"},
      {"seed: 1\n\tba: 2", "my.yaml:2: expected YAML, found an error"},
      {"seed: 1\nlines: true\nseed: 2",
       "my.yaml:3: expected each key once, found 'seed' again, which is in line 1, too"},
      {"ba: {huber_px: 2}\nba.huber_px: 3",
       "my.yaml:2: ba.huber_px: expected each option once, found it in line 1, too"},
      {"seed: 1\n---\nseed: 2", "expected one YAML document, found a second one"},
      {"seed: \"\\e[31m\"", "seed: expected a whole number, at least 0, found '\\x1b[31m'"},
  };
  for (const Case& c : cases) EXPECT_THAT(ErrorOfYaml(c.yaml), HasSubstr(c.message)) << c.yaml;
}

TEST(OptionTable, GroupsThatRepeatWithoutEndAreRefused) {
  EXPECT_EQ(ErrorOfYaml("ba: &a\n  ba: *a\n"),
            "my.yaml:2: expected options, found groups without end");
  // Ten times ten times ten ... groups.
  std::string yaml = "a0: &a0 {}\n";
  for (int level = 1; level < 12; ++level) {
    yaml += "a" + std::to_string(level) + ": &a" + std::to_string(level) + " {";
    for (int i = 0; i < 10; ++i) {
      yaml += "b" + std::to_string(i) + ": *a" + std::to_string(level - 1) + ", ";
    }
    yaml += "}\n";
  }
  EXPECT_THAT(ErrorOfYaml(yaml), HasSubstr("expected options, found groups without end"));
}

TEST(OptionTable, BadSettingsOfTheCommandLineAreNamed) {
  EXPECT_EQ(ErrorOfSet("seed"), "--set: expected KEY=VALUE, found 'seed'");
  EXPECT_EQ(ErrorOfSet("=1"), "--set: expected KEY=VALUE, found '=1'");
  EXPECT_THAT(ErrorOfSet("hubber_px=1"), HasSubstr("did you mean 'ba.huber_px'?"));
  EXPECT_EQ(ErrorOfSet("lines=1"), "--set lines=1: lines: expected true or false, found '1'");
}

TEST(OptionTable, SettingsOfOtherReadersAreNamedByTheirPlace) {
  const auto error_of = [](const std::string& key, const std::string& text) {
    OuterOptions options;
    OptionTable table(options);
    try {
      table.Set(key, text, "den.yaml:7");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return "no error, huber_px " + table.Value("ba.huber_px");
  };
  EXPECT_EQ(error_of("ba.huber_px", "3"), "no error, huber_px 3");
  EXPECT_EQ(error_of("lines", "1"), "den.yaml:7: lines: expected true or false, found '1'");
  EXPECT_EQ(error_of("hubber_px", "1"),
            "den.yaml:7: unknown option 'hubber_px'; did you mean 'ba.huber_px'?");
}

TEST(OptionTable, FaultySettingLeavesTheValue) {
  OuterOptions options;
  EXPECT_THROW(OptionTable(options).Set("ba.huber_px=1000"), InputError);
  EXPECT_EQ(options.ba.huber_px, 2.45);
}

TEST(OptionTable, ReadsFilesAndNamesMissingOnes) {
  OuterOptions options;
  OptionTable table(options);
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "plumbline_options_io_test.yaml";
  std::ofstream(path) << "seed: 77\n";
  table.LoadFile(path);
  EXPECT_EQ(options.seed, 77U);
  std::filesystem::remove(path);
  EXPECT_THROW(table.LoadFile(path), InputError);
  EXPECT_THROW(table.LoadFile(testing::TempDir()), InputError);
  // An empty file is one that was cut off; one of comments alone is written on purpose.
  std::ofstream(path) << "# nothing yet\n";
  table.LoadFile(path);
  std::ofstream(path) << "\n \n";
  EXPECT_THROW(table.LoadFile(path), InputError);
  std::filesystem::remove(path);
}

TEST(OptionTable, GivesSingleValues) {
  OuterOptions options;
  const OptionTable table(options);
  EXPECT_EQ(table.Value("ba.huber_px"), "2.45");
  EXPECT_EQ(table.Value("shape"), "round");
  EXPECT_THROW((void)table.Value("nothing"), InputError);
}

TEST(OptionTable, RefusesRemovedOptionsAndNamesWhatServesInstead) {
  EXPECT_EQ(ErrorOfYaml("ba:\n  damping: 0.6"),
            "my.yaml:2: ba.damping is no option any more: it is fixed at 0.5 (kDamping), found "
            "'0.6'");
  EXPECT_EQ(ErrorOfYaml("ba.loss.kind:"),
            "my.yaml:1: ba.loss.kind is no option any more: it is fixed at huber (HuberLoss), "
            "found ''");
  EXPECT_EQ(ErrorOfYaml("ba: {kernel: huber}"),
            "my.yaml:1: ba.kernel is no option any more: loss.kind took its place, found 'huber'");
  EXPECT_EQ(ErrorOfSet("ba.damping=0.5"),
            "--set ba.damping=0.5: ba.damping is no option any more: it is fixed at 0.5 "
            "(kDamping), found '0.5'");
}

// Files that an earlier version wrote hold all of its options, most of them at their defaults.
TEST(OptionTable, ReadsRemovedOptionsAtTheValuesOfTheirConstants) {
  EXPECT_EQ(ErrorOfYaml("ba: {damping: 0.50, iterations: 3, loss: {kind: huber}}"), "no error");
  EXPECT_EQ(ErrorOfYaml("ba:\n  damping: 5e-1\n  loss:\n"), "no error");
  OuterOptions options;
  const OptionTable table(options);
  std::vector<std::string> keys;
  for (const RemovedOption& removed : table.removed()) keys.push_back(removed.name);
  EXPECT_THAT(keys, ElementsAre("ba.damping", "ba.loss.kind", "ba.kernel"));
  EXPECT_THAT(table.Dump(), Not(HasSubstr("damping")));
}

TEST(OptionTable, TellsOfRemovedOptionsInPlaceOfAnErrorWhereAsked) {
  OuterOptions options;
  OptionTable table(options);
  std::vector<RemovedSetting> told;
  table.LoadText("ba: {damping: 0.6, loss.kind: huber, iterations: 7}",
                 "m.plb",
                 [&](const RemovedSetting& setting) { told.push_back(setting); });
  EXPECT_EQ(options.ba.iterations, 7);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].key, "ba.damping");
  EXPECT_EQ(told[0].found, "0.6");
  EXPECT_EQ(told[0].constant, "0.5");
  EXPECT_EQ(told[0].message,
            "m.plb:1: ba.damping is no option any more: it is fixed at 0.5 (kDamping), found "
            "'0.6'");
}

TEST(OptionTable, KnowsTheMethodsOfTheLibraryAndThoseOfTheProgram) {
  EXPECT_THAT(ErrorOfYaml("search: wide"),
              HasSubstr("my.yaml:1: search: expected one of near | far, found 'wide'"));
  OuterOptions options;
  OptionTable table(options, kMore);
  table.Set("search=wide");
  EXPECT_EQ(options.search, "wide");
  EXPECT_THAT(table.Dump(),
              HasSubstr("search: wide  # how to look: near (around the last place), wide "
                        "(everywhere) (near | far | wide)\n"));
  EXPECT_NO_THROW(table.CheckRanges());
  EXPECT_THROW(OptionTable(options).CheckRanges(), InputError);
  EXPECT_THROW(table.Set("search=deep"), InputError);
  EXPECT_EQ(options.search, "wide");
}

// Saved options may name a method of another program.
TEST(OptionTable, TellsOfMethodsThatTheProgramDoesNotHave) {
  OuterOptions options;
  OptionTable table(options);
  std::vector<RemovedSetting> told;
  const auto tell = [&](const RemovedSetting& setting) { told.push_back(setting); };
  table.LoadText("search: wide\nseed: 4", "m.plb", tell);
  EXPECT_EQ(options.search, "near");
  EXPECT_EQ(options.seed, 4U);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].constant, "near");
  EXPECT_EQ(told[0].message, "m.plb:1: search: expected one of near | far, found 'wide'");
  EXPECT_THROW(table.LoadText("shape: oval", "m.plb", tell), InputError);
}

TEST(OptionTable, DumpsOptionsWithDottedKeysBehindOthers) {
  OuterOptions options;
  options.ba.iterations = 4;
  const OptionTable table(options);
  const auto inner = [](const OptionField& field) { return field.key.starts_with("ba."); };
  const std::string dotted = table.DumpDotted(inner);
  EXPECT_THAT(dotted, HasSubstr("\nba.iterations: 4  # iterations per solve (at least 1)\n"));
  OuterOptions again;
  OptionTable read(again);
  read.LoadText(table.Dump([&](const OptionField& field) { return !inner(field); }) + dotted, "");
  EXPECT_EQ(read.Dump(), table.Dump());
}

}  // namespace options_io_test
}  // namespace plumbline
