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

OrderedSamples InOrderOfTime(std::span<const InertialSample> samples) {
  OrderedSamples ordered;
  for (const InertialSample& sample : samples) {
    if (!ordered.samples.empty() && sample.stamp_ns <= ordered.samples.back().stamp_ns) {
      const bool same = sample.stamp_ns == ordered.samples.back().stamp_ns;
      ++(same ? ordered.repeated : ordered.backward);
      continue;
    }
    ordered.samples.push_back(sample);
  }
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

std::vector<InertialSample> JoinedSamples(std::span<const InertialSample> gyroscope,
                                          std::span<const InertialSample> accelerometer) {
  const bool gyroscope_leads = MedianInterval(gyroscope) <= MedianInterval(accelerometer);
  const auto& fast = gyroscope_leads ? gyroscope : accelerometer;
  const auto& slow = gyroscope_leads ? accelerometer : gyroscope;
  std::vector<InertialSample> joined;
  std::size_t next = 1;  // of the slower one, the end of the interval around the stamp
  for (const InertialSample& sample : fast) {
    while (next < slow.size() && slow[next].stamp_ns < sample.stamp_ns) ++next;
    if (next >= slow.size()) break;
    if (slow[next - 1].stamp_ns > sample.stamp_ns) continue;
    const InertialSample other = SampleBetween(slow[next - 1], slow[next], sample.stamp_ns);
    joined.push_back({sample.stamp_ns,
                      (gyroscope_leads ? sample : other).angular_rate,
                      (gyroscope_leads ? other : sample).specific_force});
  }
  return joined;
}

}  // namespace plumbline
