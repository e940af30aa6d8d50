// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/loop_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/pus/testing/played_self_test.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// ST[20] in a loop of its own: values are read there and set by whoever is their writer.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Rig;
using testing::Sent;
using ::testing::StartsWith;

constexpr const char* shelf_descriptor = R"(<Subsystem name="SHELF" id="10">
  <ParamRef name="FILES" id="0" type="UINT32" init="7" minimum="0" maximum="1000"
            writable="PreOperational SafeOperational Operational"/>
  <ParamRef name="FOLDERS" id="1" type="UINT32" init="1" minimum="0" maximum="9" writable="PreOperational" persistent="yes"/>
  <ParamRef name="TURNS" id="2" type="UINT32" minimum="0" maximum="4000000000" writable="PreOperational SafeOperational"/>
  <ServiceLoop name="VALUES" period_us="20000" queue="2"/>
  <Service name="ST20" loop="VALUES"/>
  <Configuration name="FIRST" id="1" sampling_us="1000"/>
  <Configuration name="SECOND" id="2" sampling_us="1000"><Set parameter="FILES" value="3"/></Configuration>
  <Configuration name="BARE" id="3" sampling_us="1000"><Service name="ST20" offered="no"/></Configuration>
</Subsystem>)";

/// Its node counts its turns in Safe-Operational.
struct Shelf final : Subsystem {
  Parameter<std::uint32_t> files, folders, turns;
  std::function<void()> meanwhile;  ///< in other threads, while the service loop is with the author

  Result<Step> software_init() override {
    publish("FILES", files);
    publish("FOLDERS", folders);
    publish("TURNS", turns);
    return done;
  }
  Result<> safe_operational(const Cycle&) noexcept override {
    turns.store(turns.load() + 1);
    return ok();
  }
  Result<Step> post_operational() override {
    if (meanwhile) meanwhile();
    return done;
  }
  void telemetry(Octets) override {
    if (meanwhile) meanwhile();
  }
};

struct ParametersOfALoop : ::testing::Test {
  Shelf author;
  Rig rig{author, shelf_descriptor};

  static constexpr std::uint8_t files = 0, folders = 1, turns = 2;
  static std::uint32_t wire(std::uint8_t id) { return ParameterId{10, Type::Uint32, id}.wire(); }

  Sent set(std::initializer_list<std::pair<std::uint8_t, std::uint32_t>> values, std::uint32_t mode_epoch = 0) {
    std::vector<std::byte> data(1 + 8 * values.size());
    OctetWriter writer{data};
    writer.put(static_cast<std::uint8_t>(values.size()));
    for (const auto& [id, value] : values) writer.put(wire(id)).put(value);
    return rig.send(20, 3, data, {}, mode_epoch);
  }
  Sent read(std::uint8_t id) {
    std::array<std::byte, 5> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(wire(id));
    return rig.send(20, 1, data);
  }
  /// One of the loop, without a word of the service loop.
  void step_loop() { static_cast<void>(rig.subsystem.own_loop_step(0, rig.clock.now())); }
  /// All three, as their threads would.
  std::string outcome_of(Sent sent) {
    rig.service();
    step_loop();
    rig.settle();
    return rig.outcome(sent);
  }
  std::uint32_t seen(const Parameter<std::uint32_t>& parameter) {
    std::uint32_t value = 0;
    EXPECT_TRUE(parameter.snapshot(value));
    return value;
  }
};

TEST_F(ParametersOfALoop, AreReportedInItsStepAndByTheServiceLoop) {
  rig.bring_to(State::PreOperational);
  const Sent sent = read(files);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "") << "the service loop does not do it";
  step_loop();
  EXPECT_THAT(rig.reports(20, 2), IsEmpty()) << "only the service loop speaks with the supervisor";
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_THAT(rig.reports(20, 2), ElementsAre("01000a050000000007"));
}

TEST_F(ParametersOfALoop, AreSetAtTheNextBoundaryOfTheCycle) {
  rig.bring_to(State::PreOperational);
  const Sent sent = set({{files, 5}, {folders, 2}});
  rig.service();
  step_loop();
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_EQ(seen(author.files), 7U) << "the cycle runs and alone writes";
  rig.cycle();
  EXPECT_EQ(seen(author.files), 5U);
  EXPECT_EQ(seen(author.folders), 2U);
}

TEST_F(ParametersOfALoop, AreSetByTheServiceLoopWhileNoCycleRuns) {
  rig.bring_to(State::PreOperational, 0);
  const Sent sent = set({{files, 5}});
  rig.service();
  step_loop();
  EXPECT_EQ(seen(author.files), 7U) << "the loop is no writer";
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_EQ(seen(author.files), 5U);
}

