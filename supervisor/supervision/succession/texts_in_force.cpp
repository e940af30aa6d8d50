// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/succession/texts_in_force.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {
namespace {

using TextLength = std::uint32_t;

void put_text(OctetWriter& writer, std::string_view text) {
  writer.put(static_cast<TextLength>(text.size())).put(std::as_bytes(std::span{text}));
}

[[nodiscard]] std::string take_next_text(OctetReader& reader) {
  const Octets octets = reader.get(reader.get<TextLength>());
  return {reinterpret_cast<const char*>(octets.data()), octets.size()};
}

}  // namespace

TextsInForce::Texts TextsInForce::newest() const {
  Texts texts;
  OctetReader reader{journal_.newest()};
  while (reader.good() && !reader.exhausted()) {
    std::filesystem::path file = take_next_text(reader);
    texts[std::move(file)] = std::make_shared<const std::string>(take_next_text(reader));
  }
  return reader.good() ? texts : Texts{};
}

bool TextsInForce::note(const Texts& texts) {
  const auto text_of = [](const auto& each) -> const auto& { return each.second; };
  if (std::ranges::equal(texts, noted_, {}, text_of)) return true;
  noted_.clear();
  std::size_t octets = 0;
  for (const auto& [file, text] : texts) {
    noted_.push_back(text);
    octets += 2 * sizeof(TextLength) + file.native().size() + text->size();
  }
  std::vector<std::byte> content(octets);
  OctetWriter writer{content};
  for (const auto& [file, text] : texts) {
    put_text(writer, file.native());
    put_text(writer, *text);
  }
  // What was noted before is not in force any more.
  return journal_.write(content) || (journal_.write({}) && false);
}

}  // namespace hirosco::supervisor
