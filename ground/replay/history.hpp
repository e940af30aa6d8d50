// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/answered.hpp"
#include "ground/model/catalogue.hpp"

/// What parameters were: the archived packets decoded again.
namespace hirosco::ground {

/// Samples of one column in a span, oldest first. Calls `take(t, value)`. False: there were `most` or more.
[[nodiscard]] bool samples(const Catalogue& catalogue, Archive& archive, std::size_t column, const Span& span,
                           std::size_t most, const std::function<void(OnboardTime, double)>& take);

/// {parameter, unit, complete, gaps, t, v}, or min and max of buckets instead of v when there are more than `points`.
[[nodiscard]] Answered<nlohmann::json> history_json(const Catalogue& catalogue, Archive& archive,
                                                    const std::string& parameter, const Span& span, std::size_t points);

/// One line for each time at which one of the parameters was sampled.
[[nodiscard]] Answered<std::string> history_csv(const Catalogue& catalogue, Archive& archive,
                                                const std::vector<std::string>& parameters, const Span& span);

}  // namespace hirosco::ground
