// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {

namespace fs = std::filesystem;

namespace {

constexpr int port_step = 100;
constexpr int tried_steps = 50;
constexpr int highest_port = 65'535;
/// Another flight is in the registry for milliseconds only.
constexpr int tried_holds = 100;
constexpr std::chrono::milliseconds between_holds{20};

[[nodiscard]] struct flock whole_file() {
  struct flock range{};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  return range;
}

/// Of the open file, so that who inherits the descriptor has it, too, and who only looks does not take it.
[[nodiscard]] bool take(int file) {
  struct flock range = whole_file();
  return ::fcntl(file, F_OFD_SETLK, &range) == 0;
}
[[nodiscard]] bool is_taken(int file) {
  struct flock range = whole_file();
  return ::fcntl(file, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

/// The same address `steps` further; empty when there is none.
[[nodiscard]] std::string shifted(const std::string& text, int steps) {
  const auto colon = text.rfind(':');
  int port = 0;
  if (colon != std::string::npos) std::from_chars(text.data() + colon + 1, text.data() + text.size(), port);
  port += steps * port_step;
  return port > highest_port ? std::string{} : fmt::format("{}:{}", text.substr(0, colon), port);
}

[[nodiscard]] bool said_by(const std::vector<FlightEntry>& others, const std::string& address) {
  return std::ranges::any_of(
      others, [&](const FlightEntry& other) { return other.telemetry == address || other.telecommand == address; });
}

/// Empty when it can have the ports of its mission, or has got others of its own; else why not.
[[nodiscard]] std::string choose_ports(FlightEntry& entry, const std::vector<FlightEntry>& others) {
  if (entry.telemetry.empty()) return {};
  if (!entry.named()) {
    for (const std::string& address : {entry.telemetry, entry.telecommand}) {
      const auto free = can_listen(address);
      if (!free) return fmt::format("{}: {} (--instance NAME takes free ports)", address, free.error().text);
      if (said_by(others, address))
        return fmt::format("{}: another flight has it (--instance NAME takes free ports)", address);
    }
    return {};
  }
  const FlightEntry planned = entry;
  for (int step = 1; step <= tried_steps; ++step) {
    entry.telemetry = shifted(planned.telemetry, step);
    entry.telecommand = shifted(planned.telecommand, step);
    if (entry.telemetry.empty() || entry.telecommand.empty()) break;
    if (said_by(others, entry.telemetry) || said_by(others, entry.telecommand)) continue;
    if (can_listen(entry.telemetry) && can_listen(entry.telecommand)) return {};
  }
  return fmt::format("no ports are free above {} and {}", planned.telemetry, planned.telecommand);
}

[[nodiscard]] std::vector<OtherCores> cores_of(const std::vector<FlightEntry>& others) {
  std::vector<OtherCores> cores;
  for (const FlightEntry& other : others) cores.push_back({other.instance, other.core_uses});
  return cores;
}

/// "3 0.25", behind it "alone" where it is nobody else's; "shared 0.5" where it is not known which it is.
[[nodiscard]] std::string text_of(const CoreUse& use) {
  return fmt::format("{} {}{}", use.core ? std::to_string(*use.core) : "shared", use.load, use.alone ? " alone" : "");
}

[[nodiscard]] CoreUse core_use_in(const std::string& text) {
  std::istringstream words{text};
  std::string core, alone;
  CoreUse use;
  words >> core >> use.load >> alone;
  std::uint16_t number = 0;
  if (std::from_chars(core.data(), core.data() + core.size(), number).ec == std::errc{}) use.core = number;
  use.alone = alone == "alone";
  return use;
}

}  // namespace

std::string entry_text(const FlightEntry& entry) {
  std::string text =
      fmt::format("instance={}\nmission={}\nfile={}\nfolder={}\nlog={}\ntelemetry={}\ntelecommand={}\nkeeper={}\n",
                  entry.instance, entry.mission, entry.file.string(), entry.folder.string(), entry.log.string(),
                  entry.telemetry, entry.telecommand, entry.keeper);
  for (const CoreUse& use : entry.core_uses) text += fmt::format("core={}\n", text_of(use));
  for (const std::string& address : entry.udp) text += fmt::format("udp={}\n", address);
  return text;
}

std::optional<FlightEntry> entry_from_text(const std::string& text) {
  FlightEntry entry;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) return std::nullopt;
    const std::string name = line.substr(0, equals);
    const std::string value = line.substr(equals + 1);
    if (name == "instance") entry.instance = value;
    else if (name == "mission") entry.mission = value;
    else if (name == "file") entry.file = value;
    else if (name == "folder") entry.folder = value;
    else if (name == "log") entry.log = value;
    else if (name == "telemetry") entry.telemetry = value;
    else if (name == "telecommand") entry.telecommand = value;
    else if (name == "udp") entry.udp.push_back(value);
    else if (name == "keeper") std::from_chars(value.data(), value.data() + value.size(), entry.keeper);
    else if (name == "core") entry.core_uses.push_back(core_use_in(value));
  }
  if (!good_instance(entry.instance) || entry.mission.empty() || entry.folder.empty()) return std::nullopt;
  return entry;
}

