// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/saved_atlas.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Uuid, IsMadeOfContents) {
  EXPECT_EQ(UuidOf("a"), UuidOf("a"));
  EXPECT_NE(UuidOf("a"), UuidOf("b"));
  EXPECT_NE(UuidOf(""), Uuid());
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = ToString(UuidOf("text " + std::to_string(i)));
    EXPECT_TRUE(seen.insert(name.substr(0, 12)).second) << "first half";
    EXPECT_TRUE(seen.insert(name.substr(24)).second) << "second half";
  }
}

TEST(Uuid, HasTheFormOfVersion8) {
  Uuid uuid;
  for (std::size_t i = 0; i < uuid.bytes.size(); ++i)
    uuid.bytes[i] = static_cast<std::uint8_t>(17 * i);
  EXPECT_EQ(ToString(uuid), "00112233-4455-6677-8899-aabbccddeeff");
  for (const char* text : {"", "a", "another"}) {
    const std::string name = ToString(UuidOf(text));
    ASSERT_EQ(name.size(), 36U);
    EXPECT_EQ(name[14], '8') << name;
    EXPECT_NE(std::string("89ab").find(name[19]), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace plumbline
