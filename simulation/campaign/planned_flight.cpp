// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/planned_flight.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/crc32.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::campaign {
namespace {

namespace st129 = pus::st129;

constexpr Duration ping_every = 250ms;
const std::string ground = "ground";

[[nodiscard]] std::string name_in(Octets data) {
  constexpr std::size_t name_octets = 16;
  std::string name;
  for (std::size_t i = 0; i < std::min(name_octets, data.size()); ++i) {
    const char letter = static_cast<char>(data[i]);
    if (letter == '\0') break;
    name += letter > ' ' && letter <= '~' ? letter : '?';
  }
  return name.empty() ? "?" : name;
}

/// What came down again, for who judges it: destination, number in the log and CRC-32 of the report inside; of the end of it destination, request,
/// reports, left out, missing, damaged and why it ended early, with '_' for each space ('-': it did not). Else nothing.
[[nodiscard]] std::string retrieved_in(const pus::TelemetryView& report) {
  if (report.service() != st129::service_type) return {};
  if (st129::is_retrieved(report)) {
    const auto again = st129::read_retrieved(report.source_data());
    return again ? fmt::format(" {} {} {}", report.destination(), again->number, crc32(again->packet)) : std::string{};
  }
  const auto end = st129::read_retrieval_end(report.source_data());
  if (report.subtype() != st129::retrieval_end || !end) return {};
  std::string why = end->why.empty() ? "-" : end->why;
  std::ranges::replace(why, ' ', '_');
  return fmt::format(" {} {} {} {} {} {} {}", report.destination(), end->request, end->reports, end->left_out,
                     end->missing, end->damaged, why);
}

}  // namespace

void PlannedFlight::Observer::told(OnboardTime, std::string_view line) {
  const double now_s = craft != nullptr ? seconds(craft->now() - start_of_flight) : 0.0;
  text += fmt::format("{:.6f} {}\n", now_s, line);
}

PlannedFlight::PlannedFlight(const descriptor::Mission& mission, simulation::Modules modules, FlightPlan plan,
                             std::unique_ptr<PlantedDefect> defect)
    : mission_{mission},
      plan_{std::move(plan)},
      defect_{defect ? std::move(defect) : std::make_unique<PlantedDefect>()},
      modules_{std::move(modules)} {
  if (!plan_.mode.empty()) mission_.start_mode = plan_.mode;
  defect_->mission = &mission_;
  if (defect_->edit) defect_->edit(mission_);
  if (defect_->devices) defect_->devices(modules_.devices);
  disk_.keeps = defect_->keeps;
  craft_ = std::make_unique<simulation::Spacecraft>(simulation::Spacecraft::Parts{
      .mission = mission_,
      .subsystems = modules_.subsystems,
      .devices = modules_.devices,
      .log = *unused_,
      .observer = observer_,
      .seed = plan_.seed,
      .make_log = [this](const Clock& clock) { return log_on(disk_, clock); },
      .make_log_readings = [this](const Clock& clock) { return readings_on(disk_, clock); },
      .open_database = [this](supervisor::DatabaseStrategy) { return database_on(disk_); },
      .wrap_channel = defect_->wrap_channel});
  defect_->craft = craft_.get();
  observer_.craft = craft_.get();
  trace_ = std::make_unique<WorldTrace>(mission_, *craft_, defect_->clock_percent);
  craft_->ground().on_telemetry([this](Octets packet) { received_on_ground(packet); });
}

void PlannedFlight::fly() {
  for (const Action& action : plan_.actions) {
    if (action.at >= plan_.finale) break;
    run_until(action.at);
    perform(action);
  }
  run_until(plan_.finale);
  finale();
  trace_->say("end");
}

void PlannedFlight::look() {
  if (defect_->each_instant) defect_->each_instant();
  trace_->look();
}

