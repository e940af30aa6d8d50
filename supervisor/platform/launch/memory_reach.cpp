// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/memory_reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::string folder_and_why(const std::string& folder, const Error& why) {
  const bool of_system = why.code == ErrorCode::SystemFailure && why.value > 0;
  return of_system ? fmt::format("{}: {} ({})", folder, why.text, std::strerror(static_cast<int>(why.value)))
                   : fmt::format("{}: {}", folder, why.text);
}

}  // namespace

std::set<std::string> MemoryReach::folders_of(const descriptor::MissionSubsystem& subsystem) const {
  std::set<std::string> folders;
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem))
    if (std::string folder = memory_folder_of(flow, instance_); !folder.empty()) folders.insert(std::move(folder));
  return folders;
}

bool MemoryReach::is_anothers(std::uint32_t process, const std::string& folder) const {
  return std::ranges::any_of(
      processes_, [&](const auto& each) { return each.first != process && each.second.folders.contains(folder); });
}

SpareFolders MemoryReach::make_spares(const descriptor::MissionSubsystem& subsystem, Sandbox& sandbox) const {
  std::set<std::pair<Transfer, std::string>> addresses;
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem))
    addresses.emplace(flow.transfer, flow.address);
  SpareFolders spares = SpareFolders::make(addresses.size());
  for (const std::string& place : spares.for_sandbox()) let_write(place, sandbox);
  return spares;
}

void MemoryReach::began(std::uint32_t process, int pid, const descriptor::MissionSubsystem& subsystem,
                        SpareFolders spares, bool in_sandbox) {
  spares.belong_to(pid);
  processes_.insert_or_assign(process, OfProcess{in_sandbox, folders_of(subsystem), std::move(spares)});
}

void MemoryReach::goes_on(std::uint32_t process, int pid, const descriptor::MissionSubsystem& subsystem) {
  processes_.insert_or_assign(process, OfProcess{!sandbox_is_off(), folders_of(subsystem), SpareFolders::of(pid)});
}

void MemoryReach::ended(std::uint32_t process) {
  if (auto gone = processes_.extract(process)) gone.mapped().spares.remove();
}

void MemoryReach::add_possible(std::uint32_t process, const descriptor::MissionSubsystem& fresh, Sandbox& had) const {
  const auto found = processes_.find(process);
  if (found == processes_.end()) return;
  const auto& [in_sandbox, folders, spares] = found->second;
  std::size_t left = spares.places().size();
  for (const std::string& folder : folders_of(fresh)) {
    if (folders.contains(folder)) continue;
    if (in_sandbox && left-- == 0) return;
    let_write(folder, had);
  }
}

std::string MemoryReach::let_in(std::uint32_t process, const descriptor::MissionSubsystem& fresh,
                                const std::optional<OwnGroup>& own) {
  const auto found = processes_.find(process);
  if (found == processes_.end()) return {};
  auto& [in_sandbox, folders, spares] = found->second;
  for (const FlowAddress& flow : descriptor::flows_of(fresh.subsystem)) {
    const std::string folder = memory_folder_of(flow, instance_);
    if (folder.empty() || folders.contains(folder)) continue;
    if (is_anothers(process, folder)) return folder + ": another subsystem was let in there";
    const auto made = own ? make_own_place(flow, instance_, *own, PlaceTime::AtStart) : make_place(flow, instance_);
    if (!made) return folder_and_why(folder, made.error());
    if (in_sandbox)
      if (const auto given = spares.give(folder); !given) return folder_and_why(folder, given.error());
    folders.insert(folder);
  }
  return {};
}

std::string MemoryReach::keep_in(std::uint32_t process, const descriptor::MissionSubsystem& now) {
  const auto found = processes_.find(process);
  if (found == processes_.end()) return {};
  auto& [in_sandbox, folders, spares] = found->second;
  std::string kept;
  const auto named = folders_of(now);
  for (const std::string& folder : std::set{folders}) {
    if (named.contains(folder)) continue;
    folders.erase(folder);
    if (!in_sandbox) continue;
    if (const auto taken = spares.take_back(folder); !taken && kept.empty())
      kept = folder_and_why(folder, taken.error());
  }
  return kept;
}

}  // namespace hirosco::supervisor
