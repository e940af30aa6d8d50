// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>

#include "hirosco/subsystem/pages/supervisor_silence.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// A filter whose cycle starts with each sample of an encoder (adr 0094): handshake, cycle, limits, and a producer that floods, stops,
/// dies in its sample, wakes without one, or is in fault. The test is supervisor, clock and cycle thread.
namespace hirosco::arrivals {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using ::testing::HasSubstr;
using testing::Rig;

constexpr Duration longest = 10ms, least = 1ms;

std::string filter_descriptor(std::string_view kind = "latest", std::string_view more = "") {
  return R"(<Subsystem name="FILTER" id="21"><Parameters><ParamRef name="N" id="1" type="UINT32"/></Parameters>
    <Configuration name="C" id="1" sampling_us="10000" started_by="TICKS" least_us="1000">
      <HKService id="1" interval="1"><SampledOnce><ParamRef name="N"/></SampledOnce></HKService>
      <RealTimeLinkService><Requires name="TICKS" age="3" kind=")" +
         std::string{kind} + "\"" + std::string{more} + R"(><Field name="NUMBER" type="UINT64"/></Requires>
    </RealTimeLinkService></Configuration></Subsystem>)";
}

struct Tick {
  std::uint64_t number;
};

template <class Port>
struct Filter final : Subsystem {
  Port ticks;
  Parameter<std::uint32_t> n;
  std::vector<Cycle> cycles;
  bool fails{false};

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    publish("N", n);
    return done;
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return take(cycle); }

 private:
  Result<> take(const Cycle& cycle) noexcept {
    cycles.push_back(cycle);
    return ok();
  }
};

/// The filter, the memory of its link, and what a cycle thread does on the test's clock.
template <class Port>
struct Started {
  Filter<Port> filter;
  Rig rig;
  LinkKind kind;
  HeapMemory memory;
  MemoryHandle shared;
  std::unique_ptr<LinkWriter> writer;
  std::uint64_t number{0};
  std::optional<TimePoint> due;

  explicit Started(LinkKind of_kind = LinkKind::Latest, std::string_view more = "")
      : rig{filter, filter_descriptor(to_text(of_kind), more)}, kind{of_kind} {
    rig.bring_to(State::PreOperational);
  }
  [[nodiscard]] st128::Agreement agreement() const {
    return {.method = LinkMethod::SharedMemory,
            .byte_order = descriptor::ByteOrder::Little,
            .kind = kind,
            .depth = kind == LinkKind::Queued ? default_link_depth : 0,
            .producer_period = 3ms,
            .consumer_period = longest,
            .fields = {{"NUMBER", Type::Uint64, 1}},
            .wakes = true};
  }
  std::string attach(const st128::Agreement& agreed, std::uint32_t epoch = 1) {
    const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), agreed.method, agreed.kind);
    shared = mechanism->establish(memory, agreed.layout(epoch)).value();
    writer = mechanism->produce(memory, shared, agreed.layout(epoch)).value();
    std::array<std::byte, max_packet_octets> buffer{};
    const auto octets =
        st128::write_attach_request(
            buffer, {.link = 1, .role = Role::Consumer, .epoch = epoch, .set = "TICKS", .agreement = agreed})
            .value();
    const auto sent = rig.send(128, st128::attach, Octets{buffer}.first(octets), shared);
    rig.service();
    step();
    rig.service();
    return rig.outcome(sent);
  }
  void write(LinkStatus status = LinkStatus::Valid) {
    ++number;
    writer->write(std::as_bytes(std::span{&number, 1}), rig.clock.now(), status);
  }
  /// One cycle, whenever it is to start: with a sample that is there, else when it is due.
  void step() {
    rig.permit.heartbeat.fetch_add(rig.supervisor_silent ? 0 : 1);
    if (!due) due = rig.clock.now() + longest;
    const CycleWait wait = rig.subsystem.cycle_wait();
    const TimePoint starts = wait.arrived() ? std::min(std::max(wait.earliest, rig.clock.now()), *due) : *due;
    if (starts > rig.clock.now()) rig.clock.advance(starts - rig.clock.now());
    due = rig.subsystem.cycle_step(*due);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  void operate() {
    ASSERT_EQ(attach(agreement()), "1 3 7");
    write();
    step();
    ASSERT_TRUE(filter.ticks.valid());
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto sent = rig.set_state(state);
      for (int i = 0; i < 6; ++i) {
        rig.service();
        write();
        step();
      }
      rig.service();
      ASSERT_EQ(rig.outcome(sent), "1 3 7");
    }
    ASSERT_EQ(rig.inhibited(), 0u);
  }
};
using Newest = Started<LinkInput<Tick>>;
using Every = Started<QueueInput<Tick>>;
using Lent = Started<LoanInput<Tick>>;

