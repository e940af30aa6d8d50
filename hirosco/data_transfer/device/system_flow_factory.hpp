// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_network.hpp"

namespace hirosco {

/// In the environment of every process of a flight that has a name of its own: that name (adr 0037).
inline constexpr const char* flight_instance_variable = "HIROSCO_INSTANCE";

/// In the environment of every process of a flight: the networks on which its devices may be (device_network.hpp, adr 0112).
inline constexpr const char* device_networks_variable = "HIROSCO_DEVICE_NETWORKS";

/// The flight that this process belongs to, by its environment; empty: one that has its mission's name.
[[nodiscard]] std::string flight_instance();
/// What stands behind each name of a device in the flight of this instance.
[[nodiscard]] std::string instance_suffix(const std::string& instance);

/// The flows of the real set, by means of transfer (`flow_means.hpp`). NotPermitted for means that are not built in. Names of
/// shared memory, queues, sockets and pseudo-terminals belong to the instance of the flight, so that two flights of one mission do not share their
/// devices.  Realtime: blocks, allocates. Thread: any.
class SystemFlowFactory final : public FlowFactory {
 public:
  /// Of the flight that this process belongs to.
  SystemFlowFactory();
  /// Of that instance; empty: of the flight that has its mission's name.
  explicit SystemFlowFactory(const std::string& instance, std::vector<DeviceNetwork> networks = {});

 private:
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override;

  std::string instance_;
  std::vector<DeviceNetwork> networks_;
};

}  // namespace hirosco
