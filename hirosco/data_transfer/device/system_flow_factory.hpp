// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"

namespace hirosco {

/// In the environment of every process of a flight that has a name of its own: that name (adr 0037).
inline constexpr const char* flight_instance_variable = "HIROSCO_INSTANCE";

/// The flows of the real set, by means of transfer (`flow_means.hpp`). NotPermitted for means that are not built in. Names of
/// shared memory and UNIX sockets belong to the instance of the flight, so that two flights of one mission do not share their
/// devices.  Realtime: blocks, allocates. Thread: any.
class SystemFlowFactory final : public FlowFactory {
 public:
  /// Of the flight that this process belongs to.
  SystemFlowFactory();
  /// Of that instance; empty: of the flight that has its mission's name.
  explicit SystemFlowFactory(const std::string& instance);

 private:
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override;

  std::string suffix_;
};

}  // namespace hirosco
