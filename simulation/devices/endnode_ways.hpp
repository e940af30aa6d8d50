// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "simulation/devices/words.hpp"

namespace hirosco::simulation {

/// The flows by which one endnode of a simulated device is reached: the preferred one and its fall-backs, as one flow. It answers
/// by the one that it was asked by last, which alone wait() waits for, and each can be made to fail alone.
/// Realtime: bounded; no allocation but in fault(). Thread: one.
class EndnodeWays final : public DataFlow {
 public:
  /// Opens the device's side of all. `flows` must outlive it.
  [[nodiscard]] static Result<std::unique_ptr<EndnodeWays>> open(FlowFactory& flows,
                                                                 std::vector<FlowAddress> addresses);

  [[nodiscard]] std::size_t count() const noexcept { return ways_.size(); }
  /// By this way alone, for who looks at each. Unavailable: it is unplugged.
  [[nodiscard]] Result<Received> receive_by(std::size_t way, MutableOctets buffer) noexcept;
  [[nodiscard]] Result<> send_by(std::size_t way, Octets frame) noexcept;
  /// unplug | plug | silent | deaf | heal, or "corrupt" for `frames` frames. InvalidArgument: not one of these; what else opening says.
  [[nodiscard]] Result<> fault(std::size_t way, std::string_view what, std::uint32_t frames);
  void heal() noexcept;

 private:
  struct Way {
    FlowAddress address;
    std::unique_ptr<DataFlow> flow;  ///< null: unplugged
    bool silent{false};  ///< says nothing
    bool deaf{false};  ///< hears nothing
    std::uint32_t corrupt_frames{0};
  };
  EndnodeWays(FlowFactory& flows, std::vector<Way> ways) : flows_{flows}, ways_{std::move(ways)} {}
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override;
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override;
  [[nodiscard]] bool do_wait(Duration timeout) noexcept override;

  FlowFactory& flows_;
  std::vector<Way> ways_;
  std::size_t asked_by_{0};
};

/// The words from `at` on: N WHAT, of one way (EndnodeWays::fault). NotFound: there are none.
[[nodiscard]] Result<> fault_way(EndnodeWays* ways, const Words& words, std::size_t at);

}  // namespace hirosco::simulation
