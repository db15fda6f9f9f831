// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/schemas.h"

#include "plumbline/viewer/messages.h"

#include <array>
#include <cstdint>
#include <vector>

namespace plumbline {
namespace {

// Types of fields, by their numbers in google.protobuf.FieldDescriptorProto.
enum FieldType : std::uint8_t {
  kDouble = 1,
  kFloat = 2,
  kUint64 = 4,
  kInt64 = 3,
  kInt32 = 5,
  kFixed32 = 7,
  kBool = 8,
  kString = 9,
  kMessage = 11,
  kBytes = 12,
  kUint32 = 13,
  kEnum = 14,
  kSfixed32 = 15
};
enum Label : std::uint8_t { kOne = 1, kMany = 3 };

struct FieldRow {
  std::string_view name;
  std::uint32_t number;
  FieldType type;
  // Type name of a message or an enumeration: ".foxglove.Pose".
  std::string_view type_name = {};
  Label label = kOne;
};
struct EnumRow {
  std::string_view name;
  std::vector<std::string_view> values;  // names of the values from 0 on
};
struct MessageRow {
  std::string_view name;
  std::vector<FieldRow> fields;
  std::vector<EnumRow> enums = {};
};
struct FileRow {
  std::string_view name, package;
  std::vector<std::string_view> dependencies;
  std::vector<MessageRow> messages;
};

constexpr std::string_view kTimestamp = ".google.protobuf.Timestamp";

FileRow TimestampFile() {
  return {"google/protobuf/timestamp.proto",
          "google.protobuf",
          {},
          {{"Timestamp", {{"seconds", 1, kInt64}, {"nanos", 2, kInt32}}}}};
}

std::vector<MessageRow> GeometryMessages() {
  return {
      {"Point2", {{"x", 1, kDouble}, {"y", 2, kDouble}}},
      {"Point3", {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}}},
      {"Vector3", {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}}},
      {"Quaternion", {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}, {"w", 4, kDouble}}},
      {"Pose",
       {{"position", 1, kMessage, ".foxglove.Vector3"},
        {"orientation", 2, kMessage, ".foxglove.Quaternion"}}},
      {"Color", {{"r", 1, kDouble}, {"g", 2, kDouble}, {"b", 3, kDouble}, {"a", 4, kDouble}}},
  };
}

std::vector<MessageRow> CameraMessages() {
  return {
      {"CompressedImage",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 4, kString},
        {"data", 2, kBytes},
        {"format", 3, kString}}},
      {"CameraCalibration",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 9, kString},
        {"width", 2, kFixed32},
        {"height", 3, kFixed32},
        {"distortion_model", 4, kString},
        {"D", 5, kDouble, {}, kMany},
        {"K", 6, kDouble, {}, kMany},
        {"R", 7, kDouble, {}, kMany},
        {"P", 8, kDouble, {}, kMany}}},
      {"PointsAnnotation",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"type", 2, kEnum, ".foxglove.PointsAnnotation.Type"},
        {"points", 3, kMessage, ".foxglove.Point2", kMany},
        {"outline_color", 4, kMessage, ".foxglove.Color"},
        {"thickness", 7, kDouble}},
       {{"Type", {"UNKNOWN", "POINTS", "LINE_LOOP", "LINE_STRIP", "LINE_LIST"}}}},
      {"ImageAnnotations", {{"points", 2, kMessage, ".foxglove.PointsAnnotation", kMany}}},
  };
}

