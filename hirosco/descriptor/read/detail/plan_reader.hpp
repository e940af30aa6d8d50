// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/read/detail/mission_draft.hpp"
#include "hirosco/descriptor/read/detail/step_names.hpp"

namespace hirosco::descriptor::detail {

/// Reads <Recovery>: the plans, when each begins and what it does.
class PlanReader {
 public:
  explicit PlanReader(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  void read_recovery(const xml::Element& element);

 private:
  void read_plan(const xml::Element& element);
  void read_when(const xml::Element& element, Plan& plan);
  void read_do(const xml::Element& element, Plan& plan);
  /// `place`: of the step in its plan.
  [[nodiscard]] std::int64_t read_value(Attributes& attributes, const StepAttribute& described, std::size_t place,
                                        PlanStep& step);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  StepNames step_names_{draft_};
  Unique plan_names_{"plan name", "E0201"};
};

}  // namespace hirosco::descriptor::detail
