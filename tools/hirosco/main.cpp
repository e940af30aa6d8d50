// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "hirosco/utilities/version.hpp"
#include "tools/dynamics/batch.hpp"
#include "tools/hirosco/command_line.hpp"
#include "tools/hirosco/command_pages.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/new_folder/kinds.hpp"

/// `hirosco`: one command for everything. The command line is read here and nowhere else.
namespace {

using namespace hirosco;
using namespace hirosco::tools;

void add_instance(CLI::App& command, std::string& instance) {
  command.add_option("--instance", instance, "Which flight, where several are in the air");
}

/// `json`: what comes in place of text.
void add_connection(CLI::App& command, Connection& connection, const std::string& json) {
  command.add_option(
      "--mission", connection.mission,
      "Mission whose descriptors decode the packets; by default the one that flies, else that of this folder");
  add_instance(command, connection.instance);
  command.add_option("--host", connection.host, "Address of the ground link; by default the flight's");
  command.add_option("--port", connection.port, "Port of the ground link; by default the flight's");
  command.add_flag("--json", connection.json, json);
}

/// A first word that is no command: says which there are.
[[nodiscard]] bool unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == argv[1]) return false;
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  fmt::print(stderr, "hirosco: no command '{}'{}; there are: {}\n", argv[1], did_you_mean(argv[1], names),
             fmt::join(names, ", "));
  return true;
}

/// `hirosco new KIND --help` speaks of this kind alone. False: it is not asked.
[[nodiscard]] bool tell_kind(CLI::App& command, int argc, char** argv) {
  if (argc < 4 || argv[1] != command.get_name()) return false;
  const std::string_view asked{argv[argc - 1]};
  const auto kinds = new_kinds();
  const auto kind = std::ranges::find(kinds, std::string_view{argv[2]}, [](const NewKind& one) { return one.name; });
  if (kind == kinds.end() || (asked != "--help" && asked != "-h")) return false;
  command.remove_option(command.get_option("kind"));
  if (!kind->of_urdf)
    for (const char* option : {"--urdf", "--tip", "--gripper", "--chain", "--homing", "--wrist-sensor", "--packages"})
      command.remove_option(command.get_option(option));
  command.description(fmt::format("Make {}. It prints what to type next", kind->makes));
  command.name(fmt::format("new {}", kind->name));
  fmt::print("{}", command.help("hirosco"));
  return true;
}

/// To standard output where no file is named.
int write_page(const std::string& file, const std::string& text) {
  if (file.empty()) return fmt::print("{}", text), exit_ok;
  std::ofstream written{file};
  return written << text && written.flush() ? exit_ok : exit_environment;
}