std::vector<MessageRow> WorldMessages() {
  return {
      {"PoseInFrame",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 2, kString},
        {"pose", 3, kMessage, ".foxglove.Pose"}}},
      {"FrameTransform",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"parent_frame_id", 2, kString},
        {"child_frame_id", 3, kString},
        {"translation", 4, kMessage, ".foxglove.Vector3"},
        {"rotation", 5, kMessage, ".foxglove.Quaternion"}}},
      {"PackedElementField",
       {{"name", 1, kString},
        {"offset", 2, kFixed32},
        {"type", 3, kEnum, ".foxglove.PackedElementField.NumericType"}},
       {{"NumericType",
         {"UNKNOWN",
          "UINT8",
          "INT8",
          "UINT16",
          "INT16",
          "UINT32",
          "INT32",
          "FLOAT32",
          "FLOAT64"}}}},
      {"PointCloud",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 2, kString},
        {"pose", 3, kMessage, ".foxglove.Pose"},
        {"point_stride", 4, kFixed32},
        {"fields", 5, kMessage, ".foxglove.PackedElementField", kMany},
        {"data", 6, kBytes}}},
      {"LinePrimitive",
       {{"type", 1, kEnum, ".foxglove.LinePrimitive.Type"},
        {"pose", 2, kMessage, ".foxglove.Pose"},
        {"thickness", 3, kDouble},
        {"scale_invariant", 4, kBool},
        {"points", 5, kMessage, ".foxglove.Point3", kMany},
        {"color", 6, kMessage, ".foxglove.Color"}},
       {{"Type", {"LINE_STRIP", "LINE_LOOP", "LINE_LIST"}}}},
      {"SceneEntityDeletion",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"type", 2, kEnum, ".foxglove.SceneEntityDeletion.Type"},
        {"id", 3, kString}},
       {{"Type", {"MATCHING_ID", "ALL"}}}},
      {"SceneEntity",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 2, kString},
        {"id", 3, kString},
        {"frame_locked", 5, kBool},
        {"lines", 11, kMessage, ".foxglove.LinePrimitive", kMany}}},
      {"SceneUpdate",
       {{"deletions", 1, kMessage, ".foxglove.SceneEntityDeletion", kMany},
        {"entities", 2, kMessage, ".foxglove.SceneEntity", kMany}}},
  };
}

// Returns the messages about the run, which the page needs beside the image; docs/viewer.md
// explains every field.
std::vector<MessageRow> RunMessages() {
  return {
      {"Stage", {{"name", 1, kString}, {"milliseconds", 2, kDouble}}},
      {"Frame",
       {{"number", 1, kUint32},
        {"status", 2, kString},
        {"reason", 3, kString},
        {"map", 4, kUint32},
        {"world_from_camera", 5, kMessage, ".foxglove.Pose"},
        {"keyframe", 6, kBool},
        {"inlier_points", 7, kUint32},
        {"inlier_lines", 8, kUint32},
        {"stages", 9, kMessage, ".plumbline.Stage", kMany},
        {"shed", 10, kString},
        {"point_px", 11, kFloat, {}, kMany},
        {"point_ids", 12, kSfixed32, {}, kMany},
        {"line_px", 13, kFloat, {}, kMany},
        {"line_ids", 14, kSfixed32, {}, kMany},
        {"image", 15, kBytes}}},
      {"Camera",
       {{"width", 1, kUint32},
        {"height", 2, kUint32},
        {"fx", 3, kDouble},
        {"fy", 4, kDouble},
        {"cx", 5, kDouble},
        {"cy", 6, kDouble},
        {"baseline", 7, kDouble}}},
      {"Run",
       {{"name", 1, kString},
        {"frames", 2, kUint32},
        {"frames_expected", 3, kUint32},
        {"dropped", 4, kUint32},
        {"lost", 5, kUint32},
        {"frames_per_second", 6, kDouble},
        {"paused", 7, kBool},
        {"can_pause", 8, kBool},
        {"finished", 9, kBool},
        {"camera", 10, kMessage, ".plumbline.Camera"},
        {"saved_map", 11, kBool}}},
      {"Event",
       {{"kind", 1, kString},
        {"frame", 2, kUint32},
        {"keyframe", 3, kUint32},
        {"older", 4, kUint32},
        {"points", 5, kUint32},
        {"lines", 6, kUint32},
        {"moved", 7, kDouble}}},
  };
}

