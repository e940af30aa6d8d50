// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What four links add to a cycle: a whole cycle of the framework in Operational that requires a set of 64 and one of 256 octets and provides two
// alike, against the same cycle without links and the bare reads and writes of such links, which it cannot do without. Each round has each of the
// three once, the two cycles in turns first; what it costs to look at the clock is taken off. The partners write and read between the rounds, which is not measured.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

using pus::st128::Role;

constexpr std::size_t small_values = 8, large_values = 32;  ///< of 8 octets
constexpr std::uint8_t with_links = 1, without_links = 2;  ///< configurations
constexpr Duration sampling = 500us;
/// Between two steps of the service loop, which is no part of a cycle and takes what cycles report.
constexpr int rounds_between = 32;

const std::string crossing_descriptor = R"(<Subsystem name="CROSSING" id="10">
  <Parameters>
    <ParamRef name="SMALL" id="1" type="DOUBLE" count="8"/>
    <ParamRef name="LARGE" id="2" type="DOUBLE" count="32"/>
  </Parameters>
  <Configuration name="LINKED" id="1" priority="80" sampling_us="500">
    <RealTimeLinkService>
      <Provides name="SMALL_OUT"><ParamRef name="SMALL"/></Provides>
      <Provides name="LARGE_OUT"><ParamRef name="LARGE"/></Provides>
      <Requires name="SMALL_IN"><Field name="VALUES" type="DOUBLE" count="8"/></Requires>
      <Requires name="LARGE_IN"><Field name="VALUES" type="DOUBLE" count="32"/></Requires>
    </RealTimeLinkService>
  </Configuration>
  <Configuration name="ALONE" id="2" priority="80" sampling_us="500"/>
</Subsystem>
)";

/// Its own work is the same with and without links: both of its parameters are new in each cycle.
class Crossing final : public Subsystem {
 public:
  template <std::size_t values>
  struct Numbers {
    std::array<double, values> numbers;
  };
  LinkInput<Numbers<small_values>> small_in;
  LinkInput<Numbers<large_values>> large_in;

 private:
  Result<Step> software_init() override {
    publish("SMALL", small_);
    publish("LARGE", large_);
    require_link("SMALL_IN", small_in);
    require_link("LARGE_IN", large_in);
    return done;
  }
  Result<> operational(const Cycle& cycle) noexcept override {
    values_.front() = static_cast<double>(cycle.count);
    std::array<double, small_values> few{values_.front()};
    small_.store(few);
    large_.store(values_);
    return ok();
  }
  std::array<double, large_values> values_{};
  Parameter<std::array<double, small_values>> small_;
  Parameter<std::array<double, large_values>> large_;
};

/// The other end of a link.
struct Partner {
  Mapping mapping;
  LatestWriter writer;
  LatestReader reader;
};

/// Two links each way, and what passes over them.
template <class End>
struct Four {
  End small_in, large_in, small_out, large_out;
};
using Partners = Four<Partner>;

std::array<std::byte, 8 * small_values> small_payload{};
std::array<std::byte, 8 * large_values> large_payload{};

[[nodiscard]] int read_both(LatestReader& small, LatestReader& large) {
  return (small.read(small_payload).flow == Flow::New ? 1 : 0) + (large.read(large_payload).flow == Flow::New ? 1 : 0);
}
void write_both(LatestWriter& small, LatestWriter& large, TimePoint now) {
  small.write(small_payload, now, LinkStatus::Valid);
  large.write(large_payload, now, LinkStatus::Valid);
}

/// A subsystem in Operational whose cycles are stepped here, by the clock of the computer.
class Stepped {
 public:
  Stepped(const Clock& clock, std::uint8_t configuration)
      : clock_{clock},
        subsystem_{author_,
                   testing::read_descriptor(crossing_descriptor),
                   {.clock = clock,
                    .memory = memory_,
                    .flows = flows_,
                    .realtime = true,
                    .explain = [](std::string_view text) { std::fprintf(stderr, "%s\n", std::string{text}.c_str()); }},
                   channels_.subsystem_end(),
                   vital_,
                   permit_} {
    permit_.release();
    call("SET_STATE", static_cast<double>(State::PreOperational));
    call("CONFIGURE", configuration);
    if (configuration == with_links) {
      partners_.emplace(attach(1, Role::Consumer, "SMALL_IN", "VALUES", small_values),
                        attach(2, Role::Consumer, "LARGE_IN", "VALUES", large_values),
                        attach(3, Role::Producer, "SMALL_OUT", "SMALL", small_values),
                        attach(4, Role::Producer, "LARGE_OUT", "LARGE", large_values));
      feed();
      cycle(clock_.now());
    }
    for (const State state : {State::SafeOperational, State::Operational})
      call("SET_STATE", static_cast<double>(state));
  }
  Stepped(const Stepped&) = delete;
  Stepped& operator=(const Stepped&) = delete;

