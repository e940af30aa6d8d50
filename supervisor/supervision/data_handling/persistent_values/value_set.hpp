// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "supervisor/platform/storage/value_copy.hpp"

namespace hirosco::supervisor {

/// Values of a subsystem's persistent parameters, those that were ever set. Plain data, bounded by the descriptor. Thread: one.
class ValueSet {
 public:
  /// As the mission has it before anything was set.
  explicit ValueSet(const descriptor::MissionSubsystem& declared);

  /// Ranges and initial values are these from now on (docs/adr/0095). What was set and is outside its range is forgotten: the names of those.
  std::vector<std::string> redeclare(const descriptor::SubsystemDescriptor& declared);
  /// Of a descriptor with what was set: as it was declared, before anything was.
  void undo(descriptor::SubsystemDescriptor& subsystem) const;

  /// It has persistent parameters at all.
  [[nodiscard]] bool wanted() const noexcept { return !parameters_.empty(); }
  /// FNV-1a 64 over name, id, type, size and unit of each: values of another layout mean something else.
  [[nodiscard]] std::uint64_t layout() const noexcept { return layout_; }
  [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
  [[nodiscard]] bool has(std::uint32_t id) const { return parameters_.contains(id); }
  [[nodiscard]] std::string_view name_of(std::uint32_t id) const { return parameters_.at(id).field.name; }
  /// Octets of a value on the wire.
  [[nodiscard]] std::size_t octets_of(std::uint32_t id) const { return parameters_.at(id).octets(); }

  /// Of the parameter with this ParameterId::wire(). False: it is not persistent, no telecommand could set that, or it was set already.
  bool set(std::uint32_t id, Octets value);
  /// It is what the descriptor says again. False: it was.
  bool forget(std::uint32_t id) { return values_.erase(id) != 0; }

  /// As they stand in a copy: how many (u8), then id and value of each, as in TC[20,3].
  [[nodiscard]] std::vector<std::byte> octets() const;
  /// With its layout.
  [[nodiscard]] ValueCopy copy(std::uint64_t sequence, OnboardTime since) const {
    return {layout_, sequence, since, octets()};
  }
  /// All of a whole copy, or nothing and why not: Layout, Range, Damaged.
  [[nodiscard]] std::expected<void, CopyFault> take(const ValueCopy& copy);

  /// With these the subsystem begins from its next start on: what the mission says, and instead of it what was set.
  void begin(descriptor::MissionSubsystem& member) const;

 private:
  std::map<std::uint32_t, descriptor::Parameter> parameters_;  ///< the persistent ones, as declared
  std::map<std::uint32_t, std::vector<std::byte>> values_;
  std::vector<descriptor::Override> declared_;
  std::uint64_t layout_{};
};

}  // namespace hirosco::supervisor
