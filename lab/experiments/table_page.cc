// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table_page.h"

#include "plumbline/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #222; background: #fff; margin: 2rem auto;
       max-width: 1500px; padding: 0 1.5rem; }
h1 { font-size: 1.6rem; margin-bottom: 0.2rem; }
h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.87em; font-variant-numeric: tabular-nums; }
th, td { padding: 0.2rem 0.5rem; text-align: left; vertical-align: top; }
thead th { border-bottom: 2px solid #999; font-weight: 600; }
thead th span { display: block; color: #777; font-weight: 400; }
tr.first td, tr.first th { border-top: 1px solid #ccc; }
tbody th { font-weight: 600; }
td.best { background: #e2f2e4; font-weight: 600; }
td .range { display: block; color: #777; font-size: 0.8em; font-weight: 400; white-space: nowrap; }
td.runs { white-space: nowrap; }
td.none { color: #a33; }
p.note, li { color: #555; }
code { background: #f3f3f3; padding: 0 0.25em; }
figure { margin: 0 0 1.5rem; }
figure svg { max-width: 100%; height: auto; }
)";

std::string Cell(const TableRow& row, const TableCell& cell, const Metric& metric) {
  const std::string text = CellText(row, cell, metric);
  const std::string kind = cell.best ? " class=\"best\"" : cell.spread ? "" : " class=\"none\"";
  const auto space = text.find(' ');
  if (!cell.spread || space == std::string::npos) {
    return fmt::format("<td{}>{}</td>", kind, EscapeHtml(text));
  }
  return fmt::format("<td{}>{} <span class=\"range\">{}</span></td>",
                     kind,
                     EscapeHtml(text.substr(0, text[space - 1] == ',' ? space - 1 : space)),
                     EscapeHtml(text.substr(space + 1)));
}

std::string Table(const Plan& plan, const ResultTable& table) {
  std::string html =
      "<div class=\"scroll\"><table>\n<thead><tr><th>sequence</th><th>variant</th><th>runs</th>";
  for (const Metric* metric : table.columns) {
    html += fmt::format("<th title=\"{}\">{} <span>{}</span></th>",
                        EscapeHtml(metric->help),
                        EscapeHtml(metric->name),
                        EscapeHtml(metric->unit));
  }
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const TableRow& row = table.rows[r];
    const bool first = r == 0 || table.rows[r - 1].sequence != row.sequence;
    html += fmt::format("<tr{}><th>{}</th><td>{}</td><td class=\"runs\">{}</td>",
                        first ? " class=\"first\"" : "",
                        first ? EscapeHtml(plan.sequences[row.sequence].name) : "",
                        EscapeHtml(plan.experiment.variants[row.variant].name),
                        RunsText(row));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      html += Cell(row, row.cells[c], *table.columns[c]);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string RatiosOfMetric(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  std::string html = fmt::format(
      "<h2>{}</h2>\n<p class=\"note\">{} {}</p>\n<div class=\"scroll\"><table>\n<thead><tr>"
      "<th>variant</th><th>sequence</th><th>pairs</th><th>ratio</th><th></th><th>left out</th>"
      "<th>lost alone</th></tr></thead>\n<tbody>\n",
      EscapeHtml(RatioTitle(plan, ratios.front().metric)),
      EscapeHtml(RatioNote(plan)),
      ChanceText(plan, ratios));
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const PairedRatio& r = ratios[i];
    const bool first = i == 0 || ratios[i - 1].variant != r.variant;
    html += fmt::format(
        "<tr{}><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></"
        "tr>\n",
        first ? " class=\"first\"" : "",
        first ? EscapeHtml(ComparedName(plan, r.variant)) : "",
        r.sequence ? EscapeHtml(plan.sequences[*r.sequence].name)
                   : fmt::format("<b>all {} places</b>", r.places),
        r.pairs,
        RatioText(r),
        VerdictText(r),
        r.left_out,
        r.lost_alone);
  }
  return html + "</tbody></table></div>\n";
}

// Nothing without ratios.
std::string Ratios(const Plan& plan, const std::vector<PairedRatio>& ratios) {
  std::string html;
  for (const auto& of_metric : ByMetric(ratios)) html += RatiosOfMetric(plan, of_metric);
  return html;
}

// Nothing without starts.
std::string Starts(const Plan& plan, const std::vector<PairedStarts>& starts) {
  if (starts.empty()) return "";
  std::string html = fmt::format(
      "<h2>Starts against {}, start by start</h2>\n<p class=\"note\">{}</p>\n"
      "<div class=\"scroll\"><table>\n<thead>",
      EscapeHtml(plan.experiment.reference),
      PairsNote());
  const auto rows = CellsOfPairs(plan, starts);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    html += "<tr>";
    for (const std::string& cell : rows[r]) {
      const char* kind = r == 0 ? "th" : "td";
      html += fmt::format("<{0}>{1}</{0}>", kind, EscapeHtml(cell));
    }
    html += r == 0 ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string Variants(const Plan& plan) {
  std::string html = "<h2>Variants</h2>\n<ul>\n";
  for (const Variant& variant : plan.experiment.variants) {
    std::vector<std::string> parts = variant.settings;
    parts.insert(parts.end(), variant.arguments.begin(), variant.arguments.end());
    html += fmt::format(
        "<li><b>{}</b>: {}</li>\n",
        EscapeHtml(variant.name),
        parts.empty()
            ? "as it is"
            : "<code>" + EscapeHtml(fmt::format("{}", fmt::join(parts, " "))) + "</code>");
  }
  return html + "</ul>\n";
}

// Failed and missing runs; empty if there are none.
std::string Gaps(const Plan& plan, const ResultTable& table) {
  const std::vector<std::string> failures = FailureTexts(plan, table);
  if (plan.missing.empty() && failures.empty()) return "";
  std::string html = "<h2>What is missing</h2>\n<ul>\n";
  for (const std::string& pattern : plan.missing) {
    html += fmt::format("<li>no sequence {}</li>\n", EscapeHtml(pattern));
  }
  for (const std::string& failure : failures) {
    html += fmt::format("<li>{}</li>\n", EscapeHtml(failure));
  }
  return html + "</ul>\n";
}

std::string Legend(const std::vector<ResultTable>& tables) {
  std::string html = "<h2>Metrics</h2>\n<ul>\n";
  for (const ResultTable& table : tables) {
    for (const Metric* metric : table.columns) {
      html += fmt::format(
          "<li><b>{}</b>: {}</li>\n", EscapeHtml(ColumnTitle(*metric)), EscapeHtml(metric->help));
    }
  }
  return html + "</ul>\n";
}

}  // namespace

std::string_view TablePageStyle() { return kStyle; }

std::string FormatPage(const Plan& plan,
                       const std::vector<ResultTable>& tables,
                       const std::vector<PagePlot>& plots,
                       const Comparisons& against_reference,
                       const PaperComparison& comparison) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>{2}.</p>\n"
      "<p class=\"note\">{3}, below it the range over the runs; runs with the same trajectory "
      "count once. Green: the best on a sequence among the variants that cover as much of "
      "it.</p>\n",
      EscapeHtml(plan.experiment.name),
      kStyle,
      EscapeHtml(plan.experiment.help),
      plan.experiment.tolerated_failures ? "Mean" : "Median");
  for (const ResultTable& table : tables) {
    if (table.columns.empty()) continue;
    html += table.kind == MetricKind::kTiming ? "<h2>Speed</h2>\n" : "<h2>Results</h2>\n";
    html += Table(plan, table);
    if (table.kind == MetricKind::kRepeatable) html += Gaps(plan, table);
  }
  html += FormatComparisonHtml(comparison);
  html += Starts(plan, against_reference.starts) + Ratios(plan, against_reference.ratios);
  html += "<h2>Plots</h2>\n";
  for (const PagePlot& plot : plots) {
    html += fmt::format("<h3>{}</h3>\n<figure>{}</figure>\n", EscapeHtml(plot.metric), plot.svg);
  }
  return html + Variants(plan) + Legend(tables) + "</body>\n</html>\n";
}

}  // namespace plumbline
