// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Pings over both hops, ground link to supervisor to subsystem and back, with permission and log, against a bare forwarder
// that moves the same packets in batches. Ground and subsystem are processes of their own that do nothing else.
// With a third argument, so many pings a second: with nothing beside them, and while all that was said before comes down again and again.
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <new>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/wait_set.hpp"
#include "supervisor/platform/storage/log_readings.hpp"
#include "supervisor/supervisor.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint16_t ground_apid = 2;
constexpr std::uint16_t echo_apid = 10;
constexpr int outstanding = 64;
constexpr int pings = 20'000;
constexpr int warm_up = 2'000;
/// So long without an answer, and some were refused: another flight of the same mission has its devices, say.
constexpr Duration patience = 10s;

/// How a round pings.
struct Pace {
  int per_second{0};  ///< 0: as fast as they come back
  bool retrieves{false};  ///< TC[129,11] for all of the log, again where it has ended
};

/// What a round of pings came to, in memory that the ground shares.
struct Round {
  double per_second{};
  double retrieved_per_second{};
  double kept{1};  ///< of the records that the log was given
  Figures round_trip_us{};
};

void wait_for(int descriptor, Duration limit = 100ms) {
  pollfd wanted{.fd = descriptor, .events = POLLIN, .revents = 0};
  const timespec wait{.tv_sec = 0, .tv_nsec = static_cast<long>(std::max<std::int64_t>(limit.count(), 0))};
  ::ppoll(&wanted, 1, &wait, nullptr);
}

void retrieve(SocketChannel& channel, std::uint16_t count) {
  constexpr OnboardTime ever{std::chrono::hours{24 * 365 * 100}};
  std::array<std::byte, 64> octets{};
  const auto packet = pus::write_telecommand(octets,
                                             {.apid = pus::supervisor_apid,
                                              .sequence_count = count,
                                              .ack = 0,
                                              .service = pus::st129::service_type,
                                              .subtype = pus::st129::retrieve,
                                              .source = 7},
                                             pus::st129::write_retrieve({OnboardTime{}, ever, true}));
  static_cast<void>(channel.send({.kind = MessageKind::GroundTelecommand, .link = 1, .packet = *packet}));
}

/// The ground's process: keeps `outstanding` pings under way and takes each answer by its count.
Round ping(SocketChannel& channel, const Clock& clock, const Pace& pace) {
  std::array<TimePoint, 16'384> sent{};
  std::vector<std::int64_t> took;
  took.reserve(pings);
  int begun = 0;
  int ended = 0;
  TimePoint start{}, answered = clock.now();
  std::uint64_t retrieved = 0;
  std::uint16_t questions = 0;
  const TimePoint first = clock.now();
  const auto due = [&] {  // of the next ping
    return pace.per_second == 0 ? first : first + std::chrono::nanoseconds{1s} / pace.per_second * begun;
  };
  MessageBuffer buffer;
  std::array<std::byte, 64> octets{};
  while (ended < warm_up + pings) {
    while (begun - ended < outstanding && begun < warm_up + pings && clock.now() >= due()) {
      const auto count = static_cast<std::uint16_t>(begun % 16'384);
      const auto packet = pus::write_telecommand(
          octets, {.apid = echo_apid, .sequence_count = count, .ack = 0, .service = 17, .subtype = 1, .source = 7}, {});
      sent[count] = clock.now();
      if (!channel.send({.kind = MessageKind::GroundTelecommand, .link = 1, .packet = *packet})) break;
      ++begun;
    }
    const auto found = channel.receive(buffer);
    if (!found) std::_Exit(1);
    if (found->flow == Flow::None) {
      if (clock.now() - answered > patience) std::_Exit(1);
      wait_for(channel.wait_descriptor(), pace.per_second == 0 ? 100ms : std::min<Duration>(due() - clock.now(), 10ms));
      continue;
    }
    const auto report = pus::TelemetryView::parse(found->message.packet);
    const bool again = report && report->service() == pus::st129::service_type;
    if (again && report->subtype() == pus::st129::retrieved && ended >= warm_up) ++retrieved;
    if (again && report->subtype() == pus::st129::retrieval_end) retrieve(channel, questions++);
    if (!report || report->service() != 17 || report->apid() != echo_apid) continue;  // housekeeping, copies
    const TimePoint now = answered = clock.now();
    if (ended == warm_up) start = now;
    if (ended == warm_up / 2 && pace.retrieves) retrieve(channel, questions++);
    if (ended >= warm_up) took.push_back((now - sent[report->sequence_count()]).count());
    ++ended;
  }
  const double took_s = seconds(clock.now() - start);
  return {.per_second = pings / took_s,
          .retrieved_per_second = static_cast<double>(retrieved) / took_s,
          .round_trip_us = figures_of(took, 1e-3)};
}

/// The subsystem's process: answers each ping with its count.
[[noreturn]] void echo(SocketChannel& channel, const Clock& clock) {
  MessageBuffer buffer;
  std::array<std::byte, 64> octets{};
  for (;;) {
    const auto found = channel.receive(buffer);
    if (!found) std::_Exit(0);
    if (found->flow == Flow::None) {
      wait_for(channel.wait_descriptor());
      continue;
    }
    const auto ping = pus::TelecommandView::parse(found->message.packet);
    if (!ping) continue;
    const auto answer = pus::write_telemetry(octets,
                                             {.apid = echo_apid,
                                              .sequence_count = ping->sequence_count(),
                                              .service = 17,
                                              .subtype = 2,
                                              .destination = ping->source(),
                                              .time = clock.onboard()},
                                             {});
    while (!channel.send({.packet = *answer})) ::usleep(50);
  }
}

/// Both ends of a channel, one of which is a child's.
struct Ends {
  std::pair<FileDescriptor, FileDescriptor> pair{SocketChannel::make_pair().value()};
};

class Children {
 public:
  ~Children() {
    for (const pid_t child : children_) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
  }
  template <class Work>
  void start(Work work) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      work();
      std::_Exit(0);
    }
    children_.push_back(child);
  }
  /// The first one has ended.
  [[nodiscard]] bool first_ended() { return ::waitpid(children_.front(), nullptr, WNOHANG) > 0; }

 private:
  std::vector<pid_t> children_;
};

