// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/observed_flight.hpp"

#include <algorithm>
#include <stdexcept>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::simulation {

void Story::told(OnboardTime when, std::string_view line) {
  lines_.push_back({when, std::string{line}});
  if (on_line) on_line(line);
}

void Story::routed(const pus::TelemetryView& packet) {
  if (on_telemetry) on_telemetry(packet);
}

std::optional<std::size_t> Story::find(std::string_view part, std::size_t from) const {
  for (std::size_t i = from; i < lines_.size(); ++i)
    if (lines_[i].text.find(part) != std::string::npos) return i;
  return std::nullopt;
}

std::size_t Story::count(std::string_view part) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(lines_, [&](const Line& line) { return line.text.find(part) != std::string::npos; }));
}

std::string Story::missing_in_order(const std::vector<std::string>& parts) const {
  std::size_t from = 0;
  for (const std::string& part : parts) {
    const auto found = find(part, from);
    if (!found) return part;
    from = *found + 1;
  }
  return {};
}

std::string Story::text() const {
  std::string all;
  for (const Line& line : lines_) all += line.text + "\n";
  return all;
}

void hand_rests(descriptor::Mission& mission) {
  for (auto& device : mission.devices) std::erase_if(device.settings, [](const auto& s) { return s.name == "hand"; });
}

Flight::Flight(Plan plan) : files_{std::move(plan.files)} {
  const descriptor::FileSource source =
      [this, files = descriptor::file_system()](const std::filesystem::path& path) -> Result<std::string> {
    const auto found = files_.find(path.filename().string());
    return found != files_.end() ? found->second : files(path);
  };
  auto reading = descriptor::read_mission(plan.mission, source);
  std::string problems;
  for (const auto& problem : reading.problems) problems += descriptor::render(problem, source, false);
  if (!reading.value) throw std::runtime_error{problems};
  mission_ = std::move(*reading.value);
  if (plan.edit) plan.edit(*mission_);
  modules_ = load_modules(*mission_);
  for (const auto& [program, make] : plan.subsystems) modules_.subsystems[program] = make;
  for (const auto& [program, make] : plan.devices) modules_.devices[program] = make;
  for (const auto& [program, why] : modules_.missing)
    if (!modules_.subsystems.contains(program) && !modules_.devices.contains(program)) problems += why + "\n";
  if (!problems.empty()) throw std::runtime_error{problems};
  craft_ = std::make_unique<Spacecraft>(Spacecraft::Parts{.mission = *mission_,
                                                          .subsystems = modules_.subsystems,
                                                          .devices = modules_.devices,
                                                          .log = log_,
                                                          .observer = story_,
                                                          .seed = plan.seed,
                                                          .make_log = plan.make_log,
                                                          .wrap_channel = plan.wrap_channel,
                                                          .values = plan.values,
                                                          .files = source,
                                                          .revives_after = plan.revives_after,
                                                          .journal_octets = plan.journal_octets});
}

std::vector<supervisor::LogRecord> Flight::records() {
  auto page = log_.read({.last = SIZE_MAX});
  return page ? std::move(page->records) : std::vector<supervisor::LogRecord>{};
}

bool Flight::commission() {
  const auto& supervisor = craft_->supervisor();
  static_cast<void>(craft_->run_until([&] { return supervisor.commissioned() || !supervisor.succeeded(); }, 60s));
  return supervisor.commissioned();
}

State Flight::state(std::string_view subsystem) {
  const VitalPage* page = craft_->vital(subsystem);
  return page != nullptr ? static_cast<State>(page->state.load()) : State::Offline;
}

std::uint32_t Flight::inhibited(std::string_view subsystem) {
  const VitalPage* page = craft_->vital(subsystem);
  return page != nullptr ? page->inhibited.load() : 0;
}

bool Flight::run_until_state(std::string_view subsystem, State wanted, Duration limit) {
  return craft_->run_until([&] { return state(subsystem) == wanted; }, limit);
}

std::uint64_t Flight::cycles(std::string_view subsystem) {
  const VitalPage* page = craft_->vital(subsystem);
  return page != nullptr ? page->cycles.load() : 0;
}

CommandOutcome Flight::set_state(std::string_view subsystem, State wanted) {
  return craft_->command(subsystem, "SET_STATE", {static_cast<double>(wanted)});
}

CommandOutcome Flight::configure(std::string_view subsystem, std::string_view configuration) {
  const auto* described = mission_->find_subsystem(subsystem)->subsystem.find_configuration(configuration);
  return craft_->command(subsystem, "CONFIGURE", {static_cast<double>(described->id)});
}

CommandOutcome Flight::enter_mode(std::string_view mode) {
  return craft_->command(mission_->supervisor.name, "ENTER_MODE", {static_cast<double>(mission_->find_mode(mode)->id)});
}

CommandOutcome Flight::set_mode(std::string_view mode) {
  return craft_->command(mission_->supervisor.name, "SET_MODE", {static_cast<double>(mission_->find_mode(mode)->id)});
}

Flight::Verdict Flight::send(Octets packet) {
  Verdict verdict;
  const std::uint32_t id = pus::read_primary_header(packet)->request_id;
  craft_->ground().on_telemetry([&](Octets octets) {
    const auto report = pus::TelemetryView::parse(octets);
    if (!report || report->service() != 1) return;
    OctetReader reader{report->source_data()};
    if (reader.get<std::uint32_t>() != id) return;
    const bool failure = report->subtype() % 2 == 0 && report->subtype() != 6;  // of a step: it goes on
    if (!failure && report->subtype() != 7) return;
    verdict = {report->subtype(), failure ? reader.get<std::uint16_t>() : std::uint16_t{0}, report->apid()};
  });
  craft_->ground().send(packet);
  static_cast<void>(craft_->run_until([&] { return verdict.subtype != 0; }, 5s));
  craft_->ground().on_telemetry({});
  return verdict;
}

}  // namespace hirosco::simulation
