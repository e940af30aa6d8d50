// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/request.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

class ARequest : public ::testing::Test {
 protected:
  [[nodiscard]] Answered<Request> read(const std::string& function, const nlohmann::json& arguments,
                                       const std::string& subsystem = "DRILL") const {
    return request_of(catalogue, {{"subsystem", subsystem}, {"function", function}, {"arguments", arguments}});
  }
  [[nodiscard]] std::string refusal(const std::string& function, const nlohmann::json& arguments) const {
    const auto request = read(function, arguments);
    if (request) return "taken";
    EXPECT_EQ(request.error().status, 400U);
    return request.error().text;
  }
  /// Data of TC[8,1]: the name, how many arguments, and these.
  [[nodiscard]] static std::vector<std::byte> call(std::string name, std::uint8_t count,
                                                   const std::vector<std::byte>& arguments) {
    name.resize(16);
    std::vector<std::byte> data;
    for (const char letter : name) data.push_back(static_cast<std::byte>(letter));
    data.push_back(std::byte{count});
    data.insert(data.end(), arguments.begin(), arguments.end());
    return data;
  }
  Catalogue catalogue{testing::workshop()};
};

TEST_F(ARequest, TakesNumbersAndNamesOfValuesWithoutRegardToCase) {
  const auto request = read("BORE", {{"DEPTH", 2.5}, {"TOOL", "core"}});
  ASSERT_TRUE(request) << request.error().text;
  EXPECT_EQ(request->subsystem->name, "DRILL");
  EXPECT_EQ(request->service, 8);
  EXPECT_EQ(request->subtype, 1);
  EXPECT_EQ(request->data, call("BORE", 2, testing::in_octets(std::uint8_t{1}, 2.5, std::uint8_t{2}, std::uint8_t{2})));
  EXPECT_EQ(request->arguments, R"({"DEPTH":2.5,"TOOL":"core"})");
  EXPECT_EQ(request->way, Way::InTurn);
  EXPECT_FALSE(request->essential);
  EXPECT_FALSE(request->confirm);
}

TEST_F(ARequest, SendsTheDeclaredValueOfWhatIsAbsentOrNullAndSaysSo) {
  for (const nlohmann::json& arguments :
       {nlohmann::json{{"DEPTH", 3}}, nlohmann::json{{"DEPTH", 3}, {"TOOL", nullptr}}}) {
    const auto request = read("BORE", arguments);
    ASSERT_TRUE(request) << request.error().text;
    EXPECT_EQ(request->data,
              call("BORE", 2, testing::in_octets(std::uint8_t{1}, 3.0, std::uint8_t{2}, std::uint8_t{1})));
    EXPECT_EQ(request->arguments, R"({"DEPTH":3,"TOOL":1})");
  }
}

TEST_F(ARequest, TakesWordsAndListsOfNumbers) {
  const auto request = read("ENGRAVE", {{"WORDS", "ab"}, {"POINT", {0.5, -1.5}}});
  ASSERT_TRUE(request) << request.error().text;
  EXPECT_EQ(request->data,
            call("ENGRAVE", 2,
                 testing::in_octets(std::uint8_t{1}, std::uint16_t{2}, 'a', 'b', std::uint8_t{2}, 0.5F, -1.5F)));
  EXPECT_EQ(request->arguments, R"({"POINT":[0.5,-1.5],"WORDS":"ab"})");
}

TEST_F(ARequest, LosesNoDigitOfAWideNumber) {
  const auto expected =
      call("COUNT", 1, testing::in_octets(std::uint8_t{1}, std::uint64_t{18'446'744'073'709'551'615U}));
  const auto number = read("COUNT", {{"NUMBER", std::uint64_t{18'446'744'073'709'551'615U}}});
  const auto digits = read("COUNT", {{"NUMBER", "18446744073709551615"}});
  ASSERT_TRUE(number && digits);
  EXPECT_EQ(number->data, expected);
  EXPECT_EQ(digits->data, expected);
  EXPECT_EQ(number->arguments, R"({"NUMBER":"18446744073709551615"})") << "a page would round a number";
  EXPECT_EQ(refusal("COUNT", {{"NUMBER", 1e19}}), "NUMBER: neither a number nor a name that it knows")
      << "what was written so has been rounded already";
}

