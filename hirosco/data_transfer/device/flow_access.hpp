// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/own_flow_access.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/result.hpp"

/// What a sandbox lets a subsystem in for by a means of transfer, and what that reaches (docs/adr/0175).
namespace hirosco {

/// As the row of a means says it. Addresses have the flight's instance in them. References, so that a row which says nothing is not compiled:
/// its devices would be refused to their subsystems in flight, and who reaches a second inhibit by it would be a guess.
struct FlowAccess {
  /// Adds what the subsystem's end at this address needs, and no more: the supervisor's side is in no sandbox. Opens no file.
  void (&let_in)(const std::string& address, Sandbox& sandbox);
  /// Whether who is let in for that much reaches the flow of this address that the supervisor's side holds: a second inhibit, a power switch.
  bool (&is_reached)(const std::string& address, const Sandbox& sandbox);
  /// Makes what has to be there before the process is, as what is not there is let in by no rule. Null: nothing has to.
  Result<> (*make_place)(const std::string& address){nullptr};
  /// Removes that where nobody who was let in lives any more.
  void (*remove_place)(const std::string& address){nullptr};
  /// That place, where it is a folder for which another one can stand while who was let in runs (exchanged_folder.hpp). Null: who reaches it
  /// is settled when its process starts.
  std::string (*memory_folder)(const std::string& address){nullptr};
  /// For a subsystem that is a user of its own. Null: nothing is known of whose the flow is, so that none of its subsystems is one.
  const OwnFlowAccess* own{nullptr};
};

/// When a place is made: with those of all others, or as a process starts, in flight.
enum class PlaceTime : std::uint8_t { BeforeFlight, AtStart };

/// What the row of a subsystem's flow adds in the flight of this instance; of a means that is not built in nothing: who opens one all the same
/// is refused by the system, which names the call.
void let_in(const FlowAddress& flow, const std::string& instance, Sandbox& sandbox,
            ProcessUser user = ProcessUser::WhoeverFlies);
/// Of a means that is not built in nothing is known: whoever it is reaches it.
[[nodiscard]] bool is_reached(const FlowAddress& held, const Sandbox& sandbox);
/// Errors of the means: it is not to be let in.  Realtime: blocks, allocates.
[[nodiscard]] Result<> make_place(const FlowAddress& flow, const std::string& instance);
/// Realtime: blocks, allocates.
void remove_place(const FlowAddress& flow, const std::string& instance, ProcessUser user = ProcessUser::WhoeverFlies);

/// Such a folder that the flow is in, or is to be; empty: by its means there is none.
[[nodiscard]] std::string memory_folder_of(const FlowAddress& flow, const std::string& instance);

/// Why a subsystem that is a user of its own cannot have it for itself, in words; empty: it can.
[[nodiscard]] std::string why_not_own(const FlowAddress& flow);
/// The folder of such a subsystem that the flow is in, or is to be; empty: there is none.
[[nodiscard]] std::string own_folder(const FlowAddress& flow, const std::string& instance);
/// As make_place(), for such a subsystem; at its start nothing on a disk. NotPermitted: nothing is known of whose it is; else errors of the
/// means: the flow is not its own.  Realtime: blocks, allocates.
[[nodiscard]] Result<> make_own_place(const FlowAddress& flow, const std::string& instance, const OwnGroup& own,
                                      PlaceTime time);

/// To write, with all below; once.
void let_write(std::string place, Sandbox& sandbox);
/// Whether a file is one of those that may be written, or below one.
[[nodiscard]] bool may_write(const std::string& file, const Sandbox& sandbox);

}  // namespace hirosco
