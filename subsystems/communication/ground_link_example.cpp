// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/wait_set.hpp"
#include "subsystems/communication/tcp_server.hpp"

using namespace hirosco;
using namespace hirosco::communication;

struct Router final : GroundTraffic {
  Taken telecommand(ClientId client, Octets packet, Said) override {
    std::printf("client %u: %zu octets\n", client, packet.size());
    return Taken::Yes;   // Later: it stays, and its client is not read, until a later step
  }
};

int main() {
  const SystemClock clock;
  Router router;
  auto server = TcpServer::open({.telemetry_port = 0, .telecommand_port = 0}, router);
  WaitSet waits;
  if (!server || !waits.add((*server)->descriptor())) return 1;
  for (int round = 0; round < 3; ++round) {
    const auto next = (*server)->step(clock.now());   // never blocks; `next` bounds the wait below
    if (!waits.wait(next ? *next - clock.now() : 1ms)) return 1;
  }
  return (*server)->counters().clients == 0 ? 0 : 1;
}
