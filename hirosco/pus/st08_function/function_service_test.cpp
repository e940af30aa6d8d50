// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st08_function/function_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using descriptor::Function;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Function::Argument argument(const char* name, Type type, std::optional<double> fallback = {}, std::uint16_t count = 1) {
  Function::Argument made;
  made.field.name = name;
  made.field.type = type;
  made.field.count = count;
  made.fallback = fallback;
  return made;
}
Function function(const char* name, std::vector<Function::Argument> arguments) {
  Function made;
  made.name = name;
  made.arguments = std::move(arguments);
  return made;
}
Function gripper() {
  Function made = function("GRIPPER_OPEN", {argument("WIDTH", Type::Float), argument("SPEED", Type::Uint8, 5)});
  made.arguments[0].field.minimum = 0;
  made.arguments[0].field.maximum = 0.5;
  return made;
}

const std::string gripper_hex = "475249505045525f4f50454e00000000";   // GRIPPER_OPEN
constexpr const char* width = "013e800000";                           // argument 1 = 0.25
constexpr const char* speed = "0203";                                 // argument 2 = 3

struct Functions : ::testing::Test {
  std::vector<Function> functions{
      gripper(), function("HOLD", {}),
      function("SET", {argument("GAIN", Type::Double, {}, 2), argument("N", Type::Uint64, 1)})};
  std::vector<Value> values(const FunctionCall& call) const {
    return ArgumentReader{functions[call.function].arguments, call.arguments}.rest();
  }
  std::string failure(const std::string& hex) {
    const Bytes data = from_hex(hex);
    const auto call = decode_call(functions, data);
    if (call) return "good";
    const std::string stage = call.error().stage == Stage::Start ? "start " : "acceptance ";
    Bytes code(2);
    OctetWriter{code}.put(static_cast<std::uint16_t>(call.error().notice.code()));
    return stage + to_hex(code) + to_hex(call.error().notice.data());
  }
};

TEST_F(Functions, AreDecodedFromTheVector) {
  const auto vector = vector_of("st08", "ST08-A");
  const auto view = TelecommandView::parse(vector.octets);
  const auto call = decode_call(functions, view.value().application_data());
  ASSERT_TRUE(call.has_value());
  EXPECT_EQ(call->function, 0);
  EXPECT_EQ(values(*call), (std::vector<Value>{0.25, 3}));
  const std::vector<double> given{0.25, 3};
  EXPECT_EQ(to_hex(encode_call(functions[0], given).value()), vector.fields.at("app_data").get<std::string>());
}

TEST_F(Functions, TakeArgumentsInAnyOrderAndDeclaredValuesForAbsentOnes) {
  const auto turned = decode_call(functions, from_hex(gripper_hex + "02" + speed + width));
  EXPECT_EQ(values(turned.value()), (std::vector<Value>{0.25, 3}));
  const auto absent = decode_call(functions, from_hex(gripper_hex + "01" + width));
  EXPECT_EQ(values(absent.value()), (std::vector<Value>{0.25, 5}));
}

TEST_F(Functions, FailAtAcceptanceForAWrongLengthOnly) {
  const std::string whole = gripper_hex + "02" + width + speed;
  for (std::size_t octets = 0; octets < whole.size() / 2; ++octets)
    EXPECT_EQ(failure(whole.substr(0, 2 * octets)), "acceptance 0008") << octets;
  EXPECT_EQ(failure(whole + "00"), "acceptance 0008");
  EXPECT_EQ(failure(gripper_hex + "0101ffc00000" + "00"), "acceptance 0008") << "a wrong value does not hide it";
}

TEST_F(Functions, FailAtStartForAnUnknownName) {
  EXPECT_EQ(failure("4e4f4e45000000000000000000000000"
                    "00"),
            "start 0101004e4f4e45000000000000000000000000");
  EXPECT_EQ(failure("00000000000000000000000000000000"
                    "00"),
            "start 01010000000000000000000000000000000000");
  EXPECT_EQ(failure("484f4c44004100000000000000000000"
                    "00"),
            "start 010100484f4c44004100000000000000000000")
      << "HOLD and something behind the end";
}

TEST_F(Functions, FailAtStartForEachBadArgumentWithIndexAndId) {
  EXPECT_EQ(failure(gripper_hex + "0203" + "00" + width), "start 01050000000003") << "unknown";
  EXPECT_EQ(failure(gripper_hex + "01" + "0000"), "start 01050000000000") << "ids count from 1";
  EXPECT_EQ(failure(gripper_hex + "02" + width + width), "start 01050100000001") << "twice";
  EXPECT_EQ(failure(gripper_hex + "01" + speed), "start 01050100000001") << "missing";
  EXPECT_EQ(failure(gripper_hex + "00"), "start 01050000000001") << "missing";
  EXPECT_EQ(failure(gripper_hex + "01" + "013f400000"), "start 01050000000001") << "0.75 is above the maximum";
  EXPECT_EQ(failure(gripper_hex + "01" + "01bf800000"), "start 01050000000001") << "-1 is below the minimum";
  EXPECT_EQ(failure(gripper_hex + "01" + "017fc00000"), "start 01050000000001") << "not a number";
}

TEST_F(Functions, RefuseInfinityEvenWithoutARange) {
  const std::string set = "53455400000000000000000000000000";
  EXPECT_EQ(failure(set + "01" + "01" + "3ff0000000000000" + "4000000000000000"), "good");
  EXPECT_EQ(failure(set + "01" + "01" + "3ff0000000000000" + "7ff0000000000000"), "start 01050000000001");
}