TEST(BlockingLinks, AreOfferedAsWhatStartsTheCycle) {
  Newest started;
  std::array<std::byte, max_packet_octets> buffer{};
  started.rig.send(128, st128::request_offer,
                   Octets{buffer}.first(st128::write_offer_request(buffer, {1, "TICKS"}).value()));
  started.rig.service();
  for (const auto& report : started.rig.telemetry)
    if (report.service == st128::service_type && report.subtype == st128::offer) {
      EXPECT_TRUE(st128::read_offer(report.data)->offer.wakes);
      return;
    }
  FAIL() << "no offer";
}

TEST(BlockingLinks, ThatWakeNobodyAreNotAttachedToWhoWaitsAndTheReverse) {
  Newest started;
  st128::Agreement deaf = started.agreement();
  deaf.wakes = false;
  EXPECT_EQ(started.attach(deaf), "1 4:010700");
  EXPECT_EQ(started.attach(started.agreement(), 2), "1 3 7");
}

TEST(BlockingLinks, StartTheCycleWhenASampleArrives) {
  Newest started;
  ASSERT_EQ(started.attach(started.agreement()), "1 3 7");
  started.write();
  started.step();
  const std::size_t before = started.filter.cycles.size();
  for (int i = 0; i < 20; ++i) {
    started.rig.advance(3ms);
    started.write();
    const TimePoint now = started.rig.clock.now();
    started.step();
    EXPECT_EQ(started.rig.clock.now(), now) << "at once";
    EXPECT_EQ(started.filter.ticks.value().number, started.number);
    EXPECT_EQ(started.filter.cycles.back().planned, now);
    EXPECT_EQ(started.filter.cycles.back().period, longest) << "the wait that was agreed";
  }
  EXPECT_EQ(started.filter.cycles.size(), before + 20);
  EXPECT_EQ(started.filter.ticks.lost(), 0u);
  EXPECT_EQ(started.rig.vital.missed.load(), 0u);
}

TEST(BlockingLinks, OfKindQueuedStartTheCycleForEachSample) {
  Every started{LinkKind::Queued};
  ASSERT_EQ(started.attach(started.agreement()), "1 3 7");
  for (int i = 0; i < 20; ++i) {
    started.rig.advance(2ms);
    started.write();
    started.step();
    ASSERT_EQ(started.filter.ticks.samples().size(), 1u);
    EXPECT_EQ(started.filter.ticks.samples()[0].number, started.number);
  }
}

TEST(BlockingLinks, OfKindLoanedStartTheCycleWhenASampleIsLent) {
  Lent started{LinkKind::Loaned, R"( byte_order="native")"};
  ASSERT_EQ(started.attach(started.agreement()), "1 3 7");
  started.write();
  started.step();
  for (int i = 0; i < 20; ++i) {
    started.rig.advance(3ms);
    started.write();
    const TimePoint now = started.rig.clock.now();
    started.step();
    EXPECT_EQ(started.rig.clock.now(), now) << "at once";
    ASSERT_NE(started.filter.ticks.look(), nullptr);
    EXPECT_EQ(started.filter.ticks.look()->number, started.number);
  }
}

