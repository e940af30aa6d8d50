// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/utilities/os/line_writer.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/flight_shell.hpp"
#include "supervisor/platform/launch/thread_launcher.hpp"

/// The second deployment in real time (docs/adr/0097): supervisor and subsystems are threads of this process. Devices are wherever their
/// endnodes say.
namespace {

using namespace hirosco;
using namespace hirosco::supervisor;

/// Those of the mission's executables, which are modules. False: one is not here, and why was printed.
[[nodiscard]] bool find_makers(const descriptor::Mission& mission, ThreadLauncher::Makers& makers) {
  bool all = true;
  for (const auto& member : mission.subsystems) {
    const auto loaded = load_subsystem(member.executable);
    if (loaded) makers[member.executable] = (*loaded)->make;
    else fmt::print(stderr, "hirosco-threads: no module for {}: {}\n", member.subsystem.name, loaded.error());
    all = all && loaded.has_value();
  }
  return all;
}

[[nodiscard]] Deployment deploy(const FlightParts& parts) {
  ThreadLauncher::Makers makers;
  if (!find_makers(parts.mission, makers)) return {};
  // All of it, code of modules and stacks included: no cycle waits for a page.
  if (parts.realtime) static_cast<void>(lock_memory());
  auto launcher = std::make_unique<ThreadLauncher>(
      ThreadLauncher::Parts{.clock = parts.clock,
                            .flows = parts.flows,
                            .makers = std::move(makers),
                            .realtime = parts.realtime,
                            .links = local_link_mechanisms(),
                            // By whoever's service loop it is: it must not wait for a terminal.
                            .explain = [errors = std::make_shared<LineWriter>(STDERR_FILENO)](std::string_view line) {
                              errors->say(fmt::format("{}\n", line));
                            }});
  MemoryProvider& memory = launcher->memory();
  return {.launcher = std::move(launcher), .memory = &memory, .links = local_link_mechanisms()};
}

}  // namespace

int main(int argc, char** argv) { return fly(argc, argv, deploy); }
