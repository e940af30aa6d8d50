// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What is commanded while something else is under way, and configurations that cannot be had.
namespace hirosco {
namespace {

using ::testing::HasSubstr;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

constexpr const char* busy = "1 4:0108";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = probe_descriptor;
  return text.replace(text.find(from), from.size(), to);
}

struct Commissioning : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
};

TEST_F(Commissioning, NothingOverridesAWayThroughTransientStates) {
  probe.nodes[State::HardwareInit].again = 2;
  const auto up = rig.set_state(State::PreOperational);
  rig.service();
  const auto error = rig.set_state(State::ErrorOperational);
  const auto configure = rig.configure(1);
  rig.service();
  EXPECT_EQ(rig.outcome(error), busy);
  EXPECT_EQ(rig.outcome(configure), busy);
  rig.settle();
  EXPECT_EQ(rig.outcome(up), "1 3 7");
}

TEST_F(Commissioning, ErrorOperationalOverridesNeitherTheWayToItselfNorTheWayDown) {
  rig.bring_to(State::Operational);
  const auto first = rig.set_state(State::ErrorOperational);
  const auto again = rig.set_state(State::ErrorOperational);
  rig.service();
  rig.service();  // the cycle has not confirmed it yet
  EXPECT_EQ(rig.outcome(again), busy);
  rig.settle();
  EXPECT_EQ(rig.outcome(first), "1 3 7");
  const auto down = rig.set_state(State::PostOperational);
  rig.service();
  const auto back = rig.set_state(State::ErrorOperational);
  rig.service();
  EXPECT_EQ(rig.outcome(back), busy);
  rig.settle();
  EXPECT_EQ(rig.outcome(down), "1 3 7");
}

TEST_F(Commissioning, AChangeWaitsForTheCycleUntilItsTimeIsOver) {
  rig.bring_to(State::Operational);
  const auto to_safe = rig.set_state(State::SafeOperational);
  rig.service();
  rig.advance(10s);
  rig.service();
  EXPECT_EQ(rig.outcome(to_safe), "1 3");
  rig.advance(1ms);
  rig.service();
  EXPECT_THAT(rig.outcome(to_safe), StartsWith("1 3 8:0202"));
}

TEST_F(Commissioning, APageSaysTheStateThatTheCycleActsInWhileItsServiceLoopStandsStill) {
  rig.bring_to(State::SafeOperational);
  const auto up = rig.set_state(State::Operational);
  rig.service();
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::SafeOperational));
  rig.cycle();
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::Operational));
  EXPECT_EQ(rig.outcome(up), "1 3");
  const auto goal = rig.call("SET_GOAL", {0.5});
  rig.settle();
  EXPECT_EQ(rig.outcome(up), "1 3 7");
  EXPECT_EQ(rig.outcome(goal), "1 3 7");
  const auto down = rig.set_state(State::SafeOperational);
  rig.service();
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::Operational));
  rig.cycle();
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::SafeOperational));
  rig.settle();
  EXPECT_EQ(rig.outcome(down), "1 3 7");
}

TEST_F(Commissioning, ASoftwareInitThatTakesItsTimeIsCalledAgainUntilItIsDone) {
  probe.nodes[State::SoftwareInit].again = 3;
  const auto up = rig.set_state(State::PreOperational);
  rig.service();
  EXPECT_EQ(rig.state(), State::SoftwareInit);
  EXPECT_EQ(rig.outcome(up), "1 3");
  rig.settle();
  EXPECT_EQ(rig.outcome(up), "1 3 7");
  EXPECT_EQ(probe.nodes[State::SoftwareInit].calls, 4);
}

TEST_F(Commissioning, ADeviceThatSomebodyElseHoldsFailsTheConfigurationByItsName) {
  const auto held = rig.flows.open({Transfer::SharedMemory, "arm"}, FlowSide::Subsystem);
  ASSERT_TRUE(held);
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.configure_now(3), StartsWith("1 3 8:"));
  EXPECT_THAT(rig.explanations.back(), HasSubstr("device ARM"));
  EXPECT_EQ(rig.vital.configuration.load(), 0u);
  EXPECT_FALSE(rig.subsystem.cycle_demand().wanted);
}

