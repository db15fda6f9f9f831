// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/io/scratch_folder.h"
#include "tests/support/bag_writer.h"
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

// Bags of small images, for tests of what is read of them.
namespace plumbline {

constexpr std::int64_t kSecond = 1'000'000'000;

inline TestImage Gray(std::int64_t stamp_ns, char value) {
  return {stamp_ns, "mono8", 8, 6, 8, std::string(48, value)};
}

inline void AddImage(BagWriter& bag, const std::string& topic, const TestImage& image) {
  bag.Add(topic, "sensor_msgs/Image", image.stamp_ns + 7, RawImageMessage(Dialect::kRos1, image));
}

inline void AddPacked(BagWriter& bag, const std::string& topic, const TestImage& image) {
  bag.Add(topic,
          "sensor_msgs/CompressedImage",
          image.stamp_ns + 7,
          CompressedImageMessage(Dialect::kRos1, image));
}

inline void AddCamera(BagWriter& bag, const std::string& topic, const TestCamera& camera) {
  bag.Add(topic, "sensor_msgs/CameraInfo", 1, CalibrationMessageOf(Dialect::kRos1, camera));
}

inline TestCamera RightCamera() {
  TestCamera camera;
  camera.p[3] = -0.5;  // 0.1 m
  return camera;
}

// Three stereo pairs, the third without its right image, calibrated.
inline BagWriter StereoBag() {
  BagWriter bag;
  AddCamera(bag, "/cam0/camera_info", {});
  AddCamera(bag, "/cam1/camera_info", RightCamera());
  for (const int i : {1, 2, 3}) {
    AddImage(bag, "/cam0/image_raw", Gray(i * kSecond, static_cast<char>(i)));
    if (i < 3)
      AddImage(bag, "/cam1/image_raw", Gray(i * kSecond + 1000, static_cast<char>(10 + i)));
  }
  return bag;
}

inline std::filesystem::path Write(const ScratchFolder& folder, BagWriter bag) {
  return folder.Write("x.bag", bag.Finish());
}

// Images of 16 bits whose levels go up to these.
inline BagWriter DeepBag(const std::vector<std::string>& topics, const std::vector<int>& levels) {
  BagWriter bag;
  for (const std::string& topic : topics) {
    std::int64_t stamp_ns = 0;
    for (const int level : levels) {
      TestImage image{stamp_ns += kSecond, "mono16", 8, 6, 18, ""};
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 8; ++k) {
          image.data += LittleEndian(static_cast<std::uint64_t>(k == 0 ? level : level / 2), 2);
        }
        image.data += "**";  // rows have a margin
      }
      AddImage(bag, topic, image);
    }
  }
  return bag;
}

inline std::string PairFile(const ScratchFolder& folder) {
  return folder
      .Write("pair.yaml",
             "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrectified: true\nbaseline: 0.1\n"
             "depth_factor: 1000\nright:\n  size: [8, 6]\n  intrinsics: [5, 5, 4, 3]\n")
      .string();
}

}  // namespace plumbline
