// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/rig.hpp"

/// A function with every kind of argument, from the telecommand to the handler (adr 0063).
namespace hirosco {
namespace {

using ::testing::HasSubstr;
using testing::Rig;

constexpr const char* programmable = R"(<Subsystem name="S" id="10">
  <Enumeration name="COLOURS"><Text value="-1">red</Text><Text value="7">green</Text></Enumeration>
  <FunctionService>
    <Function name="PROGRAM" states="Operational">
      <Argument name="SERIAL" type="UINT64" minimum="0" maximum="18446744073709551615"/>
      <Argument name="OFFSET" type="INT64" minimum="-9223372036854775808" maximum="9223372036854775807"/>
      <Argument name="COLOUR" type="INT16" enumeration="COLOURS"/>
      <Argument name="NOTE" type="TEXT" octets="8" default="-"/>
      <Argument name="STEPS" type="INT32" count="3" minimum="-5" maximum="5"/>
      <Argument name="RATES" type="FLOAT" count="2" minimum="0" maximum="1" default="0.5"/>
      <Argument name="ON" type="BOOL" default="1"/>
    </Function>
  </FunctionService>
  <Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";

enum class Colour : std::int16_t { Red = -1, Green = 7 };

struct Programmable final : Subsystem {
  struct Seen {
    std::uint64_t serial{0};
    std::int64_t offset{0};
    Colour colour{};
    std::string note;
    std::array<std::int32_t, 3> steps{};
    Sized<double, 4> rates;
    bool on{false};
  };
  std::optional<Seen> seen;

