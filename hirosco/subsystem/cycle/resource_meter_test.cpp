// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/resource_meter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory_resource>
#include <vector>

#include "hirosco/subsystem/testing/inside.hpp"

namespace hirosco {
namespace {

using descriptor::Resource;

struct ResourceMeterTest : ::testing::Test {
  descriptor::Resources declared = [] {
    descriptor::Resources made;
    made.most[static_cast<std::size_t>(Resource::Threads)] = 8;
    made.pools = {{64, 4}, {1024, 8}};
    return made;
  }();
  ResourceMeter meter{declared};
  TimePoint at{};
  std::vector<ResourceMeter::Crossing> told() {
    std::vector<ResourceMeter::Crossing> all;
    meter.tell_crossings([&](const auto& crossing) { all.push_back(crossing); });
    return all;
  }
};

TEST_F(ResourceMeterTest, EachCrossingOfTheLevelIsToldOnce) {
  meter.note({.threads = 5}, at);
  EXPECT_TRUE(told().empty());
  meter.note({.threads = 6}, at);
  meter.note({.threads = 7}, at);
  auto all = told();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].resource, Resource::Threads);
  EXPECT_EQ(all[0].used, 7U);
  EXPECT_EQ(all[0].limit, 8U);
  EXPECT_TRUE(told().empty());
  meter.note({.threads = 5}, at);
  meter.note({.threads = 6}, at);
  EXPECT_EQ(told().size(), 1U) << "it was below in between";
}

TEST_F(ResourceMeterTest, WhatIsNotLimitedIsCountedOnly) {
  meter.note({.memory_kb = 1'000'000, .descriptors = 3}, at);
  meter.note({.memory_kb = 500, .descriptors = 7}, at);
  EXPECT_TRUE(told().empty());
  const ResourceStatistics statistics = meter.statistics();
  EXPECT_EQ(statistics.memory_kb, 500U);
  EXPECT_EQ(statistics.memory_high_kb, 1'000'000U);
  EXPECT_EQ(statistics.descriptors_high, 7U);
}

TEST_F(ResourceMeterTest, SharedMemoryAndTheShareOfAProcessorAreCountedToo) {
  meter.note({.shared_memory_kb = 900, .processor = 3s}, at);
  meter.note({.shared_memory_kb = 500, .processor = 3600ms}, at += 1s);
  meter.note({.shared_memory_kb = 500, .processor = 3700ms}, at += 1s);
  const ResourceStatistics statistics = meter.statistics();
  EXPECT_EQ(statistics.process.shared_memory_kb, 500U);
  EXPECT_EQ(statistics.process.shared_memory_high_kb, 900U);
  EXPECT_EQ(statistics.process.processor_percent, 10U);
  EXPECT_EQ(statistics.process.processor_high_percent, 60U);
  EXPECT_TRUE(told().empty()) << "neither is limited";
}

TEST(ResourceMeter, TellsOnWhichCoreTheCycleIsAndOfNobodyElsesNothing) {
  const descriptor::Resources declared;
  ResourceMeter meter{declared};
  EXPECT_EQ(meter.statistics().waiting.core, 65'535) << "nobody has told";
  meter.note({.cycle_core = 3}, TimePoint{1s});
  EXPECT_EQ(meter.statistics().waiting.core, 3);
  meter.note({}, TimePoint{2s});
  EXPECT_EQ(meter.statistics().waiting.core, 65'535);
}

TEST(ProcessorOfASubsystem, IsWarnedOfOnceWhereASecondTakesThreeQuartersOfWhatItsDescriptorSays) {
  descriptor::Resources declared;
  declared.most[static_cast<std::size_t>(Resource::Processor)] = 80;
  ResourceMeter meter{declared};
  TimePoint at{};
  Duration had{};
  const auto second = [&](int percent) {
    for (int tenth = 0; tenth < 10; ++tenth) meter.note({.processor = had += 1ms * percent}, at += 100ms);
    int times = 0;
    meter.tell_crossings([&](const ResourceMeter::Crossing& crossing) {
      EXPECT_EQ(crossing.resource, Resource::Processor);
      EXPECT_EQ(crossing.used, static_cast<std::uint32_t>(percent));
      EXPECT_EQ(crossing.limit, 80U);
      ++times;
    });
    return times;
  };
  meter.note({}, at);
  EXPECT_EQ(second(59), 0);
  EXPECT_EQ(second(60), 1);
  EXPECT_EQ(second(75), 0) << "it is above, and was told";
  EXPECT_EQ(second(20), 0);
  EXPECT_EQ(second(61), 1);
}

TEST_F(ResourceMeterTest, WhatWaitsForTheSupervisorIsWarnedOfByItsKindAndToldAsAllElseIs) {
  declared.waiting = {1024, 128, 1024};
  meter.note_waiting({700, 95, 1});
  EXPECT_TRUE(told().empty());
  meter.note_waiting({700, 96, 1});
  const auto all = told();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].resource, Resource::WaitingEvents);
  EXPECT_EQ(all[0].used, 96U);
  EXPECT_EQ(all[0].limit, 128U);
  meter.note_waiting({3, 0, 0});
  const ResourceStatistics statistics = meter.statistics();
  EXPECT_EQ(statistics.waiting.now, (std::array<std::uint16_t, 3>{3, 0, 0}));
  EXPECT_EQ(statistics.waiting.high, (std::array<std::uint16_t, 3>{700, 96, 1}));
}

