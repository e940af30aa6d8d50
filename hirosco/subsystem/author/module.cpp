// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco {

std::expected<const SubsystemModule*, std::string> load_subsystem(std::string_view program) {
  const auto module = load_module_of(program, ModuleKind::Subsystem);
  if (!module) return std::unexpected{module.error()};
  return static_cast<const SubsystemModule*>((*module)->content);
}

}  // namespace hirosco
