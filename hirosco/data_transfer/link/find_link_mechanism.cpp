// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/data_transfer/link/link.hpp"

namespace hirosco {

const LinkMechanism* find_link_mechanism(LinkMechanisms mechanisms, LinkMethod method, LinkKind kind) noexcept {
  const auto found = std::ranges::find_if(mechanisms, [&](const LinkMechanism* mechanism) {
    return mechanism->method() == method && mechanism->kind() == kind;
  });
  return found != mechanisms.end() ? *found : nullptr;
}

LinkEndsAt ends_of(LinkMechanisms mechanisms, LinkMethod method) noexcept {
  const bool at_addresses = std::ranges::any_of(mechanisms, [&](const LinkMechanism* mechanism) {
    return mechanism->method() == method && mechanism->ends_at() == LinkEndsAt::Addresses;
  });
  return at_addresses ? LinkEndsAt::Addresses : LinkEndsAt::Memory;
}

}  // namespace hirosco