TEST_F(ResourceMeterTest, APoolIsNamedByItsBlocksAndKeepsItsHighestUse) {
  EXPECT_EQ(meter.pools().try_allocate(16), nullptr) << "nobody has taken them yet";
  ASSERT_TRUE(meter.take_pools());
  std::vector<void*> blocks;
  for (int i = 0; i < 6; ++i) blocks.push_back(meter.pools().try_allocate(1000));
  const auto all = told();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].resource, Resource::Pool);
  EXPECT_EQ(all[0].block_octets, 1024U);
  EXPECT_EQ(all[0].limit, 8U);
  for (void* block : blocks) EXPECT_TRUE(meter.pools().give_back(block));
  EXPECT_EQ(meter.pools().try_allocate(1025), nullptr);
  const ResourceStatistics statistics = meter.statistics();
  EXPECT_EQ(statistics.pool_used[1], 0U);
  EXPECT_EQ(statistics.pool_high[1], 6U);
  EXPECT_EQ(statistics.pool_high[0], 0U);
  EXPECT_EQ(statistics.pool_refused, 1U);
}

TEST_F(ResourceMeterTest, PoolsThatWereGivenBackHaveNoBlocksInUseAndTheirMostAndRefusalsStay) {
  ASSERT_TRUE(meter.take_pools());
  std::vector<void*> blocks;
  for (int i = 0; i < 3; ++i) blocks.push_back(meter.pools().try_allocate(64));
  EXPECT_EQ(meter.pools().try_allocate(2000), nullptr);
  for (void* block : blocks) EXPECT_TRUE(meter.pools().give_back(block));
  ASSERT_TRUE(meter.give_pools_back());
  EXPECT_EQ(meter.statistics().pool_used[0], 0U);
  EXPECT_EQ(meter.statistics().pool_high[0], 3U);
  EXPECT_EQ(meter.statistics().pool_refused, 1U);
  ASSERT_TRUE(meter.take_pools());
  void* const one = meter.pools().try_allocate(64);
  EXPECT_EQ(meter.pools().try_allocate(2000), nullptr);
  EXPECT_EQ(meter.statistics().pool_used[0], 1U);
  EXPECT_EQ(meter.statistics().pool_high[0], 3U) << "the most ever";
  EXPECT_EQ(meter.statistics().pool_refused, 2U);
  EXPECT_TRUE(meter.pools().give_back(one));
}

TEST_F(ResourceMeterTest, ACrossingOfAPoolThatHasGoneSinceIsToldOnceAndNotOfTheNextPool) {
  ASSERT_TRUE(meter.take_pools());
  std::array<void*, 3> blocks{};
  for (void*& block : blocks) block = meter.pools().try_allocate(64);
  for (void* block : blocks) EXPECT_TRUE(meter.pools().give_back(block));
  ASSERT_TRUE(meter.give_pools_back());
  const auto all = told();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].block_octets, 64U);
  EXPECT_EQ(all[0].used, 0U);
  EXPECT_EQ(all[0].limit, 4U);
  EXPECT_EQ(all[0].times, 1U);
  ASSERT_TRUE(meter.take_pools());
  EXPECT_TRUE(told().empty());
}

