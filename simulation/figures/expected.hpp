// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// What a mission must show, and whether it does. The numbers stand in one table file, written from notes and closed
/// forms; nothing here or in the scenarios knows one (decision 35).
namespace hirosco::simulation {

enum class Bound : std::uint8_t { Near, AtMost, AtLeast };

/// One line of the table. Names begin with their run and a hyphen: RO2-17.6mm-force.
struct Expected {
  std::string name{};
  std::string quantity{};
  Bound bound{Bound::Near};
  double value{0};
  double tolerance{0};  ///< of Near
  std::string unit{};
  std::string source{};  ///< the closed form or the note that the value comes from

  [[nodiscard]] bool holds(double measured) const noexcept;  ///< false for NaN
  /// "43.52 ± 0.044", "≤ 3", "≥ 0.5".
  [[nodiscard]] std::string text() const;
};

/// name,quantity,bound,value,tolerance,unit,source; the last cell may contain commas.
class ExpectedTable {
 public:
  /// What is wrong with the file as text: path, line, reason.
  [[nodiscard]] static std::expected<ExpectedTable, std::string> read(const std::filesystem::path& file);
  [[nodiscard]] const Expected* find(std::string_view name) const noexcept;
  /// In the order of the file.
  [[nodiscard]] const std::vector<Expected>& rows() const noexcept { return rows_; }

 private:
  std::vector<Expected> rows_;
};

/// Every figure of a run by name.
using Figures = std::map<std::string, double>;

struct Row {
  Expected expected;
  bool measured{false};
  double value{0};
  bool holds{false};
};

/// The lines of the table whose names begin with `run` and a hyphen, judged. A line that nobody measured does not hold,
/// and a figure without a line comes back with the source "not in the table" and does not hold either.
[[nodiscard]] std::vector<Row> judged(const ExpectedTable& table, std::string_view run, const Figures& figures);

}  // namespace hirosco::simulation
