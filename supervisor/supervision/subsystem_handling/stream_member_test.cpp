// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/pages/stream_subsystem_port.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"
#include "supervisor/supervision/testing/stream_member_port.hpp"
#include "supervisor/supervisor.hpp"

/// The proof of docs/adr/0066: a member that shares no page with its supervisor, over a real stream.
namespace hirosco::supervisor {
namespace {

using ::testing::Contains;

constexpr std::uint16_t probe_apid = 10;
constexpr std::uint16_t ground_apid = 20;

/// What a computer of its own would hold: a whole subsystem, its pages, its end of the stream.
struct FarComputer {
  FarComputer(const descriptor::SubsystemDescriptor& described, const Platform& platform, FileDescriptor stream)
      : port{std::move(stream), vital, permit}, engine{author, described, platform, port.channel(), vital, permit} {}
  void step(TimePoint now) {
    port.step(now);
    static_cast<void>(engine.service_step(now));
    const auto demand = engine.cycle_demand();
    if (demand.wanted) static_cast<void>(engine.cycle_step(now));
    else engine.cycle_parked(demand.ticket);
  }
  [[nodiscard]] bool may_move() const { return permit.permits(permit.epoch.load()); }

  hirosco::testing::Probe author;
  VitalPage vital;
  PermitPage permit;
  StreamSubsystemPort port;
  GenericSubsystem engine;
};

/// PROBE behind a stream and a ground link that the test plays, commissioned by the whole supervisor, on virtual time.
struct StreamMemberTest : ::testing::Test, ProcessLauncher, Observer {
  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows, far_flows;
  descriptor::Mission mission = [] {
    descriptor::Mission made;
    made.supervisor =
        descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/supervisor/supervisor.xml", descriptor::file_system())
            .value.value();
    const descriptor::FileSource probe = [](const auto&) {
      return Result<std::string>{hirosco::testing::probe_descriptor};
    };
    descriptor::MissionSubsystem member;
    member.subsystem = descriptor::read_subsystem("probe.xml", probe).value.value();
    made.subsystems.push_back(member);
    descriptor::MissionSubsystem ground_link;
    ground_link.subsystem.name = "GROUND";
    ground_link.subsystem.id = ground_apid;
    ground_link.subsystem.configurations.emplace_back();
    ground_link.subsystem.configurations.front().id = 1;
    made.subsystems.push_back(ground_link);
    made.ground.subsystem = "GROUND";
    descriptor::Mode mode;
    mode.name = "work";
    mode.id = 1;
    mode.commission = {{.subsystem = "PROBE", .configuration = "ALONE", .state = State::Operational, .at = {}}};
    mode.permits = {{.subsystem = "*", .functions = {"*"}, .services = {3, 5, 17, 20}, .parameters = {}, .at = {}}};
    made.modes = {mode};
    made.initial_mode = made.start_mode = "work";
    descriptor::Plan again;
    again.name = "again";
    again.event = "PROCESS_DIED";
    again.steps = {{"restart", {3, 60, 100, 0}}};
    made.plans = {again};
    return made;
  }();
  Guard guard{{.clock = clock, .flows = flows, .first_epoch = 1000, .on_finding = {}}};
  DirectPacketLog log{clock, open_database(DatabaseStrategy::Memory, {}).value()};
  std::unique_ptr<FarComputer> far;
  ChannelPair ground;
  std::shared_ptr<VitalPage> ground_vital = std::make_shared<VitalPage>();
  std::shared_ptr<PermitPage> ground_permit = std::make_shared<PermitPage>();
  std::uint32_t processes{0}, probe_process{0};
  std::optional<ProcessEnd> end;  ///< of the probe's
  std::vector<std::string> story;
  std::vector<std::uint8_t> heard;  ///< TM[1,x] that ground has of its telecommands
  FileDescriptor raw;  ///< the far end of the next stream, where the test plays it itself
  bool plays_far{false};
  TimePoint guard_wake{};
  std::unique_ptr<Supervisor> supervisor;

  void SetUp() override {
    clock.set(TimePoint{10s});
    supervisor = std::make_unique<Supervisor>(Supervisor::Parts{
        .mission = mission,
        .platform = {.clock = clock, .memory = memory, .flows = flows, .realtime = true, .explain = {}},
        .launcher = *this,
        .guard = guard,
        .log = log,
        .open_database = [](DatabaseStrategy) -> std::unique_ptr<Database> { return nullptr; },
        .observer = *this});
    supervisor->start();
  }

