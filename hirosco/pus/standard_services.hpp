// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hirosco/pus/service/service_kind.hpp"

namespace hirosco::pus {

/// The services of the framework, one row each, in the order of their types. A subsystem's own are in its
/// descriptor, and an author writes one over `subsystem/author/custom_service.hpp`.
/// A new one: its folder `stNN_name/` with README and test (copy `st17_test/`, which every subsystem makes by its row alone), its row in
/// `standard_services.cpp`, its files in this library's CMakeLists.txt, its line in `docs/services.md`, and a mode's <Permit>
/// unless it is essential. Besides, where it is so: one that a descriptor may leave out has a row in
/// `descriptor/model/service_list.hpp`, one with an element of its own in descriptors is read in
/// `descriptor/read/read_services.cpp`. One that needs cycle or states has no `make`: GenericSubsystem
/// (`subsystem/service_loop/generic_subsystem.cpp`) or a part of it makes it, beside those that they have, and
/// `standard_services_test.cpp` has an object of it, by which its rows are tried against what it takes.
[[nodiscard]] std::span<const ServiceKind* const> standard_services() noexcept;

/// Those by their types; null: the framework has none of this type.
extern const std::array<const ServiceKind*, 256> standard_services_by_type;

/// Asked of every packet on each hop. Null: the framework has none of this type.
[[nodiscard]] inline const ServiceKind* standard_service(std::uint8_t type) noexcept {
  return standard_services_by_type[type];
}

}  // namespace hirosco::pus
