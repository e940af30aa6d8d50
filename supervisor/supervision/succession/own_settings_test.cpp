// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/parameter/type.hpp"
#include "supervisor/supervision/testing/adoption_rig.hpp"

/// What ground has set of the supervisor itself, under those that go on for it (docs/adr/0205).
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;

template <class... Values>
std::vector<std::byte> own_data(Values... values) {
  std::vector<std::byte> data(64);
  OctetWriter writer{data};
  (writer.put(values), ...);
  data.resize(writer.size());
  return data;
}
constexpr std::uint8_t a_single = 1, is_off = 0, is_on = 1, no_more_sets = 0;
/// Of supervisor.xml: every 100 and every 20 cycles, an event that no safety rests on; and a structure that ground makes.
constexpr std::uint16_t counts_structure = 4701, rows_structure = 4702, log_rotated = 122, made_structure = 5000;
constexpr std::uint32_t counts_interval = 100, rows_interval = 20, longer_interval = 50, newest_interval = 80;
constexpr Duration own_cycle = 10ms, starts_within = 300ms;

struct OwnSettingsTest : AdoptionTest {
  std::uint16_t sent{0};
  std::map<std::pair<int, int>, std::vector<std::byte>> heard;  ///< source data, by service and subtype
  std::vector<std::uint16_t> events, structures;  ///< ids that were reported

  void SetUp() override {
    AdoptionTest::SetUp();
    start_all(SafeOperational);
    start_supervisor();
    ASSERT_FALSE(parts.commanded.in_use()) << "of its members nothing is kept here";
  }
  void routed(const pus::TelemetryView& report) override {
    AdoptionTest::routed(report);
    if (report.apid() != supervisor_apid) return;
    const Octets data = report.source_data();
    heard[{report.service(), report.subtype()}] = {data.begin(), data.end()};
    if (report.service() == 5 && report.subtype() <= 4) events.push_back(OctetReader{data}.get<std::uint16_t>());
    if (report.service() == 3 && report.subtype() == 25) structures.push_back(OctetReader{data}.get<std::uint16_t>());
  }
  void steps(SupervisorParts& of, Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      wait(1ms);
      of.craft.now = clock.now();
      of.own.beat(of.own.beats() + 1);
      of.telecommands.forward_durable();
      static_cast<void>(of.own.step(clock.now()));
      of.reception.read_own();
    }
  }
  /// It is on its way; nobody has looked at it.
  void ground_sends(SupervisorParts& to, std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data,
                    std::uint8_t ack = pus::ack_all) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = supervisor_apid,
                                                .sequence_count = ++sent,
                                                .ack = ack,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    to.telecommands.take({.packet = *packet, .origin = Origin::ground()});
  }
  void ground_sets(SupervisorParts& of, std::uint8_t service, std::uint8_t subtype,
                   const std::vector<std::byte>& data) {
    heard.erase({1, 7});
    ground_sends(of, service, subtype, data);
    steps(of, 3ms);
    ASSERT_TRUE(heard.contains({1, 7})) << int{service} << "," << int{subtype};
  }
  void ground_sets_all(SupervisorParts& of) {
    const std::uint32_t mode = ParameterId{supervisor_apid, Type::Uint8, 0}.wire();
    ground_sets(of, 3, 31, own_data(a_single, rows_structure, longer_interval));
    ground_sets(of, 3, 6, own_data(a_single, counts_structure));
    ground_sets(of, 3, 1, own_data(made_structure, newest_interval, a_single, mode, no_more_sets));
    ground_sets(of, 3, 5, own_data(a_single, made_structure));
    ground_sets(of, 5, 6, own_data(std::uint8_t{2}, log_rotated, descriptor::framework_event::state_changed));
  }
  void all_is_as_set(SupervisorParts& of) {
    ground_sets(of, 3, 33, own_data(std::uint8_t{3}, rows_structure, counts_structure, made_structure));
    EXPECT_EQ((heard[{3, 35}]), own_data(std::uint8_t{3}, rows_structure, is_on, longer_interval, counts_structure,
                                         is_off, counts_interval, made_structure, is_on, newest_interval));
    ground_sets(of, 5, 7, {});
    EXPECT_EQ((heard[{5, 8}]), own_data(std::uint8_t{2}, log_rotated, descriptor::framework_event::state_changed));
  }
  [[nodiscard]] std::uint32_t interval_of_rows(SupervisorParts& of) {
    ground_sets(of, 3, 33, own_data(a_single, rows_structure));
    OctetReader reader{heard[{3, 35}]};
    static_cast<void>(reader.get(1 + 2 + 1));
    return reader.get<std::uint32_t>();
  }
  /// The newest supervisor has died; the next one is Operational.
  SupervisorParts& goes_on() {
    SupervisorParts& next = go_on();
    steps(next, starts_within);
    EXPECT_EQ(next.own.state(), Operational);
    EXPECT_FALSE(next.commanded.owes_own_settings());
    return next;
  }
  /// One that has begun nothing yet.
  SupervisorParts& another() {
    nexts.push_back(std::make_unique<Next>(*this, 5000 + 1000 * static_cast<std::uint32_t>(nexts.size())));
    return nexts.back()->parts;
  }
};

