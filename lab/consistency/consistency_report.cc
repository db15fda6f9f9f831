// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/consistency_report.h"

#include "plumbline/base/options.h"
#include "plumbline/base/statistics.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Kind = ConsistencyKind;

bool IsSegment(Kind kind) {
  return kind == Kind::kLine || kind == Kind::kRightLine || kind == Kind::kSegment ||
         kind == Kind::kRightSegment;
}
bool IsCorner(Kind kind) { return kind == Kind::kPoint || kind == Kind::kDisparity; }

// A quantity by which samples are parted at two limits.
struct Parting {
  const char* name;
  const char* unit;
  double low, high;
  double (*value)(const ConsistencySample& sample);
  bool (*applies)(Kind kind);
};

bool IsFeature(Kind kind) { return IsSegment(kind) || IsCorner(kind); }

bool IsInnovation(Kind kind) {
  return IsCorner(kind) || kind == Kind::kLine || kind == Kind::kRightLine;
}

constexpr std::array kPartings = {
    Parting{"length", " px", 60, 120, [](const auto& s) { return s.length; }, IsSegment},
    Parting{"contrast", "", 8, 20, [](const auto& s) { return s.contrast; }, IsSegment},
    Parting{
        "from the middle", "", 0.33, 0.67, [](const auto& s) { return s.from_middle; }, IsFeature},
    Parting{"approach", "", -0.3, -0.1, [](const auto& s) { return s.approach; }, IsInnovation},
    Parting{"octave", "", 1, 4, [](const auto& s) { return double(s.octave); }, IsCorner},
    Parting{
        "earlier keyframes", "", 3, 8, [](const auto& s) { return double(s.earlier); }, IsFeature}};

// Median of chi2 with 1 to 6 degrees of freedom.
double MedianChi2(int dof) {
  constexpr std::array kMedians{0.4549, 1.3863, 2.3660, 3.3567, 4.3515, 5.3481};
  return kMedians[static_cast<std::size_t>(dof - 1)];
}

// Adds the share of those samples of a kind that are in the class.
template <class InClass>
void AddShare(std::span<const ConsistencySample> samples,
              Kind kind,
              const std::string& of,
              const InClass& in_class,
              std::vector<ConsistencyShare>& shares) {
  ConsistencyShare share{NameOf(kind), of, 0, 0, 0};
  std::vector<double> nees;
  int dimensions = 1;
  for (const ConsistencySample& sample : samples) {
    if (sample.kind != kind || !in_class(sample)) continue;
    nees.push_back(sample.nees);
    dimensions = sample.dimensions;
    if (IsInside(sample)) share.inside += 1;
  }
  if (nees.empty()) return;
  share.samples = nees.size();
  share.inside /= static_cast<double>(nees.size());
  share.factor = std::sqrt(UpperMedian(nees) / MedianChi2(dimensions));
  shares.push_back(share);
}

std::string Plain(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

std::vector<ConsistencyShare> ConsistencyShares(std::span<const ConsistencySample> samples) {
  std::vector<ConsistencyShare> shares;
  for (const auto& [kind, name] : EnumNames(std::type_identity<Kind>{})) {
    AddShare(
        samples, kind, "all", [](const auto&) { return true; }, shares);
    for (const Parting& by : kPartings) {
      if (!by.applies(kind)) continue;
      const std::string what = by.name, low = Plain(by.low), high = Plain(by.high);
      AddShare(
          samples,
          kind,
          what + " below " + low + by.unit,
          [&](const auto& s) { return by.value(s) < by.low; },
          shares);
      AddShare(
          samples,
          kind,
          what + " " + low + " to " + high + by.unit,
          [&](const auto& s) { return by.value(s) >= by.low && by.value(s) < by.high; },
          shares);
      AddShare(
          samples,
          kind,
          what + " from " + high + by.unit,
          [&](const auto& s) { return by.value(s) >= by.high; },
          shares);
    }
  }
  return shares;
}

std::string ConsistencyTable(std::span<const ConsistencyShare> shares, std::size_t least) {
  std::ostringstream table;
  table << "errors          class                          samples  within 90 % [%]  factor\n";
  for (const ConsistencyShare& share : shares) {
    if (share.samples < least) continue;
    table << std::left << std::setw(16) << share.kind << std::setw(29) << share.of << std::right
          << std::fixed << std::setw(9) << share.samples << std::setprecision(1) << std::setw(17)
          << 100 * share.inside << std::setprecision(2) << std::setw(8) << share.factor << '\n';
  }
  return table.str();
}

std::string ConsistencyJson(std::span<const ConsistencyShare> shares) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ConsistencyShare& share : shares) {
    list.push_back({{"kind", share.kind},
                    {"of", share.of},
                    {"samples", share.samples},
                    {"inside", share.inside},
                    {"factor", share.factor}});
  }
  return list.dump(1) + '\n';
}

}  // namespace plumbline
