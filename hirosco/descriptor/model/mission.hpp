// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/device_network.hpp"
#include "hirosco/descriptor/model/manifest.hpp"
#include "hirosco/descriptor/model/reported.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/result.hpp"

/// The mission descriptor in memory: what is started, connected, permitted and recovered.
namespace hirosco::descriptor {

/// A parameter begins with other values than its subsystem's descriptor says.
struct Override {
  std::string parameter;
  std::vector<Value> values;
};
/// "NAME=1 2.5" or "NAME=words", as a launched subsystem is told.
[[nodiscard]] std::string to_string(const Override& changed);
/// The reverse, into `subsystem`. NotFound: no such parameter. OutOfRange: not as many values as it has, or no such ones.
[[nodiscard]] Result<> apply_override(SubsystemDescriptor& subsystem, std::string_view text);

/// What tells a launched subsystem to begin with all of `init`: one of the whole, or where a structure has words among its members one of each
/// member, as words stand alone.
[[nodiscard]] std::vector<Override> overrides_of(const Parameter& parameter);

/// A fall-back of a device is elsewhere than the descriptor says, by the same way.
struct MovedFallBack {
  std::string address;  ///< as the descriptor says
  std::string to;  ///< of this instance
};

/// A device of this instance has other addresses, or other settings, than its subsystem's descriptor says, in every configuration.
struct DeviceChange {
  std::string device;
  std::string address;  ///< empty = the descriptor's
  std::string enable;  ///< of the second inhibit; empty = the descriptor's
  std::string power{};  ///< of what switches its power; empty = the descriptor's
  std::vector<MovedFallBack> fall_backs{};
  std::vector<Setting> settings{};  ///< in place of those that the descriptor gives it
};

/// Whom this instance commands, or hears, where it is not who has the name that its descriptor says.
struct Redirected {
  enum class Kind : std::uint8_t { Commands, Subscribes };
  Kind kind{Kind::Commands};
  std::string subsystem;  ///< as the descriptor calls it
  std::string to;  ///< as the mission does
};

/// Processors of the computer, by the system's numbers from 0, that a subsystem has in this mission (docs/adr/0234).
struct Cores {
  /// Of its cycle and its loops of services with a priority; empty: the one that all such share (docs/adr/0007).
  std::optional<std::uint16_t> cycle{};
  bool alone{false};  ///< of the flights of this computer nobody else may use it, but for simulated devices of its own
  std::vector<std::uint16_t> services{};  ///< of all its other threads; empty: whatever the flight may use
};
/// The system's numbers end here.
inline constexpr std::uint16_t greatest_core = 1023;

struct MissionSubsystem {
  std::string executable;  ///< name of the program, looked up beside the running one and then in PATH
  bool starts{true};  ///< with the flight; else when the ground asks for it
  SubsystemDescriptor subsystem;  ///< with what the mission changes applied: name, id, parameters, addresses
  std::vector<Override> overrides;
  std::vector<DeviceChange> devices;
  std::vector<Redirected> redirected;
  Location at;
  /// What the files that its devices' settings name bring along (brought_files()), when they were read last (docs/adr/0144).
  std::vector<std::filesystem::path> brought{};
  /// User and group of its process, where the mission names numbers for that and the flight has the right to (docs/adr/0177); else it is the user
  /// who flies.
  std::optional<std::uint32_t> user{};
  bool carries_ground{false};  ///< the ground link
  std::vector<LinkMethod> link_methods{};  ///< how links of the mission that begin or end here may travel
  Cores cores{};
};

/// What makes an instance of the descriptor in its file the subsystem of the mission, as words for its process: pairs
/// "--as" "NAME:12", "--set" "PARAMETER=1 2.5", "--address", "--enable" and "--power" "DEVICE=address", "--fall-back"
/// "DEVICE=address=address", "--setting" "DEVICE:NAME=value", "--commands" and "--subscribes" "NAME=12:FILE".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> changes_of(const MissionSubsystem& member);
/// Words of it that need the other's descriptor: "NAME=12:FILE".
[[nodiscard]] constexpr bool needs_other(std::string_view word) noexcept {
  return word == "--commands" || word == "--subscribes";
}
/// One of them, into `subsystem`. NotFound: no such parameter, device, setting or fall-back, or it has no second inhibit, or nothing
/// switches its power; OutOfRange: the values do not fit; Mismatch: two ends would have one address; InvalidArgument: not of this form. All but "--commands" and "--subscribes", which need the other's
/// descriptor.
[[nodiscard]] Result<> apply_change(SubsystemDescriptor& subsystem, std::string_view word, std::string_view text);

/// A simulated device process standing in for hardware.
struct SimulatedDevice {
  std::string name;  ///< as `hirosco fault` names it
  std::string executable;
  std::string subsystem;  ///< whose device it plays
  std::string device;
  std::uint64_t seed{1};
  std::vector<Setting> settings;
  Location at;
  std::optional<std::uint16_t> core{};  ///< empty: the one that all cycles share, too
};

/// What becomes of the consumer of a link whose set it has lost (docs/adr/0077).
enum class OnLoss : std::uint8_t {
  Down,  ///< down with the network of who has failed; of a stale set: the plan for its event
  Fallback,  ///< stopped, and on in another configuration
  Hold,  ///< on for a time, then down with its own network
  Ignore,  ///< on without it
};

struct MissionLink {
  std::uint8_t id{};
  std::string from, provides;  ///< producing subsystem and its set
  std::string to, requires_;  ///< consuming subsystem and its set
  std::optional<LinkMethod> method{};  ///< none: the first that both ends have, in the producer's order
  std::string from_address{}, to_address{};  ///< of its ends, method Udp; empty: in this computer, at any port
  Location at;
  OnLoss on_loss{OnLoss::Down};
  Duration hold{};  ///< Hold: for how long
  std::string fallback{};  ///< Fallback: which configuration
};

/// How a permit calls the ground as one who asks, beside subsystems by their names.
inline constexpr std::string_view ground_origin = "ground";

/// What a mode lets through: functions, services and parameters of one subsystem, or of all ("*").
struct Permit {
  std::string subsystem;
  std::vector<std::string> functions;  ///< "*" = all
  std::vector<std::uint8_t> services;
  std::vector<std::string> parameters;  ///< that TC[20,3] may set, whatever `services` says; "*" = all writable ones
  Location at;
  /// Who may ask for it: `ground_origin`, subsystems by name. Empty: whoever may ask at all, of the supervisor the ground (docs/adr/0216).
  std::vector<std::string> from{};