/// Pings the supervisor all the time: it has to answer whatever happens (I6).
void PlannedFlight::run_until(Duration since_start) {
  const TimePoint end = start_of_flight + since_start;
  while (craft_->now() < end && !craft_->supervisor().finished()) {
    const auto since_ping = (craft_->now() - start_of_flight) % ping_every;
    const TimePoint next_ping = craft_->now() - since_ping + ping_every;
    static_cast<void>(craft_->run_until(
        [this] {
          look();
          return false;
        },
        std::min(next_ping, end) - craft_->now()));
    look();
    if (craft_->now() == next_ping)
      send(ground, {.apid = mission_.supervisor.id, .service = 17, .subtype = 1, .ack = 15}, {});
  }
}

void PlannedFlight::run_until(const std::function<bool()>& condition, Duration limit) {
  const TimePoint end = craft_->now() + limit;
  constexpr Duration look_every = 1ms;
  while (!condition() && craft_->now() < end && !craft_->supervisor().finished())
    run_until(craft_->now() - start_of_flight + look_every);
}

void PlannedFlight::perform(const Action& action) {
  if (craft_->supervisor().finished()) return;
  const bool done = do_action(action.words);
  if (defect_->after_action) defect_->after_action(action.words);
  std::string words;
  for (const std::string& word : action.words)
    if (words.size() < 60) words += " " + word;
  trace_->say("{}{}", done ? "did" : "refused", words);
  trace_->look();
}

bool PlannedFlight::do_action(const std::vector<std::string>& words) {
  const std::string& verb = words[0];
  const std::string subject = words.size() > 1 ? words[1] : "";
  if (verb == "tc") return telecommand(words);
  if (verb == "raw" && words.size() == 3) {
    const auto octets = octets_of_hex(words[2]);
    return octets && send_packet(subject, *octets);
  }
  if (verb == "flood") return flood(words);
  if (verb == "log") return disk_fault(words);
  if (verb == "safe") {
    craft_->stop_beside_flight();
    return true;
  }
  if (verb == "fault") {
    auto* device = craft_->device(subject);
    std::string line;
    for (std::size_t i = 2; i < words.size(); ++i) line += words[i] + " ";
    return device != nullptr && device->fault(line).has_value();
  }
  if (subject == mission_.supervisor.name && (verb == "stop" || verb == "go")) {
    supervisor_stopped_ = verb == "stop";
    craft_->stop(subject, supervisor_stopped_);
    return true;
  }
  if (!craft_->alive(subject)) return false;
  if (verb == "kill") craft_->kill(subject);
  else if (verb == "stop" || verb == "go") craft_->stop(subject, verb == "stop");
  else if (verb == "spin") craft_->spin(subject);
  else if (verb == "stick" || verb == "unstick") craft_->stick(subject, verb == "stick");
  else if (verb == "strain" && words.size() == 4) {
    const auto cycles = number_of(words[2]), takes_us = number_of(words[3]);
    if (!cycles || !takes_us) return false;
    craft_->strain(subject, static_cast<int>(*cycles), std::chrono::microseconds{*takes_us});
  } else return false;
  return true;
}

bool PlannedFlight::disk_fault(const std::vector<std::string>& words) {
  const std::string what = words.size() > 1 ? words[1] : "";
  if (what == "failing") disk_.fault = DiskFault::Failing;
  else if (what == "full") disk_.fault = DiskFault::Full;
  else if (what == "deleted") disk_.fault = DiskFault::Deleted;
  else if (what == "frozen") disk_.delay = Duration::max();
  else if (what == "heal") {
    disk_.fault = DiskFault::None;
    disk_.delay = {};
  } else if (what == "slow" && words.size() == 3) {
    const auto milliseconds = number_of(words[2]);
    if (!milliseconds) return false;
    disk_.delay = std::chrono::milliseconds{*milliseconds};
  } else return false;
  return true;
}

