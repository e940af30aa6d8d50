// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/status/housekeeping.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

constexpr std::size_t places = 16;

/// What ground reads of the supervisor's parameters, octet by octet as supervisor.xml declares them.
struct HousekeepingTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
    start_supervisor();
  }
  /// TC[20,1] on one parameter; the octets of its value.
  std::vector<std::byte> value_of(Type type, std::uint8_t id) {
    for (int cycle = 0; cycle < 20; ++cycle) own_step();
    std::array<std::byte, 5> asked{};
    OctetWriter writer{asked};
    writer.put(std::uint8_t{1});
    writer.put(ParameterId{supervisor_apid, type, id}.wire());
    last_routed.erase(20);
    parts.own_telecommands.send(supervisor_apid, 20, 1, asked, {}, nullptr, Duration{0});
    for (int step = 0; step < 20 && !last_routed.contains(20); ++step) own_step();
    auto& data = last_routed[20];
    if (data.size() < asked.size()) return {};
    data.erase(data.begin(), data.begin() + asked.size());
    return data;
  }
  struct Members {
    std::array<std::uint16_t, places> apid{};
    std::array<std::uint8_t, places> state{}, configuration{}, inhibited{};
    std::array<std::uint32_t, places> cycles{}, overruns{}, missed{}, latency_max_ns{}, execution_mean_ns{},
        memory_kb{};
  };
  template <class T>
  static void read(OctetReader& reader, std::array<T, places>& values) {
    for (T& each : values) each = reader.get<T>();
  }
  Members members() {
    const auto octets = value_of(Type::Struct, 4);
    OctetReader reader{octets};
    Members all;
    read(reader, all.apid);
    read(reader, all.state);
    read(reader, all.configuration);
    read(reader, all.inhibited);
    read(reader, all.cycles);
    read(reader, all.overruns);
    read(reader, all.missed);
    read(reader, all.latency_max_ns);
    read(reader, all.execution_mean_ns);
    read(reader, all.memory_kb);
    EXPECT_TRUE(reader.good() && reader.remaining() == 0);
    return all;
  }
  std::uint32_t resident_kb(std::uint32_t process) noexcept override { return 100 + process; }
};

TEST_F(HousekeepingTest, EverybodyHasItsPlaceTheSupervisorTheFirst) {
  set(hand, PreOperational);
  played[arm].vital->inhibited = 4;
  played[arm].vital->cycles = (std::uint64_t{1} << 32) + 7;
  played[arm].vital->overruns = 3;
  const Members all = members();
  EXPECT_THAT(std::vector(all.apid.begin(), all.apid.begin() + 5), ElementsAre(1, arm, hand, camera, 0));
  EXPECT_THAT(std::vector(all.state.begin(), all.state.begin() + 4), ElementsAre(5, 4, 3, 4));
  EXPECT_EQ(all.configuration[1], 1);
  EXPECT_EQ(all.inhibited[1], 4);
  EXPECT_EQ(all.cycles[1], 7U) << "counters on the wire start again from 0";
  EXPECT_EQ(all.overruns[1], 3U);
  EXPECT_GT(all.cycles[0], 0U) << "its own";
}

TEST_F(HousekeepingTest, WhoDoesNotRunIsToldAsThat) {
  craft.member(hand)->died();
  EXPECT_EQ(members().state[2], 255);
}

TEST_F(HousekeepingTest, TheOperatingSystemIsAskedForTheMemoryOfEachInItsTurn) {
  for (int turn = 0; turn < 4; ++turn) parts.housekeeping.watch(clock.now());
  const Members all = members();
  EXPECT_THAT(std::vector(all.memory_kb.begin(), all.memory_kb.begin() + 5), ElementsAre(100, 1110, 1111, 1112, 0));
  craft.member(hand)->died();
  for (int turn = 0; turn < 4; ++turn) parts.housekeeping.watch(clock.now());
  EXPECT_EQ(members().memory_kb[2], 0U);
}

