// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hirosco::servicer {

/// `hirosco report servicer`.
struct ReportOptions {
  std::filesystem::path mission;  ///< its file
  std::string out;  ///< folder of the page and its plots; empty = none
  std::uint64_t seed{1};
  std::vector<std::string> only;  ///< ids of runs; empty = all
};
int report(const ReportOptions& options);

}  // namespace hirosco::servicer
