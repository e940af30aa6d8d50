// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;

constexpr std::uint16_t values_kept = 140, values_not_kept = 141, values_taken = 142, values_refused = 143;

/// ARM's P1 and P2 are persistent, P3 is not; SET_LIMIT has an argument of P1.
struct StoredValuesTest : PartsTest {
  StoredValues& stored = parts.stored;
  ValueCopies copies{value_disk, "values/ARM"};
  std::vector<std::uint16_t> events;
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    auto& subsystem = described().subsystem;
    for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
      descriptor::Parameter made;
      made.field.name = "P" + std::to_string(id);
      made.field.type = Type::Uint16;
      made.field.minimum = Number{0};
      made.field.maximum = Number{100};
      made.id = id;
      made.init = {Number{5}};
      made.writable_states = in_states({PreOperational, SafeOperational});
      made.persistent = id != 3;
      subsystem.parameters.push_back(made);
    }
    auto limit = function("SET_LIMIT", in_states({Operational}));
    limit.arguments.resize(1);
    limit.arguments[0].of = "P1";
    subsystem.functions.push_back(limit);
  }
  void routed(const pus::TelemetryView& packet) override {
    PartsTest::routed(packet);
    if (packet.service() == 5 && packet.apid() == supervisor_apid)
      events.push_back(OctetReader{packet.source_data()}.get<std::uint16_t>());
  }
  descriptor::MissionSubsystem& described() { return craft.mission.subsystems.front(); }
  void begin() {
    stored.begin();
    start_all(Operational);
  }
  static std::uint32_t id(std::uint8_t parameter) { return ParameterId{arm, Type::Uint16, parameter}.wire(); }
  template <class... Values>
  static std::vector<std::byte> octets(Values... values) {
    std::vector<std::byte> data(64);
    OctetWriter writer{data};
    (writer.put(values), ...);
    data.resize(writer.size());
    return data;
  }
  static std::vector<std::byte> one(std::uint8_t parameter, std::uint16_t value) {
    return octets(std::uint8_t{1}, id(parameter), value);
  }
  std::uint32_t leaves(std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data,
                       std::uint8_t ack = pus::ack_all) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(
        buffer,
        {.apid = arm, .sequence_count = ++count, .ack = ack, .service = service, .subtype = subtype, .source = 7},
        data);
    const auto telecommand = pus::TelecommandView::parse(*packet).value();
    stored.forwarded(arm, telecommand);
    return telecommand.request_id();
  }
  void ends(std::uint32_t request, std::uint8_t subtype = 7) { verify(arm, request, subtype, {}, 7); }
  void set(std::uint8_t parameter, std::uint16_t value) { ends(leaves(20, 3, one(parameter, value))); }
  /// The parts look after their things so long, every millisecond.
  void pass(Duration span = 20ms) {
    for (Duration passed{}; passed < span; passed += 1ms) {
      own_step();
      stored.watch(clock.now());
    }
  }
  /// What ARM is asked for; it answers with this value of P1.
  std::vector<std::string> asked(std::optional<std::uint16_t> answer = std::nullopt) {
    std::vector<std::string> texts;
    for (const Received& each : received(arm)) {
      texts.push_back(each.text);
      if (!answer) continue;
      report(arm, 20, 2, one(1, *answer), supervisor_apid);
      verify(arm, each.request, 7);
    }
    return texts;
  }
  /// With what it begins from its next start on.
  std::vector<std::string> begins() {
    std::vector<std::string> texts;
    for (const auto& each : described().overrides) texts.push_back(to_string(each));
    return texts;
  }
  /// What stands in a copy, as far as it is whole.
  std::optional<ValueSet> in_copy(std::size_t which) {
    const TwoCopies both = copies.read();
    descriptor::MissionSubsystem plain = described();
    ValueSet set{plain};
    if (!both[which] || !set.take(*both[which])) return std::nullopt;
    return set;
  }
  /// A flight before this one has set these.
  void set_before(std::uint16_t first, std::uint16_t second, std::uint64_t sequence = 8) {
    ValueSet set{described()};
    set.set(id(1), octets(first));
    set.set(id(2), octets(second));
    ASSERT_TRUE(copies.write({set.layout(), sequence, clock.onboard(), set.octets()}));
  }
  void damage(std::size_t copy) {
    auto octets_of_it = value_disk.read(copies.path(copy), 4096).value();
    octets_of_it[30] ^= std::byte{1};
    ASSERT_TRUE(value_disk.create(copies.path(copy), octets_of_it));
  }
};

