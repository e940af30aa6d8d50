// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "hirosco/subsystem/author/module.hpp"
#include "tests/couplings/follower.hpp"

namespace hirosco {
namespace {

std::unique_ptr<Subsystem> make_counter() { return std::make_unique<Follower<QueueInput>>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_counter>; }
