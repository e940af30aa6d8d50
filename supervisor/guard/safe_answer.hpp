// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

/// What the guard says on `safe.socket` to who asked for a stop of everything (docs/adr/0167): one message for each who was to stop, whose
/// first word a program reads and whose rest a human being does, and a last one with the version and how many there were. What does not
/// end so, or has a word that is not known, tells nobody that all have stopped.
namespace hirosco::supervisor {

inline constexpr std::string_view safe_request{"SAFE"};
inline constexpr unsigned safe_answer_version = 1;
inline constexpr std::string_view safe_stopped{"STOPPED"};
inline constexpr std::string_view safe_unconfirmed{"UNCONFIRMED"};
inline constexpr std::string_view safe_end{"END"};

[[nodiscard]] inline std::string safe_line(bool stopped, std::string_view words) {
  return std::string{stopped ? safe_stopped : safe_unconfirmed} + " " + std::string{words} + "\n";
}
[[nodiscard]] inline std::string safe_last_line(std::size_t lines) {
  return std::string{safe_end} + " " + std::to_string(safe_answer_version) + " " + std::to_string(lines) + "\n";
}

/// One answer as it comes, message by message.
class SafeAnswer {
 public:
  enum class Stop : std::uint8_t {
    All,  ///< all said that they have stopped, and the answer is whole
    NotAll,  ///< somebody did not, or may be missing in what was said
    Nobody,  ///< nothing was said
  };

  /// The words for a human being; empty: there are none.
  std::string_view take(std::string_view message) {
    while (message.ends_with('\n')) message.remove_suffix(1);
    const auto [word, rest] = parted(message);
    const bool says_somebody = (word == safe_stopped || word == safe_unconfirmed) && !rest.empty();
    begun_ = true;
    if (ended_) damage("it goes on behind its end");
    else if (says_somebody) ++lines_;
    else if (word == safe_end) end(rest);
    else damage("it has a word that this program does not know: the flight is of another version of hirosco");
    if (says_somebody && word == safe_unconfirmed) unconfirmed_ = true;
    if (says_somebody) return rest;
    return word == safe_end ? std::string_view{} : message;
  }
  /// A message that was longer than anybody who is known sends.
  void take_cut_off() {
    begun_ = true;
    damage("one of its lines is too long to be read");
  }

  [[nodiscard]] Stop stop() const noexcept {
    if (!begun_) return Stop::Nobody;
    return ended_ && why_not_.empty() && !unconfirmed_ ? Stop::All : Stop::NotAll;
  }
  /// Why somebody may be missing in it; empty: it is whole.
  [[nodiscard]] std::string_view why_not_whole() const noexcept {
    if (!why_not_.empty()) return why_not_;
    return ended_ ? std::string_view{} : std::string_view{"it has no end"};
  }

 private:
  [[nodiscard]] static std::pair<std::string_view, std::string_view> parted(std::string_view text) noexcept {
    const auto space = text.find(' ');
    if (space == std::string_view::npos) return {text, {}};
    return {text.substr(0, space), text.substr(space + 1)};
  }
  /// False: it is no number, or more than one.
  [[nodiscard]] static bool read(std::string_view text, std::size_t& number) noexcept {
    const auto [behind, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    return problem == std::errc{} && behind == text.data() + text.size();
  }
  void damage(std::string_view why) noexcept {
    if (why_not_.empty()) why_not_ = why;
  }
  void end(std::string_view rest) noexcept {
    const auto [version, count] = parted(rest);
    std::size_t its_version = 0, lines = 0;
    if (!read(version, its_version) || its_version != safe_answer_version)
      return damage("its last line is of another version of hirosco than this program");
    if (!read(count, lines) || lines != lines_) return damage("its last line counts others than were named");
    ended_ = true;
  }

  std::size_t lines_{0};
  bool begun_{false}, ended_{false}, unconfirmed_{false};
  std::string_view why_not_;  ///< a literal
};

}  // namespace hirosco::supervisor
