// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include "hirosco/descriptor/read/detail/mission_draft.hpp"

namespace hirosco::descriptor::detail {

/// Where the devices of a mission are: the networks that it permits, and whose each address is.
class DeviceAddresses {
 public:
  explicit DeviceAddresses(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  /// A network beyond this computer that devices may be in.
  void read_device_network(const xml::Element& element);
  /// Those of its devices, of the switches of their power and of their second inhibits.
  void check_endnodes(const SubsystemDescriptor& subsystem);

 private:
  void check_endnode(const Endnode& endnode, const std::string& subsystem, Problems& problems);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  std::map<std::pair<Transfer, std::string>, std::string> addresses_;  ///< of devices, and whose they are
};

}  // namespace hirosco::descriptor::detail
