// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hirosco/utilities/time.hpp"

namespace hirosco::rokviss {

/// `hirosco report rokviss`.
struct ReportOptions {
  std::filesystem::path mission;     ///< its file
  std::string out;                   ///< folder of the page and its plots; empty = none
  std::uint64_t seed{1};
  std::vector<std::string> only;     ///< ids of runs; empty = those that a report has by default
  std::vector<std::string> plant;    ///< "NAME=FACTOR": errors put into the model on purpose
  int repetitions{20};               ///< of each fault
  bool convergence{false};           ///< each run a second time with sub-steps half as long
  bool corners{false};               ///< instead of the runs every corner of the ranges that the mission declares
  bool real{false};                  ///< on real processes, for `real_for`
  Duration real_for{std::chrono::minutes{5}};
};
int report(const ReportOptions& options);

}  // namespace hirosco::rokviss