TEST_F(Commissioning, SeveralTransientStatesAreDoneInOneStepOfTheServiceLoop) {
  const auto up = rig.set_state(State::PreOperational);
  rig.service();
  EXPECT_EQ(rig.state(), State::PreOperational);
  EXPECT_EQ(rig.outcome(up), "1 3 7");
  const auto down = rig.set_state(State::Offline);
  rig.service();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(rig.outcome(down), "1 3 7");
}

TEST_F(Commissioning, AChangeThatFindsNoRoomBeforeTheCycleIsHandedOverOnceThereIsSome) {
  rig.bring_to(State::SafeOperational);
  std::vector<testing::Sent> calls;
  for (int i = 0; i < 64; ++i) calls.push_back(rig.call("SET_GOAL", {0.5}));
  const auto up = rig.set_state(State::Operational);
  for (int i = 0; i < 3; ++i) rig.service();
  EXPECT_EQ(rig.outcome(up), "1 3");
  rig.settle();
  EXPECT_EQ(rig.outcome(up), "1 3 7");
  EXPECT_EQ(rig.state(), State::Operational);
  for (const auto& call : calls) EXPECT_EQ(rig.outcome(call), "1 3 7");
}

TEST_F(Commissioning, WhatFailedIsExplainedByNameOfSubsystemAndStateOrConfiguration) {
  probe.nodes[State::HardwareInit].fails = true;
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.explanations, ::testing::ElementsAre("PROBE: HardwareInit failed: planted"));
  probe.nodes[State::HardwareInit].fails = false;
  rig.set_state_now(State::PreOperational);
  probe.configure_fails = true;
  rig.configure_now(3);
  EXPECT_EQ(rig.explanations.back(), "PROBE: CONFIGURE WITH_ARM failed: planted");
  probe.configure_fails = false;
  EXPECT_EQ(rig.configure_now(3), "1 3 7") << "its devices were given back";
}

TEST_F(Commissioning, ErrorOperationalOverridesAChangeOnlyOnce) {
  rig.bring_to(State::Operational);
  rig.set_state(State::SafeOperational);
  const auto error = rig.set_state(State::ErrorOperational);
  const auto safe = rig.set_state(State::SafeOperational);
  rig.service();
  rig.service();
  EXPECT_EQ(rig.outcome(error), "1 3");
  EXPECT_EQ(rig.outcome(safe), busy);
  rig.settle();
  EXPECT_EQ(rig.outcome(error), "1 3 7");
}

TEST_F(Commissioning, NothingButErrorOperationalOverridesAChangeThatTheCycleHasNotConfirmed) {
  rig.bring_to(State::Operational);
  const auto first = rig.set_state(State::SafeOperational);
  rig.service();
  const auto again = rig.set_state(State::SafeOperational);
  rig.service();
  EXPECT_EQ(rig.outcome(again), busy);
  rig.settle();
  EXPECT_EQ(rig.outcome(first), "1 3 7");
}

TEST_F(Commissioning, AnotherConfigurationIsRefusedWhicheverOfThemStandsFirst) {
  rig.bring_to(State::PreOperational, 2);
  EXPECT_EQ(rig.configure_now(1), "1 4:01030000000001");
  EXPECT_EQ(rig.configure_now(3), "1 4:01030000000003");
}

TEST_F(Commissioning, AnInitialValueOfAWholeStructureSetsAllOfIt) {
  Probe author;
  Rig other{author, changed(R"(<Set parameter="KP" value="30"/>)", R"(<Set parameter="CUR_VALUES" value="7 0.25"/>)")};
  other.set_state_now(State::PreOperational);
  const auto configured = other.configure(2);
  other.service();
  EXPECT_EQ(other.outcome(configured), "1 3 7");
  EXPECT_EQ(author.current.load().state, 7);
  EXPECT_EQ(author.current.load().position, 0.25);
}

