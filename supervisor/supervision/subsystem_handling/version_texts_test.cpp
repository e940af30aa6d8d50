// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/version_texts.hpp"

#include <string>
#include <vector>

#include "hirosco/descriptor/testing.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"
#include "supervisor/supervision/testing/played_readings.hpp"

/// Another version of a program with the text of its descriptor, both of which come and go together.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;
using Came = Outcome::Kind;

/// ARM, HAND and CAMERA fly a file each.
struct VersionTextsTest : PartsTest {
  PlayedReadings readings;
  PlayedDesk desk;
  VersionTexts texts{{craft, parts.own, parts.stored, &readings}};
  Replacement replacement{{craft, parts.own, parts.processes, parts.reactions, parts.under_way, texts}};
  Descriptors descriptors{{craft, parts.own, desk, parts.under_way, parts.stored, &readings}};
  std::vector<std::string> used, started_with;
  int starts_that_fail{0};
  std::expected<bool, StartRefusal> ready{true};

  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem&,
                                                          const std::string&) override {
    return ready;
  }
  void use(const descriptor::MissionSubsystem&, const std::string& version) override { used.push_back(version); }
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override {
    started_with.push_back(*subsystem.subsystem.text);
    if (starts_that_fail-- > 0) return fail(ErrorCode::SystemFailure, "new process", 11);
    return PartsTest::launch(subsystem);
  }
  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems) {
      member.subsystem.file = member.subsystem.name + ".xml";
      member.subsystem.text = std::make_shared<const std::string>("old");
      craft.mission.texts[member.subsystem.file] = member.subsystem.text;
    }
    start_all(Offline);
    started_with.clear();
  }
  [[nodiscard]] DescriptorReading reading_of(const std::string& text, auto&& edit) const {
    DescriptorReading reading;
    reading.text = std::make_shared<const std::string>(text);
    reading.mission.value = craft.mission;
    descriptor::SubsystemDescriptor& subsystem = reading.mission.value->subsystems.front().subsystem;
    subsystem.text = reading.text;
    edit(subsystem);
    return reading;
  }
  [[nodiscard]] DescriptorReading more() const {
    return reading_of("more", [](descriptor::SubsystemDescriptor& subsystem) {
      subsystem.functions.push_back(function("SPIN", in_states({Operational})));
      subsystem.failures.push_back({0x8001, "BENT"});
    });
  }
  [[nodiscard]] Outcome replace(std::string_view version = "2") {
    return replacement.replace(arm, version, 30s, Call{});
  }
  void watch() { replacement.watch(clock.now()); }
  /// Its process has ended; whoever comes next stands in Offline.
  void process_ends() {
    ends[played[arm].process] = {};
    watch();
    ends.clear();
  }
  void begins() {
    watch();
    if (craft.member(arm)->alive()) set(arm, Offline);
  }
  void on_trial() {
    ASSERT_EQ(replace().kind, Came::Running);
    readings.next = more();
    watch();
    process_ends();
    begins();
    ASSERT_THAT(started_with, ElementsAre("more"));
  }
  /// From its end to the begin of the version before.
  void falls_back() {
    watch();
    watch();
    process_ends();
    begins();
  }
  [[nodiscard]] const descriptor::SubsystemDescriptor& flown() const {
    return craft.mission.find_subsystem(arm)->subsystem;
  }
  [[nodiscard]] bool has_more() const { return flown().find_function("SPIN") != nullptr; }
};

TEST_F(VersionTextsTest, WhatAVersionBringsIsInForceAndCanBeNotedBeforeItsProcessStarts) {
  ASSERT_EQ(replace().kind, Came::Running);
  watch();
  EXPECT_THAT(readings.asked, ElementsAre("ARM.xml"));
  EXPECT_TRUE(craft.member(arm)->alive()) << "nobody waits for a disk";
  readings.next = more();
  watch();
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_FALSE(has_more());
  craft.mission.texts["HAND.xml"] = std::make_shared<const std::string>("gone back meanwhile");
  process_ends();
  EXPECT_TRUE(has_more());
  EXPECT_EQ(*craft.mission.texts.at("HAND.xml"), "gone back meanwhile") << "not as it was read";
  EXPECT_THAT(started_with, IsEmpty());
  EXPECT_EQ(parts.processes.start(arm).error().code, ErrorCode::Unavailable) << "nor does anybody else start it";
  begins();
  EXPECT_THAT(started_with, ElementsAre("more"));
  EXPECT_THAT(used, ElementsAre("2"));
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml"), "more");
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml/@"), "old") << "where the next supervisor finds it";
  EXPECT_TRUE(was_told("ARM flies by ARM.xml as it is now"));
  EXPECT_TRUE(was_told("of ARM function SPIN is new: hirosco tc"));
  EXPECT_EQ(flown().failures.size(), 1U);
}