  /// What comes before a cycle: its partners have written, its supervisor is there.
  void feed() {
    permit_.heartbeat.fetch_add(1);
    if (partners_) write_both(partners_->small_in.writer, partners_->large_in.writer, clock_.now());
  }
  void cycle(TimePoint planned) { static_cast<void>(subsystem_.cycle_step(planned)); }
  /// What its partners found new.
  [[nodiscard]] int taken() {
    return partners_ ? read_both(partners_->small_out.reader, partners_->large_out.reader) : 0;
  }
  void service() {
    permit_.heartbeat.fetch_add(1);
    static_cast<void>(subsystem_.service_step(clock_.now()));
    for (MessageBuffer buffer;;) {
      const auto found = channels_.supervisor_end().receive(buffer);
      if (!found || found->flow == Flow::None) return;
    }
  }
  [[nodiscard]] bool acts() const {
    return subsystem_.state() == State::Operational && vital_.inhibited.load() == 0 && vital_.lost_reports.load() == 0;
  }
  /// Samples that it got by both of its links.
  [[nodiscard]] std::uint64_t received() { return subsystem_.cycle().link_statistics().load().received; }

 private:
  void send(std::uint8_t service_type, std::uint8_t subtype, Octets data, const MemoryHandle& beside = {}) {
    std::vector<std::byte> buffer(max_packet_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = subsystem_.descriptor().id,
                                                .sequence_count = ++sent_,
                                                .ack = pus::ack_all,
                                                .service = service_type,
                                                .subtype = subtype,
                                                .source = testing::Rig::source},
                                               data);
    static_cast<void>(channels_.supervisor_end().send({.packet = packet.value(), .memory = beside}));
    constexpr int rounds = 12;  // as a rig settles
    for (int i = 0; i < rounds; ++i) {
      service();
      const auto demand = subsystem_.cycle_demand();
      feed();
      if (demand.wanted) cycle(clock_.now());
      else subsystem_.cycle_parked(demand.ticket);
    }
  }
  void call(std::string_view name, double argument) {
    for (const auto& function : pus::common_functions())
      if (function.name == name) send(8, 1, pus::encode_call(function, std::array{argument}).value());
  }
  Partner attach(std::uint8_t link, Role role, std::string set, std::string field, std::uint32_t count) {
    const pus::st128::AttachRequest request{.link = link,
                                            .role = role,
                                            .epoch = 5,
                                            .set = std::move(set),
                                            .agreement = {.method = LinkMethod::SharedMemory,
                                                          .byte_order = descriptor::ByteOrder::Little,
                                                          .kind = LinkKind::Latest,
                                                          .producer_period = sampling,
                                                          .consumer_period = sampling,
                                                          .fields = {{std::move(field), Type::Double, count}}}};
    const LinkLayout layout = request.agreement.layout(request.epoch);
    const MemoryHandle memory = memory_.create("link", link_memory_octets(layout.payload_octets)).value();
    Partner partner;
    if (role == Role::Consumer) {
      partner.mapping = memory_.map(memory, Access::ReadWrite).value();
      partner.writer = LatestWriter::make(partner.mapping.octets, layout).value();
      static_cast<void>(memory_.seal_writers(memory));
    }
    std::vector<std::byte> buffer(max_packet_octets);
    const std::size_t octets = pus::st128::write_attach_request(buffer, request).value();
    send(pus::st128::service_type, pus::st128::attach, Octets{buffer}.first(octets), memory);
    if (role == Role::Producer) {
      partner.mapping = memory_.map(memory, Access::ReadOnly).value();
      partner.reader = LatestReader::make(partner.mapping.octets, layout).value();
    }
    return partner;
  }

  const Clock& clock_;
  HeapMemory memory_;
  LocalFlows flows_;
  ChannelPair channels_{4096};
  VitalPage vital_{};
  PermitPage permit_{};
  Crossing author_;
  GenericSubsystem subsystem_;
  std::optional<Partners> partners_;
  std::uint16_t sent_{0};
};

