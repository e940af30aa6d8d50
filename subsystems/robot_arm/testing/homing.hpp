// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// What the descriptor of an arm has besides whose joints do not know their zero when they are switched on (docs/adr/0208).
namespace hirosco::robot_arm::testing {

/// How joints look for their marks, each alike.
struct HomingNumbers {
  std::string order, speed, torque, distance;  ///< of all joints
};

/// Of the text of robot_arm.xml, or of one with another number of joints, in orbit.
[[nodiscard]] inline std::string with_homing(std::string text, const HomingNumbers& numbers, std::size_t joints = 6) {
  const auto put = [&](std::size_t at, std::string_view more) { text.insert(at, more); };
  const auto before = [&](std::string_view place, std::string_view more) { put(text.find(place), more); };
  const std::string of_each = "count=\"" + std::to_string(joints) + "\"";
  std::string none;
  for (std::size_t i = 0; i < joints; ++i) none += i == 0 ? "0" : " 0";
  before("    </Input>\n", R"(      <Field name="REFERENCED" type="UINT8" )" + of_each + "/>\n");
  before("    </Output>\n", R"(      <Field name="REFERENCE" type="UINT8" )" + of_each +
                                R"( minimum="0" maximum="1" safe=")" + none + "\"/>\n");
  before(R"(    <StructRef name="CYCLE_STATS" id="19"/>
  </Parameters>)",
         R"(    <!-- of each joint: 1 where POSITION is from its zero -->
    <ParamRef name="REFERENCED" id="66" type="UINT8" )" +
             of_each + R"(/>
    <!-- HOME: joints by their numbers, in this order, each with this speed to the side of its sign, with no more than this torque, no farther than this -->
    <StructRef name="HOMING" id="67" type="STRUCT" writable="PreOperational SafeOperational">
      <ParamRef name="ORDER" id="220" type="UINT8" )" +
             of_each + " init=\"" + numbers.order + R"(" minimum="1" maximum="16"/>
      <ParamRef name="SPEED" id="221" type="DOUBLE" )" +
             of_each + " unit=\"rad/s\" init=\"" + numbers.speed + R"(" minimum="-0.2" maximum="0.2"/>
      <ParamRef name="TORQUE" id="222" type="DOUBLE" )" +
             of_each + " unit=\"N m\" init=\"" + numbers.torque + R"(" minimum="0" maximum="30"/>
      <ParamRef name="DISTANCE" id="223" type="DOUBLE" )" +
             of_each + " unit=\"rad\" init=\"" + numbers.distance + R"(" minimum="0" maximum="6.5"/>
    </StructRef>
    <!-- who looks for its mark; 0: nobody -->
    <ParamRef name="HOMING_JOINT" id="68" type="UINT8"/>
)");
  before(
      "  </EventService>\n",
      R"(    <Event name="NOT_REFERENCED" id="1070" severity="medium"><Argument name="JOINT" type="UINT8" enumeration="JOINTS"/></Event>
    <Event name="HOMING_UNDER_GRAVITY" id="1071" severity="medium"><Argument name="VALUE" type="DOUBLE" unit="m/s2"/></Event>
)");
  before("  <FunctionService>\n", R"(  <Failure code="0x8030" name="NOT_REFERENCED"/>
  <Failure code="0x8031" name="MARK_NOT_FOUND"/>
  <Failure code="0x8032" name="HOMING_PRESSED"/>
  <Failure code="0x8033" name="HOMING_UNFIT"/>
  <Failure code="0x8034" name="OTHER_CONFIGURATION"/>
)");
  before("    <Function name=\"HOLD\"", R"(    <Function name="HOME" states="Operational">
      <Description>In the configuration HOMING: joints that do not know their zero go to their marks, one by one; each that has found it is a step</Description>
    </Function>
)");
  const std::string weighs = R"(init="0 0 -9.81")", end = "  </Configuration>\n";
  text.replace(text.find(weighs), weighs.size(), R"(init="0 0 0")");
  // As POSITION, and its device says that it homes.
  const std::size_t begin = text.find("  <Configuration name=\"POSITION\" id=\"1\"");
  std::string homing = text.substr(begin, text.find(end, begin) + end.size() - begin);
  const std::string named = "name=\"POSITION\" id=\"1\"", endnode = "      <Endnode transfer";
  homing.replace(homing.find(named), named.size(), "name=\"HOMING\" id=\"3\"");
  homing.insert(homing.find(endnode), "      <Setting name=\"HOMING\" value=\"on\"/>\n");
  before("</Subsystem>", homing);
  return text;
}

/// Of robot_arm.urdf: the wrist first, so that it is folded before what carries it turns.
[[nodiscard]] inline HomingNumbers homing_numbers() {
  return {.order = "6 5 4 3 2 1",
          .speed = "0.1 0.1 -0.1 0.1 0.1 -0.1",
          .torque = "15 15 12 5 5 5",
          .distance = "0.4 0.4 0.4 0.4 0.4 0.4"};
}

}  // namespace hirosco::robot_arm::testing
