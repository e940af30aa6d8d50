// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_means.hpp"

#include <algorithm>

#include "hirosco/data_transfer/device/system_flow_factory.hpp"

namespace hirosco {

const FlowMeans* find_flow_means(Transfer transfer) noexcept {
  const auto means = standard_flow_means();
  const auto found = std::ranges::find(means, transfer, &FlowMeans::transfer);
  return found != means.end() ? &*found : nullptr;
}

std::string address_in_flight(AddressForm form, std::string address, const std::string& instance) {
  const bool line = form == AddressForm::Line;
  if (form == AddressForm::Name || (line && !address.starts_with('/')))
    address.insert(std::min(line ? address.find('@') : std::string::npos, address.size()), instance_suffix(instance));
  return address;
}

}  // namespace hirosco
