// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/waiting_for_disk.hpp"

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

}  // namespace hirosco::supervisor
