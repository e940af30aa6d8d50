// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "bench/robots/arm_cycles.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

namespace hirosco::bench {
namespace {

/// Who moves slower rests, rad/s or m/s.
constexpr double moves_from = 2e-3;
/// After so many cycles in motion it is asked what is on.
constexpr std::size_t asked_each = 500;
/// Flights without which so many cycles cannot be had at all.
constexpr int most_flights = 200;

/// What it tells of itself: how near its links are, whether somebody whom it meets counts, by which law it goes, and what its observer finds.
constexpr std::array looked_at{"CLEARANCE", "CONTACT_WATCH", "LAW", "EXTERNAL_TORQUE"};

/// At one flight.
class Look {
 public:
  Look(const RobotTask& task, ArmCycles& found) : task_{task}, found_{found} {}

  void begin(simulation::Flight& flight) {
    flight_ = &flight;
    arm_ = &flight.mission().find_subsystem(task_.subsystem)->subsystem;
    flight.craft().measure_cycles(clock_, [this](std::string_view subsystem, simulation::CycleTaken taken) {
      if (subsystem == task_.subsystem) take(taken);
    });
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      if (report.apid() == arm_->id && report.service() == parameters && report.subtype() == values)
        hear(report.source_data());
    };
  }

 private:
  void take(simulation::CycleTaken taken) {
    if (!moves()) return;
    found_.processor_ns.push_back(taken.processor.count());
    found_.wall_ns.push_back(taken.wall.count());
    if (found_.processor_ns.size() % asked_each == 0) ask();
  }

  /// By its world, in which the next cycle finds it.
  [[nodiscard]] bool moves() {
    const std::string words = " " + flight_->craft().device(task_.device)->truth();
    constexpr std::string_view speed = " qd";
    for (auto at = words.find(speed); at != std::string::npos; at = words.find(speed, at + 1)) {
      const auto is = words.find('=', at);
      if (is != std::string::npos && std::abs(std::strtod(words.c_str() + is + 1, nullptr)) > moves_from) return true;
    }
    return false;
  }

  /// While it moves: it answers within some cycles.
  void ask() {
    const VitalPage* vital = flight_->craft().vital(task_.subsystem);
    if (vital != nullptr) found_.period_us = 1e-3 * static_cast<double>(vital->period_ns.load());
    std::array<std::byte, 1 + 4 * looked_at.size()> data;
    OctetWriter writer{data};
    writer.put(static_cast<std::uint8_t>(looked_at.size()));
    for (const char* name : looked_at) {
      const auto* its = arm_->find_parameter(name);
      writer.put(its != nullptr ? ParameterId{arm_->id, its->field.type, its->id}.wire() : 0U);
    }
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(
        buffer,
        {.apid = arm_->id, .ack = pus::ack_all, .service = parameters, .subtype = report_values, .source = 0x1000},
        data);
    if (packet) static_cast<void>(flight_->craft().ground().send(*packet));
  }

  /// An arm that lacks one of them answers with a refusal, and has told nothing.
  void hear(Octets data) {
    OctetReader reader{data};
    if (reader.get<std::uint8_t>() != looked_at.size()) return;
    std::vector<OctetReader> told;
    for (const char* name : looked_at) {
      static_cast<void>(reader.get<std::uint32_t>());
      told.emplace_back(reader.get(arm_->find_parameter(name)->octets()));
    }
    if (!reader.exhausted()) return;
    auto &clearance = told[0], &contact = told[1], &law = told[2], &external = told[3];
    found_.least_clearance_m = std::min(found_.least_clearance_m, clearance.get<double>());
    found_.watches_contact = found_.watches_contact && contact.get<std::uint8_t>() != 0;
    found_.by_positions = found_.by_positions && law.get<std::uint8_t>() == 0;
    while (external.remaining() > 0)
      found_.most_external = std::max(found_.most_external, std::abs(external.get<double>()));
    ++found_.told;
  }

  static constexpr std::uint8_t parameters = 20, report_values = 1, values = 2;
  const RobotTask& task_;
  ArmCycles& found_;
  const SystemClock clock_;
  simulation::Flight* flight_{nullptr};
  const descriptor::SubsystemDescriptor* arm_{nullptr};
};

}  // namespace

std::vector<std::string> ArmCycles::missing() const {
  std::vector<std::string> all;
  if (processor_ns.empty() || told == 0) all.emplace_back("no cycle in motion, or it did not tell what is on in one");
  if (!by_positions) all.emplace_back("another law than that of positions: no inverse dynamics");
  if (!watches_contact) all.emplace_back("the contact watch is off");
  // Exactly nothing is found by none: what it carries is rounded at least.
  if (!(most_external > 0)) all.emplace_back("its observer told of nothing");
  if (!std::isfinite(least_clearance_m))
    all.emplace_back("no clearance: there is nothing that its links are kept from");
  return all;
}

bool ArmCycles::holds() const { return problems.empty() && missing().empty() && share() <= most_of_a_period; }

ArmCycles measure_arm_cycles(const std::filesystem::path& mission, const RobotTask& task, std::size_t cycles,
                             std::uint64_t seed) {
  ArmCycles found;
  const RobotCase as_its_file_says = robot_cases(task.weakest).front();
  for (int flights = 0; found.processor_ns.size() < cycles; ++flights, ++seed) {
    const std::size_t before = found.processor_ns.size();
    Look look{task, found};
    const auto flown =
        fly_case(mission, task, as_its_file_says, seed, [&look](simulation::Flight& flight) { look.begin(flight); });
    found.problems = flown.problems;
    if (found.problems.empty() && !flown.holds()) found.problems.emplace_back("it was not where it was told to go");
    if (found.problems.empty() && (found.processor_ns.size() == before || flights == most_flights))
      found.problems.emplace_back("too few cycles in motion");
    if (!found.problems.empty()) return found;
  }
  return found;
}

}  // namespace hirosco::bench