TEST_F(VersionTextsTest, WhatItHasMoreIsPermittedAsItsTextSays) {
  on_trial();
  const auto permits_it = [&] {
    static_cast<void>(PartsTest::texts(arm));
    const auto packet = telecommand(arm, 8, 1, call_data("SPIN"));
    parts.telecommands.take({.packet = packet, .origin = Origin::ground(0)});
    parts.telecommands.forward_durable();
    return !PartsTest::texts(arm).empty();
  };
  set(arm, SafeOperational);
  EXPECT_FALSE(permits_it());
  set(arm, Operational);
  EXPECT_TRUE(permits_it());
}

TEST_F(VersionTextsTest, NotConfirmedBothGoBack) {
  on_trial();
  wait(31s);
  falls_back();
  EXPECT_THAT(started_with, ElementsAre("more", "old"));
  EXPECT_THAT(used, ElementsAre("2", ""));
  EXPECT_FALSE(has_more());
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml"), "old");
  EXPECT_FALSE(craft.mission.texts.contains("ARM.xml/@")) << "nobody needs it any more";
  EXPECT_FALSE(craft.mission.texts.contains("ARM.xml/@2"));
  EXPECT_TRUE(was_told("ARM flies by the text before"));
}

TEST_F(VersionTextsTest, ATextThatIsInForceAgainStandsAmongTheTextsOnce) {
  on_trial();
  wait(31s);
  watch();
  watch();
  process_ends();
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml"), "old");
  EXPECT_FALSE(craft.mission.texts.contains("ARM.xml/@"));
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml/@2"), "more");
  EXPECT_TRUE(was_told("ARM flies by ARM.xml as it was")) << "which the file need not say";
}

TEST_F(VersionTextsTest, WhatDiesOnTrialGoesBackWithItsText) {
  on_trial();
  craft.member(arm)->died();
  replacement.died(arm);
  watch();
  EXPECT_FALSE(has_more());
  begins();
  EXPECT_THAT(started_with, ElementsAre("more", "old"));
  EXPECT_EQ(replace().kind, Came::Running) << "it may be tried again";
}

