// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/yaml_section.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/yaml_document.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

// Turns the text of a file written for OpenCV's FileStorage into YAML, line for line. The first
// line of such a file is no valid directive, and the blank after a colon may be missing
// (`data:[1, 2]`).
std::string FromOpenCvDialect(std::string_view text) {
  const auto in_key = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  std::string yaml;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (line.starts_with("%YAML:")) {
      yaml += "#";
      yaml += line.substr(1);
      continue;
    }
    std::size_t at = std::min(line.find_first_not_of(" -"), line.size());
    while (at < line.size() && in_key(static_cast<unsigned char>(line[at]))) ++at;
    const bool glued = at > 0 && at + 1 < line.size() && line[at] == ':' &&
                       in_key(static_cast<unsigned char>(line[at - 1])) &&
                       std::isspace(static_cast<unsigned char>(line[at + 1])) == 0;
    if (glued) {
      yaml += line.substr(0, at + 1);
      yaml += ' ';
      yaml += line.substr(at + 1);
    } else {
      yaml += line;
    }
  }
  return yaml;
}

bool IsOpenCvDialect(std::string_view text) {
  return text.starts_with("%YAML:") || text.find("\n%YAML:") != std::string_view::npos;
}

// Returns how far a matrix is from a rotation; more than 1 for a reflection.
double OffRotation(const Eigen::Matrix3d& m) {
  const double off = (m * m.transpose() - Eigen::Matrix3d::Identity()).norm();
  return m.determinant() < 0 ? off + 1 : off;
}

constexpr double kMaxOffRotation = 1e-3;

}  // namespace

struct YamlSection::Place {
  YAML::Node node;
  std::string source;
  std::string prefix;  // dotted name of the group, with a dot at the end

  [[noreturn]] void Fail(const YAML::Node& at,
                         const std::string& key,
                         const std::string& message) const {
    throw InputError(fmt::format("{}: {}{}: {}", Where(at), prefix, key, message));
  }

  std::string Where(const YAML::Node& at) const {
    const int line = at.IsDefined() ? at.Mark().line : node.Mark().line;
    return fmt::format("{}:{}", source, line + 1);
  }

  // What is at a key in place of a group or a list, for messages.
  static std::string FoundAt(const YAML::Node& value) {
    if (!value.IsDefined()) return "none";
    if (value.IsScalar()) return InQuotes(value.Scalar());
    return value.IsSequence() ? "a list" : value.IsMap() ? "a group of keys" : "nothing";
  }

  std::string Scalar(const std::string& key, const YAML::Node& value) const {
    if (!value.IsScalar()) Fail(value, key, "expected one value, found a list or a group");
    return value.Scalar();
  }

  // Appends the numbers of a list.
  void AppendNumbers(const std::string& key,
                     const YAML::Node& list,
                     const std::string& expected,
                     std::vector<double>& numbers) const {
    for (const YAML::Node& item : list) {
      const std::string text = Scalar(key, item);
      const std::optional<double> value = ParseNumber(text);
      if (!value) Fail(item, key, expected + ", found " + InQuotes(text));
      numbers.push_back(*value);
    }
  }
};

YamlSection YamlSection::Parse(const std::string& yaml, const std::string& source) {
  const YAML::Node node = ParseYaml(IsOpenCvDialect(yaml) ? FromOpenCvDialect(yaml) : yaml, source);
  if (!node.IsMap()) {
    const char* found = node.IsSequence() ? "a list" : node.IsScalar() ? "a text" : "nothing";
    throw InputError(fmt::format("{}:1: expected 'key: value' rows, found {}", source, found));
  }
  return YamlSection(std::make_shared<const Place>(Place{node, source, ""}));
}

bool YamlSection::Has(const std::string& key) const { return place_->node[key].IsDefined(); }

bool YamlSection::IsGroup(const std::string& key) const {
  return Has(key) && place_->node[key].IsMap();
}

void YamlSection::Fail(const std::string& key, const std::string& message) const {
  place_->Fail(place_->node[key], key, message);
}

std::string YamlSection::Where(const std::string& key) const {
  return place_->Where(place_->node[key]);
}

YamlSection YamlSection::Child(const std::string& key) const {
  if (!IsGroup(key)) {
    Fail(key, "expected a group of keys, found " + Place::FoundAt(place_->node[key]));
  }
  return YamlSection(std::make_shared<const Place>(
      Place{place_->node[key], place_->source, place_->prefix + key + "."}));
}

std::vector<YamlSection> YamlSection::Items(const std::string& key) const {
  const YAML::Node list = place_->node[key];
  if (!list.IsDefined() || !list.IsSequence()) {
    Fail(key, "expected a list of groups, found " + Place::FoundAt(list));
  }
  std::vector<YamlSection> items;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = fmt::format("{}[{}]", key, i);
    if (!list[i].IsMap()) place_->Fail(list[i], name, "expected a group of keys");
    items.push_back(YamlSection(std::make_shared<const Place>(
        Place{list[i], place_->source, place_->prefix + name + "."})));
  }
  return items;
}

std::vector<std::string> YamlSection::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : place_->node) {
    keys.push_back(entry.first.IsScalar() ? entry.first.Scalar() : "[...]");
  }
  return keys;
}

