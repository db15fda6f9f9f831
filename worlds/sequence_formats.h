// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_calibration.h"
#include "worlds/sequence.h"

#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace plumbline {

// The parts of WriteSequence: conversion of a sequence to the files of one format.

// Text stream in the classic locale with `digits` digits.
std::ostringstream TextStream(int digits);

// A row of inertial samples: stamp [ns], rates, forces.
std::string ImuCsv(const SyntheticSequence& sequence, const std::vector<ImuSample>& samples);

// The calibration of the inertial sensor as its maker would give it: its place, noise and ranges,
// not what imu_noise and ImuFaults make of them, nor the offset of its clock.
InertialCalibration InertialOf(const SyntheticSequence& sequence);

// Images come first, one frame after the other on `threads` threads with `done(frame)` after each;
// the lists that name them last.
void WriteEurocFolder(const SyntheticSequence& sequence,
                      const std::filesystem::path& folder,
                      int threads,
                      const std::function<void(int)>& done);
void WriteTumFolder(const SyntheticSequence& sequence,
                    const std::filesystem::path& folder,
                    int threads,
                    const std::function<void(int)>& done);

}  // namespace plumbline
