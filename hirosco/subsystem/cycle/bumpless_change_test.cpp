// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/bumpless_change.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/subsystem/testing/rig.hpp"

/// The cycle looks for itself whether another configuration may be taken over, whatever the service loop has found a cycle before, and what it
/// does not take over has changed nothing. What comes of one in flight stands in service_loop/bumpless_test.cpp.
namespace hirosco::going_over {
namespace {

constexpr const char* soft_and_stiff = R"(<Subsystem name="JOINT" id="10">
  <StructRef name="CUR_VALUES" id="0" type="STRUCT">
    <ParamRef name="STATE" id="0" type="INT32"/><ParamRef name="POSITION" id="0" type="DOUBLE"/>
  </StructRef>
  <ParamRef name="KP" id="1" type="DOUBLE"/>
  <ParamRef name="STEPS" id="2" type="INT32"/>
  <Configuration name="SOFT" id="1" sampling_us="1000">
    <RealTimeLinkService><Requires name="HAND" age="3"><Field name="ANGLE" type="DOUBLE"/></Requires></RealTimeLinkService>
  </Configuration>
  <Configuration name="STIFF" id="2" sampling_us="500">
    <RealTimeLinkService><Requires name="HAND" age="3"><Field name="ANGLE" type="DOUBLE"/></Requires></RealTimeLinkService>
    <Set parameter="CUR_VALUES.STATE" value="4"/><Set parameter="KP" value="9"/><Set parameter="STEPS" value="7"/>
  </Configuration>
  <Bumpless between="SOFT STIFF"/>
</Subsystem>)";

struct CurrentValues {
  std::int32_t state;
  double position;
};
struct Angle {
  double angle;
};

struct WillingAuthor final : Subsystem {
  int hooks{0};
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    ++hooks;
    return ok();
  }
};

[[nodiscard]] Dictionary dictionary_of_the_joint() {
  return Dictionary::make(std::vector<ParameterSpec>{
                              {.name = "CUR_VALUES",
                               .id = {10, Type::Struct, 0},
                               .fields = {{"STATE", Type::Int32, 1, {}}, {"POSITION", Type::Double, 1, {}}},
                               .is_struct = true},
                              {.name = "KP", .id = {10, Type::Double, 1}, .fields = {{"KP", Type::Double, 1, {}}}},
                              {.name = "STEPS", .id = {10, Type::Int32, 2}, .fields = {{"STEPS", Type::Int32, 1, {}}}}})
      .value();
}

/// In Operational by SOFT, with the guard's permission; STIFF is wanted. The hand's producer has a period of 10 ms.
struct GoingOver : ::testing::Test {
  descriptor::SubsystemDescriptor descriptor = testing::read_descriptor(soft_and_stiff);
  const descriptor::Configuration& soft = descriptor.configurations[0];
  descriptor::Configuration& stiff = descriptor.configurations[1];
  Dictionary dictionary = dictionary_of_the_joint();
  Parameter<CurrentValues> current;
  Parameter<double> kp;
  Parameter<std::int32_t> steps;
  WillingAuthor author;
  CyclePlan plan;
  ControlState control;
  LoopRings rings;
  ReportWriter reports{descriptor.events, rings};
  PermitPage page{};
  std::unique_ptr<VitalPage> vital = std::make_unique<VitalPage>();
  PermitWatch permit{page, {control, reports, *vital}};
  SelfTestRun self_test{reports};
  BumplessChange change{{author, descriptor, dictionary, plan, control, permit, self_test, reports}};
  LinkInput<Angle> hand;
  AttachedLink link;

