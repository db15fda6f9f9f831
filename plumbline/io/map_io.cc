// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_io.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/byte_stream.h"
#include "plumbline/io/crc32.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::string_view kMagic = "PLBMAP\r\n";  // line ends show a transfer as text
constexpr std::uint32_t kVersion = 1;
constexpr std::int64_t kMaxId = std::int64_t{1} << 26;  // a map has an index of all of its ids
constexpr std::size_t kHeaderBytes = 8 + 4 + 4 + 8;     // magic, version, CRC-32, size of the body

// A keyframe as stored; its matches follow from the observations of the landmarks.
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

// The format: one Transfer for each type, for both directions; members of a class, so that each
// sees all others. Changing any of them needs a new kVersion.
struct Format {
  template <class Archive, class T>
  requires(std::is_integral_v<T> ||
           std::is_same_v<T, double>) static void Transfer(Archive& archive, T& value) {
    archive(value);
    if constexpr (Archive::kReading && std::is_same_v<T, double>) {
      if (!std::isfinite(value)) {
        throw InputError(archive.source() + ": expected finite numbers, found another");
      }
    }
  }

  template <class Archive, class Tag>
  static void Transfer(Archive& archive, Id<Tag>& id) {
    archive(id.value);
  }

  template <class Archive, class Scalar, int kRows, int kColumns>
  static void Transfer(Archive& archive, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) Transfer(archive, matrix.data()[i]);
  }

  template <class Archive>
  static void Transfer(Archive& archive, Eigen::Quaterniond& q) {
    Transfer(archive, q.coeffs());
  }

  template <class Archive, class T, std::size_t kSize>
  static void Transfer(Archive& archive, std::array<T, kSize>& items) {
    for (T& item : items) Transfer(archive, item);
  }

  // Every item takes a byte or more. Items are made one by one as they are read: a damaged count
  // cannot ask for more memory than what the file holds.
  template <class Archive>
  static std::size_t TransferCount(Archive& archive, std::size_t count) {
    auto stored = static_cast<std::uint32_t>(count);
    archive(stored);
    if constexpr (Archive::kReading) {
      if (stored > archive.remaining()) throw InputError(archive.source() + ": ends early");
    }
    return stored;
  }

  template <class Archive, class T>
  static void Transfer(Archive& archive, std::vector<T>& items) {
    const std::size_t count = TransferCount(archive, items.size());
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (Archive::kReading) items.emplace_back();
      Transfer(archive, items[i]);
    }
  }

  template <class Archive, class T>
  static void Transfer(Archive& archive, std::optional<T>& item) {
    std::uint8_t present = item ? 1 : 0;
    archive(present);
    if constexpr (Archive::kReading) {
      if (present != 0) item.emplace();
    }
    if (item) Transfer(archive, *item);
  }

  template <class Archive>
  static void Transfer(Archive& archive, Observations& observations) {
    const std::size_t count = TransferCount(archive, observations.size());
    auto next = observations.begin();
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t keyframe = 0;
      std::int32_t feature = 0;
      if constexpr (!Archive::kReading) {
        keyframe = next->first.value;
        feature = next->second;
        ++next;
      }
      archive(keyframe);
      archive(feature);
      if constexpr (Archive::kReading) observations.emplace(KeyFrameId{keyframe}, feature);
    }
  }

  template <class Archive, class... Fields>
  static void TransferAll(Archive& archive, Fields&... fields) {
    (Transfer(archive, fields), ...);
  }

  template <class Archive>
  static void Transfer(Archive& a, Rigid3& motion) {
    TransferAll(a, motion.rotation, motion.translation);
  }
  template <class Archive>
  static void Transfer(Archive& a, RectifiedCamera& c) {
    TransferAll(a, c.fx, c.fy, c.cx, c.cy, c.baseline, c.width, c.height);
  }
  template <class Archive>
  static void Transfer(Archive& a, Disparity& d) {
    TransferAll(a, d.px, d.sigma_px);
  }
  template <class Archive>
  static void Transfer(Archive& a, Segment2& s) {
    TransferAll(a, s.start, s.end);
  }
  template <class Archive>
  static void Transfer(Archive& a, PointFeature& f) {
    TransferAll(a, f.px, f.sigma_px, f.angle, f.response, f.octave, f.descriptor);
  }
  template <class Archive>
  static void Transfer(Archive& a, LineFeature& f) {
    TransferAll(a, f.segment, f.sigma_px, f.response, f.octave, f.descriptor);
  }
  template <class Archive>
  static void Transfer(Archive& a, RightLine& f) {
    TransferAll(a, f.segment, f.sigma_px);
  }
  template <class Archive>
  static void Transfer(Archive& a, Features& f) {
    TransferAll(a, f.points, f.point_disparity, f.lines, f.line_right);
  }
  template <class Archive>
  static void Transfer(Archive& a, TrackingScore& s) {
    TransferAll(a, s.visible, s.found);
  }
  template <class Archive>
  static void Transfer(Archive& a, MapPoint& p) {
    TransferAll(a, p.id, p.created_by, p.position, p.view_direction, p.reference_distance);
    TransferAll(a, p.reference_octave, p.descriptor, p.score, p.observations);
  }
  template <class Archive>
  static void Transfer(Archive& a, MapLine& l) {
    TransferAll(a, l.id, l.created_by, l.line.moment, l.line.direction, l.start, l.end);
    TransferAll(a, l.information, l.view_direction, l.descriptor, l.score, l.observations);
  }

  template <class Archive>
  static void Transfer(Archive& a, StoredKeyFrame& k) {
    TransferAll(a, k.id, k.parent, k.frame, k.stamp_ns, k.cam_from_world, k.features);
  }

  template <class Archive>
  static void Transfer(Archive& a, StoredMap& m) {
    TransferAll(a, m.camera, m.rectified_from_left, m.id, m.keyframes, m.points, m.lines);
  }
};