TEST_F(StoredValuesTest, WhatATelecommandSetIsInBothCopiesAndWhatItBeginsWithNext) {
  begin();
  EXPECT_THAT(begins(), IsEmpty());
  set(1, 42);
  pass();
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
  for (const std::size_t copy : {0U, 1U}) {
    ASSERT_TRUE(in_copy(copy));
    EXPECT_EQ(in_copy(copy)->octets(), one(1, 42));
  }
  EXPECT_THAT(events, ElementsAre(values_kept));
}

TEST_F(StoredValuesTest, WhatIsNotPersistentOrWasRefusedIsNot) {
  begin();
  set(3, 42);
  ends(leaves(20, 3, one(1, 43)), 4);
  pass();
  EXPECT_THAT(begins(), IsEmpty());
  EXPECT_EQ(copies.read()[0], std::unexpected{CopyFault::Missing});
}

TEST_F(StoredValuesTest, ThoseThatAreSetTogetherAreStoredTogether) {
  begin();
  ends(leaves(20, 3,
              octets(std::uint8_t{3}, id(1), std::uint16_t{7}, id(3), std::uint16_t{8}, id(2), std::uint16_t{9})));
  pass();
  EXPECT_THAT(begins(), ElementsAre("P1=7", "P2=9"));
  EXPECT_EQ(copies.read()[0]->sequence, 1U);
}

TEST_F(StoredValuesTest, ALaterFlightBeginsWithThemAndSaysSince) {
  set_before(70, 80);
  begin();
  EXPECT_THAT(begins(), ElementsAre("P1=70", "P2=80"));
  EXPECT_TRUE(was_told("ARM takes over 2 stored values, of 2026"));
  EXPECT_TRUE(was_told("ARM begins with P1=70"));
  set(1, 71);
  PartsTest::set(camera, Operational);
  pass();
  EXPECT_THAT(events, Contains(values_taken));
  EXPECT_THAT(begins(), ElementsAre("P1=71", "P2=80"));
  EXPECT_EQ(copies.read()[0]->sequence, 9U);
}

TEST_F(StoredValuesTest, ADamagedCopyIsNamedAndMadeWholeFromTheOther) {
  set_before(70, 80);
  damage(0);
  stored.begin();
  EXPECT_TRUE(was_told("copy 1 of ARM's stored values is not used: damaged"));
  EXPECT_THAT(begins(), ElementsAre("P1=70", "P2=80"));
  EXPECT_TRUE(in_copy(0));
}

TEST_F(StoredValuesTest, TheSecondCopyDamagedIsAsGood) {
  set_before(70, 80);
  damage(1);
  stored.begin();
  EXPECT_TRUE(was_told("copy 2 of ARM's stored values is not used: damaged"));
  EXPECT_THAT(begins(), ElementsAre("P1=70", "P2=80"));
  EXPECT_TRUE(in_copy(1));
}

TEST_F(StoredValuesTest, BothDamagedTheDescriptorCountsAndTheNextChangeIsStoredAgain) {
  set_before(70, 80);
  damage(0);
  damage(1);
  begin();
  EXPECT_THAT(begins(), IsEmpty());
  EXPECT_TRUE(was_told("ARM begins as its descriptor says: none of its stored values is used"));
  PartsTest::set(camera, Operational);
  pass();
  EXPECT_THAT(events, ElementsAre(values_refused, values_refused));
  set(2, 3);
  pass();
  EXPECT_THAT(begins(), ElementsAre("P2=3"));
  EXPECT_TRUE(in_copy(0) && in_copy(1));
}

