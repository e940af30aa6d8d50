// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/traffic.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"

namespace hirosco::supervisor {

/// Logs telecommands that are not carried out and tells who sent them why. Thread: the supervisor's.
class Refusals {
 public:
  Refusals(Craft& craft, OwnSubsystem& own, Traffic& traffic) : craft_{craft}, own_{own}, traffic_{traffic} {}

  void refuse(Octets packet, const Origin& origin, const pus::Request& request, const pus::FailureNotice& notice);
  /// What is no telecommand, and as much of it as can be read.
  void refuse_damaged(Octets packet, const Origin& origin, const pus::FailureNotice& notice);

 private:
  Craft& craft_;
  OwnSubsystem& own_;
  Traffic& traffic_;
  TimePoint report_window_{};
  int reports_in_window_{0};
};

}  // namespace hirosco::supervisor
