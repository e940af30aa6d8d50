// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/deliveries.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

/// Packets are numbers here. The channel of a member has `room` places.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct DeliveriesTest : PartsTest {
  static constexpr int room = static_cast<int>(ChannelPair::default_capacity);
  static constexpr int may_wait = static_cast<int>(Deliveries::most_waiting);
  std::vector<std::string> losses;
  Deliveries deliveries{craft, [this](const Member& member, std::uint32_t lost) {
                          losses.push_back(member.descriptor().name + " " + std::to_string(lost));
                        }};
  std::uint32_t processes{0};

  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
  }
  /// No two have the same number, as in an operating system.
  Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& described) override {
    auto launched = PartsTest::launch(described);
    if (launched) launched->process = played[described.subsystem.id].process = ++processes;
    return launched;
  }
  void give(int number, std::uint16_t apid = hand) {
    std::array<std::byte, 2> packet{};
    OctetWriter{packet}.put(static_cast<std::uint16_t>(number));
    deliveries.give(*craft.member(apid), packet);
  }
  /// So many, numbered from 0.
  void give_all(int many) {
    for (int number = 0; number < many; ++number) give(number);
  }
  std::vector<int> read(std::uint16_t apid = hand) {
    std::vector<int> found;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[apid].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      found.push_back(OctetReader{next->message.packet}.get<std::uint16_t>());
    }
  }
  static std::vector<int> numbers(int first, int end) {
    std::vector<int> all;
    for (int number = first; number < end; ++number) all.push_back(number);
    return all;
  }
  void is_started_anew(std::uint16_t apid = hand) {
    guard.forget(apid);
    craft.member(apid)->died();
    ASSERT_TRUE(parts.processes.start(apid));
  }
};

TEST_F(DeliveriesTest, WhatFindsRoomIsThereAtOnce) {
  give_all(3);
  EXPECT_EQ(read(), numbers(0, 3));
  EXPECT_THAT(read(camera), IsEmpty());
}

TEST_F(DeliveriesTest, WhatFindsNoneWaitsAndComesWithTheNextLook) {
  give_all(room + 3);
  EXPECT_EQ(read(), numbers(0, room));
  deliveries.watch(clock.now());
  EXPECT_EQ(read(), numbers(room, room + 3));
  EXPECT_THAT(losses, IsEmpty());
}

TEST_F(DeliveriesTest, WhatComesLaterPassesNothingThatWaits) {
  give_all(room + 2);
  read();
  give(room + 2);
  EXPECT_EQ(read(), numbers(room, room + 3));
}

TEST_F(DeliveriesTest, WhatFindsNoPlaceToWaitIsLostToItAloneAndTold) {
  give_all(room + may_wait);
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, IsEmpty()) << "all wait";
  give(9001);
  give(9002);
  give(7, camera);
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, ElementsAre("HAND 2"));
  EXPECT_THAT(read(camera), ElementsAre(7));
  EXPECT_EQ(read(), numbers(0, room));
  deliveries.watch(clock.now());
  EXPECT_EQ(read(), numbers(room, room + may_wait)) << "what was lost is gone, and what waited is whole";
}

TEST_F(DeliveriesTest, LossesAreToldOnceASecondEachOnce) {
  deliveries.lose(*craft.member(hand));
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, ElementsAre("HAND 1")) << "the first at once";
  deliveries.lose(*craft.member(hand));
  deliveries.lose(*craft.member(hand));
  wait(999ms);
  deliveries.watch(clock.now());
  EXPECT_EQ(losses.size(), 1U);
  wait(1ms);
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, ElementsAre("HAND 1", "HAND 2"));
  wait(5s);
  deliveries.watch(clock.now());
  EXPECT_EQ(losses.size(), 2U) << "nothing was lost since";
}

TEST_F(DeliveriesTest, WhoIsStartedAnewIsGivenNothingThatWaitedForTheProcessBefore) {
  give_all(room + 2);
  is_started_anew();
  give(9000);
  deliveries.watch(clock.now());
  EXPECT_THAT(read(), ElementsAre(9000));
  give_all(room + 2);
  is_started_anew();
  deliveries.watch(clock.now());
  EXPECT_THAT(read(), IsEmpty()) << "nor by a look alone";
}

TEST_F(DeliveriesTest, WhatTheDeadHadLostIsToldOfNobody) {
  deliveries.lose(*craft.member(hand));
  craft.member(hand)->died();
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, IsEmpty());
  is_started_anew();
  deliveries.lose(*craft.member(hand));
  deliveries.watch(clock.now());
  EXPECT_THAT(losses, ElementsAre("HAND 1")) << "its own alone";
}

}  // namespace
}  // namespace hirosco::supervisor