TEST_F(StoredValuesTest, WhatHasLeftItsRangeOrLayoutIsNotUsedAndStaysWhereItIs) {
  set_before(70, 80);
  described().subsystem.parameters[1].field.maximum = Number{79};
  stored.begin();
  EXPECT_THAT(begins(), IsEmpty());
  EXPECT_TRUE(was_told("copy 1 of ARM's stored values is not used: outside the range"));
  EXPECT_TRUE(was_told("copy 2 of ARM's stored values is not used: outside the range"));
  EXPECT_EQ(copies.read()[0]->sequence, 8U) << "the old descriptor would find it again";
}

TEST_F(StoredValuesTest, OfTwoWholeCopiesTheNewerCountsAndBothHaveItThen) {
  set_before(70, 80, 8);
  const auto older = value_disk.read(copies.path(1), 4096).value();
  set_before(71, 81, 9);
  ASSERT_TRUE(value_disk.create(copies.path(1), older));
  stored.begin();
  EXPECT_THAT(begins(), ElementsAre("P1=71", "P2=81"));
  EXPECT_EQ(copies.read()[1]->sequence, 9U);
}

TEST_F(StoredValuesTest, WhatAFunctionMadeOfItIsAskedForWhenItHasEnded) {
  begin();
  set(1, 42);
  const auto request = leaves(8, 1, call_data("SET_LIMIT", 1));
  pass();
  EXPECT_THAT(asked(), IsEmpty()) << "it goes on";
  ends(request);
  pass();
  EXPECT_THAT(asked(17), ElementsAre("TC[20,1]"));
  pass();
  EXPECT_THAT(begins(), ElementsAre("P1=17"));
  EXPECT_THAT(asked(), IsEmpty());
}

TEST_F(StoredValuesTest, AFunctionThatFailedOnItsWayIsAskedForTooAndOneThatNeverBeganIsNot) {
  begin();
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)), 4);
  pass();
  EXPECT_THAT(asked(), IsEmpty());
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)), 8);
  pass();
  EXPECT_THAT(asked(16), ElementsAre("TC[20,1]"));
  EXPECT_THAT(begins(), ElementsAre("P1=16"));
}

TEST_F(StoredValuesTest, OneWhoseEndNobodyWantedToHearIsAskedFor) {
  begin();
  leaves(20, 3, one(1, 42), 0);
  pass();
  EXPECT_THAT(asked(42), ElementsAre("TC[20,1]"));
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
}

TEST_F(StoredValuesTest, AValueSetWhileItIsAskedForIsNotReplacedByTheEarlierOne) {
  begin();
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)));
  pass();
  const auto questions = received(arm);
  ASSERT_EQ(questions.size(), 1U);
  set(1, 50);
  report(arm, 20, 2, one(1, 17), supervisor_apid);
  verify(arm, questions[0].request, 7);
  EXPECT_THAT(begins(), ElementsAre("P1=50"));
  pass();
  EXPECT_THAT(asked(50), ElementsAre("TC[20,1]"));
  EXPECT_THAT(begins(), ElementsAre("P1=50"));
}

TEST_F(StoredValuesTest, WhoDiesBeforeItToldWhatAFunctionMadeOfItBeginsAsTheDescriptorSays) {
  begin();
  set(1, 42);
  set(2, 43);
  leaves(8, 1, call_data("SET_LIMIT", 1));
  events.clear();
  stored.ended(arm);
  pass();
  EXPECT_THAT(begins(), ElementsAre("P2=43"));
  EXPECT_EQ(in_copy(0)->octets(), one(2, 43));
  EXPECT_THAT(events, ElementsAre(values_not_kept, values_kept));
  EXPECT_TRUE(was_told("what ARM made of P1 is not known"));
}

TEST_F(StoredValuesTest, WhoDiesOtherwiseBeginsWithWhatWasSet) {
  begin();
  set(1, 42);
  leaves(20, 3, one(1, 43));
  stored.ended(arm);
  pass();
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
}

TEST_F(StoredValuesTest, InOfflineNobodyIsAskedBeforeItComesBack) {
  begin();
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)));
  PartsTest::set(arm, Offline);
  pass();
  EXPECT_THAT(asked(), IsEmpty());
  PartsTest::set(arm, PreOperational);
  pass();
  EXPECT_THAT(asked(17), ElementsAre("TC[20,1]"));
  EXPECT_THAT(begins(), ElementsAre("P1=17"));
}

