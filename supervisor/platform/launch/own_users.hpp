// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/descriptor/model/mission.hpp"

/// Subsystems that are users of their own, where the mission names numbers for them and the flight has the right to (docs/adr/0177). Thread: any.
namespace hirosco::supervisor {

/// What of its isolation a mission asks for and does not get, in words: that all are of one user, and why. Empty: each is a user of its own,
/// or the mission asks for none. \param granted Who started the flight, and ends what its supervisor leaves, has the right, too.
[[nodiscard]] std::string why_one_user(const descriptor::Mission& mission, bool granted);

/// Makes the places of its devices, each as the row of its means of transfer says, which are its own and whoever flies' alone; at its start, in
/// flight, those for which no disk is asked. In words: which one cannot be, and what to do.
/// \param instance Of the flight.  Realtime: blocks.
[[nodiscard]] std::expected<void, std::string> make_own_places(const descriptor::MissionSubsystem& subsystem,
                                                               const OwnGroup& own, const std::string& instance,
                                                               PlaceTime time);

/// Where `user`, of no group but its own, is stopped on the way to a place by the rights of a folder, or by its own; empty: nowhere, or there is no
/// such place. By modes alone: what a file system permits beyond them is not seen. \param wanted of the place: 4 read, 2 write, 1 execute.
[[nodiscard]] std::filesystem::path closed_to(std::uint32_t user, const std::filesystem::path& place, unsigned wanted);

/// The first place that its program needs and its user does not get at, as "may not read PLACE: FOLDER is closed to it"; empty: there is none.
/// \param instance Of the flight.  Realtime: blocks.
[[nodiscard]] std::string what_is_closed(const descriptor::MissionSubsystem& subsystem, std::uint32_t user,
                                         const std::filesystem::path& program, const std::string& instance);

}  // namespace hirosco::supervisor