  [[nodiscard]] bool names(std::string_view sender) const noexcept {
    return std::ranges::find(from, sender) != from.end();
  }
};

struct CommissionStep {
  std::string subsystem;
  std::string configuration;
  State state{State::Operational};
  Location at;
};

/// A state of another subsystem without which a mode is not entered, or with which it is not: judged on what holds before the
/// change begins.
struct Interlock {
  enum class Kind : std::uint8_t { Needs, Excludes };
  Kind kind{Kind::Needs};
  std::string subsystem;
  std::vector<State> states;  ///< one of them
  std::string configuration;  ///< empty = any
  Location at;
};
/// "ARM in SafeOperational or Operational with COUPLED".
[[nodiscard]] std::string to_string(const Interlock& interlock);

struct Mode {
  std::string name;
  std::uint8_t id{};
  std::vector<std::string> from;  ///< modes from which it may be entered; empty = any
  std::vector<Interlock> interlocks;
  std::vector<CommissionStep> commission;  ///< the start list when this is the start mode
  std::vector<std::uint8_t> establish;  ///< links
  std::vector<Permit> permits;
  Location at;
};

/// One step of a plan: a word of plan_steps.hpp, and a value for each of its attributes in their order.
struct PlanStep {
  std::string kind;
  std::vector<std::int64_t> values{};
  std::string subsystem{};  ///< whom it moves; empty = whose event it is
  std::vector<std::string> words{};  ///< in the places of their values: names, as the mission writes them
  std::vector<double> arguments{};  ///< of a function that it calls
};

/// Of plans that are as safe as each other the higher pre-empts the lower on a member (docs/adr/0090).
inline constexpr std::uint8_t default_plan_priority = 100;

/// A recovery plan: the most specific matching one is taken (subsystem, event, severity, mode).
struct Plan {
  std::string name;
  std::vector<Severity> severities;  ///< empty = any
  std::string subsystem;  ///< empty = any
  std::string event;  ///< empty = any
  std::string mode;  ///< empty = any
  std::uint8_t priority{default_plan_priority};  ///< 1 to 255
  std::vector<PlanStep> steps{};  ///< in this order; empty = log
  Location at;
};

struct GroundAddresses {
  std::string subsystem;  ///< which subsystem carries the ground link; empty = none
  std::string telemetry{"127.0.0.1:10015"};
  std::string telecommand{"127.0.0.1:10025"};
};

/// Most networks that a mission names for its devices.
inline constexpr std::size_t max_device_networks = 16;

struct DatabaseUse {
  std::string strategy{"sqlite"};  ///< sqlite | ascii | postgresql
  std::string server{};  ///< of postgresql, as libpq takes it, without a password; empty = none
  std::filesystem::path path;  ///< relative to the working directory
  /// When the log goes on in another file, and how much stays; 0 = never, all of it.
  std::uint32_t rotate_mb{0};
  std::uint32_t rotate_h{0};
  std::uint32_t keep_mb{0};
};

/// What the live line of a terminal shows of the newest housekeeping.
struct ShownValue {
  std::string parameter;  ///< "SUBSYSTEM.PARAMETER" or "SUBSYSTEM.STRUCTURE.MEMBER"
  std::string label;
  std::string unit;  ///< of the parameter; empty = none
  std::uint8_t decimals{3};
};

/// Numbers of users of the system, the last one among them, that a mission gives its subsystems in its order (docs/adr/0177).
struct UserNumbers {
  std::uint32_t first{0};
  std::uint32_t last{0};
  friend bool operator==(const UserNumbers&, const UserNumbers&) = default;
};

/// A parameter by which a subsystem tells what electrical power there is (docs/adr/0124).
struct MeasuredPower {
  std::string name;  ///< "SUBSYSTEM.PARAMETER"
  Duration age{};  ///< a measurement counts so long
  std::uint16_t apid{0};
  ReportedAt at{};
};

/// What members draw is measured, and held against what they claim (docs/adr/0237).
struct PowerDraw {
  MeasuredPower measured;
  std::vector<std::uint16_t> of;  ///< their APIDs: one, or all that one outlet feeds
  double beyond_w{0};  ///< may be drawn besides what they claim
  Duration longer_than{};  ///< an excess is told when it has lasted so long
};

struct Mission {
  std::string name;
  std::filesystem::path file;
  SubsystemDescriptor supervisor;
  DatabaseUse database;
  GroundAddresses ground;
  std::optional<double> power_budget_w;  ///< for the configurations in use; empty = not limited
  std::optional<MeasuredPower> power_measured{};  ///< of that budget; none: it is all there, whatever shines
  double power_least_w{0};  ///< is granted whatever is measured, and where nothing is
  std::vector<PowerDraw> power_draws{};
  std::optional<Manifest> manifest{};  ///< none: whatever has the name of an executable is started (adr 0089)
  /// Outside this computer, where devices may be reached (docs/adr/0112); empty: nowhere.
  std::vector<DeviceNetwork> device_networks{};
  bool isolation_required{false};  ///< no subsystem is started where this computer cannot isolate it (adr 0081)
  std::optional<UserNumbers> users{};  ///< of subsystems' processes; none: all are of the user who flies (adr 0177)
  Amounts budget{};  ///< of all subsystems together; what is empty is not limited
  /// Of all cycles that name none, as this flight has it on this computer; empty: not known, as in simulated time.
  std::optional<std::uint16_t> shared_core{};
  std::vector<MissionSubsystem> subsystems;
  std::vector<SimulatedDevice> devices;
  std::vector<MissionLink> links;
  std::vector<Mode> modes;
  std::string initial_mode;
  std::string start_mode;  ///< empty = stay in the initial mode, commission nothing
  std::vector<Plan> plans;
  std::vector<ShownValue> console;  ///< in the order of the file
  /// The files that it was read from, as they were: what flies is judged by them, whatever the disk says by now (docs/adr/0095).
  std::map<std::filesystem::path, std::shared_ptr<const std::string>> texts{};