std::string YamlSection::Text(const std::string& key) const {
  if (!Has(key)) Fail(key, "expected a value, found none");
  return place_->Scalar(key, place_->node[key]);
}

std::vector<std::string> YamlSection::Texts(const std::string& key) const {
  const YAML::Node list = place_->node[key];
  if (!list.IsDefined() || !list.IsSequence()) {
    Fail(key, "expected a list, found " + Place::FoundAt(list));
  }
  std::vector<std::string> texts;
  for (const YAML::Node& item : list) texts.push_back(place_->Scalar(key, item));
  return texts;
}

bool YamlSection::Bool(const std::string& key) const {
  const std::string text = Text(key);
  if (text != "true" && text != "false")
    Fail(key, "expected true or false, found " + Printable(text));
  return text == "true";
}

double YamlSection::Number(const std::string& key) const {
  const std::string text = Text(key);
  const std::optional<double> value = ParseNumber(text);
  if (!value) Fail(key, "expected a number, found " + InQuotes(text));
  return *value;
}

double YamlSection::Positive(const std::string& key) const {
  const std::string text = Text(key);
  const std::optional<double> value = ParseNumber(text);
  if (!value || *value <= 0) Fail(key, "expected a number above 0, found " + InQuotes(text));
  return *value;
}

std::vector<double> YamlSection::Numbers(const std::string& key,
                                         const std::vector<std::size_t>& counts) const {
  const std::string expected = fmt::format("expected {} numbers", fmt::join(counts, " or "));
  const YAML::Node list = place_->node[key];
  if (!list.IsDefined() || !list.IsSequence()) Fail(key, expected + ", found no list");
  std::vector<double> numbers;
  place_->AppendNumbers(key, list, expected, numbers);
  if (std::find(counts.begin(), counts.end(), numbers.size()) == counts.end()) {
    Fail(key, fmt::format("{}, found {}", expected, numbers.size()));
  }
  return numbers;
}

Eigen::MatrixXd YamlSection::Matrix(const std::string& key, int rows, int cols) const {
  const YAML::Node value = place_->node[key];
  if (value.IsDefined() && value.IsMap()) {
    const YamlSection group = Child(key);
    for (const auto& [name, size] : {std::pair{"rows", rows}, std::pair{"cols", cols}}) {
      if (group.Has(name) && group.Number(name) != size) {
        group.Fail(name, fmt::format("expected {}, found {}", size, Printable(group.Text(name))));
      }
    }
    return group.Matrix("data", rows, cols);
  }
  std::vector<double> numbers;
  const bool nested =
      value.IsDefined() && value.IsSequence() && value.size() > 0 && value[0].IsSequence();
  if (nested) {
    const std::string expected = fmt::format("expected {} rows of {} numbers", rows, cols);
    const auto whole = static_cast<std::size_t>(cols);
    if (value.size() != static_cast<std::size_t>(rows)) {
      Fail(key, fmt::format("{}, found {} rows", expected, value.size()));
    }
    for (const YAML::Node& row : value) {
      if (!row.IsSequence() || row.size() != whole) {
        place_->Fail(row, key, fmt::format("{}, found a row of {}", expected, row.size()));
      }
      place_->AppendNumbers(key, row, expected, numbers);
    }
  } else {
    numbers = Numbers(key, {static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)});
  }
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      numbers.data(), rows, cols);
}

Rigid3 YamlSection::Motion(const std::string& key, int rows) const {
  const Eigen::MatrixXd matrix = Matrix(key, rows, 4);
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool whole = rows == 3 || matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  const double off = OffRotation(rotation);
  if (!(off <= kMaxOffRotation) || !whole) {
    Fail(key,
         fmt::format("expected a rigid motion (rotation, translation{}), found {}",
                     rows == 3 ? "" : ", last row 0 0 0 1",
                     whole ? fmt::format("a matrix {:.3g} off a rotation", off)
                           : fmt::format("the last row {:g} {:g} {:g} {:g}",
                                         matrix(3, 0),
                                         matrix(3, 1),
                                         matrix(3, 2),
                                         matrix(3, 3))));
  }
  return {Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner(3, 1)};
}

Eigen::Quaterniond YamlSection::Rotation(const std::string& key) const {
  const Eigen::Matrix3d rotation = Matrix(key, 3, 3);
  if (!(OffRotation(rotation) <= kMaxOffRotation)) Fail(key, "expected a rotation matrix");
  return Eigen::Quaterniond(rotation).normalized();
}

void YamlSection::RejectUnknown(const std::vector<std::string>& known) const {
  constexpr std::size_t kShortest = 4;  // letters of a beginning that tells a key
  for (const auto& entry : place_->node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "[...]";
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const auto whole = std::find_if(known.begin(), known.end(), [&key](const std::string& name) {
      return key.size() >= kShortest && name.starts_with(key);
    });
    const auto nearest = whole != known.end() ? std::optional(*whole) : NearestName(key, known);
    throw InputError(fmt::format("{}:{}: unknown key {}{}",
                                 place_->source,
                                 entry.first.Mark().line + 1,
                                 InQuotes(place_->prefix + key),
                                 nearest ? "; did you mean '" + *nearest + "'?" : ""));
  }
}

}  // namespace plumbline
