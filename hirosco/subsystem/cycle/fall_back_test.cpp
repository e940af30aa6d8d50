// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/subsystem/cycle/device_slot.hpp"

/// One endnode with fall-backs: when it goes over, what counts from then on, and what is held back meanwhile.
namespace hirosco {
namespace {

struct Measured {
  std::uint16_t angle;
};
struct Commanded {
  std::uint16_t current;
};

/// A motor by three ways; three cycles of 1 ms of silence are too many, its watchdog has 5 ms.
struct FallBack : ::testing::Test {
  static constexpr std::uint32_t limit = 3;
  LocalFlows flows;
  descriptor::Device device;
  descriptor::DeviceUse use;
  DevicePort<Measured, Commanded> port;
  std::vector<std::unique_ptr<DataFlow>> motor;
  std::optional<DeviceSlot> slot;

  FallBack() {
    const auto field = [](const char* name) {
      descriptor::Field made;
      made.name = name;
      made.type = Type::Uint16;
      return made;
    };
    device.name = "MOTOR";
    device.actuator = true;
    device.input = {field("ANGLE")};
    device.output = {{.field = field("CURRENT"), .safe = {7}}};
    use.silence = {limit, 10};
    use.watchdog_us = 5'000;
  }
  void SetUp() override {
    for (const char* address : {"a", "b", "c"})
      motor.push_back(flows.open({Transfer::SharedMemory, address}, FlowSide::Device).value());
    make();
  }
  void make() {
    slot.reset();
    std::vector<DeviceSlot::Way> ways;
    for (const char* address : {"a", "b", "c"})
      ways.push_back({flows.open({Transfer::SharedMemory, address}, FlowSide::Subsystem).value(),
                      static_cast<std::uint8_t>(ways.size())});
    slot.emplace(device, use, port, std::move(ways), 1ms, true);
  }
  std::optional<DeviceCommand> heard(std::size_t way) {
    static std::array<std::byte, max_device_frame_octets> frame;
    const auto received = motor[way]->receive(frame);
    if (!received || received->flow != Flow::New) return std::nullopt;
    return read_command(Octets{frame}.first(received->octets)).value();
  }
  void say(std::size_t way, std::uint32_t sequence, std::uint8_t angle = 1) {
    std::array<std::byte, max_device_frame_octets> buffer{};
    const std::array payload{std::byte{angle}, std::byte{0}};
    static_cast<void>(
        motor[way]->send(write_status(buffer, {.epoch = 1, .sequence = sequence, .payload = payload}).value()));
  }
  /// Cycles in which the ways that are named answer what they hear.
  void run(int cycles, std::initializer_list<std::size_t> answering) {
    for (int i = 0; i < cycles; ++i) {
      slot->read(true);
      slot->write(1, !slot->holds_back(), false);
      for (const std::size_t way : answering)
        if (const auto command = heard(way)) say(way, command->sequence);
    }
  }
  /// Cycles until it has gone over, in which nobody answers.
  int until_it_goes_over() {
    for (int cycles = 1; cycles < 100; ++cycles) {
      slot->read(true);
      if (slot->just_fell_back()) return cycles;
      slot->write(1, !slot->holds_back(), false);
    }
    return -1;
  }
};

TEST_F(FallBack, APreferredEndnodeThatAnswersIsKept) {
  run(50, {0, 1, 2});
  EXPECT_TRUE(slot->alive());
  EXPECT_EQ(slot->taken(), 0);
  EXPECT_FALSE(heard(1)) << "nothing goes out by a fall-back meanwhile";
}

TEST_F(FallBack, SilenceOfThePreferredOneGoesOverAndTellsWhyAndIsCounted) {
  run(10, {0});
  heard(0);
  slot->read(true);  // takes the last answer
  EXPECT_EQ(until_it_goes_over(), static_cast<int>(limit));
  EXPECT_EQ(slot->left(), 0);
  EXPECT_EQ(slot->taken(), 1);
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::Silent);
  EXPECT_EQ(port.endnode(), 1);
  EXPECT_EQ(port.fall_backs(), 1U);
  EXPECT_FALSE(slot->just_lost()) << "the device is not lost yet";
  slot->read(true);
  EXPECT_FALSE(slot->just_fell_back()) << "it is told once";
}

TEST_F(FallBack, ADeviceThatHangsUpIsLeftAtOnce) {
  run(10, {0});
  slot->read(true);
  motor[0].reset();
  EXPECT_EQ(until_it_goes_over(), 1);
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::HungUp);
}

