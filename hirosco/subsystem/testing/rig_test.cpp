// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/testing/rig.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hirosco::testing {
namespace {

constexpr std::string_view described = R"(<Subsystem name="LAMPS" id="20">
  <Parameters>
    <ParamRef name="LIMIT" id="1" type="DOUBLE" init="5" minimum="0" maximum="30" writable="PreOperational SafeOperational"/>
    <ParamRef name="SEEN" id="2" type="DOUBLE"/>
    <StructRef name="LAMP" id="0" writable="PreOperational">
      <ParamRef name="TITLE" id="10" type="TEXT" octets="4"/>
      <ParamRef name="LEVEL" id="11" type="UINT8" minimum="0" maximum="9"/>
    </StructRef>
  </Parameters>
  <Configuration name="NOMINAL" id="1" priority="60" sampling_us="1000"/>
</Subsystem>
)";

struct RigTest : ::testing::Test {
  struct Lamps final : Subsystem {
    struct Lamp {
      Text<4> title;
      std::uint8_t level;
    };
    Result<Step> software_init() override {
      publish("LIMIT", limit);
      publish("SEEN", seen);
      publish("LAMP", lamp);
      return done;
    }
    Parameter<double> limit, seen;
    Parameter<Lamp> lamp;
  } lamps;
  Rig rig{lamps, std::string{described}};

  std::string outcome(Sent request) {
    rig.settle();
    return rig.outcome(request);
  }
  std::string why_not(std::string_view parameter, const std::vector<std::optional<Value>>& values) {
    try {
      rig.set_with(parameter, values);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "sent";
  }
};

TEST_F(RigTest, SetsAParameterByItsName) {
  rig.bring_to(State::SafeOperational);
  EXPECT_EQ(outcome(rig.set("LIMIT", 10)), "1 3 7");
  EXPECT_EQ(lamps.limit.load(), 10.0);
}

TEST_F(RigTest, SetsAPartOfAStructureAndAllOfItByTheirNames) {
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(outcome(rig.set_with("LAMP", {"desk", 3.0})), "1 3 7");
  EXPECT_EQ(outcome(rig.set("LAMP.LEVEL", 7)), "1 3 7");
  EXPECT_EQ(lamps.lamp.load().title.view(), "desk");
  EXPECT_EQ(lamps.lamp.load().level, 7);
}

/// Code and index 0, then the id on the wire: APID 20, type (10: DOUBLE, 1: UINT8), id of the descriptor.
TEST_F(RigTest, SendsWhatIsOutsideOfItsRangeAndInAnotherStateSoThatATestSeesTheRefusal) {
  rig.bring_to(State::SafeOperational);
  EXPECT_EQ(outcome(rig.set("LIMIT", 31)), "1 4:01050000140a01");
  EXPECT_EQ(outcome(rig.set("LAMP.LEVEL", 7)), "1 4:0107000014010b");
  EXPECT_EQ(lamps.limit.load(), 5.0);
  EXPECT_EQ(lamps.lamp.load().level, 0);
}

TEST_F(RigTest, SaysInWordsWhichParameterItCannotSet) {
  const std::string those = "; its descriptor has: LIMIT LAMP LAMP.TITLE LAMP.LEVEL";
  EXPECT_EQ(why_not("LIMITS", {1.0}), "Rig::set: LAMPS has no writable parameter 'LIMITS'" + those);
  EXPECT_EQ(why_not("SEEN", {1.0}), "Rig::set: LAMPS has no writable parameter 'SEEN'" + those);
  EXPECT_EQ(
      why_not("LAMP", {"desk"}),
      "Rig::set: LAMP of LAMPS: a value missing: no telecommand can carry it; give 2 values of the types that the "
      "descriptor says");
  EXPECT_NE(why_not("LAMP.LEVEL", {256.0}).find("argument exceeds its type"), std::string::npos);
}

}  // namespace
}  // namespace hirosco::testing
