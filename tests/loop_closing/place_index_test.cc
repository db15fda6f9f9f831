// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/place_index.h"

#include "plumbline/base/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using ::testing::ElementsAre;

// What a place looks like.
Features Place(std::uint64_t number, std::size_t points = 300, std::size_t lines = 60) {
  Rng rng(number, "place");
  Features features;
  features.points.resize(points);
  features.lines.resize(lines);
  for (PointFeature& point : features.points) {
    point.response = static_cast<std::uint16_t>(rng.Uniform(0, 65535));
    for (std::uint64_t& word : point.descriptor) word = rng.Next();
  }
  for (LineFeature& line : features.lines) {
    line.response = rng.Uniform();
    for (std::uint64_t& word : line.descriptor) word = rng.Next();
  }
  return features;
}

// Each bit the other way with this probability.
template <class Feature>
void Disturb(double probability, Rng& rng, std::vector<Feature>& features) {
  for (Feature& feature : features) {
    for (std::size_t bit = 0; bit < 256; ++bit) {
      if (rng.Uniform() < probability) {
        feature.descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
      }
    }
  }
}

Features SeenAgain(Features place, double flips, std::uint64_t view) {
  Rng rng(view, "view");
  Disturb(flips, rng, place.points);
  Disturb(flips, rng, place.lines);
  return place;
}

bool All(KeyFrameId) { return true; }

PlaceIndex IndexOf(std::int64_t places) {
  PlaceIndex index;
  for (std::int64_t i = 0; i < places; ++i) {
    index.Add(KeyFrameId{i}, Place(static_cast<std::uint64_t>(i)));
  }
  return index;
}

bool Same(const std::vector<PlaceCandidate>& a, const std::vector<PlaceCandidate>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.id == y.id && x.score == y.score;
  });
}

TEST(PlaceIndex, FindsThePlaceAmongMany) {
  const PlaceIndex index = IndexOf(200);
  for (const std::uint64_t place : {0U, 77U, 199U}) {
    const auto found = index.Query(SeenAgain(Place(place), 0.08, 1), 5, All);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].id.value, static_cast<std::int64_t>(place));
    EXPECT_GT(found[0].score, 0.2);
    for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LT(found[i].score, 0.05);
  }
}

TEST(PlaceIndex, ScoresAPlaceLessTheLessOfItIsSeen) {
  const PlaceIndex index = IndexOf(50);
  const Features other = Place(1000);
  double last = 1;
  for (const std::size_t strange : {100U, 200U, 300U}) {
    Features image = Place(7);
    for (std::size_t i = 0; i < strange; ++i)
      image.points[i].descriptor = other.points[i].descriptor;
    const auto found = index.Query(image, 1, All);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].id, KeyFrameId{7});
    EXPECT_LT(found[0].score, last);
    last = found[0].score;
  }
  EXPECT_GT(last, 0.1);  // the lines alone
}

// A threshold of the score means the same in a small index and a large one.
TEST(PlaceIndex, ScoresTheSamePlaceAlikeInSmallAndLargeIndices) {
  const Features image = SeenAgain(Place(3), 0.05, 2);
  const double small = IndexOf(10).Query(image, 1, All)[0].score;
  const double large = IndexOf(400).Query(image, 1, All)[0].score;
  EXPECT_NEAR(large, small, 0.25 * small);
  EXPECT_NEAR(IndexOf(10).Query(Place(3), 1, All)[0].score, 1, 1e-3);
}

TEST(PlaceIndex, KnowsAPlaceByItsPointsOrItsLinesAlone) {
  const PlaceIndex index = IndexOf(100);
  Features points = SeenAgain(Place(20), 0.05, 3);
  points.lines.clear();
  Features lines = SeenAgain(Place(20), 0.05, 3);
  lines.points.clear();
  EXPECT_EQ(index.Query(points, 1, All).at(0).id, KeyFrameId{20});
  EXPECT_EQ(index.Query(lines, 1, All).at(0).id, KeyFrameId{20});
}

TEST(PlaceIndex, GivesOnlyWhatIsAllowed) {
  const PlaceIndex index = IndexOf(30);
  int asked = 0;
  const auto found = index.Query(Place(4), 30, [&](KeyFrameId id) {
    ++asked;
    return id != KeyFrameId{4};
  });
  for (const PlaceCandidate& candidate : found) EXPECT_NE(candidate.id, KeyFrameId{4});
  EXPECT_LE(asked, 30);
}

// Many views of the camera's surroundings do not hide the one from long ago.
TEST(PlaceIndex, AnswersForAKeyFrameAsForItsImage) {
  const PlaceIndex index = IndexOf(30);
  const auto others = [](KeyFrameId id) { return id.value % 3 != 1; };
  for (const KeyFrameId id : index.Ids()) {
    EXPECT_TRUE(Same(index.Query(id, 10, others),
                     index.Query(Place(static_cast<std::uint64_t>(id.value)), 10, others)));
  }
  EXPECT_THROW(index.Query(KeyFrameId{1000}, 1, others), BugError);
}

