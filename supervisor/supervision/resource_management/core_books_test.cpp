// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/core_books.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hirosco::supervisor {
namespace {

/// A computer with some cores, where one thread may be out of its place.
struct Computer : ProcessLauncher {
  std::set<std::uint16_t> cores{0, 1};
  std::optional<unsigned> thread_on;  ///< of every process
  mutable ThreadPlaces asked;
  Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem&) override {
    return fail(ErrorCode::Unavailable, "nothing is started here");
  }
  std::optional<ProcessEnd> ended(std::uint32_t) override { return std::nullopt; }
  void kill(std::uint32_t) override {}
  bool grants_core(std::uint16_t core) noexcept override { return cores.contains(core); }
  std::optional<StrayThread> stray(std::uint32_t, const ThreadPlaces& places) noexcept override {
    asked = places;
    if (!thread_on || (places.cycle ? *places.cycle == *thread_on : places.all.has(*thread_on))) return std::nullopt;
    return StrayThread{.name = {'c'}, .processor = *thread_on};
  }
};

struct CoreBooksTest : ::testing::Test {
  Computer computer;
  descriptor::Mission mission;
  descriptor::MissionSubsystem& subsystem(std::uint16_t apid, descriptor::Cores cores) {
    descriptor::MissionSubsystem one;
    one.subsystem.id = apid;
    one.cores = std::move(cores);
    mission.subsystems.push_back(std::move(one));
    return mission.subsystems.back();
  }
  void SetUp() override { mission.subsystems.reserve(8); }
};

TEST_F(CoreBooksTest, WhoseACoreIsAloneHasAllOfIt) {
  const auto& alone = subsystem(10, {.cycle = 1, .alone = true});
  const auto& another = subsystem(11, {.cycle = 1});
  CoreBooks books{mission, computer};
  EXPECT_FALSE(books.claim(alone));
  EXPECT_EQ(books.book(1).held(10), 100U);
  const auto refused = books.claim(another);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->core, 1);
  EXPECT_EQ(refused->shortage.budget, 100U);
  EXPECT_EQ(refused->shortage.reserved, 100U);
  books.release(10);
  EXPECT_FALSE(books.claim(another));
  EXPECT_TRUE(books.claim(alone)) << "somebody is there, whatever he takes of it";
}

TEST_F(CoreBooksTest, OfACoreThatIsSharedTheLoopsThatGoFromTheStartArePromised) {
  auto& one = subsystem(10, {.cycle = 0});
  one.subsystem.service_loops.push_back({.name = "SLOW", .period = 1ms, .priority = 30, .budget = 250us});
  const auto& two = subsystem(11, {.cycle = 0});
  CoreBooks books{mission, computer};
  EXPECT_FALSE(books.claim(one));
  EXPECT_FALSE(books.claim(two));
  EXPECT_EQ(books.book(0).held(10), 25U);
  EXPECT_EQ(books.book(0).held(11), 1U);
  EXPECT_FALSE(books.claim(one)) << "it has it already";
}

TEST_F(CoreBooksTest, ACoreThatTheComputerHasNotIsPromisedToNobodyUntilItHas) {
  const auto& one = subsystem(10, {.cycle = 7});
  const auto& two = subsystem(11, {.cycle = 1, .services = {0, 6}});
  CoreBooks books{mission, computer};
  const auto refused = books.claim(one);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->core, 7);
  EXPECT_EQ(refused->shortage.budget, 0U);
  EXPECT_EQ(books.claim(two).value().core, 6) << "its other threads have to be somewhere, too";
  EXPECT_EQ(books.book(1).held(11), 0U);
  computer.cores = {0, 1, 6, 7};
  EXPECT_FALSE(books.claim(one));
  EXPECT_FALSE(books.claim(two));
}

TEST_F(CoreBooksTest, WhoIsNotWhereItsMissionHasItIsFound) {
  const auto& one = subsystem(10, {.cycle = 1, .services = {0}});
  const auto& none = subsystem(11, {});
  const CoreBooks books{mission, computer};
  computer.thread_on = 1;
  EXPECT_FALSE(books.stray(one, 5));
  EXPECT_EQ(to_string(computer.asked.all), "0, 1");
  computer.thread_on = 0;
  EXPECT_EQ(books.stray(one, 5).value().processor, 0U);
  EXPECT_EQ(computer.asked.cycle, 1U);
  computer.thread_on = std::nullopt;
  EXPECT_FALSE(books.stray(none, 5));
  EXPECT_EQ(computer.asked.cycle, std::nullopt);
  EXPECT_EQ(to_string(computer.asked.all), to_string(ProcessorSet::of_this_thread())) << "what the flight may use";
}

TEST_F(CoreBooksTest, AMissionThatSaysNothingOfCoresHasNobodyLookedAt) {
  const auto& none = subsystem(11, {});
  const CoreBooks books{mission, computer};
  computer.thread_on = 700;
  EXPECT_FALSE(books.stray(none, 5));
}

}  // namespace
}  // namespace hirosco::supervisor