TEST_F(OwnSettingsTest, AreSoUnderEachSupervisorHoweverManyDie) {
  ground_sets_all(parts);
  all_is_as_set(parts);
  ASSERT_TRUE(notes.note());
  for (int death = 0; death < 3; ++death) {
    SupervisorParts& next = goes_on();
    all_is_as_set(next);
    ASSERT_TRUE(next.memory.note());
  }
  EXPECT_FALSE(was_told("NOT_RESTORED"));
  EXPECT_FALSE(was_told("COMMAND_NOT_KEPT"));
}

TEST_F(OwnSettingsTest, AreSoUnderOneThatGoesOnForOneThatHadNotSetItselfYet) {
  ground_sets_all(parts);
  ASSERT_TRUE(notes.note());
  SupervisorParts& first = go_on();
  ASSERT_TRUE(first.commanded.owes_own_settings());
  ASSERT_TRUE(first.memory.note());
  SupervisorParts& halfway = go_on();
  for (int step = 0; step < 200 && halfway.own.configuration() == 0; ++step) steps(halfway, 1ms);
  steps(halfway, 1ms);
  ASSERT_TRUE(halfway.commanded.owes_own_settings()) << "it is in the midst of it";
  ASSERT_TRUE(halfway.memory.note());
  all_is_as_set(goes_on());
}

TEST_F(OwnSettingsTest, AreSoBeforeTheFirstReportGoesOut) {
  EXPECT_THAT(events, Contains(descriptor::framework_event::state_changed)) << "nobody has switched it off yet";
  ground_sets_all(parts);
  ASSERT_TRUE(notes.note());
  events.clear();
  structures.clear();
  SupervisorParts& next = go_on();
  next.own.announce("LOG_ROTATED", {1});
  steps(next, own_cycle * (longer_interval - 1));
  EXPECT_EQ(next.own.state(), Operational);
  EXPECT_THAT(events, Not(Contains(log_rotated)));
  EXPECT_THAT(events, Not(Contains(descriptor::framework_event::state_changed)));
  EXPECT_TRUE(was_told("LOG_ROTATED")) << "it is an event all the same";
  EXPECT_THAT(structures, Not(Contains(rows_structure))) << "not in the interval of the descriptor";
  steps(next, starts_within);
  EXPECT_THAT(structures, Contains(rows_structure));
  steps(next, own_cycle * counts_interval);
  EXPECT_THAT(structures, Not(Contains(counts_structure)));
}

TEST_F(OwnSettingsTest, AreUndoneByNoStopAndNoPlan) {
  ground_sets_all(parts);
  parts.commanded.all_stopped();
  parts.commanded.lower(arm, Offline, "TOO_HOT");
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = go_on();
  next.commanded.all_stopped();
  steps(next, starts_within);
  all_is_as_set(next);
}

TEST_F(OwnSettingsTest, AreThoseThatGroundSetLast) {
  ground_sets_all(parts);
  ground_sets(parts, 3, 31, own_data(a_single, rows_structure, newest_interval));
  ground_sets(parts, 5, 5, own_data(a_single, log_rotated));
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = goes_on();
  EXPECT_EQ(interval_of_rows(next), newest_interval);
  ground_sets(next, 5, 7, {});
  EXPECT_EQ((heard[{5, 8}]), own_data(a_single, descriptor::framework_event::state_changed));
}

