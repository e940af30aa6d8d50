// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/time.hpp"

/// The commands behind `hirosco`. Each returns its exit code: 0 ok, 1 finding, 2 usage, 3 environment, 4 internal;
/// `run` besides 5: a reaction of high severity that nobody had caused.
namespace hirosco::tools {

inline constexpr int exit_ok = 0;
inline constexpr int exit_finding = 1;
inline constexpr int exit_usage = 2;
inline constexpr int exit_environment = 3;
inline constexpr int exit_internal = 4;

struct RunOptions {
  std::string mission;
  std::string instance;              ///< empty = the mission's name (adr 0037)
  std::string mode;                  ///< to start in; empty = the mission's
  std::optional<Duration> run_for;
  bool quiet{false};
  bool json{false};
  bool plain{false};                 ///< lines on a terminal, too, and no screen
  bool ground{true};                 ///< the ground station too
  bool tour{false};                  ///< its page opens with the guided tour
  bool threads{false};               ///< supervisor and subsystems as threads of one process (adr 0097)
};
int run(const RunOptions& options);

struct CheckOptions {
  std::vector<std::string> files;
  bool json{false};
  bool show{false};                  ///< print what was read
  bool recovery{false};              ///< print which plan each event would get, and in which modes
  bool fly{false};                   ///< what is missing on this computer is an error, not a warning
};
int check(const CheckOptions& options);

struct DynamicsOptions {
  std::string model;                 ///< URDF file
  std::string tip;                   ///< link; empty = the only one at an end
};
/// Moves a robot as lines on standard input say (adr 0101).
int dynamics(const DynamicsOptions& options);

struct ManifestOptions {
  std::string mission;
  bool write{false};                 ///< into the file that the mission names, else to standard output
};
/// What is here of a mission's executables, as its manifest has it (adr 0089).
int manifest(const ManifestOptions& options);

struct PermissionsOptions {
  std::string mission;
  std::string mode;                  ///< empty = all
  bool csv{false};                   ///< a line for each request, and nothing left out
};
/// The table of what is permitted, as the supervisor judges it (adr 0086).
int permissions(const PermissionsOptions& options);

struct SimulateOptions {
  std::string mission;
  std::string mode;                  ///< to start in; empty = the mission's
  Duration run_for{std::chrono::seconds{10}};
  std::uint64_t seed{1};
  std::string trace;                 ///< CSV at cycle rate; empty = none
  std::vector<std::string> at;       ///< "SECONDS DEVICE LINE": injections
  bool summary{false};               ///< counts only, not the log
  bool octets{false};                ///< those of each packet behind its words
  std::string values;                ///< folder of persistent values; empty: from no flight before, for none after
};
int simulate(const SimulateOptions& options);

/// What a mission does by a program of its own, hirosco-mission-NAME (adr 0054): `hirosco COMMAND MISSION ...` becomes this program with
/// COMMAND, the mission's file and the rest of the line. Returns only where there is none.
int mission_program(const std::string& command, const std::string& mission, const std::vector<std::string>& rest);

/// How clients reach the spacecraft. What is empty is that of the one that flies, else as the mission that is meant here says.
struct Connection {
  std::string mission;
  std::string instance;
  std::string host;
  std::uint16_t port{0};
  bool json{false};
};
struct TelecommandOptions {
  Connection connection;
  std::string subsystem;
  std::string function;  ///< or "ping"
  std::vector<std::string> arguments;  ///< values in order, or NAME=VALUE
  bool yes{false};  ///< what asks for a confirmation is sent without one
  Duration limit{std::chrono::seconds{70}};
};
int telecommand(const TelecommandOptions& options);
struct StatusOptions {
  Connection connection;
  bool all{false};  ///< the newest housekeeping of every subsystem besides
  std::string of;  ///< that of this subsystem and of no other; empty: of none alone
};
/// Is it well? 0: yes, 1: no, 3: nobody answers.
int status(const StatusOptions& options);

struct ModeOptions {
  Connection connection;
  std::string name;  ///< empty = the modes are listed
  bool preview{false};  ///< say what would be done, and what is against it
  Duration limit{std::chrono::seconds{70}};
};
/// The whole craft into a mode (adr 0075). 1: refused, or it failed; with `preview`, it is impossible now.
int mode(const ModeOptions& options);

struct PlanOptions {
  Connection connection;
  std::string event;  ///< SUBSYSTEM:EVENT
  bool from_descriptors{false};  ///< in every mode, without a flight
  Duration limit{std::chrono::seconds{10}};
};
/// What recovery would do about an event, step by step; nothing is done (adr 0099). 1: it could not begin now, or no answer.
int plan(const PlanOptions& options);

struct LogOptions {
  std::string mission;  ///< as for a connection
  std::string instance;
  std::string path;  ///< of the store; empty = of the one that flies, else the mission's
  std::optional<std::uint16_t> apid;
  std::optional<std::uint8_t> service;
  std::string text;
  std::size_t last{40};
  bool housekeeping{false};  ///< with TM[3,25] and its values, which are left out where nobody asks for them
  bool json{false};
};
int log(const LogOptions& options);

struct ResourcesOptions {
  std::string mission;  ///< as for a connection
  std::string instance;
  bool all{false};  ///< of all flights that the log has, not of the newest alone
  bool json{false};
};
/// What each subsystem declares in <Resources> beside the most that it has taken, from the log (adr 0188), and while it flies what it takes now, with
/// its process and power. 1: of one nothing is there.
int resources(const ResourcesOptions& options);

struct FaultOptions {
  std::string mission;  ///< as for a connection
  std::string instance;
  std::string device;
  std::vector<std::string> words;
};
int fault(const FaultOptions& options);

struct SafeOptions {
  std::string mission;  ///< empty = all that fly
  std::string instance;
};
/// Stops every actuator through the local socket of a flight's guard. 0: all have stopped, 1: somebody did not confirm,
/// or may be missing in the answer, which the keeper was signalled for, too, 3: nobody answered, and the keeper was signalled to do it
/// or, where that is gone, a supervisor that stands still was ended.
int safe(const SafeOptions& options);

/// Said where hirosco-ground is missing.
inline constexpr const char* station_needs = "it is built where libboost-dev and nlohmann-json3-dev are installed";

struct GroundOptions {
  std::string mission;  ///< as for a connection
  std::string instance;
  std::optional<std::uint16_t> port;  ///< empty = 8080, or the next free one above
  std::string token;  ///< empty = a new one
  std::string observer_token;  ///< empty = a new one
  std::string telemetry;  ///< HOST:PORT; empty = of the one that flies, else as the mission says
  std::string archive;  ///< empty = beside the mission's log
  std::string page;  ///< folder; empty = the one that was built
  bool json{false};
  bool markdown{false};  ///< of `why`: a report
};
int ground(const GroundOptions& options);
/// The chain of causes of the last stop, from the ground station's archive.
int why(const GroundOptions& options);

/// What other programs need of a mission (adr 0106).
enum class Exported : std::uint8_t { Python, Xtce, Yamcs, InterfaceDocument };
struct ExportOptions {
  Exported what{Exported::Python};
  std::string mission;
  std::string to{"."};  ///< folder that gets it
};
int export_mission(const ExportOptions& options);

struct DoctorOptions {
  std::string mission;  ///< empty = the usual one
  bool json{false};
};
/// What a mission needs of this computer to fly with its figures, and what mends it (adr 0109). 1: something is missing.
int look_after(const DoctorOptions& options);

struct NewOptions {
  std::string kind;  ///< one of new_kinds()
  std::string name;
  std::string to{"."};  ///< folder that gets the new one
  std::string urdf;  ///< of a robot: its file; empty = the one that comes with the template
  std::string tip;  ///< of a robot: link; empty = the only end that moves
  std::string gripper;  ///< of a robot: joints that are a subsystem of their own; empty = none
  bool chain{false};  ///< of a robot: what does not move tip or gripper stands still
  bool homing{false};  ///< of a robot: its joints look for their zeros
  bool wrist_sensor{false};  ///< of a robot: force and moment are measured at its tip
  std::vector<std::string>
      packages;  ///< of a robot: folders in which those of its meshes lie, package://A/B is A/B there
};
/// A folder of one's own to begin with (adr 0109).
int make_new(const NewOptions& options);

// --- shared ------------------------------------------------------------------------------------------------------------
/// A name or a path: the mission file; a name is looked for in missions/NAME/mission.xml from the working directory and
/// from this program upwards. Empty: nowhere.
[[nodiscard]] std::filesystem::path find_mission(const std::string& name_or_path);
/// The mission that is meant where none is named and none flies: the one of the working directory (mission.xml), else the only one that has
/// a log in its folder log/. Empty: there is none, or several.
[[nodiscard]] std::string meant_mission();
/// The mission that a newcomer is shown: the word in the file missions/usual, looked for likewise. Empty: none.
[[nodiscard]] std::string usual_mission();
/// Where a page of docs/ is for whoever reads it here: installed, or as the sources have it.
[[nodiscard]] std::string document(const std::string& name);
/// Reads the mission and prints what is wrong with it to standard error.
[[nodiscard]] std::optional<descriptor::Mission> load_mission(const std::string& name_or_path);
[[nodiscard]] std::uint16_t port_of(const std::string& address);
/// As far from the port for telemetry as in the mission, which may be flown on other ports.
[[nodiscard]] std::uint16_t telecommand_port(const descriptor::Mission& mission, std::uint16_t telemetry_port);
/// Where a flight keeps its lock and the control sockets of its simulated devices. An instance without a name of its own
/// has its mission's.
[[nodiscard]] std::filesystem::path runtime_folder(const std::string& instance);
/// Where the folders of all flights are, and of which instance one of them is; empty: of none.
[[nodiscard]] std::filesystem::path runtime_root();
[[nodiscard]] std::string instance_of_folder(const std::filesystem::path& folder);
/// The ground station's archive, beside the log that the supervisor writes.
[[nodiscard]] std::filesystem::path archive_beside(const std::filesystem::path& log);
/// "; did you mean 'x'?" for the name that is nearest to `text`, or nothing when none is.
[[nodiscard]] std::string did_you_mean(std::string_view text, const std::vector<std::string>& names);
/// Names by which missions can be flown from here.
[[nodiscard]] std::vector<std::string> known_missions();

}  // namespace hirosco::tools
