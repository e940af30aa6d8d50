// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/instance.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"

namespace hirosco::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_name = 64;

struct Address {
  std::string host;
  std::uint16_t port{0};
};

[[nodiscard]] Address address_of(const std::string& text) {
  const auto colon = text.rfind(':');
  Address address{.host = text.substr(0, colon)};
  if (colon == std::string::npos) return address;
  std::from_chars(text.data() + colon + 1, text.data() + text.size(), address.port);
  return address;
}

/// In numbers, as sockets want it.
[[nodiscard]] std::string in_numbers(const std::string& address) {
  constexpr std::string_view name{"localhost:"};
  return address.starts_with(name) ? "127.0.0.1:" + address.substr(name.size()) : address;
}

/// What a second process at the same address would get in the way of: neither name nor port is the instance's.
[[nodiscard]] std::vector<std::string> ports_of(const descriptor::Mission& mission) {
  std::vector<std::string> found;
  const auto note = [&](const descriptor::Endnode& endnode) {
    const FlowMeans* means = find_flow_means(endnode.transfer);
    if (means == nullptr || means->form == AddressForm::Name) return;
    if (means->form == AddressForm::HostPort || endnode.address.starts_with('/')) found.push_back(endnode.address);
  };
  for (const auto& member : mission.subsystems) {
    for (const auto& device : member.subsystem.devices)
      if (device.enable) {
        note(*device.enable);
        std::ranges::for_each(device.enable_terms.fall_backs, note);
      }
    for (const auto& power : member.subsystem.power_switches) {
      note(power.endnode);
      std::ranges::for_each(power.terms.fall_backs, note);
    }
    for (const auto& configuration : member.subsystem.configurations)
      for (const auto& use : configuration.devices) {
        note(use.endnode);
        std::ranges::for_each(use.fall_backs, note);
      }
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

/// What to do where nothing flies and nobody says which mission is meant.
[[nodiscard]] std::string nothing_flies(std::string_view command) {
  std::string text =
      "nothing flies here (hirosco run MISSION), and no mission is meant: name one by --mission NAME or FILE";
  if (command == "log") text += ", or a log by --path FILE";
  if (command == "why") text += ", or an archive by --archive FILE";
  return text + "; in a folder with a mission.xml that is the one";
}

[[nodiscard]] std::string list_of(const std::vector<FlightEntry>& flights) {
  std::string text;
  for (const auto& flight : flights)
    text += fmt::format("\n  --instance {}: mission {}, telemetry {}, log {}", flight.instance, flight.mission,
                        flight.telemetry.empty() ? "none" : flight.telemetry, flight.log.string());
  return text;
}

/// Missions of this folder that have a log of this instance: those whose files stand in it, and those whose names its logs have. Of several that
/// write into one log its mission.xml is meant.
[[nodiscard]] std::vector<FoundLog> flown_from_here(const std::string& instance) {
  std::vector<FoundLog> found;
  const auto note = [&](const fs::path& file, const fs::path& known_log = {}) {
    auto reading = descriptor::read_mission(file, descriptor::file_system());
    if (!reading.value || !reading.problems.empty()) return;
    auto log = instance_log(*reading.value, instance);
    if (log != known_log && !supervisor::pieces_of(log).empty())
      found.push_back({std::move(*reading.value), std::move(log)});
  };
  const auto names_in = [](const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code failed;
    for (fs::directory_iterator files{folder, failed}, none; !failed && files != none; files.increment(failed))
      names.push_back(files->path().filename().string());
    std::ranges::sort(names);
    return names;
  };
  note("mission.xml");
  const fs::path its_log = found.empty() ? fs::path{} : found.front().path;
  for (const std::string& name : names_in("."))
    if (name.ends_with(".xml") && name != "mission.xml") note(name, its_log);
  // Pieces of one log are NAME.db, NAME.2.db and so on.
  std::vector<std::string> flown;
  for (const std::string& name : names_in(fs::path{"log"} / instance)) flown.push_back(name.substr(0, name.find('.')));
  flown.erase(std::ranges::unique(flown).begin(), flown.end());
  for (const std::string& name : flown) {
    const bool known = std::ranges::any_of(found, [&](const FoundLog& each) { return each.path.stem() == name; });
    if (const fs::path file = known ? fs::path{} : find_mission(name); !file.empty()) note(file);
  }
  return found;
}

/// What to say of an instance that does not fly: which missions have flown as it, or that none has.
[[nodiscard]] std::string which_has_flown(const char* command, const std::string& instance,
                                          const std::vector<FoundLog>& flown) {
  std::string text =
      fmt::format("instance '{}' has flown from here with {} missions; which one?", instance, flown.size());
  for (const FoundLog& each : flown)
    text += fmt::format("\n  hirosco {} {} --instance {}: mission {}, log {}", command, each.mission.file.string(),
                        instance, each.mission.name, each.path.string());
  return text;
}

}  // namespace

bool good_instance(const std::string& name) {
  const auto good = [](unsigned char letter) {
    return (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z') ||
           letter == '-' || letter == '_';
  };
  return !name.empty() && name.size() <= longest_name && std::ranges::all_of(name, good);
}

Result<> can_listen(const std::string& text) {
  const Address wanted = address_of(text);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(wanted.port);
  if (::inet_pton(AF_INET, wanted.host.c_str(), &address.sin_addr) != 1)
    return fail(ErrorCode::InvalidArgument, "the ground link needs an IPv4 address");
  const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(socket.get(), 1) == 0)
    return ok();
  if (errno == EADDRINUSE) return fail(ErrorCode::Unavailable, "somebody listens there already", errno);
  return fail(ErrorCode::SystemFailure, "this computer does not let us listen there", errno);
}

fs::path instance_log(const descriptor::Mission& mission, const std::string& instance) {
  const fs::path& path = mission.database.path;
  return instance.empty() || instance == mission.name ? path : path.parent_path() / instance / path.filename();
}

FlightEntry plan_flight(const descriptor::Mission& mission, const std::string& instance) {
  std::error_code failed;
  FlightEntry entry{.instance = instance,
                    .mission = mission.name,
                    .file = fs::absolute(mission.file, failed),
                    .folder = runtime_folder(instance),
                    .log = fs::absolute(instance_log(mission, instance), failed),
                    .udp = ports_of(mission),
                    .cores = flight_cores(mission, ProcessorSet::of_this_thread()),
                    .keeper = ::getpid()};
  if (mission.ground.subsystem.empty()) return entry;
  entry.telemetry = in_numbers(mission.ground.telemetry);
  entry.telecommand = in_numbers(mission.ground.telecommand);
  return entry;
}

std::expected<std::optional<FlightEntry>, std::string> choose_flight(const std::vector<FlightEntry>& flights,
                                                                     const Which& which) {
  if (!which.instance.empty()) {
    const auto wanted = std::ranges::find(flights, which.instance, &FlightEntry::instance);
    if (wanted == flights.end())
      return std::unexpected{fmt::format("no instance '{}' flies{}", which.instance,
                                         flights.empty() ? "; nothing flies here" : "; there are:" + list_of(flights))};
    if (!which.mission.empty() && wanted->mission != which.mission)
      return std::unexpected{
          fmt::format("instance '{}' flies mission {}, not {}", which.instance, wanted->mission, which.mission)};
    return *wanted;
  }
  std::vector<FlightEntry> meant;
  for (const auto& flight : flights)
    if (which.mission.empty() || flight.mission == which.mission) meant.push_back(flight);
  if (meant.empty()) return std::nullopt;
  if (meant.size() == 1) return meant.front();
  return std::unexpected{fmt::format("{} flights are in the air; which one?{}", meant.size(), list_of(meant))};
}

std::expected<FoundFlight, int> find_flight(const char* command, const std::string& mission,
                                            const std::string& instance) {
  std::optional<descriptor::Mission> loaded;
  if (!mission.empty()) {
    loaded = load_mission(mission);
    if (!loaded) return std::unexpected{exit_finding};
  }
  auto chosen = choose_flight(FlightRegistry{}.flights(), {loaded ? loaded->name : std::string{}, instance});
  if (!chosen) {
    fmt::print(stderr, "hirosco {}: {}\n", command, chosen.error());
    return std::unexpected{exit_usage};
  }
  if (!loaded) {
    const std::string name = *chosen ? (*chosen)->file.string() : meant_mission();
    if (name.empty()) {
      fmt::print(stderr, "hirosco {}: {}\n", command, nothing_flies(command));
      return std::unexpected{exit_environment};
    }
    loaded = load_mission(name);
  }
  if (!loaded) return std::unexpected{exit_finding};
  return FoundFlight{std::move(*loaded), std::move(*chosen)};
}

std::expected<FoundFlight, int> only_mission(const char* command, const std::string& mission) {
  std::string name = mission.empty() ? meant_mission() : mission;
  if (name.empty()) {
    name = usual_mission();
    fmt::print(stderr, "hirosco {}: no mission is named: taken is {} (another one: --mission NAME or FILE)\n", command,
               name);
  }
  auto loaded = load_mission(name);
  if (!loaded) return std::unexpected{exit_finding};
  return FoundFlight{std::move(*loaded), std::nullopt};
}

std::expected<FoundLog, int> find_log(const char* command, const std::string& mission, const std::string& instance) {
  const auto flights = FlightRegistry{}.flights();
  const bool flies = std::ranges::find(flights, instance, &FlightEntry::instance) != flights.end();
  if (good_instance(instance) && !flies) {
    auto flown = mission.empty() ? flown_from_here(instance) : std::vector<FoundLog>{};
    if (flown.size() == 1) return std::move(flown.front());
    if (flown.size() > 1) {
      fmt::print(stderr, "hirosco {}: {}\n", command, which_has_flown(command, instance, flown));
      return std::unexpected{exit_usage};
    }
    // The one that is named, or meant here: what is wrong with its file is told.
    const std::string name = mission.empty() ? meant_mission() : mission;
    auto meant = name.empty() ? std::nullopt : load_mission(name);
    if (!name.empty() && !meant) return std::unexpected{exit_finding};
    const fs::path log = meant ? instance_log(*meant, instance) : fs::path{"log"} / instance / "NAME.db";
    if (meant && !supervisor::pieces_of(log).empty()) return FoundLog{std::move(*meant), log};
    fmt::print(stderr, "hirosco {0}: {1}\nhirosco {0}: nor has it flown from this folder: no {2}\n", command,
               choose_flight(flights, {{}, instance}).error(), log.string());
    return std::unexpected{exit_usage};
  }
  auto found = find_flight(command, mission, instance);
  if (!found) return std::unexpected{found.error()};
  auto path = found->flight ? found->flight->log : found->mission.database.path;
  return FoundLog{std::move(found->mission), std::move(path), std::move(found->flight)};
}

std::expected<GroundLinkPlace, int> find_ground_link(const char* command, const Connection& connection) {
  // Who says where it is gets exactly that, whatever flies on this computer.
  const bool said = !connection.host.empty() || connection.port != 0;
  if (said && connection.instance.empty()) {
    auto named = only_mission(command, connection.mission);
    if (!named) return std::unexpected{named.error()};
    const Address usual = address_of(in_numbers(named->mission.ground.telemetry));
    return GroundLinkPlace{std::move(named->mission), connection.host.empty() ? usual.host : connection.host,
                           connection.port == 0 ? usual.port : connection.port};
  }
  auto found = find_flight(command, connection.mission, connection.instance);
  if (!found) return std::unexpected{found.error()};
  const Address place =
      address_of(found->flight ? found->flight->telemetry : in_numbers(found->mission.ground.telemetry));
  if (place.port == 0 && connection.port == 0) {
    fmt::print(stderr, "hirosco {}: {} has no ground link\n", command, found->flight->instance);
    return std::unexpected{exit_environment};
  }
  return GroundLinkPlace{std::move(found->mission), connection.host.empty() ? place.host : connection.host,
                         connection.port == 0 ? place.port : connection.port,
                         found->flight ? found->flight->keeper : 0};
}

}  // namespace hirosco::tools
