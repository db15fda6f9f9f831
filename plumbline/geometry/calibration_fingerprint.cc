// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/calibration_fingerprint.h"

#include "plumbline/base/content_hash.h"
#include "plumbline/geometry/byte_format.h"

#include <algorithm>

namespace plumbline {
namespace {

void Write(ByteWriter& bytes, const Camera& camera) {
  const CameraIntrinsics& c = camera.intrinsics();
  TransferAll(bytes, c.fx, c.fy, c.cx, c.cy, c.width, c.height, c.distortion);
  bytes(static_cast<std::uint8_t>(c.model));
}

}  // namespace

std::uint64_t FingerprintOf(const Calibration& calibration, const RectifiedCamera& camera) {
  ByteWriter bytes;
  Write(bytes, calibration.left);
  if (calibration.right) {
    Write(bytes, *calibration.right);
    Transfer(bytes, calibration.right_from_left);
  }
  TransferAll(bytes, calibration.rectified, calibration.depth_factor, camera);
  return std::max<std::uint64_t>(ContentHash(bytes.bytes()), 1);
}

}  // namespace plumbline
