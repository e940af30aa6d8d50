// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "tools/hirosco/ground_connection.hpp"

/// What the supervisor is asked that it would do, and how that is printed: `hirosco mode --preview`, `hirosco plan`.
namespace hirosco::tools {

/// A question of ST[129].
struct Question {
  std::uint16_t supervisor{};  ///< its APID
  std::uint8_t subtype{};
  std::vector<std::byte> data;
  std::uint8_t answer{};  ///< subtype of the report
};
/// The source data of the answer; empty when the question is refused, or no answer comes within `limit`.
[[nodiscard]] std::optional<std::vector<std::byte>> ask(GroundConnection& connection, const Question& question,
                                                        Duration limit);

/// "steps" of a JSON object.
[[nodiscard]] nlohmann::ordered_json steps_json(const std::vector<pus::st129::ModePreview::Step>& steps,
                                                const pus::PacketDescriber& describer);
/// One line for each stage: "  1  ARM SafeOperational, HAND Offline".
[[nodiscard]] std::string steps_text(const std::vector<pus::st129::ModePreview::Step>& steps,
                                     const pus::PacketDescriber& describer);

}  // namespace hirosco::tools
