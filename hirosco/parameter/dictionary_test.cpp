// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/dictionary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace hirosco {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct MovedValues {
  std::int32_t moving;
  std::array<double, 2> position;
  float temperature;
};

ParameterSpec current_values() {
  return {"CUR_VALUES",
          {10, Type::Struct, 0},
          {{"MOVING", Type::Int32, 1}, {"POSITION", Type::Double, 2}, {"TEMPERATURE", Type::Float, 1}},
          true,
          {1, 0.5, -0.5, 20}};
}
ParameterSpec goal() { return {"DES_POSITION", {10, Type::Double, 0}, {{"DES_POSITION", Type::Double, 2}}, false, {}}; }
ParameterSpec limit() { return {"LIMIT", {10, Type::Uint8, 0}, {{"LIMIT", Type::Uint8, 1}}, false, {255}}; }

Dictionary made(std::vector<ParameterSpec> specs) {
  auto dictionary = Dictionary::make(specs);
  EXPECT_TRUE(dictionary.has_value()) << dictionary.error();
  return std::move(*dictionary);
}
std::string refusal(std::vector<ParameterSpec> specs) {
  const auto dictionary = Dictionary::make(specs);
  return dictionary.has_value() ? "accepted" : dictionary.error();
}
template <class T>
std::string publish_error(const ParameterSpec& spec) {
  Dictionary dictionary = made({spec});
  Parameter<T> parameter;
  const auto published = dictionary.publish(spec.name, parameter);
  return published.has_value() ? "accepted" : published.error();
}

TEST(Dictionary, RejectsASecondParameterOfTheSameName) {
  ParameterSpec other = limit();
  other.name = "DES_POSITION";
  EXPECT_THAT(refusal({goal(), other}), AllOf(HasSubstr("DES_POSITION"), HasSubstr("second")));
}

TEST(Dictionary, RejectsASecondParameterOfTheSameLayoutAndId) {
  ParameterSpec other = goal();
  other.name = "OTHER";
  EXPECT_THAT(refusal({goal(), other}), AllOf(HasSubstr("OTHER"), HasSubstr("DES_POSITION")));
}

struct PartGains {
  double p;
  double d;
};
struct PartLaw {
  std::uint8_t mode;
  PartGains gains;
  std::array<PartGains, 2> joints;
};
ParameterSpec controller() {
  return {"CONTROLLER",
          {10, Type::Struct, 1},
          {{"MODE", Type::Uint8, 1, 1},
           {"GAINS.P", Type::Double, 1, 1},
           {"GAINS.D", Type::Double, 1, 2},
           {"JOINTS[0].P", Type::Double, 1, 3},
           {"JOINTS[0].D", Type::Double, 1, 4},
           {"JOINTS[1].P", Type::Double, 1, 5},
           {"JOINTS[1].D", Type::Double, 1, 6}},
          true,
          {1, 2, 3, 4, 5, 6, 7},
          {{"GAINS", 1, 2, 2}, {"JOINTS[0]", 3, 2, 3}, {"JOINTS[1]", 5, 2, 4}}};
}

TEST(Dictionary, KnowsAStructureWithinByNameAndById) {
  const Dictionary dictionary = made({controller()});
  EXPECT_EQ(dictionary.find("CONTROLLER.GAINS"), (ParameterPlace{0, 7}));
  EXPECT_EQ(dictionary.find("GAINS"), (ParameterPlace{0, 7}));
  EXPECT_EQ(dictionary.find("CONTROLLER.JOINTS[1].D"), (ParameterPlace{0, 6}));
  EXPECT_EQ(dictionary.find("CONTROLLER.JOINTS"), std::nullopt);
  EXPECT_EQ(dictionary.place_of(ParameterId{10, Type::Struct, 4}.wire()), (ParameterPlace{0, 9}));
  EXPECT_EQ(dictionary.wire_octets(0, 9), 16u);
  EXPECT_EQ(dictionary.wire_octets(0, 10), 0u) << "there is no fourth";
  ParameterSpec twice = controller();
  twice.parts[1].id = 2;
  EXPECT_THAT(refusal({twice}), AllOf(HasSubstr("CONTROLLER.JOINTS[0]"), HasSubstr("layout and id")));
  twice = controller();
  twice.parts[2].count = 3;
  EXPECT_THAT(refusal({twice}), HasSubstr("JOINTS[1]"));
}

