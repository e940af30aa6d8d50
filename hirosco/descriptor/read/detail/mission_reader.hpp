// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/link/internet_address.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// What is wrong with a path that must stay inside, `above` folders up; empty when nothing is.
[[nodiscard]] std::string_view refuse_path(std::string_view text, int above);
/// Why the producer's set cannot feed the consumer's, by this method where there is one; empty when it can.
[[nodiscard]] std::string mismatch(const SubsystemDescriptor& producer, const Provides& provides,
                                   const Requires& requires_, std::optional<LinkMethod> method);

/// Somebody can be found in it; the others are passed through.
[[nodiscard]] constexpr bool is_steady(State state) noexcept {
  return state == State::Offline || state == State::PreOperational || state == State::SafeOperational ||
         state == State::Operational || state == State::ErrorOperational || state == State::PostOperational;
}

/// Reads one <Mission> and the subsystem descriptors it names.
class MissionReader {
 public:
  MissionReader(Problems& problems, const FileSource& source) : problems_{problems}, source_{source} {}
  [[nodiscard]] Mission read(const xml::Element& root);
  /// Problems of the subsystem files, each file's in its order.
  [[nodiscard]] std::vector<Diagnostic> take_subsystem_problems();
  [[nodiscard]] std::vector<Diagnostic> take_subsystem_warnings();

 private:
  // read_mission.cpp
  void read_supervisor(const xml::Element& element);
  void read_database(const xml::Element& element);
  void read_log_server(Attributes& attributes);
  void read_ground(const xml::Element& element);
  void read_address(Attributes& attributes, std::string_view name, std::string& into);
  // read_power.cpp
  void read_power(const xml::Element& element);
  void read_measured_power(const xml::Attribute& measured, Duration age);
  // read_resources.cpp
  void read_resources(const xml::Element& element);
  void read_isolation(const xml::Element& element);
  // read_manifest.cpp
  void read_manifest(const xml::Element& element);
  // read_resources.cpp
  void check_resources(const xml::Element& element);
  void read_member(const xml::Element& element);
  /// Name and id of an instance, where they are not the descriptor's.
  void read_identity(Attributes& attributes, MissionSubsystem& member);
  void read_override(const xml::Element& element, MissionSubsystem& member, Unique& names);
  void read_device_change(const xml::Element& element, MissionSubsystem& member, Unique& names);
  void read_changed_setting(const xml::Element& element, MissionSubsystem& member, DeviceChange& changed,
                            Unique& names);
  void read_simulated_device(const xml::Element& element);
  /// The descriptor that the attribute names; reported when it cannot be taken.
  [[nodiscard]] std::optional<SubsystemDescriptor> read_descriptor(Attributes& attributes);
  // read_addresses.cpp
  void read_device_network(const xml::Element& element);
  void check_endnodes(const SubsystemDescriptor& subsystem);
  void check_endnode(const Endnode& endnode, const std::string& subsystem, Problems& problems);
  // check_reach.cpp
  void note_sockets();
  void check_reach();
  // read_mission.cpp
  [[nodiscard]] std::string executable(Attributes& attributes);

  // read_commands.cpp
  void read_redirected(const xml::Element& element, MissionSubsystem& member, Redirected::Kind kind, Unique& names);
  // read_foreign.cpp
  void resolve_foreign_of(const MissionSubsystem& member, Subscribes& heard, const SubsystemDescriptor& other,
                          Problems& problems);
  void check_foreign_circles();
  /// Whom the members command and hear, once all are known.
  void resolve_commands();
  void resolve_one(const MissionSubsystem& member, Commands& commands);
  void resolve_one(const MissionSubsystem& member, Subscribes& subscribes);
  static void resolve_things(std::vector<Thing>& things, const SubsystemDescriptor& other, const Location& at,
                             Problems& problems);
  /// Whom the mission means by that name; null: nobody, and it was reported.
  [[nodiscard]] const MissionSubsystem* find_other(const MissionSubsystem& member, const std::string& named,
                                                   Redirected::Kind kind);

  // read_console.cpp
  void read_console(const xml::Element& element);
  void read_shown(const xml::Element& element);