/// Takes nothing while it is full.
struct FullDisk final : MemoryValueDisk {
  bool full{true};
  Result<> create(const Path& file, Octets octets) override {
    return full ? fail(ErrorCode::SystemFailure, "no room", 28) : MemoryValueDisk::create(file, octets);
  }
};

/// Another supervisor goes on for the one that the rig has, which died at this moment.
struct StoredValuesGoOn : StoredValuesTest {
  std::optional<StoredValues> next;

  void goes_on() { goes_on(values); }
  void goes_on(ValueStore& store) {
    recalls(stored, store);
    next->begin();
  }
  /// One that has not come to its first step.
  void recalls(const StoredValues& before, ValueStore& disk) {
    std::vector<std::byte> noted(4096);
    OctetWriter writer{noted};
    before.note(writer);
    ASSERT_TRUE(writer.good());
    described().overrides.clear();  // the mission as it is read again
    for (auto& parameter : described().subsystem.parameters) parameter.init = {Number{5}};
    events.clear();
    next.emplace(craft, parts.own, parts.own_telecommands, &disk);
    OctetReader reader{writer.written()};
    next->recall(reader);
    ASSERT_TRUE(reader.exhausted());
  }
  void heard(std::uint16_t from, std::uint8_t service, std::uint8_t subtype, Octets data, std::uint16_t destination) {
    std::array<std::byte, 64> room;
    const auto packet = pus::write_telemetry(
        room, {.apid = from, .service = service, .subtype = subtype, .destination = destination}, data);
    next->hear(from, pus::TelemetryView::parse(*packet).value());
  }
  void end_heard(std::uint16_t from, std::uint32_t request, std::uint8_t subtype) {
    heard(from, 1, subtype, octets(request, static_cast<std::uint16_t>(pus::FailureCode::OutcomeUnknown)), 7);
  }
  void goes_by() {
    for (Duration passed{}; passed < 20ms; passed += 1ms) {
      own_step();
      next->watch(clock.now());
    }
  }
  /// How often ARM was asked for P1, which is 17.
  std::size_t answered() {
    const auto questions = received(arm);
    for (const Received& each : questions) {
      heard(arm, 20, 2, one(1, 17), supervisor_apid);
      verify(arm, each.request, 7);
    }
    return questions.size();
  }
};

TEST_F(StoredValuesGoOn, WhatWasAcceptedUnderOneSupervisorAndEndsUnderTheNextIsKept) {
  begin();
  const auto request = leaves(20, 3, one(1, 42));
  goes_on();
  end_heard(arm, request, 7);
  goes_by();
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
  EXPECT_EQ(in_copy(0)->octets(), one(1, 42));
  EXPECT_THAT(events, Contains(values_kept));
}

/// The dead one had read it and not noted that: nobody hears it again.
TEST_F(StoredValuesGoOn, WhatWasChangedByOneWhoseEndNobodyKnowsIsAskedForAndHeardIfItEndsLater) {
  begin();
  const auto request = leaves(20, 3, one(1, 42));
  goes_on();
  goes_by();
  EXPECT_EQ(answered(), 0U) << "it may still be on its way";
  end_heard(supervisor_apid, request, 8);
  goes_by();
  EXPECT_EQ(answered(), 1U);
  EXPECT_THAT(begins(), ElementsAre("P1=17"));
  end_heard(arm, request, 7);
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
}

TEST_F(StoredValuesGoOn, WhatAFunctionMadeOfItIsAskedForByTheNextOne) {
  begin();
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)));
  goes_on();
  goes_by();
  EXPECT_EQ(answered(), 1U);
  EXPECT_THAT(begins(), ElementsAre("P1=17"));
}

TEST_F(StoredValuesGoOn, WhatWasAskedForWithoutAnAnswerIsAskedForAgain) {
  begin();
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)));
  pass();
  EXPECT_THAT(asked(), ElementsAre("TC[20,1]"));
  goes_on();
  goes_by();
  EXPECT_EQ(answered(), 1U);
  EXPECT_THAT(begins(), ElementsAre("P1=17"));
}

