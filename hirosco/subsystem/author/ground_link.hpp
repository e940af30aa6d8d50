// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "hirosco/subsystem/author/ground_transport.hpp"

namespace hirosco {

class Subsystem;

/// What a subsystem needs to be the ground link of a mission, whatever carries its packets: hands the telecommands of clients to the
/// supervisor, and says with each whether it was said behind the newest stop of everything (docs/adr/0156, 0157). The subsystem calls step() in
/// service() and telemetry() in telemetry(), open() in configure() and close() in hardware_deinit(), and has nothing else to remember.
/// Thread: the service loop. Not open: nothing comes and nothing goes.
class GroundLink final : private GroundTraffic {
 public:
  /// Told of each telecommand that the supervisor took.
  using OnTaken = std::function<void(Octets packet)>;

  /// `holder` outlives it.
  GroundLink(Subsystem& holder, OpenGroundTransport open, OnTaken on_taken = {});
  ~GroundLink() override = default;
  GroundLink(const GroundLink&) = delete;
  GroundLink& operator=(const GroundLink&) = delete;

  /// What opens the transport says, when none is open.
  Result<> open();
  [[nodiscard]] bool is_open() const noexcept { return transport_ != nullptr; }
  /// Moves what is due; never blocks.
  void step(TimePoint now);
  /// Nothing more comes in, what has come is handed over. How many packets still wait for that.
  [[nodiscard]] std::size_t finish(TimePoint now);
  void close() noexcept { transport_.reset(); }
  /// Queues a packet for every telemetry client.
  void telemetry(Octets packet);
  /// Requires: is_open().
  [[nodiscard]] const GroundTransport::Counters& counters() const { return transport_->counters(); }
  /// When step() is to be called besides.
  [[nodiscard]] ServiceWake wake() const { return transport_ ? transport_->wake() : ServiceWake{}; }

 private:
  Taken telecommand(ClientId client, Octets packet, Said said) override;
  void look_for_stop();

  Subsystem& holder_;
  OpenGroundTransport open_;
  OnTaken on_taken_;
  std::unique_ptr<GroundTransport> transport_;
  std::uint32_t known_stop_{0};  ///< PermitPage::newest_stop before this step looked for what clients have sent
};

}  // namespace hirosco
