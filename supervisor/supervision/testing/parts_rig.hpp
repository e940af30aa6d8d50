// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <new>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/testing/report_shape.hpp"
#include "supervisor/composition.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// All parts of a supervisor on virtual time, in a small mission whose members the test plays: each has a channel, pages and a
/// process that does what the test says. What the supervisor itself reports is to be of its shape. CAMERA is the ground link.
namespace hirosco::supervisor::testing {

using descriptor::Severity;

struct PlayedMember {
  struct End final : Channel {
    explicit End(ChannelPair& both) : pair{both} {}
    Result<> send(const Message& message) override { return pair.supervisor_end().send(message); }
    Result<Found> receive(MessageBuffer& buffer) override { return pair.supervisor_end().receive(buffer); }
    ChannelPair& pair;
  };
  ChannelPair channel;
  VitalPage* vital{nullptr};
  PermitPage* permit{nullptr};
  std::uint32_t process{0};
  std::uint16_t reports{0};
};

/// The small mission, each with a configuration, under the supervisor's own descriptor.
inline descriptor::Mission parts_mission() {
  auto made = small_mission();
  static const auto own =
      descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/supervisor/supervisor.xml", descriptor::file_system());
  made.supervisor = *own.value;
  made.ground.subsystem = "CAMERA";
  made.initial_mode = made.start_mode = "open";
  for (auto& member : made.subsystems) {
    if (!member.subsystem.configurations.empty()) continue;
    descriptor::Configuration only;
    only.name = "ONLY";
    only.id = 1;
    only.power_w = 20;
    member.subsystem.configurations = {only};
  }
  return made;
}

inline std::unique_ptr<Database> kept_in(Database*& store) {
  auto made = std::make_unique<MemoryDatabase>();
  store = made.get();
  return made;
}

struct PartsTest : ::testing::Test, ProcessLauncher, Observer {
  explicit PartsTest(descriptor::Mission flown = parts_mission()) : mission{std::move(flown)} {}

  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  descriptor::Mission mission;
  Guard guard{{.clock = clock, .flows = flows, .first_epoch = 1000, .on_finding = {}}};
  Database* store{nullptr};  ///< of the log, which owns it
  DirectPacketLog log{clock, kept_in(store)};
  DirectLogReadings log_readings{[this](const LogQuery& query) { return store->read(query); }};
  MemoryValueDisk value_disk;
  DirectValueStore values{value_disk, "values"};
  std::map<std::uint16_t, PlayedMember> played;
  std::map<std::uint32_t, ProcessEnd> ends;
  std::vector<std::uint32_t> killed;
  std::vector<std::string> story;
  std::vector<std::uint8_t> routed_services;
  std::map<std::uint8_t, std::vector<std::byte>> last_routed;  ///< source data by service
  std::unique_ptr<Database> next_database;  ///< what SET_DATABASE finds
  SupervisorParts parts{{.mission = mission,
                         .platform = {clock, memory, flows},
                         .launcher = *this,
                         .guard = guard,
                         .log = log,
                         .open_database = [this](DatabaseStrategy) { return std::move(next_database); },
                         .observer = *this,
                         .values = &values,
                         .log_readings = &log_readings}};
  Craft& craft = parts.craft;

  /// What steps act with, and a desk that the test plays.
  [[nodiscard]] Means means_with(CommandDesk& desk) {
    return {craft, desk, parts.graph, parts.restarts, parts.under_way, parts.commanded, parts.losses, parts.waiting};
  }
  void SetUp() override {
    clock.set(TimePoint{10s});
    craft.now = clock.now();
  }
  // ProcessLauncher
  Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& described) override {
    played.erase(described.subsystem.id);
    PlayedMember& member = played[described.subsystem.id];
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    LaunchedSubsystem launched;
    launched.vital = page(sizeof(VitalPage));
    launched.permit = page(sizeof(PermitPage));
    launched.process = member.process = described.subsystem.id + 1000U;
    member.vital = new (launched.vital.octets.data()) VitalPage{};
    member.permit = new (launched.permit.octets.data()) PermitPage{};
    launched.port = std::make_unique<LocalMemberPort>(std::make_unique<PlayedMember::End>(member.channel),
                                                      launched.vital, launched.permit);
    return launched;
  }
  std::optional<ProcessEnd> ended(std::uint32_t process) override {
    const auto found = ends.find(process);
    return found != ends.end() ? std::optional{found->second} : std::nullopt;
  }
  void kill(std::uint32_t process) override { killed.push_back(process); }
  // Observer
  void told(OnboardTime, std::string_view line) override { story.emplace_back(line); }
  void routed(const pus::TelemetryView& packet) override {
    if (packet.apid() == supervisor_apid) {
      EXPECT_EQ(pus::testing::unlike_its_shape(packet.service(), packet.subtype(), packet.source_data()), "");
    }
    routed_services.push_back(packet.service());
    last_routed[packet.service()].assign(packet.source_data().begin(), packet.source_data().end());
  }

