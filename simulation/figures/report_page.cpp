// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/figures/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "hirosco/xml/escaped.hpp"

namespace hirosco::simulation {
namespace {

using xml::escaped;

constexpr std::string_view style = R"(
body { font: 15px/1.5 Helvetica, Arial, sans-serif; color: #1c1c1c; max-width: 1060px; margin: 2em auto; padding: 0 1.2em; }
h1 { margin-bottom: 0; } h2 { margin-top: 2.2em; border-bottom: 1px solid #bbb; } .sub, .how, figcaption { color: #555; }
table { border-collapse: collapse; width: 100%; font-size: 13px; }
th, td { text-align: left; padding: 3px 8px; border-bottom: 1px solid #ddd; vertical-align: top; }
td:first-child { white-space: nowrap; }
td.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; } td.source { color: #555; }
.holds { color: #1a6b3c; } .fails { color: #a11212; font-weight: bold; }
figure { margin: 1.2em 0; break-inside: avoid; } img { max-width: 100%; border: 1px solid #ddd; }
@media print { body { margin: 0; max-width: none; font-size: 11px; } h2 { break-after: avoid; } tr { break-inside: avoid; } }
)";

[[nodiscard]] std::string value_of(const Row& row) {
  return row.measured ? fmt::format("{:.6g}", row.value) : "nothing";
}
[[nodiscard]] std::string_view verdict_of(const Row& row) { return row.holds ? "holds" : "FAILS"; }
[[nodiscard]] std::string unit_of(const Row& row) { return row.expected.unit == "1" ? "" : row.expected.unit; }

[[nodiscard]] std::string rows_of(const Chapter& chapter) {
  std::string text =
      "<table>\n<tr><th>figure</th><th>what</th><th>expected</th><th>measured</th><th>unit</th><th>verdict</th>"
      "<th>expected value from</th></tr>\n";
  for (const Row& row : chapter.rows)
    text += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"{}\">{}</td>"
        "<td class=\"source\">{}</td></tr>\n",
        escaped(row.expected.name), escaped(row.expected.quantity), row.expected.text(), value_of(row),
        escaped(unit_of(row)), row.holds ? "holds" : "fails", verdict_of(row), escaped(row.expected.source));
  return text + "</table>\n";
}

[[nodiscard]] std::string section_of(const Chapter& chapter) {
  std::string text = fmt::format("<h2 id=\"{0}\">{0} {1}</h2>\n<p class=\"how\">{2}</p>\n", escaped(chapter.id),
                                 escaped(chapter.title), escaped(chapter.how));
  for (const std::string& problem : chapter.findings.problems)
    text += fmt::format("<p class=\"fails\">{}</p>\n", escaped(problem));
  text += rows_of(chapter);
  for (const std::string& note : chapter.findings.notes) text += fmt::format("<p>{}</p>\n", escaped(note));
  for (const auto& plot : chapter.findings.plots)
    text += fmt::format("<figure><img src=\"{0}.svg\" alt=\"{1}\"><figcaption>{2}</figcaption></figure>\n",
                        escaped(plot.name), escaped(plot.title), escaped(plot.caption));
  return text;
}

[[nodiscard]] std::string summary_of(const std::vector<Chapter>& chapters) {
  std::string text = "<table>\n<tr><th>run</th><th>what</th><th>figures that hold</th><th>verdict</th></tr>\n";
  for (const Chapter& chapter : chapters)
    text += fmt::format(
        "<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td>{2} of {3}</td><td class=\"{4}\">{5}</td></tr>\n",
        escaped(chapter.id), escaped(chapter.title), std::ranges::count(chapter.rows, true, &Row::holds),
        chapter.rows.size(), chapter.holds() ? "holds" : "fails", chapter.holds() ? "holds" : "FAILS");
  return text + "</table>\n";
}

[[nodiscard]] Result<> write(const std::filesystem::path& file, std::string_view text) {
  std::ofstream out{file, std::ios::binary | std::ios::trunc};
  out << text;
  out.close();
  if (!out) return fail(ErrorCode::SystemFailure, "a file of the report cannot be written", errno);
  return ok();
}

}  // namespace

bool Chapter::holds() const noexcept { return findings.problems.empty() && std::ranges::all_of(rows, &Row::holds); }

std::string text_of(const Chapter& chapter) {
  std::string text = fmt::format("\n{} {}: {}\n", chapter.id, chapter.title, chapter.how);
  for (const Row& row : chapter.rows)
    text += fmt::format("  {:32} {:>22} {:>14} {:8} {}\n", row.expected.name, row.expected.text(), value_of(row),
                        unit_of(row), verdict_of(row));
  for (const std::string& problem : chapter.findings.problems) text += fmt::format("  PROBLEM: {}\n", problem);
  for (const std::string& note : chapter.findings.notes) text += fmt::format("  {}\n", note);
  return text;
}

std::string verdict_line(const std::vector<Chapter>& chapters) {
  std::size_t rows = 0, holding = 0;
  std::string failing;
  for (const Chapter& chapter : chapters)
    for (const Row& row : chapter.rows) {
      ++rows;
      if (row.holds) ++holding;
      else failing += " " + row.expected.name;
    }
  return fmt::format("\n{} of {} figures hold{}{}\n", holding, rows, failing.empty() ? "" : "; these do not:", failing);
}

Result<> write_page(const std::filesystem::path& folder, const std::string& heading, const std::string& subtitle,
                    const std::vector<Chapter>& chapters) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return fail(ErrorCode::SystemFailure, "the folder of the report cannot be made", failed.value());
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
      "<p class=\"sub\">{2}</p>\n",
      escaped(heading), style, escaped(subtitle));
  page += summary_of(chapters);
  for (const Chapter& chapter : chapters) {
    page += section_of(chapter);
    for (const auto& plot : chapter.findings.plots) HIROSCO_TRY(write(folder / (plot.name + ".svg"), svg_of(plot)));
  }
  return write(folder / "index.html", page + "</body>\n</html>\n");
}

}  // namespace hirosco::simulation
