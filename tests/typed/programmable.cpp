// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/subsystem/author/module.hpp"

/// Takes whatever its descriptor permits: what it does not permit is the framework's to refuse.
namespace hirosco {
namespace {

enum class Colour : std::int16_t { Red = -1, Green = 7 };

class Programmable final : public Subsystem {
  Result<Step> software_init() override {
    on_function("PROGRAM",
                [](std::uint64_t, std::int64_t, Colour, std::string_view, const std::array<float, 2>&,
                   const std::array<bool, 3>&) -> Result<> { return ok(); });
    on_function("NAME", [](std::string_view) -> Result<> { return ok(); });
    on_function("COUNT",
                [](std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                   double) -> Result<> { return ok(); });
    on_function("SERIAL", [](std::uint64_t) -> Result<> { return ok(); });
    on_function("SWITCH", [](bool, Colour) -> Result<> { return ok(); });
    return done;
  }
};

std::unique_ptr<Subsystem> make_programmable() { return std::make_unique<Programmable>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_programmable>; }
