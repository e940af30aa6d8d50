// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::supervisor {

using descriptor::State;

/// What a telecommand that was completed says besides what it does.
enum class Kept : std::uint8_t { Yes, NoMatter, NoRoom };

/// A telecommand of the supervisor's own, without its addressee.
struct SettingCommand {
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::vector<std::byte> data;
};

/// What a subsystem was commanded to be, from the telecommands that it has completed (docs/adr/0076): state, configuration,
/// parameters, housekeeping, event reports. What a function has set is not among it: a function may move something.
/// Plain data, bounded by the descriptor and by `most_definition_octets`. Thread: the supervisor's.
class CommandedState {
 public:
  /// Of housekeeping definitions that telecommands have made or lengthened, all together.
  static constexpr std::size_t most_definition_octets = 16'384;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// In force by CONFIGURE; 0 = none.
  [[nodiscard]] std::uint8_t configuration() const noexcept { return configuration_; }
  /// Parameters that functions have set and nobody sets again (Function::unrepeated): what they stood at is lost with the process.
  [[nodiscard]] const std::set<std::uint16_t>& unrepeated() const noexcept { return unrepeated_; }
  [[nodiscard]] std::vector<std::string> unrepeated_names(const descriptor::SubsystemDescriptor& subsystem) const;
  /// Whether it was done, or how much of it, is not known: what a function would have set counts as set.
  void may_have_set(const pus::TelecommandView& telecommand, const descriptor::SubsystemDescriptor& subsystem);
  /// What another record of the same process has of it counts, too.
  void may_have_set(const CommandedState& other) {
    unrepeated_.insert(other.unrepeated_.begin(), other.unrepeated_.end());
  }
  /// Nothing above this. Of what is neither on the way up nor at its end, Error-Operational say, Pre-Operational is left.
  void lower(State most) noexcept;

  /// Whose reports are off.
  [[nodiscard]] const std::set<std::uint16_t>& silent_events() const noexcept { return silent_events_; }

  /// A request that this looks at at all: worth to be remembered until it is completed.
  [[nodiscard]] static bool concerns(const pus::TelecommandView& telecommand,
                                     const descriptor::SubsystemDescriptor& subsystem);
  /// It has reported TM[1,7].
  Kept completed(const pus::TelecommandView& telecommand, const descriptor::SubsystemDescriptor& subsystem);

  /// All of it, for a supervisor that goes on for this one (docs/adr/0093).
  void note(OctetWriter& writer) const;
  void recall(OctetReader& reader);

  /// What brings the settings back that can be set in `state`, Pre-Operational or Safe-Operational, and in no state before it on the
  /// way up; in the order in which they are to be sent.
  [[nodiscard]] std::vector<SettingCommand> settings_for(State state,
                                                         const descriptor::SubsystemDescriptor& subsystem) const;
  /// Parameters that can be set in neither of the two: setting them might move something. Their names.
  [[nodiscard]] std::vector<std::string> out_of_reach(const descriptor::SubsystemDescriptor& subsystem) const;

 private:
  struct ParameterValue {
    std::uint32_t id{};  ///< ParameterId::wire()
    std::vector<std::byte> value;  ///< as on the wire
  };
  struct Structure {
    std::uint16_t id{};
    std::vector<std::byte> created{};  ///< as in TC[3,1]; empty: the descriptor's
    std::vector<std::vector<std::byte>> appended{};  ///< as in TC[3,29]
    std::optional<std::uint32_t> interval{};
    std::optional<bool> periodic{};
  };
  void enter(State state) noexcept;
  void configure(std::uint8_t id, const descriptor::SubsystemDescriptor& subsystem);
  void set_parameters(Octets data, const descriptor::SubsystemDescriptor& subsystem);
  void switch_events(Octets data, bool enabled);
  Kept define(std::uint8_t subtype, Octets data, const descriptor::SubsystemDescriptor& subsystem);
  /// Null: none of its descriptor's, in the configuration in force.
  [[nodiscard]] const descriptor::HousekeepingStructure* declared(
      std::uint16_t structure, const descriptor::SubsystemDescriptor& subsystem) const;
  [[nodiscard]] bool is_defined(std::uint16_t structure, const descriptor::SubsystemDescriptor& subsystem) const;
  [[nodiscard]] Structure& structure(std::uint16_t id);
  [[nodiscard]] std::size_t definition_octets() const noexcept;

  State state_{State::Offline};
  std::uint8_t configuration_{0};
  std::set<std::uint16_t> unrepeated_;
  std::vector<ParameterValue> parameters_;  ///< in the order in which they were set; no id twice
  std::set<std::uint16_t> silent_events_;  ///< whose reports are off
  std::vector<Structure> structures_;
};

}  // namespace hirosco::supervisor
