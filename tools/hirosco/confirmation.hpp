// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "hirosco/utilities/lower_case.hpp"

/// What a descriptor wants confirmed (confirm="yes", docs/adr/0105) is asked once more of a person, as the page does. Who is no person at a terminal is asked
/// nothing: a script has been written by somebody who meant it, and would wait for ever.
namespace hirosco::tools {

[[nodiscard]] inline bool is_yes(std::string_view answer) {
  while (!answer.empty() && (answer.back() == '\n' || answer.back() == '\r' || answer.back() == ' '))
    answer.remove_suffix(1);
  const std::string word = lower_case(std::string{answer});
  return word == "y" || word == "yes";
}

/// \param said On the command line. \param person Sees what is asked, and may answer.
[[nodiscard]] inline bool may_be_sent(bool confirm, bool said, bool person, const std::function<std::string()>& ask) {
  return !confirm || said || !person || is_yes(ask());
}

}  // namespace hirosco::tools
