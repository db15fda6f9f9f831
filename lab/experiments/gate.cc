// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/gate.h"

#include "lab/experiments/catalog.h"
#include "lab/experiments/mean.h"
#include "lab/experiments/metrics.h"
#include "plumbline/base/error.h"
#include "plumbline/base/yaml_document.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

constexpr std::array<std::string_view, 8> kKeys = {
    "experiment", "sequence", "variant", "metric", "unit", "at_most", "at_least", "of"};

class LimitReader {
 public:
  LimitReader(const char* file, const YAML::Node& node) : file_(file), node_(node) {}

  GateLimit Read() const {
    if (!node_.IsMap()) Fail("expected a group of keys");
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) Fail("unknown key " + key);
    }
    GateLimit limit{Text("experiment"),
                    Text("sequence"),
                    Text("variant"),
                    Text("metric"),
                    Text("unit"),
                    Number("at_most"),
                    Number("at_least"),
                    IsOfMean()};
    if (limit.at_most.has_value() == limit.at_least.has_value()) {
      Fail("expected one of at_most and at_least");
    }
    Check(limit);
    return limit;
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", file_, node_.Mark().line + 1, message));
  }

  std::string Text(const char* key) const {
    if (!node_[key] || !node_[key].IsScalar()) Fail(fmt::format("expected {}: and a word", key));
    return node_[key].as<std::string>();
  }

  std::optional<double> Number(const char* key) const {
    if (!node_[key]) return std::nullopt;
    const auto number = ParseNumber(Text(key));
    if (!number) Fail(fmt::format("{}: expected a number", key));
    return number;
  }

  bool IsOfMean() const {
    if (!node_["of"]) return false;
    const std::string word = Text("of");
    if (word != "mean" && word != "worst") Fail("of: expected mean or worst, found " + word);
    return word == "mean";
  }

  void Check(const GateLimit& limit) const {
    const Metric* metric = FindMetric(limit.metric);
    if (metric == nullptr) Fail("no metric is called " + limit.metric);
    if (metric->unit != limit.unit) {
      Fail(fmt::format("{}: expected the unit {}", limit.metric, metric->unit));
    }
    const auto& variants = FindExperiment(limit.experiment).variants;
    const bool known = std::any_of(variants.begin(), variants.end(), [&](const Variant& v) {
      return v.name == limit.variant;
    });
    if (!known) Fail(limit.experiment + " has no variant " + limit.variant);
  }

  const char* file_;
  YAML::Node node_;
};

bool IsWithin(const GateLimit& limit, double value) {
  return limit.at_most ? value <= *limit.at_most : value >= *limit.at_least;
}

// The figure of a run, or the reason if there is none.
Expected<double, std::string> FigureOf(const JobResult& result, const std::string& metric) {
  if (!result.figures) return result.reason;
  const auto value = result.figures->values.find(metric);
  if (value != result.figures->values.end()) return value->second;
  const auto reason = result.figures->reasons.find(metric);
  return reason == result.figures->reasons.end() ? "not measured" : reason->second;
}

// The value compared with a limit.
double Summary(const GateLimit& limit, const std::vector<double>& figures) {
  if (limit.of_mean) return Mean(figures);
  const auto [least, most] = std::minmax_element(figures.begin(), figures.end());
  return limit.at_most ? *most : *least;
}

// A limit and the runs that it is about.
GateCheck CheckLimit(const GateLimit& limit, const std::vector<const JobResult*>& runs) {
  GateCheck check{limit, std::nullopt, "", false};
  std::vector<double> figures;
  for (const JobResult* run : runs) {
    const auto figure = FigureOf(*run, limit.metric);
    if (figure) {
      figures.push_back(*figure);
    } else {
      check.reason = figure.error();
    }
  }
  if (figures.empty()) return check;
  check.figure = Summary(limit, figures);
  check.kept = check.reason.empty() && IsWithin(limit, *check.figure);
  return check;
}

std::string LineOf(const GateCheck& check) {
  const GateLimit& limit = check.limit;
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} |\n",
      check.kept ? "kept" : "**broken**",
      limit.sequence,
      limit.variant,
      (limit.of_mean ? "mean " : "") +
          (limit.unit.empty() ? limit.metric : fmt::format("{} [{}]", limit.metric, limit.unit)),
      check.reason.empty() && check.figure ? fmt::format("{:.4g}", *check.figure) : check.reason,
      limit.at_most ? fmt::format("at most {:g}", *limit.at_most)
                    : fmt::format("at least {:g}", *limit.at_least));
}

}  // namespace

std::vector<GateLimit> ParseGateLimits(const EmbeddedYaml& file) {
  const YAML::Node root = ParseYaml(file.text, file.name);
  if (!root.IsSequence()) throw InputError(std::string(file.name) + ": expected a list of limits");
  std::vector<GateLimit> limits;
  for (const YAML::Node& node : root) limits.push_back(LimitReader(file.name, node).Read());
  return limits;
}

std::vector<GateLimit> GateLimitsOf(const std::string& experiment) {
  std::vector<GateLimit> limits = ParseGateLimits(GateLimitsFile());
  std::erase_if(limits, [&](const GateLimit& limit) { return limit.experiment != experiment; });
  return limits;
}

std::vector<GateCheck> CheckGate(const std::vector<GateLimit>& limits,
                                 const Plan& plan,
                                 const std::vector<JobResult>& results) {
  std::vector<GateCheck> checks;
  for (const GateLimit& limit : limits) {
    std::vector<const JobResult*> runs;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
      const Job& job = plan.jobs[i];
      if (plan.SequenceOf(job).name == limit.sequence &&
          plan.VariantOf(job).name == limit.variant) {
        runs.push_back(&results[i]);
      }
    }
    if (!runs.empty()) checks.push_back(CheckLimit(limit, runs));
  }
  std::stable_partition(
      checks.begin(), checks.end(), [](const GateCheck& check) { return !check.kept; });
  return checks;
}

std::string FormatGate(const std::vector<GateCheck>& checks) {
  if (checks.empty()) return "";
  std::string text =
      "\n## Limits\n\n| | sequence | variant | metric | figure | limit "
      "|\n|---|---|---|---|---|---|\n";
  for (const GateCheck& check : checks) text += LineOf(check);
  return text;
}

}  // namespace plumbline
