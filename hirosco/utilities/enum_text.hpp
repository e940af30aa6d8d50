// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace hirosco {

/// Specialise with a `static constexpr auto table = enum_table<E>({{E::A, "a"}, ...})`: the one place where an
/// enumeration and its texts meet.
template <class E>
struct EnumTexts;

template <class E>
struct EnumText {
  E value;
  std::string_view text;
};

template <class E, std::size_t N>
[[nodiscard]] constexpr std::array<EnumText<E>, N> enum_table(const EnumText<E> (&rows)[N]) {
  std::array<EnumText<E>, N> table{};
  for (std::size_t i = 0; i < N; ++i) table[i] = rows[i];
  return table;
}

inline constexpr std::string_view no_enumerator = "?";

/// Text of an enumerator, no_enumerator for a value outside the enumeration.  Realtime: bounded.
template <class E>
[[nodiscard]] constexpr std::string_view to_text(E value) noexcept {
  for (const auto& row : EnumTexts<E>::table)
    if (row.value == value) return row.text;
  return no_enumerator;
}

/// Enumerator of a text; empty when no enumerator has it.  Realtime: bounded.
template <class E>
[[nodiscard]] constexpr std::optional<E> from_text(std::string_view text) noexcept {
  for (const auto& row : EnumTexts<E>::table)
    if (row.text == text) return row.value;
  return std::nullopt;
}

}  // namespace hirosco
