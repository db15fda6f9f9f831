// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"

#include <string>
#include <vector>

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

TEST(EscapeHtml, LeavesNothingThatHtmlWouldRead) {
  EXPECT_EQ(EscapeHtml("<b title=\"x\">'1 & 2'</b>"),
            "&lt;b title=&quot;x&quot;&gt;&#39;1 &amp; 2&#39;&lt;/b&gt;");
  EXPECT_EQ(EscapeHtml("plain text, ü"), "plain text, ü");
}

TEST(EditDistance, CountsInsertionsDeletionsReplacementsSwaps) {
  EXPECT_EQ(EditDistance("", ""), 0U);
  EXPECT_EQ(EditDistance("abc", ""), 3U);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("huber_px", "hubber_px"), 1U);
  EXPECT_EQ(EditDistance("seed", "sede"), 1U);
  EXPECT_EQ(EditDistance("ab", "ba"), 1U);
  EXPECT_EQ(EditDistance("abcd", "badc"), 2U);
  EXPECT_EQ(EditDistance("ca", "abc"), 3U);
}

TEST(NearestName, FindsTheMisspelledName) {
  const std::vector<std::string> names = {"slam.mode", "slam.seed", "ba.huber_px"};
  EXPECT_EQ(NearestName("slam.sede", names), "slam.seed");
  EXPECT_EQ(NearestName("ba.huberpx", names), "ba.huber_px");
}

TEST(NearestName, FindsANameWithoutItsGroup) {
  const std::vector<std::string> names = {"slam.seed", "slam.mode", "ba.huber_px"};
  EXPECT_EQ(NearestName("huber_px", names), "ba.huber_px");
}

TEST(NearestName, FindsANameOfTheMisspelledGroup) {
  const std::vector<std::string> names = {
      "slam.seed", "tracking.reference", "tracking.min_initial"};
  EXPECT_EQ(NearestName("trackng.foo", names), "tracking.reference");
  EXPECT_EQ(NearestName("tracking.initial", names), "tracking.min_initial");
  EXPECT_EQ(NearestName("other.foo", names), std::nullopt);
  EXPECT_EQ(NearestName("foo", names), std::nullopt);
}

TEST(NearestName, IsSilentWhenNothingIsNear) {
  const std::vector<std::string> names = {"slam.seed", "slam.mode"};
  EXPECT_EQ(NearestName("lines.weighting", names), std::nullopt);
}

TEST(NearestName, TakesNoTimeForNamesThatAreNone) {
  const std::vector<std::string> names(1000, "slam.seed");
  EXPECT_EQ(NearestName(std::string(10'000'000, 'x'), names), std::nullopt);
}

TEST(NearestName, TakesTheFirstOfEquallyNear) {
  const std::vector<std::string> names = {"abd", "abe"};
  EXPECT_EQ(NearestName("abc", names), "abd");
}

}  // namespace

}  // namespace plumbline