TEST_F(StoredValuesGoOn, WhoDiesWithTheSupervisorDoesNotBeginWithWhatAFunctionMayHaveTightened) {
  begin();
  set(1, 42);
  set(2, 43);
  leaves(8, 1, call_data("SET_LIMIT", 1));
  pass();
  goes_on();
  EXPECT_THAT(begins(), ElementsAre("P1=42", "P2=43"));
  next->ended(arm);
  goes_by();
  EXPECT_THAT(begins(), ElementsAre("P2=43"));
  EXPECT_THAT(events, Contains(values_not_kept));
}

TEST_F(StoredValuesGoOn, WhatTheDiskHadNotTakenIsKeptByTheNextOneAndTold) {
  begin();
  set(1, 42);
  MemoryValueDisk other_disk;  // on which nothing of it has come
  DirectValueStore other{other_disk, "values"};
  goes_on(other);
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
  goes_by();
  EXPECT_THAT(events, Contains(values_kept));
  ValueCopies there{other_disk, "values/ARM"};
  EXPECT_TRUE(there.read()[0] && there.read()[1]);
  EXPECT_EQ(there.read()[0]->sequence, 1U);
}

TEST_F(StoredValuesGoOn, WhoDiesBeforeItHasReadTheDiskLeavesAllOfItToTheNextOne) {
  begin();
  set(1, 42);
  ends(leaves(8, 1, call_data("SET_LIMIT", 1)));
  MemoryValueDisk other_disk;
  DirectValueStore other{other_disk, "values"};
  recalls(stored, other);
  for (int death = 0; death < 2; ++death) {
    const StoredValues before{*next};
    recalls(before, other);
  }
  next->begin();
  EXPECT_THAT(begins(), ElementsAre("P1=42"));
  goes_by();
  EXPECT_EQ(answered(), 1U) << "what the function made of it";
}

TEST_F(StoredValuesGoOn, WhatTheDiskHasIsNotNotedAndNobodyIsAskedForNothing) {
  begin();
  set(1, 42);
  pass();
  goes_on();
  goes_by();
  EXPECT_EQ(answered(), 0U);
  EXPECT_THAT(begins(), ElementsAre("P1=42")) << "from the disk";
  EXPECT_THAT(events, Not(Contains(values_kept)));
}

TEST_F(StoredValuesTest, ADiskThatTakesNothingIsToldOnceAndTriedAgain) {
  FullDisk disk;
  DirectValueStore on_it{disk, "values"};
  StoredValues other{craft, parts.own, parts.own_telecommands, &on_it};
  other.begin();
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const auto packet = pus::write_telecommand(
      buffer, {.apid = arm, .ack = pus::ack_all, .service = 20, .subtype = 3, .source = 7}, one(1, 42));
  const auto telecommand = pus::TelecommandView::parse(*packet).value();
  other.forwarded(arm, telecommand);
  std::array<std::byte, 4> request{};
  OctetWriter{request}.put(telecommand.request_id());
  std::array<std::byte, pus::max_telemetry_octets> room;
  const auto done = pus::write_telemetry(room, {.apid = arm, .service = 1, .subtype = 7, .destination = 7}, request);
  other.hear(arm, pus::TelemetryView::parse(*done).value());
  const auto look = [&](Duration span) {
    wait(span);
    other.watch(clock.now());
    own_step();
  };
  for (int i = 0; i < 3; ++i) look(StoredValues::retry_after);
  EXPECT_THAT(events, ElementsAre(values_not_kept));
  EXPECT_TRUE(was_told("ARM's values are not stored: no room (28)"));
  EXPECT_THAT(begins(), ElementsAre("P1=42")) << "this flight has it all the same";
  disk.full = false;
  for (int i = 0; i < 3; ++i) look(StoredValues::retry_after);
  EXPECT_THAT(events, ElementsAre(values_not_kept, values_kept));
  ValueCopies there{disk, "values/ARM"};
  EXPECT_TRUE(there.read()[0] && there.read()[1]);
}

}  // namespace
}  // namespace hirosco::supervisor
