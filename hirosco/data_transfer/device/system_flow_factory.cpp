// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/system_flow_factory.hpp"

#include <cstdlib>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {
namespace {

[[nodiscard]] std::string told(const char* variable) {
  const char* text = std::getenv(variable);
  return text != nullptr ? text : "";
}

}  // namespace

std::string flight_instance() { return told(flight_instance_variable); }

std::string instance_suffix(const std::string& instance) { return instance.empty() ? "" : "." + instance; }

SystemFlowFactory::SystemFlowFactory()
    : SystemFlowFactory{flight_instance(), read_device_networks(told(device_networks_variable))} {}
SystemFlowFactory::SystemFlowFactory(const std::string& instance, std::vector<DeviceNetwork> networks)
    : instance_{instance}, networks_{std::move(networks)} {}

Result<std::unique_ptr<DataFlow>> SystemFlowFactory::do_open(const FlowAddress& address, FlowSide side) {
  const FlowMeans* means = find_flow_means(address.transfer);
  if (means == nullptr)
    return fail(ErrorCode::NotPermitted, "this means of transfer is not built in",
                std::to_underlying(address.transfer));
  return means->open(
      {address_in_flight(means->form, address.address, instance_), side, address.framing, address.holder, networks_});
}

}  // namespace hirosco