TEST_F(FallBack, GarbageByThePreferredOneGoesOver) {
  run(10, {0});
  slot->read(true);
  for (std::uint32_t i = 0; i < limit; ++i) {
    static_cast<void>(motor[0]->send(std::array<std::byte, 30>{}));
    slot->read(true);
  }
  EXPECT_TRUE(slot->just_fell_back());
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::Damaged);
}

TEST_F(FallBack, ThePreferredOneThatNeverSpokeIsLeftOnceItIsMissed) {
  for (int i = 0; i < 20; ++i) slot->read(false);
  EXPECT_FALSE(slot->just_fell_back());
  EXPECT_EQ(until_it_goes_over(), static_cast<int>(limit));
}

TEST_F(FallBack, IsNotAliveAndHoldsBackUntilItAnswersACommandThatWentOutByIt) {
  say(1, 5);  // of long ago
  run(10, {0});
  slot->read(true);
  ASSERT_GT(until_it_goes_over(), 0);
  EXPECT_FALSE(slot->alive());
  EXPECT_TRUE(slot->holds_back());
  slot->read(true);
  EXPECT_FALSE(slot->alive()) << "what lay in its mailbox is old";
  EXPECT_TRUE(slot->holds_back());
  slot->write(1, false, false);
  const auto command = heard(1);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->mode, DeviceMode::Off);
  say(1, command->sequence - 1, 9);
  slot->read(true);
  EXPECT_FALSE(slot->alive()) << "it answers a command from before";
  say(1, command->sequence, 8);
  slot->read(true);
  EXPECT_TRUE(slot->alive());
  EXPECT_TRUE(port.fresh());
  EXPECT_EQ(port.input().angle, 8);
}

/// Of the modes that go out by it: what begins by it, a cold unit, knows of none before, and would be let go by Active (docs/adr/0149).
TEST_F(FallBack, WhatHasJustBegunThereHasHeardOffBeforeItHearsActiveHoweverManyCommandsAreLost) {
  for (int lost = 0; lost < static_cast<int>(limit); ++lost) {
    make();
    run(10, {0});
    slot->read(true);
    ASSERT_GT(until_it_goes_over(), 0);
    ASSERT_EQ(slot->taken(), 1);
    std::vector<DeviceMode> reached;
    for (int cycle = 0; cycle < 40; ++cycle) {
      slot->write(1, !slot->holds_back(), false);
      if (const auto command = heard(1); command && cycle >= lost) {
        reached.push_back(command->mode);
        say(1, command->sequence);
      }
      slot->read(true);
    }
    ASSERT_EQ(slot->taken(), 1) << lost;
    EXPECT_EQ(reached.front(), DeviceMode::Off) << lost;
    EXPECT_EQ(reached.back(), DeviceMode::Active) << lost << ": and then it moves";
  }
}

TEST_F(FallBack, WhatWasLeftIsToldToLetGoAndHoldsBackUntilItsWatchdogHasRunOut) {
  run(10, {0});
  slot->read(true);
  ASSERT_GT(until_it_goes_over(), 0);
  const auto last = heard(0);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->mode, DeviceMode::Off);
  // 5 ms of its watchdog and a cycle, though the new one has answered long before.
  for (int cycle = 0; cycle < 6; ++cycle) {
    EXPECT_TRUE(slot->holds_back()) << cycle;
    slot->write(1, false, false);
    if (const auto command = heard(1)) say(1, command->sequence);
    slot->read(true);
  }
  EXPECT_TRUE(slot->alive());
  EXPECT_FALSE(slot->holds_back());
  EXPECT_FALSE(heard(0)) << "nothing more goes out there";
  slot->write(1, true, false);
  EXPECT_EQ(heard(1)->mode, DeviceMode::Active) << "and it moves again";
}

