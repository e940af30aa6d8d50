// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "simulation/figures/expected.hpp"
#include "simulation/figures/plot.hpp"

/// What a report on a mission shows: text for the terminal, a folder with a page and its plots for the browser and the printer.
namespace hirosco::simulation {

/// What a run found: figures by the names of the table, plots, and what a reader ought to know besides.
struct Findings {
  Figures figures{};
  std::vector<Plot> plots{};
  std::vector<std::string> notes{};
  std::vector<std::string> problems{};  ///< why it shows nothing, or less than it should
};

/// One run as flown and judged.
struct Chapter {
  std::string id;
  std::string title;
  std::string how;
  Findings findings;
  std::vector<Row> rows;

  [[nodiscard]] bool holds() const noexcept;
};

/// The rows of a chapter as aligned lines, its problems and notes.
[[nodiscard]] std::string text_of(const Chapter& chapter);
/// How many of all rows hold and the names of those that do not, as a line of its own.
[[nodiscard]] std::string verdict_line(const std::vector<Chapter>& chapters);
/// Writes FOLDER/index.html and FOLDER/NAME.svg for every plot. SystemFailure: `value` is errno.
[[nodiscard]] Result<> write_page(const std::filesystem::path& folder, const std::string& heading,
                                  const std::string& subtitle, const std::vector<Chapter>& chapters);

}  // namespace hirosco::simulation
