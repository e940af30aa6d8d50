// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/service/arguments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/testing/vectors.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using descriptor::Function;

Argument typed(const char* name, Type type, std::uint16_t count = 1) {
  Argument made;
  made.field.name = name;
  made.field.type = type;
  made.field.count = count;
  return made;
}

Argument words(std::uint16_t octets) {
  Argument made = typed("NOTE", Type::Text);
  made.field.text_octets = octets;
  return made;
}

/// A function with one argument of each kind.
struct TypedArguments : ::testing::Test {
  TypedArguments() {
    function.name = "PROGRAM";
    Argument any = typed("SERIAL", Type::Uint64);
    any.field.minimum = 1;
    Argument named = typed("COLOUR", Type::Uint8);
    named.texts = {{1, "red"}, {7, "green"}};
    Argument flag = typed("ON", Type::Bool);
    flag.texts = {{0, "off"}, {1, "on"}};
    flag.fallback = true;
    function.arguments = {any, named, words(5), typed("STEPS", Type::Int16, 3), flag};
  }
  std::string refusal(const std::string& arguments) const {
    const auto call = decode_call({&function, 1}, from_hex(name + arguments));
    if (call) return "good";
    std::vector<std::byte> code(2);
    OctetWriter{code}.put(static_cast<std::uint16_t>(call.error().notice.code()));
    return (call.error().stage == Stage::Start ? "start " : "acceptance ") + to_hex(code) +
           to_hex(call.error().notice.data());
  }
  std::string encoded(std::vector<std::optional<Value>> values) const {
    const auto data = encode_call(function, GivenValues{values});
    return data ? to_hex(*data) : std::string{data.error().text} + " " + std::to_string(data.error().value);
  }
  Function function;
  const std::string name = "50524f4752414d000000000000000000";
  const std::string serial = "01ffffffffffffffff", colour = "0207", note = "030003e282ac", steps = "04800000007fff",
                    on = "0500";
};

TEST_F(TypedArguments, StandOnTheWireAsTheStandardSaysAndReachTheCycleWhole) {
  const std::vector<std::optional<Value>> values{UINT64_MAX, 7, "\u20ac", -32'768, 0, 32'767, false};
  EXPECT_EQ(encoded(values), name + "05" + serial + colour + note + steps + on);
  const auto call = decode_call({&function, 1}, from_hex(name + "05" + on + steps + note + colour + serial));
  ASSERT_TRUE(call.has_value());
  ArgumentReader reader{function.arguments, call->arguments};
  EXPECT_EQ(reader.remaining(), 7U);
  EXPECT_EQ(reader.number(), Number{UINT64_MAX});
  EXPECT_EQ(reader.number(), Number{7});
  EXPECT_EQ(reader.text(), "\u20ac");
  EXPECT_EQ(reader.count(), 3);
  EXPECT_EQ(reader.rest(), (std::vector<Value>{-32'768, 0, 32'767, 0}));
  EXPECT_EQ(reader.remaining(), 0U);
  EXPECT_EQ(reader.number(), Number{0}) << "behind the end there is nothing";
  EXPECT_EQ(reader.text(), "");
}

TEST_F(TypedArguments, ThatAreWrongAreRefusedWithTheirIndex) {
  const std::string rest = colour + note + steps;
  EXPECT_EQ(refusal("04" + serial + rest), "good") << "the last by its default";
  EXPECT_EQ(refusal("04" + ("01" + std::string(16, '0')) + rest), "start 01050000000001") << "below the minimum";
  EXPECT_EQ(refusal("04" + serial + "0202" + note + steps), "start 01050100000002") << "no value of the enumeration";
  EXPECT_EQ(refusal("04" + serial + colour + "030006616263646566" + steps), "start 01050200000003") << "longer";
  EXPECT_EQ(refusal("04" + serial + colour +
                    "030002c3"
                    "28" +
                    steps),
            "start 01050200000003")
      << "no UTF-8";
  EXPECT_EQ(refusal("04" + serial + colour + "030003610062" + steps), "start 01050200000003") << "a NUL within";
  EXPECT_EQ(refusal("05" + serial + rest + "0502"), "start 01050400000005") << "neither on nor off";
  EXPECT_EQ(refusal("04" + serial + colour + steps + "03ffff61"), "acceptance 0008") << "more text than there is";
  EXPECT_EQ(refusal("04" + serial + colour + note + "0480000000"), "acceptance 0008") << "an array cut off";
  EXPECT_EQ(refusal("03" + serial + colour + steps), "start 01050300000003") << "missing";
}

