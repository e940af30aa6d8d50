// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "robotics/shapes/mesh.hpp"

/// Of the readers of meshes.
namespace hirosco::robotics::detail {

using Problem = std::unexpected<MeshProblem>;
[[nodiscard]] inline Problem problem(descriptor::Location at, std::string text) {
  return Problem{MeshProblem{at, std::move(text)}};
}

[[nodiscard]] std::expected<Mesh, MeshProblem> read_stl(std::string_view octets);
[[nodiscard]] std::expected<Mesh, MeshProblem> read_obj(std::string_view text);
[[nodiscard]] std::expected<Mesh, MeshProblem> read_collada(std::string_view text);

/// Words with blanks between them, and where each stands.
class Words {
 public:
  /// `at`: of the first character.
  explicit Words(std::string_view text, descriptor::Location at = {1, 1}) : text_{text}, here_{at} {}

  /// The next word; empty: there is none. With `LineEnd` only of this line, whose end is then left standing.
  enum class Over : std::uint8_t { Lines, Line };
  std::string_view next(Over over = Over::Lines) noexcept {
    while (at_ < text_.size() && is_blank(text_[at_]) && (over == Over::Lines || text_[at_] != '\n')) pass();
    word_at_ = here_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) pass();
    return text_.substr(begin, at_ - begin);
  }
  void pass_line() noexcept {
    while (at_ < text_.size() && text_[at_] != '\n') pass();
    if (at_ < text_.size()) pass();
  }
  [[nodiscard]] bool at_end() const noexcept { return at_ == text_.size(); }
  [[nodiscard]] descriptor::Location where() const noexcept { return word_at_; }

 private:
  static bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void pass() noexcept {
    if (text_[at_] == '\n') here_ = {here_.line + 1, 1};
    else ++here_.column;
    ++at_;
  }
  std::string_view text_;
  std::size_t at_{0};
  descriptor::Location here_, word_at_;
};

/// A finite decimal number; nothing: the word is none.
[[nodiscard]] inline std::optional<double> number_of(std::string_view word) noexcept {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (failed != std::errc{} || end != word.data() + word.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}
[[nodiscard]] inline std::optional<std::int64_t> whole_number_of(std::string_view word) noexcept {
  std::int64_t number = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (failed != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// 'word', shortened, so that a message is one line.
[[nodiscard]] inline std::string quoted(std::string_view word) {
  constexpr std::size_t most = 40;
  std::string text{"'"};
  for (const char c : word.substr(0, most)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > most ? "...'" : "'");
}

}  // namespace hirosco::robotics::detail
