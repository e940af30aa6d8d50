// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "hirosco/pus/service/service.hpp"
#include "supervisor/supervision/own_subsystem.hpp"

namespace hirosco::supervisor {

/// ST[129] (pus/st129_supervision), a service of the supervisor's own subsystem. Nothing comes of its telecommands but answers: they wait for
/// no disk, no cycle and no queue, and are handed over where they come in (telecommands.cpp). Whoever answers one of them is
/// registered here by its subtype, and reports on it. Thread: the supervisor's.
class SupervisionService final : public pus::Service {
 public:
  using Answer = std::function<void(const pus::Request&, Octets data)>;
  explicit SupervisionService(OwnSubsystem& own) noexcept : own_{own} {}

  void answers(std::uint8_t subtype, Answer answer) { answers_.emplace(subtype, std::move(answer)); }
  [[nodiscard]] const pus::ServiceKind& kind() const noexcept override;
  void handle(const pus::TelecommandView& telecommand, const pus::Request& request) override;

 private:
  OwnSubsystem& own_;
  std::map<std::uint8_t, Answer> answers_;
};

}  // namespace hirosco::supervisor
