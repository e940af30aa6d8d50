// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <set>

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// What is commanded while a telecommand is being taken (docs/adr/0226): whatever comes, and whatever a plan answers, each is logged once, its
/// copy goes down once and before all reports on it, and nobody waits for an end in vain.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::SizeIs;
using enum descriptor::State;

/// A telecommand that the log has, and how many were in hand when it was told of this one, itself among them.
struct TakenOne {
  LogKind kind{};
  std::vector<std::byte> packet;
  std::size_t in_hand{0};
  [[nodiscard]] std::uint16_t count() const { return pus::read_primary_header(packet)->sequence_count; }
};

/// A log that sees how many have come in and have no record yet.
class TellingDatabase final : public Database {
 public:
  TellingDatabase(const std::uint32_t& come_in, std::vector<TakenOne>& taken) : come_in_{come_in}, taken_{taken} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    for (const LogRecord& record : batch)
      if (record.kind == LogKind::TelecommandReceived || record.kind == LogKind::TelecommandRefused)
        taken_.push_back({record.kind, record.packet, come_in_ - taken_.size()});
    return ok();
  }
  Result<LogPage> do_read(const LogQuery&) override { return LogPage{}; }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "telling"; }
  const std::uint32_t& come_in_;
  std::vector<TakenOne>& taken_;
};

constexpr std::uint8_t coupled_configuration = 2, wide_configuration = 3;
constexpr std::uint16_t ground_source = 7;

struct NestedTelecommandsTest : PartsTest {
  /// A report of the supervisor as it came by.
  struct Told {
    std::uint8_t service{}, subtype{};
    std::uint16_t destination{};
    std::vector<std::byte> data;
    [[nodiscard]] bool is_copy() const {
      return service == pus::st129::service_type && subtype == pus::st129::telecommand_copy;
    }
    [[nodiscard]] bool is_on(std::uint32_t request) const {
      return service == 1 && OctetReader{data}.get<std::uint32_t>() == request;
    }
  };
  std::vector<TakenOne> taken;  ///< by the order of the log
  std::vector<Told> told_of;
  std::vector<int> ends_heard;  ///< of each own telecommand for which somebody waits: how often it was told of its end
  std::uint16_t next_count{0x2000};  ///< of ground; the supervisor's own are lower
  int nested{0};

