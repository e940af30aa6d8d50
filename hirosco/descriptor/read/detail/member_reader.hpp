// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/descriptor/read/detail/device_addresses.hpp"
#include "hirosco/descriptor/read/detail/mission_draft.hpp"
#include "hirosco/descriptor/read/detail/other_members.hpp"

namespace hirosco::descriptor::detail {

/// Who flies: the supervisor and each <Subsystem>, by the descriptors that they name.
class MemberReader {
 public:
  MemberReader(MissionDraft& draft, const FileSource& source, DeviceAddresses& addresses, OtherMembers& others)
      : draft_{draft}, problems_{draft.problems}, source_{source}, addresses_{addresses}, others_{others} {}
  /// The supervisor's descriptor; `attributes`: of <Supervisor>.
  void read_supervisor(Attributes& attributes);
  /// One <Subsystem> of the mission.
  void read_member(const xml::Element& element);

 private:
  /// Name and id of an instance, where they are not the descriptor's.
  void read_identity(Attributes& attributes, MissionSubsystem& member);
  /// The descriptor that the attribute names; reported when it cannot be taken.
  [[nodiscard]] std::optional<SubsystemDescriptor> read_descriptor(Attributes& attributes);

  MissionDraft& draft_;
  Problems& problems_;
  const FileSource& source_;
  DeviceAddresses& addresses_;
  OtherMembers& others_;
  Unique subsystem_names_{"subsystem name", "E0301"};
  Unique subsystem_ids_{"subsystem id", "E0302"};
};

}  // namespace hirosco::descriptor::detail