TEST_F(VersionTextsTest, WhatCannotEvenBeStartedGoesBackWithItsText) {
  starts_that_fail = 1;
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = more();
  watch();
  process_ends();
  watch();
  watch();
  EXPECT_FALSE(has_more());
  begins();
  EXPECT_THAT(started_with, ElementsAre("more", "old"));
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(VersionTextsTest, ConfirmedBothStayUntilTheyAreTakenBackByCommandAndToAndFro) {
  on_trial();
  EXPECT_EQ(replacement.confirm(arm).kind, Came::Done);
  wait(60s);
  watch();
  EXPECT_TRUE(has_more());
  EXPECT_EQ(*craft.mission.texts.at("ARM.xml/@"), "old");
  for (const bool back : {true, false, true}) {
    ASSERT_EQ(replacement.take_back(arm, {}).kind, Came::Running);
    process_ends();
    begins();
    EXPECT_EQ(has_more(), !back);
    EXPECT_EQ(started_with.back(), back ? "old" : "more");
    EXPECT_EQ(used.back(), back ? "" : "2");
    EXPECT_EQ(*craft.mission.texts.at("ARM.xml"), back ? "old" : "more");
    EXPECT_EQ(*craft.mission.texts.at(back ? "ARM.xml/@2" : "ARM.xml/@"), back ? "more" : "old");
  }
}

TEST_F(VersionTextsTest, ATrialThatFailsTakesNoTextFromAVersionThatWasConfirmed) {
  const auto is_taken_back = [&] {
    ASSERT_EQ(replacement.take_back(arm, {}).kind, Came::Running);
    process_ends();
    begins();
  };
  on_trial();
  ASSERT_EQ(replacement.confirm(arm).kind, Came::Done);
  is_taken_back();
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = reading_of("other", [](descriptor::SubsystemDescriptor& subsystem) {
    subsystem.functions.push_back(function("STALL", in_states({Operational})));
  });
  watch();
  process_ends();
  begins();
  wait(31s);
  falls_back();
  is_taken_back();
  EXPECT_THAT(started_with, ElementsAre("more", "old", "other", "old", "more"));
}

TEST_F(VersionTextsTest, WhatIsNoPureAdditionKeepsTheVersionOut) {
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next =
      reading_of("less", [](descriptor::SubsystemDescriptor& subsystem) { subsystem.functions.pop_back(); });
  watch();
  EXPECT_TRUE(was_told("E0380: function BRAKE is gone cannot change in flight"));
  EXPECT_TRUE(was_told("ARM stays the version that it is: ARM.xml says neither"));
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_THAT(used, IsEmpty());
  parts.reception.read_own();
  EXPECT_THAT(routed_services, Contains(129));
  EXPECT_EQ(replace().kind, Came::Running) << "and a better one may be tried";
}

TEST_F(VersionTextsTest, ATextWithErrorsKeepsTheVersionOut) {
  DescriptorReading bad;
  bad.text = std::make_shared<const std::string>("bad");
  bad.mission.problems = {
      {.file = "ARM.xml", .at = {3, 7}, .code = "E0111", .message = "'x' is no number", .hint = {}}};
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = std::move(bad);
  watch();
  EXPECT_TRUE(was_told("ARM keeps its descriptor: ARM.xml:3:7: error: E0111: 'x' is no number"));
  EXPECT_THAT(used, IsEmpty());
}

TEST_F(VersionTextsTest, OfAFileThatOthersFlyNobodyTakesATextAlone) {
  craft.mission.subsystems[1].subsystem.file = "ARM.xml";
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = more();
  watch();
  EXPECT_TRUE(was_told("it differs from what flies, and HAND flies by it, too"));
  EXPECT_TRUE(craft.member(arm)->alive());
  // The text in force asks nothing of anybody.
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = reading_of("old", [](descriptor::SubsystemDescriptor&) {});
  watch();
  process_ends();
  EXPECT_THAT(started_with, ElementsAre("old"));
  EXPECT_THAT(used, ElementsAre("2"));
}

TEST_F(VersionTextsTest, NobodyRereadsWhatIsOnTrial) {
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = more();
  watch();
  EXPECT_EQ(descriptors.reread(hand, Call{}).code, pus::FailureCode::Busy) << "the mission changes in this moment";
  process_ends();
  begins();
  EXPECT_EQ(descriptors.reread(arm, Call{}).code, pus::FailureCode::Busy);
  EXPECT_EQ(replacement.confirm(arm).kind, Came::Done);
  EXPECT_EQ(descriptors.reread(arm, Call{}).kind, Came::Running);
}

TEST_F(VersionTextsTest, NobodyIsJudgedWithATextThatIsAboutToChange) {
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = more();
  watch();
  ASSERT_EQ(replacement.replace(hand, "2", 30s, Call{}).kind, Came::Running);
  process_ends();
  EXPECT_THAT(readings.asked, ElementsAre("ARM.xml"));
  begins();
  EXPECT_THAT(readings.asked, ElementsAre("ARM.xml", "HAND.xml"));
}

TEST_F(VersionTextsTest, WhatIsReadForAProgramThatIsRefusedMeanwhileIsNobodys) {
  ASSERT_EQ(replace().kind, Came::Running);
  watch();
  ready = std::unexpected{StartRefusal{{ErrorCode::Mismatch, "its digest is not the one in the manifest"}, "another"}};
  watch();
  ready = true;
  readings.next = more();
  ASSERT_EQ(replace().kind, Came::Running);
  watch();
  EXPECT_EQ(readings.asked.size(), 2U);
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(VersionTextsTest, AFileThatIsNotReadInTimeIsGivenUpAndWhatComesLateIsNobodys) {
  ASSERT_EQ(replace().kind, Came::Running);
  watch();
  wait(61s);
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  ASSERT_EQ(replace().kind, Came::Running);
  watch();
  EXPECT_EQ(readings.asked.size(), 1U) << "the disk has not answered yet";
  readings.next = more();
  watch();
  EXPECT_THAT(used, IsEmpty());
  watch();
  EXPECT_EQ(readings.asked.size(), 2U);
}

TEST_F(VersionTextsTest, WhoReadsOfALinkWhatWentWithTheVersionIsNamed) {
  on_trial();
  descriptor::Requires wanted;
  wanted.name = "ARM_STATE";
  wanted.fields.emplace_back().name = "SPEED";
  craft.mission.subsystems[1].subsystem.configurations.front().requires_ = {wanted};
  ASSERT_EQ(replacement.take_back(arm, {}).kind, Came::Running);
  process_ends();
  EXPECT_TRUE(was_told("HAND reads SPEED of ARM.ARM_STATE (link 1), which it provides no more"));
}

/// ARM's LIMIT is persistent, from 0 to 10; the version knows it up to 100.
struct VersionTextsAndValues : VersionTextsTest {
  void SetUp() override {
    descriptor::Parameter limit;
    limit.field.name = "LIMIT";
    limit.field.type = Type::Uint16;
    limit.field.minimum = Number{0};
    limit.field.maximum = Number{10};
    limit.id = 1;
    limit.init = {Number{5}};
    limit.writable_states = in_states({PreOperational});
    limit.persistent = true;
    craft.mission.subsystems.front().subsystem.parameters = {limit};
    VersionTextsTest::SetUp();
    parts.stored.begin();
    ASSERT_EQ(replace().kind, Came::Running);
    readings.next = reading_of("wider", [](descriptor::SubsystemDescriptor& subsystem) {
      subsystem.parameters.front().field.maximum = Number{100};
      subsystem.functions.push_back(function("SPIN", in_states({Operational})));
    });
    watch();
    process_ends();
    begins();
    ASSERT_TRUE(has_more());
  }
  void is_set(std::uint16_t value) {
    std::array<std::byte, 7> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{arm, Type::Uint16, 1}.wire()).put(value);
    const auto packet = telecommand(arm, 20, 3, data);
    const auto telecommand = *pus::TelecommandView::parse(packet);
    parts.stored.forwarded(arm, telecommand);
    verify(arm, telecommand.request_id(), 7, {}, 7);
  }
  void is_taken_back() {
    ASSERT_EQ(replacement.take_back(arm, {}).kind, Came::Running);
    process_ends();
    begins();
    ASSERT_FALSE(has_more());
  }
  [[nodiscard]] const descriptor::MissionSubsystem& described() const { return craft.mission.subsystems.front(); }
};

TEST_F(VersionTextsAndValues, WhatIsStoredGoesOnWithTheTextBeforeWhereThatHoldsIt) {
  is_set(9);
  EXPECT_EQ(described().overrides.size(), 1U);
  is_taken_back();
  EXPECT_EQ(described().subsystem.parameters.front().init, std::vector<Value>{Number{9}});
  EXPECT_EQ(described().subsystem.parameters.front().field.maximum, Number{10});
  EXPECT_EQ(described().overrides.size(), 1U);
}

TEST_F(VersionTextsAndValues, WhatTheTextBeforeDoesNotHoldIsForgottenAndTold) {
  is_set(50);
  EXPECT_EQ(described().subsystem.parameters.front().init, std::vector<Value>{Number{50}});
  is_taken_back();
  EXPECT_TRUE(was_told("stored values of ARM leave their ranges: LIMIT"));
  EXPECT_EQ(described().subsystem.parameters.front().init, std::vector<Value>{Number{5}});
  EXPECT_THAT(described().overrides, IsEmpty());
}

/// A supervisor that goes on for another has the texts of the mission, and among them that to go back to.
struct RecalledTexts : PartsTest {
  static constexpr std::uint16_t wheel = 11;
  [[nodiscard]] static std::string with_more(const std::string& text) {
    return descriptor::testing::changed("<FunctionService>", R"(<FunctionService><Function name="SPIN"/>)", text);
  }
  [[nodiscard]] static descriptor::Mission left_behind() {
    const auto source = descriptor::file_system();
    const descriptor::Mission first =
        *descriptor::read_mission(descriptor::testing::data / "mission.xml", source).value;
    const auto& file = first.find_subsystem(wheel)->subsystem.file;
    const auto before = first.texts.at(file);
    descriptor::Mission left = *descriptor::read_again(first, file, with_more(*before), source).value;
    left.texts[file.native() + "/@"] = before;
    left.supervisor = parts_mission().supervisor;
    return left;
  }
  RecalledTexts() : PartsTest{left_behind()} {}
  VersionTexts texts{{craft, parts.own, parts.stored, nullptr}};
};

TEST_F(RecalledTexts, AreGoneBackToByTheNextSupervisor) {
  const Member& member = *craft.member(wheel);
  const std::string file = member.descriptor().file.native();
  const std::string in_force = *member.descriptor().text;
  ASSERT_NE(member.descriptor().find_function("SPIN"), nullptr);
  EXPECT_FALSE(texts.recall(member, "9")) << "it flew by no other text";
  ASSERT_TRUE(texts.recall(member, ""));
  for (int time = 0; time < 2; ++time) {  // once more does nothing
    texts.go_back(member, "2", "");
    EXPECT_EQ(member.descriptor().find_function("SPIN"), nullptr);
    EXPECT_EQ(*craft.mission.texts.at(file), *member.descriptor().text);
    EXPECT_EQ(*craft.mission.texts.at(file + "/@2"), in_force);
  }
  texts.keep_only(member, nullptr);
  EXPECT_FALSE(texts.has(wheel, ""));
  EXPECT_FALSE(craft.mission.texts.contains(file + "/@"));
  EXPECT_TRUE(craft.mission.texts.contains(file)) << "that in force";
}

TEST_F(RecalledTexts, GoWithTheVersionThatWasOnTrial) {
  VersionNotes notes;
  notes.on_trial.push_back({.apid = wheel, .wanted = "2", .before = ""});
  std::vector<std::byte> octets(64);
  OctetWriter writer{octets};
  write(writer, notes);
  OctetReader reader{writer.written()};
  Replacement replacement{{craft, parts.own, parts.processes, parts.reactions, parts.under_way, texts}};
  replacement.recall(reader);
  const Member& member = *craft.member(wheel);
  EXPECT_TRUE(member.brings_text);
  ASSERT_NE(member.descriptor().find_function("SPIN"), nullptr);
  for (int step = 0; step < 4; ++step) replacement.watch(clock.now());
  EXPECT_EQ(member.descriptor().find_function("SPIN"), nullptr);
  EXPECT_FALSE(member.brings_text);
}

/// What is noted goes back in the next supervisor, also where it was on its way there: from its begin.
TEST_F(VersionTextsTest, AVersionIsNotedBeforeItsProcessStartsAndUntilTheOneBeforeRuns) {
  const auto noted = [&] {
    std::vector<std::byte> octets(256);
    OctetWriter writer{octets};
    replacement.note(writer);
    OctetReader reader{writer.written()};
    VersionNotes notes = read_version_notes(reader);
    EXPECT_TRUE(reader.exhausted());
    return notes;
  };
  const auto on_its_way = [&] {
    const VersionNotes notes = noted();
    return notes.on_trial.size() == 1 && notes.on_trial.front().apid == arm && notes.on_trial.front().wanted == "2" &&
           notes.on_trial.front().before.empty();
  };
  ASSERT_EQ(replace().kind, Came::Running);
  readings.next = more();
  watch();
  EXPECT_THAT(noted().on_trial, IsEmpty()) << "all is as it was";
  process_ends();
  EXPECT_TRUE(on_its_way()) << "its text is in force";
  begins();
  EXPECT_TRUE(on_its_way());
  wait(31s);
  watch();
  EXPECT_TRUE(on_its_way());
  watch();
  EXPECT_TRUE(on_its_way());
  process_ends();
  EXPECT_TRUE(on_its_way()) << "the text before is in force";
  begins();
  EXPECT_THAT(noted().on_trial, IsEmpty());
  EXPECT_EQ(noted().in_force.at(arm), "");
}

}  // namespace
}  // namespace hirosco::supervisor
