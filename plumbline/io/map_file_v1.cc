// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file_v1.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/features/single_precision.h"
#include "plumbline/map/map_builder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::uint64_t kLargestMap = std::uint64_t{1} << 36;  // bytes

constexpr std::size_t kBodyBegin = 24;  // bytes before it: magic, version, CRC-32, size of the body

struct StoredKeyFrame {
  KeyFrameId id;
  KeyFrameId parent;
  FrameId frame;
  std::int64_t stamp_ns = 0;
  Rigid3 cam_from_world;
  Features features;
};

struct StoredMap {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  MapId id;
  std::vector<StoredKeyFrame> keyframes;
  std::vector<MapPoint> points;
  std::vector<MapLine> lines;
};

// Has a Read for each type. They are members of a class, so that each sees all others.
struct Format {
  template <class T>
  requires(std::is_integral_v<T> || std::is_same_v<T, double>) static void Read(ByteReader& r,
                                                                                T& value) {
    r(value);
  }

  template <class Tag>
  static void Read(ByteReader& r, Id<Tag>& id) {
    r(id.value);
  }

  template <class Scalar, int kRows, int kColumns>
  static void Read(ByteReader& r, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) r(matrix.data()[i]);
  }

  static void Read(ByteReader& r, Eigen::Quaterniond& q) { Read(r, q.coeffs()); }

  template <class T, std::size_t kSize>
  static void Read(ByteReader& r, std::array<T, kSize>& items) {
    for (T& item : items) Read(r, item);
  }

  // Reads the number of items. Every item takes a byte or more and is made when it is read, so that
  // a damaged count cannot ask for more memory than what the file holds.
  static std::size_t ReadCount(ByteReader& r) {
    std::uint32_t count = 0;
    r(count);
    if (count > r.remaining()) throw InputError(r.source() + ": ends early");
    return count;
  }

  template <class T>
  static void Read(ByteReader& r, std::vector<T>& items) {
    const std::size_t count = ReadCount(r);
    for (std::size_t i = 0; i < count; ++i) Read(r, items.emplace_back());
  }

  template <class T>
  static void Read(ByteReader& r, std::optional<T>& item) {
    std::uint8_t present = 0;
    r(present);
    if (present != 0) Read(r, item.emplace());
  }

  static void Read(ByteReader& r, Observations& observations) {
    const std::size_t count = ReadCount(r);
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t keyframe = 0;
      std::int32_t feature = 0;
      ReadAll(r, keyframe, feature);
      observations.emplace(KeyFrameId{keyframe}, feature);
    }
  }

  template <class... Fields>
  static void ReadAll(ByteReader& r, Fields&... fields) {
    (Read(r, fields), ...);
  }

  static void Read(ByteReader& r, Rigid3& motion) {
    ReadAll(r, motion.rotation, motion.translation);
  }
  static void Read(ByteReader& r, RectifiedCamera& c) {
    ReadAll(r, c.fx, c.fy, c.cx, c.cy, c.baseline, c.width, c.height);
  }
  static void Read(ByteReader& r, Disparity& d) { ReadAll(r, d.px, d.sigma_px); }
  static void Read(ByteReader& r, Segment2& s) { ReadAll(r, s.start, s.end); }
  static void Read(ByteReader& r, PointFeature& f) {
    ReadAll(r, f.px, f.sigma_px, f.angle, f.response, f.octave, f.descriptor);
  }
  static void Read(ByteReader& r, LineFeature& f) {
    ReadAll(r, f.segment, f.sigma_px, f.response, f.octave, f.descriptor);
  }
  static void Read(ByteReader& r, RightLine& f) { ReadAll(r, f.segment, f.sigma_px); }
  static void Read(ByteReader& r, Features& f) {
    ReadAll(r, f.points, f.point_disparity, f.lines, f.line_right);
  }
  static void Read(ByteReader& r, TrackingScore& s) { ReadAll(r, s.visible, s.found); }
  static void Read(ByteReader& r, MapPoint& p) {
    ReadAll(r, p.id, p.created_by, p.position, p.view_direction, p.reference_distance);
    ReadAll(r, p.reference_octave, p.descriptor, p.score, p.observations);
  }
  static void Read(ByteReader& r, MapLine& l) {
    ReadAll(r, l.id, l.created_by, l.line.moment, l.line.direction, l.start, l.end);
    ReadAll(r, l.information, l.view_direction, l.descriptor, l.score, l.observations);
  }
  static void Read(ByteReader& r, StoredKeyFrame& k) {
    ReadAll(r, k.id, k.parent, k.frame, k.stamp_ns, k.cam_from_world, k.features);
  }
  static void Read(ByteReader& r, StoredMap& m) {
    ReadAll(r, m.camera, m.rectified_from_left, m.id, m.keyframes, m.points, m.lines);
  }
};

