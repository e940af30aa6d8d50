// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/link/link_datagram.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"

namespace hirosco {
namespace {

const LatestLink latest_link;
const LoanedLink loaned_link;
const QueuedLink queued_link;
const LatestLink local_udp_link{LinkMethod::Udp, max_datagram_payload_octets, LinkEndsAt::Addresses};

/// With POSIX alone all members are threads of one process (docs/adr/0097): no sample leaves it, whatever method its link has.
constexpr const LinkMechanism* local_mechanisms[]{
    &latest_link,
    &loaned_link,
    &queued_link,
    &local_udp_link,
};

}  // namespace

LinkMechanisms standard_link_mechanisms() noexcept { return local_mechanisms; }
LinkMechanisms local_link_mechanisms() noexcept { return local_mechanisms; }

}  // namespace hirosco