TEST_F(Functions, TakeEveryIntegerOf64BitsAsItIs) {
  const std::string set =
      "53455400000000000000000000000000"
      "02"
      "01"
      "3ff0000000000000"
      "4000000000000000"
      "02";
  for (const auto& [hex, number] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"0020000000000001", 9007199254740993U}, {"ffffffffffffffff", UINT64_MAX}, {"0000000000000000", 0U}}) {
    const auto call = decode_call(functions, from_hex(set + hex));
    ASSERT_TRUE(call.has_value()) << hex;
    EXPECT_EQ(values(*call).back(), Value{Number{number}});
  }
}

TEST_F(Functions, WithMoreOctetsThanACallHoldsAreRefused) {
  functions = {function("WIDE", {argument("A", Type::Uint8, {}, 257)})};
  EXPECT_EQ(failure("57494445000000000000000000000000"
                    "00"),
            "start 010400");
}

TEST_F(Functions, OfEverySubsystemHaveIndexesOfTheirOwn) {
  const auto built_in = common_functions();
  const auto call = decode_call(functions,
                                from_hex("5345545f535441544500000000000000"
                                         "01"
                                         "0105"),
                                built_in);
  EXPECT_EQ(call.value().function, set_state_function);
  EXPECT_EQ(call.value().arguments[0], std::byte{5});
  const auto configure = decode_call(functions,
                                     from_hex("434f4e46494755524500000000000000"
                                              "01"
                                              "0107"),
                                     built_in);
  EXPECT_EQ(configure.value().function, configure_function);
  EXPECT_FALSE(decode_call(functions,
                           from_hex("5345545f535441544500000000000000"
                                    "01"
                                    "010a"),
                           built_in)
                   .has_value())
      << "there is no tenth state";
}

TEST_F(Functions, AreEncodedSoThatTheyAreDecodedAgain) {
  const std::vector<double> gains{1.5, -2.5};
  const auto data = encode_call(functions[2], gains);
  const auto call = decode_call(functions, data.value());
  EXPECT_EQ(call.value().function, 2);
  EXPECT_EQ(values(call.value()), (std::vector<Value>{1.5, -2.5, 1}));
}

TEST_F(Functions, AreEncodedFromNamedArguments) {
  const std::vector<std::pair<std::string_view, Value>> named{{"N", 9}, {"GAIN", 1}, {"GAIN", 2}};
  const auto call = decode_call(functions, encode_call(functions[2], named).value());
  EXPECT_EQ(values(call.value()), (std::vector<Value>{1, 2, 9}));
  const std::vector<std::pair<std::string_view, Value>> unknown{{"M", 9}};
  EXPECT_EQ(encode_call(functions[2], unknown).error().code, ErrorCode::NotFound);
  const std::vector<std::pair<std::string_view, Value>> thrice{{"GAIN", 1}, {"GAIN", 2}, {"GAIN", 3}};
  EXPECT_EQ(encode_call(functions[2], thrice).error().code, ErrorCode::InvalidArgument);
}

TEST_F(Functions, AreNotEncodedWithValuesThatWouldBeRefused) {
  const auto error = [this](std::vector<double> values) {
    const auto data = encode_call(functions[0], values);
    return data ? std::string_view{"good"} : to_text(data.error().code);
  };
  EXPECT_EQ(error({0.25}), "good");
  EXPECT_EQ(error({}), "invalid argument");
  EXPECT_EQ(error({0.25, 1, 1}), "invalid argument");
  EXPECT_EQ(error({0.75}), "out of range");
  EXPECT_EQ(error({0.25, 256}), "out of range");
  EXPECT_EQ(error({0.25, 1.5}), "invalid argument");
  EXPECT_EQ(error({std::numeric_limits<double>::quiet_NaN()}), "invalid argument");
}

struct CallTaker final : FunctionExecutor {
  std::expected<void, FailureNotice> submit(const FunctionCall& call, const Request&) override {
    if (full) return std::unexpected{FailureNotice{FailureCode::Busy}};
    calls.push_back(call);
    return {};
  }
  bool full{false};
  std::vector<FunctionCall> calls;
};

struct FunctionRequests : Functions {
  RecordingSink sink;
  Verification verification{sink};
  CallTaker executor;
  FunctionService service{functions, common_functions(), executor, verification};
};

TEST_F(FunctionRequests, AreAcceptedAndSubmittedAndTheRestIsLeftToTheOwner) {
  handle(service, vector_of("st08", "ST08-A").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac074"));
  ASSERT_EQ(executor.calls.size(), 1U);
  EXPECT_EQ(values(executor.calls[0]).front(), Value{0.25});
}

TEST_F(FunctionRequests, ThatTheExecutorRefusesFailToStart) {
  executor.full = true;
  send(service, 1,
       "484f4c44000000000000000000000000"
       "00");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac0010108"));
}

TEST_F(FunctionRequests, ThatAreBadNeverReachTheExecutor) {
  send(service, 1, "484f4c44000000000000000000000000");
  send(service, 1,
       "484f4c45000000000000000000000000"
       "00");
  send(service, 2, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0010008", "1.1 180ac001",
                                       "1.4 180ac001010100484f4c45000000000000000000000000", "1.2 180ac00100070802"));
  EXPECT_THAT(executor.calls, IsEmpty());
}

}  // namespace
}  // namespace hirosco::pus