/// Whoever was told that it is set, and configures then, has what the configuration says.
TEST_F(ParametersOfALoop, AreSetBeforeWhatIsAskedForWhenTheirSettingWasTold) {
  rig.bring_to(State::PreOperational, 0);
  const Sent sent = set({{files, 5}});
  rig.service();
  step_loop();
  const Sent configured = rig.configure(2);
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  rig.settle();
  EXPECT_EQ(rig.outcome(configured), "1 3 7");
  EXPECT_EQ(seen(author.files), 3U);
}

TEST_F(ParametersOfALoop, AreAllSetOrNone) {
  rig.bring_to(State::PreOperational);
  EXPECT_THAT(outcome_of(set({{files, 5}, {folders, 10}})), StartsWith("1 4:"));
  EXPECT_EQ(seen(author.files), 7U);
  EXPECT_EQ(seen(author.folders), 1U);
}

TEST_F(ParametersOfALoop, AreJudgedByStateAndModeWhenItDoesItNotWhenItCame) {
  rig.bring_to(State::PreOperational);
  rig.permit.mode_epoch = 3;
  const Sent of_state = set({{folders, 2}}), of_mode = set({{files, 5}}, 3);
  rig.service();
  rig.permit.mode_epoch = 4;
  rig.set_state_now(State::SafeOperational);
  step_loop();
  rig.settle();
  EXPECT_THAT(rig.outcome(of_state), StartsWith("1 4:0107"));
  EXPECT_THAT(rig.outcome(of_mode), StartsWith("2:000d"));
  EXPECT_EQ(seen(author.folders), 1U);
  EXPECT_EQ(seen(author.files), 7U);
}

/// What comes to its turn between the order and its being there must not be set behind it.
TEST_F(ParametersOfALoop, AreJudgedByTheStateTooThatTheCycleIsSentInto) {
  rig.bring_to(State::PreOperational);
  const Sent entered = rig.set_state(State::SafeOperational);
  rig.service();
  const Sent of_both = set({{files, 5}}), of_before = set({{folders, 2}});
  rig.service();
  step_loop();
  rig.settle();
  EXPECT_EQ(rig.outcome(entered), "1 3 7");
  EXPECT_EQ(rig.outcome(of_both), "1 3 7");
  EXPECT_THAT(rig.outcome(of_before), StartsWith("1 4:0107"));
  EXPECT_EQ(seen(author.folders), 1U);
  rig.set_state_now(State::Offline);
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(outcome_of(set({{folders, 2}})), "1 3 7") << "it is there";
}

TEST_F(ParametersOfALoop, ThatArePersistentAreKeptThoughTheyAreSetOnTheWayDown) {
  rig.bring_to(State::PreOperational, 0);
  const Sent sent = set({{folders, 5}});
  rig.service();
  author.meanwhile = [this] { step_loop(); };
  rig.set_state_now(State::Offline);
  author.meanwhile = nullptr;
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  rig.bring_to(State::PreOperational, 0);
  EXPECT_EQ(seen(author.folders), 5U);
}

TEST_F(ParametersOfALoop, AreLookedAtAsTheyAreSetWhereANarrowerRangeIsTaken) {
  rig.bring_to(State::PreOperational, 0);
  std::string narrower{shelf_descriptor};
  const std::string was = R"(maximum="1000")";
  narrower.replace(narrower.find(was), was.size(), R"(maximum="8")");
  const MemoryHandle memory = rig.memory.create("text", narrower.size()).value();
  std::ranges::copy(std::as_bytes(std::span{narrower}),
                    rig.memory.map(memory, Access::ReadWrite).value().octets.begin());
  ASSERT_TRUE(rig.memory.seal_writers(memory));
  std::array<std::byte, 4> octets;
  OctetWriter{octets}.put(static_cast<std::uint32_t>(narrower.size()));
  const Sent judged = rig.send(130, 1, octets, memory), sent = set({{files, 9}});
  rig.service();
  author.meanwhile = [this] { step_loop(); };
  rig.answer(11, 200, 1, {});
  const Sent taken = rig.send(130, 2, {});
  rig.settle();
  EXPECT_EQ(rig.outcome(judged), "1 3 7");
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_THAT(rig.outcome(taken), StartsWith("1 4:0107"));
  EXPECT_EQ(seen(author.files), 9U);
  EXPECT_EQ(outcome_of(set({{files, 10}})), "1 3 7") << "the range before";
}

TEST_F(ParametersOfALoop, ThatTheCycleWritesItselfAreRefused) {
  rig.bring_to(State::SafeOperational);
  EXPECT_THAT(outcome_of(set({{turns, 5}})), StartsWith("1 4:0107"));
  EXPECT_EQ(outcome_of(set({{files, 5}})), "1 3 7");
  EXPECT_EQ(seen(author.files), 5U);
}

