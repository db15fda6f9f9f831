// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/state_stream.h"

#include "plumbline/base/error.h"
#include "plumbline/map/state_format.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const RectifiedCamera kCamera{450, 451, 375.5, 239.25, 0.11, 752, 480};

StateReader ReaderOf(const std::string& bytes) {
  return {{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "test", kCamera};
}

std::shared_ptr<const IndexedFeatures> OnePoint(double x) {
  Features features;
  features.points.resize(1);
  features.points[0].px = {x, 20};
  features.point_disparity.emplace_back(Disparity{3.25, 0.5});
  Vector6d k;
  k << 0.1, -0.2, 0.3, -0.4, 0.5, -0.6;
  return IndexFeatures(kCamera, std::move(features), {{kCamera, k}, {kCamera, 2}});
}

TEST(StateStream, WhatIsSharedIsWrittenOnceAndSharedAgain) {
  const auto a = OnePoint(10);
  const auto b = OnePoint(30);
  const std::vector<std::shared_ptr<const IndexedFeatures>> saved = {a, b, nullptr, a, b, b};
  StateWriter writer;
  Transfer(writer, saved);
  StateWriter once;
  Transfer(once, std::vector{a, b});
  EXPECT_LT(writer.bytes().size(), once.bytes().size() + 50);

  StateReader reader = ReaderOf(writer.bytes());
  std::vector<std::shared_ptr<const IndexedFeatures>> loaded;
  Transfer(reader, loaded);
  EXPECT_EQ(reader.remaining(), 0U);
  ASSERT_EQ(loaded.size(), saved.size());
  EXPECT_EQ(loaded[0], loaded[3]);
  EXPECT_EQ(loaded[1], loaded[4]);
  EXPECT_NE(loaded[0], loaded[1]);
  EXPECT_EQ(loaded[2], nullptr);
  // To the last bit, with the correction and an index of the same image.
  EXPECT_EQ(loaded[1]->features.points[0].px, b->features.points[0].px);
  EXPECT_EQ(loaded[1]->features.point_disparity[0]->px, b->features.point_disparity[0]->px);
  EXPECT_EQ(loaded[1]->correction, b->correction);
  EXPECT_EQ(loaded[1]->point_grid.InWindow(b->features.points[0].px, 1), std::vector<int>{0});
}

TEST(StateStream, ANumberOfNothingOrOfSomethingElseIsRefused) {
  StateWriter features;
  Transfer(features, OnePoint(10));
  features(std::uint64_t{1});  // meant as a snapshot
  StateReader reader = ReaderOf(features.bytes());
  std::shared_ptr<const IndexedFeatures> indexed;
  Transfer(reader, indexed);
  std::shared_ptr<const MapSnapshot> snapshot;
  EXPECT_THROW(Transfer(reader, snapshot), InputError);
  ByteWriter number;
  number(std::uint64_t{7});
  StateReader other = ReaderOf(number.bytes());
  EXPECT_THROW(Transfer(other, indexed), InputError);
}

TEST(StateFormat, AFrameComesBackAndHasMatchesOfItsFeatures) {
  Frame frame;
  frame.id = FrameId{4};
  frame.stamp_ns = 77;
  frame.cam_from_world.translation = {1, 2, 3};
  frame.indexed = OnePoint(10);
  frame.points = {PointId{9}};
  StateWriter writer;
  Transfer(writer, frame);
  StateReader reader = ReaderOf(writer.bytes());
  Frame loaded;
  Transfer(reader, loaded);
  EXPECT_EQ(loaded.id, frame.id);
  EXPECT_EQ(loaded.stamp_ns, 77);
  EXPECT_EQ(loaded.cam_from_world.translation, frame.cam_from_world.translation);
  EXPECT_EQ(loaded.points, frame.points);
  frame.points.emplace_back();
  StateWriter wrong;
  Transfer(wrong, frame);
  StateReader of_wrong = ReaderOf(wrong.bytes());
  EXPECT_THROW(Transfer(of_wrong, loaded), InputError);
}

TEST(StateFormat, ASnapshotHasItsCentreAndLandmarksInOrder) {
  MapSnapshot snapshot;
  snapshot.centre = KeyFrameId{3};
  snapshot.places[KeyFrameId{3}].unit = 2;
  auto reference = std::make_shared<KeyFrame>();
  reference->frame.indexed = OnePoint(10);
  reference->frame.points.resize(1);
  snapshot.reference = reference;
  snapshot.points.resize(2);
  snapshot.points[0].id = PointId{1};
  snapshot.points[1].id = PointId{5};
  snapshot.points[1].position = {0.1, 0.2, 0.3};
  snapshot.points[1].observation_count = 4;
  const auto copied = [](const MapSnapshot& original) {
    StateWriter writer;
    Transfer(writer, original);
    StateReader reader = ReaderOf(writer.bytes());
    MapSnapshot copy;
    Transfer(reader, copy);
    return copy;
  };
  const MapSnapshot copy = copied(snapshot);
  EXPECT_EQ(copy.centre, snapshot.centre);
  EXPECT_EQ(copy.places.at(KeyFrameId{3}).unit, 2);
  ASSERT_NE(copy.Find(PointId{5}), nullptr);
  EXPECT_EQ(copy.Find(PointId{5})->position, snapshot.points[1].position);
  EXPECT_EQ(copy.Find(PointId{5})->observation_count, 4);
  MapSnapshot other = snapshot;
  std::swap(other.points[0], other.points[1]);
  EXPECT_THROW(copied(other), InputError);
  other = snapshot;
  other.centre = KeyFrameId{4};
  EXPECT_THROW(copied(other), InputError);
  other = snapshot;
  other.reference = nullptr;
  EXPECT_THROW(copied(other), InputError);
}

}  // namespace
}  // namespace plumbline