  GoingOver() {
    EXPECT_TRUE(dictionary.publish("CUR_VALUES", current));
    EXPECT_TRUE(dictionary.publish("KP", kp));
    EXPECT_TRUE(dictionary.publish("STEPS", steps));
    current.store({1, 0.7});
    kp.store(2);
    steps.store(3);
    plan.configuration = &soft;
    plan.inputs.emplace_back(soft.requires_[0], &hand, true);
    link.agreement.producer_period = 10ms;
    link.count_in(soft.sampling);
    plan.inputs[0].attach(&link);
    page.release();
    control.enter(State::Operational);
  }
  /// Nothing: it was taken over. Else why not, as it is reported.
  std::string refusal() {
    Reconfiguration wanted = Reconfiguration::make(soft, stiff, descriptor.bumpless[0], dictionary);
    return refusal_of(wanted);
  }
  std::string refusal_of(Reconfiguration& wanted) {
    const bool begun = change.begin(wanted, TimePoint{1s});
    const auto record = rings.answers.front();
    if (begun) return record ? "taken over, and said not to be" : "";
    if (!record) return "refused, and nobody is told";
    CycleReport head;
    AuthorsError why;
    std::memcpy(&head, record->data(), sizeof head);
    std::memcpy(&why, record->data() + sizeof head, sizeof why);
    rings.answers.pop();
    EXPECT_EQ(head.kind, ReportKind::NotReconfigured);
    EXPECT_EQ(head.index, 2) << "it was wanted";
    return {why.text.data(), why.text_octets};
  }
  void expect_as_before() {
    EXPECT_EQ(plan.configuration, &soft);
    EXPECT_EQ(current.load().state, 1);
    EXPECT_EQ(current.load().position, 0.7);
    EXPECT_EQ(kp.load(), 2.0);
    EXPECT_EQ(steps.load(), 3);
    EXPECT_EQ(author.hooks, 0) << "its author was not asked";
    EXPECT_EQ(cycles_that_the_hand_is_awaited(), 3 * 10);
  }
  int cycles_that_the_hand_is_awaited() {
    int cycles = 0;
    while (plan.inputs[0].awaits_first(true, true)) ++cycles;
    return cycles;
  }
};

TEST_F(GoingOver, SetsTheValuesOfTheOtherConfigurationAndWhatIsNotSetStays) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(plan.configuration, &stiff);
  EXPECT_EQ(author.hooks, 1);
  EXPECT_EQ(current.load().state, 4);
  EXPECT_EQ(current.load().position, 0.7) << "another member";
  EXPECT_EQ(kp.load(), 9.0);
  EXPECT_EQ(steps.load(), 7);
}

TEST_F(GoingOver, LeavesASlowerProducerAsMuchTimeInCyclesOfTheOtherPeriod) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(cycles_that_the_hand_is_awaited(), 3 * 20) << "30 ms, in cycles of 500 us";
}

TEST_F(GoingOver, IsRefusedWhereAnotherConfigurationIsInForceThanTheOneItWasMadeFor) {
  Reconfiguration late = Reconfiguration::make(stiff, stiff, descriptor.bumpless[0], dictionary);
  EXPECT_EQ(refusal_of(late), "another configuration is in force");
  expect_as_before();
}

TEST_F(GoingOver, IsRefusedOutsideTheStatesOfControl) {
  for (const State state : {State::PreOperational, State::ErrorOperational}) {
    control.enter(state);
    EXPECT_EQ(refusal(), "neither Safe-Operational nor Operational") << to_text(state);
  }
  expect_as_before();
}

TEST_F(GoingOver, IsRefusedWhileASelfTestTriesWhatWouldChange) {
  control.enter(State::SafeOperational);
  self_test.begin({}, 1s);
  EXPECT_EQ(refusal(), "a self test runs");
  EXPECT_TRUE(self_test.running()) << "which goes on";
  expect_as_before();
  self_test.forget();
  EXPECT_EQ(refusal(), "");
}

TEST_F(GoingOver, IsRefusedInOperationalWhereTheSecondInhibitHoldsThoughTheGuardPermits) {
  control.inhibit(inhibited_by_device);
  EXPECT_EQ(refusal(), "the actuators are inhibited");
  expect_as_before();
  control.clear();
  EXPECT_EQ(refusal(), "");
}

TEST_F(GoingOver, IsRefusedInOperationalWhereTheGuardHasStoppedThoughNothingElseInhibits) {
  page.fence();
  EXPECT_EQ(refusal(), "the actuators are inhibited");
  expect_as_before();
}

TEST_F(GoingOver, AsksForNoPermissionInSafeOperationalWhereNothingMoves) {
  control.enter(State::SafeOperational);
  control.inhibit(inhibited_by_device);
  page.fence();
  EXPECT_EQ(refusal(), "");
}

TEST_F(GoingOver, PutsBackWhatWasSetBeforeAValueThatItsParameterCannotHold) {
  stiff.initial[2].values = {Number{3'000'000'000}};
  EXPECT_EQ(refusal(), "value not representable in its type");
  expect_as_before();
}

TEST_F(GoingOver, PutsBackWhatWasSetBeforeAParameterThatNobodyHasPublished) {
  dictionary.unpublish_all();
  EXPECT_TRUE(dictionary.publish("CUR_VALUES", current));
  EXPECT_TRUE(dictionary.publish("KP", kp));
  EXPECT_EQ(refusal(), "an initial value");
  expect_as_before();
}

}  // namespace
}  // namespace hirosco::going_over
