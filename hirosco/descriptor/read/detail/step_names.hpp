// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/read/detail/mission_draft.hpp"

namespace hirosco::descriptor::detail {

/// Names that the steps of a plan say, looked up when the whole plan is read: it may say in <When> whose they are.
class StepNames {
 public:
  struct NamedInStep {
    std::size_t step, attribute;
    const xml::Attribute* at;
    StepAttribute::Kind kind;
  };

  explicit StepNames(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  /// A step of the plan that is read names somebody, or something of somebody.
  void add(const NamedInStep& named) { named_in_steps_.push_back(named); }
  /// All that was added, into the values of the plan's steps.
  void resolve_names(Plan& plan);

 private:
  void resolve_name(const Plan& plan, PlanStep& step, const NamedInStep& named);
  void check_arguments(const xml::Attribute& at, const Function& function, PlanStep& step);
  void check_notice(const xml::Attribute& at);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  std::vector<NamedInStep> named_in_steps_;  ///< of the plan that is read
};

}  // namespace hirosco::descriptor::detail
