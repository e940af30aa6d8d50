// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Structures in structures, and arrays of them (docs/adr/0103).
namespace hirosco::descriptor {
namespace {

using ::testing::ElementsAre;
using testing::marked;
using testing::read_text;

/// With the enumeration that `body` may name.
std::string with_structures(const std::string& body) {
  const std::string modes =
      R"(<Enumeration name="MODES"><Text value="0">rest</Text><Text value="1">follow</Text></Enumeration>)";
  return R"(<Subsystem name="S" id="10">)" + (body.contains("MODES") ? modes : "") + body + "</Subsystem>";
}

constexpr auto nested_controller = R"(
<StructRef name="CONTROLLER" id="7" type="STRUCT" writable="SafeOperational">
  <ParamRef name="MODE" id="1" type="UINT8" enumeration="MODES" minimum="0" maximum="1" init="follow"/>
  <StructRef name="GAINS" id="8" type="STRUCT">
    <ParamRef name="P" id="1" type="DOUBLE" minimum="0" maximum="100" init="20"/>
    <ParamRef name="D" id="2" type="DOUBLE" minimum="0" maximum="100"/>
  </StructRef>
  <StructRef name="JOINTS" id="9" count="2">
    <ParamRef name="ON" id="1" type="BOOL" init="on"/>
    <StructRef name="LIMITS" id="10">
      <ParamRef name="LEAST" id="3" type="DOUBLE" minimum="-3" maximum="0" init="-1.5"/>
      <ParamRef name="MOST" id="4" type="DOUBLE" minimum="0" maximum="3" init="1.5"/>
    </StructRef>
  </StructRef>
</StructRef>
<HKService id="4701" interval="10"><SampledOnce>
  <ParamRef name="CONTROLLER.JOINTS[1]"/><ParamRef name="GAINS.D"/>
</SampledOnce></HKService>)";

std::vector<std::string> field_names(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.name);
  return names;
}

TEST(Structures, StandInStructuresByTheirWay) {
  const auto reading = read_text(with_structures(nested_controller));
  ASSERT_TRUE(reading.value) << testing::rendered(reading.problems,
                                                  testing::text_source(with_structures(nested_controller)));
  const Parameter& parameter = *reading.value->find_parameter("CONTROLLER");
  std::vector<std::string> members;
  for (const auto& member : parameter.members) members.push_back(member.field.name + " " + std::to_string(member.id));
  EXPECT_THAT(members, ElementsAre("MODE 1", "GAINS.P 1", "GAINS.D 2", "JOINTS[0].ON 1", "JOINTS[0].LIMITS.LEAST 3",
                                   "JOINTS[0].LIMITS.MOST 4", "JOINTS[1].ON 2", "JOINTS[1].LIMITS.LEAST 5",
                                   "JOINTS[1].LIMITS.MOST 6"));
  std::vector<std::string> parts;
  for (const auto& part : parameter.parts)
    parts.push_back(part.name + " " + std::to_string(part.id) + ": " + std::to_string(part.first) + "+" +
                    std::to_string(part.count));
  EXPECT_THAT(parts, ElementsAre("GAINS 8: 1+2", "JOINTS[0] 9: 3+3", "JOINTS[0].LIMITS 10: 4+2", "JOINTS[1] 11: 6+3",
                                 "JOINTS[1].LIMITS 12: 7+2"));
  EXPECT_EQ(parameter.octets(), 1u + 2 * 8 + 2 * (1 + 2 * 8));
  EXPECT_EQ(parameter.init, (std::vector<Value>{1.0, 20.0, 0.0, 1.0, -1.5, 1.5, 1.0, -1.5, 1.5}));
}

