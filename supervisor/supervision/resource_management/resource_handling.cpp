// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/resource_handling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/sanitizer.hpp"

namespace hirosco::supervisor {

using descriptor::Resource;

namespace {

[[nodiscard]] std::string words(std::uint32_t amount, Resource resource) {
  return std::to_string(amount) + unit_of(resource);
}

}  // namespace

ResourceHandling::ResourceHandling(Craft& craft, OwnSubsystem& own)
    : craft_{craft}, own_{own}, cores_{craft.mission, craft.launcher} {
  for (std::size_t i = 0; i < books_.size(); ++i) books_[i].set_budget(craft.mission.budget[i]);
}

std::optional<std::string> ResourceHandling::claim(const Member& member) {
  const auto amount = [&most = member.descriptor().resources.most](std::size_t place) {
    return promised_of(most, static_cast<Resource>(place)).value_or(0);
  };
  for (std::size_t i = 0; i < books_.size(); ++i) {
    const auto resource = static_cast<Resource>(i);
    const auto shortage = books_[i].shortage(member.apid(), amount(i));
    if (shortage) return refuse(member, resource, *shortage);
  }
  if (const auto lacks = cores_.claim(member.described())) {
    const std::string reason = refuse(member, Resource::Cores, lacks->shortage);
    return lacks->shortage.budget == 0
               ? fmt::format("the mission gives it core {}, which is none of this computer that the flight may use",
                             lacks->core)
               : fmt::format("core {}: {}", lacks->core, reason);
  }
  for (std::size_t i = 0; i < books_.size(); ++i) books_[i].hold(member.apid(), amount(i));
  return std::nullopt;
}

std::string ResourceHandling::refuse(const Member& member, Resource resource, const Shortage& shortage) {
  own_.announce("RESOURCE_REFUSED", {static_cast<double>(member.apid()), static_cast<double>(resource),
                                     static_cast<double>(shortage.budget), static_cast<double>(shortage.reserved),
                                     static_cast<double>(shortage.requested)});
  return fmt::format("{} short: it asks for {}, {} of {} are reserved", to_text(resource),
                     words(shortage.requested, resource), words(shortage.reserved, resource),
                     words(shortage.budget, resource));
}

void ResourceHandling::release(std::uint16_t apid) {
  cores_.release(apid);
  for (Book& book : books_) book.hold(apid, 0);
  seen_.erase(apid);
}

void ResourceHandling::watch(TimePoint) {
  if (craft_.members.empty()) return;
  turn_ = (turn_ + 1) % craft_.members.size();
  const Member& member = craft_.members[turn_];
  if (!member.alive()) return;
  const auto usage = craft_.launcher.usage(member.process());
  if (!usage) return;
  Seen& seen = seen_[member.apid()];
  if (std::exchange(seen.process, member.process()) != member.process()) seen = {.process = member.process()};
  if (seen.ended) return;
  if (const auto excess = excess_of(member, seen, *usage)) {
    seen.ended = true;
    return end(member, *excess,
               fmt::format("has taken {} of {}, {} {} at most", words(excess->used, excess->resource),
                           to_text(excess->resource),
                           excess->resource == Resource::Processes ? "each subsystem is" : "its descriptor says",
                           words(excess->limit, excess->resource)));
  }
  watch_cores(member, seen);
}

/// Until it has come to Pre-Operational for the first time its threads may still be on their way.
void ResourceHandling::watch_cores(const Member& member, Seen& seen) {
  const auto state = member.state();
  seen.settled |= state && *state != descriptor::State::Offline && !is_transient(*state);
  if (!seen.settled) return;
  const auto stray = cores_.stray(member.described(), member.process());
  if (!stray) return;
  seen.ended = true;
  const auto own = member.described().cores.cycle;
  end(member, {Resource::Cores, stray->processor, own ? *own : 0U},
      fmt::format("has a thread {} that may go on core {}, which the mission does not give it", stray->name.data(),
                  stray->processor));
}

std::optional<ResourceHandling::Excess> ResourceHandling::excess_of(const Member& member, Seen& seen,
                                                                    const ProcessUsage& usage) {
  const descriptor::Amounts& most = member.descriptor().resources.most;
  const std::pair<Resource, std::uint32_t> taken[]{{Resource::Memory, usage.memory_kb},
                                                   {Resource::SharedMemory, usage.shared_memory_kb},
                                                   {Resource::Threads, usage.threads}};
  for (const auto& [resource, used] : taken) {
    if ((built_with_sanitizer || sandbox_is_off()) && resource == Resource::Memory) continue;
    if (const auto limit = amount_of(most, resource); limit && used > *limit) return Excess{resource, used, *limit};
  }
  const auto state = member.state();
  // Its sandbox lets it start none. Where there is none, what leads to it (a shim of its interpreter) may before it acts; where whoever
  // flies wants none, a debugger may be what began it.
  const bool settled = state && *state != descriptor::State::Offline && !is_transient(*state);
  const bool may_start = built_with_sanitizer || sandbox_is_unwanted();
  // A look may be of a moment before that: it is the next one that counts.
  if (usage.processes <= 1 || !settled || may_start) seen.others = 0;
  else if (seen.others == 0) seen.others = usage.look + 1;
  else if (usage.look >= seen.others) return Excess{Resource::Processes, usage.processes, 1};
  const auto limit = amount_of(most, Resource::Processor);
  const auto percent = seen.processor.look(usage.processor, craft_.now);
  if (!limit || !percent) return std::nullopt;
  // On its way up or down it reads files and meshes: how long that may last is the guard's.
  const bool on_its_way = state && is_transient(*state);
  seen.too_much = *percent > *limit && !on_its_way ? seen.too_much + 1 : 0;
  if (seen.too_much < windows_too_much) return std::nullopt;
  return Excess{Resource::Processor, *percent, *limit};
}

void ResourceHandling::end(const Member& member, const Excess& excess, const std::string& what) {
  craft_.tell(fmt::format("{} {}: it is ended", member.descriptor().name, what), member.apid());
  own_.announce("RESOURCE_EXCEEDED", {static_cast<double>(member.apid()), static_cast<double>(excess.resource),
                                      static_cast<double>(excess.used), static_cast<double>(excess.limit)});
  // What it moves is stopped before it is gone: its end takes the way of every death.
  craft_.guard.fence(member.apid());
  craft_.launcher.kill(member.process());
}

}  // namespace hirosco::supervisor
