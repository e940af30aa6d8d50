// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guarded_member.hpp"

namespace hirosco::supervisor {

/// Hears the second inhibits of a member's devices, and what it means that one is not heard (docs/adr/0237). Where answers have an age limit, an older
/// one says nothing: that drive counts as not enabled, its member is fenced, and the next way is for who is let go again; or, where the
/// descriptor says so, the next way goes on with it. Where they have none, a silence is told.  Thread: under the guard's mutex.
class InhibitWatch {
 public:
  explicit InhibitWatch(GuardFindings& findings) : findings_{findings} {}
  /// Realtime: bounded; no heap but for findings.
  void step(GuardedMember& member, TimePoint now);

 private:
  void judge(GuardedMember& member, WatchedDevice& device, TimePoint now);
  void lose(GuardedMember& member, WatchedDevice& device, TimePoint now);

  GuardFindings& findings_;
};

}  // namespace hirosco::supervisor
