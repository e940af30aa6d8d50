// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "supervisor/platform/storage/database.hpp"
#include "supervisor/platform/storage/packet_log.hpp"

using namespace hirosco;
using namespace hirosco::supervisor;

int main() {
  ManualClock clock;
  auto store = std::make_unique<MemoryDatabase>();
  Database& database = *store;
  DirectPacketLog log{clock, std::move(store)};

  const std::uint64_t received = log.append({.kind = LogKind::TelecommandReceived, .peer = 11, .note = "client 1"});
  clock.advance(1ms);
  if (received == 0 || log.durable() < received) return 1;  // only now it may be forwarded
  const std::uint64_t refused =
      log.append({.kind = LogKind::TelecommandRefused, .peer = 11, .note = "not permitted in this mode"});
  if (refused != received + 1) return 1;

  const auto page = database.read({.apid = 11, .last = 10});
  if (!page || page->records.size() != 2) return 1;
  for (const LogRecord& record : page->records) std::puts(describe(record).c_str());
  return 0;
}