  struct GroundEnd final : Channel {
    explicit GroundEnd(ChannelPair& both) : pair{both} {}
    Result<> send(const Message& message) override { return pair.supervisor_end().send(message); }
    Result<Found> receive(MessageBuffer& buffer) override { return pair.supervisor_end().receive(buffer); }
    ChannelPair& pair;
  };
  template <class Page>
  static Mapping mapping_of(const std::shared_ptr<Page>& page) {
    return {page, {reinterpret_cast<std::byte*>(page.get()), sizeof(Page)}};
  }
  // ProcessLauncher
  Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& described) override {
    LaunchedSubsystem launched;
    launched.process = ++processes;
    if (described.subsystem.id == ground_apid) {
      launched.vital = mapping_of(ground_vital);
      launched.permit = mapping_of(ground_permit);
      launched.port =
          std::make_unique<LocalMemberPort>(std::make_unique<GroundEnd>(ground), launched.vital, launched.permit);
      ground_vital->state = static_cast<std::uint32_t>(State::Operational);
      ground_vital->configuration = 1;
      return launched;
    }
    probe_process = launched.process;
    end.reset();
    auto ends = StreamChannel::make_pair().value();
    auto port = std::make_unique<testing::StreamMemberPort>(std::move(ends.first));
    launched.vital = port->vital_page();
    launched.permit = port->permit_page();
    launched.port = std::move(port);
    if (plays_far) raw = std::move(ends.second);
    else
      far = std::make_unique<FarComputer>(described.subsystem,
                                          Platform{.clock = clock, .memory = memory, .flows = far_flows, .explain = {}},
                                          std::move(ends.second));
    return launched;
  }
  std::optional<ProcessEnd> ended(std::uint32_t process) override {
    return process == probe_process ? end : std::nullopt;
  }
  void kill(std::uint32_t) override {
    far.reset();
    raw.reset();
    end = ProcessEnd{.by_signal = true, .value = 9};
  }
  // Observer
  void told(OnboardTime, std::string_view line) override { story.emplace_back(line); }

