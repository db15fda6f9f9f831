// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/bench/sequence_images.h"

#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include <ctime>
#include <filesystem>
#include <utility>

namespace plumbline::bench {

std::optional<SequenceImages> ReadImages(const std::string& data,
                                         const Sequence& sequence,
                                         int count) {
  const std::filesystem::path folder = std::filesystem::path(data) / sequence.folder;
  if (!std::filesystem::exists(folder)) return std::nullopt;
  DatasetOptions options;
  if (sequence.camera != nullptr) options.camera = sequence.camera;
  const auto dataset = OpenDataset(folder, options);
  const Rectifier rectifier(dataset->calibration());
  SequenceImages images{{}, rectifier.left_mask()};
  for (int i = 0; i < count; ++i) {
    const std::size_t frame = (2 * static_cast<std::size_t>(i) + 1) * dataset->size() /
                              (2 * static_cast<std::size_t>(count));
    auto read = dataset->Read(frame);
    if (read) images.left.push_back(rectifier.Apply(std::move(*read)).left);
  }
  return images;
}

double CpuMilliseconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace plumbline::bench
