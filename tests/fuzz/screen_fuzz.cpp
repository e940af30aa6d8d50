// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "tests/fuzz/fuzz.hpp"
#include "tools/terminal/columns.hpp"
#include "tools/terminal/lines.hpp"
#include "tools/terminal/screen.hpp"

/// Whatever the processes of a flight print, and whatever keys come: the screen is as large as the terminal, and sends it nothing that
/// steers it but its own few sequences. The first three octets are columns, rows, and how many keys follow.
namespace {

using namespace hirosco::terminal;

using hirosco::fuzz::expect;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::size_t head = 3;
  if (size < head) return 0;
  std::string_view text{reinterpret_cast<const char*>(data), size};
  const Size room{static_cast<std::size_t>(data[0]) % 140, static_cast<std::size_t>(data[1]) % 60};
  const std::size_t key_octets = std::min<std::size_t>(data[2] % 16, size - head);
  std::string_view keys = text.substr(head, key_octets);
  text.remove_prefix(head + key_octets);

  ScreenModel model;
  Lines lines{300};
  lines.take(text, [&](std::string_view line) { model.take(line); });
  const Picture before = draw(model, room, 0);
  if (!before.rows.empty()) hirosco::fuzz::taken();
  while (!keys.empty()) {
    const std::size_t left = keys.size();
    model.press(take_key(keys), before.event_rows);
    expect(keys.size() < left, "each key takes an octet at least");
  }
  const Picture after = draw(model, room, data[1] % 5);
  if (room.columns != 0) expect(after.rows.size() == room.rows, "as many rows as there are");
  for (const std::string& line : words_of(after))
    expect(width_of(line) <= room.columns, "no row is wider than the terminal");
  for (const char letter : paint(after, before, room, {.colour = false, .unicode = false}))
    expect(letter == '\x1b' || (letter >= ' ' && letter < 0x7F), "ASCII and sequences");
  for (const PictureRow& row : after.rows)
    for (const Span& span : row)
      for (const char letter : span.text)
        expect(static_cast<unsigned char>(letter) >= ' ' && letter != 0x7F, "nothing of what was told steers");
  expect(farewell(model, "log").size() < 100, "a few words at the end");
  return 0;
}
