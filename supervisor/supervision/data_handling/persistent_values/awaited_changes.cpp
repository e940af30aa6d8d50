// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/awaited_changes.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::size_t noted_octets(const AwaitedChanges::Change& change) {
  constexpr std::size_t head = 2 + 4 + 2 + 1 + 2;
  return head + sizeof(std::uint32_t) * change.ids.size() + change.values.size();
}

[[nodiscard]] bool is_end_of(const AwaitedChanges::Change& change, const pus::TelemetryView& report) {
  return change.source == report.destination() &&
         change.request == OctetReader{report.source_data()}.get<std::uint32_t>();
}

}  // namespace

bool AwaitedChanges::add(Change change) {
  std::size_t octets = noted_octets(change);
  for (const Change& each : changes_) octets += noted_octets(each);
  if (changes_.size() == most || octets > most_octets) return false;
  changes_.push_back(std::move(change));
  return true;
}

std::optional<AwaitedChanges::Change> AwaitedChanges::take(std::uint16_t from, const pus::TelemetryView& end) {
  const auto found =
      std::ranges::find_if(changes_, [&](const Change& each) { return each.apid == from && is_end_of(each, end); });
  if (found == changes_.end()) return std::nullopt;
  Change taken = std::move(*found);
  changes_.erase(found);
  return taken;
}

const AwaitedChanges::Change* AwaitedChanges::told_as_unknown(const pus::TelemetryView& end) const {
  const auto found = std::ranges::find_if(changes_, [&](const Change& each) { return is_end_of(each, end); });
  return found != changes_.end() ? &*found : nullptr;
}

AwaitedChanges::Ids AwaitedChanges::take_all_of(std::uint16_t apid) {
  Ids of_functions;
  std::erase_if(changes_, [&](Change& each) {
    if (each.apid != apid) return false;
    if (each.values.empty()) of_functions.merge(each.ids);
    return true;
  });
  return of_functions;
}

void AwaitedChanges::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint16_t>(changes_.size()));
  for (const Change& each : changes_) {
    writer.put(each.apid).put(each.request).put(each.source).put(static_cast<std::uint8_t>(each.ids.size()));
    for (const std::uint32_t id : each.ids) writer.put(id);
    writer.put(static_cast<std::uint16_t>(each.values.size())).put(Octets{each.values});
  }
}

void AwaitedChanges::recall(OctetReader& reader) {
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    Change each;
    each.apid = reader.get<std::uint16_t>();
    each.request = reader.get<std::uint32_t>();
    each.source = reader.get<std::uint16_t>();
    for (auto more = reader.get<std::uint8_t>(); more > 0; --more) each.ids.insert(reader.get<std::uint32_t>());
    const Octets values = reader.get(reader.get<std::uint16_t>());
    each.values.assign(values.begin(), values.end());
    if (reader.good()) changes_.push_back(std::move(each));
  }
}

}  // namespace hirosco::supervisor