Result<FileDescriptor> take_lock(const fs::path& path) {
  FileDescriptor lock{::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)};
  if (!lock) return fail(ErrorCode::SystemFailure, "the lock cannot be made", errno);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) == 0) return lock;
  return errno == EWOULDBLOCK ? fail(ErrorCode::Unavailable, "somebody has the lock")
                              : fail(ErrorCode::SystemFailure, "the lock cannot be taken", errno);
}

fs::path FlightRegistry::default_folder() { return fs::path{P_tmpdir} / fmt::format("hirosco-flights-{}", ::getuid()); }

/// Ours alone, or nobody's: another user may have made a folder of this name.
std::expected<FileDescriptor, std::string> FlightRegistry::hold() const {
  ::mkdir(folder_.c_str(), 0700);
  struct stat found{};
  if (::lstat(folder_.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) || found.st_uid != ::getuid())
    return std::unexpected{
        fmt::format("{}, where the flights of this computer stand, is no folder of yours", folder_.string())};
  Result<FileDescriptor> lock = take_lock(folder_ / ".lock");
  for (int i = 0; i < tried_holds && !lock && lock.error().code == ErrorCode::Unavailable; ++i) {
    std::this_thread::sleep_for(between_holds);
    lock = take_lock(folder_ / ".lock");
  }
  if (lock) return std::move(*lock);
  return std::unexpected{fmt::format("{}: {}", folder_.string(), lock.error().text)};
}

std::vector<FlightEntry> FlightRegistry::flights() const {
  std::vector<FlightEntry> found;
  struct stat facts{};
  if (::lstat(folder_.c_str(), &facts) != 0 || !S_ISDIR(facts.st_mode) || facts.st_uid != ::getuid()) return found;
  std::error_code failed;
  for (fs::directory_iterator files{folder_, failed}, none; !failed && files != none; files.increment(failed)) {
    const std::string name = files->path().filename().string();
    if (!good_instance(name)) continue;
    const FileDescriptor file{::open(files->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
    if (!file || !is_taken(file.get())) continue;  // that flight is over
    std::ostringstream text;
    text << std::ifstream{files->path()}.rdbuf();
    auto entry = entry_from_text(text.str());
    if (entry && entry->instance == name) found.push_back(std::move(*entry));
  }
  std::ranges::sort(found, {}, &FlightEntry::instance);
  return found;
}

std::expected<Admission, std::string> FlightRegistry::enter(FlightEntry entry) const {
  const auto held = hold();  // two that start at once see each other
  if (!held) return std::unexpected{held.error()};
  FileDescriptor lock{
      ::open((folder_ / entry.instance).c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600)};
  if (!lock) return std::unexpected{fmt::format("{} cannot be written", (folder_ / entry.instance).string())};
  if (is_taken(lock.get())) return std::unexpected{fmt::format("{} flies already", entry.instance)};
  const auto others = flights();
  const auto their_cores = cores_of(others);
  keep_off(entry.cores, their_cores);
  entry.core_uses = entry.cores.uses();
  if (auto reason = judge_cores(entry.core_uses, their_cores); !reason.empty())
    return std::unexpected{std::move(reason)};
  for (const FlightEntry& other : others)
    for (const std::string& address : entry.udp)
      if (std::ranges::find(other.udp, address) != other.udp.end())
        return std::unexpected{fmt::format("{} has the devices at {} already", other.instance, address)};
  if (auto reason = choose_ports(entry, others); !reason.empty()) return std::unexpected{std::move(reason)};
  const std::string text = entry_text(entry);
  if (entry_from_text(text).value_or(FlightEntry{}).log != entry.log)
    return std::unexpected{std::string{"a path of this flight has characters that no file of flights can hold"}};
  if (::ftruncate(lock.get(), 0) != 0 ||
      ::pwrite(lock.get(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || !take(lock.get()))
    return std::unexpected{fmt::format("{} cannot be written", (folder_ / entry.instance).string())};
  return Admission{std::move(entry), std::move(lock)};
}

}  // namespace hirosco::tools