TEST_F(OwnSettingsTest, OfOneThatHadLeftAndWasNotEndedComeLast) {
  ground_sets_all(parts);
  ground_sends(parts, 3, 31, own_data(a_single, rows_structure, newest_interval));
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = goes_on();
  EXPECT_EQ(interval_of_rows(next), newest_interval);
  EXPECT_FALSE(was_told("COMMAND_NOT_KEPT"));
  ASSERT_TRUE(next.memory.note());
  EXPECT_EQ(interval_of_rows(goes_on()), newest_interval);
}

TEST_F(OwnSettingsTest, ThatAreRefusedAreToldAndHoldTheOthersUpNotAtAll) {
  constexpr std::uint16_t nobodys = 9999;
  ground_sets_all(parts);
  ground_sends(parts, 3, 31, own_data(a_single, nobodys, newest_interval));
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = goes_on();
  all_is_as_set(next);
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=1 SERVICE=3 SUBTYPE=31"));
}

TEST_F(OwnSettingsTest, OfWhichNoWholeNoteTellsAreToldAsLost) {
  ground_sets_all(parts);
  ASSERT_TRUE(notes.note());
  journal.clear();
  SupervisorParts& next = goes_on();
  EXPECT_TRUE(was_told("SUPERVISOR medium NOT_RESTORED APID=1"));
  EXPECT_EQ(interval_of_rows(next), rows_interval) << "as its descriptor says";
  ASSERT_TRUE(next.memory.note());
  story.clear();
  goes_on();
  EXPECT_FALSE(was_told("NOT_RESTORED")) << "it is known again: nothing was set since";
}

TEST_F(OwnSettingsTest, AreTakenWholeFromANoteOrNotAtAll) {
  ground_sets_all(parts);
  std::vector<std::byte> room(4096);
  OctetWriter writer{room};
  parts.commanded.note(writer);
  const Octets whole = writer.written();
  for (std::size_t octets = 0; octets < whole.size(); ++octets) {
    OctetReader torn{whole.first(octets)};
    SupervisorParts& next = another();
    next.commanded.recall(torn);
    ASSERT_FALSE(next.commanded.owes_own_settings()) << octets;
    EXPECT_THAT(next.commanded.own_settings(PreOperational), IsEmpty()) << octets;
    nexts.pop_back();
  }
  OctetReader reader{whole};
  SupervisorParts& next = another();
  next.commanded.recall(reader);
  EXPECT_TRUE(reader.exhausted());
  EXPECT_TRUE(next.commanded.owes_own_settings());
  std::vector<std::byte> again(4096);
  OctetWriter noted{again};
  next.commanded.note(noted);
  EXPECT_TRUE(std::ranges::equal(noted.written(), whole)) << "until it is so it is handed on as it was";
}

TEST_F(OwnSettingsTest, ThatHaveNoRoomOrNoEndAreToldWhenTheyAreSet) {
  std::vector<std::byte> wide(900), buffer(pus::max_telemetry_octets);
  for (std::uint16_t id = made_structure; id < made_structure + 20; ++id) {
    OctetWriter{wide}.put(id).put(newest_interval);
    const auto definition = telecommand(supervisor_apid, 3, 1, wide);
    const auto view = pus::TelecommandView::parse(definition).value();
    parts.commanded.forwarded(supervisor_apid, view, Origin::ground());
    const auto done = pus::write_telemetry(
        buffer, {.apid = supervisor_apid, .service = 1, .subtype = 7, .destination = view.source()},
        own_data(view.request_id()));
    parts.commanded.hear(supervisor_apid, pus::TelemetryView::parse(*done).value());
  }
  steps(parts, 2ms);
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=1 SERVICE=3 SUBTYPE=1"));
  ground_sends(parts, 5, 6, own_data(a_single, log_rotated), 0);
  steps(parts, 2ms);
  EXPECT_TRUE(was_told("COMMAND_NOT_KEPT APID=1 SERVICE=5 SUBTYPE=6"));
}

}  // namespace
}  // namespace hirosco::supervisor
