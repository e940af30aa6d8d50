// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/own_users.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/utilities/os/own_user.hpp"
#include "supervisor/platform/launch/interpreter.hpp"
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;

constexpr unsigned to_read = 4, to_write = 2, to_execute = 1;

[[nodiscard]] std::string refused_place(const FlowAddress& flow, const std::string& instance,
                                        const descriptor::MissionSubsystem& subsystem, std::uint32_t user,
                                        const Error& why) {
  const std::string detail = why.code == ErrorCode::SystemFailure && why.value > 0
                                 ? fmt::format(" ({})", std::strerror(static_cast<int>(why.value)))
                             : why.value > 0 ? fmt::format(" ({})", why.value)
                                             : std::string{};
  const std::string folder = own_folder(flow, instance);
  if (folder.empty())
    return fmt::format("{} cannot be for {}'s device alone, who is user {}: {}{}", flow.address,
                       subsystem.subsystem.name, user, why.text, detail);
  return fmt::format(
      "{} cannot be the folder of {}'s device, who is user {}: {}{}; end who uses it, remove it, and it is made",
      folder, subsystem.subsystem.name, user, why.text, detail);
}

[[nodiscard]] bool permits(const struct stat& found, std::uint32_t user, unsigned wanted) noexcept {
  const unsigned shift = found.st_uid == user ? 6 : found.st_gid == user ? 3 : 0;
  return (found.st_mode >> shift & wanted) == wanted;
}

/// Where it is stopped on the way to a place. From the working directory on, which it is in already: what is above that does not matter.
[[nodiscard]] fs::path closed_on_the_way(std::uint32_t user, const fs::path& place, const fs::path& here) {
  if (here.empty() || std::ranges::mismatch(here, place).in1 != here.end()) return closed_to(user, place, to_execute);
  for (fs::path way = place;; way = way.parent_path()) {
    struct stat found{};
    if (::stat(way.c_str(), &found) == 0 && !permits(found, user, to_execute)) return way;
    if (way == here) return {};
  }
}

struct Wish {
  const char* verb;
  fs::path place;
  unsigned of_file;
  unsigned of_folder;
};

}  // namespace

std::string why_one_user(const descriptor::Mission& mission, bool granted) {
  if (!mission.users) return {};
  std::vector<std::string> lacking = lacking_for_own_users(mission.users->first, mission.users->last);
  if (lacking.empty() && granted) return {};
  if (lacking.empty()) lacking.emplace_back("the same rights of the process that started the flight");
  return fmt::format("all are of one user: for users of their own the flight lacks {}", fmt::join(lacking, ", "));
}

std::expected<void, std::string> make_own_places(const descriptor::MissionSubsystem& subsystem, const OwnGroup& own,
                                                 const std::string& instance, PlaceTime time) {
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem))
    if (const auto made = make_own_place(flow, instance, own, time); !made)
      return std::unexpected{refused_place(flow, instance, subsystem, own.group, made.error())};
  return {};
}

fs::path closed_to(std::uint32_t user, const fs::path& place, unsigned wanted) {
  std::error_code failed;
  const fs::path there = fs::canonical(place, failed);
  if (failed) return {};
  fs::path way;
  for (const fs::path& part : there) {
    way /= part;
    struct stat found{};
    if (::stat(way.c_str(), &found) == 0 && !permits(found, user, way == there ? wanted : to_execute)) return way;
  }
  return {};
}

std::string what_is_closed(const descriptor::MissionSubsystem& subsystem, std::uint32_t user, const fs::path& program,
                           const std::string& instance) {
  const Sandbox sandbox = sandbox_of(subsystem, program, instance, ProcessUser::ItsOwn);
  std::vector<std::string> own;
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem))
    if (std::string folder = own_folder(flow, instance); !folder.empty()) own.push_back(std::move(folder));
  std::vector<Wish> wishes;
  for (const auto& place : sandbox.executable) wishes.push_back({"execute", place, to_execute, to_read | to_execute});
  for (const auto& place : sandbox.readable) wishes.push_back({"read", place, to_read, to_read | to_execute});
  // Modules that it may have beside these it may do without.
  if (const auto interpreter = interpreter_of(program)) {
    for (const auto& place : interpreter->executable)
      wishes.push_back({"execute", place, to_execute, to_read | to_execute});
    for (const auto& place : interpreter->listable) wishes.push_back({"list", place, to_read, to_read | to_execute});
  }
  // Folders of its own are made for it, or refused.
  std::error_code failed;
  for (const auto& place : sandbox.writable)
    if (std::ranges::find(own, place) == own.end() && !fs::is_directory(place, failed))
      wishes.push_back({"write", place, to_read | to_write, 0});
  for (const Wish& wish : wishes) {
    const unsigned wanted = fs::is_directory(wish.place, failed) ? wish.of_folder : wish.of_file;
    const fs::path closed = closed_to(user, wish.place, wanted);
    if (!closed.empty())
      return fmt::format("may not {} {}: {} is closed to it", wish.verb, wish.place.string(), closed.string());
  }
  for (const fs::path folder : own)
    if (const fs::path closed = closed_on_the_way(user, folder.parent_path(), fs::current_path(failed));
        !closed.empty())
      return fmt::format("may not come to {}: {} is closed to it", folder.string(), closed.string());
  return {};
}

}  // namespace hirosco::supervisor
