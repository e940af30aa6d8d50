// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <version>

#include "hirosco/utilities/version.hpp"

/// A subsystem or simulated device in a shared object, NAME.so beside its program NAME: what `hirosco simulate` loads
/// (docs/adr/0050). It has one entry point, hirosco_module(), and brings its own copy of the libraries along.
namespace hirosco {

enum class ModuleKind : std::uint32_t { Subsystem = 1, SimulatedDevice = 2 };

inline constexpr std::uint64_t module_magic = 0x454C'5544'4F4D'5348;  ///< "HSMODULE" of a little-endian machine

#ifdef _GLIBCXX_RELEASE
inline constexpr std::uint32_t standard_library_release = _GLIBCXX_RELEASE;
#else
inline constexpr std::uint32_t standard_library_release = 0;  ///< not libstdc++
#endif

/// What a module says of itself. What stands up to `interface` keeps its place in all versions: it is read before anything
/// else is relied on.
struct Module {
  std::uint64_t magic{module_magic};
  const char* interface{interface_version};  ///< of the libraries inside
  std::uint32_t standard_library{standard_library_release};  ///< that its author's code was compiled with
  ModuleKind kind{};
  const void* content{nullptr};  ///< of the kind: SubsystemModule, simulation::DeviceModule
};

}  // namespace hirosco

/// The entry point, defined by each module:
///   const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_lamp>; }
extern "C" [[gnu::visibility("default")]] const hirosco::Module* hirosco_module() noexcept;
