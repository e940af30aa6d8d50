// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/data_flow.hpp"

namespace hirosco {

/// The flows of the real set, by means of transfer (the numbers of descriptor::Transfer): shared memory, UNIX and UDP
/// datagrams. NotPermitted for means that are not built in.  Realtime: blocks, allocates. Thread: any.
class SystemFlowFactory final : public FlowFactory {
 private:
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override;
};

}  // namespace hirosco
