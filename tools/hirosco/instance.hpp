// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/core_places.hpp"

/// Several flights on one computer (adr 0037): what belongs to one of them, and where all of them are found.
namespace hirosco::tools {

/// One flight, as the registry has it.
struct FlightEntry {
  std::string instance;
  std::string mission;           ///< its name
  std::filesystem::path file;    ///< of the mission
  std::filesystem::path folder;  ///< its lock, sockets of its simulated devices, its local stop
  std::filesystem::path log;
  std::string telemetry{};       ///< HOST:PORT; empty: a mission without ground link
  std::string telecommand{};
  std::vector<std::string> udp{};  ///< addresses of its devices that no instance changes
  FlightCores cores{};           ///< of a flight that is planned: where its cycles are to be (adr 0007, 0234)
  std::vector<CoreUse> core_uses{};  ///< of one that is entered: where they are, and their declared shares
  int keeper{0};                 ///< its process

  /// It has a name of its own, and so all that the mission's file names once.
  [[nodiscard]] bool named() const { return instance != mission; }
};

/// One NAME=VALUE a line; other programs read it, too (ground/clients/python/runtime.py).
[[nodiscard]] std::string entry_text(const FlightEntry& entry);
[[nodiscard]] std::optional<FlightEntry> entry_from_text(const std::string& text);

/// A name that may stand in a file's: letters, digits, '-', '_', at most 64.
[[nodiscard]] bool good_instance(const std::string& name);
/// Where an instance of this mission logs: as the mission says for the one of the mission's own name, else in a folder of
/// its name beside.
[[nodiscard]] std::filesystem::path instance_log(const descriptor::Mission& mission, const std::string& instance);
/// What an instance of this mission is called, writes to and, before the registry has chosen free ports, listens on.
[[nodiscard]] FlightEntry plan_flight(const descriptor::Mission& mission, const std::string& instance);
/// Whether this address can be listened on; Unavailable: somebody does.
[[nodiscard]] Result<> can_listen(const std::string& address);

/// A flight in the registry. It stays there as long as the descriptor is open in any process.
struct Admission {
  FlightEntry flight;
  FileDescriptor lock;
};

/// The flights of this computer and user. The folder does not depend on XDG_RUNTIME_DIR; an entry counts as long as its
/// file is locked, so that a killed flight leaves nothing to clean up. Looking takes no lock: nobody who looks is in the
/// way of a flight that starts.
class FlightRegistry {
 public:
  explicit FlightRegistry(std::filesystem::path folder = default_folder()) : folder_{std::move(folder)} {}
  [[nodiscard]] static std::filesystem::path default_folder();
  /// Those that fly, by name.
  [[nodiscard]] std::vector<FlightEntry> flights() const;
  /// Enters a flight; one with a name of its own with the first ports that are free. In words why not: one of this name
  /// flies, its ports are taken, the declared budgets of all flights need more than the processor, or the folder is no use.
  [[nodiscard]] std::expected<Admission, std::string> enter(FlightEntry entry) const;

 private:
  [[nodiscard]] std::expected<FileDescriptor, std::string> hold() const;
  std::filesystem::path folder_;
};

/// Which flight is meant on a command line; what is empty is open.
struct Which {
  std::string mission;  ///< its name as it stands in its file
  std::string instance;
};
/// Of these the one that is meant, empty when none flies. In words: the instance does not fly, or several could be meant.
[[nodiscard]] std::expected<std::optional<FlightEntry>, std::string> choose_flight(
    const std::vector<FlightEntry>& flights, const Which& which);

/// The mission that a command is about, and its flight if it is in the air.
struct FoundFlight {
  descriptor::Mission mission;
  std::optional<FlightEntry> flight;
};
/// Looks for it; without one, and where no mission is named, it is about the one that is meant here (`meant_mission()`). Else the exit code,
/// and the reason was printed.
[[nodiscard]] std::expected<FoundFlight, int> find_flight(const char* command, const std::string& mission,
                                                          const std::string& instance);

/// The mission that is named, else the one that is meant here, else the usual one, which is said; whatever flies.
[[nodiscard]] std::expected<FoundFlight, int> only_mission(const char* command, const std::string& mission);

/// The log of a mission: of the flight that is in the air, else of the one that has flown from this folder.
struct FoundLog {
  descriptor::Mission mission;
  std::filesystem::path path;
  std::optional<FlightEntry> flight{};  ///< the one that is in the air
};
[[nodiscard]] std::expected<FoundLog, int> find_log(const char* command, const std::string& mission,
                                                    const std::string& instance);

/// Where a command finds the ground link of its flight.
struct GroundLinkPlace {
  descriptor::Mission mission;
  std::string host;
  std::uint16_t port{0};
  int keeper{0};  ///< of the flight, where that is in the air on this computer; 0: it is not known to be
};
[[nodiscard]] std::expected<GroundLinkPlace, int> find_ground_link(const char* command, const Connection& connection);

/// A lock that lives as long as the descriptor, here or in a process that inherited it; Unavailable: somebody has it.
[[nodiscard]] Result<FileDescriptor> take_lock(const std::filesystem::path& path);

}  // namespace hirosco::tools
