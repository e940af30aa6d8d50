// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "hirosco/data_transfer/device/data_flow.hpp"

namespace hirosco {

/// Data flows inside one process: the two sides of one address meet in a pair of mailboxes that keep the newest frame.
/// No thread, no clock: what a program does is what happens. Flows may outlive the factory.
/// Thread: one for the factory and all of its flows. Realtime: open allocates, the flows are wait-free.
class LocalFlows final : public FlowFactory {
 public:
  struct Pair;

 private:
  /// AlreadyExists: this side of the address is open.
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override;

  std::map<std::pair<Transfer, std::string>, std::shared_ptr<Pair>> pairs_;
};

}  // namespace hirosco
