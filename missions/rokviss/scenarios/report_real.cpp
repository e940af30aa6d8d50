// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/report_real.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <map>
#include <numeric>
#include <thread>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::rokviss {
namespace {

constexpr std::size_t bins = 16;
using Bins = std::array<std::uint32_t, bins>;

/// CYCLE_TIMES and LINK_STATS, as reports 4714 and 4723 bring them once a second.
struct Member {
  std::string_view name;
  std::uint16_t apid;
  std::uint16_t structure;
  Bins execution{}, latency{};
  std::uint32_t received{0}, lost{0};
  // Of the first and the newest report, beside those of the bare loop: how many never ran.
  double first_cycles{0}, cycles{0};
  double first_bare{0}, bare{0};
};

/// What this machine lets through: a loop that only sleeps, with the period, priority and processor of the cycles beside
/// it. A host that takes the processor away costs both the same.
class BareLoop {
 public:
  BareLoop() {
    if (auto started = Thread::start("bare-loop", [this] { run(); })) thread_ = std::move(*started);
  }
  BareLoop(const BareLoop&) = delete;
  BareLoop& operator=(const BareLoop&) = delete;
  ~BareLoop() { ends_.store(true, std::memory_order_relaxed); }  // Thread joins
  [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_.load(std::memory_order_relaxed); }
  [[nodiscard]] double cycles_per_s() const noexcept {
    return static_cast<double>(cycles()) / seconds(SystemClock{}.now() - started_);
  }

 private:
  static constexpr Duration period = 500us;
  static constexpr int priority = 80;
  void run() {
    static_cast<void>(set_fifo_priority(priority) ? pin_to_cycle_cpu() : ask_for_short_slices());
    const SystemClock clock;
    TimePoint planned = clock.now();
    while (!ends_.load(std::memory_order_relaxed)) {
      planned += period;
      sleep_until(planned);
      cycles_.fetch_add(1, std::memory_order_relaxed);
      // As the cycles do: what was missed is skipped.
      if (const Duration late = clock.now() - planned; late > period) planned += late / period * period;
    }
  }

