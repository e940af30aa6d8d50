// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/system_flow_factory.hpp"

#include <cstdlib>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {
namespace {

[[nodiscard]] std::string own_instance() {
  const char* name = std::getenv(flight_instance_variable);
  return name != nullptr ? name : "";
}

}  // namespace

SystemFlowFactory::SystemFlowFactory() : SystemFlowFactory{own_instance()} {}
SystemFlowFactory::SystemFlowFactory(const std::string& instance) : suffix_{instance.empty() ? "" : "." + instance} {}

Result<std::unique_ptr<DataFlow>> SystemFlowFactory::do_open(const FlowAddress& address, FlowSide side) {
  const FlowMeans* means = find_flow_means(address.transfer);
  if (means == nullptr)
    return fail(ErrorCode::NotPermitted, "this means of transfer is not built in",
                std::to_underlying(address.transfer));
  return means->open(means->form == AddressForm::Name ? address.address + suffix_ : address.address, side);
}

}  // namespace hirosco
