// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "simulation/spacecraft/observed_flight.hpp"

/// Flights of the repository's missions, and packets that no decent ground would send.
namespace hirosco::testing {

using simulation::hand_rests;
using simulation::Plan;
using simulation::Story;

/// Plan::mission is the name of a mission of the repository, or its file from the repository's root on; empty: rokviss.
class Flight final : public simulation::Flight {
 public:
  explicit Flight(Plan plan) : simulation::Flight{with_file(std::move(plan))} {}

 private:
  static Plan with_file(Plan plan) {
    if (plan.mission.empty()) plan.mission = "rokviss";
    const std::filesystem::path root{HIROSCO_SOURCE_DIR};
    plan.mission =
        plan.mission.extension() == ".xml" ? root / plan.mission : root / "missions" / plan.mission / "mission.xml";
    return plan;
  }
};

/// A telecommand TC[8,1] to `apid` with octets of the caller's choice.
[[nodiscard]] std::vector<std::byte> function_packet(std::uint16_t apid, std::uint16_t count, Octets data);
/// Name, number of arguments and DOUBLE arguments as they stand on the wire, unchecked.
[[nodiscard]] std::vector<std::byte> call_data(std::string_view name, const std::vector<double>& arguments);

}  // namespace hirosco::testing
