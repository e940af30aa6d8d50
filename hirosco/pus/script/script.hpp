// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// A script: telecommands of one subsystem to others, a line each as `hirosco tc` has it, with waits between them (docs/adr/0138).
namespace hirosco::pus {

/// A script is at most so long, in octets and in lines that do something.
inline constexpr std::size_t most_script_octets = 20'000;
inline constexpr std::size_t most_script_lines = 200;
/// Of a wait, a limit and a time.
inline constexpr double longest_script_wait_s = 86'400;

/// One line of a script that does something:
///   SUBSYSTEM FUNCTION ARGUMENT...                        sends it, and waits for its end
///   wait SECONDS
///   until SUBSYSTEM PARAMETER < VALUE within SECONDS      < <= == != >= >
///   event SUBSYSTEM EVENT within SECONDS                  heard since the last telecommand was sent
///   limit SECONDS                                         of each telecommand from here on
///   @SECONDS LINE                                         not before that time of the script
struct ScriptLine {
  enum class Kind : std::uint8_t { Telecommand, Wait, Until, Event, Limit };
  enum class Is : std::uint8_t { Below, AtMost, Equal, Other, AtLeast, Above };
  Kind kind{Kind::Telecommand};
  std::uint16_t number{0};  ///< in its file, from 1
  double not_before_s{0};  ///< of the script's time
  std::string subsystem{};
  std::string name{};  ///< of the function, parameter or event
  std::vector<std::string> words{};  ///< the arguments of a telecommand
  Is is{Is::Equal};
  double value{0};
  double seconds{0};  ///< of a wait, a limit, and within which something comes
  std::uint16_t subsystem_at{0}, name_at{0};  ///< their columns, from 1
  std::vector<std::uint16_t> words_at{};
  [[nodiscard]] bool holds(double is_now) const noexcept;
};

struct Script {
  std::string name;
  std::vector<ScriptLine> lines;
};

/// One thing that is wrong with a script, where it is and what to do about it.
struct ScriptProblem {
  std::uint16_t line{0}, column{0};
  std::size_t length{1};
  std::string message;
  std::string hint;
};
struct ScriptReading {
  Script script;
  std::vector<ScriptProblem> problems;  ///< empty: the script is whole
};

/// What a text says, as far as that can be known without whom it commands. A stack of telecommands, as ground keeps and writes it, is such
/// a text: "hirosco tc" in front of a line is passed over, and so is "set -e".  Realtime: allocates.
[[nodiscard]] ScriptReading read_script(std::string name, std::string_view text);

/// What a telecommand's line asks for, as <Commands> of the descriptor of who plays it has it; without arguments where no mission has said
/// yet who is commanded. A setting is named "SET:PARAMETER".  Realtime: allocates.
[[nodiscard]] std::expected<descriptor::Function, ScriptProblem> request_of(
    const ScriptLine& line, const descriptor::SubsystemDescriptor& player);
/// The values of its arguments, permitted ones.  Realtime: allocates.
[[nodiscard]] std::expected<std::vector<std::optional<Value>>, ScriptProblem> values_of(
    const ScriptLine& line, const descriptor::Function& request);
/// The parameter that an `until` waits for, in `reads` of <Commands>, or the event that an `event` does, in <Subscribes>.
[[nodiscard]] std::expected<const descriptor::Thing*, ScriptProblem> awaited_by(
    const ScriptLine& line, const descriptor::SubsystemDescriptor& player);
/// The number in the octets of such a parameter, as it stands on the wire. Empty: it is none.
[[nodiscard]] std::optional<double> number_of(const descriptor::Thing& parameter, Octets big_endian);

/// All that is wrong with it for who plays it.  Realtime: allocates.
[[nodiscard]] std::vector<ScriptProblem> check_script(const Script& script,
                                                      const descriptor::SubsystemDescriptor& player);

}  // namespace hirosco::pus
