// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/core_books.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/cores.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::uint32_t asked_of_its_core(const descriptor::MissionSubsystem& subsystem) {
  if (subsystem.cores.alone) return CoreBooks::all_of_a_core;
  const double loops = 100 * descriptor::cycle_share(subsystem.subsystem, nullptr);
  return std::clamp<std::uint32_t>(static_cast<std::uint32_t>(loops), 1, CoreBooks::all_of_a_core);
}

}  // namespace

CoreBooks::CoreBooks(const descriptor::Mission& mission, ProcessLauncher& launcher)
    : launcher_{launcher}, named_{descriptor::names_cores(mission)} {
  if (named_) of_flight_ = ProcessorSet::of_this_thread();
}

/// Anew each time: a processor may be taken off, and come back.
Book& CoreBooks::asked(std::uint16_t core) {
  Book& book = books_[core];
  book.set_budget(launcher_.grants_core(core) ? all_of_a_core : 0);
  return book;
}

std::optional<CoreBooks::CoreShortage> CoreBooks::claim(const descriptor::MissionSubsystem& subsystem) {
  const std::uint16_t apid = subsystem.subsystem.id;
  const auto& [cycle, alone, services] = subsystem.cores;
  for (const std::uint16_t core : services)
    if (const Book& book = asked(core); book.budget() == 0)
      return CoreShortage{core, {.budget = 0, .reserved = book.reserved(), .requested = 1}};
  if (!cycle) return std::nullopt;
  Book& book = asked(*cycle);
  const std::uint32_t amount = asked_of_its_core(subsystem);
  if (const auto shortage = book.shortage(apid, amount)) return CoreShortage{*cycle, *shortage};
  book.hold(apid, amount);
  return std::nullopt;
}

void CoreBooks::release(std::uint16_t apid) {
  for (auto& [core, book] : books_) book.hold(apid, 0);
}

std::optional<StrayThread> CoreBooks::stray(const descriptor::MissionSubsystem& subsystem,
                                            std::uint32_t process) const noexcept {
  if (!named_) return std::nullopt;
  const auto& [cycle, alone, services] = subsystem.cores;
  ThreadPlaces places{.all = services.empty() ? of_flight_ : ProcessorSet::of(services), .cycle = std::nullopt};
  if (cycle) {
    places.all.add(*cycle);
    places.cycle = *cycle;
  }
  return launcher_.stray(process, places);
}

}  // namespace hirosco::supervisor