/// Hands out what was prepared before the processes began.
class Prepared final : public supervisor::ProcessLauncher {
 public:
  explicit Prepared(SealedMemory& memory) : memory_{memory} {}
  void offer(std::uint16_t apid, FileDescriptor end) { ends_[apid] = std::move(end); }
  [[nodiscard]] Result<supervisor::LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override {
    supervisor::LaunchedSubsystem launched;
    launched.vital = memory_.map(memory_.create("vital", sizeof(VitalPage)).value(), Access::ReadWrite).value();
    launched.permit = memory_.map(memory_.create("permit", sizeof(PermitPage)).value(), Access::ReadWrite).value();
    auto* vital = ::new (launched.vital.octets.data()) VitalPage;
    ::new (launched.permit.octets.data()) PermitPage;
    vital->state.store(static_cast<std::uint32_t>(descriptor::State::PreOperational));
    FileDescriptor& end = ends_[subsystem.subsystem.id];
    if (!end) std::tie(end, silent_.emplace_back()) = SocketChannel::make_pair().value();
    launched.port = std::make_unique<supervisor::LocalMemberPort>(
        std::make_unique<SocketChannel>(std::move(end), SocketChannel::Memory::Dropped),  // as in a flight
        launched.vital, launched.permit);
    launched.process = subsystem.subsystem.id;
    return launched;
  }
  [[nodiscard]] std::optional<supervisor::ProcessEnd> ended(std::uint32_t) override { return std::nullopt; }
  void kill(std::uint32_t) override {}

 private:
  SealedMemory& memory_;
  std::map<std::uint16_t, FileDescriptor> ends_;
  std::vector<FileDescriptor> silent_;  ///< the other ends of those who say nothing
};

struct Silent final : supervisor::Observer {
  void told(OnboardTime, std::string_view) override {}
};

[[nodiscard]] descriptor::Mission mission_of(const std::filesystem::path& file) {
  const auto source = descriptor::file_system();
  auto reading = descriptor::read_mission(file, source);
  if (!reading.value) std::exit(1);
  descriptor::Mission mission = std::move(*reading.value);
  // Nothing is commissioned and nothing has devices: ground and subsystem are stand-ins.
  mission.start_mode.clear();
  for (auto& member : mission.subsystems) member.subsystem.configurations.clear();
  return mission;
}