  /// All are started and stand in this state, in their first configuration.
  void start_all(State state) {
    parts.processes.start_all();
    for (auto& [apid, member] : played) set(apid, state);
  }
  void set(std::uint16_t apid, State state, std::uint8_t configuration = 1) {
    played[apid].vital->state = static_cast<std::uint32_t>(state);
    played[apid].vital->configuration = state == State::Offline ? std::uint8_t{0} : configuration;
  }
  /// A step of the subsystem that the supervisor is, a millisecond later, and what it said.
  void own_step() {
    wait(1ms);
    parts.telecommands.forward_durable();
    static_cast<void>(parts.own.step(clock.now()));
    parts.reception.read_own();
  }
  /// It is commissioned, with a start mode that commissions nobody else: its own functions are there.
  void start_supervisor() {
    parts.own.start(craft.mode_epoch);
    parts.commissioning.start([] {});
    for (int step = 0; step < 200 && parts.commissioning.running(); ++step) own_step();
    ASSERT_TRUE(parts.commissioning.succeeded()) << parts.commissioning.waiting_for();
  }
  /// A function of its own is called; "done", or why not; empty while it goes on.
  std::string call_own(std::string_view name, double argument) {
    parts.own_telecommands.command(supervisor_apid, name, argument,
                                   [this](bool success, const std::string& why) { own_end = success ? "done" : why; });
    for (int step = 0; step < 50 && own_end.empty(); ++step) own_step();
    return std::exchange(own_end, {});
  }
  std::string own_end;  ///< of the last function of its own
  /// An event of a member, heard by the supervisor.
  void event(std::uint16_t apid, std::uint16_t id, Severity severity) {
    std::array<std::byte, pus::event_message_head_octets> buffer{};
    const auto octets = pus::write_event_message(buffer, {.severity = severity, .id = id});
    ASSERT_TRUE(played[apid].channel.subsystem_end().send({.kind = MessageKind::Event, .packet = *octets}));
    parts.reception.read(*craft.member(apid));
  }
  void wait(Duration span) {
    clock.advance(span);
    craft.now = clock.now();
  }
  struct Received {
    std::string text;
    std::uint32_t request{};
    std::uint16_t source{};
  };
  /// What a member was sent since it was asked last.
  std::vector<Received> received(std::uint16_t apid) {
    std::vector<Received> found;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[apid].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      const auto telecommand = pus::TelecommandView::parse(next->message.packet);
      if (telecommand)
        found.push_back({telecommand_text(*telecommand), telecommand->request_id(), telecommand->source()});
    }
  }
  std::vector<std::string> texts(std::uint16_t apid) {
    std::vector<std::string> found;
    for (const Received& each : received(apid)) found.push_back(each.text);
    return found;
  }
  /// A report of a member, heard by the supervisor.
  void report(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
              std::uint16_t destination = 0, std::optional<std::uint16_t> as = std::nullopt) {
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    const auto packet = pus::write_telemetry(buffer,
                                             {.apid = as.value_or(apid),
                                              .sequence_count = played[apid].reports++,
                                              .service = service,
                                              .subtype = subtype,
                                              .destination = destination},
                                             data);
    ASSERT_TRUE(packet);
    ASSERT_TRUE(played[apid].channel.subsystem_end().send({.kind = MessageKind::Packet, .packet = *packet}));
    parts.reception.read(*craft.member(apid));
  }
  /// TM[1,subtype] of a member on a telecommand of the supervisor.
  void verify(std::uint16_t apid, std::uint32_t request, std::uint8_t subtype, pus::FailureCode code = {},
              std::uint16_t source = supervisor_apid) {
    std::array<std::byte, 6> data;
    OctetWriter writer{data};
    writer.put(request);
    writer.put(static_cast<std::uint16_t>(code));
    report(apid, 1, subtype, Octets{data}.first(subtype % 2 == 0 ? 6 : 4), source);
  }
  /// Each telecommand that a member was sent is completed, until nothing more comes.
  void obey(std::uint16_t apid) {
    for (auto sent = received(apid); !sent.empty(); sent = received(apid))
      for (const Received& each : sent) {
        constexpr std::string_view to_state = "SET_STATE ";
        if (each.text.starts_with(to_state))
          set(apid, static_cast<State>(std::stoi(each.text.substr(to_state.size()))));
        verify(apid, each.request, 7);
      }
  }
  /// All cycle and step, look at their permits, and the guard looks at them.
  void guard_sees_all() {
    guard.beat();
    for (auto& [apid, member] : played) {
      ++member.vital->cycles;
      ++member.vital->service_steps;
      member.vital->seen_epoch = member.permit->epoch.load();
    }
    static_cast<void>(guard.step(clock.now()));
  }
  [[nodiscard]] bool was_told(std::string_view line) const {
    return std::ranges::any_of(story, [&](const std::string& each) { return each.find(line) != std::string::npos; });
  }
  /// What the supervisor said itself, heard by its parts: TM[1,8] with their codes are kept.
  std::vector<std::uint16_t> own_failures() {
    static_cast<void>(parts.own.step(clock.now()));
    std::vector<std::uint16_t> codes;
    struct Ear final : Hearer {
      explicit Ear(std::vector<std::uint16_t>& all) : codes{all} {}
      void hear(std::uint16_t, const pus::TelemetryView& heard) override {
        if (heard.service() != 1 || heard.subtype() != 8) return;
        OctetReader reader{heard.source_data()};
        static_cast<void>(reader.get<std::uint32_t>());
        codes.push_back(reader.get<std::uint16_t>());
      }
      std::vector<std::uint16_t>& codes;
    } ear{codes};
    Telemetry listening{craft, parts.own, parts.traffic, parts.ground_route, {&ear}};
    MessageBuffer buffer;
    for (;;) {
      const auto next = parts.own.channel().receive(buffer);
      if (!next || next->flow == Flow::None) return codes;
      if (next->message.kind == MessageKind::Packet)
        static_cast<void>(listening.take(supervisor_apid, next->message.packet));
    }
  }
};

inline std::string to(State state) { return "SET_STATE " + std::to_string(static_cast<int>(state)); }

}  // namespace hirosco::supervisor::testing
