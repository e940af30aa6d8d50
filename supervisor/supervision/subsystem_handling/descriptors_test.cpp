// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/descriptors.hpp"

#include <gmock/gmock.h>

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"
#include "supervisor/supervision/testing/played_readings.hpp"

/// Descriptors that are read again: all who fly a file, and the supervisor with them, or nobody.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using enum descriptor::State;
using Came = Outcome::Kind;

/// ARM and HAND fly one file, CAMERA another.
struct DescriptorsTest : PartsTest {
  PlayedReadings readings;
  PlayedDesk desk;
  Descriptors descriptors{{craft, parts.own, desk, parts.under_way, parts.stored, &readings}};

  // ProcessLauncher
  std::string refused_place;  ///< that nobody is let in to
  std::vector<std::string> reach;  ///< what it was asked for, in order
  std::string let_in(std::uint32_t process, const descriptor::MissionSubsystem& fresh) override {
    reach.push_back("in " + std::to_string(process) + " " + *fresh.subsystem.text);
    return refused_place;
  }
  std::string keep_in(std::uint32_t process, const descriptor::MissionSubsystem& now) override {
    reach.push_back("go " + std::to_string(process) + " " + *now.subsystem.text);
    return {};
  }
  /// Of ARM and HAND.
  [[nodiscard]] std::vector<std::string> both(const std::string& word, const std::string& text) const {
    std::vector<std::string> made;
    for (const std::uint16_t apid : {arm, hand})
      made.push_back(word + " " + std::to_string(played.at(apid).process) + " " + text);
    return made;
  }

  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems) {
      member.subsystem.file = member.subsystem.id == camera ? "camera.xml" : "arm.xml";
      member.subsystem.text = std::make_shared<const std::string>("old");
      descriptor::Parameter gain;
      gain.field.name = "GAIN";
      gain.field.maximum = Number{10};
      gain.writable_states = in_states({PreOperational});
      member.subsystem.parameters = {gain};
    }
    start_all(Offline);
  }
  void watch() { descriptors.watch(clock.now()); }
  [[nodiscard]] Outcome reread(std::uint16_t apid = arm) { return descriptors.reread(apid, Call{}); }
  [[nodiscard]] DescriptorReading another(auto&& edit) const {
    DescriptorReading reading;
    reading.text = std::make_shared<const std::string>("new");
    reading.mission.value = craft.mission;
    for (auto& member : reading.mission.value->subsystems)
      if (member.subsystem.id != camera) edit(member.subsystem);
    return reading;
  }
  [[nodiscard]] DescriptorReading wider() const {
    return another([](descriptor::SubsystemDescriptor& subsystem) {
      subsystem.parameters[0].field.maximum = Number{20};
      subsystem.text = std::make_shared<const std::string>("new");
    });
  }
  /// The newest that is read is judged by the members.
  void is_read(DescriptorReading reading) {
    ASSERT_EQ(reread().kind, Came::Running);
    readings.next = std::move(reading);
    watch();
  }
  void answer(bool first, bool second = true, const std::string& why = "its reason") {
    desk.answer(first, why);
    desk.answer(second, why);
    watch();
  }
  [[nodiscard]] Number most(std::uint16_t apid) const {
    return *craft.mission.find_subsystem(apid)->subsystem.parameters[0].field.maximum;
  }
  /// Whether it reaches a member that a ground sends it to.
  [[nodiscard]] bool permits(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data) {
    static_cast<void>(texts(apid));
    const auto packet = telecommand(apid, service, subtype, data);
    parts.telecommands.take({.packet = packet, .origin = Origin::ground(0)});
    parts.telecommands.forward_durable();
    return !texts(apid).empty();
  }
  [[nodiscard]] std::string text_of(std::uint16_t apid) const {
    return *craft.mission.find_subsystem(apid)->subsystem.text;
  }
};

