// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/figure_page.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

struct Section {
  std::string name;
  std::vector<std::string> metrics;
  std::vector<std::pair<std::string, std::string>> rows;  // sequence, variant
  std::map<std::pair<std::pair<std::string, std::string>, std::string>, std::string> cells;
};

template <class T>
void AddOnce(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

const FigureMetric& Find(std::span<const FigureMetric> metrics, const std::string& name) {
  const auto found = std::find_if(
      metrics.begin(), metrics.end(), [&](const FigureMetric& m) { return m.name == name; });
  PLUMBLINE_CHECK(found != metrics.end(), "no metric is called " + name);
  return *found;
}

std::vector<Section> Sections(std::span<const FigureRow> rows,
                              std::span<const FigureMetric> metrics) {
  std::vector<Section> sections;
  for (const FigureRow& row : rows) {
    const std::string name = row.sequence.substr(0, row.sequence.find('/'));
    auto section = std::find_if(
        sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
    if (section == sections.end()) section = sections.insert(sections.end(), {name, {}, {}, {}});
    const auto key = std::pair(row.sequence, row.variant);
    AddOnce(section->metrics, row.metric);
    AddOnce(section->rows, key);
    section->cells[{key, row.metric}] =
        row.value ? fmt::format("{:.{}f}", *row.value, Find(metrics, row.metric).digits) : "-";
  }
  return sections;
}

std::string CellOf(const Section& section,
                   const std::pair<std::string, std::string>& row,
                   const std::string& metric) {
  const auto cell = section.cells.find({row, metric});
  return cell == section.cells.end() ? "" : cell->second;
}

std::string TitleOf(const FigureMetric& metric) {
  return metric.unit.empty() ? std::string(metric.name)
                             : fmt::format("{} [{}]", metric.name, metric.unit);
}

std::string HtmlTable(const Section& section, std::span<const FigureMetric> metrics) {
  std::string html =
      fmt::format("<h2>{}</h2>\n<table>\n<thead><tr><th>sequence</th><th>variant</th>",
                  EscapeHtml(section.name));
  for (const std::string& metric : section.metrics) {
    html += fmt::format("<th>{}</th>", EscapeHtml(TitleOf(Find(metrics, metric))));
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& key : section.rows) {
    html +=
        fmt::format("<tr><th>{}</th><td>{}</td>", EscapeHtml(key.first), EscapeHtml(key.second));
    for (const std::string& metric : section.metrics) {
      html += fmt::format("<td>{}</td>", CellOf(section, key, metric));
    }
    html += "</tr>\n";
  }
  html += "</tbody></table>\n";
  return html;
}

}  // namespace

std::string FormatFigureMarkdown(const std::string& title,
                                 const std::string& help,
                                 std::span<const FigureRow> rows,
                                 std::span<const FigureMetric> metrics) {
  std::string text = fmt::format("# {}\n\n{}.\n", title, help);
  for (const Section& section : Sections(rows, metrics)) {
    text += fmt::format("\n## {}\n\n| sequence | variant |", section.name);
    std::string rule = "|---|---|";
    for (const std::string& metric : section.metrics) {
      text += fmt::format(" {} |", TitleOf(Find(metrics, metric)));
      rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const auto& key : section.rows) {
      text += fmt::format("| {} | {} |", key.first, key.second);
      for (const std::string& metric : section.metrics) {
        text += fmt::format(" {} |", CellOf(section, key, metric));
      }
      text += "\n";
    }
  }
  text += "\n## Metrics\n\n";
  for (const FigureMetric& metric : metrics) {
    text += fmt::format("- **{}**: {}\n", TitleOf(metric), metric.help);
  }
  return text;
}

std::string FormatFigurePage(const std::string& title,
                             const std::string& help,
                             std::span<const FigureRow> rows,
                             std::span<const FigureMetric> metrics,
                             std::span<const PagePlot> plots,
                             const PaperComparison& comparison) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>{2}.</p>\n<h2>Plots</h2>\n",
      EscapeHtml(title),
      TablePageStyle(),
      EscapeHtml(help));
  for (const PagePlot& plot : plots) {
    html += fmt::format("<h3>{}</h3>\n<figure>{}</figure>\n", EscapeHtml(plot.metric), plot.svg);
  }
  html += FormatComparisonHtml(comparison);
  for (const Section& section : Sections(rows, metrics)) html += HtmlTable(section, metrics);
  html += "<h2>Metrics</h2>\n<ul>\n";
  for (const FigureMetric& metric : metrics) {
    html += fmt::format("<li><b>{}</b>: {}</li>\n",
                        EscapeHtml(TitleOf(metric)),
                        EscapeHtml(std::string(metric.help)));
  }
  return html + "</ul>\n</body>\n</html>\n";
}

}  // namespace plumbline
