// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/flows/system_flow_factory.hpp"

#include <cstdlib>

#include "hirosco/data_transfer/flows/datagram_flow.hpp"
#include "hirosco/data_transfer/flows/shared_memory_flow.hpp"

namespace hirosco {
namespace {

/// As descriptor::Transfer, which ranks above this library.
enum Means : std::uint8_t { SharedMemoryMeans = 0, MessageQueue = 1, Unix = 2, Udp = 3, Tcp = 4, Serial = 5 };

[[nodiscard]] std::string own_instance() {
  const char* name = std::getenv(flight_instance_variable);
  return name != nullptr ? name : "";
}

}  // namespace

SystemFlowFactory::SystemFlowFactory() : SystemFlowFactory{own_instance()} {}
SystemFlowFactory::SystemFlowFactory(const std::string& instance) : suffix_{instance.empty() ? "" : "." + instance} {}

Result<std::unique_ptr<DataFlow>> SystemFlowFactory::do_open(const FlowAddress& address, FlowSide side) {
  switch (address.transfer) {
    case SharedMemoryMeans: return SharedMemoryFlow::open(address.address + suffix_, side);
    case Unix: return open_unix_flow(address.address + suffix_, side);
    case Udp: return open_udp_flow(address.address, side);
    case MessageQueue: return fail(ErrorCode::NotPermitted, "message queue is not built in", address.transfer);
    case Tcp: return fail(ErrorCode::NotPermitted, "TCP is not built in", address.transfer);
    case Serial: return fail(ErrorCode::NotPermitted, "serial line is not built in", address.transfer);
    default: return fail(ErrorCode::InvalidArgument, "unknown means of transfer", address.transfer);
  }
}

}  // namespace hirosco