  /// ARM goes without a break from one configuration into another, for which there is never power enough.
  void SetUp() override {
    PartsTest::SetUp();
    auto& described = craft.mission.subsystems[0].subsystem;
    auto wide = described.configurations.front();
    wide.name = "WIDE";
    wide.id = wide_configuration;
    wide.power_w = 500;
    described.configurations.push_back(wide);
    described.bumpless = {{.configurations = {coupled_configuration, wide_configuration}, .steps = {}}};
    parts.power.ledger().set_budget(200);
    for (const auto& link : craft.mission.links) parts.graph.set_up(link.id, true);
    start_all(SafeOperational);
    parts.own.start(craft.mode_epoch);
    all_act();
    log.switch_to(std::make_unique<TellingDatabase>(parts.traffic.counts.telecommands, taken));
  }
  void routed(const pus::TelemetryView& packet) override {
    PartsTest::routed(packet);
    if (packet.apid() == supervisor_apid)
      told_of.push_back({packet.service(),
                         packet.subtype(),
                         packet.destination(),
                         {packet.source_data().begin(), packet.source_data().end()}});
  }
  void all_act() {
    set(arm, Operational, coupled_configuration);
    set(hand, Operational);
    set(camera, Operational);
  }
  void plan_for_a_shortage(std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan plan;
    plan.name = "short of power";
    plan.event = "POWER_REFUSED";
    plan.steps = std::move(steps);
    craft.mission.plans = {std::move(plan)};
  }
  std::vector<std::byte> call(std::uint16_t apid, std::string_view function, int argument = -1,
                              std::uint16_t source = ground_source) {
    std::vector<std::byte> packet(pus::max_telecommand_octets);
    const auto written = pus::write_telecommand(packet,
                                                {.apid = apid,
                                                 .sequence_count = next_count++,
                                                 .ack = pus::ack_all,
                                                 .service = 8,
                                                 .subtype = 1,
                                                 .source = source},
                                                call_data(function, argument));
    packet.resize(written.value().size());
    return packet;
  }
  /// Somebody waits for its end, and commands again when it is told, as the next step of a procedure does.
  void command(std::uint16_t apid, int more) {
    const std::size_t number = ends_heard.size();
    ends_heard.push_back(0);
    parts.own_telecommands.command(apid, "BRAKE", std::nullopt, [this, apid, more, number](bool, const std::string&) {
      ++ends_heard[number];
      if (more > 0) command(apid == arm ? hand : arm, more - 1);
    });
  }
  /// One that comes in, with what holds when it has been taken.
  void take(const std::vector<std::byte>& packet, const Origin& origin) {
    const auto come_in = parts.traffic.counts.telecommands;
    const std::size_t before = taken.size(), said_before = told_of.size();
    ASSERT_EQ(come_in, before) << "nothing is in hand";
    parts.telecommands.take({.packet = packet, .origin = origin});
    ASSERT_EQ(taken.size(), parts.traffic.counts.telecommands) << "each has one record when the outer one has ended";
    const std::span news{std::span{taken}.subspan(before)};
    ASSERT_FALSE(news.empty());
    EXPECT_EQ(news.back().packet, packet) << "what came of it stands before it";
    EXPECT_EQ(news.back().in_hand, 1u);
    for (std::size_t i = 0; i + 1 < news.size(); ++i) {
      EXPECT_EQ(news[i].in_hand, 2u) << "within it, and nothing within that";
      if (i > 0) {
        EXPECT_EQ(news[i].count(), news[i - 1].count() + 1) << "in the order in which they were commanded";
      }
    }
    nested += static_cast<int>(news.size()) - 1;
    EXPECT_EQ(told_of.size(), said_before) << "nobody hears anything before it has been taken";
    parts.reception.read_own();
    expect_a_copy(packet, origin, std::span{told_of}.subspan(said_before));
  }
  static void expect_a_copy(const std::vector<std::byte>& packet, const Origin& origin, std::span<const Told> said) {
    const auto request = pus::read_primary_header(packet)->request_id;
    int copies = 0, on_it = 0;
    for (const Told& each : said) {
      if (each.is_copy()) {
        ++copies;
        EXPECT_EQ(each.data, packet) << "of what a ground commands, and of nothing else";
        EXPECT_EQ(on_it, 0) << "every ground knows by it what the reports are on";
      }
      if (each.is_on(request) && each.destination == pus::TelecommandView::parse(packet)->source()) ++on_it;
    }
    EXPECT_EQ(copies, origin.is_ground() ? 1 : 0);
  }
  /// All that was sent is answered, and what is told of that is heard, until there is nothing more.
  void answer_all() {
    for (int turn = 0; turn < 12; ++turn) {
      own_step();
      for (const std::uint16_t apid : {arm, hand, camera}) obey(apid);
    }
    guard_sees_all();
    parts.safe_all.follow();
  }
};

/// In whatever order: stops by the ground and by a member, what protects, states, a shortage with every kind of answer to it, own commands
/// whose senders command again, and the death and the silence of who was commanded.
TEST_F(NestedTelecommandsTest, EachIsLoggedOnceItsCopyGoesDownFirstAndItsSenderHearsOneEndWhateverComesInBetween) {
  const std::vector<std::vector<descriptor::PlanStep>> answers{
      {{.kind = "fence"}, {.kind = "configure", .values = {wide_configuration}}},
      {{.kind = "command", .values = {1, 0, 15}, .subsystem = "HAND", .words = {"BRAKE"}},
       {.kind = "command", .values = {1, 0, 15}, .words = {"BRAKE"}}},
      {{.kind = "set_state", .values = {static_cast<std::int64_t>(SafeOperational)}}},
      {{.kind = "log"}}};
  std::mt19937 random{11};
  const auto any = [&](std::size_t of) { return static_cast<std::size_t>(random() % of); };
  for (int turn = 0; turn < 2000 && !HasFailure(); ++turn) {
    all_act();
    plan_for_a_shortage(answers[any(answers.size())]);
    const std::uint16_t whom = any(2) == 0 ? arm : hand;
    switch (any(8)) {
      case 0: take(call(supervisor_apid, "SAFE_ALL"), Origin::ground(3)); break;
      case 1: take(call(supervisor_apid, "SAFE_ALL", -1, hand), Origin::subsystem(hand)); break;
      case 2: take(call(whom, "BRAKE"), Origin::ground()); break;
      case 3: take(call(whom, "SET_STATE", static_cast<int>(SafeOperational)), Origin::ground()); break;
      case 4: take(call(arm, "CONFIGURE", wide_configuration), Origin::ground()); break;
      case 5: command(whom, static_cast<int>(any(3))); break;
      case 6: parts.own_telecommands.fail_all_to(whom, "process died"); break;
      case 7:
        wait(CommandDesk::answer_limit);
        parts.own_telecommands.watch(clock.now());
        break;
      default: break;
    }
    if (any(3) != 0) answer_all();
  }
  answer_all();
  EXPECT_THAT(ends_heard, ::testing::Each(1));
  EXPECT_GT(ends_heard.size(), 200u);
  EXPECT_GT(nested, 500) << "most of what was tried is nested";
  std::set<std::vector<std::byte>> packets;
  for (const TakenOne& each : taken) packets.insert(each.packet);
  EXPECT_EQ(packets.size(), taken.size()) << "none is logged twice";
}

