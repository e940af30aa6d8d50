// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/resource_table.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "tools/hirosco/json_line.hpp"

namespace hirosco::tools {
namespace {

[[nodiscard]] std::string text_or_dash(const std::optional<std::uint64_t>& number, std::string_view unit = "") {
  return number ? fmt::format("{}{}", *number, unit) : "-";
}

struct Cells {
  std::string_view subsystem, resource, declared, now, most, share;
};
[[nodiscard]] std::string joined(const Cells& cells, Flies flies) {
  if (flies == Flies::No)
    return fmt::format("{:<20} {:<22} {:>10} {:>10} {:>7}", cells.subsystem, cells.resource, cells.declared, cells.most,
                       cells.share);
  return fmt::format("{:<18} {:<22} {:>9} {:>9} {:>9} {:>7}", cells.subsystem, cells.resource, cells.declared,
                     cells.now, cells.most, cells.share);
}

}  // namespace

std::string resource_heading(Flies flies) {
  return joined(
      {"subsystem", flies == Flies::No ? "in <Resources>" : "resource", "declared", "now", "most used", "share"},
      flies);
}

std::string resource_line(const std::string& subsystem, const ResourceRow& row, Flies flies) {
  return joined({subsystem, row.attribute, text_or_dash(row.declared), text_or_dash(row.now), std::to_string(row.high),
                 text_or_dash(row.percent(), " %")},
                flies);
}

std::string resource_json(const std::string& subsystem, const ResourceRow& row, Flies flies) {
  const auto number_or_null = [](const std::optional<std::uint64_t>& number) {
    return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json object{
      {"subsystem", subsystem}, {"resource", row.attribute}, {"declared", number_or_null(row.declared)}};
  if (flies == Flies::Yes) object["now"] = number_or_null(row.now);
  object["high"] = row.high;
  object["percent"] = number_or_null(row.percent());
  return json_line(object);
}

}  // namespace hirosco::tools