// The parent where it is in the map, else the newest keyframe before `keyframe`.
KeyFrameId LivingParent(const Map& map, const KeyFrame& keyframe) {
  if (!keyframe.parent.valid() || map.Find(keyframe.parent) != nullptr) return keyframe.parent;
  const auto it = map.keyframes().find(keyframe.id);
  return it == map.keyframes().begin() ? KeyFrameId{} : std::prev(it)->first;
}

[[noreturn]] void FailMap(const std::string& source, const std::string& what) {
  throw InputError(source + ": expected a map that agrees with itself, found " + what);
}

void CheckKeyFrames(const StoredMap& stored, const std::string& source) {
  KeyFrameId previous;
  for (const StoredKeyFrame& k : stored.keyframes) {
    const Features& f = k.features;
    if (!(previous < k.id) || !(k.parent < k.id)) FailMap(source, "keyframes out of order");
    if (f.points.size() != f.point_disparity.size() || f.lines.size() != f.line_right.size()) {
      FailMap(source, "features of unequal counts");
    }
    if (!k.cam_from_world.translation.allFinite() ||
        !(std::abs(k.cam_from_world.rotation.norm() - 1) < 1e-6)) {
      FailMap(source, "a keyframe without a valid pose");
    }
    const bool placed = std::all_of(
        f.points.begin(), f.points.end(), [](const PointFeature& p) { return p.px.allFinite(); });
    if (!placed) FailMap(source, "a feature without a position");
    previous = k.id;
  }
  if (previous.value >= kMaxId) FailMap(source, "an id out of range");
}

// Ids ascend, every landmark has observations, and they name features that exist, each once.
template <class Landmark, class FeatureCount>
void CheckLandmarks(const std::vector<Landmark>& landmarks,
                    const StoredMap& stored,
                    const FeatureCount& feature_count,
                    const std::string& source) {
  std::set<std::pair<KeyFrameId, int>> taken;
  decltype(Landmark::id) previous;
  for (const Landmark& landmark : landmarks) {
    if (!(previous < landmark.id)) FailMap(source, "landmarks out of order");
    if (landmark.observations.empty()) FailMap(source, "a landmark without observations");
    for (const auto& [keyframe, feature] : landmark.observations) {
      const auto found =
          std::lower_bound(stored.keyframes.begin(),
                           stored.keyframes.end(),
                           keyframe,
                           [](const StoredKeyFrame& k, KeyFrameId id) { return k.id < id; });
      if (found == stored.keyframes.end() || found->id != keyframe || feature < 0 ||
          static_cast<std::size_t>(feature) >= feature_count(found->features) ||
          !taken.emplace(keyframe, feature).second) {
        FailMap(source, "an observation of a feature that is not there or taken");
      }
    }
    previous = landmark.id;
  }
  if (previous.value >= kMaxId) FailMap(source, "an id out of range");
}

