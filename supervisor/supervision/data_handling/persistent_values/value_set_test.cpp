// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/value_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

[[nodiscard]] descriptor::Parameter persistent_parameter(std::string name, std::uint8_t id, Number lowest,
                                                         Number highest) {
  descriptor::Parameter made;
  made.field.name = std::move(name);
  made.field.type = Type::Uint16;
  made.field.minimum = lowest;
  made.field.maximum = highest;
  made.id = id;
  made.init = {Number{1}};
  made.persistent = true;
  return made;
}

/// LIMIT from 0 to 10, GAIN from 0 to 100, and NOISE, which is not persistent. The mission says NOISE=4 and LIMIT=3.
[[nodiscard]] descriptor::MissionSubsystem declared_arm() {
  descriptor::MissionSubsystem made;
  made.subsystem.name = "ARM";
  made.subsystem.id = 10;
  made.subsystem.parameters = {persistent_parameter("LIMIT", 1, 0, 10), persistent_parameter("GAIN", 2, 0, 100),
                               persistent_parameter("NOISE", 3, 0, 10)};
  made.subsystem.parameters[2].persistent = false;
  made.overrides = {{"NOISE", {Number{4}}}, {"LIMIT", {Number{3}}}};
  made.subsystem.parameters[0].init = {Number{3}};
  return made;
}

[[nodiscard]] std::uint32_t id_in_arm(std::uint8_t id) { return ParameterId{10, Type::Uint16, id}.wire(); }
const std::uint32_t limit_id = id_in_arm(1), gain_id = id_in_arm(2), noise_id = id_in_arm(3);

[[nodiscard]] std::vector<std::byte> two_octets(std::uint16_t number) {
  std::vector<std::byte> octets(2);
  OctetWriter{octets}.put(number);
  return octets;
}
[[nodiscard]] ValueCopy whole_copy(const ValueSet& set) { return {set.layout(), 1, {}, set.octets()}; }
[[nodiscard]] std::vector<std::string> begins_with(const ValueSet& set) {
  auto member = declared_arm();
  set.begin(member);
  std::vector<std::string> texts;
  for (const auto& each : member.overrides) texts.push_back(to_string(each));
  return texts;
}

TEST(ValueSet, IsWantedByWhoHasAPersistentParameterOnly) {
  EXPECT_TRUE(ValueSet{declared_arm()}.wanted());
  EXPECT_FALSE(ValueSet{descriptor::MissionSubsystem{}}.wanted());
}

TEST(ValueSet, TakesWhatATelecommandCouldSetOfAPersistentParameter) {
  ValueSet set{declared_arm()};
  EXPECT_TRUE(set.set(limit_id, two_octets(10)));
  EXPECT_FALSE(set.set(limit_id, two_octets(10))) << "nothing new";
  EXPECT_FALSE(set.set(limit_id, two_octets(11)));
  EXPECT_FALSE(set.set(noise_id, two_octets(1)));
  EXPECT_FALSE(set.set(gain_id, std::vector<std::byte>(3)));
  EXPECT_EQ(set.size(), 1U);
}

TEST(ValueSet, GoesByTheRangesAndInitialValuesOfADescriptorThatIsReadAgain) {
  ValueSet set{declared_arm()};
  set.set(gain_id, two_octets(99));
  const std::uint64_t layout = set.layout();
  auto declared = declared_arm().subsystem;
  declared.parameters[0].field.maximum = Number{20};
  declared.parameters[0].init = {Number{5}};
  set.redeclare(declared);
  EXPECT_TRUE(set.set(limit_id, two_octets(11)));
  EXPECT_EQ(set.layout(), layout) << "its copies stay whole";
  set.forget(limit_id);
  auto member = declared_arm();
  set.begin(member);
  EXPECT_EQ(member.subsystem.parameters[0].init, (std::vector<Value>{Number{5}}));
  EXPECT_EQ(member.subsystem.parameters[1].init, (std::vector<Value>{Number{99}}));
}

TEST(ValueSet, ForgetsWhatARangeThatHoldsAgainDoesNotHold) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  auto declared = declared_arm().subsystem;
  EXPECT_THAT(set.redeclare(declared), ::testing::IsEmpty());
  declared.parameters[1].field.maximum = Number{98};
  EXPECT_THAT(set.redeclare(declared), ElementsAre("GAIN"));
  EXPECT_EQ(set.size(), 1U);
  EXPECT_THAT(set.redeclare(declared), ::testing::IsEmpty());
}

