// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "hirosco/pus/words/given_words.hpp"
#include "simulation/spacecraft/flight_origin.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/injection_plan.hpp"
#include "tools/hirosco/named_request.hpp"
#include "tools/hirosco/readiness.hpp"

namespace hirosco::tools {
namespace {

/// The story goes into the log, which is printed at the end: one stream, in order. What is wrong with a simulated device is no part of it.
struct Nobody final : supervisor::Observer {
  void told(OnboardTime, std::string_view line) override {
    if (line.starts_with("no simulated device ") || line.starts_with("simulated device "))
      fmt::print(stderr, "hirosco simulate: {}\n", line);
  }
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// One line for one record: time, kind, ways, words, and the octets where they are wanted.
void print_record(const supervisor::LogRecord& record, const pus::PacketDescriber& describer, bool octets) {
  fmt::print("{:12.6f} {:<21} {} -> {}", seconds(record.monotonic - TimePoint{1s}), to_text(record.kind),
             record.source == 0 ? "ground" : describer.name_of(record.source),
             record.peer == 0 ? "ground" : describer.name_of(record.peer));
  if (!record.packet.empty()) fmt::print(" {}", describer.describe(record.packet));
  if (!record.note.view().empty()) fmt::print(" \"{}\"", record.note.view());
  if (octets && !record.packet.empty()) fmt::print(" ");
  if (octets)
    for (const std::byte octet : record.packet) fmt::print("{:02x}", std::to_integer<unsigned>(octet));
  fmt::print("\n");
}

/// World truth of all devices as CSV behind a line of where it comes from: "DEVICE.NAME" a column, a line after each cycle of whose device is the first. While that
/// has none, Offline or dead, the world goes on all the same: a line each 10 ms.
class Trace {
 public:
  static constexpr Duration without_cycles = std::chrono::milliseconds{10};
  explicit Trace(const descriptor::Mission& mission) : mission_{mission} {}
  void head(const std::string& origin) { fmt::print(file_.get(), "{}{}\n", simulation::origin_mark, origin); }
  [[nodiscard]] bool open(const std::string& path) {
    file_.reset(std::fopen(path.c_str(), "w"));
    return file_ != nullptr;
  }
  void write_line(std::string_view subsystem, TimePoint now, simulation::Spacecraft& craft) {
    if (mission_.devices.empty() || subsystem != mission_.devices.front().subsystem) return;
    written_ = now;
    std::string names = "t_s", values = fmt::format("{:.6f}", seconds(now - TimePoint{1s}));
    for (const auto& described : mission_.devices) {
      const auto* device = craft.device(described.name);
      if (device == nullptr) continue;
      std::istringstream words{device->truth()};
      for (std::string word; words >> word;) {
        const auto equals = word.find('=');
        names += fmt::format(",{}.{}", described.name, word.substr(0, equals));
        values += "," + word.substr(equals + 1);
      }
    }
    if (!std::exchange(headed_, true)) fmt::print(file_.get(), "{}\n", names);
    fmt::print(file_.get(), "{}\n", values);
  }
  /// The craft flies until then.
  void fly(simulation::Spacecraft& craft, TimePoint end) {
    while (craft.now() < end) {
      craft.run(std::min<Duration>(1ms, end - craft.now()));
      if (!mission_.devices.empty() && craft.now() - written_ >= without_cycles)
        write_line(mission_.devices.front().subsystem, craft.now(), craft);
    }
  }
  /// False: not all of it arrived.
  [[nodiscard]] bool close() { return std::ferror(file_.get()) == 0 && std::fclose(file_.release()) == 0; }

 private:
  const descriptor::Mission& mission_;
  File file_{nullptr, &std::fclose};
  bool headed_{false};
  TimePoint written_{1s};
};

[[nodiscard]] std::expected<NamedRequest, std::string> request_in(const Injection& injection,
                                                                  const descriptor::Mission& mission) {
  const auto line = pus::words_of_line(injection.line);
  if (!line) return std::unexpected(fmt::format("--at '... tc {}': a quote is not closed", injection.line));
  std::vector<std::string> words;
  for (const auto& word : *line) words.push_back(word.text);
  words.resize(std::max<std::size_t>(words.size(), 2));
  return named_request(mission, words[0], words[1], std::span{words}.subspan(2));
}

/// In words: whom or what of it the mission does not have.
[[nodiscard]] std::optional<std::string> unknown_in(const Injection& injection, const descriptor::Mission& mission) {
  std::vector<std::string> names;
  if (injection.device == "tc") {
    const auto request = request_in(injection, mission);
    return request ? std::nullopt : std::optional{request.error()};
  }
  if (injection.device == "kill") {
    if (mission.find_subsystem(injection.line) != nullptr) return std::nullopt;
    for (const auto& member : mission.subsystems) names.push_back(member.subsystem.name);
    return fmt::format("no subsystem '{}' to kill; the mission has {}", injection.line, fmt::join(names, " "));
  }
  for (const auto& device : mission.devices) names.push_back(device.name);
  if (std::ranges::find(names, injection.device) != names.end()) return std::nullopt;
  return fmt::format("no device '{}'; the mission has {}", injection.device,
                     names.empty() ? "no simulated device" : fmt::format("{}", fmt::join(names, " ")));
}

/// Ground of this flight: what becomes of its telecommands stands in the log.
class Ground {
 public:
  explicit Ground(simulation::Spacecraft& craft) : craft_{craft} {}
  /// False: it did not go up, as nobody on board listened.
  [[nodiscard]] bool send(const NamedRequest& named) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = named.subsystem->id,
                                                .sequence_count = count_++,
                                                .ack = pus::ack_all,
                                                .service = named.request.service,
                                                .subtype = named.request.subtype,
                                                .source = source},
                                               named.data);
    return packet && craft_.ground().send(*packet);
  }