/// tc ORIGIN APID SERVICE SUBTYPE ACK [HEX]
bool PlannedFlight::telecommand(const std::vector<std::string>& words) {
  if (words.size() < 6) return false;
  std::array<std::uint64_t, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = number_of(words[i + 2]);
    if (!number) return false;
    numbers[i] = *number;
  }
  const auto data = octets_of_hex(words.size() > 6 ? words[6] : "");
  return data && send(words[1],
                      {.apid = static_cast<std::uint16_t>(numbers[0]),
                       .service = static_cast<std::uint8_t>(numbers[1]),
                       .subtype = static_cast<std::uint8_t>(numbers[2]),
                       .ack = static_cast<std::uint8_t>(numbers[3])},
                      *data);
}

/// flood ORIGIN valid|damaged COUNT: all in one instant
bool PlannedFlight::flood(const std::vector<std::string>& words) {
  if (words.size() != 4) return false;
  const auto count = number_of(words[3]);
  if (!count) return false;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (words[2] == "valid") {
      send(words[1], {.apid = mission_.supervisor.id, .service = 17, .subtype = 1, .ack = 9}, {});
    } else {
      constexpr std::array damaged{std::byte{0x18}, std::byte{0x01}, std::byte{0xC0}, std::byte{0x00}, std::byte{0x00},
                                   std::byte{0x06}, std::byte{0x2F}, std::byte{0x11}, std::byte{0x01}, std::byte{0x00},
                                   std::byte{0x00}, std::byte{0x00}, std::byte{0x01}};
      send_packet(words[1], damaged);
    }
  }
  return true;
}

bool PlannedFlight::send(const std::string& origin, const Header& header, Octets data) {
  const auto* member = mission_.find_subsystem(origin);
  const std::uint16_t source = member != nullptr ? member->subsystem.id : std::uint16_t{0};
  constexpr std::uint16_t modulo = 16'384;
  std::uint16_t& count = counts_[origin];
  count = static_cast<std::uint16_t>((count + 1) % modulo);
  std::array<std::byte, max_packet_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = header.apid,
                                              .sequence_count = count,
                                              .ack = header.ack,
                                              .service = header.service,
                                              .subtype = header.subtype,
                                              .source = source},
                                             data);
  if (!packet) return false;
  last_request_ = pus::read_primary_header(*packet)->request_id;
  return send_packet(origin, *packet);
}

bool PlannedFlight::send_packet(const std::string& origin, Octets packet) {
  bool sent = false;
  if (origin == ground) {
    sent = craft_->ground().send(packet);
  } else {
    sent = craft_->send_as(origin, packet);
  }
  const auto telecommand = pus::TelecommandView::parse(packet);
  if (telecommand) {
    const bool asks_again = telecommand->service() == st129::service_type && telecommand->subtype() == st129::retrieve;
    const Octets data = telecommand->application_data();
    const std::string what = telecommand->service() == 8   ? name_in(data)
                             : asks_again && !data.empty() ? hex_of(data)
                                                           : "-";
    trace_->say("{} {} {} {} {} {} {} {} {}", sent ? "sent" : "unsent", origin, telecommand->apid(),
                telecommand->sequence_count(), telecommand->source(), telecommand->ack(), telecommand->service(),
                telecommand->subtype(), what);
  } else {
    trace_->say("{} {} damaged", sent ? "sent" : "unsent", origin);
  }
  return sent;
}

void PlannedFlight::received_on_ground(Octets packet) {
  const auto report = pus::TelemetryView::parse(packet);
  if (!report) return;
  if (report->service() != 1) {
    trace_->say("down {} {} {} {}{}", report->apid(), report->sequence_count(), report->service(), report->subtype(),
                retrieved_in(*report));
    return;
  }
  OctetReader reader{report->source_data()};
  const auto request = reader.get<std::uint32_t>();
  trace_->say("down {} {} {} {} {} {}", report->apid(), report->sequence_count(), report->service(), report->subtype(),
              report->destination(), request);
  if (report->destination() != 0) return;
  if (report->subtype() % 2 == 0 || report->subtype() == 7)
    verdicts_[request] = {.over = true, .completed = report->subtype() == 7};
}

}  // namespace hirosco::campaign