TEST_F(TypedArguments, TextHasNoneToItsMostOctets) {
  for (const auto& [octets, wanted] : std::vector<std::pair<std::size_t, bool>>{{0, true}, {5, true}, {6, false}}) {
    std::vector<std::byte> data;
    EXPECT_EQ(append_value(data, words(5), std::string(octets, 'x')).has_value(), wanted) << octets;
    EXPECT_EQ(data.size(), wanted ? octets + 2 : 0U);
  }
  EXPECT_TRUE(permits(words(4), "\xF0\x9F\x9A\x80"));
  for (const std::string_view bad :
       {std::string_view{"\xC0\xAF"}, std::string_view{"\xED\xA0\x80"}, std::string_view{"\xF4\x90\x80\x80"},
        std::string_view{"a\0b", 3}, std::string_view{"\xE2\x82"}})
    EXPECT_FALSE(permits(words(9), bad));
}

TEST_F(TypedArguments, AreNotEncodedWhenTheyWouldBeRefused) {
  EXPECT_EQ(encoded({0, 7, "", 1, 2, 3}), "argument outside its range 0");
  EXPECT_EQ(encoded({1, 2, "", 1, 2, 3}), "argument outside its range 0");
  EXPECT_EQ(encoded({1, 7, 5, 1, 2, 3}), "a number where text is wanted 0");
  EXPECT_EQ(encoded({1, "red", "", 1, 2, 3}), "text where a number is wanted 0");
  EXPECT_EQ(encoded({1, 7, "abcdef", 1, 2, 3}), "text longer than declared 0");
  EXPECT_EQ(encoded({1, 7, "\xFF", 1, 2, 3}), "text is not UTF-8 0");
  EXPECT_EQ(encoded({1, 7, "", 1, 2, 32'768}), "argument exceeds its type 0");
  EXPECT_EQ(encoded({1, 7, "", 1, 2, 0.5}), "fraction for an integer argument 0");
  EXPECT_EQ(encoded({1, 7, "", 1, 2}), "argument missing 4");
  EXPECT_EQ(encoded({18446744073709551616.0, 7, "", 1, 2, 3}), "argument exceeds its type 0");
}

TEST_F(TypedArguments, AreTypedAndShownInWords) {
  const auto& arguments = function.arguments;
  EXPECT_EQ(parse_value(arguments[0], "18446744073709551615"), Value{Number{UINT64_MAX}});
  EXPECT_EQ(parse_value(arguments[1], "GREEN"), Value{Number{7}});
  EXPECT_EQ(parse_value(arguments[1], "blue"), std::nullopt);
  EXPECT_EQ(parse_value(arguments[2], "12"), Value{std::string{"12"}});
  EXPECT_EQ(parse_value(arguments[4], "on"), Value{Number{1}});
  EXPECT_EQ(value_text(arguments[0], Number{UINT64_MAX}), "18446744073709551615");
  EXPECT_EQ(value_text(arguments[1], Number{7}), "green");
  EXPECT_EQ(value_text(arguments[1], Number{8}), "8");
  EXPECT_EQ(value_text(arguments[2], std::string{"a\x1B[2J\u20ac"}), "'a?[2J\u20ac'");
  EXPECT_EQ(range_text(arguments[0]), "1..18446744073709551615");
  EXPECT_EQ(range_text(arguments[1]), "red|green");
  EXPECT_EQ(range_text(arguments[2]), "text of at most 5 octets");
  EXPECT_EQ(range_text(arguments[3]), "3 of -32768..32767");
}

/// Whatever octets come: refused, or a call whose values are all permitted and encode to what was decoded.
TEST_F(TypedArguments, OfAnyOctetsAreRefusedOrWhatTheDescriptorPermits) {
  std::mt19937 random{8};
  const auto whole = from_hex(name + "05" + serial + colour + note + steps + on);
  std::size_t good = 0;
  const int tries = 200'000 / hirosco::testing::one_in(10);
  for (int i = 0; i < tries; ++i) {
    auto data = whole;
    for (unsigned changes = random() % 4; changes != 0; --changes) {
      const std::size_t at = function_name_octets + random() % (data.size() - function_name_octets);
      data[at] = static_cast<std::byte>(random());
    }
    if (random() % 4 == 0) data.resize(random() % (data.size() + 1));
    const auto call = decode_call({&function, 1}, data);
    if (!call) continue;
    ++good;
    const auto values = ArgumentReader{function.arguments, call->arguments}.rest();
    ASSERT_EQ(values.size(), value_count(function));
    const std::vector<std::optional<Value>> given{values.begin(), values.end()};
    const auto again = encode_call(function, GivenValues{given});
    ASSERT_TRUE(again) << again.error().text;
    const auto second = decode_call({&function, 1}, *again);
    ASSERT_TRUE(second.has_value());
    ASSERT_EQ(second->arguments, call->arguments);
  }
  EXPECT_GT(good, static_cast<std::size_t>(tries / 20));
  EXPECT_LT(good, static_cast<std::size_t>(tries / 20 * 19));
}

TEST(GivenValues, AreTheSameWhetherSomebodyTypedThemOrACallInCppHasThem) {
  const std::vector<std::optional<Value>> typed{Value{Number{3}}, std::nullopt, Value{std::string{"words"}}};
  const GivenValues typed_values{typed};
  ASSERT_EQ(typed_values.size(), 3U);
  EXPECT_EQ(typed_values.at(0), ValueView{Number{3}});
  EXPECT_EQ(typed_values.at(1), std::nullopt) << "the declared value is sent";
  EXPECT_EQ(typed_values.at(2), ValueView{std::string_view{"words"}});
  EXPECT_EQ(typed_values.at(3), std::nullopt);
  const std::array<double, 2> numbers{0.5, 1.5};
  const std::string_view words{"words"};
  const std::array native{NativeValue{numbers.data(), numbers.size(),
                                      [](const void* at, std::size_t element) noexcept {
                                        return ValueView{Number{static_cast<const double*>(at)[element]}};
                                      }},
                          NativeValue{&words, 1, [](const void* at, std::size_t) noexcept {
                                        return ValueView{*static_cast<const std::string_view*>(at)};
                                      }}};
  const GivenValues native_values{native};
  ASSERT_EQ(native_values.size(), 3U);
  EXPECT_EQ(native_values.at(1), ValueView{Number{1.5}});
  EXPECT_EQ(native_values.at(2), ValueView{words});
  EXPECT_EQ(native_values.at(3), std::nullopt);
  EXPECT_EQ(GivenValues{}.size(), 0U);
}

TEST(WrittenValues, OfWhichThereIsNoRoomAreNone) {
  std::array<std::byte, 3> room;
  OctetWriter writer{room};
  Argument number;
  number.field.type = Type::Uint16;
  const std::vector<std::optional<Value>> two{Value{Number{1}}, Value{Number{2}}};
  number.field.count = 2;
  ASSERT_TRUE(write_values(writer, {&number, 1}, two, Ids::None));
  EXPECT_EQ(all_written(writer).error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco::pus
