// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/injection_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <sstream>

namespace hirosco::tools {

std::expected<std::vector<Injection>, std::string> plan_injections(const std::vector<std::string>& texts,
                                                                   Duration run_for) {
  std::vector<Injection> plan;
  for (const std::string& text : texts) {
    std::istringstream words{text};
    double after_s = 0.0;
    Injection injection;
    if (!(words >> after_s >> injection.device) || !(after_s >= 0.0))
      return std::unexpected(
          fmt::format("--at '{}' is not \"SECONDS DEVICE LINE\", for example \"5 arm unplug\"", text));
    std::getline(words >> std::ws, injection.line);
    // Before it is made a Duration, which has an end.
    if (after_s < seconds(run_for))
      injection.after = std::chrono::duration_cast<Duration>(std::chrono::duration<double>(after_s));
    else injection.after = run_for;
    if (injection.after >= run_for)
      return std::unexpected(
          fmt::format("--at '{}' would come when the flight is over: it takes {} s; --for takes a longer one, or give "
                      "an earlier time",
                      text, seconds(run_for)));
    plan.push_back(std::move(injection));
  }
  std::ranges::stable_sort(plan, {}, &Injection::after);
  return plan;
}

}  // namespace hirosco::tools