TEST_F(DescriptorsTest, AllWhoFlyAFileTakeItAndTheSupervisorWithThem) {
  is_read(wider());
  EXPECT_THAT(readings.asked, ElementsAre("arm.xml"));
  EXPECT_THAT(desk.sent, ElementsAre("10 TC[130,1] 0 ms", "11 TC[130,1] 0 ms"));
  EXPECT_EQ(most(arm), Number{10}) << "nobody has it yet";
  answer(true);
  EXPECT_THAT(desk.sent,
              ElementsAre("10 TC[130,1] 0 ms", "11 TC[130,1] 0 ms", "10 TC[130,2] 0 ms", "11 TC[130,2] 0 ms"));
  answer(true);
  EXPECT_EQ(most(arm), Number{20});
  EXPECT_EQ(most(hand), Number{20});
  EXPECT_EQ(most(camera), Number{10});
  EXPECT_EQ(text_of(arm), "new") << "who is started again begins with it";
  EXPECT_EQ(*craft.mission.texts.at("arm.xml"), "new");
  EXPECT_TRUE(was_told("ARM flies by arm.xml as it is now"));
  EXPECT_THAT(killed, IsEmpty());
}

TEST_F(DescriptorsTest, WhoIsDownIsNotAskedAndBeginsWithItNext) {
  craft.member(hand)->died();
  is_read(wider());
  EXPECT_THAT(desk.sent, ElementsAre("10 TC[130,1] 0 ms"));
  desk.answer(true);
  watch();
  desk.answer(true);
  watch();
  EXPECT_EQ(most(hand), Number{20});
}

TEST_F(DescriptorsTest, WhereNobodyRunsTheSupervisorAloneTakesIt) {
  craft.member(arm)->died();
  craft.member(hand)->died();
  is_read(wider());
  watch();
  watch();
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_EQ(most(arm), Number{20});
}

TEST_F(DescriptorsTest, OneThatRefusesKeepsAllFromIt) {
  is_read(wider());
  answer(true, false, "the value of GAIN is outside its new range");
  EXPECT_EQ(desk.sent.size(), 2U) << "nobody is told to take it";
  EXPECT_EQ(most(arm), Number{10});
  EXPECT_EQ(text_of(arm), "old");
  EXPECT_TRUE(was_told("HAND does not take it: the value of GAIN is outside its new range"));
  EXPECT_EQ(reread().kind, Came::Running) << "and a better one may be tried";
}

TEST_F(DescriptorsTest, WhoDoesNotSayThatItTookItIsEnded) {
  is_read(wider());
  answer(true);
  answer(true, false, "no answer");
  EXPECT_EQ(most(hand), Number{20});
  EXPECT_THAT(killed, ElementsAre(played[hand].process));
}

TEST_F(DescriptorsTest, WhoWasStartedMeanwhileWithTheTextBeforeIsEnded) {
  craft.member(hand)->died();
  is_read(wider());
  desk.answer(true);
  watch();
  ASSERT_TRUE(parts.processes.start(hand));
  desk.answer(true);
  watch();
  EXPECT_EQ(most(hand), Number{20});
  EXPECT_THAT(killed, ElementsAre(played[hand].process));
}

TEST_F(DescriptorsTest, WhereAllRefuseToTakeItNothingChanges) {
  is_read(wider());
  answer(true);
  answer(false, false);
  EXPECT_EQ(most(arm), Number{10});
  EXPECT_THAT(killed, IsEmpty());
}

TEST_F(DescriptorsTest, WhoIsAskedIsLetInBeforeAnybodyTakesItAndLeavesTheRestWhenItIsInForce) {
  is_read(wider());
  EXPECT_THAT(reach, IsEmpty()) << "not everybody has agreed";
  answer(true);
  EXPECT_EQ(reach, both("in", "new"));
  reach.clear();
  answer(true);
  EXPECT_EQ(reach, both("go", "new"));
}

