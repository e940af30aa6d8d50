// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/found_values.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

constexpr std::uint16_t taken_event = 142, refused_event = 143;

struct FoundValuesTest : PartsTest {
  FoundValues found{craft, parts.own};
  std::vector<std::uint16_t> events;

  void SetUp() override {
    PartsTest::SetUp();
    start_all(PreOperational);
    found.begin(clock.now());
  }
  void routed(const pus::TelemetryView& packet) override {
    PartsTest::routed(packet);
    if (packet.service() != 5 || packet.apid() != supervisor_apid) return;
    const auto id = OctetReader{packet.source_data()}.get<std::uint16_t>();
    if (id == taken_event || id == refused_event) events.push_back(id);
  }
  void tell() {
    found.tell(clock.now());
    for (int step = 0; step < 3; ++step) own_step();
  }
};

TEST_F(FoundValuesTest, AreToldOnceWhenTheGroundLinkIsThere) {
  found.refused(arm, 1, CopyFault::Damaged);
  found.taken(arm, 3, OnboardTime{});
  tell();
  EXPECT_THAT(events, IsEmpty()) << "nobody would hear of it";
  set(camera, Operational);
  tell();
  EXPECT_THAT(events, ElementsAre(refused_event, taken_event));
  tell();
  EXPECT_EQ(events.size(), 2U);
}

TEST_F(FoundValuesTest, AreToldToTheLogWhenTheGroundLinkDoesNotCome) {
  found.taken(arm, 3, OnboardTime{});
  wait(FoundValues::patience - 100ms);
  tell();
  EXPECT_THAT(events, IsEmpty());
  wait(100ms);
  tell();
  EXPECT_THAT(events, ElementsAre(taken_event));
}

}  // namespace
}  // namespace hirosco::supervisor