  // read_modes.cpp
  void read_link(const xml::Element& element);
  /// "A.SET" split and its subsystem found.
  [[nodiscard]] const SubsystemDescriptor* read_end(Attributes& attributes, std::string_view name,
                                                    std::string& subsystem, std::string& set);
  void check_link(const xml::Element& element, const SubsystemDescriptor& producer, const SubsystemDescriptor& consumer,
                  const MissionLink& link);
  /// read_link_loss.cpp
  void read_loss(Attributes& attributes, const SubsystemDescriptor* consumer, MissionLink& link);
  // read_way.cpp
  void read_way(Attributes& attributes, MissionLink& link);
  [[nodiscard]] std::optional<InternetAddress> read_link_address(const xml::Attribute* at, const MissionLink& link,
                                                                 std::string& into);
  // read_modes.cpp
  void read_modes(const xml::Element& element);
  void read_mode(const xml::Element& element);

  // read_interlocks.cpp
  void read_interlock(const xml::Element& element, Interlock::Kind kind, Mode& mode);
  /// Modes may be named before they are read: when all are.
  void check_from(const xml::Element& modes);
  void check_start(const xml::Attribute& start, const Mode& mode);

  // check_modes.cpp: only what was read without a problem is judged
  /// What a mode commissions must fit the power budget together.
  void check_power(const xml::Element& element, const Mode& mode);
  /// And the one processor of all cycles.
  void check_cycles(const xml::Element& element, const Mode& mode);
  /// A mode brings up a link into each set that what it commissions requires.
  void check_required(const Mode& mode);
  /// Both ends of a link are commissioned with the sets that it joins.
  void check_established(const xml::Element& element, const Mode& mode);
  [[nodiscard]] std::string refuse_link(const Mode& mode, const MissionLink& link) const;

  // read_modes.cpp
  void read_commission(const xml::Element& element, Mode& mode, Unique& names);
  void read_establish(const xml::Element& element, Mode& mode, Unique& ids);
  void read_permit(const xml::Element& element, Mode& mode);
  // read_plans.cpp
  void read_recovery(const xml::Element& element);
  void read_plan(const xml::Element& element);
  void read_when(const xml::Element& element, Plan& plan);
  void read_do(const xml::Element& element, Plan& plan);
  /// `place`: of the step in its plan.
  [[nodiscard]] std::int64_t read_value(Attributes& attributes, const StepAttribute& described, std::size_t place,
                                        PlanStep& step);
  struct NamedInStep {
    std::size_t step, attribute;
    const xml::Attribute* at;
    StepAttribute::Kind kind;
  };
  void resolve_names(Plan& plan);
  void resolve_name(const Plan& plan, PlanStep& step, const NamedInStep& named);
  void check_arguments(const xml::Attribute& at, const Function& function, PlanStep& step);
  void check_notice(const xml::Attribute& at);
  void expand_runs(const xml::Element& element);
  void check_answers(const xml::Element& element, const Plan& plan);
  // read_modes.cpp
  [[nodiscard]] State read_steady_state(Attributes& attributes, std::string_view name, State fallback);
  void check_functions(const xml::Attribute& at, const Permit& permit);
  void check_parameters(const xml::Attribute& at, const Permit& permit);

  /// A subsystem of the mission, with `supervisor` also the supervisor; reported when there is none.
  [[nodiscard]] const SubsystemDescriptor* find(const xml::Attribute& at, std::string_view name, bool supervisor);
  [[nodiscard]] bool whole() const noexcept { return !incomplete_; }

  Problems& problems_;
  const FileSource& source_;
  Mission mission_;
  std::vector<std::vector<Diagnostic>> subsystem_problems_;
  std::vector<Diagnostic> warnings_;
  std::vector<std::pair<const xml::Attribute*, std::string>> redirections_;  ///< where, and whose
  std::vector<NamedInStep> named_in_steps_;  ///< of the plan that is read
  std::size_t doubtful_links_{0};    ///< that were reported: what a mode establishes cannot be judged then
  bool incomplete_{false};           ///< a subsystem could not be read: names may be missing for that reason only
  Unique subsystem_names_{"subsystem name", "E0301"};
  Unique subsystem_ids_{"subsystem id", "E0302"};
  Unique device_names_{"simulated device", "E0201"};
  Unique played_{"device", "E0201"};
  Unique link_ids_{"link id", "E0202"};
  Unique link_addresses_{"address of a link", "E0313"};
  Unique mode_names_{"mode name", "E0201"};
  Unique mode_ids_{"mode id", "E0202"};
  Unique plan_names_{"plan name", "E0201"};
  std::map<std::pair<Transfer, std::string>, std::string> addresses_;  ///< of devices, and whose they are
};

}  // namespace hirosco::descriptor::detail