TEST_F(ResourceMeterTest, BlocksThatAreHeldKeepTheirMemoryAndAreNamedUntilTheyComeBack) {
  ASSERT_TRUE(meter.take_pools());
  void* const small = meter.pools().try_allocate(64);
  void* const large = meter.pools().try_allocate(1024);
  const auto refused = meter.give_pools_back();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Mismatch);
  EXPECT_STREQ(refused.error().text, "blocks still held: 1 of 64 octets, 1 of 1024 octets");
  EXPECT_EQ(refused.error().value, 2);
  EXPECT_EQ(meter.pools().try_allocate(64), nullptr) << "nothing is given of them any more";
  std::memset(large, 1, 1024);
  EXPECT_TRUE(meter.pools().give_back(small));
  ASSERT_TRUE(meter.take_pools());
  EXPECT_EQ(meter.statistics().pool_used[1], 1U) << "what was held is held still";
  EXPECT_TRUE(meter.pools().give_back(large));
  EXPECT_TRUE(meter.give_pools_back());
  EXPECT_TRUE(meter.give_pools_back()) << "there are none";
  EXPECT_EQ(meter.leave_pools_behind(nullptr), nullptr);
}

/// Takes what it is told to from its pools, in its cycle.
struct Greedy final : Subsystem {
  int wanted{0};
  std::array<void*, 16> held{};
  bool container_refused{false};

