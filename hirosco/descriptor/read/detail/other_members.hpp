// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hirosco/descriptor/read/detail/mission_draft.hpp"

namespace hirosco::descriptor::detail {

/// Whom the members command and hear, the supervisor like every other one.
class OtherMembers {
 public:
  explicit OtherMembers(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  /// Whom an instance commands, or hears, in place of who has the name.
  void read_redirected(const xml::Element& element, MissionSubsystem& member, Redirected::Kind kind, Unique& names);
  /// Once all members are known.
  void resolve_all();
  /// Once the supervisor has a row for everybody (give_everybody_a_row()): a process reads its descriptor's file, where they are as many as that
  /// says, and could not read a report with more.
  void check_rows() const;

 private:
  void resolve_one(const MissionSubsystem& member, Commands& commands);
  void resolve_one(const MissionSubsystem& member, Subscribes& subscribes);
  static void check_asked_of_supervisor(const MissionSubsystem& member, const Commands& commands, Problems& problems);
  static void resolve_things(std::vector<Thing>& things, const SubsystemDescriptor& other, const Location& at,
                             Problems& problems);
  /// Whom the mission means by that name, the supervisor among them; null: nobody, and it was reported.
  [[nodiscard]] const SubsystemDescriptor* find_other(const MissionSubsystem& member, const std::string& named,
                                                      Redirected::Kind kind);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  std::vector<std::pair<const xml::Attribute*, std::string>> redirections_;  ///< where, and whose
};

/// Parameters of `member` that have the value of another's, which it hears.
void resolve_foreign_of(const MissionSubsystem& member, Subscribes& heard, const SubsystemDescriptor& other,
                        Problems& problems);
/// No value comes from itself by way of others.
void check_foreign_circles(MissionDraft& draft);

}  // namespace hirosco::descriptor::detail
