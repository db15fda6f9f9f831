// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"

#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  EXPECT_EQ(Printable(""), "");
  EXPECT_EQ(Printable("a/b c.txt:1: 'x' \\ ~"), "a/b c.txt:1: 'x' \\ ~");
  EXPECT_EQ(Printable("Gr\xC3\xB6\xC3\x9F\x65 \xE2\x82\xAC \xF0\x9F\x93\xB7"),
            "Gr\xC3\xB6\xC3\x9F\x65 \xE2\x82\xAC \xF0\x9F\x93\xB7");
}

TEST(Printable, EscapesWhatATerminalObeys) {
  EXPECT_EQ(Printable("a\nb\rc\td"), "a\\nb\\rc\\td");
  EXPECT_EQ(Printable("\x1b[31mred\x07"), "\\x1b[31mred\\x07");
  EXPECT_EQ(Printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(Printable("\x7f"), "\\x7f");
  EXPECT_EQ(Printable("\xC2\x9B[2J"), "\\xc2\\x9b[2J");  // C1: another ESC [
  EXPECT_EQ(Printable("a\xE2\x80\xAE\x62"),
            "a\\xe2\\x80\\xae"
            "b");  // turns the text around
}

TEST(Printable, EscapesWhatIsNoUtf8) {
  EXPECT_EQ(Printable("\xFF\xFE"), "\\xff\\xfe");
  EXPECT_EQ(Printable("\xC3"), "\\xc3");
  EXPECT_EQ(Printable("\xC3("), "\\xc3(");
  EXPECT_EQ(Printable("\xC0\x8A"), "\\xc0\\x8a");           // a longer way to write a line end
  EXPECT_EQ(Printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");  // a surrogate
}

TEST(Printable, KeepsBothEndsOfLongTexts) {
  const std::string text = "first" + std::string(1'000'000, 'x') + "last";
  const std::string shown = Printable(text);
  EXPECT_LT(shown.size(), kLongestWord + 40);
  EXPECT_TRUE(shown.starts_with("firstxxx"));
  EXPECT_NE(shown.find(" ... (1000009 bytes) ... "), std::string::npos);
  EXPECT_TRUE(shown.ends_with("xxxlast"));
  EXPECT_EQ(Printable(std::string(kLongestWord, 'x')), std::string(kLongestWord, 'x'));
}

TEST(Printable, CutsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\xE2\x82\xAC";
  for (std::size_t longest = 9; longest < 20; ++longest) {
    EXPECT_EQ(Printable(text, longest).find('\\'), std::string::npos) << longest;
  }
}

TEST(InQuotes, PutsTheTextInQuotes) {
  EXPECT_EQ(InQuotes(""), "''");
  EXPECT_EQ(InQuotes("a\n"), "'a\\n'");
}

}  // namespace
}  // namespace plumbline
