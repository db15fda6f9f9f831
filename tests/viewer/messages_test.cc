// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/messages.h"

#include "plumbline/io/recordings/image_message.h"
#include "plumbline/viewer/schemas.h"

#include <cstring>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::span<const std::uint8_t> Bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// The fields of a message as (number, bytes or the little-endian number), in order.
using Field = std::pair<unsigned, std::string>;
std::vector<Field> FieldsOf(std::string_view bytes) {
  std::vector<Field> fields;
  std::size_t at = 0;
  const auto varint = [&] {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = static_cast<std::uint8_t>(bytes.at(at++));
      value |= std::uint64_t{byte & 127U} << shift;
      if (byte < 128) return value;
    }
  };
  while (at < bytes.size()) {
    const std::uint64_t tag = varint();
    std::string value;
    if ((tag & 7U) == 0) {
      value = std::to_string(varint());
    } else {
      const std::size_t size = (tag & 7U) == 1 ? 8 : (tag & 7U) == 5 ? 4 : varint();
      value = std::string(bytes.substr(at, size));
      EXPECT_EQ(value.size(), size);
      at += size;
    }
    fields.emplace_back(static_cast<unsigned>(tag >> 3U), value);
  }
  return fields;
}

std::vector<std::string> All(std::string_view bytes, unsigned number) {
  std::vector<std::string> values;
  for (const auto& [id, value] : FieldsOf(bytes)) {
    if (id == number) values.push_back(value);
  }
  return values;
}

double DoubleOf(const std::string& bytes) {
  double value = 0;
  EXPECT_EQ(bytes.size(), sizeof(value));
  std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

// What the program reads of other recordings, it reads of its own.
TEST(Messages, AnImageIsReadAsItWasWritten) {
  const std::string bytes = CompressedImageMessage(1'403'636'579'763'555'584, "jpeg", "pixels");
  const auto image =
      ParseImage({MessageKind::kCompressedImage, MessageEncoding::kProtobuf}, Bytes(bytes));
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->stamp_ns, 1'403'636'579'763'555'584);
  EXPECT_EQ(image->encoding, "jpeg");
  EXPECT_EQ(std::string(image->data.begin(), image->data.end()), "pixels");
}

TEST(Messages, ACalibrationIsReadAsItWasWritten) {
  const RectifiedCamera camera{435.2, 435.3, 367.4, 252.2, 0.11, 752, 480};
  const std::string bytes = CalibrationMessageOf(5, camera);
  const auto read =
      ParseCalibration({MessageKind::kCalibration, MessageEncoding::kProtobuf}, Bytes(bytes));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->width, 752U);
  EXPECT_EQ(read->height, 480U);
  EXPECT_EQ(read->distortion_model, "plumb_bob");
  EXPECT_EQ(read->k, (std::array<double, 9>{435.2, 0, 367.4, 0, 435.3, 252.2, 0, 0, 1}));
  EXPECT_EQ(read->p[5], 435.3);
  EXPECT_EQ(read->d, std::vector<double>(5, 0.0));
}

