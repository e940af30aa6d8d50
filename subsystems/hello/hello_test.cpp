// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/hello/hello.hpp"

#include <gtest/gtest.h>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco {
namespace {

struct HelloTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/hello/hello.xml"};
  std::unique_ptr<Subsystem> hello = make_hello();
  testing::Rig rig{*hello, descriptor::file_system()(file).value()};

  /// The newest report of structure 4711: where the joint is, as ground sees it.
  double position_rad() {
    rig.cycle(500);
    rig.service();
    const pus::HousekeepingDecoder decoder{rig.descriptor()};
    for (auto report = rig.telemetry.rbegin(); report != rig.telemetry.rend(); ++report) {
      if (report->service != 3) continue;
      const auto values = decoder.decode(report->data).value();
      for (const auto& value : values)
        if (value.name == "CUR_VALUES.POSITION") return value.values[0];
    }
    return -1;
  }
};

TEST_F(HelloTest, CreepsToItsInitialGoalAndStaysThere) {
  rig.bring_to(State::Operational);
  EXPECT_NEAR(position_rad(), 0.2 * 0.25, 0.005);  // 0.2 rad/s for about 0.25 s
  rig.cycle(5'000);
  EXPECT_EQ(position_rad(), 0.3);
}

TEST_F(HelloTest, StandsStillBeforeOperational) {
  rig.bring_to(State::SafeOperational);
  EXPECT_EQ(position_rad(), 0.0);
}

TEST_F(HelloTest, MovesToWhereItIsTold) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE_TO", {-0.1});
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  rig.cycle(2'000);
  EXPECT_EQ(position_rad(), -0.1);
}

TEST_F(HelloTest, RefusesAGoalBeyondItsLimit) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE_TO", {1.6});
  rig.settle();
  EXPECT_TRUE(rig.outcome(request).starts_with("1 4:0105"));
}

/// Its descriptor says -3.2 to 3.2: it never comes to the handler. Index 0, argument 1.
TEST_F(HelloTest, IsNotAskedForAGoalOutsideOfTheDeclaredRange) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE_TO", {3.3});
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 4:01050000000001");
}

TEST_F(HelloTest, SaysInWordsWhatATestCannotSend) {
  const auto why_not = [&](std::string_view function, std::initializer_list<double> values) -> std::string {
    try {
      rig.call(function, values);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "sent";
  };
  EXPECT_EQ(why_not("MOVE", {0.1}), "Rig::call: HELLO has no function 'MOVE'; its descriptor has: MOVE_TO");
  EXPECT_NE(why_not("MOVE_TO", {}).find("argument missing: no telecommand can carry it; give 1 values"),
            std::string::npos);
}

}  // namespace
}  // namespace hirosco
