// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"

namespace hirosco::supervisor {

class PowerHandling;

/// All that may refuse a well-formed telecommand as the craft stands now, without doing anything about it: what is asked before
/// sending and what is decided on sending are this one function. Thread: the supervisor's.
class Judgement {
 public:
  Judgement(const Craft& craft, OwnSubsystem& own, const LinkGraph& links, const PowerHandling& power)
      : craft_{craft}, own_{own}, links_{links}, power_{power} {}
  Judgement(const Judgement&) = delete;  // what tells what is in force speaks of this one
  Judgement& operator=(const Judgement&) = delete;

  [[nodiscard]] std::expected<Permitted, pus::FailureNotice> judge(const pus::TelecommandView& telecommand,
                                                                   const Origin& origin) const;
  /// TC[129,1]: would the telecommand that is its data be permitted now, from who asks?
  void answer(const pus::Request& request, Octets asked) const;

 private:
  [[nodiscard]] bool is_sound(std::uint16_t apid) const;
  [[nodiscard]] Situation situation_of(std::uint16_t apid) const;
  [[nodiscard]] std::vector<descriptor::InForce> in_force() const;

  const Craft& craft_;
  OwnSubsystem& own_;
  const LinkGraph& links_;
  const PowerHandling& power_;
  /// in_force() as the rules ask for it: made once and not for each telecommand, of which hardly any needs it.
  const std::function<std::vector<descriptor::InForce>()> tells_in_force_{[this] { return in_force(); }};
};

}  // namespace hirosco::supervisor
