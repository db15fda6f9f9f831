// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/map_io.h"

#include "plumbline/base/error.h"
#include "plumbline/features/extractor.h"
#include "plumbline/io/map_file/section_file.h"
#include "plumbline/map/byte_format.h"
#include "plumbline/map/map_builder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::uint32_t kVersion = 2;

// Sections come in this order: the context; for each map its record, keyframes, points and lines,
// each kind in as many sections as it needs; the end.
enum SectionKind : std::uint32_t {
  kContext = 1,
  kMapRecord = 2,
  kKeyFrames = 3,
  kPoints = 4,
  kLines = 5,
  kEnd = 6
};

// A section is closed when it has this much, so that little memory is needed.
constexpr std::size_t kSectionBytes = std::size_t{1} << 21;
constexpr std::size_t kSectionLandmarks = 8192;
constexpr std::size_t kSectionObservations = 65536;

struct MapCounts {
  std::int64_t keyframes = 0;
  std::int64_t points = 0;
  std::int64_t lines = 0;
};

template <class Archive, Like<MapCounts> T>
void Transfer(Archive& archive, T& counts) {
  TransferAll(archive, counts.keyframes, counts.points, counts.lines);
}

const Descriptor* DescriptorOf(const Map& map, const MapPoint&, KeyFrameId id, int feature) {
  const KeyFrame* keyframe = map.Find(id);
  if (keyframe == nullptr || feature < 0) return nullptr;
  const auto& points = keyframe->frame.features().points;
  const auto place = static_cast<std::size_t>(feature);
  return place < points.size() ? &points[place].descriptor : nullptr;
}

const Descriptor* DescriptorOf(const Map& map, const MapLine&, KeyFrameId id, int feature) {
  const KeyFrame* keyframe = map.Find(id);
  if (keyframe == nullptr || feature < 0) return nullptr;
  const auto& lines = keyframe->frame.features().lines;
  const auto place = static_cast<std::size_t>(feature);
  return place < lines.size() ? &lines[place].descriptor : nullptr;
}

// Finds the descriptors of the features that show landmarks of one kind.
template <class Landmark>
auto DescriptorsIn(const Map& map) {
  return [&map](KeyFrameId keyframe, int feature) {
    return DescriptorOf(map, Landmark(), keyframe, feature);
  };
}

void WriteKeyFrames(const Map& map, SectionWriter& file) {
  ByteWriter section;
  for (const auto& [id, keyframe] : map.keyframes()) {
    TransferPlace(section, keyframe);
    const Features measured = MeasuredFeatures(*keyframe.frame.indexed);
    Transfer(section, measured);
    if (section.bytes().size() >= kSectionBytes) file.Write(kKeyFrames, section.Take());
  }
  if (!section.bytes().empty()) file.Write(kKeyFrames, section.bytes());
}

template <class LandmarkId, class Landmark>
void WriteLandmarks(const IdTable<LandmarkId, Landmark>& landmarks,
                    const Map& map,
                    SectionKind kind,
                    SectionWriter& file) {
  LandmarkList<const Landmark> list;
  std::size_t observations = 0;
  const auto write = [&] {
    ByteWriter section;
    TransferCount(section, list.size());
    TransferAllOf(section, list, DescriptorsIn<Landmark>(map));
    file.Write(kind, section.bytes());
    list.clear();
    observations = 0;
  };
  for (const auto& [id, landmark] : landmarks) {
    list.push_back(&landmark);
    observations += landmark.observations.size();
    if (list.size() == kSectionLandmarks || observations >= kSectionObservations) write();
  }
  if (!list.empty()) write();
}

void WriteMap(const Map& map, const MapRecord& record, SectionWriter& file) {
  const MapCounts counts{static_cast<std::int64_t>(map.keyframes().size()),
                         static_cast<std::int64_t>(map.points().size()),
                         static_cast<std::int64_t>(map.lines().size())};
  ByteWriter section;
  TransferAll(section, record, counts);
  const double border_px = record.correction.lens.border_px();
  if (border_px != 0) Transfer(section, border_px);
  file.Write(kMapRecord, section.bytes());
  WriteKeyFrames(map, file);
  WriteLandmarks(map.points(), map, kPoints, file);
  WriteLandmarks(map.lines(), map, kLines, file);
}

std::vector<const Map*> MapsOf(const Atlas& atlas) {
  std::vector<const Map*> maps;
  for (const auto& [id, map] : atlas.maps()) maps.push_back(&map);
  return maps;
}

// Writes the sections. The context comes first, since the camera must be known to read maps.
void WriteSections(const std::vector<const Map*>& maps,
                   const AtlasContext& context,
                   MapId active,
                   SectionWriter& file) {
  ByteWriter section;
  TransferAll(section, context, active);
  TransferCount(section, maps.size());
  file.Write(kContext, section.bytes());
  for (const Map* map : maps) {
    MapRecord record = map->Record();
    for (const Map* other : maps) {
      if (map->id() != active) break;
      // Atlas::Activate gives the active map ids after those of all others.
      record.next_point = std::max(record.next_point, other->NextPointId());
      record.next_line = std::max(record.next_line, other->NextLineId());
    }
    WriteMap(*map, record, file);
  }
  file.Write(kEnd, {});
}

