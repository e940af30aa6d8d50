// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"
#include "ground/model/model.hpp"

/// What is known, as the page and other clients are told it: live, in replay and on request the same.
namespace hirosco::ground {

[[nodiscard]] nlohmann::json event_json(const StoredEvent& event);
[[nodiscard]] nlohmann::json command_json(const StoredCommand& command);
[[nodiscard]] nlohmann::json report_json(const StoredReport& report);
[[nodiscard]] nlohmann::json mark_json(const StoredMark& mark);
/// What a model says of mode, subsystems and links at a time; without `link` and `values`.
[[nodiscard]] nlohmann::json status_json(const Catalogue& catalogue, const Model& model, OnboardTime now);
/// A number, true or false, or words.
[[nodiscard]] nlohmann::json value_json(const Column& column, const Value& value);
/// {NAME: [v, t]} of what is newer than a revision.
[[nodiscard]] nlohmann::json values_json(const Catalogue& catalogue, const Model& model, std::uint64_t since);

}  // namespace hirosco::ground
