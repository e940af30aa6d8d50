// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::supervisor {

/// Who speaks. Made where the octets enter, travels with them, and is what rules look at; the source id that a telecommand
/// bears is a claim, which must be its origin's (adr 0062). Procedures, plans and the console speak as the supervisor.
class Origin {
 public:
  enum class Kind : std::uint8_t { Ground, Subsystem, Supervisor };

  /// A client of the ground link, by the number that the link gave it.
  [[nodiscard]] static constexpr Origin ground(std::uint16_t client = 0) noexcept { return {Kind::Ground, 0, client}; }
  /// A member, by its channel.
  [[nodiscard]] static constexpr Origin subsystem(std::uint16_t apid) noexcept { return {Kind::Subsystem, apid, 0}; }
  [[nodiscard]] static constexpr Origin supervisor() noexcept { return {Kind::Supervisor, pus::supervisor_apid, 0}; }
  /// Who has this source id, of a telecommand that was found to own it.
  [[nodiscard]] static Origin of(std::uint16_t source, const descriptor::Mission& mission) noexcept {
    if (source == mission.supervisor.id) return supervisor();
    return mission.find_subsystem(source) != nullptr ? subsystem(source) : ground();
  }

  [[nodiscard]] constexpr bool is_ground() const noexcept { return kind_ == Kind::Ground; }
  [[nodiscard]] constexpr bool is_subsystem() const noexcept { return kind_ == Kind::Subsystem; }
  [[nodiscard]] constexpr bool is_supervisor() const noexcept { return kind_ == Kind::Supervisor; }
  /// 0 of the ground; in the log, and where reports go that may not go where a telecommand wants them.
  [[nodiscard]] constexpr std::uint16_t apid() const noexcept { return apid_; }
  [[nodiscard]] constexpr std::uint16_t client() const noexcept { return client_; }

  /// On board each has its own id and no other; the ground has all that are nobody's there, 0 among them.
  [[nodiscard]] bool owns(std::uint16_t source, const descriptor::Mission& mission) const noexcept {
    if (!is_ground()) return source == apid_;
    return mission.find_member(source) == nullptr;
  }

 private:
  constexpr Origin(Kind kind, std::uint16_t apid, std::uint16_t client) noexcept
      : kind_{kind}, apid_{apid}, client_{client} {}
  Kind kind_;
  std::uint16_t apid_;
  std::uint16_t client_;
};

}  // namespace hirosco::supervisor
