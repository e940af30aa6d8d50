// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/greedy.hpp"

#include <limits>

namespace hirosco::testing {
namespace {

constexpr auto mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="GREEDY">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/greedy.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  <Subsystem executable="greedy" descriptor="greedy.xml"/>
  <SimulatedDevice name="motor" executable="motor" subsystem="GREEDY" device="MOTOR" seed="1"/>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="GREEDY" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
      <Permit subsystem="*" services="3 5 17 20"/>
    </Mode>
  </Modes>
  <Recovery>
    <Plan name="network-down"><When severity="high"/><Do action="shut_down_network"/></Plan>
    <Plan name="to-safe"><When severity="medium"/><Do action="set_state" state="SafeOperational"/></Plan>
    <Plan name="note"><When severity="low info"/><Do action="log"/></Plan>
  </Recovery>
</Mission>
)";

constexpr auto subsystem_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="GREEDY" id="20">
  <Parameters><ParamRef name="RUNS" id="0" type="UINT32"/></Parameters>
  <EventService>
    <Event name="TROUBLE" id="2010" severity="medium"/>
    <Event name="MORE_TROUBLE" id="2011" severity="medium"/>
    <Event name="REMARK" id="2012" severity="low"/>
  </EventService>
  <FunctionService>
    <Function name="TWO_TROUBLES" states="Operational"/>
    <Function name="REMARK" states="Operational"/>
  </FunctionService>
  <TestService/>
  <Device name="MOTOR" actuator="yes">
    <Input><Field name="ANGLE" type="DOUBLE" unit="rad"/></Input>
    <Output><Field name="TORQUE" type="DOUBLE" unit="N m" safe="-1"/></Output>
  </Device>
  <Configuration name="NOMINAL" id="1" priority="80" sampling_us="1000">
    <HKService id="4741" interval="10"><SampledOnce><ParamRef name="RUNS"/></SampledOnce></HKService>
    <Device name="MOTOR" silence="3" silence_reduced="40" watchdog_ms="10" watchdog_reduced_ms="50">
      <Endnode transfer="shared_memory" address="greedy-motor" byte_order="little"/>
    </Device>
  </Configuration>
</Subsystem>
)";

class Greedy final : public Subsystem {
 public:
  explicit Greedy(GreedyTrace& trace) : trace_{trace} {}

 private:
  struct Angle {
    double rad;
  };
  struct Torque {
    double n_m;
  };

  void grab(State node) noexcept {
    trace_.node = node;
    ++trace_.node_runs[static_cast<std::size_t>(node)];
    motor_.output().n_m = greedy_torque;
  }
  /// Transient nodes take several phases, so that there is time to look.
  static constexpr int phases = 20;
  Result<Step> grab_in_phases(State node) {
    grab(node);
    return trace_.node_runs[static_cast<std::size_t>(node)] % phases == 0 ? done : again;
  }

  Result<> offline() override {
    grab(State::Offline);
    return ok();
  }
  Result<Step> software_init() override {
    constexpr auto own = static_cast<std::size_t>(State::SoftwareInit);
    if (trace_.node_runs[own] % phases == 0) introduce();
    return grab_in_phases(State::SoftwareInit);
  }
  void introduce() {
    publish("RUNS", runs_);
    use_device("MOTOR", motor_);
    use_event(trouble_);
    use_event(more_trouble_);
    use_event(remark_);
    on_function("TWO_TROUBLES", [this]() -> Outcome {
      raise(trouble_);
      raise(more_trouble_);
      return ok();
    });
    on_function("REMARK", [this]() -> Outcome {
      raise(remark_);
      return ok();
    });
  }
  Result<Step> hardware_init() override { return grab_in_phases(State::HardwareInit); }
  Result<> configure(const descriptor::Configuration&) override {
    grab(State::PreOperational);
    trace_.configured = true;
    return ok();
  }
  Result<> pre_operational(const Cycle&) noexcept override { return grab_in_cycle(State::PreOperational); }
  Result<> safe_operational(const Cycle&) noexcept override { return grab_in_cycle(State::SafeOperational); }
  Result<> operational(const Cycle&) noexcept override { return grab_in_cycle(State::Operational); }
  Result<> error_operational(const Cycle&) noexcept override { return grab_in_cycle(State::ErrorOperational); }
  Result<Step> post_operational() override { return grab_in_phases(State::PostOperational); }
  Result<Step> hardware_deinit() override { return grab_in_phases(State::HardwareDeinit); }
  Result<Step> software_deinit() override { return grab_in_phases(State::SoftwareDeinit); }

