// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/requests.hpp"

#include <gtest/gtest.h>

#include "hirosco/pus/words/describe.hpp"

/// Requests by name, whatever service carries them.
namespace hirosco::pus {
namespace {

descriptor::Mission one_with_a_service() {
  descriptor::Mission mission;
  descriptor::MissionSubsystem member;
  member.subsystem.name = "LAMP";
  member.subsystem.id = 10;
  descriptor::Function dim;
  dim.name = "DIM";
  descriptor::Function blink;
  blink.name = "BLINK";
  blink.service = 200;
  blink.subtype = 3;
  descriptor::Function::Argument times;
  times.field.name = "TIMES";
  times.field.type = Type::Uint16;
  times.field.maximum = 500;
  descriptor::Function::Argument level;
  level.field.name = "LEVEL";
  level.field.count = 2;
  level.fallback = 0.5;
  blink.arguments = {times, level};
  descriptor::CustomService service;
  service.name = "SIGNAL";
  service.type = 200;
  service.requests = {blink};
  descriptor::Function::Argument count;
  count.field.name = "COUNT";
  count.field.type = Type::Uint16;
  service.reports = {{"BLINKED", 4, {count}}};
  descriptor::Parameter gain;
  gain.field.name = "GAIN";
  gain.id = 3;
  member.subsystem.parameters = {gain};
  member.subsystem.functions = {dim};
  member.subsystem.services = {service};
  mission.subsystems.push_back(member);
  return mission;
}

const descriptor::Function* request_named(const std::vector<descriptor::Function>& requests, std::string_view name) {
  const auto found = std::ranges::find(requests, name, &descriptor::Function::name);
  return found == requests.end() ? nullptr : &*found;
}

TEST(Requests, AreThoseOfEverySubsystemOfItsFunctionsAndOfItsOwnServices) {
  const auto mission = one_with_a_service();
  std::string names;
  for (const auto& request : requests_of(mission.subsystems[0].subsystem))
    names += request.name + " " + std::to_string(request.service) + "," + std::to_string(request.subtype) + ";";
  EXPECT_EQ(names,
            "SET_STATE 8,1;CONFIGURE 8,1;PING 17,1;SELF_TEST 17,128;REPORT_SELF_TEST 17,130;DIM 8,1;BLINK 200,3;");
}

TEST(Requests, OfAnOwnServiceCarryTheirArgumentsInOrderAndNothingElse) {
  const auto mission = one_with_a_service();
  const auto requests = requests_of(mission.subsystems[0].subsystem);
  const descriptor::Function& blink = *request_named(requests, "BLINK");
  const std::vector<std::optional<Value>> given{300.0, 0.25};
  const auto data = encode_request(blink, given);
  ASSERT_TRUE(data);
  EXPECT_EQ(data->size(), 2 + 8 + 8);
  EXPECT_EQ(decode_request(blink, *data), (std::vector<Value>{300.0, 0.25, 0.5})) << "the last by its default";
  EXPECT_FALSE(decode_request(blink, Octets{*data}.first(17)));
  const std::vector<std::optional<Value>> too_large{501.0}, none{};
  EXPECT_EQ(encode_request(blink, too_large).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(encode_request(blink, none).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(encode_request(*request_named(requests, "PING"), none)->size(), 0);
}

TEST(Requests, AreReadBackAsCallsOfFunctionsToo) {
  const auto mission = one_with_a_service();
  const auto requests = requests_of(mission.subsystems[0].subsystem);
  const std::vector<std::optional<Value>> operational{5.0};
  const auto data = encode_request(*request_named(requests, "SET_STATE"), operational);
  ASSERT_TRUE(data);
  EXPECT_EQ(decode_request(*request_named(requests, "SET_STATE"), *data), std::vector<Value>{5.0});
}

descriptor::SubsystemDescriptor one_with_a_structure() {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 10;
  subsystem.enumerations = {{"COLOURS", {{0, "red"}, {1, "green"}}}};
  descriptor::Parameter lamp;
  lamp.field.name = "LAMP";
  lamp.field.type = Type::Struct;
  lamp.id = 4;
  lamp.writable_states = 1 << static_cast<int>(descriptor::State::SafeOperational);
  const auto member = [](std::string name, Type type, std::uint8_t id) {
    descriptor::Parameter::Member made;
    made.field.name = std::move(name);
    made.field.type = type;
    made.id = id;
    return made;
  };
  lamp.members = {member("TITLE", Type::Text, 1), member("LIGHT.COLOUR", Type::Uint8, 2),
                  member("LIGHT.LEVEL", Type::Float, 3)};
  lamp.members[0].field.text_octets = 4;
  lamp.members[1].field.enumeration = "COLOURS";
  lamp.members[2].field.maximum = Number{1};
  lamp.parts = {{"LIGHT", 9, 1, 2, {}}};
  subsystem.parameters = {lamp};
  return subsystem;
}

TEST(Requests, SetAParameterWholeAndEachPartOfIt) {
  const auto requests = requests_of(one_with_a_structure());
  const descriptor::Function* const whole = request_named(requests, "SET:LAMP");
  const descriptor::Function* const light = request_named(requests, "SET:LAMP.LIGHT");
  ASSERT_TRUE(whole != nullptr && light != nullptr && request_named(requests, "SET:LAMP.LIGHT.LEVEL") != nullptr);
  EXPECT_TRUE(light->permitted_in(descriptor::State::SafeOperational));
  EXPECT_FALSE(light->permitted_in(descriptor::State::Operational));
  EXPECT_EQ(light->arguments[0].texts.size(), 2u);
  const std::vector<std::optional<Value>> given{"on", 1.0, 0.5};
  const auto data = encode_request(*whole, given);
  ASSERT_TRUE(data) << data.error().text;
  // N, the id of PTC 8 and so on: subsystem 10, STRUCT, 4; four octets of text, colour, level (IEEE 754).
  const std::vector<unsigned char> expected{1, 0, 10, 32, 4, 'o', 'n', 0, 0, 1, 0x3F, 0, 0, 0};
  EXPECT_TRUE(std::ranges::equal(*data, std::as_bytes(std::span{expected})));
  EXPECT_EQ(decode_request(*whole, *data), (std::vector<Value>{std::string{"on"}, 1.0, 0.5}));
  EXPECT_EQ(decode_request(*light, *data), std::nullopt) << "it is not what this one sets";
  EXPECT_TRUE(is_for(*whole, 20, 3, *data));
  EXPECT_FALSE(is_for(*light, 20, 3, *data));
}

TEST(Requests, SetNothingThatIsOutsideItsRangeOrIncomplete) {
  const auto requests = requests_of(one_with_a_structure());
  const descriptor::Function& light = *request_named(requests, "SET:LAMP.LIGHT");
  const std::vector<std::optional<Value>> too_bright{1.0, 1.5}, half{1.0}, no_colour{3.0, 0.5}, many{1.0, 0.5, 0.5};
  EXPECT_EQ(encode_request(light, too_bright).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(encode_request(light, half).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(encode_request(light, no_colour).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(encode_request(light, many).error().code, ErrorCode::InvalidArgument);
  const std::vector<std::optional<Value>> long_words{"longer", 1.0, 0.5};
  EXPECT_EQ(encode_request(*request_named(requests, "SET:LAMP"), long_words).error().code, ErrorCode::OutOfRange);
}

TEST(Requests, WhatIsEssentialGoesAloneAndAPingDoesNot) {
  const auto mission = one_with_a_service();
  auto requests = requests_of(mission.subsystems[0].subsystem);
  EXPECT_FALSE(goes_alone(*request_named(requests, "PING")));
  EXPECT_FALSE(goes_alone(*request_named(requests, "DIM")));
  descriptor::Function stop = *request_named(requests, "DIM");
  stop.essential = true;
  EXPECT_TRUE(goes_alone(stop));
}

TEST(Requests, OfEverySubsystemHaveNamesThatNoDescriptorMayTake) {
  std::vector<std::string_view> names;
  const auto requests = requests_of({});
  for (const auto& request : requests) names.push_back(request.name);
  EXPECT_TRUE(std::ranges::equal(names, descriptor::built_in_requests));
}

TEST(Requests, OfTheFrameworkSayWhatTheyDoAndWhereTheyArePermitted) {
  const auto requests = requests_of({});
  for (const auto& request : requests) {
    EXPECT_FALSE(request.description.empty()) << request.name;
    EXPECT_EQ(request.permitted_in(descriptor::State::Operational), request.name != "SELF_TEST");
    EXPECT_TRUE(request.permitted_in(descriptor::State::SafeOperational));
    EXPECT_EQ(request.essential, request.name == "PING");
  }
}

std::string described(const descriptor::Mission& mission, std::uint8_t service, std::uint8_t subtype, Octets data) {
  std::array<std::byte, 256> buffer;
  const auto packet = write_telecommand(buffer, {.apid = 10, .service = service, .subtype = subtype}, data);
  return PacketDescriber{mission}.describe(*packet);
}

TEST(Requests, HaveWordsOfTheirShape) {
  const auto mission = one_with_a_service();
  std::array<std::byte, 64> data;
  OctetWriter structures{data};
  structures.put(std::uint8_t{2}).put(std::uint16_t{4711}).put(std::uint16_t{4712});
  EXPECT_EQ(described(mission, 3, 5, structures.written()), "TC[3,5] LAMP #0 ENABLE_PERIODIC STRUCTURES=4711,4712");
  OctetWriter intervals{data};
  intervals.put(std::uint8_t{1}).put(std::uint16_t{4711}).put(std::uint32_t{50});
  EXPECT_EQ(described(mission, 3, 31, intervals.written()),
            "TC[3,31] LAMP #0 MODIFY_INTERVAL STRUCTURES=(STRUCTURE=4711 INTERVAL=50)");
  OctetWriter values{data};
  values.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 3}.wire()).put(1.5);
  EXPECT_EQ(described(mission, 20, 3, values.written()),
            "TC[20,3] LAMP #0 SET_VALUES PARAMETERS=(PARAMETER=GAIN VALUE=1.5)");
  EXPECT_EQ(described(mission, 17, 1, {}), "TC[17,1] LAMP #0 PING");
  EXPECT_EQ(described(mission, 17, 128, {}), "TC[17,128] LAMP #0 SELF_TEST");
}

TEST(Requests, HaveWordsForWhateverOctetsCome) {
  const auto mission = one_with_a_service();
  std::array<std::byte, 40> data;
  unsigned state = 1;
  for (std::size_t round = 0; round < 2000; ++round) {
    for (auto& octet : data) octet = static_cast<std::byte>((state = state * 1664525U + 1013904223U) >> 24);
    const auto service = static_cast<std::uint8_t>(std::array{3, 5, 8, 17, 20, 128, 129, 200}.at(round % 8));
    EXPECT_FALSE(
        described(mission, service, static_cast<std::uint8_t>(1 + round / 8 % 40), Octets{data}.first(round % 41))
            .empty());
  }
}

TEST(Requests, AndReportsOfAnOwnServiceHaveWords) {
  const auto mission = one_with_a_service();
  std::array<std::byte, 64> data, buffer;
  OctetWriter blink{data};
  blink.put(std::uint16_t{7}).put(0.25).put(0.5);
  EXPECT_EQ(described(mission, 200, 3, blink.written()), "TC[200,3] LAMP #0 BLINK TIMES=7 LEVEL=0.25,0.5");
  const auto packet = write_telemetry(buffer, {.apid = 10, .service = 200, .subtype = 4}, Octets{data}.first(2));
  EXPECT_EQ(PacketDescriber{mission}.describe(*packet), "TM[200,4] LAMP BLINKED COUNT=7");
  const auto cut = write_telemetry(buffer, {.apid = 10, .service = 200, .subtype = 4}, Octets{data}.first(1));
  EXPECT_EQ(PacketDescriber{mission}.describe(*cut), "TM[200,4] LAMP BLINKED COUNT=?");
}

}  // namespace
}  // namespace hirosco::pus
