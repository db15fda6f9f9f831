// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/yaml_document.h"

#include "plumbline/base/error.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace yaml_document_test {

using testing::HasSubstr;

std::string ErrorOf(const std::string& text) {
  try {
    ParseYaml(text, "my.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseYaml, ReadsOneDocument) {
  EXPECT_EQ(ParseYaml("---\na: 1\nb: {a: 2}\n...\n", "my.yaml")["b"]["a"].as<int>(), 2);
  EXPECT_TRUE(ParseYaml("", "my.yaml").IsNull());
  EXPECT_TRUE(ParseYaml("# nothing\n", "my.yaml").IsNull());
}

TEST(ParseYaml, KeysOfDifferentGroupsMayBeAlike) {
  EXPECT_EQ(ErrorOf("a: {x: 1}\nb: {x: 1}\nc: [{x: 1}, {x: 1}]\nx: x\n"), "no error");
  EXPECT_EQ(ErrorOf("a: &g {x: 1}\nb: *g\nc: *g\n"), "no error");
  EXPECT_EQ(ErrorOf("a: [x, x, [x, x]]\nb: ~\nc:\n"), "no error");
}

TEST(ParseYaml, NamesWhatIsWrong) {
  EXPECT_EQ(ErrorOf("a: 1\nb: 2\na: 3\n"),
            "my.yaml:3: expected each key once, found 'a' again, which is in line 1, too");
  EXPECT_THAT(ErrorOf("g:\n  h:\n    a: 1\n    b: [1, {c: 2}]\n    a: 1\n"),
              HasSubstr("my.yaml:5: "));
  EXPECT_THAT(ErrorOf("a: {x: 1, y: 2, x: 3}\n"), HasSubstr("my.yaml:1: expected each key once"));
  EXPECT_THAT(ErrorOf("? [1, 2]\n: 3\na: 1\na: 2\n"), HasSubstr("my.yaml:4: "));
  EXPECT_THAT(ErrorOf("a: 1\n---\nb: 2\n"),
              HasSubstr(": expected one YAML document, found a second one"));
  EXPECT_THAT(ErrorOf("a: [1\n"), HasSubstr("my.yaml:2: expected YAML, found an error: "));
  EXPECT_THAT(ErrorOf("a: *none\n"), HasSubstr("my.yaml:1: expected YAML, found an error: "));
  EXPECT_THAT(ErrorOf(std::string(100'000, '[')), HasSubstr("expected YAML, found an error: "));
}

}  // namespace yaml_document_test
}  // namespace plumbline