 private:
  static constexpr std::uint16_t source = 0x4000;  // a station's, as that of `hirosco tc`
  simulation::Spacecraft& craft_;
  std::uint16_t count_{0};
};

}  // namespace

int simulate(const SimulateOptions& options) {
  auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  if (!options.mode.empty())
    if (const auto why_not = descriptor::start_in(*mission, options.mode)) {
      fmt::print(stderr, "hirosco simulate: {}\n", *why_not);
      return exit_usage;
    }
  if (!ready(*mission, FlownAs::Simulation)) return exit_environment;
  const auto injections = plan_injections(options.at, options.run_for);
  if (!injections) {
    fmt::print(stderr, "hirosco simulate: {}\n", injections.error());
    return exit_usage;
  }
  for (const Injection& injection : *injections)
    if (const auto why_not = unknown_in(injection, *mission)) {
      fmt::print(stderr, "hirosco simulate: {}\n", *why_not);
      return exit_usage;
    }
  std::optional<Trace> trace;
  if (!options.trace.empty() && !trace.emplace(*mission).open(options.trace)) {
    fmt::print(stderr, "hirosco simulate: cannot write {}\n", options.trace);
    return exit_environment;
  }
  const auto modules = simulation::load_modules(*mission);
  supervisor::MemoryDatabase log;
  Nobody nobody;
  supervisor::SystemValueDisk disk;
  supervisor::DirectValueStore values{disk, options.values};
  simulation::Spacecraft craft{{.mission = *mission,
                                .subsystems = modules.subsystems,
                                .devices = modules.devices,
                                .log = log,
                                .observer = nobody,
                                .seed = options.seed,
                                .values = options.values.empty() ? nullptr : &values}};
  const std::string origin = simulation::origin_of(*mission, craft, options.seed);
  if (trace) trace->head(origin);
  if (trace)
    craft.on_cycle([&](std::string_view subsystem, TimePoint now) { trace->write_line(subsystem, now, craft); });
  const auto fly_until = [&](TimePoint until) {
    if (trace) trace->fly(craft, until);
    else if (craft.now() < until) craft.run(until - craft.now());
  };
  const TimePoint begin = craft.now();
  Ground ground{craft};
  bool all_taken = true;
  for (const Injection& injection : *injections) {
    fly_until(begin + injection.after);
    if (injection.device == "kill") craft.kill(injection.line);
    else if (injection.device == "tc") {
      if (ground.send(request_in(injection, *mission).value())) continue;
      fmt::print(stderr, "hirosco simulate: '{}' did not go up after {} s: no ground link was open\n", injection.line,
                 seconds(injection.after));
      all_taken = false;
    } else if (auto* device = craft.device(injection.device); device == nullptr || !device->fault(injection.line)) {
      fmt::print(stderr, "hirosco simulate: device '{}' does not take '{}'\n", injection.device, injection.line);
      all_taken = false;
    }
  }
  fly_until(begin + options.run_for);

  const auto page = log.read({.last = SIZE_MAX});
  if (!page) return exit_internal;
  std::size_t packets = 0;
  const pus::PacketDescriber describer{*mission};
  if (!options.summary) fmt::print("{}{}\n", simulation::origin_mark, origin);
  for (const auto& record : page->records) {
    if (!record.packet.empty()) ++packets;
    if (!options.summary) print_record(record, describer, options.octets);
  }
  if (options.summary)
    fmt::print("{} s simulated, {} log records, {} packets, mode {}, {} of {} links up\n", seconds(options.run_for),
               page->records.size(), packets, craft.supervisor().mode().name, craft.supervisor().links().up_count(),
               craft.supervisor().links().defined_count());
  if (trace && !trace->close()) {
    fmt::print(stderr, "hirosco simulate: {} cannot be written to its end\n", options.trace);
    return exit_environment;
  }
  return all_taken && craft.supervisor().commissioned() ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
