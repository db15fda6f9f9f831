// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/sequence_truth.h"

#include "plumbline/base/input_file.h"
#include "plumbline/features/extractor.h"
#include "plumbline/io/cameras/yaml_section.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/report/error_options.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// The same whatever the options of the initialization under test are.
FeatureOptions StereoFeatures() {
  FeatureOptions options;
  options.point_count = 3000;
  options.lines = false;
  options.stereo_points.calibration_sigma = 2e-4;
  return options;
}

bool Offers(const Dataset& dataset, SensorKind kind) {
  const auto& kinds = dataset.info().available;
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

SequenceTruth::SequenceTruth(const Dataset& mono,
                             const Rectifier& rectifier,
                             const std::optional<std::string>& camera,
                             const std::optional<Trajectory>& poses)
    : mono_(mono),
      camera_(rectifier.camera()),
      rectified_from_raw_(rectifier.rectified_left_from_left()),
      max_gap_ns_(ErrorOptionsFor(mono.sensor(), mono.info().format).max_gap_ns) {
  const DatasetInfo& info = mono.info();
  if (poses) {
    poses_ = *poses;
  } else if (info.ground_truth) {
    poses_ = info.ground_truth->OfCamera(mono.calibration());
  }
  if (fs::exists(info.path / "mav0" / "depth0" / "data.csv")) {
    OpenDepthImages(info.path / "mav0" / "depth0");
    return;
  }
  const bool rgbd = Offers(mono, SensorKind::kRgbd);
  if (!rgbd && !Offers(mono, SensorKind::kStereo)) return;
  DatasetOptions options;
  options.sensor = rgbd ? SensorKind::kRgbd : SensorKind::kStereo;
  options.camera = camera;
  metric_ = OpenDataset(info.path, options);
  for (std::size_t i = 0; i < metric_->size(); ++i) metric_frames_[metric_->stamp_ns(i)] = i;
  if (!rgbd) {
    stereo_ = std::make_unique<FrontEnd>(metric_->calibration(), StereoFeatures());
  }
}

void SequenceTruth::OpenDepthImages(const fs::path& folder) {
  const fs::path sensor = folder / "sensor.yaml", list = folder / "data.csv";
  depth_factor_ = YamlSection::Parse(ReadInputFile(sensor, kLargestSettings), sensor.string())
                      .Positive("depth_factor");
  for (const TextRow& row : ReadRows(list, ',')) {
    const auto stamp = ParseNanoseconds(row.fields.front());
    if (!stamp || row.fields.size() != 2)
      FailAt(list, row.line, "a stamp and a file", "another row");
    depth_images_[*stamp] = folder / "data" / row.fields[1];
  }
}

std::optional<Rigid3> SequenceTruth::WorldFromCamera(int frame) const {
  const std::int64_t stamp = mono_.stamp_ns(static_cast<std::size_t>(frame));
  const auto world_from_raw = InterpolateAt(poses_, stamp, max_gap_ns_);
  if (!world_from_raw) return std::nullopt;
  return *world_from_raw * Rigid3{rectified_from_raw_.conjugate(), Eigen::Vector3d::Zero()};
}

std::shared_ptr<const TrueDepth> SequenceTruth::DepthAt(int frame) const {
  const std::int64_t stamp = mono_.stamp_ns(static_cast<std::size_t>(frame));
  if (depth_factor_) {
    const auto path = depth_images_.find(stamp);
    if (path == depth_images_.end()) return nullptr;
    auto depth = ReadDepthImage(path->second, *depth_factor_);
    return depth ? DepthFromImage(*depth) : nullptr;
  }
  const auto index = metric_frames_.find(stamp);
  if (index == metric_frames_.end()) return nullptr;
  const auto measured = metric_->Read(index->second);
  if (!measured) return nullptr;
  if (stereo_) return DepthFromStereo(*measured);
  return measured->depth ? DepthFromImage(*measured->depth) : nullptr;
}

std::shared_ptr<const TrueDepth> SequenceTruth::DepthFromImage(DepthImage depth) const {
  return std::make_shared<TrueDepthOfImage>(
      std::move(depth), mono_.calibration().left, camera_, rectified_from_raw_);
}

std::shared_ptr<const TrueDepth> SequenceTruth::DepthFromStereo(SensorFrame frame) const {
  const ExtractedFrame extracted = stereo_->Extract(std::move(frame));
  const Rectifier& pair = stereo_->rectifier();
  return std::make_shared<TrueDepthOfPoints>(
      TrueDepthOfStereo(extracted.indexed->features,
                        pair.camera(),
                        rectified_from_raw_ * pair.rectified_left_from_left().conjugate(),
                        camera_));
}

}  // namespace plumbline
