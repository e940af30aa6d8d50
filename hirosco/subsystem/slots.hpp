// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/layout.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/framework_events.hpp"
#include "hirosco/descriptor/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/subsystem/pages.hpp"
#include "hirosco/subsystem/ports.hpp"

/// What the cycle moves between the author's ports and the outside: one slot per required set, provided set and device
/// of the chosen configuration. Slots are built by the service loop while the cycle rests; step functions run in the
/// cycle and are bounded.
namespace hirosco {

/// One end of an established link: made by the service loop, used by the cycle, freed by the service loop.
struct AttachedLink {
  std::uint8_t id{0};                    ///< in the mission
  pus::st128::Agreement agreement;
  std::unique_ptr<LinkWriter> writer;    ///< producer
  std::unique_ptr<LinkReader> reader;    ///< consumer
  AttachedLink* next{nullptr};           ///< producer: of the same set; the cycle's
  std::vector<LayoutField> scatter;      ///< consumer: where each agreed field goes in the port, size 0 = unused
  std::vector<std::size_t> wire_offset;  ///< consumer: of each entry of `scatter`
  std::vector<std::byte> payload;        ///< consumer
  std::endian order{std::endian::little};
  std::uint32_t producer_cycles_per_sample{1};  ///< own cycles that one sample of a slower producer may take
};

/// A required set of real-time data.
class LinkInputSlot {
 public:
  LinkInputSlot(const descriptor::Requires& terms, LinkInputPort* port, bool realtime) noexcept;
  [[nodiscard]] const descriptor::Requires& terms() const noexcept { return *terms_; }
  [[nodiscard]] LinkInputPort* port() const noexcept { return port_; }
  [[nodiscard]] bool attached() const noexcept { return link_ != nullptr; }
  /// Prepares the scatter list of a link for the port. Mismatch: the agreement lacks a field.
  [[nodiscard]] Result<> plan(AttachedLink& link) const;
  void attach(AttachedLink* link) noexcept;
  /// Lets go of this link; of another one it keeps hold.
  void detach(const AttachedLink* link) noexcept;
  /// Reads the link into the port, in the cycle that started at `now`.
  void read(TimePoint now) noexcept;
  /// Tells how the link does.
  void tell(IncomingLink& page) const noexcept;
  /// Too old, reported faulty or absent: what a required set must not be while actuators move.
  [[nodiscard]] bool stale() const noexcept { return !port_->valid_; }
  /// Its producer or the supervisor has ended it in order: no reason for an alarm.
  [[nodiscard]] bool ended() const noexcept { return link_ == nullptr || port_->status_ == LinkStatus::Stopping; }

 private:
  const descriptor::Requires* terms_;
  LinkInputPort* port_;
  std::uint32_t age_limit_;
  AttachedLink* link_{nullptr};
  double latency_mean_ns_{0.0};
  std::uint32_t latency_max_ns_{0};
};

/// A provided set of real-time data. A set may have any number of consumers, one link each: what they get is encoded once.
class LinkOutputSlot {
 public:
  LinkOutputSlot(const descriptor::Subsystem& subsystem, const descriptor::Provides& terms, Dictionary& dictionary);
  [[nodiscard]] const descriptor::Provides& terms() const noexcept { return *terms_; }
  [[nodiscard]] const std::vector<pus::st128::OfferedField>& fields() const noexcept { return fields_; }
  void attach(AttachedLink* link) noexcept;
  void detach(AttachedLink* link) noexcept;
  void write(TimePoint now, LinkStatus status) noexcept;

 private:
  struct Source {
    const ParameterCell* cell;
    LayoutField field;
  };
  const descriptor::Provides* terms_;
  std::vector<pus::st128::OfferedField> fields_;
  std::vector<Source> sources_;
  void encode_for(std::endian order) noexcept;
  [[nodiscard]] MutableOctets payload(std::endian order) noexcept {
    return payloads_[order == std::endian::big ? 1 : 0];
  }

  std::array<std::vector<std::byte>, 2> payloads_;  ///< little and big endian
  AttachedLink* first_{nullptr};
};

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
  std::vector<std::byte> payload_;
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

/// Compares a port's C++ layout with the fields of the descriptor; empty when they agree, else what differs.
[[nodiscard]] std::string layout_difference(std::span<const NativeField> native,
                                            const std::vector<descriptor::Field>& declared);

}  // namespace hirosco
