// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/inertial_sample.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// Samples in order of time.
struct OrderedSamples {
  std::vector<InertialSample> samples;  // stamps strictly increasing
  std::size_t backward = 0;             // left out: their stamp is before that of a former sample
  std::size_t repeated = 0;             // left out: their stamp is that of the former sample
  std::size_t ahead = 0;                // left out: far later than those before and after them
};

// Returns true if the values are those of a sensor in rad/s and m/s^2: numbers of at most 1e6.
bool IsPlausible(const InertialSample& sample);

// Passes on the samples that are in order of time. One whose stamp does not increase is left out:
// which of two is right is not known, and a stamp that was believed cannot be taken back in a live
// run. The first ones, and those from one on that is more than 1 s ahead of the former, wait until
// there are five: if one comes that is more than 0.5 s before them, they have wrong stamps and are
// left out.
class TimeOrder {
 public:
  void Add(const InertialSample& sample);
  // No more samples follow: those that wait are in order.
  void End() { Release(waiting_.end()); }
  // Returns the next sample in order; nullopt until more are added.
  std::optional<InertialSample> Take();
  // Adds the numbers of samples that were left out so far.
  void CountInto(OrderedSamples& ordered) const;

 private:
  using Waiting = std::vector<InertialSample>;
  // Samples that wait up to this one, or all, are in order.
  void Release(Waiting::const_iterator last);

  std::optional<std::int64_t> last_ns_;  // of those in order
  Waiting waiting_;                      // stamps increase
  std::deque<InertialSample> ready_;
  std::size_t backward_ = 0, repeated_ = 0, ahead_ = 0;
};

// Returns the samples that are in order (TimeOrder).
OrderedSamples InOrderOfTime(std::span<const InertialSample> samples);

// Joins the samples of a gyroscope (their angular_rate) with those of an accelerometer (their
// specific_force) that are sampled apart, as they come: the slower one is interpolated linearly at
// the stamps of the faster one. Stamps without samples of the slower one around them are left out.
class SampleJoiner {
 public:
  // gyroscope_leads  the gyroscope is the faster one
  explicit SampleJoiner(bool gyroscope_leads) : gyroscope_leads_(gyroscope_leads) {}
  // The stamps of each must increase strictly. At most 10,000 samples of the faster one wait for
  // the slower one; the oldest are given up.
  void AddRates(const InertialSample& sample) { Add(gyroscope_leads_ ? fast_ : slow_, sample); }
  void AddForces(const InertialSample& sample) { Add(gyroscope_leads_ ? slow_ : fast_, sample); }
  // Returns the next joined sample; nullopt until more samples come.
  std::optional<InertialSample> Take();

 private:
  static void Add(std::deque<InertialSample>& to, const InertialSample& sample);

  bool gyroscope_leads_;
  std::deque<InertialSample> fast_, slow_;
};

// Joins samples that were taken apart (SampleJoiner); the faster ones have the smaller median
// interval. The stamps of both must increase strictly.
std::vector<InertialSample> JoinedSamples(std::span<const InertialSample> gyroscope,
                                          std::span<const InertialSample> accelerometer);

// Returns the median interval of samples in order of time, in seconds; 0 if there are less than 2.
double MedianInterval(std::span<const InertialSample> samples);

// Returns the sample at a stamp between two neighbours, linear in time.
InertialSample SampleBetween(const InertialSample& a,
                             const InertialSample& b,
                             std::int64_t stamp_ns);

}  // namespace plumbline
