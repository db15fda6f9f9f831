// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_format.h"
#include "plumbline/features/feature_correction.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Transfer (base/byte_format.h) of motions, cameras, features and what is known of their
// correction.

template <class Archive, class Scalar, int kRows, int kColumns>
void Transfer(Archive& archive, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) archive(matrix.data()[i]);
}
template <class Archive, class Scalar, int kRows, int kColumns>
requires(!Archive::kReading) void Transfer(Archive& archive,
                                           const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) archive(matrix.data()[i]);
}

template <class Archive, Like<Eigen::Quaterniond> T>
void Transfer(Archive& archive, T& q) {
  Transfer(archive, q.coeffs());
}
template <class Archive, Like<Rigid3> T>
void Transfer(Archive& archive, T& motion) {
  TransferAll(archive, motion.rotation, motion.translation);
}
template <class Archive, Like<RectifiedCamera> T>
void Transfer(Archive& archive, T& c) {
  TransferAll(archive, c.fx, c.fy, c.cx, c.cy, c.baseline, c.width, c.height);
}

template <class Archive, Like<StereoCorrection> T>
void Transfer(Archive& archive, T& correction) {
  StereoCorrection::VisitNumbers(correction, [&](auto& number) { Transfer(archive, number); });
}

template <class Archive, Like<StereoEvidence> T>
void Transfer(Archive& archive, T& evidence) {
  TransferAll(archive, evidence.information, evidence.weighted, evidence.moments);
}

// Transfers the descriptors of a list, one after the other. `get` returns the descriptor of an
// item.
template <class Archive, class Items, class Get>
void TransferDescriptors(Archive& archive, Items& items, const Get& get) {
  for (auto& item : items) Transfer(archive, get(item));
}

// Transfers the presence of each value of an OptionalList; returns pointers to the present ones.
template <class Archive, class List>
auto TransferPresence(Archive& archive, List& list) {
  std::vector<std::uint8_t> present(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) present[i] = list[i] ? 1 : 0;
  TransferColumn(
      archive, present, [](auto& flag) -> auto& { return flag; });
  if constexpr (Archive::kReading) {
    using Item = typename decltype(list.values())::value_type;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (present[i] != 0) list.Set(i, Item());
    }
  }
  std::vector<decltype(list.Find(0))> there;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i]) there.push_back(list.Find(i));
  }
  return there;
}

template <class Archive, class Items, class Get>
void TransferSegments(Archive& archive, Items& items, const Get& get) {
  TransferColumn(
      archive, items, [&](auto& i) -> auto& { return get(i).start.x(); });
  TransferColumn(
      archive, items, [&](auto& i) -> auto& { return get(i).start.y(); });
  TransferColumn(
      archive, items, [&](auto& i) -> auto& { return get(i).end.x(); });
  TransferColumn(
      archive, items, [&](auto& i) -> auto& { return get(i).end.y(); });
}

// Transfers a column of numbers that are floats or unsigned in memory and doubles in the archive.
// Numbers that are read become the nearest ones that fit.
template <class Archive, class Items, class Get>
void TransferAsDoubles(Archive& archive, Items& items, const Get& get) {
  std::vector<double> column;
  column.reserve(items.size());
  for (const auto& item : items) column.push_back(static_cast<double>(get(item)));
  TransferColumn(
      archive, column, [](auto& value) -> auto& { return value; });
  if constexpr (Archive::kReading) {
    using Number = std::remove_cvref_t<decltype(get(items.front()))>;
    constexpr double kMost = std::numeric_limits<Number>::max();
    for (std::size_t i = 0; i < items.size(); ++i) {
      double value = column[i];
      if (std::is_integral_v<Number>) value = value > 0 ? std::min(std::round(value), kMost) : 0;
      get(items[i]) = static_cast<Number>(value);
    }
  }
}

template <class Archive, class Points>
void TransferPointFeatures(Archive& archive, Points& points) {
  constexpr std::size_t kLeastBytes = 53;
  const std::size_t count = TransferCount(archive, points.size(), kLeastBytes);
  if constexpr (Archive::kReading) points.resize(count);
  TransferColumn(
      archive, points, [](auto& p) -> auto& { return p.px.x(); });
  TransferColumn(
      archive, points, [](auto& p) -> auto& { return p.px.y(); });
  TransferColumn(
      archive, points, [](auto& p) -> auto& { return p.sigma_px; });
  TransferAsDoubles(
      archive, points, [](auto& p) -> auto& { return p.angle; });
  TransferAsDoubles(
      archive, points, [](auto& p) -> auto& { return p.response; });
  TransferColumn(
      archive, points, [](auto& p) -> auto& { return p.octave; });
  TransferDescriptors(
      archive, points, [](auto& p) -> auto& { return p.descriptor; });
}

template <class Archive, class Lines>
void TransferLineFeatures(Archive& archive, Lines& lines) {
  constexpr std::size_t kLeastBytes = 57;
  const std::size_t count = TransferCount(archive, lines.size(), kLeastBytes);
  if constexpr (Archive::kReading) lines.resize(count);
  TransferSegments(
      archive, lines, [](auto& l) -> auto& { return l.segment; });
  TransferColumn(
      archive, lines, [](auto& l) -> auto& { return l.sigma_px; });
  TransferColumn(
      archive, lines, [](auto& l) -> auto& { return l.response; });
  TransferColumn(
      archive, lines, [](auto& l) -> auto& { return l.octave; });
  TransferDescriptors(
      archive, lines, [](auto& l) -> auto& { return l.descriptor; });
}

// Transfers features column by column (TransferColumn): numbers of single precision take four
// bytes.
template <class Archive, Like<Features> T>
void Transfer(Archive& archive, T& features) {
  TransferPointFeatures(archive, features.points);
  TransferLineFeatures(archive, features.lines);
  if constexpr (Archive::kReading) {
    features.point_disparity.resize(features.points.size());
    features.line_right.resize(features.lines.size());
  }
  PLUMBLINE_CHECK(features.point_disparity.size() == features.points.size() &&
                      features.line_right.size() == features.lines.size(),
                  "features of unequal counts");
  const auto disparities = TransferPresence(archive, features.point_disparity);
  TransferColumn(
      archive, disparities, [](auto* d) -> auto& { return d->px; });
  TransferColumn(
      archive, disparities, [](auto* d) -> auto& { return d->sigma_px; });
  const auto right = TransferPresence(archive, features.line_right);
  TransferSegments(
      archive, right, [](auto* r) -> auto& { return r->segment; });
  TransferColumn(
      archive, right, [](auto* r) -> auto& { return r->sigma_px; });
}

}  // namespace plumbline
