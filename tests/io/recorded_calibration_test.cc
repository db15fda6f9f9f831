// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/recorded_calibration.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace named_distortion_test {

using testing::HasSubstr;

// A model and its numbers, or what is said of them.
struct Case {
  std::string model;
  std::vector<double> numbers;
  DistortionModel expected = DistortionModel::kNone;
};

const std::vector<double> kFive = {0.1, -0.2, 0.001, 0.002, 0.03};

const std::vector<double> kEight = {0.4, -2.5, 0.001, 0.002, 1.4, 0.3, -2.3, 1.35};

std::vector<double> Padded(std::vector<double> numbers, std::size_t size) {
  numbers.resize(size);
  return numbers;
}

TEST(SetNamedDistortion, KnowsTheNamesOfDrivers) {
  using enum DistortionModel;
  const std::vector<double> four = {0.1, -0.2, 0.001, 0.002};
  const std::vector<Case> cases = {{"plumb_bob", four, kRadTan},
                                   {"plumb_bob", kFive, kRadTan},
                                   {"plumb_bob", Padded(kFive, 8), kRadTan},
                                   {"plumb_bob", Padded(kFive, 12), kRadTan},
                                   {"rational_polynomial", Padded(kFive, 8), kRadTan},
                                   {"rational_polynomial", Padded(kFive, 14), kRadTan},
                                   {"rational_polynomial", kEight, kRational},
                                   {"rational_polynomial", Padded(kEight, 14), kRational},
                                   {"Brown Conrady", kFive, kRadTan},
                                   {"radtan", four, kRadTan},
                                   {"rational_polynomial", Padded({}, 8)},
                                   {"plumb_bob", {}},
                                   {"equidistant", four, kEquidistant},
                                   {"fisheye", four, kEquidistant},
                                   {"kannala_brandt", four, kEquidistant},
                                   {"Kannala Brandt4", Padded(four, 5), kEquidistant},
                                   {"", {}},
                                   {"", Padded({}, 5)},
                                   {"none", {}},
                                   {"Inverse Brown Conrady", Padded({}, 5)},
                                   {"Ftheta", Padded({}, 5)}};
  for (const Case& one : cases) {
    CameraIntrinsics intrinsics;
    EXPECT_EQ(SetNamedDistortion(one.model, one.numbers, intrinsics), std::nullopt) << one.model;
    EXPECT_EQ(intrinsics.model, one.expected) << one.model << " of " << one.numbers.size();
    for (std::size_t i = 0; i < kMostCoefficients; ++i) {
      const bool given = one.expected != DistortionModel::kNone && i < one.numbers.size();
      EXPECT_EQ(intrinsics.distortion[i], given ? one.numbers[i] : 0) << one.model;
    }
  }
}

TEST(SetNamedDistortion, SaysWhyNot) {
  const auto fault = [](const std::string& model, const std::vector<double>& numbers) {
    CameraIntrinsics intrinsics;
    return SetNamedDistortion(model, numbers, intrinsics).value_or("no fault");
  };
  std::vector<double> prism = Padded(kFive, 12);
  prism[9] = 0.5;
  EXPECT_THAT(fault("rational_polynomial", prism),
              HasSubstr("k5, k6 and then zeros, found 0.5 as number 10; calibrate without the thin "
                        "prism"));
  EXPECT_THAT(fault("equidistant", kFive), HasSubstr("found 0.03 as number 5"));
  EXPECT_THAT(fault("equidistant", {}), HasSubstr("expected 'equidistant' of 4 numbers, found 0"));
  EXPECT_THAT(fault("plumb_bob", {0.1, 0.2}), HasSubstr("of at least 4 numbers, found 2"));
  EXPECT_THAT(fault("", kFive), HasSubstr("expected the name of a distortion model"));
  EXPECT_THAT(fault("Inverse Brown Conrady", kFive),
              HasSubstr("found 'Inverse Brown Conrady', whose numbers undo a distortion"));
  EXPECT_THAT(fault("thin_prism", kFive), HasSubstr("found 'thin_prism'"));
}

}  // namespace named_distortion_test
}  // namespace plumbline