int read_and_do(int argc, char** argv) {
  CLI::App app{"HIROSCO, a high-level robotic spacecraft controller"};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string{"hirosco "} + version);

  RunOptions run_options;
  std::string run_for;
  auto* run_command = app.add_subcommand("run", "Fly a mission with real processes until Ctrl-C");
  run_command->add_option("mission", run_options.mission, "Name or path of a mission; without one, they are listed");
  run_command->add_option("--instance", run_options.instance,
                          "A name of its own for this flight: log, ports, sockets and devices of its own, too");
  run_command->add_option("--mode", run_options.mode, "Start in this mode of the mission");
  run_command->add_option("--for", run_for, "Shut down in order after this time (60s, 10min)");
  run_command->add_flag("--quiet", run_options.quiet, "Print nothing but errors");
  run_command->add_flag("--plain", run_options.plain, "Lines, and no screen, on a terminal, too");
  bool no_ground = false;
  run_command->add_flag("--no-ground", no_ground, "Without the ground station and its page");
  run_command->add_flag("--json", run_options.json, "One JSON object a line");
  run_command->add_flag("--threads", run_options.threads,
                        "Supervisor and subsystems as threads of one process, which isolates nobody");

  std::string tour_mission;
  auto* tour_command = app.add_subcommand("tour", "Fly a mission and be shown around by its page, in eight steps");
  tour_command->add_option("mission", tour_mission, "Name or path of a mission; by default the usual one");
  tour_command->add_option("--for", run_for, "Shut down in order after this time (60s, 10min)");
  tour_command->add_flag("--plain", run_options.plain, "Lines, and no screen, on a terminal, too");

  CheckOptions check_options;
  auto* check_command = app.add_subcommand("check", "Check descriptors and missions, all problems at once");
  check_command->add_option("files", check_options.files, "Descriptor or mission files")->required();
  auto* show = check_command->add_flag("--show", check_options.show, "Print what was read");
  auto* recovery =
      check_command->add_flag("--recovery", check_options.recovery,
                              "Print which plan each event would get in which mode, and which gives way to which");
  // What those two print is for people.
  check_command->add_flag("--json", check_options.json, "Problems as JSON, one a line")
      ->excludes(show)
      ->excludes(recovery);
  check_command->add_flag("--fly", check_options.fly,
                          "Also all programs that a mission needs must be here, and modules that are here be of this "
                          "version");

  DoctorOptions doctor_options;
  auto* doctor_command = app.add_subcommand(
      "doctor",
      "What this computer has and lacks for a flight, with the line that mends it; ends with 1 when it matters");
  doctor_command->add_option("mission", doctor_options.mission,
                             "Name or path of the mission that is to fly; by default the usual one");
  doctor_command->add_flag("--json", doctor_options.json, "One JSON object a line, for each row");

  NewOptions new_options;
  std::vector<std::string> kinds;
  std::string kinds_help = "What to make";
  for (const NewKind& kind : new_kinds()) {
    kinds.emplace_back(kind.name);
    kinds_help += fmt::format("; {}: {}", kind.name, kind.makes);
  }
  auto* new_command =
      app.add_subcommand("new", "Make a folder of one's own that builds, tests, simulates and flies as it is");
  new_command->add_option("kind", new_options.kind, kinds_help)->required()->check(CLI::IsMember(kinds));
  new_command->add_option("name", new_options.name, "Name of what it makes, and of the folder")->required();
  new_command->add_option("--to", new_options.to, "Folder that gets it")->capture_default_str();
  new_command->add_option("--urdf", new_options.urdf,
                          "Of a robot: its URDF file; by default an arm that is there to try");
  new_command->add_option("--tip", new_options.tip,
                          "Of a robot: the link that is its tool; by default the only end that moves");
  new_command->add_option("--gripper", new_options.gripper,
                          "Of a robot: joints that drive fingers (NAME,NAME): a subsystem of their own");
  new_command->add_flag("--chain", new_options.chain,
                        "Of a robot: only the joints that move tip and gripper are flown, all others stand at 0");
  new_command->add_flag(
      "--homing", new_options.homing,
      "Of a robot that weighs nothing: its encoders do not know their zeros, and its joints look for them");
  new_command->add_flag("--wrist-sensor", new_options.wrist_sensor,
                        "Of a robot: a sensor of force and moment at its tip");
  new_command->add_option("--packages", new_options.packages,
                          "Of a robot: a folder in which its meshes' packages lie, where they are not above its file");

  SimulateOptions simulate_options;
  std::string simulate_for = "10s";
  std::string simulate_seed = "1";
  auto* simulate_command =
      app.add_subcommand("simulate", "Fly a mission in one process on virtual time and print its log");
  simulate_command->add_option("mission", simulate_options.mission, "Name or path of a mission")->required();
  simulate_command->add_option("--mode", simulate_options.mode, "Start in this mode of the mission");
  simulate_command->add_option("--for", simulate_for, "Virtual time")->capture_default_str();
  simulate_command->add_option("--seed", simulate_seed, "Seed of everything random")->capture_default_str();
  simulate_command->add_option(
      "--trace", simulate_options.trace,
      "Write the truth of the simulated world as CSV, at cycle rate; each 10 ms while there is no cycle");
  simulate_command->add_option("--at", simulate_options.at,
                               "Injection \"SECONDS DEVICE LINE\", \"SECONDS kill SUBSYSTEM\" or \"SECONDS tc "
                               "SUBSYSTEM FUNCTION [VALUE...]\" from "
                               "ground, before the end, in any order");
  simulate_command->add_option(
      "--values", simulate_options.values,
      "Folder of persistent parameters' values, read and written; by default there are none before");
  simulate_command->add_flag("--summary", simulate_options.summary, "Print counts instead of the log");
  simulate_command->add_flag("--octets", simulate_options.octets, "Print each packet's octets behind its words");

  std::string judged_mission;
  auto* report_command = app.add_subcommand(
      "report",
      "Fly the runs that a mission is judged by and compare their figures (its options: report MISSION --help)");
  report_command->add_option("mission", judged_mission, "Name or path of a mission, before all options")->required();

  TelecommandOptions tc_options;
  std::string tc_limit = "70s";
  auto* tc_command = app.add_subcommand("tc", "Send a telecommand by name and wait for its verification reports");
  tc_command->add_option("subsystem", tc_options.subsystem, "Name of the subsystem; without one, they are listed");
  tc_command->add_option("function", tc_options.function,
                         "Name of the function, or ping; without one, those that it has are listed");
  tc_command->add_option("arguments", tc_options.arguments, "Values in order, or NAME=VALUE")->allow_extra_args();
  tc_command->add_flag("--yes", tc_options.yes,
                       "Send without asking what its descriptor wants confirmed at a terminal");
  tc_command->add_option("--limit", tc_limit, "How long to wait for the end")->capture_default_str();
  add_connection(*tc_command, tc_options.connection, "One JSON object a line, for each report");

  PermissionsOptions permissions_options;
  auto* permissions_command = app.add_subcommand(
      "permissions", "Who may ask what of whom in which mode and state, as the supervisor judges it");
  permissions_command->add_option("mission", permissions_options.mission, "Mission: a name or a path")->required();
  permissions_command->add_option("--mode", permissions_options.mode, "Only this mode");
  permissions_command->add_flag("--csv", permissions_options.csv,
                                "A line for each request; ten places, one for each state");

  DynamicsOptions dynamics_options;
  auto* dynamics_command = app.add_subcommand(
      "dynamics", "The equations of motion of a robot from a URDF file: JSON lines in, JSON lines out");
  dynamics_command->add_option("model", dynamics_options.model, "URDF file")->required();
  dynamics_command->add_option("--tip", dynamics_options.tip,
                               "Link whose Jacobians are told; by default the only one at an end");
  dynamics_command->footer(batch_help);

  ManifestOptions manifest_options;
  auto* manifest_command =
      app.add_subcommand("manifest", "SHA-256 of a mission's executables and their versions, as sha256sum writes it");
  manifest_command->add_option("mission", manifest_options.mission, "Mission: a name or a path")->required();
  manifest_command->add_flag("--write", manifest_options.write, "Into the file that the mission names");

  ModeOptions mode_options;
  std::string mode_limit = "70s";
  auto* mode_command = app.add_subcommand("mode", "Bring the whole craft into a mode; without a name, list the modes");
  mode_command->add_option("name", mode_options.name, "Name of the mode");
  mode_command->add_flag("--preview", mode_options.preview,
                         "Only tell the steps that it would take, or all that is against it");
  mode_command->add_option("--limit", mode_limit, "How long to wait for the end")->capture_default_str();
  add_connection(
      *mode_command, mode_options.connection,
      "One JSON object a line: for each report; with --preview one for all, without a name one for each mode");

  PlanOptions plan_options;
  std::string plan_limit = "10s";
  auto* plan_command =
      app.add_subcommand("plan", "What recovery would do about an event now, in steps; nothing is done");
  plan_command->add_option("event", plan_options.event, "SUBSYSTEM:EVENT, for example ARM:PROCESS_DIED")->required();
  plan_command->add_flag("--descriptors", plan_options.from_descriptors,
                         "In each mode, as the descriptors say it: needs no flight");
  plan_command->add_option("--limit", plan_limit, "How long to wait for the answer")->capture_default_str();
  add_connection(*plan_command, plan_options.connection, "One JSON object; with --descriptors a list of them");

  StatusOptions status_options;
  auto* status_command =
      app.add_subcommand("status", "Is it well? One line and what deviates; ends with 1 when it is not");
  status_command->add_option("subsystem", status_options.of,
                             "The newest housekeeping of this subsystem, and the verdict in one line");
  status_command->add_flag("--all", status_options.all, "The newest housekeeping of every subsystem besides");
  add_connection(*status_command, status_options.connection,
                 "One JSON object a line: for each subsystem, last the verdict with its findings and the way up");

  LogOptions log_options;
  auto* log_command = app.add_subcommand("log", "Read the supervisor's log; its times are UTC");
  const std::string whose_log =
      "Mission whose log is read; by default the one that flies, else that of this folder: of its mission.xml, or its "
      "only log";
  log_command->add_option("mission", log_options.mission, whose_log);
  log_command->add_option("--mission", log_options.mission, whose_log);
  log_command->add_option("--instance", log_options.instance, "Whose log, of those that fly or have flown from here");
  log_command->add_option("--path", log_options.path, "Another log store");
  log_command->add_option("--apid", log_options.apid, "Only this subsystem");
  log_command->add_option("--service", log_options.service, "Only this service");
  log_command->add_option("--text", log_options.text, "Only lines with this text");
  log_command->add_option("--last", log_options.last, "So many of the newest")->capture_default_str();
  log_command->add_flag(
      "--housekeeping", log_options.housekeeping,
      "Housekeeping with its values, too, which is left out by itself (--service 3 has it; --json without values)");
  log_command->add_flag("--json", log_options.json, "One JSON object a line");

  ResourcesOptions resources_options;
  auto* resources_command = app.add_subcommand("resources",
                                               "What each subsystem declares in <Resources> beside the most that it "
                                               "took in the newest flight; while it flies what "
                                               "it takes now, too, and its process and power");
  resources_command->add_option("mission", resources_options.mission, whose_log);
  resources_command->add_option("--mission", resources_options.mission, whose_log);
  resources_command->add_option("--instance", resources_options.instance,
                                "Whose log, of those that fly or have flown from here");
  resources_command->add_flag("--all", resources_options.all, "In all flights that the log has");
  resources_command->add_flag("--json", resources_options.json, "One JSON object a line");

  FaultOptions fault_options;
  auto* fault_command =
      app.add_subcommand("fault", "Inject a fault into a simulated device, or move the operator's hand");
  fault_command->add_option("device", fault_options.device,
                            "Name of the device; without one, all are listed with what they take");
  fault_command
      ->add_option("line", fault_options.words,
                   "unplug, plug, freeze MS, corrupt N, hand wander, ...; without one, they are listed")
      ->allow_extra_args();
  fault_command->add_option("--mission", fault_options.mission,
                            "Mission that runs; by default the one that flies, else that of this folder");
  add_instance(*fault_command, fault_options.instance);
  SafeOptions safe_options;
  auto* safe_command = app.add_subcommand(
      "safe", "Stop every actuator but for the ground link's, past ground link, cycles, queues, disk and mode");
  safe_command->add_option("--mission", safe_options.mission, "Only this mission; by default all that fly here");
  safe_command->add_option("--instance", safe_options.instance, "Only this flight");

  GroundOptions ground_options;
  auto* ground_command = app.add_subcommand("ground", "Serve the ground station's page and API for a flying mission");
  const std::string whose = "Name or path of the mission; by default the one that flies, else that of this folder";
  ground_command->add_option("mission", ground_options.mission, whose);
  ground_command->add_option("--mission", ground_options.mission, whose);
  add_instance(*ground_command, ground_options.instance);
  ground_command->add_option("--port", ground_options.port,
                             "Port on the loopback address; by default the first free one from 8080 on");
  ground_command->add_option("--token", ground_options.token,
                             "What the page must know; a new one each time by default");
  ground_command->add_option("--observer-token", ground_options.observer_token,
                             "For those who may look but not command");
  ground_command->add_option("--telemetry", ground_options.telemetry, "ADDRESS:PORT of the spacecraft");
  ground_command->add_option("--archive", ground_options.archive, "File of the archive");
  ground_command->add_option("--page", ground_options.page, "Folder with another page");
  ground_command->add_flag("--json", ground_options.json, "One JSON object: the URLs");
  auto* why_command = app.add_subcommand("why", "The chain of causes of the last stop");
  why_command->add_option("mission", ground_options.mission, whose);
  why_command->add_option("--mission", ground_options.mission, whose);
  why_command->add_option("--instance", ground_options.instance,
                          "Which one, of those that fly or have flown from here");
  why_command->add_option("--archive", ground_options.archive, "File of the ground station's archive");
  why_command->add_flag("--json", ground_options.json, "One JSON object, as GET /api/why of the page answers");
  why_command->add_flag("--md", ground_options.markdown, "As a report in Markdown");
  ExportOptions export_options;
  auto* export_command = app.add_subcommand("export", "What other programs need of a mission");
  export_command->require_subcommand(1);
  const auto add_export = [&](tools::Exported what, const char* name, const char* says) {
    auto* command = export_command->add_subcommand(name, says);
    command->add_option("mission", export_options.mission, "Name or path of the mission")->required();
    command->add_option("--to", export_options.to, "Folder that gets it")->capture_default_str();
    command->callback([&export_options, what] { export_options.what = what; });
  };
  using tools::Exported;
  add_export(Exported::Python, "python",
             "A Python client from the descriptors: a package without requirements, a class for each subsystem");
  add_export(Exported::Xtce, "xtce", "Telemetry and telecommands as XTCE 1.2, for ground stations that read it");
  add_export(Exported::Yamcs, "yamcs", "A project with which Yamcs starts: database, links, events in words, stacks");
  add_export(Exported::InterfaceDocument, "icd", "The interface document: every packet, octet by octet, as Markdown");
  std::string page;
  auto* pages =
      app.add_subcommand(pages_command, "Writes the man page, the completion of bash, or the names of missions");
  pages->group("");
  std::string page_file;
  pages->add_option("page", page)->required()->check(CLI::IsMember({"man", "bash", "missions"}));
  pages->add_option("file", page_file);
  // Values such as -0.8 are arguments, not options.
  tc_command->prefix_command(false);

  if (unknown_command(app, argc, argv)) return exit_usage;
  if (tell_kind(*new_command, argc, argv)) return exit_ok;
  // What it takes is the mission's business.
  if (argc > 2 && argv[1] == std::string_view{"report"} && argv[2][0] != '-')
    return mission_program(argv[1], argv[2], {argv + 3, argv + argc});
  try {
    app.parse(argc, argv);
    simulate_options.seed = seed_of(simulate_seed);
    if (!run_for.empty()) run_options.run_for = duration_of(run_for);
    simulate_options.run_for = duration_of(simulate_for);
    tc_options.limit = duration_of(tc_limit);
    mode_options.limit = duration_of(mode_limit);
    plan_options.limit = duration_of(plan_limit);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? exit_ok : exit_usage;
  }
  if (*pages)
    return write_page(page_file, page == "man"    ? man_page(app)
                                 : page == "bash" ? bash_completion(app)
                                                  : fmt::format("{}\n", fmt::join(known_missions(), "\n")));
  run_options.ground = !no_ground;
  if (*run_command) return run(run_options);
  if (*tour_command) {
    run_options.mission = tour_mission.empty() ? usual_mission() : tour_mission;
    run_options.tour = true;
    return run(run_options);
  }
  if (*ground_command) return ground(ground_options);
  if (*why_command) return why(ground_options);
  if (*export_command) return export_mission(export_options);
  if (*check_command) return check(check_options);
  if (*new_command) return make_new(new_options);
  if (*doctor_command) return look_after(doctor_options);
  if (*simulate_command) return simulate(simulate_options);
  if (*report_command) return mission_program("report", judged_mission, {});
  if (*tc_command) return telecommand(tc_options);
  if (*mode_command) return mode(mode_options);
  if (*plan_command) return plan(plan_options);
  if (*dynamics_command) return dynamics(dynamics_options);
  if (*manifest_command) return manifest(manifest_options);
  if (*permissions_command) return permissions(permissions_options);
  if (*status_command) return status(status_options);
  if (*log_command) return log(log_options);
  if (*resources_command) return resources(resources_options);
  if (*safe_command) return safe(safe_options);
  return fault(fault_options);
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("hirosco", [&] { return read_and_do(argc, argv); });
}
