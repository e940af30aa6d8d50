// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::descriptor {

namespace {

/// One number of a field: it was in its range when the mission was read.
[[nodiscard]] std::optional<Value> value_in(const Field& field, std::string_view text) {
  const auto number = parse_number(text);
  const TypeRange range = range_of(field.type);
  if (!number || *number < range.lowest || *number > range.highest) return std::nullopt;
  return *number;
}

}  // namespace

std::string to_string(const Override& changed) {
  std::string text = changed.parameter + "=";
  for (std::size_t i = 0; i < changed.values.size(); ++i) {
    const auto* words = std::get_if<std::string>(&changed.values[i]);
    text.append(i == 0 ? "" : " ").append(words != nullptr ? *words : to_string(std::get<Number>(changed.values[i])));
  }
  return text;
}

Result<> apply_override(SubsystemDescriptor& subsystem, std::string_view text) {
  const std::string_view name = text.substr(0, text.find('='));
  const auto place = find_place(subsystem, name);
  if (!place) return fail(ErrorCode::NotFound, "no such parameter");
  if (name.size() == text.size()) return fail(ErrorCode::OutOfRange, "no value");
  const std::vector<Field> fields = fields_of(subsystem, *place);
  Parameter& parameter = subsystem.parameters[place->parameter];
  std::string_view given = text.substr(name.size() + 1);
  if (fields.size() == 1 && fields.front().type == Type::Text) {
    if (given.size() > fields.front().text_octets || !is_text(given))
      return fail(ErrorCode::OutOfRange, "no such text");
    begin_with(parameter, place->member, {std::string{given}});
    return ok();
  }
  std::vector<Value> values;
  bool more = true;
  for (const Field& field : fields) {
    if (field.type == Type::Text) return fail(ErrorCode::OutOfRange, "words among numbers");
    for (std::uint32_t i = 0; i < field.values(); ++i) {
      const auto end = given.find(' ');
      if (!std::exchange(more, end != given.npos)) return fail(ErrorCode::OutOfRange, "another number of values");
      const auto value = value_in(field, given.substr(0, end));
      if (!value) return fail(ErrorCode::OutOfRange, "not a number of its type");
      values.push_back(*value);
      given.remove_prefix(end == given.npos ? given.size() : end + 1);
    }
  }
  if (more) return fail(ErrorCode::OutOfRange, "another number of values");
  begin_with(parameter, place->member, std::move(values));
  return ok();
}

std::vector<Override> overrides_of(const Parameter& parameter) {
  const bool words = std::ranges::any_of(
      parameter.members, [](const Parameter::Member& member) { return member.field.type == Type::Text; });
  if (!words) return {{parameter.field.name, parameter.init}};
  std::vector<Override> each;
  auto value = parameter.init.begin();
  for (const Parameter::Member& member : parameter.members) {
    const auto end = value + static_cast<std::ptrdiff_t>(member.field.values());
    each.push_back({parameter.field.name + "." + member.field.name, {value, end}});
    value = end;
  }
  return each;
}

std::vector<std::pair<std::string, std::string>> changes_of(const MissionSubsystem& member) {
  std::vector<std::pair<std::string, std::string>> changes{
      {"--as", fmt::format("{}:{}", member.subsystem.name, member.subsystem.id)}};
  for (const Override& changed : member.overrides) changes.emplace_back("--set", to_string(changed));
  for (const DeviceChange& device : member.devices) {
    if (!device.address.empty()) changes.emplace_back("--address", device.device + "=" + device.address);
    if (!device.enable.empty()) changes.emplace_back("--enable", device.device + "=" + device.enable);
    if (!device.power.empty()) changes.emplace_back("--power", device.device + "=" + device.power);
    for (const MovedFallBack& moved : device.fall_backs)
      changes.emplace_back("--fall-back", fmt::format("{}={}={}", device.device, moved.address, moved.to));
    for (const Setting& setting : device.settings)
      changes.emplace_back("--setting", fmt::format("{}:{}={}", device.device, setting.name, setting.value));
  }
  for (const Commands& commands : member.subsystem.commands)
    if (commands.apid != 0) changes.emplace_back("--commands", to_string(commands));
  for (const Subscribes& subscribes : member.subsystem.subscribes)
    if (subscribes.apid != 0) changes.emplace_back("--subscribes", to_string(subscribes));
  return changes;
}

namespace {

[[nodiscard]] Result<> rename(SubsystemDescriptor& subsystem, std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == 0 || colon == text.npos) return fail(ErrorCode::InvalidArgument, "NAME:ID is wanted");
  const char* const end = text.data() + text.size();
  std::uint16_t id = 0;
  const auto read = std::from_chars(text.data() + colon + 1, end, id);
  if (read.ec != std::errc{} || read.ptr != end) return fail(ErrorCode::InvalidArgument, "NAME:ID is wanted");
  subsystem.name = text.substr(0, colon);
  subsystem.id = id;
  return ok();
}