TEST(Dictionary, SetsAndTellsAStructureWithinAndNothingBesideIt) {
  Dictionary dictionary = made({controller()});
  Parameter<PartLaw> parameter;
  ASSERT_TRUE(dictionary.publish("CONTROLLER", parameter).has_value());
  ASSERT_TRUE(dictionary.initialise());
  std::array<std::byte, 16> told{};
  ASSERT_EQ(dictionary.encode(0, 8, told), told.size());
  OctetReader reader{told};
  EXPECT_EQ(reader.get<double>(), 4);
  EXPECT_EQ(reader.get<double>(), 5);
  std::array<std::byte, 16> wanted;
  OctetWriter{wanted}.put(-4.0).put(-5.0);
  ASSERT_TRUE(dictionary.decode_into(0, 8, wanted));
  const PartLaw now = parameter.load();
  EXPECT_EQ(now.gains.p, 2);
  EXPECT_EQ(now.joints[0].p, -4);
  EXPECT_EQ(now.joints[0].d, -5);
  EXPECT_EQ(now.joints[1].p, 6);
  EXPECT_EQ(dictionary.accepts(0, 8, Octets{wanted}.first(15)).error().code, ErrorCode::Malformed);
  EXPECT_EQ(dictionary.accepts(0, 10, {}).error().code, ErrorCode::NotFound);
}

