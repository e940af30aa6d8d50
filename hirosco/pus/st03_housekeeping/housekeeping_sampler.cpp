// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {

HousekeepingSampler::HousekeepingSampler() {
  for (auto& slot : slots_) {
    slot.periodic.buffer = std::make_unique<std::byte[]>(max_housekeeping_octets);
    slot.one_shot.buffer = std::make_unique<std::byte[]>(max_housekeeping_octets);
  }
}
HousekeepingSampler::~HousekeepingSampler() = default;

int HousekeepingSampler::find_free_slot() const noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].free.load(std::memory_order_acquire)) return static_cast<int>(i);
  return -1;
}

bool HousekeepingSampler::send(Command::Kind kind, std::size_t slot, std::uint32_t interval) noexcept {
  return commands_.try_push({kind, static_cast<std::uint8_t>(slot), interval});
}

void HousekeepingSampler::install(std::size_t slot, const HousekeepingLayout& layout) noexcept {
  slots_[slot].layout = layout;
  slots_[slot].free.store(false, std::memory_order_relaxed);
  send(Command::Kind::Install, slot, slots_[slot].layout.interval);
}

void HousekeepingSampler::Collection::start(std::uint32_t cycles) noexcept {
  active = true;
  phase = 0;
  interval = cycles;
}

void HousekeepingSampler::apply_commands() noexcept {
  // Bounded: no more than what one full queue holds, whatever the service adds meanwhile.
  Command command;
  for (std::size_t i = 0; i < max_commands && commands_.try_pop(command); ++i) apply(command);
}

void HousekeepingSampler::apply(const Command& command) noexcept {
  Slot& slot = slots_[command.slot];
  switch (command.kind) {
    case Command::Kind::Install:
      slot.installed = true;
      slot.interval = command.interval;
      slot.one_shots = 0;
      slot.periodic.active = slot.one_shot.active = false;
      break;
    case Command::Kind::Remove:
      slot.installed = false;
      slot.free.store(true, std::memory_order_release);
      break;
    case Command::Kind::Enable:
      if (!slot.periodic.active) slot.periodic.start(slot.interval);
      break;
    case Command::Kind::Disable: slot.periodic.active = false; break;
    case Command::Kind::OneShot:
      if (slot.one_shots != UINT16_MAX) ++slot.one_shots;
      break;
    case Command::Kind::SetInterval:  // a running interval is finished first
      slot.interval = command.interval;
      break;
  }
}

void HousekeepingSampler::tick(SampleSource& source, SampleSink& sink) noexcept {
  apply_commands();
  for (auto& slot : slots_) {
    if (!slot.installed) continue;
    if (slot.periodic.active && advance(slot, slot.periodic, source, sink)) slot.periodic.start(slot.interval);
    if (!slot.one_shot.active && slot.one_shots != 0) {
      --slot.one_shots;
      slot.one_shot.start(slot.layout.sets().empty() ? 1 : slot.interval);
    }
    if (slot.one_shot.active && advance(slot, slot.one_shot, source, sink)) slot.one_shot.active = false;
  }
}

/// True when the interval is over and the report is out.
bool HousekeepingSampler::advance(Slot& slot, Collection& collection, SampleSource& source, SampleSink& sink) noexcept {
  ++collection.phase;
  sample_sets(slot, collection, source);
  if (collection.phase < collection.interval) return false;
  const MutableOctets buffer{collection.buffer.get(), max_housekeeping_octets};
  OctetWriter{buffer}.put(slot.layout.id);
  sample_values(slot.layout, slot.layout.once(), buffer.subspan(HousekeepingLayout::structure_id_octets), source);
  deliver(slot, collection, sink);
  return true;
}

void HousekeepingSampler::sample_sets(Slot& slot, Collection& collection, SampleSource& source) noexcept {
  std::size_t set_at = HousekeepingLayout::structure_id_octets + slot.layout.once_octets();
  for (const auto& set : slot.layout.sets()) {
    const std::uint32_t spacing = collection.interval / set.repetitions;
    if (collection.phase % spacing == 0) {
      const std::size_t at = set_at + (collection.phase / spacing - 1) * std::size_t{set.octets};
      sample_values(slot.layout, slot.layout.values_of(set),
                    MutableOctets{collection.buffer.get(), max_housekeeping_octets}.subspan(at), source);
    }
    set_at += set.repetitions * std::size_t{set.octets};
  }
}

void HousekeepingSampler::sample_values(const HousekeepingLayout& layout, std::span<const std::uint32_t> places,
                                        MutableOctets to, SampleSource& source) noexcept {
  for (const std::uint32_t at : places) {
    const SampledValue& value = layout.value(at);
    const MutableOctets place = to.first(value.octets);
    if (source.sample(value.parameter, value.member, place) != value.octets) {
      std::ranges::fill(place, std::byte{});
      failed_samples_.fetch_add(1, std::memory_order_relaxed);
    }
    to = to.subspan(value.octets);
  }
}

void HousekeepingSampler::deliver(const Slot& slot, const Collection& collection, SampleSink& sink) noexcept {
  const std::size_t octets = slot.layout.report_octets();
  const MutableOctets room = sink.reserve(octets);
  if (room.size() < octets) {
    lost_reports_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  copy_octets({collection.buffer.get(), octets}, room);
  sink.commit(slot.layout.id, octets);
}

}  // namespace hirosco::pus