/// In each configuration that gives it: who gives it nowhere has no use for it.
[[nodiscard]] Result<> set_setting(SubsystemDescriptor& subsystem, std::string_view text) {
  const auto colon = text.find(':'), equals = text.find('=');
  if (colon == text.npos || equals == text.npos || colon > equals)
    return fail(ErrorCode::InvalidArgument, "DEVICE:NAME=VALUE is wanted");
  const std::string_view device = text.substr(0, colon), name = text.substr(colon + 1, equals - colon - 1);
  bool given = false;
  for (Configuration& configuration : subsystem.configurations)
    for (DeviceUse& use : configuration.devices)
      for (Setting& setting : use.settings) {
        if (subsystem.devices[use.device].name != device || setting.name != name) continue;
        setting.value = text.substr(equals + 1);
        given = true;
      }
  return given ? ok() : fail(ErrorCode::NotFound, "no configuration gives the device such a setting");
}

/// The switch is a whole device's, which may have several endnodes.
[[nodiscard]] Result<> move_power(SubsystemDescriptor& subsystem, std::string_view device, std::string_view address) {
  const auto power = std::ranges::find(subsystem.power_switches, device, &PowerSwitch::device);
  if (power == subsystem.power_switches.end()) return fail(ErrorCode::NotFound, "nothing switches its power");
  power->endnode.address = address;
  return ok();
}

/// Of the endnode and its fall-backs, the one with this address. \return whether there was one.
[[nodiscard]] Result<bool> move_among(const Endnode& preferred, std::vector<Endnode>& fall_backs, std::string_view from,
                                      std::string_view to) {
  bool moved = false;
  for (Endnode& other : fall_backs) {
    if (other.address != from) continue;
    const auto there = [&](const Endnode& end) { return end.transfer == other.transfer && end.address == to; };
    if (there(preferred) || std::ranges::any_of(fall_backs, there))
      return fail(ErrorCode::Mismatch, "the device has that address already");
    other.address = to;
    moved = true;
  }
  return moved;
}

/// In each configuration that falls back to it, and of what the supervisor's side holds.
[[nodiscard]] Result<> move_fall_back(SubsystemDescriptor& subsystem, std::string_view name, std::string_view text) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == text.npos || equals + 1 == text.size())
    return fail(ErrorCode::InvalidArgument, "DEVICE=ADDRESS=ADDRESS is wanted");
  const std::string_view from = text.substr(0, equals), to = text.substr(equals + 1);
  bool moved = false;
  const auto among = [&](const Endnode& preferred, std::vector<Endnode>& fall_backs) -> Result<> {
    HIROSCO_TRY_LET(const bool found, move_among(preferred, fall_backs, from, to));
    moved = moved || found;
    return ok();
  };
  for (Configuration& configuration : subsystem.configurations)
    for (DeviceUse& use : configuration.devices) {
      if (subsystem.devices[use.device].name != name) continue;
      HIROSCO_TRY(among(use.endnode, use.fall_backs));
    }
  for (Device& device : subsystem.devices) {
    if (!device.enable || device.name != name) continue;
    HIROSCO_TRY(among(*device.enable, device.enable_terms.fall_backs));
  }
  for (PowerSwitch& power : subsystem.power_switches) {
    if (power.device != name) continue;
    HIROSCO_TRY(among(power.endnode, power.terms.fall_backs));
  }
  return moved ? ok() : fail(ErrorCode::NotFound, "nothing of it falls back to this address");
}

}  // namespace

Result<> apply_change(SubsystemDescriptor& subsystem, std::string_view word, std::string_view text) {
  if (word == "--as") return rename(subsystem, text);
  if (word == "--set") return apply_override(subsystem, text);
  if (word == "--setting") return set_setting(subsystem, text);
  const auto equals = text.find('=');
  const bool known = word == "--address" || word == "--enable" || word == "--power" || word == "--fall-back";
  if (equals == text.npos || equals + 1 == text.size() || !known)
    return fail(ErrorCode::InvalidArgument, "DEVICE=ADDRESS is wanted");
  const std::string_view name = text.substr(0, equals), rest = text.substr(equals + 1);
  if (word == "--power") return move_power(subsystem, name, rest);
  if (word == "--fall-back") return move_fall_back(subsystem, name, rest);
  const auto device = std::ranges::find(subsystem.devices, name, &Device::name);
  if (device == subsystem.devices.end())
    return fail(ErrorCode::NotFound, "no such device; one of several endnodes is DEVICE.ENDNODE");
  if (word == "--enable") {
    if (!device->enable) return fail(ErrorCode::NotFound, "the device has no second inhibit");
    device->enable->address = rest;
    return ok();
  }
  const auto index = static_cast<std::size_t>(device - subsystem.devices.begin());
  for (Configuration& configuration : subsystem.configurations)
    for (DeviceUse& use : configuration.devices)
      if (use.device == index) use.endnode.address = rest;
  return ok();
}

}  // namespace hirosco::descriptor
