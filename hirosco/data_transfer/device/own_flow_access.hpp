// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/result.hpp"

/// How a subsystem that is a user of its own has the flow of a device for itself (docs/adr/0177).
namespace hirosco {

/// Of which user the process of a subsystem is.
enum class ProcessUser : std::uint8_t { WhoeverFlies, ItsOwn };

/// Numbers of users and their groups that one flight gives its subsystems, the last one among them.
struct GroupRange {
  std::uint32_t first{1};  ///< as it begins there is none in it
  std::uint32_t last{0};
  [[nodiscard]] bool contains(std::uint32_t group) const noexcept { return first <= group && group <= last; }
};

/// Of such a subsystem.
struct OwnGroup {
  std::uint32_t group{0};
  GroupRange of_flight{};
};

/// As the row of a means says it, beside what that says where all are of one user (flow_access.hpp). Addresses have the flight's instance in
/// them. With nothing said the flow is nobody's, as a port, or the computer gives it away, as a line: all is as for one user.
struct OwnFlowAccess {
  /// Why the one of this address cannot be for one subsystem alone, in words; empty: it can. Null: each can.
  std::string_view (*why_not)(const std::string& address){nullptr};
  /// The folder that is the subsystem's and whoever flies' alone; empty: the address is none. Null: there is no such folder.
  std::string (*folder)(const std::string& address){nullptr};
  /// Makes it. Mismatch: it is there, and others get in.
  Result<> (*make_folder)(const std::string& address, const OwnGroup& own){nullptr};
  /// In place of the row's, of which this is a part: whose inhibits are out of reach with that are so with this.
  void (*let_in)(const std::string& address, Sandbox& sandbox){nullptr};
  /// Removes from that folder what ends of a flow have left there that were killed. Null: they leave nothing.
  void (*forget)(const std::string& folder){nullptr};
  /// Where the folder is: it is made before the flight, in which a supervisor asks no disk (docs/adr/0144).
  bool on_disk{false};
};

/// Of a means of which nothing has to be said.
inline constexpr OwnFlowAccess own_as_of_one_user{};

}  // namespace hirosco