TEST_F(ARequest, NamesTheArgumentThatDoesNotFitAndWhatItMayBe) {
  EXPECT_EQ(refusal("BORE", {{"TOOL", 1}}), "DEPTH: a value is wanted");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", 0.5}}), "DEPTH: 0.5 is below its minimum 1 mm");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", 51}}), "DEPTH: 51 is above its maximum 50 mm");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", true}}), "DEPTH: neither a number nor a name that it knows");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", "2"}}), "DEPTH: neither a number nor a name that it knows");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", {2, 3}}}), "DEPTH: 1 values are wanted");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", 2}, {"TOOL", 3}}), "TOOL: 3 is none of Twist|Core");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", 2}, {"TOOL", "saw"}}), "TOOL: neither a number nor a name that it knows");
  EXPECT_EQ(refusal("BORE", {{"DEPTH", 2}, {"WIDTH", 1}}), "BORE has no argument 'WIDTH'");
  EXPECT_EQ(refusal("BORE", nlohmann::json::array({2})), "arguments: an object {name: value} is wanted");
  EXPECT_EQ(refusal("ENGRAVE", {{"WORDS", 5}, {"POINT", {0, 0}}}), "WORDS: a text is wanted");
  EXPECT_EQ(refusal("ENGRAVE", {{"WORDS", "much too long"}, {"POINT", {0, 0}}}),
            "WORDS: at most 8 octets of text are wanted");
  EXPECT_EQ(refusal("ENGRAVE", {{"WORDS", ""}, {"POINT", {0}}}), "POINT: 2 values are wanted");
  EXPECT_EQ(refusal("COUNT", {{"NUMBER", 2.5}}), "COUNT: fraction for an integer argument");
  EXPECT_EQ(refusal("COUNT", {{"NUMBER", -1}}), "COUNT: argument exceeds its type");
}

TEST_F(ARequest, NamesTheSubsystemAndTheFunctionThatThereIsNot) {
  EXPECT_EQ(refusal("SAW", nlohmann::json::object()), "DRILL has no function 'SAW'");
  EXPECT_EQ(read("BORE", nlohmann::json::object(), "SAW").error().text, "no subsystem 'SAW'");
  EXPECT_EQ(request_of(catalogue, {{"subsystem", 10}, {"function", "BORE"}}).error().text, "no subsystem ''");
}

TEST_F(ARequest, WithoutArgumentsNeedsNone) {
  const auto request = request_of(catalogue, {{"subsystem", "LAMP"}, {"function", "PING"}});
  ASSERT_TRUE(request) << request.error().text;
  EXPECT_EQ(request->service, 17);
  EXPECT_EQ(request->subtype, 1);
  EXPECT_TRUE(request->data.empty());
  EXPECT_EQ(request->arguments, "{}");
  EXPECT_EQ(request->way, Way::InTurn) << "a ping asks about the ordinary way";
}

TEST_F(ARequest, OfAnotherServiceIsAddressedToIt) {
  const auto own = read("PEEK", {{"ADDRESS", 0x1234}});
  ASSERT_TRUE(own) << own.error().text;
  EXPECT_EQ(own->service, 200);
  EXPECT_EQ(own->data, testing::in_octets(std::uint16_t{0x1234}));
  const auto setting = read("SET:GAIN", {{"GAIN", 0.25}});
  ASSERT_TRUE(setting) << setting.error().text;
  EXPECT_EQ(setting->service, 20);
  EXPECT_EQ(setting->subtype, 3);
  const ParameterId gain{testing::drill_apid, Type::Double, 6};
  EXPECT_EQ(setting->data, testing::in_octets(std::uint8_t{1}, gain.wire(), 0.25));
}

TEST_F(ARequest, SaysWhetherItIsEssentialAndWhetherSomebodyIsAskedOnceMore) {
  const auto stop = read("SAFE_ALL", nlohmann::json::object(), "SUPERVISOR");
  ASSERT_TRUE(stop) << stop.error().text;
  EXPECT_TRUE(stop->essential);
  EXPECT_EQ(stop->way, Way::Alone);
  const auto wipe = read("WIPE", nlohmann::json::object());
  ASSERT_TRUE(wipe) << wipe.error().text;
  EXPECT_TRUE(wipe->confirm);
  EXPECT_EQ(wipe->way, Way::InTurn);
}

}  // namespace
}  // namespace hirosco::ground