StoredMap ReadStored(const std::filesystem::path& path) {
  const std::string file = ReadInputFile(path, kLargestMap);
  const std::string source = path.string();
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()),
                                            file.size());
  ByteReader header(bytes, source);
  std::uint64_t magic = 0;
  std::uint32_t version = 0, crc = 0;
  std::uint64_t size = 0;
  Format::ReadAll(header, magic, version, crc, size);
  const std::span<const std::uint8_t> body = bytes.subspan(kBodyBegin);
  if (body.size() != size) {
    throw InputError(
        fmt::format("{}: expected {} bytes after the header, found {}", source, size, body.size()));
  }
  if (Crc32(body) != crc) throw InputError(source + ": damaged (wrong checksum)");
  StoredMap stored;
  ByteReader reader(body, source);
  Format::Read(reader, stored);
  if (reader.remaining() != 0) throw InputError(source + ": expected the end, found more bytes");
  return stored;
}

// Returns a record of what version 1 does not keep, for a map that took in these keyframes and no
// others.
MapRecord RecordOf(const StoredMap& stored) {
  MapRecord record;
  record.id = stored.id;
  record.version = 1;
  record.keyframes_taken_in = static_cast<std::int64_t>(stored.keyframes.size());
  const auto after_last = [](const auto& items) {
    const auto last = items.empty() ? std::int64_t{-1} : items.back().id.value;
    return std::clamp(last, std::int64_t{-1}, kMaxBuiltId) + 1;
  };
  record.next_keyframe.value = after_last(stored.keyframes);
  record.next_point.value = after_last(stored.points);
  record.next_line.value = after_last(stored.lines);
  return record;
}

// Moves a keyframe out of `stored`. If its parent is missing, the keyframe before it takes its
// place.
KeyFrame Take(StoredKeyFrame& stored, const RectifiedCamera& camera, const Map& before) {
  KeyFrame keyframe;
  keyframe.id = stored.id;
  keyframe.parent = stored.parent;
  const auto& others = before.keyframes();
  keyframe.number = static_cast<std::int64_t>(others.size());
  if (stored.parent.valid() && before.Find(stored.parent) == nullptr) {
    keyframe.parent = others.empty() ? KeyFrameId{} : others.rbegin()->first;
  }
  keyframe.frame.id = stored.frame;
  keyframe.frame.stamp_ns = stored.stamp_ns;
  keyframe.frame.cam_from_world = stored.cam_from_world;
  RoundToSinglePrecision(stored.features);
  keyframe.frame.indexed = IndexFeatures(camera, std::exchange(stored.features, {}));
  return keyframe;
}

}  // namespace

SavedAtlas LoadMapFileV1(const std::filesystem::path& path,
                         const std::function<void(const AtlasContext&)>& check) {
  StoredMap stored = ReadStored(path);
  SavedAtlas saved;
  saved.file_version = 1;
  saved.context.camera = stored.camera;
  saved.context.rectified_from_left = stored.rectified_from_left;
  saved.context.sessions.resize(1);
  check(saved.context);
  MapBuilder builder(RecordOf(stored), path.string());
  for (StoredKeyFrame& k : stored.keyframes) builder.Add(Take(k, stored.camera, builder.map()));
  for (MapPoint& point : stored.points) builder.Add(std::move(point));
  for (MapLine& line : stored.lines) builder.Add(std::move(line));
  saved.atlas.Adopt(builder.Finish());
  saved.atlas.Activate(stored.id);
  saved.context.maps[stored.id];
  return saved;
}

}  // namespace plumbline
