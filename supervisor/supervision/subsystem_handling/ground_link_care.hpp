// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/succession/succession.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Without the ground link nobody could command anything: it comes back by itself, whether a fault or a telecommand took it
/// away (adr 0043), and is started again when it died whatever the mission's plans say (adr 0165). Thread: the supervisor's.
class GroundLinkCare final : public Watch {
 public:
  GroundLinkCare(const Means& means, const UnderWay& under_way, const Succession& succession)
      : craft_{means.craft},
        links_{means.links},
        restarts_{means.restarts},
        under_way_{under_way},
        succession_{succession},
        runner_{means} {}

  void watch(TimePoint now) override;
  /// To what its mode asks for, or, while links that this requires are down, to a configuration that requires none that is.
  void restore(const Member& link);

 private:
  static constexpr Duration pause = std::chrono::seconds{1};
  void start_again(const Member& link, TimePoint now);
  [[nodiscard]] const descriptor::CommissionStep* wanted(const Member& link) const;
  [[nodiscard]] const descriptor::Configuration& able(const descriptor::SubsystemDescriptor& link,
                                                      const std::string& configuration) const;

  Craft& craft_;
  const LinkGraph& links_;
  Restarts& restarts_;
  const UnderWay& under_way_;
  const Succession& succession_;
  ProcedureRunner runner_;
  std::optional<TimePoint> lost_at_;
  Duration patience_{pause};  ///< longer after each time that it did not come back
};

}  // namespace hirosco::supervisor