TEST(BlockingLinks, OfAProducerThatFloodsCostSamplesAndNoCycleBeforeTheLeastDistance) {
  Newest started;
  started.operate();
  const TimePoint began = started.rig.clock.now();
  const std::size_t before = started.filter.cycles.size();
  // Ten samples in each least distance.
  while (started.rig.clock.now() < began + 100ms) {
    for (int i = 0; i < 10; ++i) started.write();
    started.step();
  }
  const auto cycles = started.filter.cycles.size() - before;
  EXPECT_LE(cycles, 101u);
  EXPECT_GE(cycles, 99u) << "as quick as it may be";
  EXPECT_EQ(started.filter.ticks.lost(), 9 * cycles);
  EXPECT_EQ(started.rig.inhibited(), 0u);
  for (std::size_t i = before + 1; i < started.filter.cycles.size(); ++i)
    ASSERT_GE(started.filter.cycles[i].planned - started.filter.cycles[i - 1].planned, least);
}

/// A flood makes no limit short: the supervisor's silence counts waits, and housekeeping comes at its interval.
TEST(BlockingLinks, OfAProducerThatFloodsShortenNoLimitThatIsCountedInCycles) {
  Newest started;
  started.operate();
  started.rig.forget_telemetry();
  started.rig.supervisor_silent = true;
  const TimePoint began = started.rig.clock.now();
  std::size_t cycles = 0;
  while ((started.rig.inhibited() & inhibited_by_supervisor) == 0) {
    started.write();
    started.step();
    ++cycles;
    ASSERT_LT(started.rig.clock.now() - began, 1h);
  }
  const Duration silent_for = started.rig.clock.now() - began;
  EXPECT_GE(silent_for, longest * supervisor_silence_cycles(longest));
  EXPECT_LE(silent_for, longest * (supervisor_silence_cycles(longest) + 2));
  EXPECT_GE(cycles, 9 * supervisor_silence_cycles(longest)) << "it did flood";
  started.rig.service();
  const auto reports = started.rig.reports(3, 25).size();
  EXPECT_LE(reports, static_cast<std::size_t>(silent_for / longest) + 1)
      << "one in each longest wait, not in each cycle";
}

TEST(BlockingLinks, OfAProducerThatStopsLeaveTheCycleToTheClockAndGetOldInWaits) {
  Newest started;
  started.operate();
  const TimePoint last = started.rig.clock.now();
  started.steps(3);
  EXPECT_EQ(started.rig.clock.now(), last + 3 * longest) << "overdue, and started all the same";
  EXPECT_TRUE(started.filter.ticks.valid());
  EXPECT_EQ(started.rig.inhibited(), 0u);
  started.steps(2);
  EXPECT_FALSE(started.filter.ticks.valid());
  EXPECT_NE(started.rig.inhibited() & inhibited_by_link, 0u);
  started.rig.service();
  EXPECT_EQ(started.rig.heard(descriptor::framework_event::set_stale(0)), 1);
  started.write();
  const TimePoint back = started.rig.clock.now();
  started.step();
  EXPECT_LE(started.rig.clock.now(), back + least) << "the next sample starts a cycle again";
  EXPECT_TRUE(started.filter.ticks.valid());
}

/// The producer is killed between the first and the last word of a sample: an odd sequence stands there for ever.
TEST(BlockingLinks, OfAProducerThatDiesInItsSampleStartNoCycleForItAndGetOld) {
  Newest started;
  started.operate();
  const std::uint64_t whole = started.number;
  const Mapping mapping = [&] {
    // As the dead one had it mapped: nobody else can write there any more.
    const auto block = started.memory.map(started.shared, Access::ReadOnly).value();
    return block;
  }();
  auto& sequence = *reinterpret_cast<std::uint64_t*>(mapping.octets.data() + link_memory::sequence_at);
  std::atomic_ref<std::uint64_t>{sequence}.fetch_add(1);
  started.writer.reset();
  const std::size_t before = started.filter.cycles.size();
  const TimePoint died = started.rig.clock.now();
  started.steps(6);
  EXPECT_EQ(started.filter.ticks.value().number, whole) << "never a torn one";
  EXPECT_EQ(started.filter.cycles.size(), before + 6);
  EXPECT_GE(started.rig.clock.now(), died + 5 * longest) << "the half sample starts one cycle at most";
  EXPECT_NE(started.rig.inhibited() & inhibited_by_link, 0u);
}

