// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/downlink/catch_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "hirosco/descriptor/read/read.hpp"

/// A station that missed something of a mission with a lamp, whose supervisor the test plays.
namespace hirosco::ground {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace st129 = pus::st129;

constexpr std::uint16_t us = 0xE000;
constexpr OnboardTime midday{std::chrono::seconds{2'145'916'900}};

class AStationThatMissedSomething : public ::testing::Test {
 protected:
  static descriptor::Mission mission() {
    const descriptor::FileSource source = [](const std::filesystem::path& file) -> Result<std::string> {
      if (file == "lamp.xml")
        return std::string{
            R"(<Subsystem name="LAMP" id="11"><Configuration name="ON" id="1" sampling_us="10000"/></Subsystem>)"};
      if (file == "mission.xml")
        return std::string{R"(<Mission name="LIGHT"><Supervisor descriptor="supervisor.xml"/>
<Subsystem executable="lamp" descriptor="lamp.xml"/><Modes initial="dark" start="dark"><Mode name="dark">
<Permit subsystem="*" functions="SET_STATE CONFIGURE SET_MODE SHUTDOWN"/></Mode></Modes></Mission>)"};
      return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / "supervisor" / file.filename());
    };
    auto reading = descriptor::read_mission("mission.xml", source);
    for (const auto& problem : reading.problems) ADD_FAILURE() << descriptor::render(problem, source, false);
    return reading.value.value_or(descriptor::Mission{});
  }
  std::vector<std::byte> packet(std::uint8_t service, std::uint8_t subtype, Octets data, OnboardTime t,
                                std::uint16_t destination = 0, std::uint16_t apid = pus::supervisor_apid) {
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    const auto made = pus::write_telemetry(buffer,
                                           {.apid = apid,
                                            .sequence_count = count++,
                                            .service = service,
                                            .subtype = subtype,
                                            .destination = destination,
                                            .time = t},
                                           data);
    return {made->begin(), made->end()};
  }
  /// A subsystem of the mission changed its state.
  std::vector<std::byte> state_changed(descriptor::State state, OnboardTime t) {
    const descriptor::SubsystemDescriptor& subsystem = *catalogue.subsystems().back();
    const auto event = std::ranges::find(subsystem.events, "STATE_CHANGED", &descriptor::Event::name);
    std::array<std::byte, 3> data{};
    OctetWriter{data}.put(event->id).put(static_cast<std::uint8_t>(state));
    return packet(5, 1, data, t, 0, subsystem.id);
  }
  bool hears(const std::vector<std::byte>& octets) { return catch_up.hear(*pus::TelemetryView::parse(octets)); }
  bool comes_down(const std::vector<std::byte>& missed, std::uint16_t destination = us) {
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    return hears(packet(st129::service_type, st129::retrieved, st129::write_retrieved(buffer, {number++, missed}),
                        midday, destination));
  }
  /// Of what was asked last, where nothing else is said.
  bool ends(st129::RetrievalEnd end = {}, std::uint16_t destination = us) {
    if (end.request == 0) end.request = static_cast<std::uint32_t>(asked.size());
    return hears(
        packet(st129::service_type, st129::retrieval_end, st129::write_retrieval_end(end), midday, destination));
  }
  void pass(Duration time) {
    clock.advance(time);
    catch_up.tick();
  }
  std::vector<std::vector<std::byte>> archived() {
    std::vector<std::vector<std::byte>> all;
    archive->packets({}, [&](const StoredPacket& stored) {
      all.push_back(stored.octets);
      return true;
    });
    return all;
  }
  std::vector<std::string> states() {
    std::vector<std::string> all;
    for (const StoredChange& change : archive->changes({}))
      if (change.kind == "state") all.push_back(change.value);
    return all;
  }

  Catalogue catalogue{mission()};
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  ManualClock clock;
  std::uint16_t count{0};
  std::uint64_t number{1};
  bool link{true};
  std::vector<st129::Retrieve> asked;
  std::vector<std::string> events;
  std::vector<Span> filled;
  CatchUp catch_up{{.catalogue = catalogue,
                    .archive = *archive,
                    .clock = clock,
                    .source = us,
                    .ask = [this](const st129::Retrieve& wanted) -> std::optional<std::uint32_t> {
                      if (!link) return std::nullopt;
                      asked.push_back(wanted);
                      return static_cast<std::uint32_t>(asked.size());
                    },
                    .heard =
                        [this](const Heard& heard, OnboardTime) {
                          if (heard.event) events.push_back(heard.event->name);
                        },
                    .filled = [this](OnboardTime from, OnboardTime to) { filled.push_back({from, to}); }}};
};

TEST_F(AStationThatMissedSomething, AsksForItOnceAndKeepsWhatComesAsIfItHadHeardIt) {
  catch_up.link_up();
  catch_up.missing(midday, midday + 30s);
  archive->add(StoredGap{midday, midday + 30s});
  pass(50ms);
  pass(50ms);
  ASSERT_THAT(asked, SizeIs(1));
  EXPECT_EQ(asked[0], (st129::Retrieve{midday - 2s, midday + 32s, true})) << "stored a little after it was stamped";
  using enum descriptor::State;
  const std::vector missed{state_changed(PreOperational, midday + 1s), state_changed(Operational, midday + 2s)};
  for (const auto& one : missed) EXPECT_TRUE(comes_down(one));
  EXPECT_TRUE(ends({.reports = 2}));
  EXPECT_EQ(archived(), missed) << "the packets themselves, not what brought them";
  EXPECT_THAT(states(), ElementsAre("PreOperational", "Operational"));
  EXPECT_THAT(events, ElementsAre("STATE_CHANGED", "STATE_CHANGED"));
  EXPECT_THAT(archive->gaps({}), IsEmpty());
  ASSERT_THAT(filled, SizeIs(1));
  EXPECT_EQ(filled[0].from, midday);
  pass(60s);
  EXPECT_THAT(asked, SizeIs(1)) << "nothing is left";
}

TEST_F(AStationThatMissedSomething, WhatItHasAlreadyIsNotKeptTwice) {
  catch_up.link_up();
  const auto known = state_changed(descriptor::State::Operational, midday + 1s);
  StoredPacket stored;
  stored.t = pus::TelemetryView::parse(known)->time();
  archive->add(stored, known);
  catch_up.missing(midday, midday + 30s);
  pass(50ms);
  EXPECT_TRUE(comes_down(known));
  EXPECT_THAT(archived(), ElementsAre(known));
  EXPECT_THAT(events, IsEmpty());
  const auto just_before = state_changed(descriptor::State::Offline, midday - 1ms);
  EXPECT_TRUE(comes_down(just_before)) << "of one subsystem the newest before the link broke, of another missed";
  EXPECT_THAT(archived(), ElementsAre(just_before, known));
}

TEST_F(AStationThatMissedSomething, OfALongTimeComesTheEndFirstAndOfAllOfItNoHousekeeping) {
  catch_up.link_up();
  catch_up.missing(midday - 1h, midday);
  pass(50ms);
  EXPECT_TRUE(ends());
  pass(50ms);
  EXPECT_TRUE(ends());
  ASSERT_THAT(asked, SizeIs(2));
  EXPECT_EQ(asked[0], (st129::Retrieve{midday - CatchUp::whole_span - 2s, midday + 2s, true}));
  EXPECT_EQ(asked[1], (st129::Retrieve{midday - 1h - 2s, midday + 2s, false}));
}

TEST_F(AStationThatMissedSomething, OfABeginAllIsThereWhenItCameHoweverLateItsFirstReport) {
  catch_up.link_up();
  archive->add(StoredGap{midday, midday + 60s});
  catch_up.missing(midday, midday + 60s, CatchUp::After::TheBegin);
  pass(50ms);
  EXPECT_TRUE(comes_down(state_changed(descriptor::State::Operational, midday + 20s)));
  EXPECT_TRUE(ends({.reports = 1}));
  EXPECT_THAT(archive->gaps({}), IsEmpty());
}

TEST_F(AStationThatMissedSomething, WhereTheLogHasNothingOfItItStaysMissing) {
  catch_up.link_up();
  archive->add(StoredGap{midday, midday + 60s});
  catch_up.missing(midday, midday + 60s);
  pass(50ms);
  EXPECT_TRUE(ends());
  EXPECT_THAT(archive->gaps({}), SizeIs(1)) << "another flight's";
}

TEST_F(AStationThatMissedSomething, AGapThatWasNotFilledWholeStaysOne) {
  catch_up.link_up();
  for (const st129::RetrievalEnd& end :
       {st129::RetrievalEnd{.missing = 1}, st129::RetrievalEnd{.left_out = 1}, st129::RetrievalEnd{.damaged = 1}}) {
    archive->add(StoredGap{midday, midday + 1s});
    catch_up.missing(midday, midday + 1s);
    pass(50ms);
    EXPECT_TRUE(ends(end));
    EXPECT_THAT(archive->gaps({}), SizeIs(1));
    archive->close_gaps({});
  }
}

TEST_F(AStationThatMissedSomething, BeforeTheFirstReportThatCameNobodyKnowsAnything) {
  catch_up.link_up();
  archive->add(StoredGap{midday, midday + 60s});
  catch_up.missing(midday, midday + 60s);
  pass(50ms);
  EXPECT_TRUE(comes_down(state_changed(descriptor::State::Operational, midday + 20s)));
  EXPECT_TRUE(ends({.reports = 1}));
  const auto gaps = archive->gaps({});
  ASSERT_THAT(gaps, SizeIs(1)) << "the flight before has a log of its own";
  EXPECT_EQ(gaps[0].from, midday);
  EXPECT_EQ(gaps[0].to, midday + 20s);
}

TEST_F(AStationThatMissedSomething, AsksAgainWhereNobodyAnswersAndGivesUpInTheEnd) {
  catch_up.link_up();
  catch_up.missing(midday, midday + 1s);
  for (int i = 0; i < 10; ++i) pass(CatchUp::patience);
  EXPECT_THAT(asked, SizeIs(CatchUp::most_tries));
  catch_up.missing(midday + 20s, midday + 21s);
  pass(50ms);
  EXPECT_EQ(asked.back().from, midday + 18s) << "and goes on with what is missing next";
}

TEST_F(AStationThatMissedSomething, BeginsAgainWithTheNextLinkWhatTheLastOneBrokeOff) {
  catch_up.link_up();
  catch_up.missing(midday, midday + 1s);
  pass(50ms);
  catch_up.link_down();
  pass(CatchUp::patience);
  EXPECT_THAT(asked, SizeIs(1)) << "there is no link";
  catch_up.link_up();
  pass(50ms);
  EXPECT_THAT(asked, SizeIs(2));
}

TEST_F(AStationThatMissedSomething, WhatAnotherStationFetchesIsNeitherLiveNorItsOwn) {
  catch_up.link_up();
  EXPECT_TRUE(comes_down(state_changed(descriptor::State::Operational, midday), us + 1));
  EXPECT_TRUE(ends({}, us + 1));
  EXPECT_THAT(archived(), IsEmpty());
  EXPECT_FALSE(hears(packet(17, 2, {}, midday))) << "and all else is said now";
  EXPECT_FALSE(hears(packet(st129::service_type, st129::telecommand_copy, {}, midday)));
}

TEST_F(AStationThatMissedSomething, IsNotEndedByTheEndOfWhatTheStationBeforeItAskedFor) {
  catch_up.link_up();
  archive->add(StoredGap{midday, midday + 60s});
  catch_up.missing(midday, midday + 60s);
  pass(50ms);
  EXPECT_TRUE(comes_down(state_changed(descriptor::State::Offline, midday - 1h))) << "of that";
  EXPECT_TRUE(ends({.request = 99, .reports = 1, .why = "asked anew"}));
  pass(50ms);
  EXPECT_THAT(asked, SizeIs(1)) << "its own is still under way";
  EXPECT_TRUE(comes_down(state_changed(descriptor::State::Operational, midday + 20s)));
  EXPECT_TRUE(ends({.reports = 1}));
  ASSERT_THAT(archive->gaps({}), SizeIs(1));
  EXPECT_EQ(archive->gaps({})[0].to, midday + 20s) << "as far as its own has brought it";
}

TEST_F(AStationThatMissedSomething, ManySmallGapsAreFetchedTogether) {
  link = false;
  catch_up.link_up();
  for (int i = 0; i < 100; ++i) catch_up.missing(midday + i * 1s, midday + i * 1s + 500ms);
  link = true;
  pass(50ms);
  ASSERT_THAT(asked, SizeIs(1));
  EXPECT_EQ(asked[0], (st129::Retrieve{midday - 2s, midday + 99s + 500ms + 2s, true}));
}

}  // namespace
}  // namespace hirosco::ground
