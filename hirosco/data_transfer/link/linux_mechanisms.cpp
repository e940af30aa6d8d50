// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"
#include "hirosco/data_transfer/link/udp_link.hpp"

namespace hirosco {
namespace {

const LatestLink latest_link;
const LoanedLink loaned_link;
const QueuedLink queued_link;
const UdpLink udp_link;
const LatestLink local_udp_link{LinkMethod::Udp, max_datagram_payload_octets, LinkEndsAt::Addresses};

/// A mechanism is in force where it stands here: for descriptors, handshake, both ends and the supervisor's view.
constexpr const LinkMechanism* built_in_mechanisms[]{
    &latest_link,
    &loaned_link,
    &queued_link,
    &udp_link,
};
/// The same in one process.
constexpr auto local_mechanisms = [] {
  auto local = std::to_array(built_in_mechanisms);
  std::ranges::replace(local, static_cast<const LinkMechanism*>(&udp_link),
                       static_cast<const LinkMechanism*>(&local_udp_link));
  return local;
}();

}  // namespace

LinkMechanisms standard_link_mechanisms() noexcept { return built_in_mechanisms; }
LinkMechanisms local_link_mechanisms() noexcept { return local_mechanisms; }

}  // namespace hirosco