TEST_F(DescriptorsTest, WhereOneIsNotLetInNobodyTakesItAndAllReachWhatTheyDid) {
  refused_place = "/dev/shm/hirosco/arm-b: another subsystem was let in there";
  is_read(wider());
  answer(true);
  EXPECT_EQ(desk.sent.size(), 2U) << "nobody is told to take it";
  EXPECT_EQ(text_of(arm), "old");
  EXPECT_TRUE(was_told("ARM cannot be let in to /dev/shm/hirosco/arm-b: another subsystem was let in there"));
  auto wanted = both("in", "new");
  for (const std::string& each : both("go", "old")) wanted.push_back(each);
  EXPECT_EQ(reach, wanted);
}

TEST_F(DescriptorsTest, WhereNobodyTakesItAllReachWhatTheyDid) {
  is_read(wider());
  answer(true);
  reach.clear();
  answer(false, false);
  EXPECT_EQ(reach, both("go", "old"));
}

TEST_F(DescriptorsTest, AreReadInOfflineAndPreOperationalOnly) {
  for (const State state : {SoftwareInit, HardwareInit, SafeOperational, Operational, ErrorOperational, PostOperational,
                            HardwareDeinit, SoftwareDeinit}) {
    set(hand, state);
    EXPECT_EQ(reread().kind, Came::Refused) << to_text(state) << ": HAND flies the file, too";
  }
  set(hand, PreOperational);
  EXPECT_EQ(reread().kind, Came::Running);
  EXPECT_EQ(reread(camera).kind, Came::Refused) << "one at a time";
  EXPECT_EQ(descriptors.reread(99, Call{}).kind, Came::Refused);
}

TEST_F(DescriptorsTest, WhoHasLeftMeanwhileIsNotAsked) {
  ASSERT_EQ(reread().kind, Came::Running);
  set(arm, SafeOperational);
  readings.next = wider();
  watch();
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_EQ(most(arm), Number{10});
}

TEST_F(DescriptorsTest, EachProblemIsToldWithItsPlace) {
  DescriptorReading bad;
  bad.mission.problems = {
      {.file = "arm.xml", .at = {3, 7}, .code = "E0111", .message = "'x' is no number", .hint = {}},
      {.file = "mission.xml", .at = {9, 2}, .code = "E0204", .message = "no GAIN", .hint = "take it out"}};
  is_read(std::move(bad));
  EXPECT_TRUE(was_told("ARM keeps its descriptor: arm.xml:3:7: error: E0111: 'x' is no number"));
  EXPECT_TRUE(was_told("ARM keeps its descriptor: mission.xml:9:2: error: E0204: no GAIN (take it out)"));
  EXPECT_THAT(desk.sent, IsEmpty());
  parts.reception.read_own();
  EXPECT_THAT(routed_services, ::testing::Contains(129));
}

TEST_F(DescriptorsTest, WhatCannotChangeInFlightIsNamedOnceForAllWhoFlyIt) {
  is_read(another([](descriptor::SubsystemDescriptor& subsystem) {
    subsystem.parameters[0].field.type = Type::Float;
    subsystem.functions.pop_back();
  }));
  EXPECT_TRUE(was_told("parameter GAIN: its type cannot change in flight"));
  EXPECT_TRUE(was_told("function BRAKE is gone cannot change in flight"));
  EXPECT_EQ(std::ranges::count_if(story, [](const auto& line) { return line.find("GAIN") != line.npos; }), 1);
  EXPECT_EQ(craft.mission.subsystems[0].subsystem.parameters[0].field.type, Type::Double);
}

TEST_F(DescriptorsTest, WhatAProgramHasToHaveIsToldWithTheWayToIt) {
  is_read(another([](descriptor::SubsystemDescriptor& subsystem) {
    subsystem.functions.push_back(function("SPIN", in_states({Operational})));
  }));
  EXPECT_TRUE(was_told("function SPIN is new: not by REREAD (a program has to have it: REPLACE starts one that does"));
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_EQ(craft.mission.find_subsystem(arm)->subsystem.find_function("SPIN"), nullptr);
}

