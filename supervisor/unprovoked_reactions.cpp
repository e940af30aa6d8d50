// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/unprovoked_reactions.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// As much of one as is noted; those of descriptors are shorter.
constexpr std::size_t longest_name = 255;

[[nodiscard]] bool makes_well(std::string_view line) { return line == "heal" || line == "plug"; }

/// "ARM_LOST" is told of the device ARM: an event has '_' where the name of a device has what an event may not.
[[nodiscard]] bool is_loss_of(const ToldReaction& reaction, const descriptor::SimulatedDevice& device) {
  constexpr std::string_view ending = "_LOST";
  const std::string_view event = reaction.event;
  return reaction.subsystem == device.subsystem && event.ends_with(ending) &&
         std::ranges::equal(event.substr(0, event.size() - ending.size()), device.device, [](char told, char named) {
           return told == named || (told == '_' && (named == '.' || named == '-'));
         });
}

/// Something that keeps a device from its subsystem is in force there at this time, or was up to `limit` before.
[[nodiscard]] bool is_cut_off(const std::string& device, TimePoint at, const std::vector<DeviceInjection>& injections) {
  constexpr Duration limit = UnprovokedReactions::limit;
  TimePoint unplugged{}, silenced{};  // until then; the first of all times: it is not
  for (const DeviceInjection& each : injections) {
    if (each.device != device || each.at > at) continue;
    const std::string_view line = each.line;
    const auto word = line.substr(0, line.find(' '));
    const double ms = word.size() < line.size() ? std::atof(each.line.c_str() + word.size()) : 0.0;
    const TimePoint after = each.at + std::chrono::duration_cast<Duration>(
                                          std::chrono::duration<double, std::milli>(std::clamp(ms, 0.0, 3.6e6)));
    if (word == "unplug") unplugged = TimePoint::max();
    if (word == "plug") unplugged = std::min(unplugged, each.at + limit);
    if (word == "silent" || (word == "delay" && ms > 0)) silenced = TimePoint::max();
    if (word == "heal" || (word == "delay" && ms <= 0)) silenced = std::min(silenced, each.at + limit);
    if (word == "stall" || word == "freeze") silenced = std::max(silenced, after + limit);
  }
  return at <= unplugged || at <= silenced;
}

}  // namespace

std::vector<ToldReaction> unprovoked(std::vector<ToldReaction> reactions,
                                     const std::vector<DeviceInjection>& injections,
                                     const descriptor::Mission& mission) {
  std::erase_if(reactions, [&](const ToldReaction& reaction) {
    const bool death = reaction.event == "PROCESS_DIED" || reaction.event == "HANG";
    const bool just_before = std::ranges::any_of(injections, [&](const DeviceInjection& each) {
      return reaction.at >= each.at && reaction.at - each.at <= UnprovokedReactions::limit &&
             !(death && makes_well(each.line));
    });
    return just_before || std::ranges::any_of(mission.devices, [&](const descriptor::SimulatedDevice& device) {
             return is_loss_of(reaction, device) && is_cut_off(device.name, reaction.at, injections);
           });
  });
  return reactions;
}

void UnprovokedReactions::note(OctetWriter& writer) const {
  const auto put_text = [&](std::string_view text) {
    const auto whole = text.substr(0, longest_name);
    writer.put(static_cast<std::uint8_t>(whole.size())).put(std::as_bytes(std::span{whole}));
  };
  // The clock of its node, which is the next one's too.
  writer.put(commanded_.time_since_epoch().count()).put(static_cast<std::uint8_t>(uncommanded_.size()));
  for (const ToldReaction& each : uncommanded_) {
    writer.put(each.at.time_since_epoch().count());
    put_text(each.subsystem);
    put_text(each.event);
  }
}

void UnprovokedReactions::recall(OctetReader& reader) {
  const auto time = [&] { return TimePoint{Duration{reader.get<std::int64_t>()}}; };
  const auto text = [&] {
    const Octets octets = reader.get(reader.get<std::uint8_t>());
    return std::string{reinterpret_cast<const char*>(octets.data()), octets.size()};
  };
  commanded_ = time();
  for (auto left = reader.get<std::uint8_t>(); left > 0 && reader.good(); --left) {
    ToldReaction each;
    each.at = time();
    each.subsystem = text();
    each.event = text();
    if (reader.good()) uncommanded_.push_back(std::move(each));
  }
}

}  // namespace hirosco::supervisor
