// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/loops.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/subsystem/testing/told.hpp"
#include "hirosco/utilities/os/clock.hpp"

/// The thread that drives a subsystem's cycle in real time, as a process has it, beside a service loop that the test steps.
/// Run under the thread sanitizer by ./check.
namespace hirosco {
namespace {

/// One subsystem with the thread of its cycle; the test's thread is its service loop and its supervisor.
class Driven {
 public:
  Driven(Subsystem& author, const std::string& descriptor)
      : subsystem{author,
                  testing::read_descriptor(descriptor),
                  {.clock = clock, .memory = memory, .flows = flows, .realtime = false, .wakes = true, .explain = {}},
                  channels.subsystem_end(),
                  vital,
                  permit},
        cycle_{subsystem, clock, bell_, false} {
    permit.release();
    EXPECT_TRUE(cycle_.start("cycle"));
  }
  ~Driven() { cycle_.end(); }
  Driven(const Driven&) = delete;
  Driven& operator=(const Driven&) = delete;

  void send(std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& with = {}) {
    std::array<std::byte, max_packet_octets> buffer{};
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = subsystem.descriptor().id,
                                                .sequence_count = ++count_,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    ASSERT_TRUE(channels.supervisor_end().send({.packet = packet.value(), .memory = with}));
    ++sent;
  }
  void call(std::string_view function, double argument) {
    const auto common = pus::common_functions();
    const auto found = std::ranges::find(common, function, &descriptor::Function::name);
    ASSERT_NE(found, common.end());
    send(8, 1, pus::encode_call(*found, std::span{&argument, 1}).value());
  }
  void step() {
    permit.heartbeat.fetch_add(1);
    static_cast<void>(subsystem.service_step(clock.now()));
    const auto demand = subsystem.cycle_demand();
    if ((demand.wanted && !cycling_) || demand.ticket != ticket_) cycle_.wake();
    cycling_ = demand.wanted;
    ticket_ = demand.ticket;
    bell_.hear();
    told.hear(channels.supervisor_end());
    std::this_thread::yield();
  }
  template <class Condition>
  void until(Condition&& condition) {
    while (!condition()) step();
  }
  void done() {
    until([this] { return told.completions + told.failures >= sent; });
  }
  void go(State state) {
    call("SET_STATE", static_cast<double>(state));
    until([&] { return subsystem.state() == state; });
  }
  [[nodiscard]] std::uint64_t cycles() const { return vital.cycles.load(); }
  void cycle_on(std::uint64_t count) {
    const std::uint64_t before = cycles();
    until([&] { return cycles() >= before + count; });
  }

  SystemClock clock;
  HeapMemory memory;
  LocalFlows flows;
  ChannelPair channels{4096};
  VitalPage vital{};
  PermitPage permit{};
  GenericSubsystem subsystem;
  testing::Told told;
  int sent{0};

 private:
  Bell bell_ = Bell::make().value();
  CycleThread cycle_;
  bool cycling_{false};
  std::uint32_t ticket_{0};
  std::uint16_t count_{0};
};

// --- the cycle ---------------------------------------------------------------------------------------------------------

struct Tick {
  std::uint64_t number;
};

struct Filter final : Subsystem {
  LinkInput<Tick> ticks;
  TimePoint before{};
  std::atomic<int> early{0};  ///< cycles that began before they were due

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    return done;
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override {
    if (before != TimePoint{} && cycle.planned < before + cycle.period) ++early;
    before = cycle.planned;
    return ok();
  }
};

TEST(CycleThreads, BeginACycleWithTheSampleThatStartsIt) {
  Filter filter;
  Driven driven{filter, R"(<Subsystem name="FILTER" id="21">
    <Configuration name="C" id="1" sampling_us="100000" started_by="TICKS" least_us="1000"><RealTimeLinkService>
      <Requires name="TICKS" age="3"><Field name="NUMBER" type="UINT64"/></Requires></RealTimeLinkService></Configuration>
    </Subsystem>)"};
  driven.go(State::PreOperational);
  driven.call("CONFIGURE", 1);
  driven.cycle_on(2);
  EXPECT_EQ(filter.early, 0) << "no link: the clock alone";
  const pus::st128::Agreement agreed{.method = LinkMethod::SharedMemory,
                                     .byte_order = descriptor::ByteOrder::Little,
                                     .kind = LinkKind::Latest,
                                     .depth = 0,
                                     .producer_period = 3ms,
                                     .consumer_period = 100ms,
                                     .fields = {{"NUMBER", Type::Uint64, 1}},
                                     .wakes = true};
  const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), agreed.method, agreed.kind);
  const MemoryHandle shared = mechanism->establish(driven.memory, agreed.layout(1)).value();
  const auto writer = mechanism->produce(driven.memory, shared, agreed.layout(1)).value();
  std::array<std::byte, max_packet_octets> buffer{};
  const auto octets =
      pus::st128::write_attach_request(
          buffer, {.link = 1, .role = pus::st128::Role::Consumer, .epoch = 1, .set = "TICKS", .agreement = agreed})
          .value();
  driven.send(128, pus::st128::attach, Octets{buffer}.first(octets), shared);
  driven.done();
  ASSERT_EQ(driven.told.failures, 0);
  for (std::uint64_t number = 1; number <= 20; ++number) {
    const std::uint64_t before = driven.cycles();
    writer->write(std::as_bytes(std::span{&number, 1}), driven.clock.now(), LinkStatus::Valid);
    driven.until([&] { return driven.cycles() > before; });
  }
  EXPECT_GT(filter.early, 0);
}

}  // namespace
}  // namespace hirosco
