// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/overview.hpp"

/// What is told of a craft of two that is well, for tests.
namespace hirosco::supervisor::testing {

[[nodiscard]] inline Overview pair() {
  Overview craft{.mission = "PAIR",
                 .mode = "coupled",
                 .initial_mode = "commissioning",
                 .usual_mode = "coupled",
                 .members = {},
                 .links = {}};
  for (const char* name : {"ARM", "HAND"})
    craft.members.push_back({.name = name,
                             .runs = true,
                             .state = "Operational",
                             .wanted = "Operational",
                             .counted = true,
                             .cycling = true,
                             .realtime = true,
                             .period_ns = 500'000,
                             .cycles = 1000,
                             .latency_max_ns = 31'000,
                             .execution_mean_ns = 20'000});
  craft.links = {{.id = 1, .from = "ARM", .to = "HAND", .up = true, .wanted = true},
                 {.id = 2, .from = "HAND", .to = "ARM", .up = true, .wanted = true}};
  return craft;
}

}  // namespace hirosco::supervisor::testing