TEST(Structures, AreReferredToWholeAndInPart) {
  const auto reading = read_text(with_structures(nested_controller));
  ASSERT_TRUE(reading.value);
  const SubsystemDescriptor& subsystem = *reading.value;
  const auto& sampled = subsystem.housekeeping.front().sampled_once;
  ASSERT_EQ(sampled.size(), 2u);
  EXPECT_THAT(field_names(fields_of(subsystem, sampled[0])),
              ElementsAre("JOINTS[1].ON", "JOINTS[1].LIMITS.LEAST", "JOINTS[1].LIMITS.MOST"));
  EXPECT_THAT(field_names(fields_of(subsystem, sampled[1])), ElementsAre("GAINS.D"));
  EXPECT_EQ(identity_of(subsystem, sampled[0]), (ParameterId{10, Type::Struct, 11}));
  const auto whole = find_place(subsystem, "CONTROLLER");
  const auto gains = find_place(subsystem, "CONTROLLER.GAINS");
  const auto gain = find_place(subsystem, "CONTROLLER.GAINS.P");
  const auto joint = find_place(subsystem, "CONTROLLER.JOINTS[0]");
  ASSERT_TRUE(whole && gains && gain && joint);
  EXPECT_TRUE(covers(subsystem, *whole, *gain));
  EXPECT_TRUE(covers(subsystem, *gains, *gain));
  EXPECT_FALSE(covers(subsystem, *gain, *gains));
  EXPECT_TRUE(overlap(subsystem, *gain, *gains));
  EXPECT_FALSE(overlap(subsystem, *joint, *gains));
  for (const auto& place : {*whole, *gains, *gain, *joint}) {
    const auto found = find_parameter(subsystem, identity_of(subsystem, place).wire());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->member, place.member) << place.text;
  }
  EXPECT_FALSE(find_place(subsystem, "CONTROLLER.GAINS.I"));
}

