// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/communication.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco {
namespace {

using testing::Rig;

std::string descriptor_text() {
  std::ifstream file{HIROSCO_SOURCE_DIR "/subsystems/communication/communication.xml"};
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A link with so many packets that nobody takes, and what it has counted.
struct Link {
  GroundTransport::Counters counters;
  std::size_t waiting{0};
  bool open{false};
  int finished{0};
  int steps{0};
};
class Transport final : public GroundTransport {
 public:
  explicit Transport(Link& link) : link_{link} { link_.open = true; }
  void all_stopped() override {}
  ~Transport() override { link_.open = false; }
  void step(TimePoint) override { ++link_.steps; }
  [[nodiscard]] std::size_t finish(TimePoint) override {
    ++link_.finished;
    return link_.waiting;
  }
  void telemetry(Octets) override {}
  [[nodiscard]] const Counters& counters() const override { return link_.counters; }

 private:
  Link& link_;
};

struct OpenLink : ::testing::Test {
  Link link;
  std::unique_ptr<Subsystem> author{
      make_communication_on([this](GroundTraffic&) -> Result<std::unique_ptr<GroundTransport>> {
        return std::make_unique<Transport>(link);
      })};
  Rig rig{*author, descriptor_text()};

  void SetUp() override { rig.bring_to(State::SafeOperational); }
};

TEST_F(OpenLink, TellsEachConnectionThatTheSpacecraftEndsWithItsReasonAndNoOther) {
  using enum GroundTransport::CloseReason;
  for (const auto reason : {PeerClosed, Version, NotTelecommand, Length, Incomplete, Slow, Evicted, SocketError}) {
    rig.forget_telemetry();
    const auto number = static_cast<std::size_t>(reason);
    link.counters.closed[number] += 2;
    rig.advance(200ms);
    rig.settle();
    // The id of CLIENT_CUT, the reason, how many.
    const std::vector<std::string> told{"00cb0" + std::to_string(number) + "00000002"};
    const bool own_wish = reason == PeerClosed || reason == SocketError;
    EXPECT_EQ(rig.reports(5, 2), own_wish ? std::vector<std::string>{} : told) << number;
  }
}

struct ClosedLink : OpenLink {
  testing::Sent way_down;

  void SetUp() override {
    OpenLink::SetUp();
    way_down = rig.set_state(State::Offline);
  }
  static constexpr std::uint16_t dropped = 208;
};

TEST_F(ClosedLink, IsOpenUntilAllThatItHasReceivedIsTakenAndReadsNothingMeanwhile) {
  link.waiting = 3;
  rig.settle();
  const int steps = link.steps;
  for (int i = 0; i < 100; ++i) {
    rig.advance(4ms);
    rig.settle(1);
  }
  EXPECT_TRUE(link.open);
  EXPECT_GT(link.finished, 0);
  EXPECT_EQ(link.steps, steps);
  EXPECT_EQ(rig.state(), State::HardwareDeinit);
  link.waiting = 0;
  rig.settle();
  EXPECT_FALSE(link.open);
  EXPECT_EQ(rig.outcome(way_down), "1 3 7");
  EXPECT_EQ(rig.events(dropped), 0);
}

TEST_F(ClosedLink, TellsWhatNobodyTookInHalfASecondAndCloses) {
  link.waiting = 3;
  rig.settle();
  rig.advance(600ms);
  rig.settle();
  EXPECT_FALSE(link.open);
  EXPECT_EQ(rig.outcome(way_down), "1 3 7");
  EXPECT_EQ(rig.heard(dropped), 1);
}

}  // namespace
}  // namespace hirosco