// Throws InputError for a map that could not be read again (MapBuilder), before the file that is
// there is replaced.
void CheckIds(const std::filesystem::path& path, const Map& map) {
  const std::int64_t next = std::max(map.NextPointId().value, map.NextLineId().value);
  if (next <= kMaxBuiltId) return;
  throw InputError(fmt::format("{}: expected a map that gave at most {} ids to points, found {}",
                               path.string(),
                               kMaxBuiltId,
                               next));
}

void WriteFile(const std::filesystem::path& path,
               const std::vector<const Map*>& maps,
               const AtlasContext& context,
               MapId active) {
  for (const Map* map : maps) CheckIds(path, *map);
  SectionWriter file(path, VersionedPreamble(kMapMagic, kVersion));
  WriteSections(maps, context, active, file);
  file.Commit();
}

ByteReader ReaderOf(const std::string& contents, const std::string& source) {
  return {{reinterpret_cast<const std::uint8_t*>(contents.data()), contents.size()}, source};
}

void CheckEnd(const ByteReader& reader) {
  if (reader.remaining() != 0) {
    throw InputError(reader.source() + ": expected the end of a section, found more bytes");
  }
}

// Returns the contents of the next section, which must be of this kind.
std::string NextSectionOfKind(SectionReader& file, std::uint32_t kind) {
  SectionReader::Section section = file.Next();
  if (section.kind != kind) {
    throw InputError(fmt::format(
        "{}: expected a section of kind {}, found kind {}", file.source(), kind, section.kind));
  }
  return std::move(section.contents);
}

[[noreturn]] void FailMap(const std::string& source, const std::string& what) {
  throw InputError(source + ": expected a map that agrees with itself, found " + what);
}

void CheckContext(const AtlasContext& context, const std::string& source) {
  const RectifiedCamera& c = context.camera;
  // At this size the grid of each keyframe takes 1 MB.
  constexpr std::int64_t kMaxPixels = 100'000'000;
  if (!(c.fx > 0) || !(c.fy > 0) || c.width <= 0 || c.height <= 0 ||
      std::int64_t{c.width} * c.height > kMaxPixels) {
    FailMap(source, "no valid camera");
  }
  const bool finite = std::isfinite(c.fx) && std::isfinite(c.fy) && std::isfinite(c.cx) &&
                      std::isfinite(c.cy) && std::isfinite(c.baseline) && c.baseline >= 0;
  if (!finite || !(std::abs(context.rectified_from_left.norm() - 1) < 1e-6) ||
      !(context.octave_scale > 1 && context.octave_scale < 10)) {
    FailMap(source, "no valid camera");
  }
  const StereoEvidence& evidence = context.stereo_evidence;
  if (!evidence.information.allFinite() || !evidence.weighted.allFinite() ||
      !evidence.moments.allFinite()) {
    FailMap(source, "evidence about the stereo pair without a value");
  }
}

void ReadKeyFrames(SectionReader& file,
                   const AtlasContext& context,
                   std::int64_t count,
                   MapBuilder& builder) {
  const auto sessions =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(context.sessions.size()));
  for (std::int64_t done = 0; done < count;) {
    const std::string contents = NextSectionOfKind(file, kKeyFrames);
    ByteReader reader = ReaderOf(contents, file.source());
    do {
      KeyFrame keyframe;
      TransferPlace(reader, keyframe);
      Features measured;
      Transfer(reader, measured);
      if (!keyframe.session.valid() || keyframe.session.value >= sessions) {
        FailMap(file.source(), "a keyframe of a session that is not there");
      }
      keyframe.frame.indexed =
          IndexFeatures(context.camera, std::move(measured), builder.map().correction());
      builder.Add(std::move(keyframe));
    } while (++done < count && reader.remaining() != 0);
    CheckEnd(reader);
  }
}

template <class Landmark>
void ReadLandmarks(SectionReader& file, SectionKind kind, std::int64_t count, MapBuilder& builder) {
  for (std::int64_t done = 0; done < count;) {
    const std::string contents = NextSectionOfKind(file, kind);
    ByteReader reader = ReaderOf(contents, file.source());
    const std::size_t stored = TransferCount(reader, 0);
    if (stored > kSectionLandmarks) FailMap(file.source(), "too many landmarks in a section");
    std::vector<Landmark> landmarks(stored);
    LandmarkList<Landmark> list;
    for (Landmark& landmark : landmarks) list.push_back(&landmark);
    TransferAllOf(reader, list, DescriptorsIn<Landmark>(builder.map()));
    CheckEnd(reader);
    done += static_cast<std::int64_t>(landmarks.size());
    if (landmarks.empty() || done > count) FailMap(file.source(), "another number of landmarks");
    for (Landmark& landmark : landmarks) builder.Add(std::move(landmark));
  }
}

