// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/spare_folders.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "hirosco/data_transfer/device/exchanged_folder.hpp"
#include "hirosco/utilities/os/process.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;

/// In the file system that the folders of addresses are in, as they become those.
constexpr const char* memory_root = "/dev/shm";
constexpr std::string_view spare_prefix = "hirosco-spare.";
constexpr unsigned most_spares = 1000;

[[nodiscard]] std::string spare_name(int pid, unsigned number) {
  return fmt::format("{}/{}{}.{}", memory_root, spare_prefix, pid, number);
}

/// Of the process that has a folder of this name.
[[nodiscard]] std::optional<int> pid_in(const std::string& name) {
  if (!name.starts_with(spare_prefix)) return std::nullopt;
  int pid = 0;
  const char* const begin = name.data() + spare_prefix.size();
  const auto end = std::from_chars(begin, name.data() + name.size(), pid);
  return end.ec == std::errc{} && end.ptr != begin && *end.ptr == '.' ? std::optional{pid} : std::nullopt;
}

[[nodiscard]] bool is_own_folder(const std::string& folder) noexcept {
  struct stat found{};
  return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid();
}

/// Whether it is there to be collected or not.
[[nodiscard]] bool has_ended(int pid) noexcept {
  const auto process = Process::adopt(pid);
  if (!process) return process.error().value == ESRCH;
  pollfd end{process->handle().get(), POLLIN, 0};
  return ::poll(&end, 1, 0) > 0;
}

/// What the process has left in it stays, and it with that.
void clear_spare(const std::string& folder) noexcept {
  static_cast<void>(::unlink((folder + "/frames").c_str()));
  static_cast<void>(::rmdir(folder.c_str()));
}

[[nodiscard]] std::vector<std::string> names_in_memory_root() {
  std::vector<std::string> names;
  std::error_code failed;
  fs::directory_iterator each{memory_root, failed};
  for (; !failed && each != fs::directory_iterator{}; each.increment(failed))
    names.push_back(each->path().filename().string());
  return names;
}

}  // namespace

SpareFolders::SpareFolders(SpareFolders&& other) noexcept
    : pid_{other.pid_},
      belong_{other.belong_},
      places_{std::exchange(other.places_, {})},
      opened_{std::move(other.opened_)} {}

SpareFolders& SpareFolders::operator=(SpareFolders&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(belong_, other.belong_);
  std::swap(places_, other.places_);
  std::swap(opened_, other.opened_);
  return *this;
}

SpareFolders::~SpareFolders() {
  if (!belong_) remove();
}

SpareFolders SpareFolders::make(std::size_t wanted) {
  SpareFolders made;
  made.pid_ = ::getpid();
  for (unsigned number = 0; made.places_.size() < wanted && number < most_spares; ++number) {
    // Not as those of a process are called: this one may be that.
    std::string place = fmt::format("{}/{}{}.new{}", memory_root, spare_prefix, made.pid_, number);
    if (::mkdir(place.c_str(), S_IRWXU) != 0 && errno == EEXIST) continue;
    FileDescriptor opened{::open(place.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
    if (!opened) {
      clear_spare(place);
      break;
    }
    made.places_.push_back(std::move(place));
    made.opened_.push_back(std::move(opened));
  }
  return made;
}

std::vector<std::string> SpareFolders::for_sandbox() const {
  std::vector<std::string> paths;
  for (const FileDescriptor& each : opened_) paths.push_back(fmt::format("/proc/self/fd/{}", each.get()));
  return paths;
}

SpareFolders SpareFolders::of(int pid) {
  SpareFolders found;
  found.pid_ = pid;
  found.belong_ = true;
  for (const std::string& name : names_in_memory_root())
    if (std::string place = fmt::format("{}/{}", memory_root, name); pid_in(name) == pid && is_own_folder(place))
      found.places_.push_back(std::move(place));
  return found;
}

void SpareFolders::sweep() {
  for (const std::string& name : names_in_memory_root()) {
    const auto pid = pid_in(name);
    const std::string place = fmt::format("{}/{}", memory_root, name);
    if (pid && is_own_folder(place) && has_ended(*pid)) clear_spare(place);
  }
}

void SpareFolders::belong_to(int pid) {
  pid_ = pid;
  belong_ = true;
  opened_.clear();
  std::vector<std::string> before = std::exchange(places_, {});
  for (const std::string& place : before) {
    const std::string name = free_name();
    if (::renameat2(AT_FDCWD, place.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE) == 0) places_.push_back(name);
    else clear_spare(place);
  }
}

/// That nobody has. One of a process of before that had this number is no spare folder of this one.
std::string SpareFolders::free_name() const {
  for (unsigned number = 0; number < most_spares; ++number) {
    std::string name = spare_name(pid_, number);
    if (std::ranges::find(places_, name) != places_.end()) continue;
    clear_spare(name);
    struct stat found{};
    if (::lstat(name.c_str(), &found) != 0) return name;
  }
  return spare_name(pid_, most_spares);
}

Result<> SpareFolders::give(const std::string& place) {
  if (is_open_by_a_subsystem(place))
    return fail(ErrorCode::AlreadyExists, "another subsystem has the frames in it open");
  if (!holds_frames_at_most(place)) return fail(ErrorCode::Mismatch, "there is something else than frames in it");
  Error last{ErrorCode::NotFound, "none of the folders that its process was let in to is left"};
  for (auto spare = places_.begin(); spare != places_.end(); ++spare) {
    if (!holds_frames_at_most(*spare)) continue;
    const auto given = exchange_memory_folder(*spare, place);
    if (given) {
      clear_spare(*spare);
      places_.erase(spare);
      return ok();
    }
    last = given.error();
  }
  return fail(last);
}

Result<> SpareFolders::take_back(const std::string& place) {
  const std::string name = free_name();
  if (::mkdir(name.c_str(), S_IRWXU) != 0) return fail(ErrorCode::SystemFailure, "make a folder in its place", errno);
  const auto taken = exchange_memory_folder(name, place);
  if (!taken) clear_spare(name);
  if (!taken && taken.error().code == ErrorCode::NotFound) return ok();
  if (!taken) return fail(taken.error());
  static_cast<void>(::chmod(name.c_str(), S_IRWXU));
  places_.push_back(name);
  return ok();
}

void SpareFolders::remove() {
  for (const std::string& place : std::exchange(places_, {})) clear_spare(place);
}

}  // namespace hirosco::supervisor
