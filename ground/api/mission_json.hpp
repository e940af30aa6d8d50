// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "ground/model/catalogue.hpp"

namespace hirosco::ground {

/// One edge of the ten states' table, which belongs to the generic subsystem.
struct Transition {
  descriptor::State from{};
  descriptor::State to{};
  bool failure{false};               ///< taken only when the state it leaves has failed
};

/// A line that a simulated device takes, for a button of the page.
struct FaultText {
  std::string line;
  std::string text;
};
/// By the names of the devices, which tell them themselves.
using FaultTexts = std::map<std::string, std::vector<FaultText>>;

/// GET /api/mission: what the descriptors say.
[[nodiscard]] nlohmann::json mission_json(const Catalogue& catalogue, std::span<const Transition> transitions,
                                          const FaultTexts& faults);

}  // namespace hirosco::ground
