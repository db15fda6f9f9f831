// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/image_message.h"

#include "tests/support/message_writer.h"
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace image_message_test {

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class Dialects : public testing::TestWithParam<Dialect> {
 protected:
  static MessageForm Form(MessageKind kind) {
    const std::map<Dialect, MessageEncoding> encodings = {
        {Dialect::kRos1, MessageEncoding::kRos1},
        {Dialect::kCdr, MessageEncoding::kCdr},
        {Dialect::kBigEndianCdr, MessageEncoding::kCdr},
        {Dialect::kProtobuf, MessageEncoding::kProtobuf}};
    return {kind, encodings.at(GetParam())};
  }
  static constexpr std::int64_t kStamp = 1'403'636'579'763'555'584;
};

TEST_P(Dialects, HaveImages) {
  const std::string bytes =
      RawImageMessage(GetParam(), {kStamp, "bgr8", 2, 3, 7, "0123456789", "camera_0"});
  const auto image = ParseImage(Form(MessageKind::kImage), BytesOf(bytes));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->stamp_ns, kStamp);
  EXPECT_FALSE(image->compressed);
  EXPECT_EQ(image->encoding, "bgr8");
  EXPECT_EQ(image->frame, "camera_0");
  EXPECT_EQ(image->width, 2U);
  EXPECT_EQ(image->height, 3U);
  EXPECT_EQ(image->step, 7U);
  EXPECT_FALSE(image->big_endian);
  EXPECT_EQ(std::string(image->data.begin(), image->data.end()), "0123456789");
}

TEST_P(Dialects, HaveCompressedImages) {
  const std::string bytes =
      CompressedImageMessage(GetParam(), {kStamp, "jpeg", 0, 0, 0, "abc", "camera_0"});
  const auto image = ParseImage(Form(MessageKind::kCompressedImage), BytesOf(bytes));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->stamp_ns, kStamp);
  EXPECT_TRUE(image->compressed);
  EXPECT_EQ(image->encoding, "jpeg");
  EXPECT_EQ(image->frame, "camera_0");
  EXPECT_EQ(std::string(image->data.begin(), image->data.end()), "abc");
}

TEST_P(Dialects, HaveCalibrations) {
  TestCamera camera;
  camera.d = {0.1, -0.2, 0.3, 0.4, 0.5};
  camera.p[3] = -0.25;
  camera.r[5] = 0.125;
  const std::string bytes = CalibrationMessageOf(GetParam(), camera);
  const auto message = ParseCalibration(Form(MessageKind::kCalibration), BytesOf(bytes));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->width, 8U);
  EXPECT_EQ(message->height, 6U);
  EXPECT_EQ(message->distortion_model, "plumb_bob");
  EXPECT_EQ(message->d, camera.d);
  EXPECT_EQ(message->k, camera.k);
  EXPECT_EQ(message->r, camera.r);
  EXPECT_EQ(message->p, camera.p);
  EXPECT_EQ(message->binning_x, 0U);
}

// No message is taken for a whole one whose end is missing; in protobuf, where every field may be
// missing, one that ends within a field.
TEST_P(Dialects, NoticeMessagesThatEndEarly) {
  const bool protobuf = GetParam() == Dialect::kProtobuf;
  const std::string image =
      RawImageMessage(GetParam(), {kStamp, "mono8", 4, 4, 4, "0123456789abcdef"});
  int refused = 0;
  for (std::size_t size = 0; size < image.size(); ++size) {
    const auto parsed = ParseImage(Form(MessageKind::kImage), BytesOf(image.substr(0, size)));
    refused += parsed ? 0 : 1;
    EXPECT_TRUE(protobuf || !parsed) << size;
  }
  EXPECT_GT(refused, static_cast<int>(image.size()) / 2);
  const std::string camera = CalibrationMessageOf(GetParam(), {});
  EXPECT_FALSE(ParseCalibration(Form(MessageKind::kCalibration),
                                BytesOf(camera.substr(0, camera.size() - 3))));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    Dialects,
    testing::Values(Dialect::kRos1, Dialect::kCdr, Dialect::kBigEndianCdr, Dialect::kProtobuf));

TEST(ParseRosClock, ReadsTheTime) {
  for (const Dialect dialect : {Dialect::kRos1, Dialect::kCdr, Dialect::kBigEndianCdr}) {
    RosFields fields(dialect);
    fields.Time(1'403'636'579'763'555'584);
    const std::string bytes = fields.Take();
    const bool cdr = dialect != Dialect::kRos1;
    EXPECT_EQ(ParseRosClock(cdr, BytesOf(bytes)), 1'403'636'579'763'555'584);
    EXPECT_EQ(ParseRosClock(cdr, BytesOf(bytes.substr(0, bytes.size() - 1))), std::nullopt);
  }
}

TEST(FormOf, KnowsTypesByTheirEncoding) {
  const auto kind = [](const char* type, const char* encoding) {
    const auto form = FormOf({"/topic", type, encoding});
    return form ? std::optional(form->kind) : std::nullopt;
  };
  EXPECT_EQ(kind("sensor_msgs/Image", "ros1"), MessageKind::kImage);
  EXPECT_EQ(kind("sensor_msgs/msg/CompressedImage", "cdr"), MessageKind::kCompressedImage);
  EXPECT_EQ(kind("foxglove.CameraCalibration", "protobuf"), MessageKind::kCalibration);
  EXPECT_EQ(kind("sensor_msgs/msg/Image", "ros1"), std::nullopt);
  EXPECT_EQ(kind("sensor_msgs/Imu", "ros1"), MessageKind::kInertial);
  EXPECT_EQ(kind("sensor_msgs/msg/Imu", "cdr"), MessageKind::kInertial);
  EXPECT_EQ(kind("sensor_msgs/MagneticField", "ros1"), std::nullopt);
  EXPECT_EQ(kind("foxglove.RawImage", "json"), std::nullopt);
}

TEST(ParseImage, RefusesOtherEncodingsOfCdr) {
  std::string bytes = RawImageMessage(Dialect::kCdr, {5, "mono8", 1, 1, 1, "x"});
  bytes[1] = 3;  // PL_CDR_LE
  EXPECT_FALSE(ParseImage({MessageKind::kImage, MessageEncoding::kCdr}, BytesOf(bytes)));
}

TEST(ParseImage, SkipsFieldsOfLaterSchemas) {
  ProtobufFields fields;
  fields.Number(900, 1U << 31);
  fields.Fixed64(40, 3);
  fields.Bytes(41, "later");
  const std::string bytes =
      fields.Take() + RawImageMessage(Dialect::kProtobuf, {9, "mono8", 1, 1, 1, "x"});
  const auto image = ParseImage({MessageKind::kImage, MessageEncoding::kProtobuf}, BytesOf(bytes));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->stamp_ns, 9);
  EXPECT_EQ(image->width, 1U);
}

TEST(ParseCalibration, RefusesMatricesOfAnotherSize) {
  ProtobufFields fields;
  fields.Bytes(6, std::string(8 * 8, '\0'));  // K of eight numbers
  EXPECT_FALSE(ParseCalibration({MessageKind::kCalibration, MessageEncoding::kProtobuf},
                                BytesOf(fields.Take())));
}

}  // namespace image_message_test
}  // namespace plumbline