/// What wakes is looked at again: without a sample nothing is read as new, and the set gets old as if nobody had woken.
TEST(BlockingLinks, ThatWakeWithoutASampleKeepNothingFresh) {
  Newest started;
  started.operate();
  const TimePoint began = started.rig.clock.now();
  std::size_t cycles = 0;
  while (started.filter.ticks.valid()) {
    // The sequence goes on and the count stays: a change of status, or a forger.
    started.writer->set_status(LinkStatus::Valid);
    started.step();
    ++cycles;
    ASSERT_LT(started.rig.clock.now() - began, 1h);
  }
  EXPECT_LE(started.rig.clock.now() - began, 5 * longest);
  EXPECT_GE(started.rig.clock.now() - began, 3 * longest);
  EXPECT_LE(cycles, 51u) << "never before the least distance";
}

TEST(BlockingLinks, OfAProducerInFaultInhibitWithTheSampleThatTellsItAndThenTheClockGoesOnAlone) {
  Newest started;
  started.operate();
  started.rig.advance(2ms);
  const TimePoint now = started.rig.clock.now();
  started.write(LinkStatus::Fault);
  started.step();
  EXPECT_EQ(started.rig.clock.now(), now) << "told at once";
  EXPECT_NE(started.rig.inhibited() & inhibited_by_link, 0u);
  for (int i = 0; i < 5; ++i) {
    const TimePoint before = started.rig.clock.now();
    started.write(LinkStatus::Fault);
    started.step();
    EXPECT_EQ(started.rig.clock.now(), before + longest);
  }
  started.write();
  started.step();
  EXPECT_TRUE(started.filter.ticks.valid());
  started.rig.advance(2ms);
  started.write();
  const TimePoint well = started.rig.clock.now();
  started.step();
  EXPECT_EQ(started.rig.clock.now(), well) << "well again, it starts cycles again";
}

TEST(BlockingLinks, ThatAreDetachedLeaveTheCycleToTheClock) {
  Newest started;
  ASSERT_EQ(started.attach(started.agreement()), "1 3 7");
  started.write();
  started.step();
  started.rig.detach(1);
  started.rig.service();
  started.step();
  started.rig.service();
  EXPECT_EQ(started.rig.subsystem.cycle_wait().word, nullptr);
  const TimePoint before = started.rig.clock.now();
  started.write();
  started.step();
  EXPECT_EQ(started.rig.clock.now(), before + longest);
}

/// Whatever arrives and whenever: two cycles are never nearer than the least distance unless the clock is due, never further apart
/// than the longest wait, and the newest sample is in the cycle that it started.
TEST(BlockingLinks, KeepBothDistancesWhateverTheirProducerDoes) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    std::mt19937 random{seed};
    Newest started;
    ASSERT_EQ(started.attach(started.agreement()), "1 3 7");
    started.filter.cycles.clear();
    for (int i = 0; i < 200; ++i) {
      if (random() % 4 != 0) started.rig.advance(std::chrono::microseconds{random() % 9'000});
      if (random() % 3 != 0) started.write(random() % 8 == 0 ? LinkStatus::Degraded : LinkStatus::Valid);
      if (random() % 9 == 0) started.writer->set_status(LinkStatus::Valid);
      started.step();
      ASSERT_TRUE(started.number == 0 || started.filter.ticks.value().number == started.number);
      if (i == 0) continue;
      const auto& cycles = started.filter.cycles;
      const Duration apart = cycles.back().planned - cycles[cycles.size() - 2].planned;
      ASSERT_GE(apart, least) << seed << ' ' << i;
      ASSERT_LE(apart, longest) << seed << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace hirosco::arrivals
