// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/edited_texts.hpp"

#include <charconv>
#include <span>
#include <utility>

#include "hirosco/utilities/crc32.hpp"
#include "simulation/campaign/plan.hpp"

namespace hirosco::campaign {
namespace {

/// What stands first behind these words, with `put` in front of it. False: they do not stand there.
[[nodiscard]] bool put_behind(std::string& text, std::string_view words, std::string_view put) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) return false;
  text.insert(at + words.size(), put);
  return true;
}

/// Its first interval of housekeeping, so many times.
void lengthen_interval(std::string& text, std::uint64_t times) {
  constexpr std::string_view words = "interval=\"";
  const std::size_t at = text.find(words);
  if (at == std::string::npos) return;
  const char* const begin = text.data() + at + words.size();
  std::uint64_t interval = 0;
  const auto [end, problem] = std::from_chars(begin, text.data() + text.size(), interval);
  if (problem == std::errc{})
    text.replace(at + words.size(), static_cast<std::size_t>(end - begin), std::to_string(interval * times));
}

}  // namespace

std::optional<EditedTexts::Edit> EditedTexts::edit(std::string_view member, std::string_view how) {
  const auto* described = mission_.find_subsystem(member);
  if (described == nullptr) return std::nullopt;
  const std::filesystem::path& file = described->subsystem.file;
  auto text = disk_(file);
  if (!text) return std::nullopt;
  bool sound = true;
  if (how == "faulty" || how == "forbidden") {
    if (!put_behind(*text, "sampling_us=\"", how == "faulty" ? "x" : "1")) return std::nullopt;
    sound = false;
  } else if (how != "back") {
    const auto times = number_of(how);
    if (!times || *times == 0 || *times > 1000) return std::nullopt;
    lengthen_interval(*text, *times);
    *text += "<!-- " + std::string{how} + " -->\n";
  }
  edited_[file] = *text;
  return Edit{.crc = crc32(std::as_bytes(std::span{*text})), .sound = sound};
}

descriptor::FileSource EditedTexts::source(std::function<std::string(std::string)> reads) {
  return [this, reads = std::move(reads)](const std::filesystem::path& file) -> Result<std::string> {
    const auto found = edited_.find(file);
    if (found == edited_.end()) return disk_(file);
    return reads ? reads(found->second) : found->second;
  };
}

}  // namespace hirosco::campaign
