// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"
#include "subsystems/communication/tcp_transport.hpp"

/// The process shell of the communication subsystem.
int main(int argc, char** argv) {
  return hirosco::run_subsystem(argc, argv, [] { return hirosco::make_communication(hirosco::open_tcp_transport); });
}