// Returns the messages about changes of the map, and the message that carries all of them.
std::vector<MessageRow> MapMessages() {
  return {
      {"MapDelta",
       {{"map", 1, kUint32},
        {"from", 2, kUint64},
        {"to", 3, kUint64},
        {"point_ids", 4, kFixed32, {}, kMany},
        {"point_positions", 5, kFloat, {}, kMany},
        {"gone_points", 6, kFixed32, {}, kMany},
        {"line_ids", 7, kFixed32, {}, kMany},
        {"line_ends", 8, kFloat, {}, kMany},
        {"gone_lines", 9, kFixed32, {}, kMany},
        {"keyframe_ids", 10, kFixed32, {}, kMany},
        {"keyframe_frames", 11, kFixed32, {}, kMany},
        {"keyframe_poses", 12, kFloat, {}, kMany},
        {"gone_keyframes", 13, kFixed32, {}, kMany},
        {"edges", 14, kFixed32, {}, kMany},
        {"line_established", 15, kFixed32, {}, kMany}}},
      {"Update",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"run", 2, kMessage, ".plumbline.Run"},
        {"frame", 3, kMessage, ".plumbline.Frame"},
        {"map", 4, kMessage, ".plumbline.MapDelta"},
        {"events", 5, kMessage, ".plumbline.Event", kMany}}},
  };
}

std::vector<FileRow> Files() {
  std::vector<MessageRow> update = RunMessages();
  for (MessageRow& message : MapMessages()) update.push_back(std::move(message));
  std::vector<MessageRow> foxglove = GeometryMessages();
  for (const auto& part : {CameraMessages(), WorldMessages()}) {
    foxglove.insert(foxglove.end(), part.begin(), part.end());
  }
  const std::string_view timestamp = "google/protobuf/timestamp.proto";
  return {TimestampFile(),
          {"foxglove/messages.proto", "foxglove", {timestamp}, std::move(foxglove)},
          {"plumbline/update.proto",
           "plumbline",
           {timestamp, "foxglove/messages.proto"},
           std::move(update)}};
}

ProtobufWriter Describe(const FieldRow& row) {
  ProtobufWriter field;
  field.Bytes(1, row.name).Varint(3, row.number).Varint(4, row.label).Varint(5, row.type);
  if (!row.type_name.empty()) field.Bytes(6, row.type_name);
  return field;
}

ProtobufWriter Describe(const EnumRow& row) {
  ProtobufWriter description;
  description.Bytes(1, row.name);
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    description.Message(2, ProtobufWriter().Bytes(1, row.values[i]).Varint(2, i));
  }
  return description;
}

ProtobufWriter Describe(const MessageRow& row) {
  ProtobufWriter description;
  description.Bytes(1, row.name);
  for (const FieldRow& field : row.fields) description.Message(2, Describe(field));
  for (const EnumRow& values : row.enums) description.Message(4, Describe(values));
  return description;
}

std::string DescribeAll() {
  ProtobufWriter set;
  for (const FileRow& row : Files()) {
    ProtobufWriter file;
    file.Bytes(1, row.name).Bytes(2, row.package);
    for (const std::string_view dependency : row.dependencies) file.Bytes(3, dependency);
    for (const MessageRow& message : row.messages) file.Message(4, Describe(message));
    set.Message(1, file.Bytes(12, "proto3"));
  }
  return set.Take();
}

}  // namespace

std::span<const FoxgloveChannel> FoxgloveChannels() {
  static constexpr std::array<FoxgloveChannel, kStreams> kChannels = {{
      {"/camera/image", "foxglove.CompressedImage"},
      {"/camera/calibration", "foxglove.CameraCalibration"},
      {"/camera/annotations", "foxglove.ImageAnnotations"},
      {"/camera/pose", "foxglove.PoseInFrame"},
      {"/tf", "foxglove.FrameTransform"},
      {"/map/points", "foxglove.PointCloud"},
      {"/map/lines", "foxglove.SceneUpdate"},
      {"/plumbline/updates", "plumbline.Update"},
      {"/camera_right/image", "foxglove.CompressedImage"},
      {"/camera_right/calibration", "foxglove.CameraCalibration"},
  }};
  return kChannels;
}

const std::string& FoxgloveSchemas() {
  static const std::string schemas = DescribeAll();
  return schemas;
}

}  // namespace plumbline
