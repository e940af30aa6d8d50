// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "supervisor/overview.hpp"

/// Is it well? The same answer for `hirosco status` and for the screen of `hirosco run`.
namespace hirosco::terminal {

using descriptor::Severity;
using supervisor::Overview;

enum class Verdict : std::uint8_t {
  Well,     ///< everybody is where the mode has him, its links are up, nobody who works is inhibited
  OnTheWay, ///< commissioning, a change or an end is under way
  NotWell,
};

/// One thing that is not as it should be. High: it makes the craft unwell; lower: it is said, too.
struct Finding {
  Severity severity{};
  std::string subject;  ///< a subsystem; empty: a link or the craft
  std::string text;     ///< without end of sentence
};

struct Judgement {
  Verdict verdict{};
  std::string line;     ///< the verdict in a sentence of at most 80 columns, as far as names allow
  std::vector<Finding> findings{};  ///< the gravest first
};
[[nodiscard]] Judgement judge(const Overview& overview);

/// Of what no telemetry tells: its keeper is gone, so that nobody would go on for its supervisor (docs/adr/0217). Whatever it was judged to be, it
/// is not well, and how it is ended is said.
void miss_keeper(Judgement& judged);

/// The commands that bring up again what is down, in turn: who does not run is started before the mode comes up (descriptor::mode_up()). Empty: no
/// mode brings anybody up.
[[nodiscard]] std::vector<std::string> way_up(const Overview& overview, const descriptor::Mission& mission);

/// The same for programs: {"mission", "verdict", "line", "findings": [{"severity", "subject", "text"}], "way_up": `commands`}, the verdict by the
/// words of its table.
[[nodiscard]] nlohmann::ordered_json verdict_json(const std::string& mission, const Judgement& judged,
                                                  const std::vector<std::string>& commands);

/// Why actuators are inhibited, in the words of the page; empty when they are not.
[[nodiscard]] std::string inhibition_words(std::uint32_t inhibited);
/// "Safe-Operational", as the paper writes the states.
[[nodiscard]] std::string state_words(std::string_view state);

}  // namespace hirosco::terminal

namespace hirosco {

template <>
struct EnumTexts<terminal::Verdict> {
  static constexpr auto table = enum_table<terminal::Verdict>({
      {terminal::Verdict::Well, "well"},
      {terminal::Verdict::OnTheWay, "on the way"},
      {terminal::Verdict::NotWell, "not well"},
  });
};

}  // namespace hirosco
