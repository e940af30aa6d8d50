// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_means.hpp"

#include <algorithm>

namespace hirosco {

const FlowMeans* find_flow_means(Transfer transfer) noexcept {
  const auto means = standard_flow_means();
  const auto found = std::ranges::find(means, transfer, &FlowMeans::transfer);
  return found != means.end() ? &*found : nullptr;
}

}  // namespace hirosco
