// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "simulation/scenarios/rokviss.hpp"

/// What `hirosco report` shows: text for the terminal, a folder with a page and its plots for the browser and the printer.
namespace hirosco::tools {

/// One run as flown and judged.
struct Chapter {
  std::string id;
  std::string title;
  std::string how;
  simulation::Findings findings;
  std::vector<simulation::Row> rows;

  [[nodiscard]] bool holds() const noexcept;
};

/// The rows of a chapter as aligned lines, its problems and notes.
[[nodiscard]] std::string text_of(const Chapter& chapter);
/// Writes FOLDER/index.html and FOLDER/NAME.svg for every plot. SystemFailure: `value` is errno.
[[nodiscard]] Result<> write_page(const std::filesystem::path& folder, const std::string& heading,
                                  const std::string& subtitle, const std::vector<Chapter>& chapters);

}  // namespace hirosco::tools