TEST_F(DescriptorsTest, AStoredValueStaysAndKeepsItsRangeFromLeavingIt) {
  for (auto& member : craft.mission.subsystems) member.overrides = {{"GAIN", {Number{9}}}};
  is_read(
      another([](descriptor::SubsystemDescriptor& subsystem) { subsystem.parameters[0].field.maximum = Number{8}; }));
  EXPECT_TRUE(was_told("the stored value of GAIN is outside its new range"));
  is_read(wider());
  answer(true);
  answer(true);
  EXPECT_EQ(craft.mission.subsystems[0].subsystem.parameters[0].init, std::vector<Value>{Number{9}});
  EXPECT_EQ(craft.mission.subsystems[0].overrides.size(), 1U);
}

TEST_F(DescriptorsTest, WhatTheOldOneWouldJudgeWaitsForTheEnd) {
  set(arm, PreOperational);
  std::array<std::byte, 5> ask;
  OctetWriter{ask}.put(std::uint8_t{1}).put(std::uint32_t{7});
  EXPECT_TRUE(permits(arm, 8, 1, call_data("SET_STATE", 4)));
  is_read(wider());
  EXPECT_FALSE(permits(arm, 8, 1, call_data("SET_STATE", 4)));
  EXPECT_TRUE(permits(arm, 8, 1, call_data("SET_STATE", 7))) << "towards safety";
  EXPECT_TRUE(permits(arm, 20, 1, ask)) << "a look";
  answer(true);
  EXPECT_FALSE(permits(arm, 8, 1, call_data("SET_STATE", 4)));
  answer(true);
  EXPECT_TRUE(permits(arm, 8, 1, call_data("SET_STATE", 4)));
}

TEST_F(DescriptorsTest, AFileThatIsNotReadInTimeIsGivenUp) {
  ASSERT_EQ(reread().kind, Came::Running);
  wait(61s);
  watch();
  ASSERT_EQ(reread().kind, Came::Running) << "the first is over";
}

TEST_F(DescriptorsTest, WhatFilesBringAlongIsTakenWithItAndAlsoWithTheTextInForce) {
  const auto bringing = [&](DescriptorReading reading, const char* mesh) {
    for (auto& member : reading.mission.value->subsystems)
      if (member.subsystem.id != hand) member.brought = {mesh};
    reading.mission.value->texts["arm.urdf"] = std::make_shared<const std::string>(mesh);
    return reading;
  };
  const auto brought = [&](std::uint16_t apid) { return craft.mission.find_subsystem(apid)->brought; };
  is_read(bringing(wider(), "a.stl"));
  EXPECT_THAT(brought(arm), IsEmpty()) << "nobody has taken it yet";
  answer(true);
  answer(true);
  EXPECT_THAT(brought(arm), ElementsAre("a.stl"));
  EXPECT_THAT(brought(hand), IsEmpty());
  EXPECT_THAT(brought(camera), IsEmpty()) << "its descriptor was not read";
  EXPECT_EQ(*craft.mission.texts.at("arm.urdf"), "a.stl");
  DescriptorReading same = another([](descriptor::SubsystemDescriptor&) {});
  is_read(bringing(std::move(same), "b.stl"));
  EXPECT_TRUE(was_told("the text is the one in force"));
  EXPECT_THAT(brought(arm), ElementsAre("b.stl"));
  EXPECT_EQ(*craft.mission.texts.at("arm.urdf"), "b.stl") << "who goes on for this supervisor looks there";
}

TEST_F(DescriptorsTest, TheTextInForceChangesNothing) {
  DescriptorReading same = another([](descriptor::SubsystemDescriptor&) {});
  same.text = std::make_shared<const std::string>("old");
  is_read(std::move(same));
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_TRUE(was_told("the text is the one in force"));
}

}  // namespace
}  // namespace hirosco::supervisor
