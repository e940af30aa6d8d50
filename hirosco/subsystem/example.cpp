// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A subsystem of one node, and its two loops stepped by hand on virtual time: no process, no thread, no supervisor.
#include <cstdio>
#include <optional>
#include <span>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

using namespace hirosco;

namespace {

constexpr const char* counter_xml = R"(<Subsystem name="COUNTER" id="9">
  <Parameters><ParamRef name="TICKS" id="0" type="UINT32"/></Parameters>
  <Configuration name="FAST" id="1" priority="50" sampling_us="1000"/>
</Subsystem>)";

class Counter final : public Subsystem {
 public:
  std::uint32_t ticks() const { return ticks_.load(); }

 private:
  Result<Step> software_init() override {
    publish("TICKS", ticks_);
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    ticks_.store(ticks_.load() + 1);
    return ok();
  }

  Parameter<std::uint32_t> ticks_;
};

/// Sends a function that every subsystem has, and steps both loops until it must have ended.
void command(GenericSubsystem& subsystem, ChannelPair& channels, ManualClock& clock, std::size_t function,
             double argument) {
  const auto data = pus::encode_call(pus::common_functions()[function], std::span{&argument, 1});
  std::array<std::byte, 64> buffer;
  const auto packet = pus::write_telecommand(buffer, {.apid = 9, .service = 8, .subtype = 1, .source = 1}, *data);
  static_cast<void>(channels.supervisor_end().send({.packet = *packet}));
  for (int i = 0; i < 10; ++i) {
    subsystem.service_step(clock.now());
    const auto demand = subsystem.cycle_demand();
    if (!demand.wanted) {
      subsystem.cycle_parked(demand.ticket);
      continue;
    }
    clock.advance(demand.period);
    subsystem.cycle_step(clock.now());
  }
}

}  // namespace

int main() {
  const auto reading = descriptor::read_subsystem(
      "counter.xml", [](const std::filesystem::path&) { return Result<std::string>{counter_xml}; });
  if (!reading.value) return 1;
  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  ChannelPair channels;
  VitalPage vital;
  PermitPage permit;
  permit.release();
  Counter counter;
  GenericSubsystem subsystem{
      counter, *reading.value, {.clock = clock, .memory = memory, .flows = flows}, channels.subsystem_end(),
      vital,   permit};

  constexpr std::size_t set_state = 0, configure = 1;
  command(subsystem, channels, clock, set_state, static_cast<double>(State::PreOperational));
  command(subsystem, channels, clock, configure, 1);
  command(subsystem, channels, clock, set_state, static_cast<double>(State::SafeOperational));
  command(subsystem, channels, clock, set_state, static_cast<double>(State::Operational));
  std::printf("%s: %u ticks in %llu cycles\n", std::string{to_text(subsystem.state())}.c_str(), counter.ticks(),
              static_cast<unsigned long long>(vital.cycles.load()));
  return subsystem.state() == State::Operational && counter.ticks() > 0 ? 0 : 1;
}
