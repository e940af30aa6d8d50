// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>

#include "hirosco/subsystem/author/module.hpp"

namespace hirosco {
namespace {

/// Numbers its cycles in every state that has some, and turns by a milliradian in each.
class Encoder final : public Subsystem {
  Result<Step> software_init() override {
    publish("NUMBER", number_);
    publish("ANGLE", angle_);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return turn(); }
  Result<> safe_operational(const Cycle&) noexcept override { return turn(); }
  Result<> operational(const Cycle&) noexcept override { return turn(); }
  Result<> error_operational(const Cycle&) noexcept override { return turn(); }

  Result<> turn() noexcept {
    const std::uint64_t next = number_.load() + 1;
    number_.store(next);
    angle_.store(0.001 * static_cast<double>(next));
    return ok();
  }

  Parameter<std::uint64_t> number_;
  Parameter<double> angle_;
};

std::unique_ptr<Subsystem> make_encoder() { return std::make_unique<Encoder>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_encoder>; }
