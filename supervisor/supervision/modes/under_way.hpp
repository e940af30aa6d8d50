// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "supervisor/supervision/modes/commissioning.hpp"
#include "supervisor/supervision/modes/modes.hpp"

namespace hirosco::supervisor {

/// Whatever brings the craft into a mode, of which there is one at a time: who stops or takes down ends it here, whichever it
/// is. Thread: the supervisor's.
class UnderWay final : public WayIntoMode {
 public:
  UnderWay(Commissioning& commissioning, Modes& modes) : commissioning_{commissioning}, modes_{modes} {}
  Cancelled cancel(std::string_view why) override {
    const Cancelled change = modes_.cancel(why);
    const Cancelled commissioning = commissioning_.cancel(why);
    return commissioning == Cancelled::Nothing ? change : commissioning;
  }
  void all_stopped(std::string_view why) override {
    modes_.all_stopped(why);
    commissioning_.all_stopped(why);
  }
  [[nodiscard]] Moving moving(std::uint16_t apid) const override { return modes_.moving(apid); }
  void stop_now(std::uint16_t apid) override { modes_.stop_now(apid); }
  /// Everybody goes down.
  void drop() {
    modes_.all_stopped("shutdown");
    commissioning_.drop();
  }
  [[nodiscard]] bool running() const noexcept { return commissioning_.running() || modes_.running(); }

 private:
  Commissioning& commissioning_;
  Modes& modes_;
};

}  // namespace hirosco::supervisor
