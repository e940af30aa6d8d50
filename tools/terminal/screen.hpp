// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/terminal/screen_model.hpp"

/// The screen of `hirosco run`: a pure function from what is known to rows, and one from two pictures to what a terminal is sent.
namespace hirosco::terminal {

struct Size {
  std::size_t columns{80};
  std::size_t rows{24};
  friend bool operator==(const Size&, const Size&) = default;
};

/// Grey is normal, colour is what deviates.
enum class Look : std::uint8_t { Plain, Dim, Bold, Note, Grave };

struct Span {
  std::string text;
  Look look{Look::Plain};
  friend bool operator==(const Span&, const Span&) = default;
};
using PictureRow = std::vector<Span>;
struct Picture {
  std::vector<PictureRow> rows;  ///< as many as the screen has, none wider than it
  std::size_t event_rows{0};  ///< room for events: a page of them
};

/// `silent_s`: since when the supervisor has told nothing. Never more columns or rows than `size`; a URL is never cut.
[[nodiscard]] Picture draw(const ScreenModel& model, Size size, double silent_s);
/// The words alone, without spaces at the end.
[[nodiscard]] std::vector<std::string> words_of(const Picture& picture);

/// How a terminal is written to.
struct Palette {
  bool colour{true};  ///< else weight alone (NO_COLOR)
  bool unicode{true};  ///< else ASCII
};
/// What makes a terminal that shows `last` show `next`: rows that differ. An empty `last`: all of them.
[[nodiscard]] std::string paint(const Picture& next, const Picture& last, Size size, Palette palette);

/// What is left on an ordinary terminal once the flight is over: how long, how it was, what was grave, what to ask next.
[[nodiscard]] std::vector<std::string> farewell(const ScreenModel& model, const std::string& log);

}  // namespace hirosco::terminal
