// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/power.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {

void PowerSwitches::add(Held held) {
  Switch& made = switches_.emplace_back();
  for (auto& flow : held.ways) made.ways.push_back({std::move(flow)});
  made.silence = held.silence;
  made.silence_reduced = held.silence_reduced;
}

void PowerSwitches::step(bool on, bool realtime, TimePoint now) noexcept {
  // Numbers of a guard that went before are behind: a switch with several ways takes none that is.
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count();
  if (!std::exchange(begun_, true))
    for (Switch& each : switches_) each.sequence = each.changed_at = static_cast<std::uint32_t>(ms);
  const bool changes = on != std::exchange(on_, on);
  if (changes) changed_at_ = now;
  for (Switch& each : switches_) {
    hear(each, now);
    each.limit = realtime ? each.silence : each.silence_reduced;
    each.too_old = each.limit > Duration{} && first_heard(each, TimePoint{}, now) == each.ways.size();
    if (changes) each.changed_at = each.sequence;
    tell(each, on);
  }
}

void PowerSwitches::hear(Switch& each, TimePoint now) noexcept {
  std::array<std::byte, max_frame_octets> frame;
  for (Way& way : each.ways) {
    const auto received = way.flow->receive(frame);
    if (!received || received->flow != Flow::New) continue;
    const auto status = read_power_status(Octets{frame}.first(received->octets));
    each.other_version = !status && status.error().code == ErrorCode::Mismatch;
    if (!status) continue;
    way.heard_at = now;
    const bool newer = static_cast<std::int32_t>(status->sequence - each.last.sequence) >= 0;
    if (each.heard && each.ways.size() > 1 && !newer) continue;
    each.last = *status;
    each.heard = true;
  }
}

void PowerSwitches::tell(Switch& each, bool on) noexcept {
  std::array<std::byte, power_frame_octets> frame;
  const auto written = write_power_command(frame, {.on = on, .sequence = ++each.sequence});
  if (!written) return;
  // A switch that does not hear it is off by itself after a while: that is what it waits for.
  for (const Way& way : each.ways) static_cast<void>(way.flow->send(*written));
}

std::size_t PowerSwitches::first_heard(const Switch& each, TimePoint since, TimePoint now) noexcept {
  const auto young = [&](const Way& way) { return now - std::max(since, way.heard_at) < each.limit; };
  return static_cast<std::size_t>(std::ranges::find_if(each.ways, young) - each.ways.begin());
}

std::optional<PowerSwitches::Silence> PowerSwitches::find_silence(TimePoint now) noexcept {
  for (std::uint16_t place = 0; Switch & each : switches_) {
    const std::uint16_t own_place = place++;
    if (each.limit <= Duration{}) continue;
    const std::size_t heard = first_heard(each, changed_at_, now);
    const bool silent = heard == each.ways.size();
    if (silent && !std::exchange(each.told_silent, true)) return Silence{own_place, false};
    if (silent) continue;
    each.told_silent = false;
    if (const std::size_t before = std::exchange(each.way, heard); heard > before) return Silence{own_place, true};
  }
  return std::nullopt;
}

Power PowerSwitches::said() const noexcept {
  const auto said = [&](const Switch& each) {
    return !each.too_old && each.last.on == on_ && static_cast<std::int32_t>(each.last.sequence - each.changed_at) > 0;
  };
  if (std::ranges::any_of(switches_, &Switch::other_version)) return power_unknown_version;
  if (!std::ranges::all_of(switches_, said)) return power_changes;
  return on_ ? power_on : power_off;
}

}  // namespace hirosco::supervisor
