// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/descriptor/read/detail/mission_draft.hpp"

namespace hirosco::descriptor::detail {

/// Reads <Modes>: what each commissions and establishes, and what it permits.
class ModeReader {
 public:
  explicit ModeReader(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  void read_modes(const xml::Element& element);

 private:
  void read_mode(const xml::Element& element);
  void read_commission(const xml::Element& element, Mode& mode, Unique& names);
  void read_establish(const xml::Element& element, Mode& mode, Unique& ids);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  Unique mode_names_{"mode name", "E0201"};
  Unique mode_ids_{"mode id", "E0202"};
};

}  // namespace hirosco::descriptor::detail