  const TimePoint started_ = SystemClock{}.now();
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> cycles_{0};
  Thread thread_;
};

[[nodiscard]] double sum(const Bins& counts) { return std::accumulate(counts.begin(), counts.end(), 0.0); }

struct Heard {
  std::array<Member, 2> members{{{"MANIPULATOR", 10, 4714}, {"JOYSTICK", 11, 4723}}};
  int reactions{0};  ///< events of medium or high severity
  std::size_t packets{0};
  BareLoop machine;
};

void take(Octets octets, Heard& heard) {
  const auto packet = pus::TelemetryView::parse(octets);
  if (!packet) return;
  ++heard.packets;
  if (packet->service() == 5 && (packet->subtype() == 3 || packet->subtype() == 4)) ++heard.reactions;
  if (packet->service() != 3 || packet->subtype() != 25) return;
  OctetReader reader{packet->source_data()};
  const auto structure = reader.get<std::uint16_t>();
  for (Member& member : heard.members) {
    if (packet->apid() != member.apid || structure != member.structure) continue;
    for (Bins* counts : {&member.execution, &member.latency})
      for (std::uint32_t& count : *counts) count = reader.get<std::uint32_t>();
    member.received = reader.get<std::uint32_t>();
    member.lost = reader.get<std::uint32_t>();
    member.cycles = sum(member.execution);
    member.bare = static_cast<double>(heard.machine.cycles());
    if (member.first_cycles > 0) continue;
    member.first_cycles = member.cycles;
    member.first_bare = member.bare;
  }
}

/// Listens until the flight closes the link in its end.
void listen(Process& flight, const std::string& mission, Heard& heard) {
  for (;;) {
    const auto ended = flight.poll();
    if (!ended || ended->has_value()) return;
    const auto place = tools::find_ground_link("report", {.mission = mission, .instance = {}, .host = {}});
    if (!place) return;
    auto connection = tools::GroundConnection::open(place->host, place->port);
    if (!connection) {
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
      continue;
    }
    for (;;) {
      const auto packet = connection->receive(std::chrono::seconds{1});
      if (!packet) break;
      if (packet->has_value()) take(**packet, heard);
    }
  }
}

/// One line with every bin that is not empty.
[[nodiscard]] std::string line_of(std::string_view name, std::string_view what, const Bins& counts) {
  std::string line = fmt::format("{} {}:", name, what);
  for (std::size_t i = 0; i < bins; ++i)
    if (counts[i] != 0) line += fmt::format(" <{} us {};", 1U << i, counts[i]);
  return line;
}

[[nodiscard]] simulation::Plot plot_of(std::string_view name, std::string_view what, std::string_view title,
                                       const Bins& counts) {
  simulation::Curve curve{.name = std::string{what}};
  for (std::size_t i = 0; i < bins; ++i) curve.add(static_cast<double>(i), counts[i]);
  return {.name = fmt::format("real-{}-{}", name, what),
          .title = fmt::format("{}: {}", name, title),
          .x_label = "below / us (bins of powers of two)",
          .y_label = "cycles",
          .caption = fmt::format(
              "{:.0f} cycles of 500 us, counted logarithmically; the last bin holds all above 16,384 us.", sum(counts)),
          .curves = {std::move(curve)},
          .bars = true};
}

void judge(const Heard& heard, simulation::Findings& findings) {
  constexpr std::size_t first_bin_beyond = 10;  // 512 us and above: longer than the period
  for (const Member& member : heard.members) {
    const std::string prefix = fmt::format("REAL-{}-", member.name);
    if (member.cycles == member.first_cycles) {
      findings.problems.push_back(fmt::format("{} told of its cycles less than twice", member.name));
      continue;
    }
    const double cycles = member.cycles;
    const double beyond =
        std::accumulate(member.execution.begin() + first_bin_beyond, member.execution.end(), 0.0) / cycles;
    findings.figures[prefix + "cycles"] = (cycles - member.first_cycles) / (member.bare - member.first_bare);
    findings.figures[prefix + "beyond"] = beyond;
    findings.figures[prefix + "received"] = member.received / cycles;
    findings.notes.push_back(line_of(member.name, "own work", member.execution));
    findings.notes.push_back(line_of(member.name, "late start", member.latency));
    findings.notes.push_back(fmt::format("{}: {} samples came in {:.0f} cycles, {} came and went between two cycles.",
                                         member.name, member.received, cycles, member.lost));
    findings.plots.push_back(plot_of(member.name, "execution", "time of a cycle's own work", member.execution));
    findings.plots.push_back(
        plot_of(member.name, "latency", "start of a cycle after its planned instant", member.latency));
  }
  findings.figures["REAL-reactions"] = heard.reactions;
  findings.notes.push_back(
      fmt::format("A bare loop of 0.5 ms beside them ran {:.0f} times a second.", heard.machine.cycles_per_s()));
}

}  // namespace

simulation::Chapter fly_for_real(const std::filesystem::path& mission, Duration span) {
  simulation::Chapter chapter{
      "REAL",
      "On real processes",
      fmt::format("{:g} s of the coupled mission with real processes and clocks", seconds(span)),
      {},
      {}};
  ProcessStart start;
  start.executable = find_program("hirosco").string();
  start.arguments = {"run", mission.string(), "--for", fmt::format("{:.3f}", seconds(span)), "--quiet"};
  auto flight = Process::spawn(start);
  if (!flight) {
    chapter.findings.problems.emplace_back("the mission cannot be started");
    return chapter;
  }
  Heard heard;
  listen(*flight, mission.string(), heard);
  const auto end = flight->poll();
  if (!end || !end->has_value() || !(*end)->success())
    chapter.findings.problems.emplace_back("the flight did not end in order");
  judge(heard, chapter.findings);
  return chapter;
}

}  // namespace hirosco::rokviss
