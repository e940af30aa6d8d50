// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/utilities/allocation_guard.hpp"
#include "tests/integration/flight.hpp"

/// Once commissioned neither cycle nor service loop of rokviss uses the heap, whatever it is told to do (docs/adr/0103). This program
/// counts it.
namespace hirosco::testing {
namespace {

namespace framework_event = descriptor::framework_event;

constexpr std::uint16_t supervisor_apid = 1;  ///< itself no subsystem that acts: its cycle only tells

/// Every flight is listened to for what the framework says of the heap.
struct HeapFlight {
  explicit HeapFlight(Plan plan) : flight{std::move(plan)} {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      if (report.service() == 3 && report.subtype() == 10) ++definitions[report.apid()];
      if (report.service() != 5 || report.apid() == supervisor_apid) return;
      OctetReader reader{report.source_data()};
      const auto id = reader.get<std::uint16_t>();
      if (id == framework_event::service_uses_heap || id == framework_event::cycle_not_realtime)
        told[{report.apid(), id}] = reader.get<std::uint32_t>();
    };
  }
  Flight flight;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint32_t>
      told;  ///< newest count of allocations, by subsystem and event
  std::map<std::uint16_t, int> definitions;  ///< TM[3,10] of each
};

/// Something that the argument may be.
Value permitted(const pus::Argument& argument) {
  const descriptor::Field& field = argument.field;
  if (argument.fallback) return *argument.fallback;
  if (field.type == Type::Text) return std::string{"a"};
  if (!argument.texts.empty()) return Number{argument.texts.back().value};
  if (field.minimum && field.maximum) {
    const double middle = (field.minimum->real() + field.maximum->real()) / 2;
    return is_integer(field.type) ? *field.minimum : Number{middle};
  }
  return Number{0};
}

/// All that a ground may ask of it while it acts, but for changes of its state.
void play_palette(Flight& flight, const descriptor::SubsystemDescriptor& subsystem) {
  for (const descriptor::Function& request : pus::requests_of(subsystem)) {
    if (request.name == "SET_STATE" || request.name == "CONFIGURE") continue;
    std::vector<Value> arguments;
    for (const auto& argument : request.arguments)
      arguments.insert(arguments.end(), pus::value_count(argument), permitted(argument));
    static_cast<void>(flight.craft().command(subsystem.name, request.name, arguments, 2s));
  }
  std::vector<std::uint16_t> structures, events;
  for (const auto& each : subsystem.housekeeping) structures.push_back(each.id);
  for (const auto& configuration : subsystem.configurations)
    for (const auto& each : configuration.housekeeping) structures.push_back(each.id);
  for (const auto& each : subsystem.events) events.push_back(each.id);
  std::uint16_t count = 0;
  const auto send = [&](std::uint8_t service, std::uint8_t subtype, Octets data) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = subsystem.id,
                                                .sequence_count = ++count,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    static_cast<void>(flight.send(*packet));
  };
  std::array<std::byte, 16> room, further, of_one;
  for (const std::uint16_t id : structures)
    for (const std::uint8_t subtype : std::array<std::uint8_t, 3>{6, 5, 27}) {
      OctetWriter writer{room};
      writer.put(std::uint8_t{1}).put(id);
      send(3, subtype, writer.written());
    }
  // One of a value of its own comes, grows and goes.
  constexpr std::uint16_t made = 59'000;
  const auto parameter = [&](std::size_t index) {
    return descriptor::identity_of(subsystem, {{}, static_cast<std::uint16_t>(index), std::nullopt, {}}).wire();
  };
  if (subsystem.parameters.size() > 1)
    for (int round = 0; round < 3; ++round) {
      flight.craft().run(500ms);  // what waits on the way is bounded
      OctetWriter first{room}, more{further}, list{of_one};
      first.put(made).put(std::uint32_t{2}).put(std::uint8_t{1}).put(parameter(0)).put(std::uint8_t{0});
      send(3, 1, first.written());
      more.put(made)
          .put(std::uint8_t{0})
          .put(std::uint8_t{1})
          .put(std::uint16_t{2})
          .put(std::uint8_t{1})
          .put(parameter(1));
      send(3, 29, more.written());
      list.put(std::uint8_t{1}).put(made);
      for (const std::uint8_t subtype : std::array<std::uint8_t, 7>{9, 33, 5, 27, 6, 3, 9})
        send(3, subtype, list.written());
    }
  for (const std::uint16_t id : events)
    for (const std::uint8_t subtype : std::array<std::uint8_t, 2>{6, 5}) {
      OctetWriter writer{room};
      writer.put(std::uint8_t{1}).put(id);
      send(5, subtype, writer.written());
    }
  send(5, 7, {});
  for (std::size_t i = 0; i < subsystem.parameters.size(); ++i) {
    OctetWriter writer{room};
    writer.put(std::uint8_t{1}).put(parameter(i));
    send(20, 1, writer.written());
  }
  send(199, 1, {});
  send(20, 3, {});
}

std::string words_of(const HeapFlight& heard) {
  std::string text;
  for (const auto& [who, count] : heard.told)
    text += std::to_string(who.first) + (who.second == framework_event::service_uses_heap ? " service " : " cycle ") +
            std::to_string(count) + "; ";
  return text;
}

TEST(Heap, OfRokvissIsLeftAloneByCyclesAndServiceLoopsForAllThatTheyCanBeTold) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  HeapFlight heard{{.edit = hand_rests}};
  ASSERT_TRUE(heard.flight.commission()) << heard.flight.story().text();
  heard.flight.craft().run(2s);
  EXPECT_EQ(words_of(heard), "") << "before anything was asked";
  for (const auto& member : heard.flight.mission().subsystems) {
    heard.told.clear();
    play_palette(heard.flight, member.subsystem);
    heard.flight.craft().run(2s);
    EXPECT_EQ(words_of(heard), "") << member.subsystem.name;
    EXPECT_EQ(heard.definitions[member.subsystem.id], 3) << member.subsystem.name << " made what it was told to";
  }
}

/// Takes from the heap in its service loop when it has acted for a while.
class Planted final : public Subsystem {
  Result<Step> software_init() override { return done; }
  void service(TimePoint) override {
    if (state() == State::Operational && ++steps_ % 500 == 0) kept_ = std::make_unique<int>(steps_);
  }
  int steps_{0};
  std::unique_ptr<int> kept_;
};

constexpr auto planted_mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="PLANTED">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/planted.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  <Subsystem executable="planted" descriptor="planted.xml"/>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="PLANTED" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
    </Mode>
  </Modes>
  <Recovery><Plan name="note"><When severity="low info"/><Do action="log"/></Plan></Recovery>
</Mission>
)";

TEST(Heap, UsedByAPlantedAuthorInItsServiceLoopIsTold) {
  HeapFlight heard{
      {.mission = "hello",
       .subsystems = {{"planted", [] { return std::make_unique<Planted>(); }}},
       .files = {
           {"mission.xml", planted_mission_text},
           {"planted.xml",
            R"(<Subsystem name="PLANTED" id="20"><Configuration name="NOMINAL" id="1" sampling_us="1000"/></Subsystem>)"}}}};
  ASSERT_TRUE(heard.flight.commission()) << heard.flight.story().text();
  heard.flight.craft().run(10s);
  EXPECT_GE((heard.told[{20, framework_event::service_uses_heap}]), 2U);
  EXPECT_EQ(heard.told.count({20, framework_event::cycle_not_realtime}), 0U);
}

}  // namespace
}  // namespace hirosco::testing
