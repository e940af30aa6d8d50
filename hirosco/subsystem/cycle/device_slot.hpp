// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/resource/quota.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/cycle/output_payload.hpp"

/// What the cycle moves between the author's ports and devices: one slot per device of the chosen configuration. Slots are
/// built by the service loop while the cycle rests; step functions run in the cycle and are bounded.
namespace hirosco {

/// How long the entry into control waits for devices that begin when their subsystem does (docs/adr/0128); from then on who is silent is lost.
inline constexpr Duration first_answer_limit = std::chrono::seconds{2};

/// A device, or one endnode of it, and its data flows: the preferred one and its fall-backs, of which one is in use (adr 0079).
/// Who falls silent is left for the next fall-back, each once; that one is alive with its first answer to a command that was
/// sent to it, and until then, and until the watchdog of what was left has run out, holds_back() is true.
class DeviceSlot {
 public:
  /// One way to the device.
  struct Way {
    std::unique_ptr<DataFlow> flow;
    std::uint8_t endnode{0};  ///< 0: the preferred one, then the fall-backs in their order
    Quota::Held port{};  ///< that its flow has
  };
  /// `ways`: at least one, in their order; `sampling`: of the cycle.
  DeviceSlot(const descriptor::Device& device, const descriptor::DeviceUse& use, DevicePortBase& port,
             std::vector<Way> ways, Duration sampling, bool realtime);
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
    std::uint32_t other_version{0};
    std::uint32_t repeated{0};
    std::uint32_t let_go{0};
    std::uint32_t refused{0};
  };
  [[nodiscard]] Loss loss() const noexcept;
  /// No good frame has come since the slot was made.
  [[nodiscard]] bool never_heard() const noexcept { return !ever_heard_; }
  /// True in the one cycle in which it went over to a fall-back; loss() tells why until the next read().
  [[nodiscard]] bool just_fell_back() const noexcept { return just_fell_back_; }
  /// No actuator of the subsystem may move: what it would move on is old, or what was left may still obey.
  [[nodiscard]] bool holds_back() const noexcept { return awaits_ || left_obeys_cycles_ > 0; }
  /// The fall-back that is in use has not answered yet: what its fields say is of before.
  [[nodiscard]] bool awaits() const noexcept { return awaits_; }
  /// Nobody has answered since the slot was made, and it is not late yet.
  [[nodiscard]] bool awaits_first() const noexcept { return !heard_ && since_good_.silent_cycles < silence_limit_; }
  /// Which endnode was left last, and which is in use.
  [[nodiscard]] std::uint8_t left() const noexcept { return left_; }
  [[nodiscard]] std::uint8_t taken() const noexcept { return ways_[way_].endnode; }
  [[nodiscard]] std::uint32_t times_fallen_back() const noexcept { return port_->fall_backs_; }
  /// Takes the newest status frame into the port. `count_silence`: whether silence counts before a first frame came. `counts`: the
  /// cycle is one in which limits go on; of cycles that samples start only some are (CyclePace).
  void read(bool count_silence, bool counts = true) noexcept;
  /// Sends the author's output if `active`, else the declared safe values.
  void write(std::uint32_t epoch, bool active, bool stopping) noexcept;
  /// What write() sends.
  [[nodiscard]] OutputPayload& output() noexcept { return output_; }
  /// The cycle has another period from now on.
  void follow(Duration sampling) noexcept;

 private:
  static constexpr std::uint32_t never = 1'000'000'000;
  void take_frame(Octets frame) noexcept;
  void fall_back() noexcept;
  [[nodiscard]] bool due(DeviceMode mode, std::uint32_t epoch_before) noexcept;
  void send(DeviceMode mode, Octets payload) noexcept;
  static void count(std::uint32_t& cycles) noexcept;

  const descriptor::Device* device_;
  DevicePortBase* port_;
  std::vector<Way> ways_;
  std::size_t way_{0};  ///< in use
  std::uint8_t left_{0};
  std::endian order_;
  std::uint32_t silence_limit_;
  std::uint32_t every_;
  std::uint32_t since_sent_{0};  ///< cycles
  DeviceMode sent_mode_{DeviceMode::Off};
  std::uint32_t left_obeys_{0};  ///< cycles in which the watchdog of a way that was left runs out; 0: no actuator
  std::uint32_t left_obeys_cycles_{0};  ///< of them still to come
  std::uint32_t since_active_{never};  ///< cycles since Active was sent by the way in use
  Duration sampling_{};
  std::uint32_t watchdog_us_;
  std::vector<LayoutField> input_layout_;
  OutputPayload output_;
  std::vector<std::byte> frame_;
  std::uint32_t sequence_{0};
  Loss since_good_;
  bool hung_up_{false};
  std::uint32_t echoed_{0};  ///< command sequence that the newest status frame answers
  std::uint32_t epoch_{0};  ///< of the newest command
  std::uint32_t active_cycles_{0};  ///< in a row in which outputs were to reach the actuators
  bool heard_{false};
  bool ever_heard_{false};
  bool counts_{true};  ///< of this cycle
  bool just_lost_{false};
  bool just_fell_back_{false};
  bool awaits_{false};  ///< the first answer by a fall-back
  std::uint32_t asked_{0};  ///< sequence of the first command sent to it
};

}  // namespace hirosco