TEST(ValueSet, SaysHowADescriptorWasBeforeAnythingWasSet) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  auto member = declared_arm();
  set.begin(member);
  set.undo(member.subsystem);
  EXPECT_EQ(member.subsystem.parameters[0].init, (std::vector<Value>{Number{3}}));
  EXPECT_EQ(member.subsystem.parameters[1].init, (std::vector<Value>{Number{1}}));
}

TEST(ValueSet, GoesThroughACopy) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  ValueSet later{declared_arm()};
  ASSERT_TRUE(later.take(whole_copy(set)));
  EXPECT_EQ(later.octets(), set.octets());
}

TEST(ValueSet, BeginsWithWhatWasSetInsteadOfWhatTheMissionSays) {
  ValueSet set{declared_arm()};
  EXPECT_THAT(begins_with(set), ElementsAre("NOISE=4", "LIMIT=3"));
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  EXPECT_THAT(begins_with(set), ElementsAre("NOISE=4", "LIMIT=7", "GAIN=99"));
  auto member = declared_arm();
  set.begin(member);
  EXPECT_EQ(member.subsystem.parameters[0].init, (std::vector<Value>{Number{7}}));
  set.forget(limit_id);
  set.forget(gain_id);
  set.begin(member);
  EXPECT_EQ(member.subsystem.parameters[0].init, (std::vector<Value>{Number{3}}));
  EXPECT_EQ(member.subsystem.parameters[1].init, (std::vector<Value>{Number{1}}));
  EXPECT_THAT(begins_with(set), ElementsAre("NOISE=4", "LIMIT=3"));
}

TEST(ValueSet, OfAnotherLayoutIsNotTaken) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  const auto changed = [](auto edit) {
    auto member = declared_arm();
    edit(member.subsystem.parameters[0]);
    return member;
  };
  using descriptor::Parameter;
  for (const auto& member :
       {changed([](Parameter& p) { p.field.name = "BOUND"; }), changed([](Parameter& p) { p.id = 9; }),
        changed([](Parameter& p) { p.field.type = Type::Int16; }), changed([](Parameter& p) { p.field.count = 2; }),
        changed([](Parameter& p) { p.field.unit = "N"; }), changed([](Parameter& p) { p.persistent = false; })}) {
    ValueSet later{member};
    EXPECT_EQ(later.take(whole_copy(set)), std::unexpected{CopyFault::Layout});
    EXPECT_EQ(later.size(), 0U);
  }
  ValueSet with_another_default{changed([](Parameter& p) { p.init = {Number{2}}; })};
  EXPECT_TRUE(with_another_default.take(whole_copy(set)));
}

TEST(ValueSet, OneThatHasLeftItsRangeTakesTheOthersAlong) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  auto narrower = declared_arm();
  narrower.subsystem.parameters[1].field.maximum = Number{98};
  ValueSet later{narrower};
  EXPECT_EQ(later.take(whole_copy(set)), std::unexpected{CopyFault::Range});
  EXPECT_EQ(later.size(), 0U);
}

TEST(ValueSet, TakesNothingOfWhatItsOctetsDoNotSay) {
  ValueSet set{declared_arm()};
  set.set(limit_id, two_octets(7));
  set.set(gain_id, two_octets(99));
  const ValueCopy whole = whole_copy(set);
  for (std::size_t length = 0; length < whole.values.size(); ++length) {
    ValueCopy cut = whole;
    cut.values.resize(length);
    EXPECT_EQ(ValueSet{declared_arm()}.take(cut).has_value(), false) << length;
  }
  ValueCopy longer = whole;
  longer.values.push_back({});
  EXPECT_EQ(ValueSet{declared_arm()}.take(longer), std::unexpected{CopyFault::Damaged});
}

/// LIMITS{LOW, HIGH}, persistent.
[[nodiscard]] descriptor::MissionSubsystem with_a_structure() {
  descriptor::MissionSubsystem made;
  made.subsystem.id = 10;
  descriptor::Parameter limits = persistent_parameter("LIMITS", 5, 0, 0);
  limits.field.type = Type::Struct;
  limits.init.clear();
  for (const std::uint8_t id : {std::uint8_t{6}, std::uint8_t{7}}) {
    const auto single = persistent_parameter(id == 6 ? "LOW" : "HIGH", id, 0, 10);
    limits.members.push_back({single.field, id});
  }
  made.subsystem.parameters = {limits};
  made.overrides = {{"LIMITS.LOW", {Number{4}}}};
  return made;
}

