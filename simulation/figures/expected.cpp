// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/figures/expected.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr std::string_view header = "name,quantity,bound,value,tolerance,unit,source";
constexpr std::size_t cells_of_a_line = 7;

using Cells = std::array<std::string, cells_of_a_line>;

std::optional<Cells> cells_of(std::string_view line) {
  Cells cells;
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    const auto comma = line.find(',');
    if (comma == line.npos) return std::nullopt;
    cells[i] = line.substr(0, comma);
    line.remove_prefix(comma + 1);
  }
  cells.back() = line;
  return cells;
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The line as a row, or what is wrong with it.
std::expected<Expected, std::string> row_of(std::string_view line) {
  const auto cells = cells_of(line);
  if (!cells) return std::unexpected{fmt::format("{} cells wanted", cells_of_a_line)};
  const auto& [name, quantity, bound, value, tolerance, unit, source] = *cells;
  Expected row{.name = name, .quantity = quantity, .unit = unit, .source = source};
  if (bound == "near") row.bound = Bound::Near;
  else if (bound == "at most") row.bound = Bound::AtMost;
  else if (bound == "at least") row.bound = Bound::AtLeast;
  else return std::unexpected{fmt::format("'{}' is not near, at most or at least", bound)};
  const auto number = number_of(value);
  if (!number) return std::unexpected{fmt::format("value '{}' is no number", value)};
  row.value = *number;
  if (row.bound == Bound::Near) {
    const auto width = number_of(tolerance);
    if (!width || *width < 0) return std::unexpected{fmt::format("tolerance '{}' is none", tolerance)};
    row.tolerance = *width;
  } else if (!tolerance.empty()) {
    return std::unexpected{"a limit has no tolerance"};
  }
  if (source.empty()) return std::unexpected{"where the value comes from is missing"};
  return row;
}

}  // namespace

bool Expected::holds(double measured) const noexcept {
  switch (bound) {
    case Bound::Near: return std::abs(measured - value) <= tolerance;
    case Bound::AtMost: return measured <= value;
    case Bound::AtLeast: return measured >= value;
  }
  return false;
}

std::string Expected::text() const {
  switch (bound) {
    case Bound::Near:
      return tolerance == 0 ? fmt::format("{:g}", value) : fmt::format("{:g} ± {:.2g}", value, tolerance);
    case Bound::AtMost: return fmt::format("≤ {:g}", value);
    case Bound::AtLeast: return fmt::format("≥ {:g}", value);
  }
  return {};
}

std::expected<ExpectedTable, std::string> ExpectedTable::read(const std::filesystem::path& file) {
  std::ifstream lines{file};
  std::string line;
  if (!std::getline(lines, line)) return std::unexpected{fmt::format("{}: cannot be read", file.string())};
  if (line != header) return std::unexpected{fmt::format("{}:1: the first line must be {}", file.string(), header)};
  ExpectedTable table;
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    auto row = row_of(line);
    if (row && table.find(row->name) != nullptr) row = std::unexpected{"the name stands there twice"};
    if (!row) return std::unexpected{fmt::format("{}:{}: {}", file.string(), number, row.error())};
    table.rows_.push_back(std::move(*row));
  }
  return table;
}

const Expected* ExpectedTable::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(rows_, name, &Expected::name);
  return found != rows_.end() ? &*found : nullptr;
}

std::vector<Row> judged(const ExpectedTable& table, std::string_view run, const Figures& figures) {
  std::vector<Row> rows;
  const std::string prefix = std::string{run} + '-';
  for (const Expected& expected : table.rows()) {
    if (!expected.name.starts_with(prefix)) continue;
    const auto figure = figures.find(expected.name);
    Row row{.expected = expected, .measured = figure != figures.end()};
    if (row.measured) row.value = figure->second;
    row.holds = row.measured && expected.holds(row.value);
    rows.push_back(std::move(row));
  }
  for (const auto& [name, value] : figures)
    if (table.find(name) == nullptr)
      rows.push_back({.expected = {.name = name, .source = "not in the table"}, .measured = true, .value = value});
  return rows;
}

}  // namespace hirosco::simulation
