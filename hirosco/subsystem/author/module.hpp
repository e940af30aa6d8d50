// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "hirosco/subsystem/author/ground_transport.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/utilities/module.hpp"

namespace hirosco {

using MakeSubsystem = std::unique_ptr<Subsystem> (*)();
using MakeOnTransport = std::unique_ptr<Subsystem> (*)(OpenGroundTransport open);

/// What the module of a subsystem tells: how it is made. Its program is made of the same (subsystem_main.cpp).
struct SubsystemModule {
  MakeSubsystem make;
  /// Of one that can hold the mission's ground link: made on a transport that is given in place of its own, as a simulation has a
  /// ground without sockets. Null of all others.
  MakeOnTransport make_on_transport;
};

template <MakeSubsystem make, MakeOnTransport make_on_transport = nullptr>
inline constexpr SubsystemModule subsystem_content{make, make_on_transport};
/// `const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_lamp>; }`
template <MakeSubsystem make, MakeOnTransport make_on_transport = nullptr>
inline constexpr Module subsystem_module{.kind = ModuleKind::Subsystem,
                                         .content = &subsystem_content<make, make_on_transport>};

/// Loads the module of the program of this name. In words why there is none.
[[nodiscard]] std::expected<const SubsystemModule*, std::string> load_subsystem(std::string_view program);

}  // namespace hirosco
