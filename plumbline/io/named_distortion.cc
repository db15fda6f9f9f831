// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/named_distortion.h"

#include "plumbline/base/printable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::array<std::string_view, 6> kRadTanNames = {
    "plumb_bob", "rational_polynomial", "radtan", "radial_tangential", "brown_conrady", "brown"};
constexpr std::array<std::string_view, 5> kEquidistantNames = {
    "equidistant", "fisheye", "kannala_brandt", "kannala_brandt4", "kannala_brandt_4"};

template <std::size_t kSize>
bool IsIn(const std::array<std::string_view, kSize>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the name in small letters, with underscores between its words.
std::string Simplified(std::string_view model) {
  std::string name;
  for (const char letter : model) {
    const auto byte = static_cast<unsigned char>(letter);
    name += std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '_';
  }
  return name;
}

bool AllZero(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0; });
}

std::string WhyNot(std::string_view model, const std::string& name) {
  if (name.empty()) {
    return "expected the name of a distortion model with its numbers, found ''";
  }
  if (name == "inverse_brown_conrady" || name == "modified_brown_conrady") {
    return fmt::format(
        "expected plumb_bob or equidistant, found {}, whose numbers undo a distortion "
        "in place of describing it",
        InQuotes(model));
  }
  return fmt::format("expected distortion plumb_bob or equidistant, found {}", InQuotes(model));
}

}  // namespace

std::optional<std::string> SetNamedDistortion(std::string_view model,
                                              std::span<const double> numbers,
                                              CameraIntrinsics& intrinsics) {
  const std::string name = Simplified(model);
  const bool radtan = IsIn(kRadTanNames, name), equidistant = IsIn(kEquidistantNames, name);
  if (!radtan && !equidistant) {
    intrinsics.model = DistortionModel::kNone;
    return AllZero(numbers) ? std::nullopt : std::optional(WhyNot(model, name));
  }
  const std::size_t most = radtan ? 5 : 4;
  const bool usual = numbers.size() == most || (radtan && numbers.size() == most - 1);
  if (radtan && !usual && AllZero(numbers)) {
    intrinsics.model = DistortionModel::kNone;
    return std::nullopt;
  }
  if (numbers.size() < most && !usual) {
    return fmt::format("expected {} of {} numbers, found {}",
                       InQuotes(model),
                       radtan ? "4 or 5" : "4",
                       numbers.size());
  }
  for (std::size_t i = most; i < numbers.size(); ++i) {
    if (numbers[i] == 0) continue;
    return fmt::format("expected {} and then zeros, found {:g} as number {}; calibrate without {}",
                       radtan ? "k1, k2, p1, p2, k3" : "k1, k2, k3, k4",
                       numbers[i],
                       i + 1,
                       radtan ? "the rational, thin prism and tilted models" : "more numbers");
  }
  intrinsics.model = radtan ? DistortionModel::kRadTan : DistortionModel::kEquidistant;
  std::copy_n(numbers.begin(), std::min(most, numbers.size()), intrinsics.distortion.begin());
  return std::nullopt;
}

}  // namespace plumbline
