// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"

/// Why it stopped, told as a person would: the cause first, then what it brought about, in the order of time.
namespace hirosco::ground {

/// The newest story that began before `to`: events of medium and high severity, or a SAFE_ALL, that belong together, with what happened
/// around them. As GET /api/why answers (ground/api/README.md); `causes` is empty when nothing has stopped.
[[nodiscard]] nlohmann::json newest_story(const Catalogue& catalogue, Archive& archive, OnboardTime to);

}  // namespace hirosco::ground
