// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/value_set.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>

#include "hirosco/descriptor/model/wire_values.hpp"

namespace hirosco::supervisor {
namespace {

/// FNV-1a 64.
class LayoutHash {
 public:
  void add(Octets octets) noexcept {
    for (const std::byte octet : octets) value_ = (value_ ^ std::to_integer<std::uint64_t>(octet)) * prime;
  }
  void add(std::uint32_t number) noexcept {
    std::array<std::byte, sizeof number> octets;
    OctetWriter{octets}.put(number);
    add(Octets{octets});
  }
  /// With its length: two names beside each other are not one.
  void add(std::string_view text) noexcept {
    add(static_cast<std::uint32_t>(text.size()));
    add(std::as_bytes(std::span{text}));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  static constexpr std::uint64_t prime = 0x0000'0100'0000'01B3;
  std::uint64_t value_{0xCBF2'9CE4'8422'2325};
};

[[nodiscard]] std::uint32_t id_of(const descriptor::SubsystemDescriptor& subsystem,
                                  const descriptor::Parameter& parameter) {
  return ParameterId{subsystem.id, parameter.field.type, parameter.id}.wire();
}

}  // namespace

ValueSet::ValueSet(const descriptor::MissionSubsystem& declared) : declared_{declared.overrides} {
  LayoutHash hash;
  for (const descriptor::Parameter& parameter : declared.subsystem.parameters) {
    if (!parameter.persistent) continue;
    const std::uint32_t id = id_of(declared.subsystem, parameter);
    parameters_.emplace(id, parameter);
    hash.add(std::string_view{parameter.field.name});
    hash.add(id);
    hash.add(parameter.field.elements());
    hash.add(std::string_view{parameter.field.unit});
    for (const auto& member : parameter.members) {
      hash.add(std::string_view{member.field.name});
      hash.add(ParameterId{declared.subsystem.id, member.field.type, member.id}.wire());
      hash.add(member.field.elements());
      hash.add(std::string_view{member.field.unit});
    }
  }
  layout_ = hash.value();
}

std::vector<std::string> ValueSet::redeclare(const descriptor::SubsystemDescriptor& declared) {
  std::vector<std::string> forgotten;
  for (const descriptor::Parameter& parameter : declared.parameters) {
    if (!parameter.persistent) continue;
    const std::uint32_t id = id_of(declared, parameter);
    parameters_.at(id) = parameter;
    const auto value = values_.find(id);
    if (value == values_.end() || descriptor::values_within(parameter, value->second)) continue;
    values_.erase(value);
    forgotten.push_back(parameter.field.name);
  }
  return forgotten;
}

void ValueSet::undo(descriptor::SubsystemDescriptor& subsystem) const {
  for (descriptor::Parameter& parameter : subsystem.parameters)
    if (parameter.persistent) parameter.init = parameters_.at(id_of(subsystem, parameter)).init;
}

bool ValueSet::set(std::uint32_t id, Octets value) {
  const auto field = parameters_.find(id);
  if (field == parameters_.end() || !descriptor::values_within(field->second, value)) return false;
  const auto known = values_.find(id);
  if (known != values_.end() && std::ranges::equal(known->second, value)) return false;
  values_[id].assign(value.begin(), value.end());
  return true;
}

std::vector<std::byte> ValueSet::octets() const {
  std::size_t sum = 1;
  for (const auto& [id, value] : values_) sum += sizeof id + value.size();
  std::vector<std::byte> octets(sum);
  OctetWriter writer{octets};
  writer.put(static_cast<std::uint8_t>(values_.size()));
  for (const auto& [id, value] : values_) writer.put(id).put(Octets{value});
  return octets;
}

std::expected<void, CopyFault> ValueSet::take(const ValueCopy& copy) {
  if (copy.layout != layout_) return std::unexpected{CopyFault::Layout};
  std::map<std::uint32_t, std::vector<std::byte>> taken;
  OctetReader reader{copy.values};
  for (auto count = reader.get<std::uint8_t>(); count > 0; --count) {
    const auto id = reader.get<std::uint32_t>();
    const auto field = parameters_.find(id);
    if (!reader.good() || field == parameters_.end()) return std::unexpected{CopyFault::Damaged};
    const Octets value = reader.get(field->second.octets());
    if (!reader.good()) return std::unexpected{CopyFault::Damaged};
    // One that has left its range takes the others along: who runs with the new gain runs with the new limit (docs/adr/0074).
    if (!descriptor::values_within(field->second, value)) return std::unexpected{CopyFault::Range};
    taken[id].assign(value.begin(), value.end());
  }
  if (!reader.exhausted()) return std::unexpected{CopyFault::Damaged};
  values_ = std::move(taken);
  return {};
}

void ValueSet::begin(descriptor::MissionSubsystem& member) const {
  member.overrides = declared_;
  for (descriptor::Parameter& parameter : member.subsystem.parameters) {
    if (!parameter.persistent) continue;
    const std::uint32_t id = id_of(member.subsystem, parameter);
    const auto value = values_.find(id);
    if (value == values_.end()) {
      parameter.init = parameters_.at(id).init;
      continue;
    }
    parameter.init = *descriptor::values_within(parameter, value->second);  // it was when it was set
    std::erase_if(member.overrides, [&](const descriptor::Override& other) {
      return std::string_view{other.parameter}.substr(0, other.parameter.find('.')) == parameter.field.name;
    });
    std::ranges::move(descriptor::overrides_of(parameter), std::back_inserter(member.overrides));
  }
}

}  // namespace hirosco::supervisor
