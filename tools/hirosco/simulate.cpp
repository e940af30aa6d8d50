// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <sstream>

#include "hirosco/pus/describe.hpp"
#include "simulation/devices/joystick_device.hpp"
#include "simulation/devices/robot_device.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/readiness.hpp"

namespace hirosco::tools {
namespace {

/// The story goes into the log, which is printed at the end: one stream, in order.
struct Nobody final : supervisor::Observer {
  void told(OnboardTime, std::string_view) override {}
};

struct Injection {
  TimePoint at{};
  std::string device;
  std::string line;
};

[[nodiscard]] std::optional<Injection> read_injection(const std::string& text) {
  std::istringstream words{text};
  double at_s = 0.0;
  Injection injection;
  if (!(words >> at_s >> injection.device) || !(at_s >= 0.0)) return std::nullopt;
  std::getline(words >> std::ws, injection.line);
  injection.at = TimePoint{1s} + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(at_s));
  return injection;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// One line for one record: time, kind, ways, words, octets.
void print_record(const supervisor::LogRecord& record, const pus::PacketDescriber& describer) {
  fmt::print("{:12.6f} {:<21} {} -> {}", seconds(record.monotonic - TimePoint{1s}), to_text(record.kind),
             record.source == 0 ? "ground" : describer.name_of(record.source),
             record.peer == 0 ? "ground" : describer.name_of(record.peer));
  if (!record.packet.empty()) fmt::print(" {}", describer.describe(record.packet));
  if (!record.note.view().empty()) fmt::print(" \"{}\"", record.note.view());
  if (!record.packet.empty()) fmt::print(" ");
  for (const std::byte octet : record.packet) fmt::print("{:02x}", std::to_integer<unsigned>(octet));
  fmt::print("\n");
}

/// World truth at the robot's cycle rate.
void write_trace_line(std::FILE* trace, TimePoint now, simulation::Spacecraft& craft) {
  const auto* robot = dynamic_cast<simulation::RobotDevice*>(craft.device("robot"));
  const auto* joystick = dynamic_cast<simulation::JoystickDevice*>(craft.device("joystick"));
  if (robot == nullptr || joystick == nullptr) return;
  const auto tip = robot->arm().tip_m();
  const auto contact = robot->arm().contact();
  const auto torque = robot->arm().joint_torque_n_m();
  const auto& link = robot->arm().state().link_rad;
  const auto& motor = robot->arm().state().motor_rad;
  const auto& handle = joystick->handle().angle_rad();
  fmt::print(trace,
             "{:.6f},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},"
             "{:.9g},{:.9g},{:.9g},{:.9g}\n",
             seconds(now - TimePoint{1s}), handle[0], handle[1], link[0], link[1], tip[0], tip[1], torque[0], torque[1],
             contact.penetration_m, contact.normal_force_n, joystick->motor_torque_n_m()[0],
             joystick->motor_torque_n_m()[1], motor[0], motor[1], robot->motor_torque_n_m()[0],
             robot->motor_torque_n_m()[1]);
}

}  // namespace

int simulate(const SimulateOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  if (!ready(*mission, Platform::Simulation)) return exit_environment;
  std::vector<Injection> injections;
  for (const std::string& text : options.at) {
    const auto injection = read_injection(text);
    if (!injection) {
      fmt::print(stderr,
                 "hirosco simulate: --at '{}' is not \"SECONDS DEVICE LINE\", for example \"5 joystick unplug\"\n",
                 text);
      return exit_usage;
    }
    injections.push_back(*injection);
  }
  for (const Injection& injection : injections) {
    if (injection.device != "kill" && std::ranges::find(mission->devices, injection.device,
                                                        &descriptor::SimulatedDevice::name) == mission->devices.end()) {
      fmt::print(stderr, "hirosco simulate: no device '{}'; the mission has", injection.device);
      for (const auto& device : mission->devices) fmt::print(stderr, " {}", device.name);
      fmt::print(stderr, "\n");
      return exit_usage;
    }
    if (injection.device == "kill" && mission->find_subsystem(injection.line) == nullptr) {
      fmt::print(stderr, "hirosco simulate: no subsystem '{}' to kill; the mission has", injection.line);
      for (const auto& member : mission->subsystems) fmt::print(stderr, " {}", member.subsystem.name);
      fmt::print(stderr, "\n");
      return exit_usage;
    }
  }
  File trace{nullptr, &std::fclose};
  if (!options.trace.empty()) {
    trace.reset(std::fopen(options.trace.c_str(), "w"));
    if (!trace) {
      fmt::print(stderr, "hirosco simulate: cannot write {}\n", options.trace);
      return exit_environment;
    }
    fmt::print(trace.get(),
               "t_s,hand1_rad,hand2_rad,q1_rad,q2_rad,tip_x_m,tip_y_m,torque1_n_m,torque2_n_m,"
               "penetration_m,contact_n,felt1_n_m,felt2_n_m,motor1_rad,motor2_rad,motor1_n_m,motor2_n_m\n");
  }
  const auto modules = simulation::load_modules(*mission);
  supervisor::MemoryDatabase log;
  Nobody nobody;
  simulation::Spacecraft craft{{.mission = *mission,
                                .subsystems = modules.subsystems,
                                .devices = modules.devices,
                                .log = log,
                                .observer = nobody,
                                .seed = options.seed}};
  if (trace)
    craft.on_cycle([&](std::string_view subsystem, TimePoint now) {
      if (subsystem == "MANIPULATOR") write_trace_line(trace.get(), now, craft);
    });
  const TimePoint end = craft.now() + options.run_for;
  bool all_taken = true;
  for (const Injection& injection : injections) {
    if (injection.at > craft.now() && injection.at < end) craft.run(injection.at - craft.now());
    if (injection.device == "kill") craft.kill(injection.line);
    else if (auto* device = craft.device(injection.device); device == nullptr || !device->fault(injection.line)) {
      fmt::print(stderr, "hirosco simulate: device '{}' does not take '{}'\n", injection.device, injection.line);
      all_taken = false;
    }
  }
  if (craft.now() < end) craft.run(end - craft.now());

  const auto page = log.read({.last = SIZE_MAX});
  if (!page) return exit_internal;
  std::size_t packets = 0;
  const pus::PacketDescriber describer{*mission};
  for (const auto& record : page->records) {
    if (!record.packet.empty()) ++packets;
    if (!options.summary) print_record(record, describer);
  }
  if (options.summary)
    fmt::print("{} s simulated, {} log records, {} packets, mode {}, {} of {} links up\n", seconds(options.run_for),
               page->records.size(), packets, craft.supervisor().mode().name, craft.supervisor().links().up_count(),
               craft.supervisor().links().defined_count());
  if (trace && (std::ferror(trace.get()) != 0 || std::fclose(trace.release()) != 0)) {
    fmt::print(stderr, "hirosco simulate: {} cannot be written to its end\n", options.trace);
    return exit_environment;
  }
  return all_taken && craft.supervisor().commissioned() ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