  Result<Step> software_init() override {
    on_function("PROGRAM",
                [this](std::uint64_t serial, std::int64_t offset, Colour colour, std::string_view note,
                       const std::array<std::int32_t, 3>& steps, const Sized<double, 4>& rates, bool on) -> Result<> {
                  seen = {serial, offset, colour, std::string{note}, steps, rates, on};
                  return ok();
                });
    return done;
  }
};

struct TypedFunction : ::testing::Test {
  TypedFunction() { rig.bring_to(State::Operational); }
  std::string program(const std::vector<std::optional<Value>>& values) {
    const auto data = pus::encode_call(*rig.descriptor().find_function("PROGRAM"), values);
    if (!data) return data.error().text;
    const auto sent = rig.send(8, 1, *data);
    rig.settle();
    return rig.outcome(sent);
  }
  Programmable author;
  Rig rig{author, programmable};
};

TEST_F(TypedFunction, BringsEveryValueToItsHandlerAsItWasSent) {
  ASSERT_EQ(program({UINT64_MAX, INT64_MIN, -1, "\u20ac 12", -5, 0, 5, 0.25, 1.0, false}), "1 3 7");
  ASSERT_TRUE(author.seen);
  EXPECT_EQ(author.seen->serial, UINT64_MAX);
  EXPECT_EQ(author.seen->offset, INT64_MIN);
  EXPECT_EQ(author.seen->colour, Colour::Red);
  EXPECT_EQ(author.seen->note, "\u20ac 12");
  EXPECT_EQ(author.seen->steps, (std::array<std::int32_t, 3>{-5, 0, 5}));
  EXPECT_EQ(author.seen->rates, (Sized<double, 4>{0.25, 1.0}));
  EXPECT_FALSE(author.seen->on);
}

TEST_F(TypedFunction, BringsTheDeclaredValueOfWhatWasLeftOut) {
  const auto data =
      testing::hex(*pus::encode_call(*rig.descriptor().find_function("PROGRAM"),
                                     std::vector<std::optional<Value>>{9007199254740993, INT64_MAX, 7, "", 1, 2, 3}));
  ASSERT_EQ(program({9007199254740993, INT64_MAX, 7, {}, 1, 2, 3}), "1 3 7") << data;
  EXPECT_EQ(author.seen->serial, 9007199254740993U);
  EXPECT_EQ(author.seen->offset, INT64_MAX);
  EXPECT_EQ(author.seen->note, "-");
  EXPECT_EQ(author.seen->rates, (Sized<double, 4>{0.5, 0.5}));
  EXPECT_TRUE(author.seen->on);
}

TEST_F(TypedFunction, IsNotCalledWithWhatItsDescriptorDoesNotPermit) {
  auto data = *pus::encode_call(*rig.descriptor().find_function("PROGRAM"),
                                std::vector<std::optional<Value>>{1, 1, 7, "abc", 1, 2, 3});
  const auto note = std::ranges::search(data, std::as_bytes(std::span{"abc", 3}));
  ASSERT_FALSE(note.empty());
  note.front() = std::byte{0xFF};
  const auto sent = rig.send(8, 1, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 4:01050300000004") << "the fourth argument";
  EXPECT_FALSE(author.seen);
}

/// One function whose argument is declared as `argument` says, with the enumeration that this may name.
std::string function_with(const std::string& argument) {
  const std::string colours =
      R"(<Enumeration name="COLOURS"><Text value="-1">red</Text><Text value="300">green</Text></Enumeration>)";
  return R"(<Subsystem name="S" id="10">)" + (argument.contains("COLOURS") ? colours : "") +
         R"(<FunctionService><Function name="F"><Argument name="A" )" + argument +
         R"(/></Function></FunctionService><Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";
}

template <class T>
struct TakesOne final : Subsystem {
  Result<Step> software_init() override {
    on_function("F", [](const T&) -> Result<> { return ok(); });
    return done;
  }
};

/// Empty, or what is told of a handler that takes a T.
template <class T>
std::string told_of(const std::string& argument) {
  TakesOne<T> author;
  Rig rig{author, function_with(argument)};
  rig.set_state_now(State::PreOperational);
  return rig.explanations.empty() ? "" : rig.explanations.front();
}

TEST(TypedHandlers, HoldWhatTheDescriptorPermitsOrAreToldWhatItSays) {
  const std::string whole = R"(type="UINT64" minimum="0" maximum="18446744073709551615")",
                    exact = R"(type="UINT64" minimum="0" maximum="9007199254740992")",
                    beyond = R"(type="UINT64" minimum="0" maximum="9007199254740993")",
                    half = R"(type="UINT64" minimum="0" maximum="9223372036854775807")",
                    low = R"(type="INT64" minimum="-9223372036854775808" maximum="0")",
                    three = R"(type="FLOAT" count="3" minimum="0" maximum="1")",
                    colour = R"(type="INT16" enumeration="COLOURS")", flag = R"(type="BOOL")",
                    flags = R"(type="BOOL" count="2")", text = R"(type="TEXT" octets="9")";
  EXPECT_EQ(told_of<std::uint64_t>(whole), "");
  EXPECT_EQ(told_of<std::int64_t>(half), "");
  EXPECT_EQ(told_of<double>(exact), "");
  EXPECT_EQ(told_of<std::int64_t>(low), "");
  EXPECT_EQ((told_of<std::array<float, 3>>(three)), "");
  EXPECT_EQ((told_of<Sized<double, 3>>(three)), "");
  EXPECT_EQ(told_of<Colour>(colour), "");
  EXPECT_EQ(told_of<bool>(flag), "");
  EXPECT_EQ(told_of<std::uint8_t>(flag), "");
  EXPECT_EQ((told_of<std::array<bool, 2>>(flags)), "");
  EXPECT_EQ(told_of<std::string_view>(text), "");
  EXPECT_EQ(told_of<FunctionValues>(three), "");

  EXPECT_EQ(told_of<std::int64_t>(whole),
            "S: SoftwareInit failed: on_function F: argument 1, A: the descriptor declares UINT64, "
            "0..18446744073709551615; the handler takes std::int64_t, which does not hold every value");
  EXPECT_THAT(told_of<double>(beyond), HasSubstr("the handler takes double, which does not hold"));
  EXPECT_THAT(told_of<std::uint64_t>(low), HasSubstr("does not hold"));
  EXPECT_THAT((told_of<std::array<float, 2>>(three)),
              HasSubstr("FLOAT[3], 3 of 0..1; the handler takes std::array<float, 2>"));
  EXPECT_THAT((told_of<Sized<double, 2>>(three)), HasSubstr("the handler takes Sized<double, 2>"));
  EXPECT_THAT(told_of<float>(three), HasSubstr("the handler takes float"));
  EXPECT_THAT(told_of<std::int8_t>(colour), HasSubstr("INT16, red|green; the handler takes std::int8_t"));
  EXPECT_THAT(told_of<bool>(colour), HasSubstr("the handler takes bool"));
  EXPECT_THAT(told_of<std::string_view>(three), HasSubstr("the handler takes std::string_view"));
  EXPECT_THAT(told_of<double>(text), HasSubstr("TEXT of 9 octets, text of at most 9 octets; the handler takes double"));
  EXPECT_THAT(told_of<FunctionValues>(text), HasSubstr("the handler takes FunctionValues, double"));
  EXPECT_THAT(told_of<FunctionValues>(whole), HasSubstr("the handler takes FunctionValues, double"));
}

}  // namespace
}  // namespace hirosco