TEST(ValueSet, KeepsAStructureWholeInPlaceOfAllThatIsInIt) {
  const auto declared = with_a_structure();
  const std::uint32_t id = ParameterId{10, Type::Struct, 5}.wire();
  ValueSet set{declared};
  ASSERT_TRUE(set.has(id));
  const std::array<std::byte, 4> good{std::byte{0}, std::byte{2}, std::byte{0}, std::byte{9}};
  const std::array<std::byte, 4> beyond{std::byte{0}, std::byte{2}, std::byte{0}, std::byte{11}};
  EXPECT_FALSE(set.set(id, beyond)) << "the second member has a range, too";
  EXPECT_FALSE(set.set(id, Octets{good}.first(2)));
  EXPECT_TRUE(set.set(id, good));
  auto member = declared;
  set.begin(member);
  ASSERT_EQ(member.overrides.size(), 1u);
  EXPECT_EQ(to_string(member.overrides[0]), "LIMITS=2 9");
  ValueSet other{declared};
  ASSERT_TRUE(other.take(whole_copy(set)).has_value());
  EXPECT_EQ(other.octets(), set.octets());
  auto renamed = declared;
  renamed.subsystem.parameters[0].members[1].field.name = "TOP";
  EXPECT_EQ(ValueSet{renamed}.take(whole_copy(set)).error(), CopyFault::Layout);
}

/// LABEL{OWNER, SHELF}, persistent: words of four octets and a number.
[[nodiscard]] descriptor::MissionSubsystem with_a_labelled_structure() {
  auto made = with_a_structure();
  descriptor::Parameter& label = made.subsystem.parameters[0];
  label.field.name = "LABEL";
  descriptor::Field& owner = label.members[0].field;
  owner.name = "OWNER";
  owner.type = Type::Text;
  owner.text_octets = 4;
  label.members[1].field.name = "SHELF";
  made.overrides = {{"LABEL.OWNER", {"eve"}}, {"OTHER", {Number{1}}}};
  return made;
}
[[nodiscard]] std::vector<std::byte> words_and_number(std::string_view words, std::uint16_t number) {
  std::vector<std::byte> octets(words.size() + 2);
  OctetWriter{octets}.put(std::as_bytes(std::span{words})).put(number);
  return octets;
}

TEST(ValueSet, KeepsAStructureWithWordsAndBeginsWithItMemberByMember) {
  using namespace std::string_view_literals;
  const auto declared = with_a_labelled_structure();
  const std::uint32_t id = ParameterId{10, Type::Struct, 5}.wire();
  ValueSet set{declared};
  EXPECT_FALSE(set.set(id, words_and_number("a\0b\0"sv, 2))) << "something behind its first zero";
  EXPECT_FALSE(set.set(id, words_and_number("\xC3\0\0\0"sv, 2))) << "half a character";
  EXPECT_FALSE(set.set(id, words_and_number("a b\0"sv, 11))) << "its neighbour has a range";
  ASSERT_TRUE(set.set(id, words_and_number("a b\0"sv, 2)));
  ValueSet later{declared};
  ASSERT_TRUE(later.take(whole_copy(set)));
  auto member = declared;
  later.begin(member);
  EXPECT_EQ(member.subsystem.parameters[0].init, (std::vector<Value>{"a b", Number{2}}));
  std::vector<std::string> told;
  for (const auto& each : member.overrides) told.push_back(to_string(each));
  EXPECT_THAT(told, ElementsAre("OTHER=1", "LABEL.OWNER=a b", "LABEL.SHELF=2"));
  auto longer = declared;
  longer.subsystem.parameters[0].members[0].field.text_octets = 5;
  EXPECT_EQ(ValueSet{longer}.take(whole_copy(set)).error(), CopyFault::Layout);
  // Words that no telecommand could have set are not taken from a copy either, its check sum notwithstanding.
  ValueCopy forged = whole_copy(set);
  forged.values[1 + 4 + 1] = std::byte{0};
  EXPECT_EQ(ValueSet{declared}.take(forged).error(), CopyFault::Range);
}

}  // namespace
}  // namespace hirosco::supervisor
