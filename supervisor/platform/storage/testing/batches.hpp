// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// Telecommands with numbers from `first` to `last`, each stored a second after the one before it.
inline std::vector<LogRecord> batch_of(std::uint64_t first, std::uint64_t last, std::size_t packet_octets = 0) {
  std::vector<LogRecord> batch;
  for (std::uint64_t number = first; number <= last; ++number)
    batch.push_back({.run = OnboardTime{Duration{7}},
                     .number = number,
                     .stored = OnboardTime{std::chrono::seconds{number}},
                     .kind = LogKind::TelecommandReceived,
                     .packet = std::vector<std::byte>(packet_octets, std::byte{0x5A})});
  return batch;
}

/// How many numbers records and gaps speak of.
inline std::uint64_t covered(const LogPage& page) {
  std::uint64_t sum = 0;
  for (const LogRecord& record : page.records) sum += record.kind == LogKind::Gap ? record.lost : 1;
  return sum;
}

}  // namespace hirosco::supervisor
