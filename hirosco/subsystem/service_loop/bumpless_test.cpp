// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/parameter/number.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// One configuration follows another while the subsystem acts.
namespace hirosco {
namespace {

using ::testing::HasSubstr;
using testing::Rig;
using testing::Sent;

constexpr double step_bound = 0.05;

constexpr const char* joint_descriptor = R"(<Subsystem name="JOINT" id="10">
  <ParamRef name="KP" id="0" type="DOUBLE" init="1" minimum="0" maximum="100"
            writable="PreOperational SafeOperational Operational"/>
  <ParamRef name="TITLE" id="1" type="TEXT" octets="8" init="none"/>
  <FunctionService><Function name="NUDGE" states="SafeOperational Operational"/></FunctionService>
  <Device name="MOTOR" actuator="yes">
    <Input><Field name="ANGLE" type="DOUBLE"/></Input>
    <Output><Field name="TORQUE" type="DOUBLE" safe="0"/></Output>
  </Device>
  <Configuration name="SOFT" id="1" sampling_us="1000" priority="40" budget_us="100" self_test="optional">
    <Set parameter="KP" value="2"/><Set parameter="TITLE" value="soft"/>
    <Device name="MOTOR" silence="1000" watchdog_ms="50"><Endnode transfer="shared_memory" address="motor"/></Device>
    <HKService id="1" interval="4"><SampledOnce><ParamRef name="KP"/></SampledOnce></HKService>
  </Configuration>
  <Configuration name="STIFF" id="2" sampling_us="500" priority="60" budget_us="200">
    <Set parameter="KP" value="9"/><Set parameter="TITLE" value="stiff"/>
    <Device name="MOTOR" silence="1000" watchdog_ms="50"><Endnode transfer="shared_memory" address="motor"/></Device>
    <HKService id="2" interval="4"><SampledOnce><ParamRef name="KP"/></SampledOnce></HKService>
  </Configuration>
  <Configuration name="OTHER" id="3" sampling_us="1000"/>
  <Bumpless between="SOFT STIFF"><Step device="MOTOR" output="TORQUE" most="0.05"/></Bumpless>
</Subsystem>)";

/// A spring to a goal that moves. What it puts out goes on where the gain changes, as the offset takes the difference over.
struct Joint final : Subsystem {
  struct Angle {
    double angle;
  };
  struct Torque {
    double torque;
  };
  Parameter<double> kp;
  Parameter<Text<8>> title;
  DevicePort<Angle, Torque> motor;
  double error{0.3}, offset{0}, torque{0};
  double jump{0};  ///< planted
  bool refuses{false};
  bool inhibits{false};
  bool tries{false};  ///< its self test goes on
  int nudges{0};
  int hooks{0}, configured{0};
  Cycle seen{}, of_hook{};
  double kp_in_hook{0};

  Result<Step> software_init() override {
    publish("KP", kp);
    publish("TITLE", title);
    use_device("MOTOR", motor);
    on_function("NUDGE", [this]() -> Result<> {
      ++nudges;
      return ok();
    });
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    ++configured;
    return ok();
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle& cycle) noexcept override {
    ++hooks;
    of_hook = cycle;
    kp_in_hook = kp.load();
    if (refuses) return fail(ErrorCode::NotPermitted, "not on the move", 3);
    offset = torque - kp.load() * error + jump;
    return ok();
  }
  Result<> work(const Cycle& cycle) noexcept {
    seen = cycle;
    error = 0.3 * std::sin(0.01 * static_cast<double>(++time));
    torque = kp.load() * error + offset;
    motor.output().torque = torque;
    if (inhibits) inhibit_actuators();
    return ok();
  }
  Result<Step> self_test(const Cycle&) noexcept override { return tries ? again : done; }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return work(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return work(cycle); }
  std::uint64_t time{0};
};

struct BumplessChange : ::testing::Test {
  explicit BumplessChange(descriptor::SubsystemDescriptor described = testing::read_descriptor(joint_descriptor))
      : rig{author, std::move(described)} {}