  /// A millisecond of both computers and the guard.
  void step() {
    clock.advance(1ms);
    if (far) far->step(clock.now());
    ++ground_vital->service_steps;
    if (clock.now() >= guard_wake) guard_wake = guard.step(clock.now());
    static_cast<void>(supervisor->step(clock.now()));
    MessageBuffer buffer;
    while (true) {
      const auto found = ground.subsystem_end().receive(buffer);
      if (!found || found->flow == Flow::None) return;
      const auto report = pus::TelemetryView::parse(found->message.packet);
      if (report && report->service() == 1 && report->destination() == 7 && report->apid() == probe_apid)
        heard.push_back(report->subtype());
    }
  }
  /// False: not within that many milliseconds.
  bool until(const std::function<bool()>& condition, int most = 3000) {
    for (; most > 0 && !condition(); --most) step();
    return condition();
  }
  [[nodiscard]] const Member& member() const { return supervisor->members().front(); }
  bool commission() {
    return until([&] { return supervisor->commissioned(); });
  }
  void command(std::uint8_t service, std::uint8_t subtype, Octets data) {
    heard.clear();
    const auto packet = testing::telecommand(probe_apid, service, subtype, data);
    ASSERT_TRUE(ground.subsystem_end().send(
        {.kind = MessageKind::GroundTelecommand, .epoch = guard.newest_stop(), .packet = packet}));
  }
  void command_state(State state) { command(8, 1, testing::call_data("SET_STATE", static_cast<int>(state))); }
  bool completed() {
    return until([&] { return std::ranges::find(heard, 7) != heard.end(); }, 200);
  }
  [[nodiscard]] std::string all() const {
    std::string lines;
    for (const auto& line : story) lines.append(line).append("\n");
    return lines;
  }
};

TEST_F(StreamMemberTest, IsCommissionedAndItsStateAndStatisticsAreSeen) {
  ASSERT_TRUE(commission()) << all();
  EXPECT_EQ(far->engine.state(), State::Operational);
  EXPECT_EQ(member().state(), State::Operational);
  EXPECT_EQ(member().configuration(), 1);
  const auto statistics = member().statistics().value();
  EXPECT_TRUE(statistics.cycling);
  EXPECT_EQ(statistics.period_ns, 500'000u);
  EXPECT_GT(statistics.cycles, 0u);
  EXPECT_EQ(statistics.inhibited, 0u);
  EXPECT_TRUE(far->may_move());
}

TEST_F(StreamMemberTest, IsCommandedFromGroundAndItsReportsComeBack) {
  ASSERT_TRUE(commission()) << all();
  command(17, 1, {});
  EXPECT_TRUE(completed());
  EXPECT_EQ(heard, (std::vector<std::uint8_t>{1, 3, 7}));
}

TEST_F(StreamMemberTest, IsFencedAtItsOwnPageAndReleasedByItsNextOperational) {
  ASSERT_TRUE(commission()) << all();
  const std::uint32_t before = far->permit.epoch;
  guard.fence(probe_apid);
  step();
  step();
  EXPECT_FALSE(far->may_move());
  EXPECT_GT(far->permit.epoch, before);
  EXPECT_NE(far->vital.inhibited.load() & inhibited_by_stop, 0u);
  EXPECT_TRUE(until([&] { return member().statistics()->inhibited != 0; }, 20)) << "and the supervisor sees it";
  EXPECT_FALSE(guard.release(probe_apid, 0)) << "what was permitted before does not lift it";
  for (const State state : {State::SafeOperational, State::Operational}) {
    command_state(state);
    ASSERT_TRUE(completed()) << all();
  }
  EXPECT_TRUE(far->may_move());
  EXPECT_TRUE(until([&] { return member().statistics()->inhibited == 0; }, 20));
}

TEST_F(StreamMemberTest, WhoseComputerEndsIsLostAndStartedAgain) {
  ASSERT_TRUE(commission()) << all();
  far.reset();
  ASSERT_TRUE(until([&] { return member().closed_at.has_value(); }, 5)) << all();
  EXPECT_TRUE(guard.fenced(probe_apid));
  ASSERT_TRUE(until([&] { return !member().alive(); }, 1100)) << all();
  EXPECT_THAT(story, Contains("PROBE died: signal 9"));
  ASSERT_TRUE(until([&] { return member().alive(); })) << all();
  EXPECT_EQ(processes, 3u) << "a new one";
  EXPECT_TRUE(until([&] { return member().state() == State::Offline; }, 50));
  EXPECT_FALSE(far->may_move());
  command_state(State::PreOperational);
  EXPECT_TRUE(completed()) << all();
  EXPECT_TRUE(until([&] { return member().state() == State::PreOperational; }, 50)) << all();
}

TEST_F(StreamMemberTest, WhoseSupervisorIsSilentStopsItselfAndEndsWhenItIsGone) {
  ASSERT_TRUE(commission()) << all();
  for (int i = 0; i < 1100; ++i) {
    clock.advance(1ms);
    far->step(clock.now());
  }
  EXPECT_FALSE(far->may_move());
  supervisor.reset();
  for (int i = 0; i < 3000 && !far->engine.finished(); ++i) {
    clock.advance(1ms);
    far->step(clock.now());
  }
  EXPECT_TRUE(far->engine.finished());
  EXPECT_EQ(far->engine.state(), State::Offline);
}

TEST_F(StreamMemberTest, WhoseComputerStandsStillHangsIsFencedAndLost) {
  ASSERT_TRUE(commission()) << all();
  const auto standing = std::move(far);
  EXPECT_TRUE(until([&] { return guard.fenced(probe_apid); }, 300)) << all();
  EXPECT_THAT(story, Contains("PROBE hangs: its cycle stands still"));
  EXPECT_TRUE(standing->may_move()) << "it has not heard of it";
  standing->step(clock.now());
  EXPECT_FALSE(standing->may_move()) << "what it hears first is the fence";
}

/// The far end is played octet by octet.
struct StreamMemberAbuse : StreamMemberTest {
  StreamMemberAbuse() { plays_far = true; }
  void say(Octets octets) {
    ASSERT_EQ(::send(raw.get(), octets.data(), octets.size(), MSG_NOSIGNAL), static_cast<ssize_t>(octets.size()));
  }
};

TEST_F(StreamMemberAbuse, OfAnotherVersionIsRefusedByNameAndEnded) {
  say(std::array{std::byte{0x48}, std::byte{0x4D}, std::byte{stream_frame_version + 1}});
  ASSERT_TRUE(until([&] { return member().closed_at.has_value(); }, 5)) << all();
  EXPECT_TRUE(guard.fenced(probe_apid));
  ASSERT_TRUE(until([&] { return !member().alive(); }, 1100)) << all();
  EXPECT_THAT(story, Contains("PROBE: 1 messages could not be read: another version of a member's stream; build both "
                              "from one hirosco (3)"));
}

TEST_F(StreamMemberAbuse, ThatSaysNothingOfASenseIsCountedAndEnded) {
  say(std::array<std::byte, 64>{});
  ASSERT_TRUE(until([&] { return !member().alive(); }, 1100)) << all();
  EXPECT_THAT(story, Contains("PROBE: 1 messages could not be read"));
}

}  // namespace
}  // namespace hirosco::supervisor
