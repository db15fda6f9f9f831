// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A group of keys of a YAML file that knows its place, for messages. All members that read a value
// throw InputError "source:line: key: expected ..., found ..." when it is missing or of another
// kind.
class YamlSection {
 public:
  // The whole file. Files in the dialect of OpenCV's FileStorage (first line `%YAML:1.0`, values
  // right after the colon) are read as well. InputError when it is not YAML or not a group of keys.
  static YamlSection Parse(const std::string& yaml, const std::string& source);

  bool Has(const std::string& key) const;
  [[noreturn]] void Fail(const std::string& key, const std::string& message) const;
  // The line of a key that is there: "source:line".
  std::string Where(const std::string& key) const;

  YamlSection Child(const std::string& key) const;
  // The groups of a list of groups, in the order of the file; messages call them key[0], key[1],
  // ...
  std::vector<YamlSection> Items(const std::string& key) const;
  // The keys of this group, in the order of the file.
  std::vector<std::string> Keys() const;
  std::string Text(const std::string& key) const;
  bool Bool(const std::string& key) const;
  double Number(const std::string& key) const;
  double Positive(const std::string& key) const;
  // A list of as many numbers as one of `counts` says.
  std::vector<double> Numbers(const std::string& key, const std::vector<std::size_t>& counts) const;
  // A matrix: its numbers row by row in one list, a list of rows, or a group with `data` (and
  // `rows`, `cols`) as OpenCV and EuRoC write it.
  Eigen::MatrixXd Matrix(const std::string& key, int rows, int cols) const;
  // A rigid motion as a 4x4 matrix, or 3x4 where rows = 3. The rotation may be off by 1e-3, as
  // files with few decimals are, and is made exact.
  Rigid3 Motion(const std::string& key, int rows = 4) const;
  Eigen::Quaterniond Rotation(const std::string& key) const;

  // InputError naming the nearest known key when there is one that is not known.
  void RejectUnknown(const std::vector<std::string>& known) const;

 private:
  struct Place;  // keeps the YAML library out of this header
  explicit YamlSection(std::shared_ptr<const Place> place) : place_(std::move(place)) {}

  std::shared_ptr<const Place> place_;
};

}  // namespace plumbline