TEST_F(HousekeepingTest, LinksAreToldAsTheirConsumerSeesThem) {
  parts.graph.set_up(2, true);
  IncomingLink& seen = played[arm].vital->incoming[0];
  seen.link = 2;
  seen.lost = 6;
  seen.latency_max_ns = 1234;
  const auto octets = value_of(Type::Struct, 5);
  OctetReader reader{octets};
  std::array<std::uint8_t, places> link{}, up{};
  std::array<std::uint32_t, places> samples{}, age_us{}, lost{}, latency_mean_ns{}, latency_max_ns{};
  read(reader, link);
  read(reader, up);
  read(reader, samples);
  read(reader, age_us);
  read(reader, lost);
  read(reader, latency_mean_ns);
  read(reader, latency_max_ns);
  ASSERT_TRUE(reader.good() && reader.remaining() == 0);
  EXPECT_THAT(std::vector(link.begin(), link.begin() + 3), ElementsAre(1, 2, 0));
  EXPECT_THAT(std::vector(up.begin(), up.begin() + 3), ElementsAre(0, 1, 0));
  EXPECT_EQ(lost[1], 6U);
  EXPECT_EQ(latency_max_ns[1], 1234U);
  EXPECT_EQ(samples[1], LinkRow::not_told) << "there is nothing to look into";
  EXPECT_EQ(age_us[1], LinkRow::not_told);
}

TEST_F(HousekeepingTest, HowWellEachLinkDoesStandsTogetherAndOfThoseThatNobodyElseCanLookIntoToo) {
  parts.graph.set_up(2, true);
  IncomingLink& seen = played[arm].vital->incoming[0];
  seen.link = 2;
  seen.lost = 6;
  seen.latency_mean_ns = 1000;
  seen.latency_max_ns = 1234;
  seen.jitter_ns = 56;
  seen.age_us = 789;
  const auto octets = value_of(Type::Struct, 8);
  OctetReader reader{octets};
  std::array<std::uint8_t, places> link{};
  std::array<std::array<std::uint32_t, places>, 5> columns{};
  read(reader, link);
  for (auto& column : columns) read(reader, column);
  ASSERT_TRUE(reader.good() && reader.remaining() == 0);
  EXPECT_THAT(std::vector(link.begin(), link.begin() + 3), ElementsAre(1, 2, 0));
  std::vector<std::uint32_t> told;
  for (const auto& column : columns) told.push_back(column[1]);
  EXPECT_THAT(told, ElementsAre(6, 1000, 1234, 56, 789));
  EXPECT_EQ(columns[3][0], 0U);
}

TEST_F(HousekeepingTest, HowLongTheSamplesOfEachLinkTookStandsBinByBin) {
  parts.graph.set_up(2, true);
  IncomingLink& other = played[arm].vital->incoming[0];
  other.link = 99;
  played[arm].vital->latencies[0].period_ns = 3;
  played[arm].vital->incoming[1].link = 2;
  LinkLatencies& seen = played[arm].vital->latencies[1];
  seen.period_ns = 500'000;
  for (std::uint32_t bin = 0; bin < latency_bins; ++bin) seen.counts[bin] = 10 + bin;
  const auto octets = value_of(Type::Struct, 9);
  OctetReader reader{octets};
  std::array<std::uint8_t, places> link{};
  std::array<std::array<std::uint32_t, places>, 10> columns{};
  read(reader, link);
  for (auto& column : columns) read(reader, column);
  ASSERT_TRUE(reader.good() && reader.remaining() == 0);
  EXPECT_THAT(std::vector(link.begin(), link.begin() + 3), ElementsAre(1, 2, 0));
  std::vector<std::uint32_t> told;
  for (const auto& column : columns) told.push_back(column[1]);
  EXPECT_THAT(told, ElementsAre(500'000, 10, 11, 12, 13, 14, 15, 16, 17, 18));
  EXPECT_EQ(columns[0][0], 0U) << "link 1 has no consumer that tells";
}

TEST_F(HousekeepingTest, ModeAndRejectionsAreThose) {
  EXPECT_EQ(value_of(Type::Uint8, 0), std::vector{std::byte{1}});
  verify(arm, 1, 4, pus::FailureCode::WrongMode, 0);
  const auto octets = value_of(Type::Uint32, 2);
  OctetReader reader{octets};
  std::array<std::uint32_t, Traffic::reasons> rejections{};
  for (auto& each : rejections) each = reader.get<std::uint32_t>();
  EXPECT_EQ(rejections[static_cast<std::size_t>(pus::FailureCode::WrongMode)], 1U);
}

}  // namespace
}  // namespace hirosco::supervisor