TEST(Dictionary, KnowsAMemberByTheIdThatItHas) {
  ParameterSpec spec = current_values();
  spec.fields[1].id = 7;
  const Dictionary dictionary = made({spec, goal()});
  EXPECT_EQ(dictionary.place_of(0x000A'0A07u), (ParameterPlace{0, 1}));
  EXPECT_EQ(dictionary.place_of(0x000A'0A00u), (ParameterPlace{1, -1}));
  spec.fields[1].id = 0;
  EXPECT_THAT(refusal({goal(), spec}), AllOf(HasSubstr("CUR_VALUES.POSITION"), HasSubstr("DES_POSITION")));
}

TEST(Dictionary, AcceptsOneIdInThreeLayoutsAsInListing1) {
  EXPECT_EQ(made({current_values(), goal(), limit()}).size(), 3u);
}

TEST(Dictionary, RejectsDeclarationsWithoutMeaning) {
  ParameterSpec spec = goal();
  spec.fields[0].count = 0;
  EXPECT_THAT(refusal({spec}), HasSubstr("count"));
  spec = goal();
  spec.fields.clear();
  EXPECT_THAT(refusal({spec}), HasSubstr("no fields"));
  spec = goal();
  spec.id.layout = Type::Float;
  EXPECT_THAT(refusal({spec}), HasSubstr("layout"));
  spec = goal();
  spec.init = {1.0, 2.0, 3.0};
  EXPECT_THAT(refusal({spec}), HasSubstr("3 initial values for 2"));
  spec = goal();
  spec.name.clear();
  EXPECT_THAT(refusal({spec}), HasSubstr("name"));
  spec = current_values();
  spec.fields[1].name = "MOVING";
  EXPECT_THAT(refusal({spec}), AllOf(HasSubstr("CUR_VALUES.MOVING"), HasSubstr("two members")));
  spec = current_values();
  spec.fields[1].type = Type::Struct;
  EXPECT_THAT(refusal({spec}), HasSubstr("CUR_VALUES.POSITION"));
  spec = goal();
  spec.fields.push_back(spec.fields[0]);
  EXPECT_THAT(refusal({spec}), HasSubstr("one field"));
}

TEST(Dictionary, BeginsWithWhatItIsGivenAndWithNothingOfAnotherNumber) {
  Dictionary dictionary = made({goal()});
  Parameter<std::array<double, 2>> value;
  ASSERT_TRUE(dictionary.publish("DES_POSITION", value));
  dictionary.begin_with(0, {4.0, 5.0});
  dictionary.begin_with(0, {6.0});
  dictionary.begin_with(7, {6.0, 7.0});
  ASSERT_TRUE(dictionary.initialise());
  EXPECT_EQ(value.load(), (std::array{4.0, 5.0}));
}

TEST(Dictionary, PublishesWhatHasTheDeclaredLayout) {
  EXPECT_EQ(publish_error<MovedValues>(current_values()), "accepted");
  EXPECT_EQ((publish_error<std::array<double, 2>>(goal())), "accepted");
  EXPECT_EQ(publish_error<std::uint8_t>(limit()), "accepted");
}

TEST(Dictionary, NamesParameterMemberAndBothTypesOfAMismatch) {
  struct Narrow {
    std::int32_t moving;
    std::array<float, 2> position;
    float temperature;
  };
  EXPECT_EQ(publish_error<Narrow>(current_values()),
            "CUR_VALUES.POSITION (member 2): the C++ type is std::array<float, 2>, the descriptor declares DOUBLE[2]");
  EXPECT_EQ(publish_error<double>(goal()), "DES_POSITION: the C++ type is double, the descriptor declares DOUBLE[2]");
  EXPECT_EQ(publish_error<std::int8_t>(limit()), "LIMIT: the C++ type is std::int8_t, the descriptor declares UINT8");
}

TEST(Dictionary, NamesAMissingAndASurplusMember) {
  struct Short {
    std::int32_t moving;
    std::array<double, 2> position;
  };
  struct Long {
    std::int32_t moving;
    std::array<double, 2> position;
    float temperature;
    float humidity;
  };
  EXPECT_EQ(publish_error<Short>(current_values()),
            "CUR_VALUES: the C++ structure has 2 members, the descriptor declares 3; C++ lacks TEMPERATURE FLOAT");
  EXPECT_EQ(publish_error<Long>(current_values()),
            "CUR_VALUES: the C++ structure has 4 members, the descriptor declares 3; "
            "not declared is the C++ member 4 (float)");
}

TEST(Dictionary, TellsAStructureFromASingleValue) {
  struct One {
    double value;
  };
  ParameterSpec spec = goal();
  spec.fields[0].count = 1;
  EXPECT_EQ(publish_error<One>(spec), "DES_POSITION: the C++ type is a structure, the descriptor declares DOUBLE");
  EXPECT_EQ(publish_error<double>(current_values()),
            "CUR_VALUES: the C++ type is double, the descriptor declares STRUCT");
}

TEST(Dictionary, RefusesToPublishAnUnknownNameOrTheSameTwice) {
  Dictionary dictionary = made({limit()});
  Parameter<std::uint8_t> first;
  Parameter<std::uint8_t> second;
  EXPECT_THAT(dictionary.publish("LIMITS", first).error(), HasSubstr("LIMITS"));
  ASSERT_TRUE(dictionary.publish("LIMIT", first));
  EXPECT_THAT(dictionary.publish("LIMIT", second).error(), AllOf(HasSubstr("LIMIT"), HasSubstr("twice")));
  EXPECT_EQ(dictionary.cell(0), &first);
}

TEST(Dictionary, NamesWhatIsNotYetPublished) {
  Dictionary dictionary = made({current_values(), goal(), limit()});
  Parameter<std::array<double, 2>> parameter;
  ASSERT_TRUE(dictionary.publish("DES_POSITION", parameter));
  std::string missing;
  EXPECT_FALSE(dictionary.all_published(missing));
  EXPECT_EQ(missing, "CUR_VALUES, LIMIT");
}

class PublishedDictionary : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(dictionary_.publish("CUR_VALUES", current_));
    ASSERT_TRUE(dictionary_.publish("DES_POSITION", goal_));
    ASSERT_TRUE(dictionary_.publish("LIMIT", limit_));
  }
  Dictionary dictionary_ = made({current_values(), goal(), limit()});
  Parameter<MovedValues> current_;
  Parameter<std::array<double, 2>> goal_{{9.0, 9.0}};
  Parameter<std::uint8_t> limit_;
};

TEST_F(PublishedDictionary, FindsByNameWireIdAndMember) {
  std::string missing;
  EXPECT_TRUE(dictionary_.all_published(missing));
  EXPECT_EQ(dictionary_.index_of("LIMIT"), 2);
  EXPECT_EQ(dictionary_.place_of(0x000A'0A00u), (ParameterPlace{1, -1}));  // subsystem 10, DOUBLE, id 0
  EXPECT_EQ(dictionary_.place_of(0x000A'0A01u), std::nullopt);
  EXPECT_EQ(dictionary_.find("CUR_VALUES.POSITION"), (ParameterPlace{0, 1}));
  EXPECT_EQ(dictionary_.find("TEMPERATURE"), (ParameterPlace{0, 2}));
  EXPECT_EQ(dictionary_.find("LIMIT"), (ParameterPlace{2, -1}));
  EXPECT_EQ(dictionary_.find("LIMIT.LIMIT"), std::nullopt);
  EXPECT_EQ(dictionary_.find("CUR_VALUES."), std::nullopt);
}

TEST(Dictionary, DoesNotGuessAnAmbiguousMember) {
  ParameterSpec other = current_values();
  other.name = "LAST_VALUES";
  other.id.id = 1;
  const Dictionary dictionary = made({current_values(), other});
  EXPECT_EQ(dictionary.find("POSITION"), std::nullopt);
  EXPECT_EQ(dictionary.find("LAST_VALUES.POSITION"), (ParameterPlace{1, 1}));
}

TEST_F(PublishedDictionary, InitialisesFromTheDeclarationAndElseToZero) {
  ASSERT_TRUE(dictionary_.initialise());
  EXPECT_EQ(current_.load().moving, 1);
  EXPECT_EQ(current_.load().position, (std::array{0.5, -0.5}));
  EXPECT_EQ(current_.load().temperature, 20.0f);
  EXPECT_EQ(goal_.load(), (std::array{0.0, 0.0}));
  EXPECT_EQ(limit_.load(), 255);
  std::uint8_t seen = 0;
  ASSERT_TRUE(limit_.snapshot(seen));
  EXPECT_EQ(seen, 255);
}

TEST_F(PublishedDictionary, EncodesWholeParametersAndMembersAlike) {
  ASSERT_TRUE(dictionary_.initialise());
  std::array<std::byte, 24> live{};
  std::array<std::byte, 24> snapshot{};
  EXPECT_EQ(dictionary_.wire_octets(0), 24u);
  EXPECT_EQ(dictionary_.encode(0, -1, live), 24u);
  EXPECT_EQ(dictionary_.snapshot_encode(0, -1, snapshot), 24u);
  EXPECT_EQ(live, snapshot);
  OctetReader reader{live};
  EXPECT_EQ(reader.get<std::int32_t>(), 1);
  EXPECT_EQ(reader.get<double>(), 0.5);
  EXPECT_EQ(reader.get<double>(), -0.5);
  EXPECT_EQ(reader.get<float>(), 20.0f);

  std::array<std::byte, 16> member{};
  EXPECT_EQ(dictionary_.wire_octets(0, 1), 16u);
  EXPECT_EQ(dictionary_.encode(0, 1, member), 16u);
  EXPECT_TRUE(std::ranges::equal(member, std::span{live}.subspan(4, 16)));
  EXPECT_EQ(dictionary_.encode(0, 1, MutableOctets{member}.first(15)), 0u);
}

TEST_F(PublishedDictionary, DecodesAMemberAndLeavesTheOthers) {
  ASSERT_TRUE(dictionary_.initialise());
  std::array<std::byte, 16> octets{};
  OctetWriter{octets}.put(7.0).put(8.0);
  ASSERT_TRUE(dictionary_.decode_into(0, 1, octets));
  EXPECT_EQ(current_.load().position, (std::array{7.0, 8.0}));
  EXPECT_EQ(current_.load().moving, 1);
  MovedValues seen{};
  ASSERT_TRUE(current_.snapshot(seen));
  EXPECT_EQ(seen.position[1], 8.0);
}

TEST_F(PublishedDictionary, RefusesPlacesThatDoNotExistAndWrongLengths) {
  std::array<std::byte, 32> octets{};
  EXPECT_EQ(dictionary_.decode_into(3, -1, octets).error().code, ErrorCode::NotFound);
  EXPECT_EQ(dictionary_.decode_into(0, 3, octets).error().code, ErrorCode::NotFound);
  EXPECT_EQ(dictionary_.decode_into(1, -1, Octets{octets}.first(15)).error().code, ErrorCode::Malformed);
  EXPECT_EQ(dictionary_.decode_into(1, -1, Octets{octets}.first(17)).error().code, ErrorCode::Malformed);
  EXPECT_EQ(dictionary_.encode(3, -1, octets), 0u);
  EXPECT_EQ(dictionary_.encode(0, 3, octets), 0u);
  EXPECT_EQ(dictionary_.wire_octets(3), 0u);
  EXPECT_EQ(dictionary_.wire_octets(0, 3), 0u);
  dictionary_.unpublish_all();
  EXPECT_EQ(dictionary_.decode_into(1, -1, Octets{octets}.first(16)).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(dictionary_.encode(1, -1, octets), 0u);
}

TEST_F(PublishedDictionary, SetsOnlyNumbersThatTheTypeHolds) {
  for (const double good : {0.0, 1.0, 255.0}) EXPECT_TRUE(dictionary_.set(2, -1, {{good}})) << good;
  limit_.store(42);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {-1.0, 256.0, 1.5, 1e300, nan, infinity, -infinity}) {
    const auto result = dictionary_.set(2, -1, {{bad}});
    ASSERT_FALSE(result) << bad;
    EXPECT_EQ(result.error().code, ErrorCode::OutOfRange);
  }
  EXPECT_EQ(limit_.load(), 42);
  EXPECT_EQ(dictionary_.set(2, -1, {{1.0, 2.0}}).error().code, ErrorCode::Malformed);
}

TEST_F(PublishedDictionary, ARefusedNumberChangesNothing) {
  ASSERT_TRUE(dictionary_.initialise());
  const auto result = dictionary_.set(0, -1, {{0.0, 3.0, 4.0, 1e39}});  // beyond float
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().value, 3);
  EXPECT_EQ(current_.load().position, (std::array{0.5, -0.5}));
}

TEST(Dictionary, HoldsTheEndsOf64BitIntegers) {
  Dictionary dictionary = made({{"S", {1, Type::Int64, 0}, {{"S", Type::Int64, 1}}, false, {}},
                                {"U", {1, Type::Uint64, 0}, {{"U", Type::Uint64, 1}}, false, {}}});
  Parameter<std::int64_t> s;
  Parameter<std::uint64_t> u;
  ASSERT_TRUE(dictionary.publish("S", s) && dictionary.publish("U", u));
  EXPECT_TRUE(dictionary.set(0, -1, {{-0x1p63}}));
  EXPECT_EQ(s.load(), std::numeric_limits<std::int64_t>::min());
  EXPECT_FALSE(dictionary.set(0, -1, {{0x1p63}}));
  EXPECT_FALSE(dictionary.set(1, -1, {{0x1p64}}));
  EXPECT_TRUE(dictionary.set(1, -1, {{0x1p63}}));
  EXPECT_EQ(u.load(), std::uint64_t{1} << 63);
}

}  // namespace
}  // namespace hirosco
