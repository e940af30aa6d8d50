// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/words/describe.hpp"

#include <gtest/gtest.h>

#include <array>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st17_test/self_test.hpp"

namespace hirosco::pus {
namespace {

[[nodiscard]] descriptor::Mission small_mission() {
  descriptor::Mission mission;
  mission.supervisor.name = "SUPERVISOR";
  mission.supervisor.id = 1;
  descriptor::MissionSubsystem member;
  member.subsystem.name = "ARM";
  member.subsystem.id = 10;
  member.subsystem.enumerations = {{"SIDES", {{1, "left"}, {2, "right"}}}};
  descriptor::Event event;
  event.name = "LIMIT";
  event.id = 1020;
  event.severity = descriptor::Severity::Medium;
  descriptor::Field side;
  side.name = "SIDE";
  side.type = Type::Uint8;
  side.enumeration = "SIDES";
  descriptor::Field value;
  value.name = "VALUE";
  value.unit = "N m";
  event.arguments = {side, value};
  member.subsystem.events = {event};
  mission.subsystems.push_back(member);
  return mission;
}

[[nodiscard]] std::string described_telemetry(std::uint8_t service, std::uint8_t subtype, Octets data) {
  const auto mission = small_mission();
  std::array<std::byte, 256> buffer;
  const auto packet = write_telemetry(buffer, {.apid = 10, .service = service, .subtype = subtype}, data);
  return PacketDescriber{mission}.describe(*packet);
}

TEST(PacketDescriber, NamesAnEventWithItsArgumentsAndUnits) {
  std::array<std::byte, 16> data;
  OctetWriter writer{data};
  writer.put(std::uint16_t{1020}).put(std::uint8_t{2}).put(12.5);
  EXPECT_EQ(described_telemetry(5, 3, writer.written()), "TM[5,3] ARM medium LIMIT SIDE=right VALUE=12.5 N m");
}

TEST(PacketDescriber, NamesTheStageAndTheReasonOfARefusal) {
  std::array<std::byte, 8> data;
  OctetWriter writer{data};
  writer.put(std::uint32_t{0x180A'C005}).put(std::uint16_t{13});
  EXPECT_EQ(described_telemetry(1, 2, writer.written()), "TM[1,2] ARM not accepted ARM #5: not permitted in this mode");
}

TEST(PacketDescriber, NamesTheParameterThatWasRefused) {
  descriptor::Mission mission = small_mission();
  auto& parameter = mission.subsystems.front().subsystem.parameters.emplace_back();
  parameter.id = 3;
  parameter.field.name = "GAIN";
  const PacketDescriber describer{mission};
  std::array<std::byte, 5> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 3}.wire());
  EXPECT_EQ(describer.describe_failure(10, 0x0105, data), "value not acceptable GAIN");
  EXPECT_EQ(describer.describe_failure(1, 0x0107, data), "not permitted now GAIN") << "by the supervisor";
  EXPECT_EQ(describer.describe_failure(10, 0x0107, Octets{data}.first(1)), "not permitted now");
  OctetWriter{data}.put(std::uint8_t{0}).put(std::uint32_t{3});
  EXPECT_EQ(describer.describe_failure(10, 0x0105, data), "value not acceptable") << "an argument of a function";
}

TEST(PacketDescriber, ShowsSwitchesWordsAndNamesOfValuesOfParameters) {
  descriptor::Mission mission = small_mission();
  const auto add = [&](const char* name, Type type, std::uint8_t id) -> descriptor::Field& {
    auto& parameter = mission.subsystems.front().subsystem.parameters.emplace_back();
    parameter.id = id;
    parameter.field.name = name;
    parameter.field.type = type;
    return parameter.field;
  };
  add("ON", Type::Bool, 1).count = 2;
  add("TITLE", Type::Text, 2).text_octets = 8;
  add("SIDE", Type::Uint8, 3).enumeration = "SIDES";
  std::array<std::byte, 64> data;
  OctetWriter writer{data};
  constexpr std::string_view words = "caf\xC3\xA9\n\0\0";
  writer.put(std::uint8_t{3}).put(ParameterId{10, Type::Bool, 1}.wire()).put(std::uint8_t{1}).put(std::uint8_t{0});
  writer.put(ParameterId{10, Type::Text, 2}.wire()).put(std::as_bytes(std::span{words.data(), 8}));
  writer.put(ParameterId{10, Type::Uint8, 3}.wire()).put(std::uint8_t{1});
  std::array<std::byte, 256> buffer;
  const auto packet = write_telemetry(buffer, {.apid = 10, .service = 20, .subtype = 2}, writer.written());
  EXPECT_EQ(PacketDescriber{mission}.describe(*packet),
            "TM[20,2] ARM VALUES PARAMETERS=(PARAMETER=ON VALUE=on,off),(PARAMETER=TITLE VALUE='caf\xC3\xA9?'),"
            "(PARAMETER=SIDE VALUE=left)");
}

TEST(PacketDescriber, NamesTheOutcomeOfASelfTestWithItsTimeAndReason) {
  std::array<std::byte, max_self_test_octets> room;
  const Octets data = write_self_test(room, {.outcome = SelfTestOutcome::Failed,
                                             .configuration = 2,
                                             .at = OnboardTime{std::chrono::milliseconds{1'000'500}},
                                             .code = FailureCode::ExecutionError,
                                             .number = 2,
                                             .reason = "wrong sign"});
  EXPECT_EQ(described_telemetry(17, 129, data),
            "TM[17,129] ARM SELF_TEST_OUTCOME OUTCOME=failed CONFIGURATION=2 TIME=1000.500 s CODE=514 NUMBER=2 "
            "REASON='wrong sign'");
  std::vector<std::byte> unknown{data.begin(), data.end()};
  unknown[0] = std::byte{9};
  EXPECT_NE(described_telemetry(17, 129, unknown).find("OUTCOME=9 "), std::string::npos);
  EXPECT_NE(described_telemetry(17, 129, data.first(4)).find("TIME=?"), std::string::npos);
}

[[nodiscard]] std::string described_question(std::uint16_t about, std::uint16_t event) {
  auto mission = small_mission();
  mission.supervisor.events.emplace_back().name = "ITS_OWN";
  mission.supervisor.events.back().id = 1020;
  std::array<std::byte, 4> data;
  OctetWriter writer{data};
  writer.put(about).put(event);
  std::array<std::byte, 64> buffer;
  const auto packet = write_telecommand(buffer, {.apid = 1, .service = 129, .subtype = 6}, writer.written());
  return PacketDescriber{mission}.describe(*packet);
}

TEST(PacketDescriber, NamesTheEventThatAQuestionIsAboutAsWhomItIsAboutDoes) {
  EXPECT_EQ(described_question(10, 1020), "TC[129,6] SUPERVISOR #0 PREVIEW_PLAN SUBSYSTEM=ARM EVENT=LIMIT");
  EXPECT_EQ(described_question(1, 1020), "TC[129,6] SUPERVISOR #0 PREVIEW_PLAN SUBSYSTEM=SUPERVISOR EVENT=ITS_OWN");
  EXPECT_EQ(described_question(77, 1020), "TC[129,6] SUPERVISOR #0 PREVIEW_PLAN SUBSYSTEM=77 EVENT=1020");
}

TEST(PacketDescriber, NamesAFunctionAndItsArguments) {
  const auto mission = small_mission();
  const auto common = common_functions();
  const double state = 4;
  const auto data = encode_call(common[0], std::span<const double>{&state, 1});
  ASSERT_TRUE(data);
  std::array<std::byte, 256> buffer;
  const auto packet = write_telecommand(buffer, {.apid = 10, .sequence_count = 7, .service = 8, .subtype = 1}, *data);
  EXPECT_EQ(PacketDescriber{mission}.describe(*packet), "TC[8,1] ARM #7 SET_STATE STATE=SafeOperational");
}

TEST(PacketDescriber, SaysWhatCanBeSaidOfADamagedPacket) {
  const auto mission = small_mission();
  std::array<std::byte, 256> buffer;
  const auto packet = write_telecommand(buffer, {.apid = 10, .service = 17, .subtype = 1}, {});
  buffer[packet->size() - 1] ^= std::byte{1};
  EXPECT_EQ(PacketDescriber{mission}.describe(*packet), "TC damaged: error control mismatch");
  EXPECT_EQ(PacketDescriber{mission}.describe(Octets{buffer}.first(3)), "fragment");
}

}  // namespace
}  // namespace hirosco::pus