  Joint author;
  Rig rig;
  std::array<std::byte, max_device_frame_octets> frame{};
  std::unique_ptr<DataFlow> motor =
      std::move(rig.flows.open({Transfer::SharedMemory, "motor"}, FlowSide::Device)).value();

  /// One cycle, and what the motor is told in it; it answers.
  DeviceCommand cycle() {
    rig.cycle();
    const auto received = motor->receive(frame).value();
    const DeviceCommand command = read_command(Octets{frame}.first(received.octets)).value();
    std::array<std::byte, max_device_frame_octets> buffer{};
    const std::array<std::byte, 8> angle{};
    static_cast<void>(motor->send(
        write_status(buffer, {.epoch = command.epoch, .sequence = command.sequence, .payload = angle}).value()));
    return command;
  }
  /// Its silence is long: one answer keeps it alive through a test.
  void bring_up(State state) {
    rig.bring_to(State::PreOperational);
    cycle();
    cycle();
    ASSERT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
    if (state == State::Operational) {
      ASSERT_EQ(rig.set_state_now(State::Operational), "1 3 7");
    }
    ASSERT_EQ(rig.inhibited(), 0U);
  }
  static double torque_of(const DeviceCommand& command) {
    OctetReader reader{command.payload, std::endian::little};
    return get_number(reader, Type::Double);
  }
  std::uint8_t in_force() const { return static_cast<std::uint8_t>(rig.vital.configuration.load()); }
  Sent self_test() { return rig.send(17, 128, {}); }
  /// Outcome and configuration.
  std::string newest_self_test() {
    static_cast<void>(rig.send(17, 130, {}));
    rig.settle();
    return rig.reports(17, 129).back().substr(0, 4);
  }
  /// Whether one may go on to be commanded: it is switched on where it was on.
  std::string switch_housekeeping(std::uint16_t structure) {
    std::array<std::byte, 3> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(structure);
    const Sent sent = rig.send(3, 5, data);
    rig.settle();
    return rig.outcome(sent);
  }
  void expect_untouched() {
    EXPECT_EQ(in_force(), 1);
    EXPECT_EQ(author.kp.load(), 2.0);
    EXPECT_EQ(author.title.load().view(), "soft");
    EXPECT_EQ(rig.subsystem.cycle_demand().period, 1ms);
    rig.forget_telemetry();
    rig.settle();
    EXPECT_EQ(rig.reports(3, 25).empty(), false);
    for (const auto& report : rig.reports(3, 25)) EXPECT_EQ(report.substr(0, 4), "0001");
  }
};

TEST_F(BumplessChange, TenTimesInMotionMovesNoOutputFurtherThanItsStepAndMissesNoCycle) {
  bring_up(State::Operational);
  const std::uint64_t before = rig.vital.cycles.load();
  std::uint64_t cycles = 0;
  double last = torque_of(cycle());
  ++cycles;
  for (int round = 0; round < 10; ++round) {
    const std::uint8_t id = round % 2 == 0 ? 2 : 1;
    const Sent sent = rig.configure(id);
    rig.service();
    EXPECT_EQ(rig.outcome(sent), "1 3") << "the cycle takes it over";
    for (int i = 0; i < 30; ++i) {
      const DeviceCommand command = cycle();
      ++cycles;
      EXPECT_EQ(command.mode, DeviceMode::Active) << "no interruption of the output";
      EXPECT_LE(std::abs(torque_of(command) - last), step_bound);
      last = torque_of(command);
    }
    rig.service();
    EXPECT_EQ(rig.outcome(sent), "1 3 7");
    EXPECT_EQ(in_force(), id);
  }
  EXPECT_EQ(author.hooks, 10);
  EXPECT_EQ(author.configured, 1) << "configure() is of Pre-Operational";
  EXPECT_EQ(rig.vital.cycles.load() - before, cycles);
  EXPECT_EQ(rig.state(), State::Operational);
}

TEST_F(BumplessChange, TakesPeriodPriorityBudgetValuesAndHousekeepingAtOneBoundary) {
  bring_up(State::Operational);
  const auto before = rig.subsystem.cycle_demand();
  EXPECT_EQ(before.period, 1ms);
  EXPECT_EQ(before.priority, 40);
  static_cast<void>(rig.configure(2));
  rig.service();
  EXPECT_EQ(rig.subsystem.cycle_demand().period, 1ms) << "not before the boundary";
  EXPECT_EQ(author.kp.load(), 2.0);
  const TimePoint planned = rig.clock.now() + 1ms;
  rig.clock.set(planned);
  EXPECT_EQ(rig.subsystem.cycle_step(planned), planned + 500us);
  const auto after = rig.subsystem.cycle_demand();
  EXPECT_EQ(after.period, 500us);
  EXPECT_EQ(after.priority, 60);
  EXPECT_EQ(after.generation, before.generation) << "the thread of the cycle goes on";
  EXPECT_EQ(author.kp_in_hook, 9.0) << "the hook sees the new values";
  EXPECT_EQ(author.of_hook.period, 500us);
  EXPECT_EQ(author.seen.period, 500us);
  EXPECT_FALSE(author.seen.first);
  EXPECT_EQ(author.title.load().view(), "stiff");
  EXPECT_EQ(rig.vital.period_ns.load(), 500'000U);
  CycleBudget budget{};
  ASSERT_TRUE(rig.subsystem.cycle().budget().snapshot(budget));
  EXPECT_EQ(budget.budget_us, 200.0F) << "held against the budget of this configuration";
  rig.forget_telemetry();
  rig.settle();
  ASSERT_FALSE(rig.reports(3, 25).empty());
  for (const auto& report : rig.reports(3, 25)) EXPECT_EQ(report.substr(0, 4), "0002");
}

TEST_F(BumplessChange, OfAPlantedJumpReachesNoActuator) {
  bring_up(State::Operational);
  const double last = torque_of(cycle());
  author.jump = 0.06;
  const Sent sent = rig.configure(2);
  rig.service();
  const DeviceCommand command = cycle();
  EXPECT_NE(command.mode, DeviceMode::Active);
  EXPECT_EQ(torque_of(command), 0.0) << "the declared safe value";
  EXPECT_GT(std::abs(author.torque - last), step_bound);
  rig.settle();
  EXPECT_THAT(rig.outcome(sent), HasSubstr("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.heard(descriptor::framework_event::configuration_failed), 1);
}

TEST_F(BumplessChange, IsAsNothingWhenTheAuthorRefusesIt) {
  bring_up(State::Operational);
  author.refuses = true;
  EXPECT_THAT(rig.configure_now(2), HasSubstr("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Operational);
  expect_untouched();
  author.refuses = false;
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
}

TEST_F(BumplessChange, IsRefusedWhereTheActuatorsAreInhibitedOrTheGuardHasStoppedThem) {
  bring_up(State::Operational);
  rig.permit.fence();
  EXPECT_EQ(rig.configure_now(2), "1 4:010700");
  EXPECT_EQ(author.hooks, 0);
  expect_untouched();
}

TEST_F(BumplessChange, ThatAFenceOvertakesOnItsWayToTheCycleIsNone) {
  bring_up(State::Operational);
  const Sent sent = rig.configure(2);
  rig.service();
  rig.permit.fence();
  rig.settle();
  EXPECT_THAT(rig.outcome(sent), HasSubstr("1 3 8:0202"));
  EXPECT_EQ(author.hooks, 0);
  EXPECT_EQ(in_force(), 1);
}

TEST_F(BumplessChange, IsForConfigurationsThatAreDeclaredCompatibleInTheStatesOfControl) {
  bring_up(State::Operational);
  EXPECT_EQ(rig.configure_now(3), "1 4:000a05") << "not declared";
  EXPECT_EQ(rig.configure_now(1), "1 4:000a05") << "in force already";
  EXPECT_EQ(rig.configure_now(9), "1 4:000a05") << "there is none of that number";
  expect_untouched();
  rig.set_state_now(State::ErrorOperational);
  EXPECT_EQ(rig.configure_now(2), "1 4:000a06");
}

TEST_F(BumplessChange, GoesInSafeOperationalToo) {
  bring_up(State::SafeOperational);
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
  EXPECT_EQ(in_force(), 2);
}

/// Else what is set could be told before a configuration whose value it has outlived, or behind one that has overwritten it.
TEST_F(BumplessChange, LetsNoValueBeSetUntilItHasEnded) {
  bring_up(State::SafeOperational);
  const auto set = [&](double value) {
    std::array<std::byte, 13> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 0}.wire()).put(value);
    return rig.send(20, 3, data);
  };
  const auto outcome_of = [&](Sent sent) {
    rig.settle();
    return rig.outcome(sent);
  };
  const Sent before = set(5), configured = rig.configure(2), behind = set(6);
  rig.service();
  EXPECT_EQ(rig.outcome(before), "1 3 7");
  EXPECT_EQ(rig.outcome(behind), "1 4:0108");
  cycle();
  EXPECT_EQ(author.kp.load(), 9.0);
  EXPECT_EQ(outcome_of(configured), "1 3 7");
  EXPECT_EQ(outcome_of(set(7)), "1 3 7");
  EXPECT_EQ(author.kp.load(), 7.0);
  author.refuses = true;
  EXPECT_THAT(rig.configure_now(1), HasSubstr("1 3 8:0202"));
  EXPECT_EQ(outcome_of(set(8)), "1 3 7") << "one that was refused has ended, too";
  static_cast<void>(rig.configure(1));
  rig.service();
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(outcome_of(set(9)), "1 3 7") << "and one that a way down overtook";
}

TEST_F(BumplessChange, IsOneAtATimeAndEndsWhateverBecomesOfTheCycle) {
  bring_up(State::Operational);
  const Sent first = rig.configure(2), second = rig.configure(2);
  rig.service();
  EXPECT_EQ(rig.outcome(second), "1 4:0108");
  rig.advance(9900ms);
  rig.service();
  EXPECT_EQ(rig.outcome(first), "1 3") << "it has ten seconds";
  rig.advance(200ms);
  rig.service();
  EXPECT_EQ(rig.outcome(first), "1 3 8:0203") << "the cycle stands";
  rig.cycle();
  rig.service();
  EXPECT_EQ(in_force(), 2) << "what the cycle takes in the end is in force, and known to be";
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  const Sent overtaken = rig.configure(2);
  rig.service();
  rig.set_state_now(State::PostOperational);
  EXPECT_THAT(rig.outcome(overtaken), ::testing::AnyOf(HasSubstr("7"), HasSubstr("8:0204")));
}

TEST_F(BumplessChange, IsRefusedWhereThePermissionIsWithdrawnThoughNoStopIsSet) {
  bring_up(State::Operational);
  rig.permit.go.store(0);
  ASSERT_EQ(rig.inhibited(), 0U) << "no cycle has seen it yet";
  const Sent sent = rig.configure(2);
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 4:010700");
  EXPECT_EQ(author.hooks, 0);
  expect_untouched();
}

TEST_F(BumplessChange, IsRefusedWhereItsAuthorHasInhibitedTheActuatorsThoughTheGuardPermits) {
  bring_up(State::Operational);
  author.inhibits = true;
  cycle();
  ASSERT_NE(rig.inhibited(), 0U);
  EXPECT_EQ(rig.configure_now(2), "1 4:010700");
  EXPECT_EQ(author.hooks, 0);
  expect_untouched();
}

TEST_F(BumplessChange, WaitsForTheEndOfASelfTest) {
  bring_up(State::SafeOperational);
  author.tries = true;
  const Sent test = self_test();
  EXPECT_EQ(rig.configure_now(2), "1 4:0108");
  EXPECT_EQ(author.hooks, 0);
  author.tries = false;
  rig.settle();
  EXPECT_EQ(rig.outcome(test), "1 3 7");
  expect_untouched();
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
}

/// Else it would be told of under the configuration before, and forgotten when the other one is known to be in force.
TEST_F(BumplessChange, LetsNoSelfTestBeginUntilItHasEnded) {
  bring_up(State::SafeOperational);
  const Sent configured = rig.configure(2), early = self_test();
  rig.service();
  EXPECT_EQ(rig.outcome(early), "1 4:0108");
  rig.settle();
  EXPECT_EQ(rig.outcome(configured), "1 3 7");
  EXPECT_EQ(newest_self_test(), "0002") << "none has run in it";
  const Sent test = self_test();
  rig.settle();
  EXPECT_EQ(rig.outcome(test), "1 3 7");
  EXPECT_EQ(newest_self_test(), "0102") << "passed, in configuration 2";
}

TEST_F(BumplessChange, ThatFindsNoRoomOnItsWayToTheCycleIsRefusedAndIsInNobodysWay) {
  bring_up(State::Operational);
  std::vector<Sent> before;
  for (std::uint32_t i = 0; i < descriptor::Queues{}.commands; ++i) {
    before.push_back(rig.call("NUDGE"));
    rig.service();
  }
  const Sent refused = rig.configure(2);
  rig.service();
  EXPECT_EQ(rig.outcome(refused), "1 4:000b");
  rig.settle();
  for (const Sent& each : before) EXPECT_EQ(rig.outcome(each), "1 3 7");
  EXPECT_EQ(author.nudges, static_cast<int>(before.size()));
  EXPECT_EQ(author.hooks, 0);
  expect_untouched();
  EXPECT_EQ(switch_housekeeping(1), "1 3 7") << "it waits for no change";
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
}

/// STIFF offers no housekeeping.
struct BumplessChangeToSilence : BumplessChange {
  BumplessChangeToSilence() : BumplessChange{testing::read_descriptor(described())} {}
  static std::string described() {
    std::string text = joint_descriptor;
    const std::string of_stiff =
        R"(<HKService id="2" interval="4"><SampledOnce><ParamRef name="KP"/></SampledOnce></HKService>)";
    return text.replace(text.find(of_stiff), of_stiff.size(), R"(<Service name="ST03" offered="no"/>)");
  }
};

TEST_F(BumplessChangeToSilence, EndsTheHousekeepingThatTheOtherConfigurationDoesNotOfferAndBringsItBack) {
  bring_up(State::Operational);
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
  rig.forget_telemetry();
  rig.settle();
  EXPECT_TRUE(rig.reports(3, 25).empty());
  EXPECT_EQ(switch_housekeeping(1), "2:000603") << "no such service";
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  expect_untouched();
  EXPECT_EQ(switch_housekeeping(1), "1 3 7");
}

/// A descriptor that no reader of descriptors has looked at: STIFF reports more often than there are cycles.
struct BumplessChangeToNonsense : BumplessChange {
  BumplessChangeToNonsense() : BumplessChange{described()} {}
  static descriptor::SubsystemDescriptor described() {
    auto made = testing::read_descriptor(joint_descriptor);
    made.configurations[1].housekeeping[0].interval_cycles = 0;
    return made;
  }
};

TEST_F(BumplessChangeToNonsense, IsAsNothingWhenItsHousekeepingCannotBeMade) {
  bring_up(State::Operational);
  EXPECT_THAT(rig.configure_now(2), HasSubstr("1 3 8:0202"));
  EXPECT_EQ(rig.heard(descriptor::framework_event::configuration_failed), 1);
  EXPECT_EQ(author.hooks, 0) << "the cycle never heard of it";
  EXPECT_EQ(rig.state(), State::Operational);
  expect_untouched();
  EXPECT_EQ(switch_housekeeping(1), "1 3 7");
}

}  // namespace
}  // namespace hirosco