TEST_F(FallBack, TheFirstThatWasLeftHoldsBackThroughASecondFallToo) {
  use.watchdog_us = 20'000;
  make();
  run(10, {0});
  ASSERT_EQ(slot->taken(), 0);
  int since_active = 0;  // that the first has heard
  while (slot->taken() < 2 && since_active < 100) {
    slot->read(true);
    slot->write(1, !slot->holds_back(), false);
    ++since_active;
  }
  ASSERT_EQ(slot->taken(), 2) << "the second said nothing either";
  while (slot->holds_back() && since_active < 100) {
    if (const auto command = heard(2)) say(2, command->sequence);
    slot->read(true);
    slot->write(1, false, false);
    ++since_active;
  }
  EXPECT_TRUE(slot->alive());
  EXPECT_GE(since_active, 20) << "its watchdog";
  EXPECT_LE(since_active, 20 + 2 * static_cast<int>(limit)) << "and the cycles in which its line was dead already";
}

TEST_F(FallBack, WhatItWasToldBehindItsLastActiveHoldsBackAllTheSameAsItMayNotHaveHeardIt) {
  use.watchdog_us = 20'000;
  make();
  run(10, {0});
  for (int cycle = 0; cycle < 2; ++cycle) {
    slot->read(true);
    slot->write(1, false, false);  // inhibited for another reason; its line is dead already
  }
  ASSERT_GT(until_it_goes_over(), 0);
  int held_back = 2 + 3;
  while (slot->holds_back() && held_back < 100) {
    slot->write(1, false, false);
    if (const auto command = heard(1)) say(1, command->sequence);
    slot->read(true);
    ++held_back;
  }
  EXPECT_GE(held_back, 20);
}

TEST_F(FallBack, AnotherPeriodMakesWhatIsLeftOfAWatchdogNoShorter) {
  use.watchdog_us = 20'000;
  make();
  run(10, {0});
  ASSERT_GT(until_it_goes_over(), 0);
  slot->follow(250us);
  int cycles = 0;
  for (; slot->holds_back() && cycles < 1'000; ++cycles) {
    slot->write(1, false, false);
    if (const auto command = heard(1)) say(1, command->sequence);
    slot->read(true);
  }
  EXPECT_GE(cycles, 4 * 16);
}

TEST_F(FallBack, WhoWasNeverActiveHoldsNothingBackWhateverThePeriodsAre) {
  use.watchdog_us = 20'000;
  make();
  for (const Duration period : {Duration{1h}, Duration{500us}, Duration{1ms}}) slot->follow(period);
  slot->read(false);
  slot->write(1, false, false);
  for (int cycles = 0; !slot->just_fell_back() && cycles < 100; ++cycles) slot->read(true);
  ASSERT_TRUE(slot->just_fell_back());
  slot->write(1, false, false);
  say(1, heard(1)->sequence);
  slot->read(true);
  EXPECT_FALSE(slot->holds_back());
}

TEST_F(FallBack, WhatWasNotActiveHoldsNothingBackBehindTheFirstAnswer) {
  slot->read(false);
  slot->write(1, false, false);
  ASSERT_GT(
      [&] {
        for (int cycles = 1; cycles < 100; ++cycles) {
          slot->read(true);
          if (slot->just_fell_back()) return cycles;
          slot->write(1, false, false);
        }
        return 0;
      }(),
      0);
  slot->write(1, false, false);
  say(1, heard(1)->sequence);
  slot->read(true);
  EXPECT_FALSE(slot->holds_back());
}

