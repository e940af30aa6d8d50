// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/told.hpp"
#include "hirosco/utilities/os/clock.hpp"

/// The threads that drive a subsystem in real time: its cycle and its loops of services, as a process has them, beside a service loop that
/// the test steps. Run under the thread sanitizer by ./check.
namespace hirosco {
namespace {

/// One subsystem with its threads; the test's thread is its service loop and its supervisor.
class Driven {
 public:
  Driven(Subsystem& author, const std::string& descriptor, bool precise = false, CycleCore* core = nullptr)
      : subsystem{author,
                  testing::read_descriptor(descriptor),
                  {.clock = clock,
                   .memory = memory,
                   .flows = flows,
                   .realtime = false,
                   .precise = precise,
                   .wakes = true,
                   .explain = {},
                   .read_again =
                       [this](std::string_view text) {
                         return descriptor::read_again(subsystem.descriptor(), text, {});
                       }},
                  channels.subsystem_end(),
                  vital,
                  permit},
        cycle_{subsystem, clock, bell_, false, nullptr, core} {
    permit.release();
    EXPECT_TRUE(cycle_.start("cycle"));
    for (std::size_t i = 0; i < subsystem.own_loops(); ++i) {
      loops_.push_back(std::make_unique<OwnLoopThread>(subsystem, i, clock, bell_, false));
      EXPECT_TRUE(loops_.back()->start());
    }
  }
  ~Driven() {
    cycle_.end();
    for (const auto& loop : loops_) loop->end();
  }
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
  std::vector<std::unique_ptr<OwnLoopThread>> loops_;
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

struct Idle final : Subsystem {};

constexpr const char* precise_descriptor = R"(<Subsystem name="PRECISE" id="22">
  <Configuration name="C" id="1" sampling_us="2000" priority="30" budget_us="500" spin_us="200"/>
  <Configuration name="SLEEPS" id="2" sampling_us="2000" priority="30" budget_us="500"/></Subsystem>)";

CycleSpin spun(std::uint8_t configuration, bool precise) {
  Idle idle;
  Driven driven{idle, precise_descriptor, precise};
  driven.go(State::PreOperational);
  driven.call("CONFIGURE", configuration);
  driven.cycle_on(50);
  CycleSpin spin;
  while (!driven.subsystem.cycle().spin().snapshot(spin)) {}
  return spin;
}

TEST(CycleThreads, SpinBeforeEachCycleWhereTheConfigurationAsksForItAndTheComputerHasRoom) {
  const CycleSpin precise = spun(1, true);
  EXPECT_EQ(precise.spin_us, 200.0F);
  EXPECT_GT(precise.longest_us, 0.0F);
  for (const CycleSpin& sleeps : {spun(1, false), spun(2, true)}) {
    EXPECT_EQ(sleeps.spin_us, 0.0F);
    EXPECT_EQ(sleeps.longest_us, 0.0F);
    EXPECT_EQ(sleeps.exceeded, 0U);
  }
}

TEST(CycleThreads, GoToTheCoreThatTheMissionNamesWhateverRightsTheyHave) {
  const ProcessorSet mine = ProcessorSet::of_this_thread();
  ASSERT_GT(mine.count(), 0U);
  Idle idle;
  CycleCore named{.named = mine.beyond(ProcessorSet{})}, nowhere;
  {
    Driven driven{idle, precise_descriptor, false, &named};
    driven.go(State::PreOperational);
    driven.until([&] { return named.is != ProcessUsage::no_core; });
    EXPECT_EQ(named.is, named.named);
    EXPECT_EQ(to_string(ProcessorSet::of_this_thread()), to_string(mine)) << "who serves stays where he may be";
  }
  Driven driven{idle, precise_descriptor, false, &nowhere};
  driven.go(State::PreOperational);
  const bool one_alone = mine.count() == 1;
  EXPECT_TRUE(one_alone || nowhere.is == ProcessUsage::no_core) << "without rights and a name nothing is tied";
}

TEST(CycleThreads, SpinOnlyWhereWhoServesHasAnotherCore) {
  Thread::start("server", [] {
    const ProcessorSet mine = ProcessorSet::of_this_thread();
    EXPECT_EQ(may_spin(true, std::nullopt), mine.count() > 1);
    EXPECT_FALSE(may_spin(false, std::nullopt));
    ASSERT_TRUE(pin_to_cycle_cpu());
    EXPECT_FALSE(may_spin(true, std::nullopt));
    EXPECT_FALSE(may_spin(true, mine.last()));
    EXPECT_TRUE(may_spin(true, *mine.last() + 1));
  })->join();
}

// --- loops of services beside it ---------------------------------------------------------------------------------------

constexpr const char* archive_descriptor = R"(<Subsystem name="ARCHIVE" id="10">
  <ParamRef name="FILES" id="0" type="UINT32" init="7" minimum="0" maximum="1000" writable="PreOperational SafeOperational Operational"/>
  <ParamRef name="LOOKED" id="1" type="UINT32"/>
  <EventService><Event name="FULL" id="5" severity="low"><Argument name="FILES" type="UINT32"/></Event></EventService>
  <CustomService name="STORE" type="200">
    <Request name="KEEP" subtype="1"><Argument name="FILES" type="UINT32" minimum="0" maximum="1000"/></Request>
    <Report name="KEPT" subtype="2"><Field name="LOOKED" type="UINT32"/></Report>
  </CustomService>
  <CustomService name="LOOK" type="201"><Request name="AT" subtype="1"/></CustomService>
  <ServiceLoop name="SLOW" period_us="1000" queue="8" budget_us="1"/>
  <ServiceLoop name="OTHER" period_us="2000" queue="8"/>
  <Service name="STORE" loop="SLOW"/><Service name="ST03" loop="SLOW"/><Service name="LOOK" loop="OTHER"/><Service name="ST20" loop="OTHER"/>
  <HKService id="9" interval="5"><SampledOnce><ParamRef name="FILES"/><ParamRef name="LOOP_STATS"/></SampledOnce></HKService>
  <Configuration name="FIRST" id="1" sampling_us="500"/>
  <Configuration name="SECOND" id="2" sampling_us="300"><Set parameter="FILES" value="3"/></Configuration>
  <Bumpless between="FIRST SECOND"/>
</Subsystem>)";

struct Archive final : Subsystem {
  CustomService store{"STORE"}, look{"LOOK"};
  Parameter<std::uint32_t> files, looked;
  Event<std::uint32_t> full{"FULL"};
  std::atomic<bool> stands{false};  ///< KEEP does not return