TEST(Messages, APoseHasPlaceAndTurn) {
  const Rigid3 pose{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {1, 2, 3}};
  const std::string message = PoseInFrameMessage(2'000'000'001, pose);
  EXPECT_EQ(All(message, 2), std::vector<std::string>{"map"});
  const std::string stamp = All(message, 1).at(0);
  EXPECT_EQ(All(stamp, 1), std::vector<std::string>{"2"});
  EXPECT_EQ(All(stamp, 2), std::vector<std::string>{"1"});
  const std::string inner = All(message, 3).at(0);
  EXPECT_EQ(DoubleOf(All(All(inner, 1).at(0), 3).at(0)), 3);
  EXPECT_EQ(DoubleOf(All(All(inner, 2).at(0), 2).at(0)), -0.5);
  EXPECT_EQ(DoubleOf(All(All(inner, 2).at(0), 4).at(0)), 0.5);
}

TEST(Messages, ACloudHasItsPointsInOnePiece) {
  const std::vector<float> xyz = {1, 2, 3, 4, 5, 6};
  const std::string message = PointCloudMessage(0, xyz);
  const std::string data = All(message, 6).at(0);
  ASSERT_EQ(data.size(), xyz.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(data.data(), xyz.data(), data.size()), 0);
  EXPECT_EQ(All(message, 5).size(), 3U);
}

TEST(Messages, LinesThatAreGoneAreTakenBack) {
  const std::vector<LineEntity> entities = {{"a", {0, 0, 0, 1, 0, 0}}, {"b", {}}};
  const std::string some = SceneUpdateMessage(0, entities, false);
  EXPECT_EQ(All(some, 2).size(), 1U);
  ASSERT_EQ(All(some, 1).size(), 1U);
  EXPECT_EQ(All(All(some, 1)[0], 3), std::vector<std::string>{"b"});
  const std::string all = SceneUpdateMessage(0, entities, true);
  ASSERT_EQ(All(all, 1).size(), 1U);
  EXPECT_EQ(All(All(all, 1)[0], 2), std::vector<std::string>{"1"});  // ALL
  const std::string lines = All(All(all, 2).at(0), 11).at(0);
  EXPECT_EQ(All(lines, 5).size(), 2U);
}

TEST(Messages, AnnotationsLeaveOutWhatThereIsNone) {
  std::vector<ImageMarks> marks(3);
  marks[0].points = {{1, 2}, {3, 4}};
  marks[2].segments = {{{0, 0}, {5, 5}}};
  const auto annotations = All(AnnotationsMessage(0, marks), 2);
  ASSERT_EQ(annotations.size(), 2U);
  EXPECT_EQ(All(annotations[0], 2), std::vector<std::string>{"1"});  // POINTS
  EXPECT_EQ(All(annotations[0], 3).size(), 2U);
  EXPECT_EQ(All(annotations[1], 2), std::vector<std::string>{"4"});  // LINE_LIST
  EXPECT_EQ(All(annotations[1], 3).size(), 2U);
}

// All messages of the schemas: name -> numbers of their fields, and the types that they name.
struct Described {
  std::map<std::string, std::set<std::string>> fields;
  std::set<std::string> named;
};

Described DescribedTypes() {
  Described described;
  for (const std::string& file : All(FoxgloveSchemas(), 1)) {
    const std::string package = All(file, 2).at(0);
    EXPECT_EQ(All(file, 12), std::vector<std::string>{"proto3"});
    for (const std::string& message : All(file, 4)) {
      const std::string name = package + "." + All(message, 1).at(0);
      for (const std::string& field : All(message, 2)) {
        const bool is_new = described.fields[name].insert(All(field, 3).at(0)).second;
        EXPECT_TRUE(is_new) << name << " has two fields of one number";
        for (const std::string& type : All(field, 6)) described.named.insert(type.substr(1));
      }
      for (const std::string& choice : All(message, 4)) {
        described.fields[name + "." + All(choice, 1).at(0)];
      }
    }
  }
  return described;
}

TEST(Schemas, EveryTypeThatIsNamedIsDescribed) {
  const Described described = DescribedTypes();
  for (const std::string& type : described.named)
    EXPECT_TRUE(described.fields.contains(type)) << type;
  for (const FoxgloveChannel& channel : FoxgloveChannels()) {
    EXPECT_TRUE(described.fields.contains(std::string(channel.type))) << channel.type;
  }
}

// What is written under a number that the schema does not have would be lost on everybody.
TEST(Schemas, EveryFieldThatIsWrittenIsDescribed) {
  const Described described = DescribedTypes();
  const std::vector<float> xyz = {1, 2, 3};
  const std::vector<LineEntity> lines = {{"a", {0, 0, 0, 1, 0, 0}}};
  std::vector<ImageMarks> marks(1);
  marks[0].points = {{1, 2}};
  const std::map<std::string, std::string> messages = {
      {"foxglove.CompressedImage", CompressedImageMessage(1, "jpeg", "x")},
      {"foxglove.CameraCalibration", CalibrationMessageOf(1, {})},
      {"foxglove.ImageAnnotations", AnnotationsMessage(1, marks)},
      {"foxglove.PoseInFrame", PoseInFrameMessage(1, {})},
      {"foxglove.FrameTransform", TransformMessage(1, {})},
      {"foxglove.PointCloud", PointCloudMessage(1, xyz)},
      {"foxglove.SceneUpdate", SceneUpdateMessage(1, lines, true)}};
  for (const auto& [type, bytes] : messages) {
    for (const auto& [number, value] : FieldsOf(bytes)) {
      EXPECT_TRUE(described.fields.at(type).contains(std::to_string(number))) << type << number;
    }
  }
}

}  // namespace
}  // namespace plumbline