TEST_F(Commissioning, WhatAnAuthorPublishedIsThereUntilItsSoftwareDeinitIsDone) {
  rig.set_state_now(State::PreOperational);
  probe.nodes[State::SoftwareDeinit].again = 5;
  rig.set_state(State::Offline);
  rig.service();
  ASSERT_EQ(rig.state(), State::SoftwareDeinit);
  const auto reports_of_kp = [&] {
    std::array<std::byte, 5> data{};
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 2}.wire());
    rig.send(20, 1, data);
    rig.service();
    return rig.reports(20, 2).size();
  };
  EXPECT_EQ(reports_of_kp(), 1u);
  rig.settle();
  ASSERT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(reports_of_kp(), 1u) << "what is gone cannot be reported";
}

TEST_F(Commissioning, EachDeviceOfAConfigurationIsMissedByItsOwnEvent) {
  rig.bring_to(State::PreOperational, 3);
  rig.set_state(State::SafeOperational);
  rig.service();
  rig.advance(first_answer_limit + 1ms);
  rig.service();
  rig.cycle(20);
  rig.service();
  EXPECT_EQ(rig.heard(testing::arm_lost), 1);
  EXPECT_EQ(rig.heard(testing::lamp_lost), 1);
}

TEST_F(Commissioning, EachConfigurationIsAnotherGenerationOfTheCycle) {
  rig.bring_to(State::PreOperational);
  const auto first = rig.subsystem.cycle_demand().generation;
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  EXPECT_EQ(rig.subsystem.cycle_demand().generation, first + 1);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  EXPECT_EQ(rig.subsystem.cycle_demand().generation, first + 1) << "the same once more is none";
}

/// Leaves out what its descriptor lets it use.
struct ForgetfulProbe final : Probe {
  bool device{true};
  bool link{true};

 protected:
  Result<Step> software_init() override {
    publish("CUR_VALUES", current);
    publish("DES_POSITION", goal);
    publish("KP", kp);
    publish("KD", kd);
    publish("SEEN", seen);
    if (link) require_link("HAND", hand);
    if (device) use_device("ARM", arm);
    use_device("LAMP", lamp);
    use_event(own);
    on_function("SET_GOAL", [](double) -> Result<> { return ok(); });
    on_function("MOVE", [](Call) -> Outcome { return running; });
    return done;
  }
};

TEST_F(Commissioning, WithoutThePortsThatSomeConfigurationNeedsNoneIsReached) {
  for (const bool device : {true, false}) {
    ForgetfulProbe author;
    (device ? author.device : author.link) = false;
    Rig forgetful{author, probe_descriptor};
    EXPECT_THAT(forgetful.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
    EXPECT_EQ(forgetful.state(), State::Offline);
    EXPECT_FALSE(forgetful.subsystem.cycle_demand().wanted);
    EXPECT_THAT(forgetful.explanations.back(), HasSubstr(device ? "ARM" : "HAND"));
  }
}

TEST_F(Commissioning, AnInitialValueOfAMemberIsSetAndTheOthersStay) {
  Probe author;
  Rig other{author, changed(R"(<Set parameter="KP" value="30"/>)", R"(<Set parameter="CUR_VALUES.STATE" value="7"/>)")};
  other.set_state_now(State::PreOperational);
  const auto configured = other.configure(2);
  other.service();
  EXPECT_EQ(other.outcome(configured), "1 3 7");
  EXPECT_EQ(author.current.load().state, 7);
  EXPECT_EQ(author.current.load().position, 0.0);
}

TEST_F(Commissioning, WhatTheCycleNeverTookIsGivenBackWithItsConfiguration) {
  rig.bring_to(State::PreOperational, 2);
  static_cast<void>(
      rig.attach(1, pus::st128::Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}}));
  static_cast<void>(rig.detach(1));
  rig.service();
  const auto down = rig.set_state(State::PostOperational);
  rig.service();
  rig.subsystem.cycle_parked(rig.subsystem.cycle_demand().ticket);
  rig.settle();
  EXPECT_EQ(rig.outcome(down), "1 3 7");
  EXPECT_TRUE(rig.reports(1, 4).empty()) << "no telecommand of anybody was to be refused";
  EXPECT_EQ(rig.vital.configuration.load(), 0u);
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
}

