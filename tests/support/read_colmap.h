// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/export/colmap_model.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

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

// A camera model: its number in binary files, its name, and how many parameters it has.
struct Model {
  std::int32_t id;
  const char* name;
  std::size_t parameters;
};
constexpr Model kModels[] = {{1, "PINHOLE", 4},
                             {4, "OPENCV", 8},
                             {5, "OPENCV_FISHEYE", 8},
                             {6, "FULL_OPENCV", 12},
                             {7, "FOV", 5}};

template <class Is>
const Model& ModelThat(const Is& is) {
  for (const Model& model : kModels) {
    if (is(model)) return model;
  }
  Fail("another camera model");
}

// Pixel of a point in the frame of the camera.
inline Eigen::Vector2d Project(const ColmapModel::Camera& camera, const Eigen::Vector3d& p) {
  const std::vector<double>& k = camera.parameters;
  const double u = p.x() / p.z(), v = p.y() / p.z();
  const double r2 = u * u + v * v, r = std::sqrt(r2);
  double x = u, y = v;
  if (camera.model == "OPENCV" || camera.model == "FULL_OPENCV") {
    const bool full = camera.model == "FULL_OPENCV";
    const double above = 1 + k[4] * r2 + k[5] * r2 * r2 + (full ? k[8] * r2 * r2 * r2 : 0);
    const double below = full ? 1 + k[9] * r2 + k[10] * r2 * r2 + k[11] * r2 * r2 * r2 : 1;
    x = u * above / below + 2 * k[6] * u * v + k[7] * (r2 + 2 * u * u);
    y = v * above / below + 2 * k[7] * u * v + k[6] * (r2 + 2 * v * v);
  } else if (camera.model == "OPENCV_FISHEYE" && r > 0) {
    const double t = std::atan2(r, 1.0), t2 = t * t;
    const double bent =
        t * (1 + k[4] * t2 + k[5] * t2 * t2 + k[6] * t2 * t2 * t2 + k[7] * t2 * t2 * t2 * t2);
    x = u * bent / r;
    y = v * bent / r;
  } else if (camera.model == "FOV" && r > 0) {
    const double bent = std::atan(r * 2 * std::tan(k[4] / 2)) / k[4];
    x = u * bent / r;
    y = v * bent / r;
  }
  return {k[0] * x + k[2], k[1] * y + k[3]};
}

}  // namespace read_colmap_detail

inline ColmapModel ReadColmapText(const std::filesystem::path& folder) {
  using namespace read_colmap_detail;
  ColmapModel model;
  std::istringstream line;
  Lines cameras(folder / "cameras.txt");
  if (!cameras.Next(line)) Fail("no camera");
  ExpectCamera(Whole(line));
  model.camera.model = Word(line);
  const Model& known = ModelThat([&](const Model& m) { return m.name == model.camera.model; });
  model.camera.width = static_cast<int>(Whole(line));
  model.camera.height = static_cast<int>(Whole(line));
  for (std::size_t i = 0; i < known.parameters; ++i) model.camera.parameters.push_back(Real(line));
  if (!(line >> std::ws).eof()) Fail("more parameters than the model has");

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
  const auto id = cameras.Next<std::int32_t>();
  const Model& known = ModelThat([&](const Model& m) { return m.id == id; });
  model.camera.model = known.name;
  model.camera.width = static_cast<int>(cameras.Next<std::uint64_t>());
  model.camera.height = static_cast<int>(cameras.Next<std::uint64_t>());
  for (std::size_t i = 0; i < known.parameters; ++i) {
    model.camera.parameters.push_back(cameras.Next<double>());
  }
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
      const Eigen::Vector2d px = read_colmap_detail::Project(model.camera, p);
      sum += (px - image.keypoints.at(view.keypoint).px).norm();
    }
  }
  return sum / static_cast<double>(point.track.size());
}

}  // namespace plumbline