 protected:
  Result<Step> software_init() override {
    try {
      std::pmr::vector<double> numbers{&resources()};
      numbers.resize(10);
      numbers.resize(1'000);
    } catch (const std::bad_alloc&) {
      container_refused = true;
    }
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override {
    for (int i = 0; i < static_cast<int>(held.size()); ++i) {
      void*& block = held[static_cast<std::size_t>(i)];
      if (i < wanted && block == nullptr) block = resources().try_allocate(100);
      if (i >= wanted && block != nullptr && resources().give_back(block)) block = nullptr;
    }
    return ok();
  }
};

struct ResourcesOfASubsystem : ::testing::Test {
  Greedy greedy;
  testing::Rig rig{greedy, R"(<Subsystem name="GREEDY" id="21">
    <Resources><Pool block="128" count="10"/></Resources>
    <Configuration name="C" id="1" sampling_us="1000"/></Subsystem>)"};
  void hold(int blocks) {
    greedy.wanted = blocks;
    for (int i = 0; i < 120; ++i) {
      rig.cycle();
      rig.advance(1ms);
      rig.service();
    }
  }
  int warnings() { return rig.heard(descriptor::framework_event::resource_warning); }
};

TEST_F(ResourcesOfASubsystem, ThreeQuartersOfAPoolAreAnEventOncePerCrossingAndItsUseIsHousekeeping) {
  rig.bring_to(State::PreOperational);
  EXPECT_TRUE(greedy.container_refused) << "80 octets are there, 8,000 are not";
  hold(7);
  EXPECT_EQ(warnings(), 0);
  hold(8);
  EXPECT_EQ(warnings(), 1);
  hold(9);
  EXPECT_EQ(warnings(), 1);
  hold(2);
  hold(16);
  EXPECT_EQ(warnings(), 2);
  const ResourceStatistics told = rig.subsystem.cycle().resource_statistics().load();
  EXPECT_EQ(told.pool_used[0], 10U);
  EXPECT_EQ(told.pool_high[0], 10U);
  EXPECT_GT(told.pool_refused, 0U);
}

TEST(WaitingForTheSupervisor, IsHeldToWhatTheDescriptorSaysWarnedOfAndHousekeeping) {
  Greedy greedy;
  testing::Rig rig{greedy, R"(<Subsystem name="GREEDY" id="21">
    <Resources waiting_housekeeping="128"/>
    <Configuration name="C" id="1" sampling_us="1000">
      <HKService id="1" interval="1"><SampledOnce><ParamRef name="CYCLE_STATS"/></SampledOnce></HKService>
    </Configuration></Subsystem>)"};
  rig.bring_to(State::PreOperational);
  // It is there and does not read: its channel fills first.
  constexpr int more_than_the_channel_holds = 4096 + 200;
  for (int i = 0; i < more_than_the_channel_holds; ++i) {
    rig.permit.heartbeat.fetch_add(1);
    rig.cycle();
    rig.advance(1ms);
    static_cast<void>(rig.subsystem.service_step(rig.clock.now()));
  }
  for (int i = 0; i < 20; ++i) {
    rig.service();
    rig.cycle();
  }
  EXPECT_EQ(rig.heard(descriptor::framework_event::resource_warning), 1);
  EXPECT_EQ(rig.subsystem.cycle().resource_statistics().load().waiting.high[2], 128U);
}

/// Speaks to two sensors by UDP and opens what else it likes.
struct Talker final : Subsystem {
  struct Angle {
    double rad;
  };
  struct Nothing {
    std::uint8_t no;
  };
  DevicePort<Angle, Nothing> left, right;
  Result<Step> software_init() override {
    use_device("LEFT", left);
    use_device("RIGHT", right);
    return done;
  }
  using Subsystem::acquire_file;
  using Subsystem::acquire_port;
};

std::string talker(const std::string& resources) {
  return R"(<Subsystem name="TALKER" id="21">)" + resources + R"(
    <Device name="LEFT"><Input><Field name="ANGLE" type="DOUBLE"/></Input><Output><Field name="NO" type="UINT8"/></Output></Device>
    <Device name="RIGHT"><Input><Field name="ANGLE" type="DOUBLE"/></Input><Output><Field name="NO" type="UINT8"/></Output></Device>
    <Configuration name="C" id="1" sampling_us="1000">
      <Device name="LEFT"><Endnode transfer="udp" address="127.0.0.1:20101"/></Device>
      <Device name="RIGHT"><Endnode transfer="udp" address="127.0.0.1:20102"/></Device>
    </Configuration></Subsystem>)";
}

TEST(PortsAndFiles, OfDevicesAndTheAuthorAreHeldInOneBookAndHousekeeping) {
  Talker talking;
  testing::Rig rig{talking, talker(R"(<Resources ports="3" files="1"/>)")};
  rig.bring_to(State::PreOperational);
  auto port = talking.acquire_port();
  ASSERT_TRUE(port);
  const auto none = talking.acquire_port();
  ASSERT_FALSE(none);
  EXPECT_STREQ(none.error().text, "all ports that its descriptor permits are held");
  EXPECT_EQ(none.error().value, 3);
  {
    const auto file = talking.acquire_file();
    ASSERT_TRUE(file);
    EXPECT_FALSE(talking.acquire_file());
  }
  for (int i = 0; i < 120; ++i) {
    rig.cycle();
    rig.service();
  }
  const ResourceStatistics told = rig.subsystem.cycle().resource_statistics().load();
  EXPECT_EQ(told.ports, 3U);
  EXPECT_EQ(told.ports_high, 3U);
  EXPECT_EQ(told.files, 0U);
  EXPECT_EQ(told.files_high, 1U);
  EXPECT_EQ(told.held_refused, 2U);
  EXPECT_GE(rig.heard(descriptor::framework_event::resource_warning), 1) << "3 of 3 are above 75 %";
  // What a configuration takes is given back with it.
  port = Quota::Held{};
  rig.set_state_now(State::Offline);
  EXPECT_EQ(talking.acquire_port().has_value(), true);
  EXPECT_EQ(rig.subsystem.meter().ports().used(), 0U);
}

TEST(PortsAndFiles, BeyondWhatItSaysAConfigurationIsRefusedWithTheReason) {
  Talker talking;
  testing::Rig rig{talking, talker(R"(<Resources ports="1"/>)")};
  rig.set_state_now(State::PreOperational);
  const std::string outcome = rig.configure_now(1);
  EXPECT_EQ(outcome.substr(0, 6), "1 3 8:") << outcome;
  const auto told = std::ranges::any_of(rig.explanations, [](const std::string& words) {
    return words.find("all ports that its descriptor permits are held") != std::string::npos;
  });
  EXPECT_TRUE(told);
  EXPECT_EQ(rig.subsystem.meter().ports().used(), 0U) << "the first was given back";
  EXPECT_EQ(rig.subsystem.meter().ports().refused(), 1U);
}

}  // namespace
}  // namespace hirosco