TEST_F(Commissioning, AConfigurationIsGivenBackOnTheWayDownWhenItsCycleRestsAtLast) {
  rig.bring_to(State::SafeOperational);
  probe.nodes[State::HardwareDeinit].again = 5;
  const auto down = rig.set_state(State::Offline);
  rig.service();  // the cycle is told to rest, and hangs
  rig.advance(11s);
  rig.service();
  rig.service();
  EXPECT_EQ(rig.state(), State::HardwareDeinit);
  EXPECT_EQ(rig.vital.configuration.load(), 1u);
  rig.cycle();  // it rests
  rig.service();
  EXPECT_EQ(rig.state(), State::HardwareDeinit);
  EXPECT_EQ(rig.vital.configuration.load(), 0u);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.outcome(down), StartsWith("1 3 8:"));
}

TEST_F(Commissioning, ACycleThatEntersErrorOperationalBehindItsTimeIsBelievedAndLedOnFromThere) {
  rig.bring_to(State::Operational);
  const auto error = rig.set_state(State::ErrorOperational);
  rig.service();
  rig.advance(11s);
  rig.service();
  EXPECT_THAT(rig.outcome(error), StartsWith("1 3 8:0202"));
  rig.cycle();
  rig.service();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::ErrorOperational));
  EXPECT_THAT(rig.set_state_now(State::SafeOperational), StartsWith("1 4:000a"));
  EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
}

TEST_F(Commissioning, ACycleThatComesLateIntoAStateWhileAnotherWayIsUnderWayIsLedOnThatWay) {
  rig.bring_to(State::Operational);
  const auto safe = rig.set_state(State::SafeOperational);
  rig.service();
  rig.advance(11s);
  rig.service();  // its time is over: down to Error-Operational
  EXPECT_THAT(rig.outcome(safe), StartsWith("1 3 8:0202"));
  rig.forget_telemetry();
  rig.cycle();  // into both, one after the other
  rig.service();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.heard(descriptor::framework_event::state_changed), 1) << "it was on its way, and is nowhere else";
}

TEST_F(Commissioning, ACycleThatComesLateIntoAStateThatItHasEnteredSinceIsInItAlready) {
  rig.bring_to(State::Operational);
  rig.set_state(State::ErrorOperational);
  rig.service();
  rig.advance(11s);
  rig.service();
  const auto again = rig.set_state(State::ErrorOperational);
  rig.service();
  rig.forget_telemetry();
  rig.cycle();  // twice, as it was told
  rig.service();
  EXPECT_EQ(rig.outcome(again), "7");
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.heard(descriptor::framework_event::state_changed), 1);
}

/// It had looked whether it is wanted, and goes through one more cycle.
TEST_F(Commissioning, ACycleThatComesLateIntoAStateAndWasToRestMeanwhileLeadsNobodyBackThere) {
  rig.bring_to(State::SafeOperational);
  rig.set_state(State::ErrorOperational);
  rig.service();
  rig.advance(11s);
  rig.service();
  rig.set_state(State::Offline);
  rig.service();
  rig.advance(11s);
  rig.service();
  rig.service();
  ASSERT_EQ(rig.state(), State::Offline);
  rig.forget_telemetry();
  static_cast<void>(rig.subsystem.cycle_step(rig.clock.now()));
  rig.service();
  rig.cycle();  // it rests
  rig.service();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(rig.heard(descriptor::framework_event::state_changed), 0);
  EXPECT_EQ(rig.vital.configuration.load(), 0U);
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::Offline));
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
}