/// Both ends of four links with nothing of a cycle around them.
class Bare {
 public:
  explicit Bare(HeapMemory& memory) {
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const auto octets = static_cast<std::uint32_t>(i % 2 == 0 ? small_payload.size() : large_payload.size());
      const LinkLayout layout{1, octets, 1, sampling};
      ends_[i].mapping =
          memory.map(memory.create("link", link_memory_octets(octets)).value(), Access::ReadWrite).value();
      ends_[i].writer = LatestWriter::make(ends_[i].mapping.octets, layout).value();
      ends_[i].reader = LatestReader::make(ends_[i].mapping.octets, layout).value();
    }
  }
  void feed(TimePoint now) { write_both(ends_[0].writer, ends_[1].writer, now); }
  [[nodiscard]] int exchange(TimePoint now) {
    const int taken = read_both(ends_[0].reader, ends_[1].reader);
    write_both(ends_[2].writer, ends_[3].writer, now);
    return taken;
  }

 private:
  std::array<Partner, 4> ends_;
};

[[nodiscard]] std::int64_t cost_of_looking(const Clock& clock) {
  std::vector<std::int64_t> samples(10'000);
  for (std::int64_t& sample : samples) {
    const TimePoint begin = clock.now();
    sample = (clock.now() - begin).count();
  }
  return static_cast<std::int64_t>(figures_of(samples, 1.0).p50);
}

/// What one repeat took, in nanoseconds.
struct Contest {
  std::vector<std::int64_t> linked, alone, bare, parts;
};
/// Nothing: a cycle did not act, or not each sample passed.
[[nodiscard]] std::optional<Contest> contest(const Clock& clock, Stepped& linked, Stepped& alone, Bare& bare,
                                             int rounds) {
  const std::int64_t looking = cost_of_looking(clock);
  const auto took = [&](auto&& work) {
    const TimePoint begin = clock.now();
    work(begin);
    return std::max<std::int64_t>((clock.now() - begin).count() - looking, 1);
  };
  Contest found;
  for (auto* samples : {&found.linked, &found.alone, &found.bare, &found.parts})
    samples->reserve(static_cast<std::size_t>(rounds));
  std::uint64_t taken = 0;
  const std::uint64_t before = linked.received();
  for (int round = 0; round < rounds; ++round) {
    bare.feed(clock.now());
    found.bare.push_back(took([&](TimePoint now) { taken += static_cast<std::uint64_t>(bare.exchange(now)); }));
    // Who comes second finds the code of a cycle in the cache.
    for (const bool has_links : {round % 2 == 0, round % 2 != 0}) {
      Stepped& stepped = has_links ? linked : alone;
      stepped.feed();
      (has_links ? found.linked : found.alone).push_back(took([&](TimePoint now) { stepped.cycle(now); }));
      taken += static_cast<std::uint64_t>(stepped.taken());
    }
    found.parts.push_back(found.bare.back() + found.alone.back());
    if (round % rounds_between != 0) continue;
    alone.service();
    linked.service();
  }
  const auto all = 2 * static_cast<std::uint64_t>(rounds);
  if (taken != 2 * all || linked.received() - before != all || !linked.acts() || !alone.acts()) return std::nullopt;
  return found;
}

int run(int repeats, int rounds) {
  const SystemClock clock;
  (void)lock_memory();
  (void)pin_to_cpu(0);
  Stepped linked{clock, with_links}, alone{clock, without_links};
  HeapMemory memory;
  Bare bare{memory};
  if (!linked.acts() || !alone.acts() || !contest(clock, linked, alone, bare, rounds_between * rounds_between)) {
    std::fputs("the cycles do not act, or not each sample passes: nothing is measured\n", stderr);
    return EXIT_FAILURE;
  }
  const bool realtime = set_fifo_priority(50).has_value();
  Series with{"cycle with four links", {}}, without{"cycle without links", {}};
  Series ends{"bare reads and writes", {}}, parts{"both together", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    auto found = contest(clock, linked, alone, bare, rounds);
    if (!found) return EXIT_FAILURE;
    with.repeats.push_back(figures_of(found->linked, 1.0));
    without.repeats.push_back(figures_of(found->alone, 1.0));
    ends.repeats.push_back(figures_of(found->bare, 1.0));
    parts.repeats.push_back(figures_of(found->parts, 1.0));
  }
  std::printf("A cycle with two links in and two out, of 64 and 256 octets, %d cycles, median of %d repeats, %s\n",
              rounds, repeats, realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  for (const Series* series : {&with, &without, &ends, &parts}) series->print("ns");
  with.print_ratio(parts);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 20'000;
  return hirosco::bench::run(repeats, rounds);
}