TEST_F(NestedTelecommandsTest, AStopByTelecommandStandsInTheLogBehindTheStatesThatFollowIt) {
  const auto stop = call(supervisor_apid, "SAFE_ALL");
  take(stop, Origin::ground());
  EXPECT_THAT(taken, SizeIs(3));
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational)));
}

TEST_F(NestedTelecommandsTest, AShutdownHasToldEveryGroundOfItselfBeforeItIsReportedAndCommandsWithinItself) {
  take(call(supervisor_apid, "SHUTDOWN"), Origin::ground());
  EXPECT_THAT(taken, SizeIs(4)) << "the ground link, too, is brought to rest";
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

/// Without an end it would begin anew within its own first step, until the supervisor had no stack.
TEST_F(NestedTelecommandsTest, APlanThatAsksForWhatItAnswersIsRefusedOnceAndFailsByThat) {
  plan_for_a_shortage({{.kind = "fence"}, {.kind = "configure", .values = {wide_configuration}}});
  take(call(arm, "CONFIGURE", wide_configuration), Origin::ground());
  EXPECT_EQ(nested, 1);
  EXPECT_TRUE(guard.fenced(arm));
  const auto short_of_power = [](const std::string& line) { return line.starts_with("power short: ARM"); };
  EXPECT_EQ(std::ranges::count_if(story, short_of_power), 2) << "both are told";
  EXPECT_TRUE(was_told("plan failed")) << "who began the plan hears of it when its step is told as refused";
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  answer_all();
  all_act();
  story.clear();
  take(call(arm, "CONFIGURE", wide_configuration), Origin::ground());
  EXPECT_TRUE(was_told("POWER_REFUSED")) << "the next one is answered as the first";
  EXPECT_EQ(nested, 2);
}

/// The deepest there is: a telecommand that is refused for power, what the plan for that asks for, and the way up of a ground link that
/// waited for the disk and leaves with it.
TEST_F(NestedTelecommandsTest, ThreeAreInHandWhereAPlanLetsAGroundLinkLeaveThatWaitedForTheDiskAndNeverMore) {
  craft.mission.modes.front().commission = {
      {.subsystem = "CAMERA", .configuration = "ONLY", .state = Operational, .at = {}}};
  ends[played[camera].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  ASSERT_FALSE(craft.member(camera)->alive());
  const auto hold = std::make_shared<HeldDatabase::Hold>();
  const auto stored = std::make_shared<MemoryDatabase>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, stored));
  hold->tries = 1'000'000;
  const auto start = call(camera, "SET_STATE", static_cast<int>(Offline));
  parts.telecommands.take({.packet = start, .origin = Origin::ground()});
  ASSERT_TRUE(parts.telecommands.waiting_since());
  hold->tries = 0;
  plan_for_a_shortage({{.kind = "command", .values = {0, 0, 15}, .words = {"MOVE_TO"}}});
  const auto wide = call(arm, "CONFIGURE", wide_configuration);
  parts.telecommands.take({.packet = wide, .origin = Origin::ground()});
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO")) << "the plan's";
  EXPECT_THAT(texts(camera), ElementsAre(to(PreOperational))) << "the way up's";
  std::vector<std::pair<LogKind, std::uint16_t>> order;
  for (const LogRecord& record : all_of(*stored))
    if (const auto header = pus::read_primary_header(record.packet); header && header->telecommand)
      order.emplace_back(record.kind, header->apid);
  using enum LogKind;
  EXPECT_THAT(order, ElementsAre(std::pair{TelecommandReceived, camera}, std::pair{TelecommandReceived, arm},
                                 std::pair{TelecommandForwarded, camera}, std::pair{TelecommandReceived, camera},
                                 std::pair{TelecommandForwarded, arm}, std::pair{TelecommandRefused, arm}))
      << "what is not essential is logged before it leaves, and what comes of its leaving behind it";
}

}  // namespace
}  // namespace hirosco::supervisor
