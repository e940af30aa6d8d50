// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "simulation/campaign/planned_flight.hpp"

/// hirosco-fly-plan MISSION PLAN FOLDER [DEFECT]: flies the plan, with a planted defect where one is named, and leaves
/// log.txt, deleted.txt (what of it was deleted in flight), trace.txt and story.txt in the folder. Without arguments: the names of the planted defects.
namespace {

using namespace hirosco;

/// One record a line: number, stored ns, monotonic ns, kind, source, peer, lost, packet or '-', note.
void write_log(const std::vector<supervisor::LogRecord>& records, const std::filesystem::path& path) {
  std::ofstream file{path};
  for (const auto& record : records)
    file << fmt::format("{} {} {} {} {} {} {} {} {}\n", record.number, record.stored.time_since_epoch().count(),
                        record.monotonic.time_since_epoch().count(), to_text(record.kind), record.source, record.peer,
                        record.lost, record.packet.empty() ? "-" : campaign::hex_of(record.packet), record.note.view());
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int exit_usage = 2, exit_finding = 1;
  if (argc == 1) {
    for (const auto name : campaign::defect_names()) fmt::print("{}\n", name);
    return 0;
  }
  auto defect = argc == 5 ? campaign::defect_named(argv[4]) : nullptr;
  if (argc < 4 || argc > 5 || (argc == 5 && defect == nullptr)) {
    fmt::print(stderr, "hirosco-fly-plan MISSION PLAN FOLDER [DEFECT]\n");
    return exit_usage;
  }
  const std::filesystem::path folder{argv[3]};
  const auto source = descriptor::file_system();
  const std::filesystem::path given{argv[1]};
  const auto reading =
      descriptor::read_mission(std::filesystem::is_directory(given) ? given / "mission.xml" : given, source);
  for (const auto& problem : reading.problems) fmt::print(stderr, "{}", descriptor::render(problem, source, false));
  if (!reading.value) return exit_finding;
  std::ifstream text{argv[2]};
  auto plan = campaign::read_plan(text);
  if (!text.eof() || !plan) {
    fmt::print(stderr, "hirosco-fly-plan: {} is not a plan (line {})\n", argv[2], plan ? 0 : plan.error().value);
    return exit_usage;
  }
  std::vector<std::string> modes = plan->ends;
  if (!plan->mode.empty()) modes.push_back(plan->mode);
  for (const std::string& mode : modes)
    if (reading.value->find_mode(mode) == nullptr) {
      fmt::print(stderr, "hirosco-fly-plan: {} names mode '{}', which the mission has not\n", argv[2], mode);
      return exit_usage;
    }
  auto modules = simulation::load_modules(*reading.value);
  for (const auto& [program, why] : modules.missing) fmt::print(stderr, "hirosco-fly-plan: {}\n", why);
  if (!modules.missing.empty()) return exit_finding;
  campaign::PlannedFlight flight{*reading.value, std::move(modules), std::move(*plan), std::move(defect)};
  flight.fly();
  write_log(flight.disk().records, folder / "log.txt");
  write_log(flight.disk().deleted, folder / "deleted.txt");
  std::ofstream{folder / "trace.txt"} << flight.trace().text();
  std::ofstream{folder / "story.txt"} << flight.story();
  return 0;
}
