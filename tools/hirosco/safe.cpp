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
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/flight_lock.hpp"
#include "tools/hirosco/hear_safe.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/our_process.hpp"

namespace hirosco::tools {
namespace {

/// Of a flight whose lock does not say what its devices may take.
constexpr std::chrono::milliseconds usual_limit{2000};

using Stop = supervisor::SafeAnswer::Stop;

/// One flight of this user. No descriptor is read for it: what stops a flight does not depend on a file that somebody edits.
struct Flying {
  std::filesystem::path folder;
  std::string name;  ///< of the instance
  std::string mission;  ///< as its lock or the registry says
  FileDescriptor socket;  ///< connected to its guard and asked; empty: nobody takes it
  bool listens{false};  ///< somebody is there for its guard's socket, though it may take nobody
  int keeper{0};
  std::chrono::milliseconds limit{usual_limit};
  std::string lock_unread{};  ///< why its lock tells nothing: the registry's keeper and the usual limit hold
};

/// Asks the guard of a flight.
void ask_guard(Flying& flight) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (flight.folder / "safe.socket").string();
  if (path.size() >= sizeof address.sun_path) return;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  FileDescriptor socket{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket) return;
  const int refused =
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
  // So many wait already that the system lets nobody else wait: that is no flight that is not there.
  flight.listens = refused == 0 || refused == EAGAIN;
  if (refused != 0) return;
  constexpr std::string_view request = supervisor::safe_request;
  if (::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size()))
    flight.socket = std::move(socket);
  else flight.listens = false;
}

/// Prints what the guard answers, one line for each device or member.
[[nodiscard]] HeardSafe answer_of(const Flying& flight, std::chrono::steady_clock::time_point limit) {
  if (!flight.socket) return {};
  return hear_safe(flight.socket.get(), limit,
                   [&](std::string_view words) { fmt::print("{}: {}\n", flight.name, words); });
}

/// Who may be missing in an answer is stopped once more, by whoever goes on; in words how. A guard that stands still and whose keeper is gone has
/// nobody who would end it or go on for it: without its supervisor devices hear of no enable any more, and cycles of nobody.
[[nodiscard]] std::string_view stop_otherwise(const Flying& flight, bool stands_still) {
  if (flight.keeper <= 0) return "its keeper is not known";
  if (auto keeper = our_process(flight.keeper))
    return keeper->send_signal(SIGUSR1) ? "its keeper was signalled to stop it"
                                        : "its keeper takes no signal from here";
  if (!flight.socket && flight.listens)
    return "its keeper is gone, and its supervisor lets nobody in: end that by kill -KILL";
  auto supervisor = stands_still ? our_listener(flight.socket.get()) : std::nullopt;
  if (!supervisor) return "its keeper is gone, too";
  return supervisor->send_signal(SIGKILL)
             ? "its keeper is gone, and its supervisor was ended: whatever moves stops by itself"
             : "its keeper is gone, and its supervisor takes no signal from here";
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
    std::string line;
    std::ifstream file{flight.folder / "lock"};
    std::getline(file, line);
    if (auto lock = lock_from_text(line)) {
      flight.keeper = lock->keeper;
      flight.limit = lock->limit;
      flight.mission = std::move(lock->mission);
    } else if (!line.empty()) {
      flight.lock_unread = std::move(lock.error());
    }
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
    if (meant) ask_guard(flight);
    if (!flight.listens && !our_process(flight.keeper)) continue;
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
    if (!flight.lock_unread.empty())
      fmt::print(stderr, "hirosco safe: {}: {} cannot be gone by: {}\n", flight.name, (flight.folder / "lock").string(),
                 flight.lock_unread);
    // Where its keeper is gone all rests on its guard, which may be late on a busy computer.
    const auto limit = asked + flight.limit + (our_process(flight.keeper) ? std::chrono::milliseconds{} : usual_limit);
    const HeardSafe heard = answer_of(flight, limit);
    if (heard.stop == Stop::NotAll) code = std::max(code, exit_finding);
    const bool whole = heard.stop != Stop::Nobody && heard.why_not_whole.empty();
    if (whole) continue;
    // A connection that has ended is no guard that stands still.
    const bool stands_still = heard.stop == Stop::Nobody && std::chrono::steady_clock::now() >= limit;
    const std::string_view whom = stop_otherwise(flight, stands_still);
    if (heard.stop == Stop::Nobody) {
      fmt::print(stderr, "hirosco safe: {} does not answer; {}\n", flight.name, whom);
      code = exit_environment;
    } else {
      fmt::print(stderr, "hirosco safe: somebody of {} may not have stopped: its answer is not whole: {}; {}\n",
                 flight.name, heard.why_not_whole, whom);
    }
  }
  return code;
}

}  // namespace hirosco::tools
