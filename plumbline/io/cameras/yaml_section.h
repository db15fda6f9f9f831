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

// A group of keys of a YAML file with its path, for messages. All members that read a value throw
// InputError "source:line: key: expected ..., found ..." if it is missing or of another kind.
class YamlSection {
 public:
  // Reads the whole file. Files in the dialect of OpenCV's FileStorage (first line `%YAML:1.0`,
  // values right after the colon) are read as well. Throws InputError if it is not YAML or not a
  // group of keys.
  static YamlSection Parse(const std::string& yaml, const std::string& source);

  bool Has(const std::string& key) const;
  // Returns true if the value of a key is a group of keys.
  bool IsGroup(const std::string& key) const;
  [[noreturn]] void Fail(const std::string& key, const std::string& message) const;
  // Returns the line of an existing key as "source:line".
  std::string Where(const std::string& key) const;

  YamlSection Child(const std::string& key) const;
  // Returns the groups of a list of groups, in the order of the file; messages call them key[0],
  // key[1], ...
  std::vector<YamlSection> Items(const std::string& key) const;
  // Returns the keys of this group, in the order of the file.
  std::vector<std::string> Keys() const;
  std::string Text(const std::string& key) const;
  // Returns a list of texts.
  std::vector<std::string> Texts(const std::string& key) const;
  bool Bool(const std::string& key) const;
  double Number(const std::string& key) const;
  double Positive(const std::string& key) const;
  // Returns a list of numbers, whose length must be one of `counts`.
  std::vector<double> Numbers(const std::string& key, const std::vector<std::size_t>& counts) const;
  // Returns a matrix, given as its numbers row by row in one list, as a list of rows, or as a group
  // with `data` (and `rows`, `cols`) as in files of OpenCV and EuRoC.
  Eigen::MatrixXd Matrix(const std::string& key, int rows, int cols) const;
  // Returns a rigid motion given as a 4x4 matrix, or 3x4 if rows = 3. The rotation may be off by
  // 1e-3, as in files with few decimals, and is made exact.
  Rigid3 Motion(const std::string& key, int rows = 4) const;
  Eigen::Quaterniond Rotation(const std::string& key) const;

  // Throws InputError naming the nearest known key, or the first that begins so, if the group has
  // an unknown key.
  void RejectUnknown(const std::vector<std::string>& known) const;

 private:
  struct Place;  // keeps the YAML library out of this header
  explicit YamlSection(std::shared_ptr<const Place> place) : place_(std::move(place)) {}

  std::shared_ptr<const Place> place_;
};

}  // namespace plumbline
