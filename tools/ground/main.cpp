// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "ground/api/api.hpp"
#include "ground/api/openapi.hpp"
#include "ground/shell/http_server.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/program_options.hpp"
#include "simulation/devices/module.hpp"
#include "tools/ground/injections.hpp"
#include "tools/ground/why.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/json_line.hpp"

/// `hirosco-ground`: the process behind `hirosco ground` and `hirosco why`, which judge what a value means.
namespace {

using namespace hirosco;
using namespace hirosco::ground;
namespace fs = std::filesystem;
using Options = std::map<std::string, std::string>;

constexpr std::array known_options{ProgramOption{"--mission", "FILE"},
                                   ProgramOption{"--archive", "FILE"},
                                   ProgramOption{"--telemetry", "ADDRESS:PORT"},
                                   ProgramOption{"--devices", "FOLDER"},
                                   ProgramOption{"--port", "N"},
                                   ProgramOption{"--page", "FOLDER"},
                                   ProgramOption{"--child"},
                                   ProgramOption{"--json"},
                                   ProgramOption{"--quiet"},
                                   ProgramOption{"--tour"},
                                   ProgramOption{"--why"},
                                   ProgramOption{"--flown", "NANOSECONDS"},
                                   ProgramOption{"--md"},
                                   ProgramOption{"--openapi"}};

[[nodiscard]] std::string new_token() {
  std::random_device device;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", device());
  return token;
}

[[nodiscard]] std::string option(const Options& options, const std::string& name, const std::string& otherwise = "") {
  const auto found = options.find(name);
  return found != options.end() ? found->second : otherwise;
}

[[nodiscard]] std::vector<Transition> state_table() {
  std::vector<Transition> table;
  for (const Edge& edge : transitions) table.push_back({edge.from, edge.to, edge.kind == EdgeKind::Failure});
  return table;
}

/// What the simulated devices of a mission understand, as their modules tell: of one whose module is not here, what all do.
[[nodiscard]] FaultTexts fault_texts(const descriptor::Mission& mission) {
  FaultTexts texts;
  const auto add = [&](const std::string& device, std::span<const simulation::FaultLine> lines) {
    for (const auto& fault : lines) texts[device].push_back({fault.line, fault.text});
  };
  for (const auto& device : mission.devices) {
    add(device.name, simulation::SimulatedDevice::common_fault_lines);
    if (const auto module = simulation::load_device(device.executable)) add(device.name, (*module)->faults);
  }
  return texts;
}

/// Beside the log that the supervisor writes.
[[nodiscard]] fs::path archive_of(const descriptor::Mission& mission) {
  const fs::path& log = mission.database.path;
  return tools::archive_beside(log.empty() ? fs::path{"log/" + mission.name + ".db"} : log);
}

/// Two stations that write into one archive would keep everything twice: the lock lives as long as the process.
[[nodiscard]] FileDescriptor take_lock(const fs::path& archive) {
  FileDescriptor lock{::open((archive.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)};
  if (lock && ::flock(lock.get(), LOCK_EX | LOCK_NB) == 0) return lock;
  return {};
}

/// The beginning of the newest flight, on-board time, where it is later than all that the archive has; empty: it is not, or nobody has said one.
[[nodiscard]] std::optional<double> unkept_flight(const Options& options, Archive& archive) {
  const std::string text = option(options, "--flown");
  Duration::rep began = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), began).ec != std::errc{}) return std::nullopt;
  const auto kept = archive.extent();
  if (kept && kept->to.time_since_epoch().count() >= began) return std::nullopt;
  return seconds(Duration{began});
}

[[nodiscard]] int print_why(Session& session, const Options& options, const fs::path& path, Archive& archive) {
  Api api{session, {.token = "-", .observer_token = {}, .page = {}, .transitions = {}}};
  const auto ask = [&](const char* target, const auto& take) {
    api.handle({"GET", target, {{"host", "127.0.0.1:8080"}, {"authorization", "Bearer -"}}, {}}, take);
  };
  const std::string& mission = session.catalogue().mission().name;
  WhichFlight which{.story_s = {}, .since_s = unkept_flight(options, archive)};
  const bool colour = ::isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  const WhyStyle style = options.contains("--md") ? WhyStyle::Markdown : colour ? WhyStyle::Coloured : WhyStyle::Lines;
  ask("/api/why", [&](const HttpResponse& response) {
    if (options.contains("--json")) {
      if (which.since_s) fmt::print(stderr, "hirosco why: {}\n", flown_since(mission, which));
      return fmt::print("{}\n", response.body);
    }
    const auto story = nlohmann::json::parse(response.body, nullptr, false);
    ask("/api/flights", [&](const HttpResponse& flights) {
      which.story_s = flight_of(nlohmann::json::parse(flights.body, nullptr, false), story);
    });
    fmt::print("{}", why_text(story, mission, path.string(), style, which));
  });
  return tools::exit_ok;
}

constexpr std::uint16_t first_port = 8080;
constexpr std::uint16_t tried_ports = 20;

