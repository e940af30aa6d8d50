// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ground/clients/xtce/packet_root.hpp"
#include "hirosco/pus/service/service_kind.hpp"

namespace hirosco::ground {

/// Describes the reports of the framework's services by the tables that the services themselves stand on. Service 1, housekeeping and
/// events, which the descriptors lay out, are described elsewhere.
void add_service_reports(SpaceSystem& system, TypeSet& types, const PacketRoot& root);

/// The names of a Number's values in such a table.
[[nodiscard]] ValueKind kind_of(const pus::Part& part);

}  // namespace hirosco::ground
