// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/layout.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/cycle/output_parameter.hpp"

/// What the cycle moves between the author's ports and devices: one slot per device of the chosen configuration. Slots are
/// built by the service loop while the cycle rests; step functions run in the cycle and are bounded.
namespace hirosco {

/// A device and its data flow.
class DeviceSlot {
 public:
  DeviceSlot(const descriptor::Device& device, const descriptor::DeviceUse& use, DevicePortBase& port,
             std::unique_ptr<DataFlow> flow, bool realtime);
  /// What of a port's C++ types differs from the device's declaration; empty when nothing does.
  [[nodiscard]] static std::string difference(const descriptor::Device& device, const DevicePortBase& port);
  [[nodiscard]] const descriptor::Device& device() const noexcept { return *device_; }
  [[nodiscard]] bool alive() const noexcept { return port_->alive_; }
  /// True in the one cycle in which the device became lost.
  [[nodiscard]] bool just_lost() const noexcept { return just_lost_; }
  /// Since its last good frame: why it counts as lost, and what came instead.
  struct Loss {
    descriptor::DeviceLoss reason{descriptor::DeviceLoss::Silent};
    std::uint32_t silent_cycles{0};
    std::uint32_t damaged{0};
    std::uint32_t wrong_size{0};
    std::uint32_t repeated{0};
    std::uint32_t let_go{0};
  };
  [[nodiscard]] Loss loss() const noexcept;
  /// Takes the newest status frame into the port. `count_silence`: whether silence counts before a first frame came.
  void read(bool count_silence) noexcept;
  /// Sends the author's output if `active`, else the declared safe values.
  void write(std::uint32_t epoch, bool active, bool stopping) noexcept;
  /// Where tell() shows; null: nowhere.  Thread: the service loop, while the cycle rests.
  void show_in(OutputParameter* told) noexcept { told_ = told; }
  enum class Telling : std::uint8_t {
    PutOut,  ///< what write() has sent
    Wish,  ///< what it would have sent in Operational
  };
  void tell(Telling what) noexcept;

 private:
  void take_frame(Octets frame) noexcept;
  /// No output leaves its declared range.
  void keep_in_range(MutableOctets payload) noexcept;
  static void count(std::uint32_t& cycles) noexcept;

  const descriptor::Device* device_;
  DevicePortBase* port_;
  std::unique_ptr<DataFlow> flow_;
  std::endian order_;
  std::uint32_t silence_limit_;
  std::uint32_t watchdog_us_;
  std::vector<LayoutField> input_layout_;
  std::vector<LayoutField> output_layout_;
  std::vector<std::byte> safe_payload_;
  std::vector<std::byte> payload_;  ///< of the author's output, within its ranges
  OutputParameter* told_{nullptr};
  bool passed_{false};  ///< what was sent is the author's
  std::vector<std::byte> frame_;
  std::uint32_t sequence_{0};
  Loss since_good_;
  bool hung_up_{false};
  std::uint32_t echoed_{0};  ///< command sequence that the newest status frame answers
  std::uint32_t epoch_{0};  ///< of the newest command
  std::uint32_t active_cycles_{0};  ///< in a row in which outputs were to reach the actuators
  bool heard_{false};
  bool just_lost_{false};
};

}  // namespace hirosco
