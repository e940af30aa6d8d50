// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/resource_meter.hpp"

#include <gtest/gtest.h>

#include <memory_resource>
#include <vector>

#include "hirosco/subsystem/testing/rig.hpp"

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
  std::vector<ResourceMeter::Crossing> told() {
    std::vector<ResourceMeter::Crossing> all;
    meter.tell_crossings([&](const auto& crossing) { all.push_back(crossing); });
    return all;
  }
};

TEST_F(ResourceMeterTest, EachCrossingOfTheLevelIsToldOnce) {
  meter.note({.threads = 5});
  EXPECT_TRUE(told().empty());
  meter.note({.threads = 6});
  meter.note({.threads = 7});
  auto all = told();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].resource, Resource::Threads);
  EXPECT_EQ(all[0].used, 7U);
  EXPECT_EQ(all[0].limit, 8U);
  EXPECT_TRUE(told().empty());
  meter.note({.threads = 5});
  meter.note({.threads = 6});
  EXPECT_EQ(told().size(), 1U) << "it was below in between";
}

TEST_F(ResourceMeterTest, WhatIsNotLimitedIsCountedOnly) {
  meter.note({.memory_kb = 1'000'000, .descriptors = 3});
  meter.note({.memory_kb = 500, .descriptors = 7});
  EXPECT_TRUE(told().empty());
  const ResourceStatistics statistics = meter.statistics();
  EXPECT_EQ(statistics.memory_kb, 500U);
  EXPECT_EQ(statistics.memory_high_kb, 1'000'000U);
  EXPECT_EQ(statistics.descriptors_high, 7U);
}

TEST_F(ResourceMeterTest, APoolIsNamedByItsBlocksAndKeepsItsHighestUse) {
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

}  // namespace
}  // namespace hirosco