Map ReadMap(SectionReader& file, const AtlasContext& context) {
  const std::string contents = NextSectionOfKind(file, kMapRecord);
  ByteReader reader = ReaderOf(contents, file.source());
  MapRecord record;
  MapCounts counts;
  TransferAll(reader, record, counts);
  // Only maps that have a lens correction keep one, so that others can be read by programs that
  // know of none.
  if (reader.remaining() != 0) {
    double border_px = 0;
    Transfer(reader, border_px);
    record.correction.lens = LensCorrection(context.camera, border_px);
  }
  CheckEnd(reader);
  MapBuilder builder(record, file.source());
  ReadKeyFrames(file, context, counts.keyframes, builder);
  ReadLandmarks<MapPoint>(file, kPoints, counts.points, builder);
  ReadLandmarks<MapLine>(file, kLines, counts.lines, builder);
  return builder.Finish();
}

// Marks ids of one kind as taken; returns false for one taken before.
class TakenIds {
 public:
  bool Take(std::int64_t id) {
    const auto place = static_cast<std::size_t>(id);
    if (taken_.size() <= place) taken_.resize(place + 1);
    return !std::exchange(taken_[place], 1);
  }

 private:
  std::vector<char> taken_;
};

// Checks that no id is in two maps, and that the age of recent landmarks is known.
void CheckAtlas(const SavedAtlas& saved, const std::string& source) {
  TakenIds keyframes, points, lines;
  const auto take = [&](TakenIds& taken, const auto& entries) {
    for (const auto& [id, entry] : entries) {
      if (!taken.Take(id.value)) FailMap(source, "an id that two maps have");
    }
  };
  for (const auto& [id, map] : saved.atlas.maps()) {
    take(keyframes, map.keyframes());
    take(keyframes, map.Record().removed_keyframes);
    take(points, map.points());
    take(lines, map.lines());
  }
  for (const auto& [id, context] : saved.context.maps) {
    const Map* map = saved.atlas.Find(id);
    if (map == nullptr) FailMap(source, "something about a map that is not there");
    const auto check = [&](const auto& young) {
      for (const auto landmark_id : young) {
        const auto* landmark = map->Find(landmark_id);
        if (landmark != nullptr && !map->Knows(landmark->created_by)) {
          FailMap(source, "a young landmark of a keyframe that never was");
        }
      }
    };
    check(context.young.points);
    check(context.young.lines);
  }
}

SavedAtlas ReadMapSections(SectionReader& file) {
  SavedAtlas saved;
  const std::string contents = NextSectionOfKind(file, kContext);
  ByteReader reader = ReaderOf(contents, file.source());
  MapId active;
  std::int64_t maps = 0;
  TransferAll(reader, saved.context, active, maps);
  CheckEnd(reader);
  CheckContext(saved.context, file.source());
  for (std::int64_t i = 0; i < maps; ++i) {
    Map map = ReadMap(file, saved.context);
    if (saved.atlas.Find(map.id()) != nullptr) FailMap(file.source(), "two maps of one id");
    saved.atlas.Adopt(std::move(map));
  }
  if (!NextSectionOfKind(file, kEnd).empty()) {
    throw InputError(file.source() + ": expected the end of the maps, found more bytes");
  }
  if (maps > 0 && saved.atlas.Find(active) == nullptr) FailMap(file.source(), "no active map");
  if (maps > 0) saved.atlas.Activate(active);
  CheckAtlas(saved, file.source());
  return saved;
}

}  // namespace

void SaveAtlas(const std::filesystem::path& path,
               const Atlas& atlas,
               const AtlasContext& context,
               MapId active) {
  WriteFile(path, MapsOf(atlas), context, active.valid() ? active : atlas.active_id());
}

SavedAtlas LoadAtlas(const std::filesystem::path& path) {
  SectionReader file(path, kVersionedPreambleBytes);
  const auto version = VersionOf(file, kMapMagic);
  if (!version) {
    throw InputError(file.source() + ": expected a Plumbline map, found another file");
  }
  if (*version != kVersion) {
    throw InputError(
        fmt::format("{}: expected a map of version {}, found version {}, which {} reads",
                    file.source(),
                    kVersion,
                    *version,
                    *version < kVersion ? "plumbline 0.2.0" : "a later plumbline"));
  }
  SavedAtlas saved = ReadMapSections(file);
  if (file.remaining() != 0) {
    throw InputError(file.source() + ": expected the end, found more bytes");
  }
  saved.file_version = kVersion;
  return saved;
}

void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map) {
  AtlasContext context;
  context.camera = camera;
  context.rectified_from_left = rectified_from_left;
  WriteFile(path, {&map}, context, map.id());
}

SavedMap SavedMapOf(Map map, const AtlasContext& context, std::uint32_t file_version) {
  SavedMap saved{context.camera, context.rectified_from_left, std::move(map), file_version};
  if (context.feature_format == kFeatureFormat) saved.octave_scale = context.octave_scale;
  return saved;
}

SavedMap LoadMap(const std::filesystem::path& path) {
  SavedAtlas saved = LoadAtlas(path);
  Map map;
  if (!saved.atlas.empty()) map = std::move(saved.atlas.active());
  return SavedMapOf(std::move(map), saved.context, saved.file_version);
}

}  // namespace plumbline
