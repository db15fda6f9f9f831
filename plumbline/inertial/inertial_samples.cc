// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/inertial_samples.h"

#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"

#include <cstdint>

namespace plumbline {
namespace {

double SecondsBetween(const InertialSample& a, const InertialSample& b) {
  return static_cast<double>(b.stamp_ns - a.stamp_ns) / kNsPerSecond;
}

}  // namespace

bool TimeOrder::Takes(std::int64_t stamp_ns) {
  if (last_ns_ && stamp_ns <= *last_ns_) {
    ++(stamp_ns == *last_ns_ ? repeated_ : backward_);
    return false;
  }
  last_ns_ = stamp_ns;
  return true;
}

OrderedSamples InOrderOfTime(std::span<const InertialSample> samples) {
  OrderedSamples ordered;
  TimeOrder order;
  for (const InertialSample& sample : samples) {
    if (order.Takes(sample.stamp_ns)) ordered.samples.push_back(sample);
  }
  ordered.backward = order.backward();
  ordered.repeated = order.repeated();
  return ordered;
}

double MedianInterval(std::span<const InertialSample> samples) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    intervals.push_back(SecondsBetween(samples[i - 1], samples[i]));
  }
  return UpperMedian(std::span<double>(intervals));
}

InertialSample SampleBetween(const InertialSample& a,
                             const InertialSample& b,
                             std::int64_t stamp_ns) {
  const double s = SecondsBetween(a, {stamp_ns, {}, {}}) / SecondsBetween(a, b);
  return {stamp_ns,
          (1 - s) * a.angular_rate + s * b.angular_rate,
          (1 - s) * a.specific_force + s * b.specific_force};
}

void SampleJoiner::Add(std::deque<InertialSample>& to, const InertialSample& sample) {
  constexpr std::size_t kMostWaiting = 10'000;
  if (to.size() == kMostWaiting) to.pop_front();
  to.push_back(sample);
}

std::optional<InertialSample> SampleJoiner::Take() {
  while (!fast_.empty()) {
    const InertialSample sample = fast_.front();
    while (slow_.size() >= 2 && slow_[1].stamp_ns < sample.stamp_ns) slow_.pop_front();
    if (slow_.empty()) return std::nullopt;
    if (slow_[0].stamp_ns > sample.stamp_ns) {
      fast_.pop_front();
      continue;
    }
    if (slow_.size() < 2) return std::nullopt;
    fast_.pop_front();
    const InertialSample other = SampleBetween(slow_[0], slow_[1], sample.stamp_ns);
    return InertialSample{sample.stamp_ns,
                          (gyroscope_leads_ ? sample : other).angular_rate,
                          (gyroscope_leads_ ? other : sample).specific_force};
  }
  return std::nullopt;
}

std::vector<InertialSample> JoinedSamples(std::span<const InertialSample> gyroscope,
                                          std::span<const InertialSample> accelerometer) {
  SampleJoiner joiner(MedianInterval(gyroscope) <= MedianInterval(accelerometer));
  std::vector<InertialSample> joined;
  auto rate = gyroscope.begin();
  auto force = accelerometer.begin();
  while (rate != gyroscope.end() || force != accelerometer.end()) {
    const bool rate_is_next = force == accelerometer.end() ||
                              (rate != gyroscope.end() && rate->stamp_ns <= force->stamp_ns);
    rate_is_next ? joiner.AddRates(*rate++) : joiner.AddForces(*force++);
    while (const auto sample = joiner.Take()) joined.push_back(*sample);
  }
  return joined;
}

}  // namespace plumbline
