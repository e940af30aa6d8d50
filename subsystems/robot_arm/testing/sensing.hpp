// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// What the descriptor of an arm has besides whose device tells force and moment at its tip (docs/adr/0179, 0235).
namespace hirosco::robot_arm::testing {

/// Of the text of robot_arm.xml.
[[nodiscard]] inline std::string with_force_sensor(std::string text) {
  const auto before = [&](std::string_view place, std::string_view more) { text.insert(text.find(place), more); };
  before("    </Input>\n", R"(      <Field name="FORCE" type="DOUBLE" count="3" unit="N"/>
      <Field name="MOMENT" type="DOUBLE" count="3" unit="N m"/>
      <Field name="FORCE_AGE" type="UINT32" unit="ms"/>
)");
  before(R"(    <StructRef name="CYCLE_STATS" id="19"/>
  </Parameters>)",
         R"(    <StructRef name="WRIST" id="62" type="STRUCT">
      <ParamRef name="FORCE" id="200" type="DOUBLE" count="3" unit="N"/>
      <ParamRef name="MOMENT" id="201" type="DOUBLE" count="3" unit="N m"/>
      <ParamRef name="AGE" id="202" type="UINT32" unit="ms"/>
      <ParamRef name="VALID" id="203" type="UINT8"/>
    </StructRef>
    <StructRef name="WRIST_RANGE" id="63" type="STRUCT" protection="yes">
      <ParamRef name="FORCE" id="205" type="DOUBLE" unit="N" init="100" minimum="100" maximum="100"/>
      <ParamRef name="MOMENT" id="206" type="DOUBLE" unit="N m" init="10" minimum="10" maximum="10"/>
    </StructRef>
)");
  before("  </EventService>\n", R"(    <Event name="WRIST_CONTACT" id="1065" severity="low">
      <Argument name="FORCE" type="DOUBLE" unit="N"/><Argument name="MOMENT" type="DOUBLE" unit="N m"/><Argument name="REACTION" type="UINT8" enumeration="REACTIONS"/>
    </Event>
    <Event name="FORCE_SENSOR_LOST" id="1066" severity="low"><Argument name="AGE" type="UINT32" unit="ms"/></Event>
)");
  return text;
}

/// Of the text of floating_arm.xml.
[[nodiscard]] inline std::string with_force_sensor_on_a_floating_base(std::string text) {
  const auto before = [&](std::string_view place, std::string_view more) { text.insert(text.find(place), more); };
  before("    </Input>\n", R"(      <Field name="FORCE" type="DOUBLE" count="3" unit="N"/>
      <Field name="MOMENT" type="DOUBLE" count="3" unit="N m"/>
      <Field name="FORCE_AGE" type="UINT32" unit="ms"/>
)");
  before("    <StructRef name=\"CYCLE_STATS\"", R"(    <StructRef name="WRIST" id="72" type="STRUCT">
      <ParamRef name="FORCE" id="200" type="DOUBLE" count="3" unit="N"/>
      <ParamRef name="MOMENT" id="201" type="DOUBLE" count="3" unit="N m"/>
      <ParamRef name="AGE" id="202" type="UINT32" unit="ms"/>
      <ParamRef name="VALID" id="203" type="UINT8"/>
    </StructRef>
    <StructRef name="WRIST_RANGE" id="73" type="STRUCT" protection="yes">
      <ParamRef name="FORCE" id="205" type="DOUBLE" unit="N" init="100" minimum="100" maximum="100"/>
      <ParamRef name="MOMENT" id="206" type="DOUBLE" unit="N m" init="10" minimum="10" maximum="10"/>
    </StructRef>
)");
  before("  </EventService>\n", R"(    <Event name="WRIST_CONTACT" id="2140" severity="low">
      <Argument name="FORCE" type="DOUBLE" unit="N"/><Argument name="MOMENT" type="DOUBLE" unit="N m"/><Argument name="REACTION" type="UINT8" enumeration="REACTIONS"/>
    </Event>
    <Event name="FORCE_SENSOR_LOST" id="2141" severity="low"><Argument name="AGE" type="UINT32" unit="ms"/></Event>
)");
  return text;
}

}  // namespace hirosco::robot_arm::testing
