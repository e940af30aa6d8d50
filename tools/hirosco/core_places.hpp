// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/os/processor_set.hpp"

/// The cores that a mission names, on this computer (docs/adr/0234).
namespace hirosco::tools {

/// What a flight needs of a core.
struct CoreUse {
  std::optional<std::uint16_t> core;  ///< empty: the one of all who name none, where it is not known which that is
  double load{0};  ///< declared share
  bool alone{false};  ///< nobody else's
  bool named{false};  ///< by its mission
};

/// Of all of a flight.
struct FlightCores {
  ProcessorSet processors{};  ///< of everybody whom the mission gives no core; the flight begins with these
  std::vector<CoreUse> named{};
  double shared_load{0};  ///< of who names none

  /// Each core once, the one of who names none among them.
  [[nodiscard]] std::vector<CoreUse> uses() const;
};
/// As this process may use the computer.
[[nodiscard]] FlightCores flight_cores(const descriptor::Mission& mission, const ProcessorSet& here);

/// Another flight of this computer.
struct OtherCores {
  std::string name;
  std::vector<CoreUse> uses;
};
/// What is another's alone is not for who names none.
void keep_off(FlightCores& cores, const std::vector<OtherCores>& others);
/// Why these do not fit beside the others, in words; empty: they do.
[[nodiscard]] std::string judge_cores(const std::vector<CoreUse>& own, const std::vector<OtherCores>& others);

/// Cores that this computer does not have for us, or on which more is to be done in time here than they have (E0423).
[[nodiscard]] std::vector<descriptor::Diagnostic> core_problems(const descriptor::Mission& mission,
                                                                const ProcessorSet& here);

}  // namespace hirosco::tools
