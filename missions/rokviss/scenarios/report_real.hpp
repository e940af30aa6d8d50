// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hirosco/utilities/time.hpp"
#include "simulation/figures/report_page.hpp"

namespace hirosco::rokviss {

/// Flies a mission with real processes for this time and listens as any ground would: cycle times, links and events of
/// the whole flight. Without a flight the findings hold the problem.
[[nodiscard]] simulation::Chapter fly_for_real(const std::filesystem::path& mission, Duration span);

}  // namespace hirosco::rokviss
