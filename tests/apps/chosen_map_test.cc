// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/chosen_map.h"

#include "tests/io/scratch_folder.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

CommandLine Line(const std::vector<std::string>& arguments) {
  return CommandLine({"map x", "", {"FILE"}, {kMapOption}}, arguments);
}

TEST(ChooseMap, TakesTheOneNamedOrTheActiveOne) {
  Atlas atlas;
  for (const int id : {0, 1, 4}) atlas.Adopt(Map(MapId{id}));
  atlas.Activate(MapId{1});
  EXPECT_EQ(ChooseMap(Line({"m.plb"}), atlas).id(), MapId{1});
  EXPECT_EQ(ChooseMap(Line({"m.plb", "--map", "4"}), atlas).id(), MapId{4});
  EXPECT_EQ(atlas.active_id(), MapId{4});
  EXPECT_THAT(MessageOf([&] {
                ChooseMap(Line({"m.plb", "--map", "2"}), atlas);
              }),
              HasSubstr("--map 2: expected a map of the file"));
  Atlas none;
  EXPECT_THAT(MessageOf([&] { ChooseMap(Line({"m.plb"}), none); }),
              HasSubstr("m.plb: expected a map, found none"));
}

}  // namespace
}  // namespace plumbline
