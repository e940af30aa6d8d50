// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/communication/ground_link.hpp"

namespace hirosco {

/// The transport below the ground link: real sockets, or a simulated ground. Thread: the service loop.
class GroundTransport {
 public:
  virtual ~GroundTransport() = default;
  /// Moves what is due; never blocks.
  virtual void step(TimePoint now) = 0;
  /// The link is to be closed: nothing more comes in, what has come is handed over. How many packets still wait for that.
  [[nodiscard]] virtual std::size_t finish(TimePoint now) = 0;
  /// Queues a packet for every telemetry client.
  virtual void telemetry(Octets packet) = 0;
  [[nodiscard]] virtual const communication::LinkCounters& counters() const = 0;
  /// When `step` is to be called besides.
  [[nodiscard]] virtual ServiceWake wake() const { return {}; }
};
/// Opens a transport that hands telecommands to `traffic`; called when the configuration is applied.
using OpenGroundTransport =
    std::function<Result<std::unique_ptr<GroundTransport>>(communication::GroundTraffic& traffic)>;

/// The communication subsystem of the demonstrator (paper 5): the ground link.
[[nodiscard]] std::unique_ptr<Subsystem> make_communication(OpenGroundTransport open);

}  // namespace hirosco
