// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/descriptor/read/detail/device_addresses.hpp"
#include "hirosco/descriptor/read/detail/member_reader.hpp"
#include "hirosco/descriptor/read/detail/mission_draft.hpp"
#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"
#include "hirosco/descriptor/read/detail/mode_reader.hpp"
#include "hirosco/descriptor/read/detail/other_members.hpp"
#include "hirosco/descriptor/read/detail/plan_reader.hpp"

namespace hirosco::descriptor::detail {

/// Reads one <Mission> and the subsystem descriptors it names: its parts in the order in which they refer to each other.
class MissionReader {
 public:
  MissionReader(MissionDraft& draft, const FileSource& source)
      : draft_{draft}, problems_{draft.problems}, mission_{draft.mission}, source_{source} {}
  MissionReader(const MissionReader&) = delete;
  MissionReader& operator=(const MissionReader&) = delete;
  void read(const xml::Element& root);

 private:
  void read_supervisor(const xml::Element& element);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  const FileSource& source_;
  DeviceAddresses device_addresses_{draft_};
  OtherMembers other_members_{draft_};
  MemberReader members_{draft_, source_, device_addresses_, other_members_};
  MissionLinkReader links_{draft_};
  ModeReader modes_{draft_};
  PlanReader plans_{draft_};
};

}  // namespace hirosco::descriptor::detail
