// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/frame_protocol.hpp"

namespace hirosco {
namespace {

/// Of one cycle: what has come beyond waits for the next.
constexpr int most_pieces = 4;

class RawFlow final : public DataFlow {
 public:
  RawFlow(std::unique_ptr<DataFlow> wire, FrameProtocol& protocol) : wire_{std::move(wire)}, protocol_{protocol} {}

 private:
  /// A protocol is one for all ways to its device: whoever speaks first begins anew.
  void begin() noexcept {
    if (!std::exchange(begun_, true)) protocol_.restart();
  }

  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    HIROSCO_TRY_LET(const DeviceCommand command, read_command(frame));
    begin();
    sequence_ = command.sequence;
    epoch_ = command.epoch;
    std::array<std::byte, max_frame_octets> out;
    const std::size_t octets = std::min(protocol_.say(command, out), out.size());
    return octets == 0 ? ok() : wire_->send(Octets{out}.first(octets));
  }

  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    begin();
    Received newest;
    for (int pieces = 0; pieces < most_pieces; ++pieces) {
      std::array<std::byte, max_frame_octets> came;
      const auto received = wire_->receive(came);
      if (!received) {
        begun_ = false;
        if (newest.flow == Flow::None) return received;
        break;
      }
      newest.damaged += received->damaged;
      if (received->flow != Flow::New) break;
      const auto heard = protocol_.hear(Octets{came}.first(std::min(received->octets, came.size())));
      newest.damaged += heard.damaged;
      if (!heard.whole) continue;
      HIROSCO_TRY_LET(
          const Octets status,
          write_status(buffer,
                       {.epoch = epoch_, .sequence = sequence_, .flags = heard.flags, .payload = heard.payload}));
      newest.flow = Flow::New;
      newest.octets = status.size();
    }
    return newest;
  }

  [[nodiscard]] bool do_wait(Duration timeout) noexcept override { return wire_->wait(timeout); }

  std::unique_ptr<DataFlow> wire_;
  FrameProtocol& protocol_;
  std::uint32_t sequence_{0};
  std::uint32_t epoch_{0};
  bool begun_{false};
};

}  // namespace

std::unique_ptr<DataFlow> make_raw_flow(std::unique_ptr<DataFlow> wire, FrameProtocol& protocol) {
  return std::make_unique<RawFlow>(std::move(wire), protocol);
}

}  // namespace hirosco
