// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/stretches.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace plumbline {

std::vector<Stretch> CoveredAtLeast(std::span<const Stretch> stretches, int count) {
  return WellCovered(stretches, {}, count, 0);
}

std::vector<Stretch> WellCovered(std::span<const Stretch> stretches,
                                 std::span<const Stretch> expected,
                                 int count,
                                 double share) {
  // A parameter at which one of the two numbers changes. Begins come before ends, so that stretches
  // that touch are one.
  struct Event {
    double place;
    bool ends;
    int stretches, expected;
  };
  std::vector<Event> events;
  events.reserve(2 * (stretches.size() + expected.size()));
  for (const Stretch& stretch : stretches) {
    events.push_back({stretch.from, false, 1, 0});
    events.push_back({stretch.to, true, -1, 0});
  }
  for (const Stretch& stretch : expected) {
    events.push_back({stretch.from, false, 0, 1});
    events.push_back({stretch.to, true, 0, -1});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::pair(a.place, a.ends) < std::pair(b.place, b.ends);
  });
  std::vector<Stretch> parts;
  bool inside = false;
  int covered = 0, wanted = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    covered += events[i].stretches;
    wanted += events[i].expected;
    const bool more = i + 1 < events.size() && events[i + 1].place == events[i].place &&
                      events[i + 1].ends == events[i].ends;
    if (more) continue;  // first all that begins here, then all that ends here
    const bool enough = covered >= count && covered >= share * wanted;
    if (enough && !inside) parts.push_back({events[i].place, events[i].place});
    if (!enough && inside) parts.back().to = events[i].place;
    inside = enough;
  }
  return parts;
}

std::vector<Stretch> WithGapsClosed(std::span<const Stretch> parts, double max_gap) {
  std::vector<Stretch> closed;
  for (const Stretch& part : parts) {
    if (closed.empty() || part.from - closed.back().to > max_gap) {
      closed.push_back(part);
    } else {
      closed.back().to = part.to;
    }
  }
  return closed;
}

double TotalLength(std::span<const Stretch> stretches) {
  double sum = 0;
  for (const Stretch& stretch : stretches) sum += stretch.Length();
  return sum;
}

}  // namespace plumbline
