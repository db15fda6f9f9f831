// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/export/colmap_model.h"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace plumbline {

// Reads COLMAP's models by COLMAP's own description of its formats, without code of the writer.
// Throws std::runtime_error for anything unexpected.
namespace read_colmap_detail {

[[noreturn]] inline void Fail(const std::string& what) { throw std::runtime_error(what); }

// Returns the next number of a line of text, from the whole word.
inline std::string Word(std::istringstream& line) {
  std::string word;
  if (!(line >> word)) Fail("a line ends early: " + line.str());
  return word;
}
inline double Real(std::istringstream& line) { return std::stod(Word(line)); }
inline std::int64_t Whole(std::istringstream& line) { return std::stoll(Word(line)); }

// The lines without comments; in images.txt empty lines count.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& path) : file_(path) {
    if (!file_) Fail("cannot open " + path.string());
  }
  bool Next(std::istringstream& line) {
    std::string text;
    do {
      if (!std::getline(file_, text)) return false;
    } while (text.starts_with('#'));
    line = std::istringstream(text);
    return true;
  }

 private:
  std::ifstream file_;
};

class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    if (!file_) Fail("cannot open " + path.string());
  }
  template <class T>
  T Next() {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bits |= static_cast<std::uint64_t>(Byte()) << (8 * i);
    }
    if constexpr (std::is_same_v<T, double>) return std::bit_cast<double>(bits);
    if constexpr (!std::is_same_v<T, double>) return static_cast<T>(bits);
  }
  std::string Name() {
    std::string name;
    for (std::uint8_t c = Byte(); c != 0; c = Byte()) name += static_cast<char>(c);
    return name;
  }
  void ExpectEnd() {
    if (file_.get() != std::ifstream::traits_type::eof()) Fail("more bytes than expected");
  }

 private:
  std::uint8_t Byte() {
    const int byte = file_.get();
    if (byte == std::ifstream::traits_type::eof()) Fail("ends early");
    return static_cast<std::uint8_t>(byte);
  }

  std::ifstream file_;
};

template <class ReadReal>
Rigid3 ReadPose(const ReadReal& real) {
  Rigid3 pose;
  pose.rotation.w() = real();
  pose.rotation.x() = real();
  pose.rotation.y() = real();
  pose.rotation.z() = real();
  for (Eigen::Index i = 0; i < 3; ++i) pose.translation(i) = real();
  return pose;
}

inline void ExpectCamera(std::int64_t id) {
  if (id != ColmapModel::kCameraId) Fail("another camera");
}

}  // namespace read_colmap_detail

inline ColmapModel ReadColmapText(const std::filesystem::path& folder) {
  using namespace read_colmap_detail;
  ColmapModel model;
  std::istringstream line;
  Lines cameras(folder / "cameras.txt");
  if (!cameras.Next(line)) Fail("no camera");
  ExpectCamera(Whole(line));
  if (Word(line) != "PINHOLE") Fail("another camera model");
  model.camera.width = static_cast<int>(Whole(line));
  model.camera.height = static_cast<int>(Whole(line));
  model.camera.fx = Real(line);
  model.camera.fy = Real(line);
  model.camera.cx = Real(line);
  model.camera.cy = Real(line);

  Lines images(folder / "images.txt");
  while (images.Next(line)) {
    ColmapModel::Image image;
    image.id = static_cast<std::uint32_t>(Whole(line));
    image.cam_from_world = ReadPose([&] { return Real(line); });
    ExpectCamera(Whole(line));
    image.name = Word(line);
    if (!images.Next(line)) Fail("an image without its second line");
    while (!(line >> std::ws).eof()) {
      const double x = Real(line), y = Real(line);
      image.keypoints.push_back({{x, y}, Whole(line)});
    }
    model.images.push_back(image);
  }

  Lines points(folder / "points3D.txt");
  while (points.Next(line)) {
    ColmapModel::Point point;
    point.id = Whole(line);
    for (Eigen::Index i = 0; i < 3; ++i) point.position(i) = Real(line);
    for (std::uint8_t* channel : {&point.color.r, &point.color.g, &point.color.b}) {
      *channel = static_cast<std::uint8_t>(Whole(line));
    }
    point.error = Real(line);
    while (!(line >> std::ws).eof()) {
      const auto image = static_cast<std::uint32_t>(Whole(line));
      point.track.push_back({image, static_cast<std::uint32_t>(Whole(line))});
    }
    model.points.push_back(point);
  }
  return model;
}

inline ColmapModel ReadColmapBinary(const std::filesystem::path& folder) {
  using namespace read_colmap_detail;
  ColmapModel model;
  Bytes cameras(folder / "cameras.bin");
  if (cameras.Next<std::uint64_t>() != 1) Fail("a number of cameras");
  ExpectCamera(cameras.Next<std::uint32_t>());
  if (cameras.Next<std::int32_t>() != 1) Fail("another camera model than PINHOLE");
  model.camera.width = static_cast<int>(cameras.Next<std::uint64_t>());
  model.camera.height = static_cast<int>(cameras.Next<std::uint64_t>());
  model.camera.fx = cameras.Next<double>();
  model.camera.fy = cameras.Next<double>();
  model.camera.cx = cameras.Next<double>();
  model.camera.cy = cameras.Next<double>();
  cameras.ExpectEnd();

  Bytes images(folder / "images.bin");
  model.images.resize(images.Next<std::uint64_t>());
  for (ColmapModel::Image& image : model.images) {
    image.id = images.Next<std::uint32_t>();
    image.cam_from_world = ReadPose([&] { return images.Next<double>(); });
    ExpectCamera(images.Next<std::uint32_t>());
    image.name = images.Name();
    image.keypoints.resize(images.Next<std::uint64_t>());
    for (ColmapModel::Keypoint& keypoint : image.keypoints) {
      keypoint.px.x() = images.Next<double>();
      keypoint.px.y() = images.Next<double>();
      keypoint.point = static_cast<std::int64_t>(images.Next<std::uint64_t>());
    }
  }
  images.ExpectEnd();

  Bytes points(folder / "points3D.bin");
  model.points.resize(points.Next<std::uint64_t>());
  for (ColmapModel::Point& point : model.points) {
    point.id = static_cast<std::int64_t>(points.Next<std::uint64_t>());
    for (Eigen::Index i = 0; i < 3; ++i) point.position(i) = points.Next<double>();
    for (std::uint8_t* channel : {&point.color.r, &point.color.g, &point.color.b}) {
      *channel = points.Next<std::uint8_t>();
    }
    point.error = points.Next<double>();
    point.track.resize(points.Next<std::uint64_t>());
    for (ColmapModel::View& view : point.track) {
      view.image = points.Next<std::uint32_t>();
      view.keypoint = points.Next<std::uint32_t>();
    }
  }
  points.ExpectEnd();
  return model;
}

// Returns the mean distance in pixels between the observations of a point and its projections, by
// the model alone. Images are found by their ids.
inline double ReprojectionErrorOf(const ColmapModel& model, const ColmapModel::Point& point) {
  double sum = 0;
  for (const ColmapModel::View& view : point.track) {
    for (const ColmapModel::Image& image : model.images) {
      if (image.id != view.image) continue;
      const Eigen::Vector3d p =
          image.cam_from_world.rotation * point.position + image.cam_from_world.translation;
      const Eigen::Vector2d px(model.camera.fx * p.x() / p.z() + model.camera.cx,
                               model.camera.fy * p.y() / p.z() + model.camera.cy);
      sum += (px - image.keypoints.at(view.keypoint).px).norm();
    }
  }
  return sum / static_cast<double>(point.track.size());
}

}  // namespace plumbline