/// At the port that was asked for and no other; without a wish at the first free one, so that two flights have two pages.
[[nodiscard]] Result<std::unique_ptr<HttpServer>> listen(HttpServer::Options options, const std::string& wish) {
  options.port = wish.empty() ? first_port : static_cast<std::uint16_t>(std::atoi(wish.c_str()));
  auto server = HttpServer::listen(options);
  for (std::uint16_t tried = 1; wish.empty() && tried < tried_ports && !server; ++tried) {
    if (server.error().code != ErrorCode::Unavailable) break;
    options.port = static_cast<std::uint16_t>(first_port + tried);
    server = HttpServer::listen(options);
  }
  if (!server)
    fmt::print(stderr, "hirosco ground: port {}{}: {} (another one: --port N; none at all: hirosco run --no-ground)\n",
               wish.empty() ? fmt::format("{} to ", first_port) : "", options.port, server.error().text);
  else if (wish.empty() && options.port != first_port)
    fmt::print(stderr, "hirosco ground: port {} is taken, so the page is at {}\n", first_port, options.port);
  return server;
}

[[nodiscard]] int serve(const Options& options, const descriptor::Mission& mission, const Catalogue& catalogue,
                        Archive& archive) {
  const SystemClock clock;
  HttpServer::Options server_options;
  server_options.spacecraft = option(options, "--telemetry", mission.ground.telemetry);
  server_options.telecommand_port = tools::telecommand_port(mission, tools::port_of(server_options.spacecraft));
  server_options.end_with_input = options.contains("--child");
  const auto server = listen(server_options, option(options, "--port"));
  if (!server) return tools::exit_environment;
  HttpServer& shell = **server;
  const fs::path devices = option(options, "--devices", tools::runtime_folder(mission.name).string());
  Surroundings outside;
  outside.send = [&](Octets packet, Way way) { return shell.send(packet, way); };
  outside.ask_device = [&](const std::string& device, const std::string& line, auto done) {
    shell.ask((devices / device).string(), line, std::move(done));
  };
  std::vector<std::string> device_names;
  for (const auto& device : mission.devices) device_names.push_back(device.name);
  Injections injections{devices, std::move(device_names), clock};
  outside.injected = [&] { return injections.poll(); };
  const auto process = static_cast<unsigned>(::getpid());
  Session session{{.catalogue = catalogue,
                   .archive = archive,
                   .clock = clock,
                   .outside = std::move(outside),
                   .source = static_cast<std::uint16_t>(0x2000U | (process & 0x1FFFU)),
                   .first_count = static_cast<std::uint16_t>(std::random_device{}() & 0x3FFFU)}};
  // Not in the arguments, which everybody on this computer can read.
  const auto token_of = [](const char* variable) {
    const char* given = std::getenv(variable);
    return given != nullptr && *given != '\0' ? std::string{given} : new_token();
  };
  const std::string token = token_of("HIROSCO_GROUND_TOKEN");
  const std::string observer = token_of("HIROSCO_GROUND_OBSERVER_TOKEN");
  Api api{session,
          {.token = token,
           .observer_token = observer,
           .port = shell.port(),
           .page = option(options, "--page", find_shipped("page").string()),
           .mission_page = mission.file.parent_path() / "page",
           .transitions = state_table(),
           .faults = fault_texts(mission)}};
  const bool tour = options.contains("--tour");
  const std::string page = fmt::format("http://127.0.0.1:{}/#token=", shell.port());
  const std::string url = page + token + (tour ? "&tour" : "");
  if (options.contains("--json")) {
    fmt::print("{}\n", tools::json_line({{"url", url}, {"observer_url", page + observer}}));
  } else if (!options.contains("--quiet")) {
    fmt::print("{}: {}\n", tour ? "open this for the tour" : "ground station", url);
    fmt::print("  to look only: {}{}\n", page, observer);
  }
  std::fflush(stdout);
  shell.run(api);
  return tools::exit_ok;
}

}  // namespace

int main(int argc, char** argv) {
  hirosco::say_last_words("hirosco-ground");
  const auto given = given_options(argc, argv, known_options);
  if (!given) {
    fmt::print(stderr, "hirosco-ground: {} (started by 'hirosco ground', 'hirosco why' and 'hirosco run')\n",
               given.error());
    return tools::exit_usage;
  }
  Options options;
  for (const auto& [name, value] : *given) options[std::string{name}] = value;
  if (options.contains("--openapi")) {
    fmt::print("{}\n", openapi_document().dump(1));
    return tools::exit_ok;
  }
  auto mission = tools::load_mission(option(options, "--mission"));
  if (!mission) return tools::exit_finding;
  const fs::path path = option(options, "--archive", archive_of(*mission).string());
  std::error_code failed;
  const bool serves = !options.contains("--why");
  if (!serves && !fs::exists(path, failed)) {
    fmt::print(stderr,
               "hirosco why: {} has no archive {}: a ground station makes it while the mission flies (hirosco run, "
               "hirosco ground)\n",
               mission->name, path.string());
    return tools::exit_environment;
  }
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), failed);
  const FileDescriptor lock = serves ? take_lock(path) : FileDescriptor{};
  if (serves && !lock) {
    fmt::print(stderr,
               "hirosco ground: {} cannot be written, or another station keeps it (another one: --archive FILE)\n",
               path.string());
    return tools::exit_environment;
  }
  auto archive = Archive::open(path.string());
  if (!archive) {
    fmt::print(stderr, "hirosco ground: {}: {}\n", path.string(), archive.error().text);
    return tools::exit_environment;
  }
  const Catalogue catalogue{*mission};
  if (serves) return serve(options, *mission, catalogue, **archive);
  const SystemClock clock;
  Session session{{.catalogue = catalogue, .archive = **archive, .clock = clock, .outside = {}}};
  return print_why(session, options, path, **archive);
}
