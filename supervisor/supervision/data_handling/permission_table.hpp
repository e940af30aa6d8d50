// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "supervisor/supervision/telecommand/origin.hpp"

/// Everything that can be asked of anybody, and where it is permitted: made by asking `decide()` (permission.hpp), so that
/// the table is what is in force. For an engineer who reviews a mission, and for the test that compares it with the
/// mission's file.
namespace hirosco::supervisor {

struct PermissionRow {
  Origin origin{Origin::ground()};
  const descriptor::SubsystemDescriptor* addressee{nullptr};
  std::uint8_t service{};
  std::uint8_t subtype{};
  /// "MOVE_TO", "SET_STATE Operational", "set POS_SCALE", "TC[3,5] enable periodic generation"; what has a name of its own has that.
  std::string request{};
  std::uint16_t permitted{0};  ///< bit n set: while the addressee is in State n
  std::uint16_t essential{0};  ///< the same, forwarded past what waits (decision 24)
  /// Names of the configurations that do not offer its service (docs/adr/0096), "-" for none in force: there it is refused in all states.
  std::vector<std::string> not_in{};
  std::uint16_t in_change{0};  ///< bit n set: also while the craft is on its way into another mode (docs/adr/0075)
};

/// Every sender (the ground, the supervisor, each subsystem that declares to command somebody), every addressee, every
/// request of its, in this mode, as the `from` of its permits says. Taken for granted are the links and the power that an addressee needs on its way up, and
/// whether it can go from one state to the other is its own to say (paper, figure 4).
[[nodiscard]] std::vector<PermissionRow> permission_table(const descriptor::Mission& mission,
                                                          const descriptor::Mode& mode);

}  // namespace hirosco::supervisor
