// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/json.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hirosco::ground {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(JsonNumber, WhatJsonHasNoNumberForIsATextThatJavaScriptUnderstands) {
  EXPECT_EQ(json_number(std::numeric_limits<double>::quiet_NaN()), json("NaN"));
  EXPECT_EQ(json_number(infinity), json("Infinity"));
  EXPECT_EQ(json_number(-infinity), json("-Infinity"));
}

TEST(JsonNumber, WholeNumbersHaveNoPointAndOthersAllTheirDigits) {
  EXPECT_EQ(to_string(json_number(3.0)), "3");
  EXPECT_EQ(to_string(json_number(-0.25)), "-0.25");
  EXPECT_TRUE(json_number(8'999'999'999'999'999.0).is_number_integer());
  EXPECT_TRUE(json_number(9.0e15).is_number_float()) << "beyond which a double leaves numbers out soon";
}

TEST(JsonNumber, AWholeNumberThatJavaScriptWouldRoundIsATextOfAllItsDigits) {
  constexpr std::int64_t exact = std::int64_t{1} << 53;
  EXPECT_EQ(json_number(Number{exact}), json(exact));
  EXPECT_EQ(json_number(Number{-exact}), json(-exact));
  EXPECT_EQ(json_number(Number{exact + 1}), json("9007199254740993"));
  EXPECT_EQ(json_number(Number{-exact - 1}), json("-9007199254740993"));
  EXPECT_EQ(json_number(Number{std::numeric_limits<std::uint64_t>::max()}), json("18446744073709551615"));
  EXPECT_EQ(json_value(hirosco::Value{std::string{"open"}}), json("open"));
  EXPECT_EQ(json_value(hirosco::Value{Number{0.5}}), json(0.5));
}

TEST(JsonTime, TimesThatDoNotFitBecomeTheNearestThatDoes) {
  EXPECT_EQ(onboard_time(1.5), OnboardTime{1500ms});
  EXPECT_EQ(onboard_time(-1.0), OnboardTime{});
  EXPECT_EQ(onboard_time(std::numeric_limits<double>::quiet_NaN()), OnboardTime{});
  EXPECT_EQ(onboard_time(infinity), OnboardTime{Duration{9'000'000'000'000'000'000}});
  EXPECT_EQ(json_time(OnboardTime{1500ms}), 1.5);
}

TEST(JsonText, OfAnObjectIsWhatItHasUnderThatNameWhereThatIsAText) {
  const json object{{"name", "ARM"}, {"count", 3}};
  EXPECT_EQ(text_of(object, "name"), "ARM");
  EXPECT_EQ(text_of(object, "count"), "");
  EXPECT_EQ(text_of(object, "nobody"), "");
  EXPECT_EQ(text_of(json::array({"name"}), "name"), "") << "no object at all";
}

TEST(JsonText, OctetsThatAreNoUtf8AreReplacedAndNothingIsThrown) {
  EXPECT_EQ(to_string(json("a\xFF"
                           "b")),
            "\"a\xEF\xBF\xBD"
            "b\"");
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
}

TEST(ParsedRequest, IsWhatItSays) {
  const json request = parsed_request(R"({"name": "LAMP", "arguments": {"name": 1}})");
  EXPECT_EQ(text_of(request, "name"), "LAMP") << "each object has names of its own";
  EXPECT_EQ(request["arguments"]["name"], 1);
}

TEST(ParsedRequest, OneThatTwoReadersWouldTakeForTwoThingsIsNone) {
  EXPECT_TRUE(parsed_request(R"({"value": 1, "value": 2})").is_discarded());
  EXPECT_TRUE(parsed_request(R"([{"a": {"value": 1, "b": 0, "value": 1}}])").is_discarded()) << "however deep";
  EXPECT_FALSE(parsed_request(R"([{"value": 1}, {"value": 2}])").is_discarded());
}

TEST(ParsedRequest, NestsNoDeeperThanAnyRequestDoes) {
  EXPECT_FALSE(parsed_request(nested(16)).is_discarded());
  EXPECT_TRUE(parsed_request(nested(18)).is_discarded());
  EXPECT_TRUE(parsed_request(nested(100'000)).is_discarded());
}

TEST(ParsedRequest, WhatIsNoJsonIsDiscarded) {
  for (const char* text : {"", "{", "{\"a\": }", "nobody", "{} {}"})
    EXPECT_TRUE(parsed_request(text).is_discarded()) << text;
}

}  // namespace
}  // namespace hirosco::ground
