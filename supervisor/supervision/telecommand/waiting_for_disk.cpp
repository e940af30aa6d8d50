// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/telecommand/waiting_for_disk.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

std::optional<WaitingForDisk::Telecommand> WaitingForDisk::take_durable(std::uint64_t durable) {
  if (waiting_.empty() || waiting_.front().number > durable) return std::nullopt;
  return take();
}

std::optional<WaitingForDisk::Telecommand> WaitingForDisk::take_late(TimePoint now) {
  if (waiting_.empty() || now - waiting_.front().since < limit) return std::nullopt;
  return take();
}

std::optional<WaitingForDisk::Telecommand> WaitingForDisk::take() {
  if (waiting_.empty()) return std::nullopt;
  std::optional<Telecommand> oldest{std::move(waiting_.front())};
  waiting_.pop_front();
  return oldest;
}

std::optional<TimePoint> WaitingForDisk::since() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.front().since;
}

std::size_t WaitingForDisk::count_of(std::uint16_t origin) const {
  return static_cast<std::size_t>(
      std::ranges::count(waiting_, origin, [](const Telecommand& each) { return each.origin.apid(); }));
}

bool WaitingForDisk::leave_up_to(std::uint64_t number) {
  leaving_ = number;
  const auto told_of = [&](const Telecommand& each) {
    return each.number <= number && each.request.source != pus::supervisor_apid;
  };
  return std::ranges::any_of(waiting_, told_of);
}

void WaitingForDisk::note(OctetWriter& writer) const {
  const auto put = [&](std::uint16_t apid, const pus::Request& request) {
    writer.put(apid).put(request.id).put(request.source).put(request.ack);
  };
  for (const bool leaving : {false, true}) {
    const auto is_kind = [&](const Telecommand& each) {
      return (each.number <= leaving_) == leaving && each.request.source != pus::supervisor_apid;
    };
    const auto own = static_cast<std::size_t>(std::ranges::count_if(waiting_, is_kind));
    writer.put(static_cast<std::uint16_t>(own + (leaving ? 0 : waited_before_.size())));
    if (!leaving)
      for (const auto& [apid, request] : waited_before_) put(apid, request);
    for (const Telecommand& each : waiting_)
      if (is_kind(each)) put(each.apid, each.request);
  }
}

std::vector<std::pair<std::uint16_t, pus::Request>> WaitingForDisk::recall(OctetReader& reader) {
  std::vector<std::pair<std::uint16_t, pus::Request>> were_leaving;
  for (auto* const kind : {&waited_before_, &were_leaving})
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      const auto apid = reader.get<std::uint16_t>();
      const auto id = reader.get<std::uint32_t>();
      const auto source = reader.get<std::uint16_t>();
      kind->push_back({apid, {id, source, reader.get<std::uint8_t>()}});
    }
  return were_leaving;
}

std::vector<pus::Request> WaitingForDisk::take_waited_before() {
  std::vector<pus::Request> taken;
  for (const auto& [apid, request] : std::exchange(waited_before_, {})) taken.push_back(request);
  return taken;
}

}  // namespace hirosco::supervisor
