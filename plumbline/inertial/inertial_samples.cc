// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/inertial/inertial_samples.h"

#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace plumbline {
namespace {

double SecondsBetween(const InertialSample& a, const InertialSample& b) {
  return static_cast<double>(b.stamp_ns - a.stamp_ns) / kNsPerSecond;
}

}  // namespace

bool IsPlausible(const InertialSample& sample) {
  const auto usable = [](const Eigen::Vector3d& v) {
    return (v.array().abs() <= 1e6).all();  // false for NaN
  };
  return usable(sample.angular_rate) && usable(sample.specific_force);
}

void TimeOrder::Add(const InertialSample& sample) {
  constexpr std::size_t kMostWaiting = 5;
  const std::int64_t stamp_ns = sample.stamp_ns;
  const auto later = std::ranges::find_if(
      waiting_, [&](const InertialSample& other) { return other.stamp_ns > stamp_ns; });
  if (later != waiting_.end() && later->stamp_ns - stamp_ns > kNsPerSecond / 2 &&
      (!last_ns_ || stamp_ns > *last_ns_)) {
    ahead_ += static_cast<std::size_t>(waiting_.end() - later);
    waiting_.erase(later, waiting_.end());
  }
  const auto newest_ns = waiting_.empty() ? last_ns_ : std::optional(waiting_.back().stamp_ns);
  if (newest_ns && stamp_ns <= *newest_ns) {
    ++(stamp_ns == *newest_ns ? repeated_ : backward_);
    return;
  }
  waiting_.push_back(sample);
  const bool follows = last_ns_ && waiting_.front().stamp_ns - *last_ns_ <= kNsPerSecond;
  if (!follows && waiting_.size() < kMostWaiting) return;
  // Samples far ahead of others that wait go on waiting.
  Release(std::ranges::adjacent_find(waiting_, [](const auto& a, const auto& b) {
    return b.stamp_ns - a.stamp_ns > kNsPerSecond;
  }));
}

void TimeOrder::Release(Waiting::const_iterator last) {
  if (waiting_.empty()) return;
  const auto end = last == waiting_.end() ? last : std::next(last);
  last_ns_ = std::prev(end)->stamp_ns;
  ready_.insert(ready_.end(), waiting_.cbegin(), end);
  waiting_.erase(waiting_.cbegin(), end);
}

std::optional<InertialSample> TimeOrder::Take() {
  if (ready_.empty()) return std::nullopt;
  const InertialSample sample = ready_.front();
  ready_.pop_front();
  return sample;
}

void TimeOrder::CountInto(OrderedSamples& ordered) const {
  ordered.backward += backward_;
  ordered.repeated += repeated_;
  ordered.ahead += ahead_;
}

OrderedSamples InOrderOfTime(std::span<const InertialSample> samples) {
  OrderedSamples ordered;
  TimeOrder order;
  const auto take = [&] {
    while (const auto sample = order.Take()) ordered.samples.push_back(*sample);
  };
  for (const InertialSample& sample : samples) {
    order.Add(sample);
    take();
  }
  order.End();
  take();
  order.CountInto(ordered);
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
