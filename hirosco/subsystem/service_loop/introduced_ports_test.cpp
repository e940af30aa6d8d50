// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/introduced_ports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "hirosco/subsystem/testing/rig.hpp"

/// What an author has named of links and devices, against each configuration of the descriptor, with the line where it stands.
namespace hirosco::named_ports {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr const char* holding_descriptor = R"(<Subsystem name="ARM" id="10">
  <Device name="MOTOR"><Input><Field name="Q" type="DOUBLE"/></Input><Output><Field name="TORQUE" type="DOUBLE"/></Output></Device>
  <Configuration name="NOMINAL" id="1" sampling_us="1000"/>
  <Configuration name="HOLD" id="2" sampling_us="1000">
    <RealTimeLinkService>
      <Provides name="IMAGE" kind="loaned"><Field name="NUMBER" type="UINT64"/></Provides>
      <Requires name="HAND"><Field name="ANGLE" type="DOUBLE"/><Field name="ENABLE" type="UINT8"/></Requires>
      <Requires name="TICKS" kind="queued" depth="4"><Field name="NUMBER" type="UINT64"/></Requires>
      <Requires name="VIEW" kind="loaned"><Field name="NUMBER" type="UINT64"/></Requires>
    </RealTimeLinkService>
    <Device name="MOTOR"><Setting name="STIFFNESS" value="4"/><Endnode transfer="shared_memory" address="motor"/></Device>
  </Configuration>
</Subsystem>)";

struct Hand {
  double angle;
  std::uint8_t enable;
};
struct Number {
  std::uint64_t number;
};
struct Real {
  double q;
};
struct Octet {
  std::uint8_t q;
};
constexpr std::array<std::string_view, 1> stiffness{"STIFFNESS"};

struct PortsOfAnArm : ::testing::Test {
  descriptor::SubsystemDescriptor descriptor = testing::read_descriptor(holding_descriptor);
  IntroducedPorts ports{descriptor};
  LinkInput<Hand> hand;
  QueueInput<Number> ticks;
  LoanInput<Number> view;
  LoanOutput<Number> image;
  DevicePort<Real, Real> motor;

  void name_all() {
    ports.require_link("HAND", hand);
    ports.require_link("TICKS", ticks);
    ports.require_link("VIEW", view);
    ports.lend_link("IMAGE", image);
    motor.will_read(stiffness);
    ports.use_device("MOTOR", motor);
  }
  /// Line of the descriptor, code and words of each.
  [[nodiscard]] std::vector<std::string> told(std::string_view configuration = "HOLD") const {
    std::vector<std::string> lines;
    for (const Mistake& each : ports.mistakes(*descriptor.find_configuration(configuration))) {
      EXPECT_FALSE(each.remedy.empty()) << each.text;
      lines.push_back(std::to_string(each.at->line) + " " + each.code + " " + each.text);
    }
    return lines;
  }
};

TEST_F(PortsOfAnArm, AreRightWhereEachSetAndDeviceOfAConfigurationHasItsOwn) {
  name_all();
  EXPECT_THAT(told(), IsEmpty());
  EXPECT_EQ(ports.link("HAND"), &hand);
  EXPECT_EQ(ports.lent("IMAGE"), &image);
  EXPECT_EQ(ports.device("MOTOR"), &motor);
}

TEST_F(PortsOfAnArm, AreMissedOneByOneInTheConfigurationThatUsesThem) {
  EXPECT_THAT(told(), ElementsAre("7 E0406 require_link HAND: the set is required and has no port",
                                  "8 E0406 require_link TICKS: the set is required and has no port",
                                  "9 E0406 require_link VIEW: the set is required and has no port",
                                  "6 E0406 set lent but without a place to make it, lend_link: IMAGE",
                                  "2 E0406 use_device MOTOR: the device is used and has no port",
                                  "11 E0405 nobody reads setting 'STIFFNESS' of 'MOTOR'"));
  EXPECT_THAT(told("NOMINAL"), IsEmpty());
  EXPECT_EQ(ports.link("HAND"), nullptr);
}

TEST_F(PortsOfAnArm, OfOtherFieldsOrKindsAreEachTold) {
  name_all();
  LinkInput<Number> short_hand, newest_ticks, copied_view;
  LoanOutput<Real> real_image;
  DevicePort<Octet, Octet> octet_motor;
  ports.require_link("HAND", short_hand);
  ports.require_link("TICKS", newest_ticks);
  ports.require_link("VIEW", copied_view);
  ports.lend_link("IMAGE", real_image);
  octet_motor.will_read(stiffness);
  ports.use_device("MOTOR", octet_motor);
  EXPECT_THAT(
      told(),
      ElementsAre("7 E0406 require_link HAND: the C++ type has 1 members, the descriptor declares 2 fields",
                  "8 E0406 require_link TICKS: is queued, its port is no QueueInput",
                  "9 E0406 require_link VIEW: is lent, its port is no LoanInput",
                  "6 E0406 lend_link IMAGE: field NUMBER: C++ has DOUBLE[1], the descriptor declares UINT64[1]",
                  "2 E0406 use_device MOTOR: input, field Q: C++ has UINT8[1], the descriptor declares DOUBLE[1]; "
                  "output, field TORQUE: C++ has UINT8[1], the descriptor declares DOUBLE[1]"));
}

TEST_F(PortsOfAnArm, AreNoneOfASetThatIsCopiedWhereTheyTakeAllSamples) {
  name_all();
  QueueInput<Hand> all;
  ports.require_link("HAND", all);
  EXPECT_THAT(told(), ElementsAre("7 E0406 require_link HAND: is copied, its port is no LinkInput"));
}

TEST_F(PortsOfAnArm, AreForgotten) {
  name_all();
  ports.forget();
  EXPECT_EQ(told().size(), 6u);
}

}  // namespace
}  // namespace hirosco::named_ports