TEST_F(FallBack, EachIsTriedOnceAndTheLastOnesSilenceIsTheLossOfTheDevice) {
  run(10, {0});
  slot->read(true);
  EXPECT_EQ(until_it_goes_over(), 3);
  EXPECT_EQ(until_it_goes_over(), 3);
  EXPECT_EQ(slot->left(), 1);
  EXPECT_EQ(slot->taken(), 2);
  EXPECT_EQ(port.fall_backs(), 2U);
  int cycles = 0;
  while (!slot->just_lost() && cycles < 100) {
    slot->read(true);
    slot->write(1, false, false);
    EXPECT_FALSE(slot->just_fell_back());
    ++cycles;
  }
  EXPECT_TRUE(slot->just_lost());
  EXPECT_FALSE(slot->alive());
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::Silent);
  run(20, {0, 1});
  EXPECT_FALSE(slot->alive()) << "who was left does not come back by itself";
  run(2, {2});
  EXPECT_TRUE(slot->alive()) << "the last one is listened to, as an only one is";
}

TEST_F(FallBack, ANewConfigurationBeginsWithThePreferredOne) {
  run(10, {0});
  slot->read(true);
  ASSERT_GT(until_it_goes_over(), 0);
  slot.reset();
  make();
  EXPECT_EQ(port.endnode(), 0);
  EXPECT_EQ(port.fall_backs(), 0U);
  run(3, {0});
  EXPECT_TRUE(slot->alive());
}

TEST_F(FallBack, AFrameGoesOutEverySoManyCyclesAndAtOnceWhenWhatItMayDoChanges) {
  use.every = 4;
  slot.reset();
  make();
  std::string sent;
  const auto write = [&](std::uint32_t epoch, bool active) {
    slot->write(epoch, active, false);
    sent += heard(0) ? 'x' : '.';
  };
  for (int i = 0; i < 9; ++i) write(1, false);
  EXPECT_EQ(sent, "x...x...x");
  write(1, true);
  write(1, true);
  write(2, true);
  write(2, false);
  write(2, false);
  EXPECT_EQ(sent, "x...x...xx.xx.");
}

/// Cycles that a quick producer starts (CyclePace).
TEST_F(FallBack, TheWatchdogOfWhatWasLeftIsWaitedForInCyclesInWhichLimitsGoOnAlone) {
  run(10, {0});
  ASSERT_GT(until_it_goes_over(), 0);
  const auto cycle = [&](bool counts) {
    slot->write(1, false, false);
    if (const auto command = heard(1)) say(1, command->sequence);
    slot->read(true, counts);
  };
  for (int i = 0; i < 100; ++i) cycle(false);
  EXPECT_TRUE(slot->alive());
  EXPECT_TRUE(slot->holds_back()) << "no time has passed that its watchdog is known to have seen";
  int counted = 0;
  for (; slot->holds_back() && counted < 100; ++counted) cycle(true);
  EXPECT_GT(counted, 1);
  EXPECT_LE(counted, 6) << "5 ms of its watchdog and a cycle";
}

TEST_F(FallBack, WhoHangsUpInTheVeryCycleInWhichItWasToldActiveIsWaitedForAsLongAsItsWatchdogIs) {
  run(10, {0});
  slot->read(true, false);  // takes the last answer
  motor[0].reset();
  slot->read(true, false);
  ASSERT_TRUE(slot->just_fell_back()) << "at once, in a cycle in which no limit goes on, too";
  for (int cycle = 0; cycle < 6; ++cycle) {
    EXPECT_TRUE(slot->holds_back()) << cycle;
    slot->write(1, false, false);
    if (const auto command = heard(1)) say(1, command->sequence);
    slot->read(true);
  }
  EXPECT_FALSE(slot->holds_back());
}

TEST_F(FallBack, CyclesInWhichNoLimitGoesOnMakeAFrameThatGoesOutEverySoManyNoMoreFrequent) {
  std::string sent;
  const auto cycles = [&](int count, bool counts) {
    for (int i = 0; i < count; ++i) {
      slot->read(false, counts);
      slot->write(0, false, false);
      sent += heard(0) ? 'x' : '.';
    }
  };
  use.every = 4;
  make();
  cycles(1, false);
  EXPECT_EQ(sent, "x") << "the first goes out in any case";
  cycles(8, false);
  cycles(4, true);
  EXPECT_EQ(sent, "x...........x");
  use.every = 1;
  make();
  sent.clear();
  cycles(4, false);
  EXPECT_EQ(sent, "xxxx") << "who takes each frame gets one in each cycle";
}

}  // namespace
}  // namespace hirosco