TEST(PlaceIndex, DoesNotCountWhatIsNotAllowedAsAlike) {
  PlaceIndex index = IndexOf(20);
  const Features image = SeenAgain(Place(5), 0.03, 4);
  const double before = index.Query(image, 1, All).at(0).score;
  for (std::int64_t i = 0; i < 30; ++i) {
    index.Add(KeyFrameId{1000 + i}, SeenAgain(Place(5), 0.03, static_cast<std::uint64_t>(50 + i)));
  }
  const auto found = index.Query(image, 1, [](KeyFrameId id) { return id.value < 1000; });
  EXPECT_EQ(found.at(0).id, KeyFrameId{5});
  EXPECT_NEAR(found.at(0).score, before, 0.1 * before);
}

TEST(PlaceIndex, FindsTheOlderOfTwoThatAreEqual) {
  PlaceIndex index;
  index.Add(KeyFrameId{9}, Place(1));
  index.Add(KeyFrameId{2}, Place(1));
  index.Add(KeyFrameId{5}, Place(2));
  const auto found = index.Query(Place(1), 2, All);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].id, KeyFrameId{2});
  EXPECT_EQ(found[1].id, KeyFrameId{9});
  EXPECT_EQ(found[0].score, found[1].score);
}

TEST(PlaceIndex, AnswersAsOneMadeAnewOfWhatIsInIt) {
  PlaceIndex grown = IndexOf(60);
  for (std::int64_t i = 0; i < 60; i += 3) grown.Remove(KeyFrameId{i});
  grown.Add(KeyFrameId{3}, Place(3));
  PlaceIndex anew;
  for (std::int64_t i = 59; i >= 0; --i) {
    if (grown.Contains(KeyFrameId{i})) {
      anew.Add(KeyFrameId{i}, Place(static_cast<std::uint64_t>(i)));
    }
  }
  EXPECT_EQ(grown.Ids(), anew.Ids());
  EXPECT_EQ(grown.size(), 41U);
  for (std::uint64_t place = 0; place < 60; place += 4) {
    const Features image = SeenAgain(Place(place), 0.1, place);
    EXPECT_TRUE(Same(grown.Query(image, 60, All), anew.Query(image, 60, All))) << place;
  }
}

TEST(PlaceIndex, ForgetsWhatIsRemoved) {
  PlaceIndex index = IndexOf(10);
  index.Remove(KeyFrameId{4});
  index.Remove(KeyFrameId{4});
  index.Remove(KeyFrameId{400});
  EXPECT_FALSE(index.Contains(KeyFrameId{4}));
  for (const PlaceCandidate& candidate : index.Query(Place(4), 10, All)) {
    EXPECT_NE(candidate.id, KeyFrameId{4});
    EXPECT_LT(candidate.score, 0.1);
  }
}

TEST(PlaceIndex, TakesTheStrongest) {
  Features many = Place(1, 1000, 300);
  Features strongest = many;
  const auto keep = [](auto& features, std::size_t count) {
    std::sort(features.begin(), features.end(), [](const auto& a, const auto& b) {
      return a.response > b.response;
    });
    features.resize(count);
  };
  keep(strongest.points, PlaceIndex::kPoints);
  keep(strongest.lines, PlaceIndex::kLines);
  PlaceIndex index;
  index.Add(KeyFrameId{0}, many);
  EXPECT_NEAR(index.Query(strongest, 1, All).at(0).score, 1, 1e-3);
  PlaceIndex same;
  same.Add(KeyFrameId{0}, strongest);
  EXPECT_EQ(same.Query(many, 1, All).at(0).score, index.Query(many, 1, All).at(0).score);
}

TEST(PlaceIndex, FindsNothingForNothingAndInNothing) {
  EXPECT_TRUE(IndexOf(5).Query(Features{}, 5, All).empty());
  EXPECT_TRUE(PlaceIndex().Query(Place(1), 5, All).empty());
  EXPECT_TRUE(IndexOf(5).Query(Place(1), 0, All).empty());
  PlaceIndex index;
  index.Add(KeyFrameId{0}, Features{});  // a keyframe that shows nothing
  EXPECT_TRUE(index.Query(Place(1), 5, All).empty());
  EXPECT_TRUE(index.Contains(KeyFrameId{0}));
  index.Remove(KeyFrameId{0});
  EXPECT_EQ(index.size(), 0U);
}

TEST(PlaceIndex, TellsWhichIdsOfAPageAreThere) {
  PlaceIndex index;
  EXPECT_EQ(index.page_count(), 0U);
  for (const int id : {1, 63, 64}) index.Add(KeyFrameId{id}, Features{});
  EXPECT_EQ(index.TakenOfPage(0), std::uint64_t{1} << 63U | 0b10U);
  EXPECT_EQ(index.TakenOfPage(1), 1U);
  index.Remove(KeyFrameId{64});
  index.Remove(KeyFrameId{65});
  EXPECT_EQ(index.TakenOfPage(1), 0U);
  EXPECT_EQ(index.TakenOfPage(index.page_count()), 0U);
  EXPECT_THROW(index.Add(KeyFrameId{}, Features{}), BugError);
}

TEST(PlaceIndex, NeedsLessThanTwentyKilobytesAKeyFrame) {
  PlaceIndex index;
  for (std::int64_t i = 0; i < 100; ++i) {
    index.Add(KeyFrameId{i}, Place(static_cast<std::uint64_t>(i), 1000, 200));
  }
  EXPECT_LT(index.Memory(), 100U * 20000U);
  EXPECT_GT(index.Memory(), 100U * 500U * sizeof(Signature));
}

}  // namespace
}  // namespace plumbline