TEST_F(ParametersOfALoop, AreUnknownBeforeTheyArePublished) {
  EXPECT_THAT(outcome_of(set({{files, 5}})), StartsWith("1 4:0101"));
  EXPECT_THAT(outcome_of(read(files)), StartsWith("1 4:0101"));
}

TEST_F(ParametersOfALoop, AreAskedForByNoMoreThanMayWait) {
  rig.bring_to(State::PreOperational);
  const Sent first = read(files), second = read(folders), third = read(turns);
  rig.settle();
  EXPECT_EQ(rig.outcome(third), "2:000b");
  step_loop();
  rig.service();
  EXPECT_EQ(rig.outcome(first), "1 3 7");
  EXPECT_EQ(rig.outcome(second), "1 3 7");
}

TEST_F(ParametersOfALoop, AreRefusedWhereTheConfigurationDoesNotOfferThem) {
  rig.bring_to(State::PreOperational, 3);
  EXPECT_EQ(outcome_of(read(files)), "2:000614");
  rig.set_state_now(State::Offline);
  rig.bring_to(State::PreOperational, 1);
  EXPECT_EQ(outcome_of(read(files)), "1 3 7");
}

/// Asked for under one that offers them.
TEST_F(ParametersOfALoop, AreRefusedWhereTheConfigurationThatCameMeanwhileDoesNotOfferThem) {
  rig.bring_to(State::PreOperational, 0);
  const Sent sent = set({{files, 5}});
  rig.service();
  EXPECT_EQ(rig.configure_now(3), "1 3 7");
  step_loop();
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "2:000614");
  EXPECT_EQ(seen(author.files), 7U);
}

TEST_F(ParametersOfALoop, AreRefusedAsBusyWhileTheCycleTakesNoneOfThoseThatWait) {
  rig.bring_to(State::PreOperational);
  constexpr int batches = 32;
  for (int i = 0; i < batches; i += 2) {
    static_cast<void>(set({{files, 5}}));
    static_cast<void>(set({{files, 6}}));
    rig.service();
    step_loop();
    rig.service();
  }
  const Sent full = set({{files, 8}});
  rig.service();
  step_loop();
  rig.service();
  EXPECT_EQ(rig.outcome(full), "1 4:0108") << "the cycle has not come since";
  rig.cycle();
  EXPECT_EQ(seen(author.files), 6U);
  EXPECT_EQ(outcome_of(set({{files, 8}})), "1 3 7");
}

/// A loop between its judgement and the queue, while the service loop goes on.
struct Between final : pus::ServiceHome {
  explicit Between(const descriptor::SubsystemDescriptor& subsystem) : subsystem_{subsystem} {}
  const descriptor::SubsystemDescriptor& descriptor() const noexcept override { return subsystem_; }
  descriptor::State state() const noexcept override { return is; }
  pus::Verification& verification() noexcept override { return verification_; }
  pus::TelemetrySink& telemetry() noexcept override { return sink_; }
  pus::SelfTest& self_test() noexcept override { return self_test_; }
  pus::FailureNotice refusal(pus::FailureCode code, const Error&) const override { return pus::FailureNotice{code}; }

  State is{State::PreOperational};

 private:
  const descriptor::SubsystemDescriptor& subsystem_;
  pus::testing::RecordingSink sink_;
  pus::Verification verification_{sink_};
  pus::testing::PlayedSelfTest self_test_;
};

TEST_F(ParametersOfALoop, AreNotQueuedByAStateThatIsNoMore) {
  const Situation at;
  const CycleOrders orders{rig.vital};
  ParameterValues values{rig.subsystem.descriptor(), at, orders, rig.subsystem.cycle()};
  ASSERT_TRUE(values.dictionary().publish("FOLDERS", author.folders));
  Between between{rig.subsystem.descriptor()};
  LoopParameters parameters{values, between};
  constexpr std::array two{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{2}};
  const pus::ParameterAccess::Write write{wire(folders), two};
  ASSERT_TRUE(parameters.check_write(write.id, write.value));
  EXPECT_TRUE(parameters.submit_write({&write, 1}, {}));
  EXPECT_EQ(values.writes().waiting(), 1U);
  ASSERT_TRUE(parameters.check_write(write.id, write.value));
  between.is = State::SafeOperational;
  const auto refused = parameters.submit_write({&write, 1}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), pus::FailureCode::NotPermittedNow);
  EXPECT_EQ(values.writes().waiting(), 1U);
}

}  // namespace
}  // namespace hirosco