 protected:
  Result<> offline() override {
    store.on_request("KEEP", [this](std::uint32_t number, Call call) -> Result<> {
      while (stands) std::this_thread::yield();
      std::uint32_t seen = 0;
      static_cast<void>(looked.snapshot(seen));
      if (auto set = store.store(files, number); !set) return set;
      static_cast<void>(store.raise(full, number));
      return store.report("KEPT", call, seen);
    });
    look.on_request("AT", [this]() -> Result<> {
      std::uint32_t seen = 0;
      static_cast<void>(files.snapshot(seen));
      return ok();
    });
    provide(store);
    provide(look);
    return ok();
  }
  Result<Step> software_init() override {
    publish("FILES", files);
    publish("LOOKED", looked);
    use_event(full);
    return done;
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return ok();
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return take(cycle); }

 private:
  Result<> take(const Cycle& cycle) noexcept {
    looked.store(static_cast<std::uint32_t>(cycle.count));
    return ok();
  }
};

std::uint32_t files_id() { return ParameterId{10, Type::Uint32, 0}.wire(); }

void set_files(Driven& driven, std::uint32_t number) {
  std::array<std::byte, 9> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(files_id()).put(number);
  driven.send(20, 3, data);
}

void read_files(Driven& driven) {
  std::array<std::byte, 5> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(files_id());
  driven.send(20, 1, data);
}

/// Up, through requests to both loops while the cycle changes its configuration, and down again: each request has exactly one end.
TEST(OwnLoopThreads, AnswerBesideTheCycleThroughTwentyRoundsOfStartReconfigureAndStop) {
  Archive archive;
  Driven driven{archive, archive_descriptor};
  for (int round = 0; round < 20; ++round) {
    driven.go(State::PreOperational);
    driven.call("CONFIGURE", 1);
    driven.cycle_on(1);
    driven.go(State::SafeOperational);
    driven.go(State::Operational);
    for (std::uint32_t i = 0; i < 6; ++i) {
      std::array<std::byte, 4> number;
      OctetWriter{number}.put(i);
      driven.send(200, 1, number);
      driven.send(201, 1, {});
      driven.call("CONFIGURE", 1 + (i + 1) % 2);
      // Housekeeping is busy until the cycle has taken what was asked of it before.
      driven.done();
      set_files(driven, i);  // busy while a change of configuration without a bump is under way
      driven.done();
      driven.cycle_on(2);
      read_files(
          driven);  // nobody writes it now: who is preempted there, as no cycle of a flight is, is not waited for
      std::array<std::byte, 3> structure;
      OctetWriter{structure}.put(std::uint8_t{1}).put(std::uint16_t{9});
      driven.send(3, i % 2 == 0 ? 6 : 5, structure);
      driven.done();
    }
    driven.go(State::ErrorOperational);
    driven.go(State::Offline);
  }
  driven.done();
  EXPECT_EQ(driven.told.failures, 0) << driven.told.failed;
  EXPECT_EQ(driven.told.completions, driven.sent);
  EXPECT_EQ(driven.told.reports, 20 * 6);
}

/// What a loop of its own is for: who asks ST[20] waits for no other service.
TEST(OwnLoopThreads, SetAndReportValuesWhileAServiceInAnotherLoopStands) {
  Archive archive;
  Driven driven{archive, archive_descriptor};
  driven.go(State::PreOperational);
  driven.call("CONFIGURE", 1);
  driven.cycle_on(1);
  driven.done();
  archive.stands = true;
  std::array<std::byte, 4> number;
  OctetWriter{number}.put(std::uint32_t{4});
  driven.send(200, 1, number);
  const int before = driven.told.completions;
  set_files(driven, 9);
  read_files(driven);
  driven.until([&] { return driven.told.completions == before + 2; });
  std::uint32_t files = 0;
  driven.until([&] { return archive.files.snapshot(files) && files == 9; });
  EXPECT_EQ(driven.told.reports, 0) << "the other one stands still";
  archive.stands = false;
  driven.done();
  EXPECT_EQ(driven.told.failures, 0);
}

/// A second from step to step where nothing else is said: whoever rests for it is woken when a configuration says a millisecond. Twenty
/// times: of one that is not, each waits for the rest of its second.
TEST(OwnLoopThreads, GoAtThePeriodOfTheConfigurationAtOnceAndBackWithTheNext) {
  Archive archive;
  std::string text{archive_descriptor};
  const auto change = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change(R"("SLOW" period_us="1000")", R"("SLOW" period_us="1000000")");
  change(R"(sampling_us="500"/>)",
         R"(sampling_us="500"><ServiceLoop name="SLOW" period_us="1000" priority="5"/></Configuration>)");
  Driven driven{archive, text};
  driven.go(State::PreOperational);
  driven.call("CONFIGURE", 1);
  driven.cycle_on(1);
  driven.go(State::SafeOperational);
  std::array<std::byte, 4> number;
  OctetWriter{number}.put(std::uint32_t{4});
  std::uint64_t waited = 0;
  for (int i = 0; i < 20; ++i) {
    const std::uint64_t before = driven.cycles();
    driven.send(200, 1, number);
    driven.done();
    waited += driven.cycles() - before;
    driven.call("CONFIGURE", 2);
    driven.done();
    EXPECT_EQ(driven.subsystem.own_loop(0).in_force().period, 1s);
    driven.cycle_on(20);  // the step that was due before has been: the next one is due in a second
    driven.call("CONFIGURE", 1);
    driven.done();
  }
  EXPECT_LT(waited, 20'000U) << "cycles of 500 us: half of what they are where nobody is woken";
  EXPECT_EQ(driven.told.failures, 0) << driven.told.failed;
  EXPECT_EQ(driven.told.completions, driven.sent);
  EXPECT_EQ(driven.told.reports, 20);
}

/// Another text of the descriptor, with another range, while they judge by the one before (docs/adr/0200): whether they rest is what the
/// thread sanitizer sees.
TEST(OwnLoopThreads, RestWhileWhatTheyJudgeByChanges) {
  Archive archive;
  Driven driven{archive, archive_descriptor};
  driven.go(State::PreOperational);
  for (int round = 0; round < 50; ++round) {
    std::string text{archive_descriptor};
    const std::string was = R"(maximum="1000" writable)";
    text.replace(text.find(was), was.size(), R"(maximum=")" + std::to_string(2000 + round) + R"(" writable)");
    const MemoryHandle memory = driven.memory.create("text", text.size()).value();
    std::ranges::copy(std::as_bytes(std::span{text}),
                      driven.memory.map(memory, Access::ReadWrite).value().octets.begin());
    ASSERT_TRUE(driven.memory.seal_writers(memory));
    std::array<std::byte, 4> octets;
    OctetWriter{octets}.put(static_cast<std::uint32_t>(text.size()));
    std::array<std::byte, 4> number;
    OctetWriter{number}.put(std::uint32_t{4});
    driven.send(130, 1, octets, memory);
    set_files(driven, 3);
    driven.send(200, 1, number);
    driven.send(130, 2, {});
    set_files(driven, 1000);
    driven.send(200, 1, number);
    driven.done();
  }
  EXPECT_EQ(driven.told.failures, 0);
  set_files(driven, 2049);
  driven.done();
  EXPECT_EQ(driven.told.failures, 0) << "the newest range";
  set_files(driven, 2050);
  driven.done();
  EXPECT_EQ(driven.told.failures, 1);
}

/// What their steps take stands in housekeeping; a budget of a microsecond is exceeded by whoever does anything.
TEST(OwnLoopThreads, AreToldWithTheirLongestStepBesideTheirBudget) {
  Archive archive;
  Driven driven{archive, archive_descriptor};
  driven.go(State::PreOperational);
  driven.call("CONFIGURE", 1);
  std::array<std::byte, 4> number;
  OctetWriter{number}.put(std::uint32_t{4});
  for (int i = 0; i < 10; ++i) {
    driven.send(200, 1, number);
    driven.done();
  }
  driven.cycle_on(40);
  LoopStatistics told;
  while (!driven.subsystem.cycle().loop_statistics().snapshot(told)) {}
  EXPECT_EQ(told.budget_us[0], 1.0F);
  EXPECT_EQ(told.budget_us[1], 0.0F);
  EXPECT_GT(told.longest_us[0], 1.0F);
  EXPECT_GT(told.longest_us[1], 0.0F);
  EXPECT_GT(told.exceeded[0], 0U);
  EXPECT_EQ(told.exceeded[1], 0U) << "it declares none";
  EXPECT_EQ(told.budget_us[2], 0.0F) << "there is no third";
  EXPECT_GT(driven.told.housekeeping, 0);
}

}  // namespace
}  // namespace hirosco
