// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/foreign_command.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/commands/request.hpp"
#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

class AForeignCommand : public ::testing::Test {
 protected:
  [[nodiscard]] StoredCommand read(std::uint8_t service, std::uint8_t subtype, Octets data,
                                   std::uint16_t apid = testing::drill_apid) const {
    const auto octets =
        testing::telecommand_of({.apid = apid, .service = service, .subtype = subtype, .source = 0x4001}, data);
    return command_of(catalogue, *pus::TelecommandView::parse(octets));
  }
  /// As somebody else would send it.
  [[nodiscard]] StoredCommand sent(const std::string& function, const nlohmann::json& arguments) const {
    const auto request =
        request_of(catalogue, {{"subsystem", "DRILL"}, {"function", function}, {"arguments", arguments}});
    EXPECT_TRUE(request);
    return request ? read(request->service, request->subtype, request->data) : StoredCommand{};
  }
  [[nodiscard]] static std::vector<std::byte> named(std::string name) {
    name.resize(17);
    std::vector<std::byte> data;
    for (const char letter : name) data.push_back(static_cast<std::byte>(letter));
    return data;
  }
  Catalogue catalogue{testing::workshop()};
};

TEST_F(AForeignCommand, HasTheNameAndTheArgumentsThatItWouldHaveHere) {
  const StoredCommand bore = sent("BORE", {{"DEPTH", 2.5}, {"TOOL", 2}});
  EXPECT_EQ(bore.apid, testing::drill_apid);
  EXPECT_EQ(bore.subsystem, "DRILL");
  EXPECT_EQ(bore.function, "BORE");
  EXPECT_EQ(bore.arguments, R"({"DEPTH":2.5,"TOOL":"Core"})") << "values by their names";
  EXPECT_EQ(bore.stage, "sent");
  EXPECT_EQ(bore.sender, "hirosco tc (16385)");
  EXPECT_EQ(sent("ENGRAVE", {{"WORDS", "ab"}, {"POINT", {0.5, -1.5}}}).arguments,
            R"({"POINT":[0.5,-1.5],"WORDS":"ab"})");
  EXPECT_EQ(sent("COUNT", {{"NUMBER", "18446744073709551615"}}).arguments, R"({"NUMBER":"18446744073709551615"})");
}

TEST_F(AForeignCommand, OfAnotherServiceIsCalledByItsNameWhereItHasOne) {
  EXPECT_EQ(read(17, 1, {}).function, "PING");
  const StoredCommand peek = sent("PEEK", {{"ADDRESS", 7}});
  EXPECT_EQ(peek.function, "PEEK");
  EXPECT_EQ(peek.arguments, R"({"ADDRESS":7})");
  const StoredCommand gain = sent("SET:GAIN", {{"GAIN", 0.25}});
  EXPECT_EQ(gain.function, "SET:GAIN");
  EXPECT_EQ(gain.arguments, R"({"GAIN":0.25})");
  EXPECT_EQ(read(3, 27, testing::in_octets(std::uint8_t{1}, std::uint16_t{70})).function, "TC[3,27]");
  const ParameterId speed{testing::drill_apid, Type::Double, 1};
  const StoredCommand read_only = read(20, 3, testing::in_octets(std::uint8_t{1}, speed.wire(), 1.0));
  EXPECT_EQ(read_only.function, "TC[20,3]") << "nothing sets this one";
  EXPECT_EQ(read_only.arguments, "{}");
}

TEST_F(AForeignCommand, WhoseArgumentsCannotBeReadHasItsNameAlone) {
  const StoredCommand bore = read(8, 1, named("BORE"));
  EXPECT_EQ(bore.function, "BORE");
  EXPECT_EQ(bore.arguments, "{}");
}

TEST_F(AForeignCommand, NobodyKnowsIsCalledAsItCallsItself) {
  EXPECT_EQ(read(8, 1, named("SAW")).function, "SAW");
  EXPECT_EQ(read(8, 1, named("")).function, "?");
  EXPECT_EQ(read(8, 1, {}).function, "?");
  const auto half = named("SA");
  EXPECT_EQ(read(8, 1, Octets{half}.first(2)).function, "SA");
}

TEST_F(AForeignCommand, ToNobodyIsToldByTheNumber) {
  const StoredCommand lost = read(8, 1, named("BORE"), 77);
  EXPECT_EQ(lost.subsystem, "APID 77");
  EXPECT_EQ(lost.apid, 77);
  EXPECT_EQ(lost.function, "BORE");
  EXPECT_EQ(lost.arguments, "{}");
}

TEST(ASender, IsToldByTheRangeOfItsSourceId) {
  EXPECT_EQ(sender_of(0x0FFF), "another ground (4095)");
  EXPECT_EQ(sender_of(0x1000), "an exported database (4096)");
  EXPECT_EQ(sender_of(0x1001), "another ground (4097)");
  EXPECT_EQ(sender_of(0x2000), "another ground station (8192)");
  EXPECT_EQ(sender_of(0x3FFF), "another ground station (16383)");
  EXPECT_EQ(sender_of(0x4000), "hirosco tc (16384)");
  EXPECT_EQ(sender_of(0x7FFF), "hirosco tc (32767)");
  EXPECT_EQ(sender_of(0x8000), "a Python client (32768)");
  EXPECT_EQ(sender_of(0xBFFF), "a Python client (49151)");
  EXPECT_EQ(sender_of(0xC000), "another ground (49152)");
}

}  // namespace
}  // namespace hirosco::ground
