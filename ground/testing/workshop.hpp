// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"
#include "ground/model/model.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/parameter/number.hpp"

/// A small mission for tests of the ground station, and the packets that its spacecraft would send.
namespace hirosco::ground::testing {

inline constexpr std::uint16_t drill_apid = 10, lamp_apid = 11;
inline constexpr std::uint16_t overview_sid = 4702;
inline constexpr OnboardTime opening{std::chrono::seconds{2'145'916'900}};

[[nodiscard]] inline descriptor::Field field(const char* name, Type type, const char* unit = "",
                                             std::uint32_t count = 1) {
  descriptor::Field made;
  made.name = name;
  made.type = type;
  made.unit = unit;
  made.count = count;
  return made;
}

[[nodiscard]] inline descriptor::Parameter parameter(std::uint8_t id, descriptor::Field of) {
  descriptor::Parameter made;
  made.id = id;
  made.field = std::move(of);
  return made;
}

/// Rows as long as `rows` of the supervisor's, each column of its type.
[[nodiscard]] inline descriptor::Parameter table(const char* name, std::uint8_t id, std::uint32_t rows,
                                                 const std::vector<std::pair<const char*, Type>>& columns) {
  descriptor::Parameter made = parameter(id, field(name, Type::Struct));
  std::uint8_t member = 100;
  for (const auto& [column, type] : columns) made.members.push_back({field(column, type, "", rows), member++});
  return made;
}

[[nodiscard]] inline descriptor::HousekeepingStructure structure(const descriptor::SubsystemDescriptor& of,
                                                                 std::uint16_t sid, std::uint32_t cycles,
                                                                 const std::vector<const char*>& parameters) {
  descriptor::HousekeepingStructure made;
  made.id = sid;
  made.interval_cycles = cycles;
  for (const char* name : parameters)
    made.sampled_once.push_back(descriptor::find_place(of, name).value_or(descriptor::ParameterRef{}));
  return made;
}

[[nodiscard]] inline descriptor::Function function(const char* name,
                                                   std::vector<descriptor::Function::Argument> arguments = {}) {
  descriptor::Function made;
  made.name = name;
  made.states = 1U << static_cast<unsigned>(descriptor::State::Operational);
  made.arguments = std::move(arguments);
  return made;
}

[[nodiscard]] inline descriptor::SubsystemDescriptor supervisor_of_workshop() {
  using enum Type;
  descriptor::SubsystemDescriptor made;
  made.name = "SUPERVISOR";
  made.id = pus::supervisor_apid;
  made.parameters = {parameter(1, field("MODE", Uint8)),
                     table("SUBSYSTEMS", 2, 4,
                           {{"APID", Uint16},
                            {"STATE", Uint8},
                            {"CONFIGURATION", Uint8},
                            {"INHIBITED", Uint8},
                            {"CYCLES", Uint32},
                            {"OVERRUNS", Uint32},
                            {"MISSED", Uint32},
                            {"LATENCY_MAX", Uint32},
                            {"EXECUTION_MEAN", Uint32},
                            {"MEMORY", Uint32}}),
                     table("LINK_STATUS", 3, 2,
                           {{"LINK", Uint8},
                            {"IS_UP", Uint8},
                            {"SAMPLES", Uint32},
                            {"AGE", Uint32},
                            {"LOST", Uint32},
                            {"LATENCY_MEAN", Uint32},
                            {"LATENCY_MAX", Uint32}})};
  descriptor::Configuration nominal;
  nominal.name = "NOMINAL";
  nominal.id = 1;
  nominal.sampling = 10ms;
  nominal.housekeeping.push_back(structure(made, overview_sid, 20, {"MODE", "SUBSYSTEMS", "LINK_STATUS"}));
  made.configurations.push_back(nominal);
  made.functions = {function("SET_MODE", {{.field = field("MODE", Uint8), .of = {}, .fallback = {}}}),
                    function("LINK", {{.field = field("LINK", Uint8), .of = {}, .fallback = {}}}),
                    function("SAFE_ALL")};
  made.functions.back().essential = true;
  const descriptor::Field apid = field("APID", Uint16);
  descriptor::Field state = field("STATE", Uint8);
  state.enumeration = "STATES";
  using enum descriptor::Severity;
  made.events = {{"PROCESS_DIED", 101, High, {apid}, {}, true},
                 {"HANG", 102, High, {apid}, {}, true},
                 {"RECOVERY_STEP", 105, Info, {apid, state}, {}, false},
                 {"LOCAL_STOP", 119, Medium, {}, {}, true}};
  descriptor::add_framework_events(made);
  return made;
}

/// One of everything: numbers, an array, words and a switch; samples that come several times in a report; functions
/// with names of values, with words, with wide numbers and to be confirmed; a service of its own, a writable parameter,
/// a device.
[[nodiscard]] inline descriptor::SubsystemDescriptor drill_of_workshop() {
  using enum Type;
  descriptor::SubsystemDescriptor made;
  made.name = "DRILL";
  made.id = drill_apid;
  made.description = "Bores holes";
  made.enumerations.push_back({"TOOLS", {{1, "Twist"}, {2, "Core"}}});
  descriptor::Field speed = field("SPEED", Double, "rad/s"), label = field("LABEL", Text), tool = field("TOOL", Uint8);
  speed.minimum = 0;
  speed.maximum = 100;
  label.text_octets = 8;
  tool.enumeration = "TOOLS";
  made.parameters = {parameter(1, speed), parameter(2, field("DEPTHS", Float, "mm", 2)),
                     parameter(3, label), parameter(4, field("ON", Bool)),
                     parameter(5, tool),  parameter(6, field("GAIN", Double))};
  made.parameters.back().writable_states = 1U << static_cast<unsigned>(descriptor::State::Operational);
  made.housekeeping.push_back(structure(made, 70, 50, {"LABEL", "ON", "SPEED"}));
  made.housekeeping.back().sampled_repeatedly.push_back({2, {*descriptor::find_place(made, "DEPTHS")}});
  descriptor::Configuration run;
  run.name = "RUN";
  run.id = 1;
  run.sampling = 10ms;
  run.housekeeping.push_back(structure(made, 71, 10, {"SPEED", "TOOL"}));
  descriptor::Provides provided;
  provided.name = "SPEED";
  run.provides.push_back(provided);
  made.configurations.push_back(run);

  descriptor::Field depth = field("DEPTH", Double, "mm"), words = field("WORDS", Text);
  depth.minimum = 1;
  depth.maximum = 50;
  words.text_octets = 8;
  made.functions = {
      function("BORE", {{.field = depth, .of = {}, .fallback = {}},
                        {.field = tool, .of = {}, .fallback = Number{1}, .texts = made.enumerations.front().texts}}),
      function("ENGRAVE", {{.field = words, .of = {}, .fallback = {}},
                           {.field = field("POINT", Float, "mm", 2), .of = {}, .fallback = {}}}),
      function("COUNT", {{.field = field("NUMBER", Uint64), .of = {}, .fallback = {}}}), function("WIPE")};
  made.functions.back().confirm = true;
  descriptor::CustomService memory;
  memory.name = "MEMORY";
  memory.type = 200;
  memory.requests.push_back(function("PEEK", {{.field = field("ADDRESS", Uint16), .of = {}, .fallback = {}}}));
  memory.requests.back().service = 200;
  made.services.push_back(memory);
  made.failures.push_back({0x8001, "BIT_BROKEN"});
  made.events = {{"TORQUE_HIGH",
                  7,
                  descriptor::Severity::Medium,
                  {field("JOINT", Uint8), field("VALUE", Double, "N m")},
                  {},
                  false}};
  // In the name of an event there is no dot.
  descriptor::Device spindle;
  spindle.name = "SPINDLE.A";
  made.devices.push_back(spindle);
  descriptor::add_framework_events(made);
  return made;
}

/// Its only configuration needs the speed of the drill.
[[nodiscard]] inline descriptor::SubsystemDescriptor lamp_of_workshop() {
  descriptor::SubsystemDescriptor made;
  made.name = "LAMP";
  made.id = lamp_apid;
  descriptor::Configuration on;
  on.name = "ON";
  on.id = 1;
  on.sampling = 20ms;
  descriptor::Requires wanted;
  wanted.name = "SPEED";
  wanted.from = "DRILL";
  on.requires_.push_back(wanted);
  made.configurations.push_back(on);
  descriptor::add_framework_events(made);
  return made;
}

[[nodiscard]] inline descriptor::Mission workshop() {
  descriptor::Mission mission;
  mission.name = "WORKSHOP";
  mission.supervisor = supervisor_of_workshop();
  for (const auto& member : {drill_of_workshop(), lamp_of_workshop()})
    mission.subsystems.emplace_back().subsystem = member;
  descriptor::MissionLink link;
  link.id = 1;
  link.from = "DRILL";
  link.to = "LAMP";
  link.provides = link.requires_ = "SPEED";
  mission.links.push_back(link);
  descriptor::Mode dark, work;
  dark.name = "dark";
  dark.id = 1;
  dark.permits.push_back({"*", {"SET_STATE", "CONFIGURE"}, {17}, {}, {}});
  work.name = "work";
  work.id = 2;
  work.commission = {{"DRILL", "RUN", descriptor::State::Operational, {}},
                     {"LAMP", "ON", descriptor::State::Operational, {}}};
  work.establish = {1};
  mission.modes = {dark, work};
  mission.initial_mode = "dark";
  mission.start_mode = "work";
  descriptor::Plan down, safe;
  down.name = "network-down";
  down.severities = {descriptor::Severity::High};
  safe.name = "to-safe";
  safe.severities = {descriptor::Severity::Medium};
  mission.plans = {down, safe};
  descriptor::SimulatedDevice spindle;
  spindle.name = "spindle";
  spindle.subsystem = "DRILL";
  spindle.device = "SPINDLE.A";
  mission.devices.push_back(spindle);
  return mission;
}

/// Numbers one after the other, as they stand on the wire.
template <class... Numbers>
[[nodiscard]] std::vector<std::byte> in_octets(Numbers... numbers) {
  std::vector<std::byte> data((sizeof(numbers) + ... + 0));
  OctetWriter writer{data};
  (writer.put(numbers), ...);
  return data;
}

[[nodiscard]] inline std::vector<std::byte> packet_of(const pus::TelemetryHeader& header, Octets data) {
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  const auto written = pus::write_telemetry(buffer, header, data);
  EXPECT_TRUE(written);
  return {written->begin(), written->end()};
}

/// A report of this structure: values by the names of columns, all others are 0.
[[nodiscard]] inline std::vector<std::byte> housekeeping(const Catalogue& catalogue, std::uint16_t apid,
                                                         std::uint16_t sid, const std::map<std::string, double>& values,
                                                         OnboardTime t) {
  const auto& reports = catalogue.reports();
  const auto report =
      std::ranges::find_if(reports, [&](const Report& one) { return one.apid == apid && one.sid == sid; });
  if (report == reports.end()) {
    ADD_FAILURE() << "no structure " << sid;
    return {};
  }
  std::vector<std::byte> data(report->octets);
  OctetWriter{data}.put(sid);
  for (const Place& place : report->places) {
    const Column& column = catalogue.columns()[place.column];
    const auto found = values.find(column.name);
    if (found == values.end()) continue;
    OctetWriter writer{std::span{data}.subspan(place.offset)};
    put_number(writer, column.type, found->second);
  }
  return packet_of({.apid = apid, .service = 3, .subtype = 25, .time = t}, data);
}

/// What the supervisor tells of everybody: states of drill and lamp (255: it does not run), mode and link 1.
struct Overview {
  double drill{5};
  double lamp{5};
  double mode{2};
  double link_up{1};
  std::map<std::string, double> more{};  ///< by the names of columns
};
[[nodiscard]] inline std::vector<std::byte> overview(const Catalogue& catalogue, const Overview& told, OnboardTime t) {
  std::map<std::string, double> values = told.more;
  const auto row = [&](const char* index, double apid, double state) {
    values["SUPERVISOR.SUBSYSTEMS.APID" + std::string{index}] = apid;
    values["SUPERVISOR.SUBSYSTEMS.STATE" + std::string{index}] = state;
    values.emplace("SUPERVISOR.SUBSYSTEMS.CONFIGURATION" + std::string{index}, 1);
  };
  row("[0]", pus::supervisor_apid, 5);
  row("[1]", drill_apid, told.drill);
  row("[2]", lamp_apid, told.lamp);
  values["SUPERVISOR.MODE"] = told.mode;
  values["SUPERVISOR.LINK_STATUS.LINK[0]"] = 1;
  values["SUPERVISOR.LINK_STATUS.IS_UP[0]"] = told.link_up;
  return housekeeping(catalogue, pus::supervisor_apid, overview_sid, values, t);
}

[[nodiscard]] inline std::vector<std::byte> event_packet(const Catalogue& catalogue, std::string_view subsystem,
                                                         std::string_view event, OnboardTime t,
                                                         const std::vector<std::byte>& arguments = {}) {
  const auto* who = catalogue.find(subsystem);
  const auto* what = who != nullptr ? who->find_event(event) : nullptr;
  if (what == nullptr) {
    ADD_FAILURE() << "no event " << event << " of " << subsystem;
    return {};
  }
  std::vector<std::byte> data = in_octets(what->id);
  data.insert(data.end(), arguments.begin(), arguments.end());
  return packet_of({.apid = who->id, .service = 5, .subtype = static_cast<std::uint8_t>(what->severity), .time = t},
                   data);
}
[[nodiscard]] inline std::vector<std::byte> state_changed(const Catalogue& catalogue, std::string_view subsystem,
                                                          descriptor::State state, OnboardTime t) {
  return event_packet(catalogue, subsystem, "STATE_CHANGED", t, in_octets(static_cast<std::uint8_t>(state)));
}
[[nodiscard]] inline std::vector<std::byte> torque_high(const Catalogue& catalogue, OnboardTime t) {
  return event_packet(catalogue, "DRILL", "TORQUE_HIGH", t, in_octets(std::uint8_t{2}, 12.5));
}

/// A telecommand of somebody, as it is on the wire.
[[nodiscard]] inline std::vector<std::byte> telecommand_of(const pus::TelecommandHeader& header, Octets data) {
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto written = pus::write_telecommand(buffer, header, data);
  EXPECT_TRUE(written);
  return {written->begin(), written->end()};
}

/// An archive that has what the workshop's spacecraft has said.
class ArchiveOfAWorkshop : public ::testing::Test {
 protected:
  /// Into model and archive, as the live view does.
  void hears(const std::vector<std::byte>& octets) {
    const auto packet = pus::TelemetryView::parse(octets);
    ASSERT_TRUE(packet);
    const Heard heard = model.take(*packet);
    StoredPacket stored;
    stored.t = packet->time();
    stored.apid = packet->apid();
    stored.service = packet->service();
    stored.subtype = packet->subtype();
    stored.sid = heard.sid;
    archive->add(stored, octets);
    for (const StoredChange& change : heard.changes) archive->add(change);
    if (heard.event) archive->add(*heard.event);
  }
  /// Its number.
  std::int64_t commanded(const std::string& function, OnboardTime t, const std::string& sender = "anna") {
    StoredCommand command;
    command.t = t;
    command.sender = sender;
    command.apid = drill_apid;
    command.subsystem = "DRILL";
    command.function = function;
    command.arguments = "{}";
    command.stage = "sent";
    return archive->add(command);
  }
  void reported(std::int64_t command, OnboardTime t, const std::string& stage, std::optional<int> code = {}) {
    archive->add(command, StoredReport{t, stage, code, code ? "because" : ""});
  }

  Catalogue catalogue{workshop()};
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  Model model{catalogue};
};

}  // namespace hirosco::ground::testing
