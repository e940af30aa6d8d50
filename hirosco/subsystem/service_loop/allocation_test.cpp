// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/resource/counted.hpp"
#include "hirosco/resource/pool_resource.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/utilities/allocation_guard.hpp"

/// The cycle never uses the heap: counted over 100,000 cycles with links both ways, an actuator, housekeeping, events,
/// functions and parameter writes; and a planted allocation is caught.
namespace hirosco {
namespace {

using pus::st128::Role;
using testing::Probe;
using testing::Rig;

/// The probe with everything in one configuration.
std::string descriptor_with_everything() {
  std::string text = testing::probe_descriptor;
  const std::string everything = R"(<Configuration name="EVERYTHING" id="4" priority="80" sampling_us="500">
    <HKService id="4712" interval="10">
      <SampledOnce><ParamRef name="CUR_VALUES"/><ParamRef name="ARM_OUTPUT"/></SampledOnce>
      <SampledNREPTimes nrep="5"><ParamRef name="DES_POSITION"/></SampledNREPTimes>
    </HKService>
    <RealTimeLinkService>
      <Provides name="ARM_STATE"><ParamRef name="CUR_VALUES.POSITION"/><ParamRef name="SEEN"/></Provides>
      <Requires name="HAND"><Field name="ANGLE" type="DOUBLE"/><Field name="ENABLE" type="UINT8"/></Requires>
    </RealTimeLinkService>
    <Device name="ARM"><Endnode transfer="shared_memory" address="arm"/></Device>
    <Device name="LAMP"><Endnode transfer="shared_memory" address="lamp"/></Device>
  </Configuration>
  <Resources><Pool block="64" count="16"/><Pool block="1024" count="4"/></Resources>
</Subsystem>)";
  return text.replace(text.find("</Subsystem>"), std::string::npos, everything);
}

/// The cycle under count, the world around it not.
class CountedFlight {
 public:
  explicit CountedFlight(Subsystem& author) : rig_{author, descriptor_with_everything()} {
    // What is counted here is told here, and the probe books its first call of each node in a map.
    rig_.cycles_watched = false;
    arm_ = open("arm");
    lamp_ = open("lamp");
    rig_.bring_to(State::PreOperational, 4);
    hand_ = rig_.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}});
    static_cast<void>(
        rig_.attach(2, Role::Producer, "ARM_STATE", {{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}}));
    for (const State state : {State::SafeOperational, State::Operational}) {
      rig_.set_state(state);
      for (int i = 0; i < 4; ++i) cycle();
    }
    uses_ = {};
  }

  void cycle() {
    sample();
    if (++sequence_ % 50 == 0) command();
    rig_.service();
    rig_.telemetry.clear();
    rig_.advance(500us);
    const RealtimeScope no_heap;
    static_cast<void>(rig_.subsystem.cycle_step(rig_.clock.now()));
    uses_ += no_heap.count();
  }
  [[nodiscard]] const AllocationCount& uses() const { return uses_; }
  [[nodiscard]] Rig& rig() { return rig_; }

 private:
  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig_.flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
  }
  /// Hand and devices say something new; now and then the hand misses some cycles and becomes stale, which is reported.
  void sample() {
    std::array<std::byte, 9> payload{};
    if (sequence_ % 1'000 < 990) hand_.writer.write(payload, rig_.clock.now(), LinkStatus::Valid);
    std::array<std::byte, max_device_frame_octets> frame{};
    for (const auto& [flow, octets] : {std::pair{arm_.get(), 8U}, std::pair{lamp_.get(), 1U}}) {
      const auto status =
          write_status(frame, {.epoch = 1, .sequence = sequence_, .payload = Octets{payload}.first(octets)});
      static_cast<void>(flow->send(status.value()));
    }
  }
  void command() {
    rig_.call("SET_GOAL", {0.5 + 0.001 * (sequence_ % 1'000)});
    std::array<std::byte, 13> write{};
    OctetWriter{write}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 2}.wire()).put(7.0);
    rig_.send(20, 3, write);
  }

  Rig rig_;
  std::unique_ptr<DataFlow> arm_, lamp_;
  Rig::Partner hand_;
  std::uint32_t sequence_{0};
  AllocationCount uses_{};
};

TEST(CycleAllocations, ThereAreNoneInAHundredThousandCycles) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  Probe probe;
  CountedFlight flight{probe};
  ASSERT_EQ(flight.rig().state(), State::Operational);
  const std::uint64_t before = flight.rig().vital.cycles.load();
  for (int i = 0; i < 100'000; ++i) flight.cycle();
  EXPECT_EQ(flight.uses().allocations, 0u);
  EXPECT_EQ(flight.uses().frees, 0u);
  EXPECT_EQ(flight.rig().vital.cycles.load() - before, 100'000u);
  EXPECT_EQ(flight.rig().vital.lost_reports.load(), 0u);
  EXPECT_EQ(probe.kp.load(), 7.0);  // writes arrived
  EXPECT_GE(probe.goal.load(), 0.5);  // functions ran
  EXPECT_GT(probe.hand.count(), 90'000u);
  EXPECT_TRUE(probe.arm.alive());
}

/// Its self test takes five cycles and passes and fails in turn.
struct Tested final : Probe {
  int calls{0}, runs{0};
  Result<Step> self_test(const Cycle& cycle) noexcept override {
    if (cycle.first) ++runs;
    if (++calls % 5 != 0) return again;
    if (runs % 2 == 0) return fail(ErrorCode::Internal, "the second one, as always", runs);
    return done;
  }
};

TEST(CycleAllocations, ThereAreNoneInASelfTest) {
  Tested tested;
  CountedFlight flight{tested};
  flight.rig().set_state(State::SafeOperational);
  for (int i = 0; i < 10'000; ++i) {
    if (i % 20 == 5) static_cast<void>(flight.rig().send(17, 128, {}));
    flight.cycle();
  }
  EXPECT_EQ(tested.runs, 500);
  EXPECT_EQ(tested.calls, 2'500);
  EXPECT_EQ(flight.uses().allocations, 0u);
  EXPECT_EQ(flight.uses().frees, 0u);
}

/// Takes every sample of a set that comes ten times in each of its cycles.
struct Collector final : Subsystem {
  struct Tick {
    Sized<double, 4> angle;
  };
  QueueInput<Tick> ticks;
  double sum{0};
  std::uint64_t taken{0};

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override {
    for (const Tick& tick : ticks.samples()) sum += tick.angle[0];
    taken += ticks.samples().size();
    return ok();
  }
};

TEST(CycleAllocations, ThereAreNoneForAQueueOfSamplesEither) {
  Collector collector;
  Rig rig{collector, R"(<Subsystem name="COLLECTOR" id="21"><Configuration name="C" id="1" sampling_us="10000">
    <RealTimeLinkService><Requires name="TICKS" kind="queued" depth="12"><Field name="ANGLE" type="DOUBLE" count="2"/></Requires>
    </RealTimeLinkService></Configuration></Subsystem>)"};
  rig.bring_to(State::PreOperational);
  const pus::st128::Agreement agreement{
      LinkMethod::SharedMemory,    descriptor::ByteOrder::Little, LinkKind::Queued, 12, 1ms, 10ms,
      {{"ANGLE", Type::Double, 2}}};
  const auto* queued = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = queued->establish(rig.memory, agreement.layout(1)).value();
  const auto writer = queued->produce(rig.memory, shared, agreement.layout(1)).value();
  std::array<std::byte, 256> buffer{};
  const auto octets = pus::st128::write_attach_request(buffer, {1, Role::Consumer, 1, "TICKS", agreement}).value();
  const auto sent = rig.send(128, pus::st128::attach, Octets{buffer}.first(octets), shared);
  rig.settle();
  ASSERT_EQ(rig.outcome(sent), "1 3 7");
  AllocationCount uses{};
  const std::array<std::byte, 16> payload{};
  for (int cycle = 0; cycle < 10'000; ++cycle) {
    // Now and then more than are kept, and none.
    for (int tick = 0; tick < cycle % 20; ++tick) writer->write(payload, rig.clock.now(), LinkStatus::Valid);
    rig.service();
    rig.advance(10ms);
    const RealtimeScope no_heap;
    static_cast<void>(rig.subsystem.cycle_step(rig.clock.now()));
    uses += no_heap.count();
  }
  EXPECT_EQ(uses.allocations, 0u);
  EXPECT_EQ(uses.frees, 0u);
  EXPECT_EQ(collector.taken, 500u * (66 + 12 * 8));
  EXPECT_EQ(collector.ticks.lost(), 500u * (1 + 2 + 3 + 4 + 5 + 6 + 7));
}

/// Lives in its pools: a container and blocks of its own in each cycle, more of them than there are.
struct Pooled final : Probe {
  std::array<void*, 8> kept{};
  std::uint64_t refusals{0};
  double sum{0};
  Result<> work(const Cycle& cycle) noexcept override {
    void*& block = kept[cycle.count % kept.size()];
    if (block != nullptr) static_cast<void>(resources().give_back(block));
    block = resources().try_allocate(cycle.count % 900 + 1);
    if (block == nullptr) ++refusals;
    std::pmr::vector<double> numbers{&resources()};
    numbers.reserve(8);
    for (int i = 0; i < 8; ++i) numbers.push_back(i);
    sum += numbers.back();
    const auto shared = make_counted<double>(resources(), 1.0);
    if (shared) sum += **shared;
    return Probe::work(cycle);
  }
};

TEST(CycleAllocations, ThereAreNoneInPools) {
  Pooled pooled;
  CountedFlight flight{pooled};
  pooled.sum = 0;
  for (int i = 0; i < 10'000; ++i) flight.cycle();
  EXPECT_EQ(pooled.sum, 10'000 * (7.0 + 1.0));
  EXPECT_GT(pooled.refusals, 0U) << "4 large blocks for 8";
  EXPECT_EQ(flight.uses().allocations, 0u);
  EXPECT_EQ(flight.uses().frees, 0u);
}

/// Its node grows a vector in one cycle of a thousand.
struct Careless final : Probe {
  std::vector<double> history;
  Result<> work(const Cycle& cycle) noexcept override {
    if (cycle.count % 1'000 == 999) {
      history = std::vector<double>(10);
    }
    return Probe::work(cycle);
  }
};

TEST(CycleAllocations, OneInAThousandCyclesIsCaught) {
  Careless careless;
  CountedFlight flight{careless};
  for (int i = 0; i < 10'000; ++i) flight.cycle();
  EXPECT_EQ(flight.uses().allocations, 10u);
}

/// Every telecommand that a subsystem takes while it acts, good ones and bad ones, again and again.
class Palette {
 public:
  explicit Palette(Rig& rig) : rig_{rig} {}
  void next() {
    const std::uint32_t kp = ParameterId{10, Type::Double, 2}.wire(), kd = ParameterId{10, Type::Double, 3}.wire();
    constexpr std::uint32_t unknown = 0x000A'0A63;
    const auto data = [this](const auto&... values) {
      OctetWriter writer{room_};
      (writer.put(values), ...);
      return writer.written();
    };
    const std::uint8_t none{0}, one{1}, two{2};
    const std::uint16_t structure{4712}, own{7}, made{5000}, repetitions{2};
    switch (turn_++ % 24) {
      case 0: rig_.send(17, 1, {}); break;
      case 1: rig_.send(20, 1, data(two, kp, kd)); break;
      case 2: rig_.send(20, 1, data(one, unknown)); break;
      case 3: rig_.send(20, 3, data(two, kp, 7.0, kd, 1.0)); break;
      case 4: rig_.send(20, 3, data(one, kp, 1e9)); break;
      case 5: rig_.call("SET_GOAL", {0.5}); break;
      case 6: rig_.send(8, 1, data(one)); break;
      case 7: rig_.send(3, 6, data(one, structure)); break;
      case 8: rig_.send(3, 5, data(one, structure)); break;
      case 9: rig_.send(3, 27, data(one, structure)); break;
      case 10: rig_.send(3, 31, data(one, structure, std::uint32_t{20})); break;
      case 11: rig_.send(5, 6, data(one, own)); break;
      case 12: rig_.send(5, 5, data(one, own)); break;
      case 13: rig_.send(199, 1, {}); break;
      case 14: rig_.send(128, 9, data(one)); break;
      case 15: rig_.send(3, 1, data(made, std::uint32_t{2}, one, kp, none)); break;
      case 16: rig_.send(3, 29, data(made, none, one, repetitions, one, kd)); break;
      case 17: rig_.send(3, 29, data(made, none, one, repetitions, one, unknown)); break;
      case 18: rig_.send(3, 9, data(two, made, structure)); break;
      case 19: rig_.send(3, 33, data(two, made, structure)); break;
      case 20: rig_.send(3, 3, data(one, made)); break;
      case 21: rig_.send(130, 1, data(std::uint32_t{9})); break;
      case 22: rig_.call("CONFIGURE", {4}); break;
      default: rig_.send(20, 1, {}); break;
    }
  }

 private:
  Rig& rig_;
  std::array<std::byte, 64> room_{};
  unsigned turn_{0};
};

TEST(ServiceLoopAllocations, ThereAreNoneForAnyTelecommandOnceCommissioned) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  Probe probe;
  CountedFlight flight{probe};
  ASSERT_EQ(flight.rig().state(), State::Operational);
  for (int i = 0; i < 64; ++i) flight.cycle();
  flight.rig().raised.clear();
  // The probe's own table of nodes has grown in its first cycles.
  const std::uint64_t before = flight.rig().subsystem.cycle().heap_uses().load().cycle;
  Palette palette{flight.rig()};
  for (int i = 0; i < 10'000; ++i) {
    palette.next();
    flight.cycle();
  }
  EXPECT_EQ(flight.rig().heard(descriptor::framework_event::service_uses_heap), 0);
  const HeapUses told = flight.rig().subsystem.cycle().heap_uses().load();
  EXPECT_EQ(told.service, 0u);
  EXPECT_EQ(told.cycle, before);
  EXPECT_TRUE(told.counted);
}

TEST(ServiceLoopAllocations, ThereAreNoneWhenASelfTestEndsInWords) {
  Tested tested;
  CountedFlight flight{tested};
  flight.rig().set_state(State::SafeOperational);
  for (int i = 0; i < 400; ++i) {
    if (i % 20 == 5) static_cast<void>(flight.rig().send(17, 128, {}));
    if (i % 20 == 15) static_cast<void>(flight.rig().send(17, 130, {}));
    flight.cycle();
  }
  EXPECT_EQ(tested.runs, 20);
  EXPECT_EQ(flight.rig().subsystem.cycle().heap_uses().load().service, 0u);
}

/// The end of a link is commissioned when it is made, whenever that is (adr 0220).
TEST(ServiceLoopAllocations, OnesForALinkThatIsMadeInFlightAreToldAndThereAreNoneBehindThem) {
  Probe probe;
  CountedFlight flight{probe};
  const auto uses = [&] { return flight.rig().subsystem.cycle().heap_uses().load().service; };
  for (int i = 0; i < 64; ++i) flight.cycle();
  ASSERT_EQ(uses(), 0u);
  std::string made;
  static_cast<void>(flight.rig().attach(3, Role::Producer, "ARM_STATE",
                                        {{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}}, &made));
  EXPECT_EQ(made, "1 3 7");
  // Told once a second: what was done behind it would be seen, too.
  for (int i = 0; i < 2'500; ++i) flight.cycle();
  const std::uint64_t for_the_link = uses();
  EXPECT_GT(for_the_link, 0u);
  Palette palette{flight.rig()};
  for (int i = 0; i < 5'000; ++i) {
    palette.next();
    flight.cycle();
  }
  EXPECT_EQ(uses(), for_the_link);
}

/// Its service loop grows a vector once in a while.
struct CarelessService final : Probe {
  std::vector<double> history;
  int steps{0};
  void service(TimePoint) override {
    if (++steps % 1'000 == 0) history.push_back(1.0), history.shrink_to_fit();
  }
};

TEST(ServiceLoopAllocations, OneOfTheAuthorIsToldAndCounted) {
  CarelessService careless;
  CountedFlight flight{careless};
  flight.rig().raised.clear();
  careless.steps = 0;
  careless.history.clear();
  for (int i = 0; i < 10'000; ++i) flight.cycle();
  // 5 s: each second the sum, and the first at once.
  EXPECT_GE(flight.rig().heard(descriptor::framework_event::service_uses_heap), 5);
  EXPECT_LE(flight.rig().heard(descriptor::framework_event::service_uses_heap), 6);
  EXPECT_GE(flight.rig().subsystem.cycle().heap_uses().load().service, 10u);
}

}  // namespace
}  // namespace hirosco