/// The reader of descriptors refuses it; of one that is built in code the flows say whether there is such a thing.
TEST_F(Commissioning, AMeansOfTransferThatIsNotBuiltInTakesNoPortOfTheComputer) {
  ASSERT_EQ(find_flow_means(Transfer::Ethercat), nullptr) << "take another one here";
  Probe author;
  auto described = testing::read_descriptor(probe_descriptor);
  for (auto& use : described.configurations[2].devices) use.endnode.transfer = Transfer::Ethercat;
  Rig other{author, std::move(described)};
  other.bring_to(State::PreOperational, 3);
  EXPECT_EQ(other.vital.configuration.load(), 3U);
  EXPECT_EQ(other.subsystem.meter().ports().used(), 0U);
}

TEST_F(Commissioning, EachCycleCountsInParametersThatNoDescriptorDeclares) {
  Probe author;
  Rig other{author,
            changed("  <Configuration name=\"COUPLED\"", R"(  <Configuration name="COUNTING" id="9" sampling_us="500">
    <HKService id="257" interval="10"><SampledOnce><ParamRef name="CYCLE_TIMES"/></SampledOnce></HKService>
    <HKService id="258" interval="10">
      <SampledOnce><ParamRef name="CYCLE_STATS"/><ParamRef name="LINK_STATS"/></SampledOnce>
    </HKService>
  </Configuration>
  <Configuration name="COUPLED")")};
  other.bring_to(State::SafeOperational, 9);
  for (int i = 0; i < 4; ++i) {
    other.cycle(10);
    other.service();
  }
  std::vector<std::uint32_t> cycles;
  for (const std::string& report : other.reports(3, 25)) {
    if (!report.starts_with("0101")) {
      EXPECT_EQ(report.size(), 2 * (2U + 3 * 4 + 2 * 4)) << "id, CYCLE_STATS, LINK_STATS";
      continue;
    }
    std::uint32_t sum = 0;
    for (std::size_t bin = 0; bin < 16; ++bin)
      sum += static_cast<std::uint32_t>(std::stoul(report.substr(4 + 8 * bin, 8), nullptr, 16));
    cycles.push_back(sum);
  }
  ASSERT_GE(cycles.size(), 3U);
  for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_EQ(cycles[i], cycles[i - 1] + 10);
}

/// Names what its descriptor does not declare, twice.
struct Mistaken final : Probe {
  bool mistaken{true};

 protected:
  Result<Step> software_init() override {
    if (mistaken)
      for (const char* name : {"NOBODY", "KNOWS"}) publish(name, spare);
    return Probe::software_init();
  }
  Parameter<double> spare;
};

/// Nobody listens to explanations: what fails fails all the same.
TEST_F(Commissioning, FailuresAreReportedThoughNobodyWantsTheirExplanation) {
  Mistaken author;
  ChannelPair channels{4096};
  VitalPage vital{};
  PermitPage permit{};
  GenericSubsystem quiet{author,
                         testing::read_descriptor(probe_descriptor),
                         {.clock = rig.clock, .memory = rig.memory, .flows = rig.flows},
                         channels.subsystem_end(),
                         vital,
                         permit};
  const auto call = [&](const char* function, double argument) {
    std::array<std::byte, 64> buffer{};
    const auto functions = pus::common_functions();
    const auto data =
        pus::encode_call(*std::ranges::find(functions, function, &descriptor::Function::name), std::array{argument});
    const auto packet = pus::write_telecommand(
        buffer, {.apid = 10, .sequence_count = 1, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = 7}, *data);
    ASSERT_TRUE(channels.supervisor_end().send({.packet = packet.value(), .memory = {}}));
    for (int i = 0; i < 5; ++i) static_cast<void>(quiet.service_step(rig.clock.now()));
  };
  call("SET_STATE", static_cast<double>(State::PreOperational));
  EXPECT_EQ(quiet.state(), State::Offline);
  author.mistaken = false;
  author.configure_fails = true;
  call("SET_STATE", static_cast<double>(State::PreOperational));
  EXPECT_EQ(quiet.state(), State::PreOperational);
  call("CONFIGURE", 1);
  EXPECT_EQ(vital.configuration.load(), 0u);
}

}  // namespace
}  // namespace hirosco
