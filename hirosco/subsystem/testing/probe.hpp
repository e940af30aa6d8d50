// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

/// A subsystem that does what a test tells it: one joint, one input link, one actuator, one lamp.
namespace hirosco::testing {

/// Numbers of the events that the framework gives the probe.
inline constexpr std::uint16_t arm_lost = descriptor::framework_event::device_lost(0);
inline constexpr std::uint16_t lamp_lost = descriptor::framework_event::device_lost(1);
inline constexpr std::uint16_t hand_stale = descriptor::framework_event::set_stale(0);

/// Listings 1 and 2 of the paper stand in it character for character.
inline const std::string probe_descriptor = R"(<Subsystem name="PROBE" id="10">
  <Parameters>
<StructRef name="CUR_VALUES" id="0" type="STRUCT">
  <ParamRef name="STATE" id="0" type="INT32" />
  <ParamRef name="POSITION" id="0" type="DOUBLE" />
</StructRef>

<ParamRef name="DES_POSITION" id="1" type="DOUBLE" />
    <ParamRef name="KP" id="2" type="DOUBLE" init="3" minimum="0" maximum="100" writable="PreOperational SafeOperational Operational"/>
    <ParamRef name="KD" id="3" type="DOUBLE" init="4" minimum="0" maximum="100" writable="PreOperational SafeOperational Operational"/>
    <ParamRef name="SEEN" id="4" type="DOUBLE"/>
  </Parameters>
  <EventService>
    <Event name="LAMP_LOST" severity="low"/>
    <Event name="OWN" id="7" severity="low"><Argument name="VALUE" type="DOUBLE"/></Event>
  </EventService>
  <FunctionService>
    <Function name="SET_GOAL" states="SafeOperational Operational"><Argument name="GOAL" type="DOUBLE" minimum="-2" maximum="2"/></Function>
    <Function name="MOVE" states="Operational"/>
  </FunctionService>
  <Device name="ARM" actuator="yes">
    <Input><Field name="ANGLE" type="DOUBLE"/></Input>
    <Output><Field name="TORQUE" type="DOUBLE" safe="-1"/></Output>
  </Device>
  <Device name="LAMP">
    <Input><Field name="LIT" type="UINT8"/></Input>
    <Output><Field name="LIT" type="UINT8"/></Output>
  </Device>
  <Configuration name="ALONE" id="1" priority="80" sampling_us="500">
<HKService id="4711" interval="500">
  <SampledOnce>
    <ParamRef name="CUR_VALUES" />
  </SampledOnce>
  <SampledNREPTimes nrep="5">
    <ParamRef name="DES_POSITION" />
  </SampledNREPTimes>
</HKService>
  </Configuration>
  <Configuration name="COUPLED" id="2" priority="70" sampling_us="1000" budget_us="250" overruns="3" overruns_reduced="5">
    <RealTimeLinkService>
      <Provides name="ARM_STATE"><ParamRef name="CUR_VALUES.POSITION"/><ParamRef name="SEEN"/></Provides>
      <Requires name="HAND" age="3" age_reduced="10" missing="inhibit">
        <Field name="ANGLE" type="DOUBLE"/>
        <Field name="ENABLE" type="UINT8"/>
      </Requires>
    </RealTimeLinkService>
    <Set parameter="KP" value="30"/>
  </Configuration>
  <Configuration name="WITH_ARM" id="3" priority="60" sampling_us="2000">
    <Device name="ARM" silence="3" silence_reduced="40"><Endnode transfer="shared_memory" address="arm"/></Device>
    <Device name="LAMP"><Endnode transfer="shared_memory" address="lamp"/></Device>
  </Configuration>
</Subsystem>
)";

class Probe : public Subsystem {
 public:
  struct CurrentValues {
    std::int32_t state;
    double position;
  };
  struct Hand {
    double angle;
    std::uint8_t enable;
  };
  struct Angle {
    double angle;
  };
  struct Torque {
    double torque;
  };
  struct Lit {
    std::uint8_t lit;
  };

  /// What the next calls of a node are to do: fail, or say `again` so often.
  struct Node {
    bool fails{false};
    int again{0};
    int calls{0};
  };
  std::map<State, Node> nodes;
  bool configure_fails{false};
  bool inhibits{false};
  std::function<void()> in_node;  ///< called first in each node
  bool raises{false};
  Cycle last{};
  std::optional<Call> move;
  std::optional<std::uint16_t> step_due;
  std::optional<std::uint16_t> failed_step_due;
  bool finish_due{false};
  std::vector<std::pair<double, double>> gains_seen;  ///< KP and KD of every cycle, where a test asks for them
  bool record_gains{false};

  Parameter<CurrentValues> current;
  Parameter<double> goal, kp, kd, seen;
  LinkInput<Hand> hand;
  Event<double> own{"OWN"};
  DevicePort<Angle, Torque> arm;
  DevicePort<Lit, Lit> lamp;

 protected:
  Result<Step> software_init() override {
    const auto step = run(State::SoftwareInit);
    if (!step || *step == again) return step;
    publish("CUR_VALUES", current);
    publish("DES_POSITION", goal);
    publish("KP", kp);
    publish("KD", kd);
    publish("SEEN", seen);
    require_link("HAND", hand);
    use_event(own);
    use_device("ARM", arm);
    use_device("LAMP", lamp);
    on_function("SET_GOAL", [this](double value) -> Result<> {
      if (value > 1.5) return fail(ErrorCode::OutOfRange, "joint limit");
      goal.store(value);
      return ok();
    });
    on_function("MOVE", [this](Call call) -> Outcome {
      if (move) return refused(pus::FailureCode::Busy);
      move = call;
      return running;
    });
    return done;
  }
  Result<Step> hardware_init() override { return run(State::HardwareInit); }
  Result<> configure(const descriptor::Configuration&) override {
    return configure_fails ? fail(ErrorCode::Unavailable, "planted") : ok();
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override { return work(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return work(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return work(cycle); }
  Result<> error_operational(const Cycle& cycle) noexcept override { return work(cycle); }
  Result<Step> post_operational() override { return run(State::PostOperational); }
  Result<Step> hardware_deinit() override { return run(State::HardwareDeinit); }
  Result<Step> software_deinit() override { return run(State::SoftwareDeinit); }

  /// In every state the author wants full torque and light: what reaches the device is the framework's business.
  virtual Result<> work(const Cycle& cycle) noexcept {
    if (in_node) in_node();
    last = cycle;
    arm.output().torque = 5.0;
    lamp.output().lit = 1;
    current.store({static_cast<std::int32_t>(cycle.state), 0.25 * static_cast<double>(cycle.count)});
    if (record_gains) gains_seen.emplace_back(kp.load(), kd.load());
    if (inhibits) inhibit_actuators();
    if (raises) raise(own, 2.5);
    if (move && step_due) progress(*move, *step_due);
    step_due.reset();
    if (move && failed_step_due) progress_failed(*move, *failed_step_due, {ErrorCode::Unavailable, "wet", 42});
    failed_step_due.reset();
    if (move && finish_due) {
      finish(*move);
      move.reset();
    }
    Node& node = nodes[cycle.state];
    ++node.calls;
    return node.fails ? fail(ErrorCode::Internal, "planted") : ok();
  }

 private:
  Result<Step> run(State state) {
    Node& node = nodes[state];
    ++node.calls;
    if (node.fails) return fail(ErrorCode::Unavailable, "planted");
    if (node.again == 0) return done;
    --node.again;
    return again;
  }
};

}  // namespace hirosco::testing