TEST(Structures, BeginWithWhatAMissionOrAProcessIsToldInPart) {
  auto reading = read_text(with_structures(nested_controller));
  ASSERT_TRUE(reading.value);
  SubsystemDescriptor& subsystem = *reading.value;
  EXPECT_TRUE(apply_override(subsystem, "CONTROLLER.GAINS=3 4"));
  EXPECT_TRUE(apply_override(subsystem, "CONTROLLER.JOINTS[1].ON=0"));
  EXPECT_EQ(subsystem.find_parameter("CONTROLLER")->init,
            (std::vector<Value>{1.0, 3.0, 4.0, 1.0, -1.5, 1.5, 0.0, -1.5, 1.5}));
  EXPECT_EQ(apply_override(subsystem, "CONTROLLER.GAINS=3").error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(apply_override(subsystem, "CONTROLLER.GAINS=3 4 5").error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(apply_override(subsystem, "CONTROLLER.GAIN=3").error().code, ErrorCode::NotFound);
}

TEST(Structures, WithWordsArePersistentAndToldToAProcessMemberByMember) {
  const std::string text = with_structures(R"(
<StructRef name="LABEL" id="7" writable="SafeOperational" persistent="yes">
  <ParamRef name="OWNER" id="1" type="TEXT" octets="12" init="nobody"/>
  <StructRef name="SHELVES" id="8" count="2">
    <ParamRef name="TITLE" id="2" type="TEXT" octets="8"/>
    <ParamRef name="SIZES" id="1" type="DOUBLE" count="2" minimum="0" maximum="9"/>
  </StructRef>
</StructRef>)");
  auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << testing::rendered(reading.problems, testing::text_source(text));
  MissionSubsystem set;
  set.subsystem = *reading.value;
  Parameter label = *set.subsystem.find_parameter("LABEL");
  label.init = {"Ada = L.", "a  b ", 1.0, 0.1, "", 3.0, 4.0};
  set.overrides = overrides_of(label);
  std::vector<std::string> told;
  for (const auto& [word, what] : changes_of(set)) {
    if (word == "--set") told.push_back(what);
    ASSERT_TRUE(apply_change(*reading.value, word, what)) << what;
  }
  EXPECT_THAT(told, ElementsAre("LABEL.OWNER=Ada = L.", "LABEL.SHELVES[0].TITLE=a  b ", "LABEL.SHELVES[0].SIZES=1 0.1",
                                "LABEL.SHELVES[1].TITLE=", "LABEL.SHELVES[1].SIZES=3 4"));
  EXPECT_EQ(reading.value->find_parameter("LABEL")->init, label.init);
}

TEST(Structures, AreSetByAConfigurationInPart) {
  const auto reading = read_text(with_structures(std::string{nested_controller} +
                                                 R"(<Configuration name="C" id="1" sampling_us="1000">
                                           <Set parameter="CONTROLLER.JOINTS[0].LIMITS" value="-1 2"/></Configuration>)"));
  ASSERT_TRUE(reading.value);
  const auto& initial = reading.value->configurations.front().initial;
  ASSERT_EQ(initial.size(), 1u);
  EXPECT_EQ(initial.front().values, (std::vector<Value>{-1.0, 2.0}));
  EXPECT_EQ(field_names(fields_of(*reading.value, initial.front().parameter)).front(), "JOINTS[0].LIMITS.LEAST");
}

// clang-format off
constexpr std::array bad_structures{
    std::pair{"E0256", R"(<StructRef name="A" id="1"><StructRef name="B" id="2"><StructRef name="C" id="3"><StructRef name="D" id="4">@<StructRef name="E" id="5"><ParamRef name="X" id="1" type="INT8"/></StructRef><ParamRef name="X" id="2" type="INT8"/></StructRef></StructRef></StructRef></StructRef>)"},
    std::pair{"E0256", R"(<StructRef name="A" id="1">@<StructRef name="B" id="2" count="64"><ParamRef name="V" id="1" type="INT8"/><ParamRef name="W" id="2" type="INT8"/><ParamRef name="X" id="3" type="INT8"/><ParamRef name="Y" id="1" type="INT16"/><ParamRef name="Z" id="2" type="INT16"/></StructRef></StructRef>)"},
    std::pair{"E0256", R"(<StructRef name="A" id="1"><StructRef name="B" id="2" count="@3"><ParamRef name="X" id="254" type="INT8"/></StructRef></StructRef>)"},
    std::pair{"E0203", R"(<StructRef name="A" id="1"><StructRef name="B" id="2" count="@3"><ParamRef name="X" id="4" type="INT8"/></StructRef></StructRef><ParamRef name="Y" id="8" type="INT8"/><ParamRef name="Z" id="2" type="INT16"/><StructRef name="C" id="4"><ParamRef name="X" id="9" type="INT8"/></StructRef>)"},
    std::pair{"E0203", R"(<StructRef name="A" id="1"><StructRef name="B" id="@1"><ParamRef name="X" id="4" type="INT8"/></StructRef></StructRef>)"},
    std::pair{"E0112", R"(<StructRef name="A" id="1"><StructRef name="B" id="2" count="@65"><ParamRef name="X" id="4" type="INT8"/></StructRef></StructRef>)"},
    std::pair{"E0201", R"(<StructRef name="A" id="1"><StructRef name="B" id="2"><ParamRef name="X" id="4" type="INT8"/></StructRef>@<ParamRef name="B" id="5" type="INT8"/></StructRef>)"},
    std::pair{"E0228", R"(<StructRef name="A" id="1" writable="SafeOperational"><StructRef name="B" id="2">@<ParamRef name="X" id="4" type="INT8"/></StructRef></StructRef>)"},
    std::pair{"E0207", R"(<StructRef name="A" id="1"><StructRef name="B" id="2"><ParamRef name="X" id="4" type="INT8" maximum="3" init="@4"/></StructRef></StructRef>)"},
    std::pair{"E0204", R"(<StructRef name="A" id="1"><StructRef name="B" id="2" count="2"><ParamRef name="X" id="4" type="INT8"/></StructRef></StructRef><HKService id="1" interval="1"><SampledOnce><ParamRef name="@A.B"/></SampledOnce></HKService>)"},
};
// clang-format on

TEST(Structures, ThatCannotBeAreRefusedWithTheirPlace) {
  for (const auto& [code, body] : bad_structures) {
    auto text = marked(with_structures(body));
    const auto reading = read_text(text.text);
    ASSERT_FALSE(reading.problems.empty()) << body;
    if (code == std::string_view{"E0203"}) {  // two are told of: the second use is where the mark stands, or behind it
      EXPECT_EQ(reading.problems.front().code, code) << body;
      continue;
    }
    EXPECT_EQ(reading.problems.front().code, code) << body << reading.problems.front().message;
    EXPECT_EQ(reading.problems.front().at.column, text.at.column) << body;
    EXPECT_EQ(reading.problems.size(), 1u) << body;
  }
}

}  // namespace
}  // namespace hirosco::descriptor
