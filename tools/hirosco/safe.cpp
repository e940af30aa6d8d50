// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

constexpr std::string_view request{"SAFE"};
/// Of a flight whose lock does not say what its devices may take.
constexpr std::chrono::milliseconds usual_limit{2000};

enum class Stop : std::uint8_t { All, NotAll, Nobody };

/// One flight of this user. No descriptor is read for it: what stops a flight does not depend on a file that somebody edits.
struct Flying {
  std::filesystem::path folder;
  std::string name;  ///< of the instance
  std::string mission;  ///< as its lock or the registry says
  FileDescriptor socket;  ///< connected to its guard and asked; empty: nobody listens
  int keeper{0};
  std::chrono::milliseconds limit{usual_limit};
};

/// Asks the guard of a flight; empty when nobody takes it.
[[nodiscard]] FileDescriptor ask_guard(const std::filesystem::path& socket_path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = socket_path.string();
  if (path.size() >= sizeof address.sun_path) return {};
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  FileDescriptor socket{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  if (::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
    return {};
  return socket;
}

/// Prints what the guard answers, one line for each device or member.
[[nodiscard]] Stop answer_of(const Flying& flight, std::chrono::steady_clock::time_point limit) {
  if (!flight.socket) return Stop::Nobody;
  Stop outcome = Stop::Nobody;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit - std::chrono::steady_clock::now());
    pollfd wanted{flight.socket.get(), POLLIN, 0};
    // Without an end somebody may be missing in what was said.
    if (::poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) <= 0)
      return outcome == Stop::Nobody ? Stop::Nobody : Stop::NotAll;
    std::array<char, 512> line;
    const auto got = ::recv(flight.socket.get(), line.data(), line.size(), 0);
    if (got <= 0) return outcome;
    std::string_view text{line.data(), static_cast<std::size_t>(got)};
    while (text.ends_with('\n')) text.remove_suffix(1);
    fmt::print("{}: {}\n", flight.name, text);
    const bool stopped = text.find("did not confirm") == std::string_view::npos;
    if (!stopped) outcome = Stop::NotAll;
    else if (outcome == Stop::Nobody) outcome = Stop::All;
  }
}

/// The keeper of a flight; empty when this number is by now none of our programs.
[[nodiscard]] std::optional<Process> keeper_of(const Flying& flight) {
  if (flight.keeper <= 0) return std::nullopt;
  auto process = Process::adopt(flight.keeper);  // before we look: nobody else gets its number behind this handle
  std::error_code failed;
  const auto program = std::filesystem::read_symlink(fmt::format("/proc/{}/exe", flight.keeper), failed);
  if (!process || failed || !program.filename().string().starts_with("hirosco")) return std::nullopt;
  return std::move(*process);
}

[[nodiscard]] bool ours(const std::filesystem::path& folder) {
  struct stat facts{};
  return ::lstat(folder.c_str(), &facts) == 0 && S_ISDIR(facts.st_mode) && facts.st_uid == ::getuid();
}

/// Where flights of this user may be: in the runtime folder of this terminal, and where the registry says, as another one
/// may have another.
[[nodiscard]] std::vector<Flying> candidates() {
  std::vector<Flying> found;
  const auto add = [&](std::filesystem::path folder, std::string name, std::string mission, int keeper) {
    if (name.empty() || !ours(folder) || std::ranges::find(found, folder, &Flying::folder) != found.end()) return;
    found.push_back({.folder = std::move(folder),
                     .name = std::move(name),
                     .mission = std::move(mission),
                     .socket = {},
                     .keeper = keeper});
  };
  for (const FlightEntry& entry : FlightRegistry{}.flights())
    add(entry.folder, entry.instance, entry.mission, entry.keeper);
  std::error_code failed;
  for (std::filesystem::directory_iterator folders{runtime_root(), failed}, none; !failed && folders != none;
       folders.increment(failed))
    add(folders->path(), instance_of_folder(folders->path()), {}, 0);
  for (Flying& flight : found) {
    std::ifstream lock{flight.folder / "lock"};
    int keeper = 0;
    std::int64_t limit_ms = 0;
    std::string mission;
    if (lock >> keeper >> limit_ms) {
      flight.keeper = keeper;
      flight.limit = std::chrono::milliseconds{std::clamp<std::int64_t>(limit_ms, 0, 120'000)};
    }
    if (lock >> mission) flight.mission = mission;
    if (flight.mission.empty()) flight.mission = flight.name;
  }
  return found;
}

/// All flights that are meant and that somebody answers for: a guard or a keeper. Each guard has been asked when this
/// returns. `others` are the names of those that were not meant.
[[nodiscard]] std::vector<Flying> ask_all(const SafeOptions& wanted, std::vector<std::string>& others) {
  std::vector<Flying> found;
  for (Flying& flight : candidates()) {
    const bool meant = (wanted.instance.empty() || flight.name == wanted.instance) &&
                       (wanted.mission.empty() || flight.mission == wanted.mission || flight.name == wanted.mission);
    if (meant) flight.socket = ask_guard(flight.folder / "safe.socket");
    if (!flight.socket && !keeper_of(flight)) continue;
    if (meant) found.push_back(std::move(flight));
    else others.push_back(flight.name);
  }
  return found;
}

}  // namespace

int safe(const SafeOptions& options) {
  std::string wanted = options.mission;
  if (wanted.find_first_of("/.") != std::string::npos) {
    const auto mission = load_mission(wanted);
    if (!mission) return exit_finding;
    wanted = mission->name;
  }
  std::vector<std::string> others;
  const auto flights = ask_all({.mission = wanted, .instance = options.instance}, others);
  const auto asked = std::chrono::steady_clock::now();
  if (flights.empty() && !others.empty()) {
    fmt::print(stderr, "hirosco safe: {} does not fly; there are: {}\n",
               options.instance.empty() ? wanted : options.instance, fmt::join(others, ", "));
    return exit_environment;
  }
  if (flights.empty()) {
    fmt::print(stderr, "hirosco safe: nothing flies here\n");
    return exit_environment;
  }
  int code = exit_ok;
  for (const Flying& flight : flights) {
    const Stop outcome = answer_of(flight, asked + flight.limit);
    if (outcome == Stop::NotAll) code = std::max(code, exit_finding);
    if (outcome != Stop::Nobody) continue;
    auto keeper = keeper_of(flight);
    const bool signalled = keeper && keeper->send_signal(SIGUSR1);
    fmt::print(stderr, "hirosco safe: {} does not answer; {}\n", flight.name,
               signalled ? "its keeper was signalled to stop it" : "its keeper is gone, too");
    code = exit_environment;
  }
  return code;
}

}  // namespace hirosco::tools
