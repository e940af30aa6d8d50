// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "hirosco/pus/service/service_kind.hpp"

namespace hirosco::pus {

/// The services of the framework, one row each, in the order of their types. A subsystem's own are in its descriptor.
[[nodiscard]] std::span<const ServiceKind* const> standard_services() noexcept;

/// Null: the framework has none of this type.
[[nodiscard]] const ServiceKind* standard_service(std::uint8_t type) noexcept;

}  // namespace hirosco::pus
