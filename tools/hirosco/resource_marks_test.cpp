// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/resource_marks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

using descriptor::Resource;

/// "memory_kB 65536 12000 19" of each row, "-" where nothing is declared.
std::vector<std::string> lines(const std::vector<ResourceRow>& rows) {
  std::vector<std::string> all;
  for (const ResourceRow& row : rows) {
    const auto text = [](const std::optional<std::uint64_t>& number) { return number ? std::to_string(*number) : "-"; };
    all.push_back(row.attribute + " " + text(row.declared) + " " + std::to_string(row.high) + " " +
                  text(row.percent()));
  }
  return all;
}

struct ResourceMarksTest : ::testing::Test {
  descriptor::SubsystemDescriptor subsystem = [] {
    descriptor::SubsystemDescriptor made;
    made.resources.most[static_cast<std::size_t>(Resource::Memory)] = 65'536;
    made.resources.pools = {{64, 512}};
    made.resources.waiting = {128, 1024, 1024};
    made.resources.queues.events_octets = 16'384;
    made.resources.channel_kb = 128;
    return made;
  }();
  ResourceMarks marks;
};

TEST_F(ResourceMarksTest, StandBesideWhatIsDeclaredInItsUnitWithTheirShareRoundedUp) {
  EXPECT_TRUE(marks.silent());
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.MEMORY", "kB", {11'000}},
                                                 {"RESOURCE_STATS.MEMORY_HIGH", "kB", {12'000}},
                                                 {"RESOURCE_STATS.THREADS_HIGH", "", {3}},
                                                 {"RESOURCE_STATS.POOL_HIGH", "", {128, 0, 0, 0, 0, 0, 0, 0}},
                                                 {"RESOURCE_STATS.WAITING_HIGH", "", {32, 5, 0}},
                                                 {"RESOURCE_STATS.QUEUES_HIGH", "%", {25, 0, 80, 1, 0, 0, 50}},
                                                 {"CYCLE_STATS.MAX_US", "us", {99}}});
  EXPECT_FALSE(marks.silent());
  EXPECT_THAT(
      lines(marks.rows(subsystem)),
      ::testing::ElementsAre("memory_kB 65536 12000 19", "shared_memory_kB - 0 -", "threads - 3 -", "descriptors - 0 -",
                             "processor_percent - 0 -", "ports - 0 -", "files - 0 -", "Pool 64 512 128 25",
                             "waiting_answers 128 32 25", "waiting_events 1024 5 1", "waiting_housekeeping 1024 0 0",
                             "cycle_commands 64 16 25", "cycle_answers_kB 32 0 0", "cycle_events_kB 16 13 82",
                             "cycle_housekeeping_kB 64 1 2", "channel_kB 128 64 50"));
}

TEST_F(ResourceMarksTest, AreTheHighestOfAllProcessesThatItHadOneAfterTheOther) {
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.MEMORY_HIGH", "kB", {12'000}}});
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.MEMORY_HIGH", "kB", {700}}});
  EXPECT_EQ(marks.rows(subsystem)[0].high, 12'000U);
}

TEST_F(ResourceMarksTest, WhatIsTakenNowIsWhatWasToldLastWhateverWasHeardLast) {
  const auto now = [&](const char* attribute) -> std::optional<std::uint64_t> {
    for (const ResourceRow& row : marks.rows(subsystem))
      if (row.attribute == attribute) return row.now;
    ADD_FAILURE() << attribute;
    return {};
  };
  EXPECT_EQ(now("memory_kB"), std::nullopt) << "nobody has told it";
  const OnboardTime at = OnboardTime{} + std::chrono::hours{1};
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.MEMORY", "kB", {11'000}},
                                                 {"RESOURCE_STATS.SHARED_MEMORY", "kB", {300}},
                                                 {"RESOURCE_STATS.PROCESSOR", "%", {7}},
                                                 {"RESOURCE_STATS.POOL_USED", "", {12, 0}},
                                                 {"RESOURCE_STATS.WAITING", "", {1, 2, 3}},
                                                 {"RESOURCE_STATS.QUEUES", "%", {25, 0, 80, 1, 0, 0, 50}}},
             at);
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.MEMORY", "kB", {9'000}}}, at - 1s);
  for (const auto& [attribute, wanted] :
       {std::pair{"memory_kB", 11'000U}, std::pair{"shared_memory_kB", 300U}, std::pair{"processor_percent", 7U},
        std::pair{"Pool 64", 12U}, std::pair{"waiting_events", 2U}, std::pair{"cycle_events_kB", 13U}})
    EXPECT_EQ(now(attribute), wanted) << attribute;
  EXPECT_EQ(now("threads"), std::nullopt);
  marks.forget_now();
  EXPECT_EQ(now("memory_kB"), std::nullopt);
}

TEST_F(ResourceMarksTest, OfLoopsOfServicesAreThereWhereItHasSome) {
  subsystem.service_loops.push_back({.name = "SLOW", .queue = 4});
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.QUEUES_HIGH", "%", {0, 0, 0, 0, 75, 2, 0}}});
  const auto all = lines(marks.rows(subsystem));
  ASSERT_GE(all.size(), 2U);
  EXPECT_EQ(all[all.size() - 2], "queue of a loop 4 3 75");
  EXPECT_EQ(all.back(), "loop_reports_kB 64 2 4");
}

TEST_F(ResourceMarksTest, OfSeveralLoopsTheShareAloneIsToldAsNobodySaysWhichWasFullest) {
  subsystem.service_loops.push_back({.name = "SLOW", .queue = 4});
  subsystem.service_loops.push_back({.name = "SLOWER", .queue = 64});
  marks.hear(std::vector<pus::HousekeepingValue>{{"RESOURCE_STATS.QUEUES_HIGH", "%", {0, 0, 0, 0, 75, 2, 0}}});
  const auto all = lines(marks.rows(subsystem));
  ASSERT_GE(all.size(), 2U);
  EXPECT_EQ(all[all.size() - 2], "fullest queue of a loop, % 100 75 75");
}

}  // namespace
}  // namespace hirosco::tools