void Check(const StoredMap& stored, const std::string& source) {
  const RectifiedCamera& c = stored.camera;
  constexpr std::int64_t kMaxPixels = 100'000'000;  // the grid of each keyframe takes 1 MB then
  if (!(c.fx > 0) || !(c.fy > 0) || c.width <= 0 || c.height <= 0 ||
      std::int64_t{c.width} * c.height > kMaxPixels) {
    FailMap(source, "no valid camera");
  }
  CheckKeyFrames(stored, source);
  const auto points = [](const Features& features) { return features.points.size(); };
  const auto lines = [](const Features& features) { return features.lines.size(); };
  CheckLandmarks(stored.points, stored, points, source);
  CheckLandmarks(stored.lines, stored, lines, source);
}

Map BuildMap(StoredMap stored) {
  MapEdit edit;
  for (StoredKeyFrame& k : stored.keyframes) {
    std::vector<Eigen::Vector2d> positions;
    for (const PointFeature& point : k.features.points) positions.push_back(point.px);
    PointGrid grid(positions, stored.camera.width, stored.camera.height);
    KeyFrame keyframe{k.id, k.parent, {}};
    keyframe.frame.id = k.frame;
    keyframe.frame.stamp_ns = k.stamp_ns;
    keyframe.frame.cam_from_world = k.cam_from_world;
    keyframe.frame.points.resize(k.features.points.size());
    keyframe.frame.lines.resize(k.features.lines.size());
    keyframe.frame.indexed = std::make_shared<const IndexedFeatures>(
        IndexedFeatures{std::move(k.features), std::move(grid)});
    edit.emplace_back(edit::AddKeyFrame{std::move(keyframe)});
  }
  for (MapPoint& point : stored.points) edit.emplace_back(edit::AddPoint{std::move(point)});
  for (MapLine& line : stored.lines) edit.emplace_back(edit::AddLine{std::move(line)});
  Map map(stored.id);
  map.Apply(edit);
  return map;
}

}  // namespace

void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map) {
  StoredMap stored{camera, rectified_from_left, map.id(), {}, {}, {}};
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Frame& frame = keyframe.frame;
    stored.keyframes.push_back({id,
                                LivingParent(map, keyframe),
                                frame.id,
                                frame.stamp_ns,
                                frame.cam_from_world,
                                frame.features()});
  }
  for (const auto& [id, point] : map.points()) stored.points.push_back(point);
  for (const auto& [id, line] : map.lines()) stored.lines.push_back(line);
  ByteWriter body;
  Format::Transfer(body, stored);

  const auto* data = reinterpret_cast<const std::uint8_t*>(body.bytes().data());
  ByteWriter header;
  for (const char c : kMagic) header(static_cast<std::uint8_t>(c));
  header(kVersion);
  header(Crc32({data, body.bytes().size()}));
  header(static_cast<std::uint64_t>(body.bytes().size()));
  std::string file = header.Take();
  file += body.bytes();
  WriteFileAtomically(path, file);
}

SavedMap LoadMap(const std::filesystem::path& path) {
  constexpr std::uint64_t kLargestMap = std::uint64_t{1} << 36;
  const std::string file = ReadInputFile(path, kLargestMap);
  const std::string source = path.string();
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()),
                                            file.size());
  if (!std::string_view(file).starts_with(kMagic)) {
    throw InputError(source + ": expected a Plumbline map, found another file");
  }
  ByteReader header(bytes.subspan(kMagic.size()), source);
  std::uint32_t version = 0;
  std::uint32_t crc = 0;
  std::uint64_t size = 0;
  header(version);
  if (version != kVersion) {
    throw InputError(fmt::format(
        "{}: expected a map of version {}, found version {}", source, kVersion, version));
  }
  Format::TransferAll(header, crc, size);
  const std::span<const std::uint8_t> body = bytes.subspan(kHeaderBytes);
  if (body.size() != size) {
    throw InputError(
        fmt::format("{}: expected {} bytes after the header, found {}", source, size, body.size()));
  }
  if (Crc32(body) != crc) throw InputError(source + ": damaged (wrong checksum)");

  StoredMap stored;
  ByteReader reader(body, source);
  Format::Transfer(reader, stored);
  if (reader.remaining() != 0) throw InputError(source + ": expected the end, found more bytes");
  Check(stored, source);
  const RectifiedCamera camera = stored.camera;
  const Eigen::Quaterniond rotation = stored.rectified_from_left;
  return {camera, rotation, BuildMap(std::move(stored)), version};
}

}  // namespace plumbline