  /// The supervisor, which is found like every other member, and then the subsystems in their order.
  [[nodiscard]] std::vector<const SubsystemDescriptor*> everybody() const;
  /// One of them; null: there is none.
  [[nodiscard]] const SubsystemDescriptor* find_member(std::string_view member) const noexcept;
  [[nodiscard]] const SubsystemDescriptor* find_member(std::uint16_t apid) const noexcept;
  /// Of those that the supervisor starts and leads.
  [[nodiscard]] const MissionSubsystem* find_subsystem(std::string_view subsystem) const noexcept;
  [[nodiscard]] const MissionSubsystem* find_subsystem(std::uint16_t apid) const noexcept;
  [[nodiscard]] const Mode* find_mode(std::string_view mode) const noexcept;
  [[nodiscard]] const MissionLink* find_link(std::uint8_t link) const noexcept;
};

/// The mode that brings a craft up again which is in the mode `now`: that one, or the `usual` one where it is the initial one or commissions
/// nobody. Null: neither brings anybody up.
[[nodiscard]] const Mode* mode_up(const Mission& mission, std::string_view now, std::string_view usual) noexcept;

/// Of what this mode needs and excludes that which does not hold with everybody Offline, in words: as a flight begins.
[[nodiscard]] std::vector<std::string> against_beginning(const Mode& mode);
/// Why commissioning cannot enter this mode from the initial one, with everybody Offline, in words; empty: it can.
[[nodiscard]] std::vector<std::string> against_start(const Mission& mission, const Mode& mode);
/// Of a flight, in place of the mission's own start mode. In words: why not.
[[nodiscard]] std::optional<std::string> start_in(Mission& mission, std::string_view mode);

/// Share of the core that its cycle goes on (docs/adr/0007, 0234) that a subsystem declares: the budget of this configuration, of none null, and
/// those of its loops of services that have a priority there.
[[nodiscard]] double cycle_share(const SubsystemDescriptor& subsystem, const Configuration* in_force) noexcept;
/// The same of the configurations of a mode, of the core that has most to do (cores.hpp has each).
[[nodiscard]] double cycle_share(const Mission& mission, const Mode& mode);
/// The greatest of all modes.
[[nodiscard]] double cycle_share(const Mission& mission);

}  // namespace hirosco::descriptor

namespace hirosco {
template <>
struct EnumTexts<descriptor::OnLoss> {
  using enum descriptor::OnLoss;
  static constexpr auto table =
      enum_table<descriptor::OnLoss>({{Down, "down"}, {Fallback, "fallback"}, {Hold, "hold"}, {Ignore, "ignore"}});
};
}  // namespace hirosco
