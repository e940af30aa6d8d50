// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/utilities/module.hpp"

namespace hirosco {

/// What the module of a subsystem tells: how it is made. Its program is made of the same (subsystem_main.cpp).
struct SubsystemModule {
  std::unique_ptr<Subsystem> (*make)();
};

template <std::unique_ptr<Subsystem> (*make)()>
inline constexpr SubsystemModule subsystem_content{make};
/// `const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_lamp>; }`
template <std::unique_ptr<Subsystem> (*make)()>
inline constexpr Module subsystem_module{.kind = ModuleKind::Subsystem, .content = &subsystem_content<make>};

/// Loads the module of the program of this name. In words why there is none.
[[nodiscard]] std::expected<const SubsystemModule*, std::string> load_subsystem(std::string_view program);

}  // namespace hirosco
