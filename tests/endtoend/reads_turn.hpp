// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/module.hpp"

/// A subsystem that reads how another one turns, over a link, and reports what it has read last (docs/adr/0236).
namespace hirosco {

/// \tparam Turn The fields that it reads, as an aggregate whose seen() is what it reports.
template <class Turn>
class ReadsTurn final : public Subsystem {
  Result<Step> software_init() override {
    require_link("TURN", turn_);
    publish("SEEN", seen_);
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    seen_.store(turn_.value().seen());
    return ok();
  }

  LinkInput<Turn> turn_;
  Parameter<double> seen_;
};

}  // namespace hirosco
