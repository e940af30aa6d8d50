// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using supervisor::LogRecord;

// Sanitized code is twenty times slower; what it looks for happens in the first seconds too.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr Duration flown = 5s;
#else
constexpr Duration flown = 60s;
#endif

struct FirstMinute {
  std::vector<LogRecord> records;
  double wall_s{0};
};

FirstMinute fly(std::uint64_t seed) {
  const auto start = std::chrono::steady_clock::now();
  Flight flight{{.seed = seed}};
  flight.craft().run(flown);
  FirstMinute minute{flight.records(), 0};
  minute.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_TRUE(flight.craft().supervisor().commissioned());
  return minute;
}

constexpr std::uint16_t what_it_has_taken = 4790;  // ports, too, of which a link by UDP takes one

/// Housekeeping of the manipulator without headers: what the world did, not how packets are counted.
std::vector<std::vector<std::byte>> robot_housekeeping(const std::vector<LogRecord>& records) {
  std::vector<std::vector<std::byte>> all;
  for (const LogRecord& record : records) {
    const auto report = pus::TelemetryView::parse(record.packet);
    if (!report || report->apid() != 10 || report->service() != 3) continue;
    OctetReader structure{report->source_data(), std::endian::big};
    if (structure.get<std::uint16_t>() == what_it_has_taken) continue;
    all.emplace_back(report->source_data().begin(), report->source_data().end());
  }
  return all;
}

TEST(Determinism, OneMinuteGivesTheSameLogTwiceAndAnotherWithAnotherSeed) {
  const FirstMinute first = fly(1);
  const FirstMinute second = fly(1);
  const FirstMinute other = fly(2);
  const auto packets =
      std::ranges::count_if(first.records, [](const LogRecord& record) { return !record.packet.empty(); });
  std::cout << fmt::format("  {} s of rokviss: {} records, {} packets, simulated in {:.2f} s\n", flown / 1s,
                           first.records.size(), packets, first.wall_s);
  EXPECT_GE(packets, flown / 1s * 1000 / 60);
  ASSERT_EQ(first.records.size(), second.records.size());
  EXPECT_TRUE(first.records == second.records);
  const auto robot = robot_housekeeping(first.records);
  ASSERT_FALSE(robot.empty());
  EXPECT_NE(robot, robot_housekeeping(other.records)) << "another seed moves the hand in another way";
}

/// The addresses are of nobody's (RFC 5737): on virtual time no socket is opened.
TEST(Determinism, LinksByUdpCarryInAWorldOfOneProcessWhatMemoryCarries) {
  const auto robot = [](const std::function<void(descriptor::Mission&)>& edit) {
    Flight flight{{.edit = edit}};
    flight.craft().run(5s);
    EXPECT_TRUE(flight.craft().supervisor().commissioned());
    return std::pair{robot_housekeeping(flight.records()), flight.story().count("up: udp, ")};
  };
  const auto by_udp = [](descriptor::Mission& mission) {
    for (descriptor::MissionLink& link : mission.links) {
      if (link.id > 2) continue;
      link.method = LinkMethod::Udp;
      link.from_address = "192.0.2.1";
      link.to_address = "192.0.2.2:4000";
    }
  };
  const auto memory = robot({}), udp = robot(by_udp), again = robot(by_udp);
  EXPECT_EQ(memory.second, 0u);
  EXPECT_EQ(udp.second, 2u);
  ASSERT_FALSE(udp.first.empty());
  EXPECT_EQ(udp.first, again.first);
  EXPECT_EQ(udp.first, memory.first);
}

/// Each of its readings is later than the one before.
class ClockThatRuns final : public Clock {
  [[nodiscard]] TimePoint do_now() const noexcept override { return TimePoint{++readings_ * 1us}; }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return {}; }
  [[nodiscard]] Duration do_processor() const noexcept override { return ++readings_ * 1us; }
  mutable std::int64_t readings_{0};
};

TEST(Determinism, IsOfAFlightWhoseCyclesAreMeasuredToo) {
  constexpr Duration looked_at = 3s;
  std::vector<LogRecord> with;
  {
    const ClockThatRuns clock;
    Flight flight{{}};
    std::map<std::string, std::uint64_t, std::less<>> cycles;
    bool as_they_took = true;
    flight.craft().measure_cycles(clock, [&](std::string_view subsystem, simulation::CycleTaken taken) {
      ++cycles[std::string{subsystem}];
      as_they_took = as_they_took && taken.wall == 1us && taken.processor == 3us;
    });
    flight.craft().run(looked_at);
    EXPECT_TRUE(as_they_took) << "readings stand around the cycle, and nothing else reads that clock";
    for (const char* name : {"MANIPULATOR", "JOYSTICK"}) {
      EXPECT_GT(cycles[name], 1000U) << name;
      EXPECT_EQ(cycles[name], flight.cycles(name)) << name;
    }
    with = flight.records();
  }
  Flight other{{}};
  other.craft().run(looked_at);
  ASSERT_FALSE(with.empty());
  EXPECT_TRUE(with == other.records());
}

}  // namespace
}  // namespace hirosco::testing
