// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/subsystem/author/states.hpp"

namespace hirosco {

/// Where a subsystem is: written by its state machine and by what puts configurations in force (Configurations, Bumpless), read by whoever decides by it.
/// Thread: the service loop.
struct Situation {
  State state{State::Offline};
  const descriptor::Configuration* configuration{nullptr};  ///< in force
  std::optional<Route> way{};  ///< a change of state is under way
  bool release_owed{false};  ///< the cycle still holds the configuration that Post-Operational was to give back

  /// The refusal of what the present state does not permit.
  [[nodiscard]] pus::FailureNotice wrong_state() const {
    return pus::FailureNotice{pus::FailureCode::WrongState}.with(static_cast<std::uint8_t>(state));
  }
};

}  // namespace hirosco
