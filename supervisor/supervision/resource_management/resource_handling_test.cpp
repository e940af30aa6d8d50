// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/resource_handling.hpp"

#include <cstdlib>
#include <map>
#include <set>

#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/sanitizer.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using descriptor::Resource;
using enum descriptor::State;

/// The members say what they take in a mission that has enough.
struct ResourceHandlingTest : PartsTest {
  std::map<std::uint32_t, ProcessUsage> uses;  ///< by process
  ResourceHandling& resources = parts.resources;
  ResourceHandlingTest() {
    for (auto& member : craft.mission.subsystems) says(member, Resource::Memory, 30'000);
    says(craft.mission.subsystems[0], Resource::Threads, 4);
    says(craft.mission.subsystems[0], Resource::Processor, 40);
  }
  static void says(descriptor::MissionSubsystem& member, Resource resource, std::uint32_t amount) {
    member.subsystem.resources.most[static_cast<std::size_t>(resource)] = amount;
  }
  std::optional<ProcessUsage> usage(std::uint32_t process) noexcept override {
    const auto found = uses.find(process);
    return found != uses.end() ? std::optional{found->second} : std::nullopt;
  }
  std::optional<std::set<std::uint16_t>> granted;  ///< cores of this computer; empty: all
  bool grants_core(std::uint16_t core) noexcept override { return !granted || granted->contains(core); }
  std::map<std::uint32_t, StrayThread> strayed;  ///< by process
  std::optional<StrayThread> stray(std::uint32_t process, const ThreadPlaces&) noexcept override {
    const auto found = strayed.find(process);
    return found != strayed.end() ? std::optional{found->second} : std::nullopt;
  }
  void look() {
    for (std::size_t i = 0; i < craft.members.size(); ++i) resources.watch(clock.now());
  }
  ProcessUsage& use_of(std::uint16_t apid) { return uses[craft.member(apid)->process()]; }
};

TEST_F(ResourceHandlingTest, WhatEachSaysIsReservedFromItsStartToItsEnd) {
  start_all(PreOperational);
  EXPECT_EQ(resources.book(Resource::Memory).reserved(), 90'000U);
  EXPECT_EQ(resources.book(Resource::Threads).reserved(), 4U);
  ends[played[arm].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  EXPECT_EQ(resources.book(Resource::Memory).reserved(), 60'000U);
  EXPECT_EQ(resources.book(Resource::Threads).reserved(), 0U);
}

TEST_F(ResourceHandlingTest, WhoDoesNotFitBesideTheOthersIsNotStartedAndTheReasonIsTold) {
  ResourceHandling scarce{[this]() -> Craft& {
                            craft.mission.budget[static_cast<std::size_t>(Resource::Memory)] = 50'000;
                            return craft;
                          }(),
                          parts.own};
  EXPECT_FALSE(scarce.claim(*craft.member(arm)));
  EXPECT_EQ(scarce.claim(*craft.member(hand)), "memory short: it asks for 30000 kB, 30000 kB of 50000 kB are reserved");
  EXPECT_EQ(scarce.book(Resource::Memory).held(hand), 0U);
  scarce.release(arm);
  EXPECT_FALSE(scarce.claim(*craft.member(hand)));
}

TEST_F(ResourceHandlingTest, PortsAndFilesStandInTheSameBooks) {
  for (auto& member : craft.mission.subsystems) {
    says(member, Resource::Ports, 2);
    says(member, Resource::Files, 1);
  }
  craft.mission.budget[static_cast<std::size_t>(Resource::Ports)] = 3;
  ResourceHandling scarce{craft, parts.own};
  EXPECT_FALSE(scarce.claim(*craft.member(arm)));
  EXPECT_EQ(scarce.claim(*craft.member(hand)), "ports short: it asks for 2, 2 of 3 are reserved");
  EXPECT_EQ(scarce.book(Resource::Files).reserved(), 1U) << "not limited, but held";
}

TEST_F(ResourceHandlingTest, EachIsOneProcessOfThoseThatTheMissionHas) {
  craft.mission.budget[static_cast<std::size_t>(Resource::Processes)] = 2;
  ResourceHandling scarce{craft, parts.own};
  EXPECT_FALSE(scarce.claim(*craft.member(arm)));
  EXPECT_FALSE(scarce.claim(*craft.member(arm))) << "it is the same one";
  EXPECT_FALSE(scarce.claim(*craft.member(hand)));
  const auto& third = *std::ranges::find_if(
      craft.members, [](const Member& each) { return each.apid() != arm && each.apid() != hand; });
  EXPECT_EQ(scarce.claim(third), "processes short: it asks for 1, 2 of 2 are reserved");
  scarce.release(arm);
  EXPECT_FALSE(scarce.claim(third));
}

TEST_F(ResourceHandlingTest, WhoStartsAProcessIsEndedAndNamedOnceItActs) {
  start_all(Operational);
  use_of(arm) = {.threads = 1, .processes = 1};
  look();
  EXPECT_TRUE(killed.empty());
  use_of(arm).processes = 2;
  use_of(arm).look = 5;
  look();
  look();
  EXPECT_TRUE(killed.empty()) << "it may have been seen so before it acted";
  use_of(arm).look = 6;
  look();
  if (built_with_sanitizer || sandbox_is_unwanted()) return;  // they may start one
  EXPECT_THAT(killed, ::testing::ElementsAre(played[arm].process));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(was_told("ARM has taken 2 of processes, each subsystem is 1 at most: it is ended"));
}

TEST_F(ResourceHandlingTest, WhoFliesWithoutASandboxByHisOwnWishMayHaveADebuggerBeginIt) {
  const bool was_unwanted = sandbox_is_unwanted();
  ::setenv("HIROSCO_SANDBOX", "off", 1);
  start_all(Operational);
  use_of(arm) = {.threads = 1, .processes = 2};
  look();
  EXPECT_TRUE(killed.empty());
  if (!was_unwanted) ::unsetenv("HIROSCO_SANDBOX");
}

TEST_F(ResourceHandlingTest, WhoIsGivenACoreThatThisComputerHasNotIsNotStartedAndTheReasonIsTold) {
  craft.mission.subsystems[0].cores.cycle = 7;
  granted = {0, 1};
  EXPECT_EQ(resources.claim(*craft.member(arm)),
            "the mission gives it core 7, which is none of this computer that the flight may use");
  granted = {7};
  EXPECT_FALSE(resources.claim(*craft.member(arm)));
  EXPECT_EQ(resources.core(7).held(arm), 1U);
  resources.release(arm);
  EXPECT_EQ(resources.core(7).held(arm), 0U);
}

TEST_F(ResourceHandlingTest, WhoIsOnAnotherCoreThanItsOwnIsFencedEndedAndNamedOnce) {
  craft.mission.subsystems[0].cores.cycle = 1;
  ResourceHandling looks{craft, parts.own};
  const auto look_with_cores = [&] {
    for (std::size_t i = 0; i < 2 * craft.members.size(); ++i) looks.watch(clock.now());
  };
  start_all(Operational);
  use_of(arm) = {.threads = 1};
  look_with_cores();
  EXPECT_TRUE(killed.empty());
  strayed[played[arm].process] = {.name = {'c', 'y', 'c', 'l', 'e'}, .processor = 0};
  look_with_cores();
  EXPECT_THAT(killed, ::testing::ElementsAre(played[arm].process));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(
      was_told("ARM has a thread cycle that may go on core 0, which the mission does not give it: it is ended"));
}

TEST_F(ResourceHandlingTest, WhoHasGoneDownSinceIsFoundElsewhereAllTheSame) {
  craft.mission.subsystems[0].cores.cycle = 1;
  ResourceHandling looks{craft, parts.own};
  start_all(Operational);
  use_of(arm) = {.threads = 1};
  const auto look_with_cores = [&] {
    for (std::size_t i = 0; i < craft.members.size(); ++i) looks.watch(clock.now());
  };
  look_with_cores();
  set(arm, Offline);
  strayed[played[arm].process] = {.name = {'c'}, .processor = 0};
  look_with_cores();
  EXPECT_THAT(killed, ::testing::ElementsAre(played[arm].process));
}

TEST_F(ResourceHandlingTest, OnTheWayToItsCoreNobodyIsAnywhereElse) {
  craft.mission.subsystems[0].cores.cycle = 1;
  ResourceHandling looks{craft, parts.own};
  start_all(Offline);
  use_of(arm) = {.threads = 1};
  strayed[played[arm].process] = {.name = {'c'}, .processor = 0};
  for (std::size_t i = 0; i < craft.members.size(); ++i) looks.watch(clock.now());
  EXPECT_TRUE(killed.empty());
}

TEST_F(ResourceHandlingTest, WhatLeadsToOneMayBeTwoProcessesBeforeItActs) {
  start_all(Offline);
  use_of(arm) = {.threads = 1, .processes = 2};
  look();
  EXPECT_TRUE(killed.empty());
}

TEST_F(ResourceHandlingTest, WhoTakesMoreThanItSaysIsFencedEndedAndNamedOnce) {
  start_all(Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  use_of(arm) = {.memory_kb = 30'000, .threads = 4};
  look();
  EXPECT_TRUE(killed.empty()) << "to the last of them";
  use_of(arm).threads = 5;
  look();
  look();
  EXPECT_THAT(killed, ::testing::ElementsAre(played[arm].process));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(was_told("ARM has taken 5 of threads, its descriptor says 4 at most: it is ended"));
}

TEST_F(ResourceHandlingTest, MemoryBeyondWhatItSaysEndsItUnlessASanitizerTakesIt) {
  start_all(Operational);
  use_of(arm) = {.memory_kb = 30'001, .threads = 4};
  look();
  EXPECT_EQ(killed.empty(), built_with_sanitizer || sandbox_is_off());
}

TEST_F(ResourceHandlingTest, ProcessorTimeIsARunawaysWhenItIsTooMuchForThreeSeconds) {
  start_all(Operational);
  for (const int percent : {90, 90, 30, 90, 90}) {
    look();
    use_of(arm).processor += 10ms * percent;
    wait(1s);
    EXPECT_TRUE(killed.empty());
  }
  look();
  use_of(arm).processor += 410ms;
  wait(1s);
  look();
  EXPECT_TRUE(was_told("ARM has taken 41 % of processor, its descriptor says 40 % at most: it is ended"));
}

TEST_F(ResourceHandlingTest, ProcessorTimeOnTheWayUpMakesNobodyARunaway) {
  start_all(State::SoftwareInit);
  for (int second = 0; second < 6; ++second) {
    look();
    use_of(arm).processor += 1s;
    wait(1s);
  }
  look();
  EXPECT_TRUE(killed.empty()) << "it reads files and meshes";
}

TEST_F(ResourceHandlingTest, OfWhoSaysNothingNothingIsTooMuch) {
  start_all(Operational);
  use_of(hand) = {.memory_kb = 1, .shared_memory_kb = 1'000'000, .threads = 1'000};
  look();
  EXPECT_TRUE(killed.empty());
}

}  // namespace
}  // namespace hirosco::supervisor