  Result<> grab_in_cycle(State node) noexcept {
    grab(node);
    runs_.store(runs_.load() + 1);
    return ok();
  }

  GreedyTrace& trace_;
  Event<> trouble_{"TROUBLE"};
  Event<> more_trouble_{"MORE_TROUBLE"};
  Event<> remark_{"REMARK"};
  Parameter<std::uint32_t> runs_;
  DevicePort<Angle, Torque> motor_;
};

/// The flow of the motor, with everything that comes along it noted whatever its mode.
class TappedFlow final : public DataFlow {
 public:
  TappedFlow(std::unique_ptr<DataFlow> inner, GreedyTrace& trace) : inner_{std::move(inner)}, trace_{trace} {}

 private:
  Result<> do_send(Octets frame) noexcept override { return inner_->send(frame); }
  Result<Received> do_receive(MutableOctets buffer) noexcept override {
    auto received = inner_->receive(buffer);
    trace_.flow_open = received.has_value();
    if (!received || received->flow != Flow::New) return received;
    const auto command = read_command(Octets{buffer}.first(received->octets));
    if (!command) return received;
    OctetReader reader{command->payload, std::endian::little};
    const double torque = reader.get<double>();
    trace_.frames.push_back({command->mode, reader.exhausted() ? torque : std::numeric_limits<double>::quiet_NaN()});
    return received;
  }
  bool do_wait(Duration timeout) noexcept override { return inner_->wait(timeout); }

  std::unique_ptr<DataFlow> inner_;
  GreedyTrace& trace_;
};

class TappedFlows final : public FlowFactory {
 public:
  TappedFlows(FlowFactory& inner, GreedyTrace& trace) : inner_{inner}, trace_{trace} {}

 private:
  Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override {
    HIROSCO_TRY_LET(auto flow, inner_.open(address, side));
    return std::make_unique<TappedFlow>(std::move(flow), trace_);
  }
  FlowFactory& inner_;
  GreedyTrace& trace_;
};

struct HoldsFlows {
  TappedFlows tapped;
};

class Motor final : private HoldsFlows, public simulation::SimulatedDevice {
 public:
  Motor(FlowFactory& flows, const FlowAddress& address, const Settings& settings, GreedyTrace& trace)
      : HoldsFlows{TappedFlows{flows, trace}}, SimulatedDevice{tapped, address, settings} {}

 private:
  void advance(Duration) noexcept override {}
  Result<> take(OctetReader payload) noexcept override {
    static_cast<void>(payload.get<double>());
    return payload.exhausted() ? ok() : fail(ErrorCode::Malformed, "motor command size");
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(0.25); }
  Result<> do_fault(const simulation::Words&) override { return fail(ErrorCode::InvalidArgument, "unknown fault"); }
  std::string do_truth() const override { return {}; }
};

}  // namespace

Plan greedy_plan(GreedyTrace& trace) {
  Plan plan;
  plan.mission = "hello";  // its folder: the texts below stand in for the files there
  plan.files = {{"mission.xml", mission_text}, {"greedy.xml", subsystem_text}};
  plan.subsystems["greedy"] = [&trace] { return std::make_unique<Greedy>(trace); };
  plan.devices["motor"] = [&trace](FlowFactory& flows, const FlowAddress& address,
                                   const simulation::SimulatedDevice::Settings& settings) {
    return std::make_unique<Motor>(flows, address, settings, trace);
  };
  return plan;
}

}  // namespace hirosco::testing