/// The product: the supervisor between ground and subsystem.
Round routed(const std::filesystem::path& file, const SystemClock& clock, const Pace& pace) {
  SealedMemory memory;
  SystemFlowFactory flows;
  const MemoryHandle figures = memory.create("figures", sizeof(Round)).value();
  const Mapping shared = memory.map(figures, Access::ReadWrite).value();
  Ends ground, echoing;
  Children children;
  Prepared launcher{memory};
  children.start([&] {
    SocketChannel channel{std::move(ground.pair.second)};
    ::new (shared.octets.data()) Round{ping(channel, clock, pace)};
  });
  children.start([&] {
    SocketChannel channel{std::move(echoing.pair.second)};
    echo(channel, clock);
  });
  ground.pair.second.reset();
  echoing.pair.second.reset();
  launcher.offer(ground_apid, std::move(ground.pair.first));
  launcher.offer(echo_apid, std::move(echoing.pair.first));
  const auto folder = std::filesystem::temp_directory_path() / ("hirosco-routing-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  double kept{};
  {
    const descriptor::Mission mission = mission_of(file);
    Silent silent;
    // As in a flight, whoever waits for the disk is woken by the log.
    auto log_progress = WakeEvent::create().value();
    supervisor::ThreadedPacketLog::Options log_options;
    log_options.on_progress = [&] { log_progress.notify(); };
    supervisor::ThreadedPacketLog log{
        clock, supervisor::open_database(supervisor::DatabaseStrategy::Sqlite, folder / "log.db").value(),
        std::move(log_options)};
    supervisor::ThreadedLogReadings log_readings{supervisor::reader_of(folder / "log.db", "")};
    supervisor::Guard guard{{.clock = clock, .flows = flows, .first_epoch = 1, .on_finding = {}}};
    supervisor::Supervisor craft{
        {.mission = mission,
         .platform = {.clock = clock, .memory = memory, .flows = flows, .realtime = false, .explain = {}},
         .launcher = launcher,
         .guard = guard,
         .log = log,
         .open_database = [](supervisor::DatabaseStrategy) -> std::unique_ptr<supervisor::Database> { return nullptr; },
         .observer = silent,
         .log_readings = &log_readings}};
    craft.start();
    TimePoint guard_wakes{};  // in a flight it has a thread of its own
    while (!children.first_ended()) {
      if (clock.now() >= guard_wakes) guard_wakes = guard.step(clock.now());
      const TimePoint wake = craft.step(clock.now());
      std::array<pollfd, 3> waits{pollfd{.fd = log_progress.descriptor(), .events = POLLIN, .revents = 0}};
      std::size_t used = 1;
      for (const auto& member : craft.members())
        if (member.alive() && (member.apid() == ground_apid || member.apid() == echo_apid) && craft.reads(member))
          waits[used++] = {.fd = member.channel()->wait_descriptor(), .events = POLLIN, .revents = 0};
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(wake - clock.now()).count();
      ::poll(waits.data(), used, static_cast<int>(std::clamp<std::int64_t>(left, 0, 10)));
      if (waits[0].revents != 0) log_progress.clear();
    }
    const supervisor::LogCounters counted = log.counters();
    const auto records = static_cast<double>(counted.accepted + counted.lost + counted.refused);
    kept = static_cast<double>(counted.accepted) / records;
  }
  std::filesystem::remove_all(folder);
  Round round = *reinterpret_cast<const Round*>(shared.octets.data());
  round.kept = kept;
  return round;
}

/// Moves what waits from one socket to another, many packets in one call.
void forward(int from, int to) {
  constexpr int batch = 32;
  static std::array<std::array<std::byte, 4104>, batch> room;
  std::array<iovec, batch> parts;
  std::array<mmsghdr, batch> messages{};
  for (std::size_t i = 0; i < batch; ++i) {
    parts[i] = {room[i].data(), room[i].size()};
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int got = ::recvmmsg(from, messages.data(), batch, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < got; ++i)
    parts[static_cast<std::size_t>(i)].iov_len = messages[static_cast<std::size_t>(i)].msg_len;
  for (int done = 0; done < got;) {
    const int sent =
        ::sendmmsg(to, messages.data() + done, static_cast<unsigned>(got - done), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) done += sent;
    else ::usleep(50);
  }
}

/// What nobody can be quicker than who does nothing: the same packets, only moved.
Round forwarded(const SystemClock& clock) {
  SealedMemory memory;
  const Mapping shared = memory.map(memory.create("figures", sizeof(Round)).value(), Access::ReadWrite).value();
  Ends ground, echoing;
  Children children;
  children.start([&] {
    SocketChannel channel{std::move(ground.pair.second)};
    ::new (shared.octets.data()) Round{ping(channel, clock, {})};
  });
  children.start([&] {
    SocketChannel channel{std::move(echoing.pair.second)};
    echo(channel, clock);
  });
  const int one = ground.pair.first.get();
  const int other = echoing.pair.first.get();
  while (!children.first_ended()) {
    std::array<pollfd, 2> waits{pollfd{.fd = one, .events = POLLIN, .revents = 0},
                                pollfd{.fd = other, .events = POLLIN, .revents = 0}};
    ::poll(waits.data(), waits.size(), 10);
    if (waits[0].revents != 0) forward(one, other);
    if (waits[1].revents != 0) forward(other, one);
  }
  return *reinterpret_cast<const Round*>(shared.octets.data());
}

int run(const std::filesystem::path& file, int repeats) {
  const SystemClock clock;
  Series ours{"hirosco", {}};
  Series bare{"forwarder", {}};
  std::vector<double> our_rates, bare_rates, ratios, kept;
  for (int i = 0; i < repeats; ++i) {
    const Round mine = routed(file, clock, {});
    const Round other = forwarded(clock);
    if (mine.per_second <= 0 || other.per_second <= 0) return 1;
    ours.repeats.push_back(mine.round_trip_us);
    bare.repeats.push_back(other.round_trip_us);
    our_rates.push_back(mine.per_second);
    bare_rates.push_back(other.per_second);
    ratios.push_back(other.per_second / mine.per_second);
    kept.push_back(mine.kept);
  }
  std::printf("Routing: %d pings to a subsystem and back, %d under way, median of %d\n", pings, outstanding, repeats);
  std::printf("%-28s %10.0f pings/s, with permission and log\n", "hirosco", median(our_rates));
  std::printf("%-28s %10.0f pings/s, batches of a bare socket\n", "forwarder", median(bare_rates));
  std::printf("%-28s %10.2f\n", "forwarder / hirosco", median(ratios));
  std::printf("%-28s %10.1f %% of its records, the others stand in gaps\n", "kept by the log", 1e2 * median(kept));
  ours.print("us there and back");
  bare.print("us there and back");
  return 0;
}

/// The live stream beside what comes down again (docs/adr/0140), in turns.
int run_beside(const std::filesystem::path& file, int repeats, int per_second) {
  const SystemClock clock;
  Series alone{"alone", {}}, beside{"beside", {}};
  std::vector<double> rates, rates_beside, retrieved, ratios;
  for (int i = 0; i < repeats; ++i) {
    const Round without = routed(file, clock, {.per_second = per_second});
    const Round with = routed(file, clock, {.per_second = per_second, .retrieves = true});
    if (without.per_second <= 0 || with.retrieved_per_second <= 0) return 1;
    alone.repeats.push_back(without.round_trip_us);
    beside.repeats.push_back(with.round_trip_us);
    rates.push_back(without.per_second);
    rates_beside.push_back(with.per_second);
    retrieved.push_back(with.retrieved_per_second);
    ratios.push_back(with.round_trip_us.p50 / without.round_trip_us.p50);
  }
  std::printf("Routing: %d pings a second to a subsystem and back, %d of them, median of %d\n", per_second, pings,
              repeats);
  std::printf("%-28s %10.0f pings/s\n", "alone", median(rates));
  std::printf("%-28s %10.0f pings/s, %.0f reports/s come down again\n", "beside a retrieval", median(rates_beside),
              median(retrieved));
  std::printf("%-28s %10.2f of the medians there and back\n", "beside / alone", median(ratios));
  alone.print("us there and back");
  beside.print("us there and back");
  return 0;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("bench_routing MISSION.xml [REPEATS [PACKETS_PER_SECOND]]\n", stderr);
    return 2;
  }
  const std::filesystem::path file = argv[1];
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 5;
  if (argc > 3) return hirosco::bench::run_beside(file, repeats, std::max(1, std::atoi(argv[3])));
  return hirosco::bench::run(file, repeats);
}
