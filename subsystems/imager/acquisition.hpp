// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/utilities/time.hpp"
#include "subsystems/imager/image_store.hpp"
#include "subsystems/imager/readout.hpp"

namespace hirosco::imager {

/// One image at a time on its way from the camera into the store: ordered, asked for packet by packet, kept, and lent to who looks by the link. It
/// reports nothing: it says what has become of the image.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Acquisition {
 public:
  enum class Fate : std::uint8_t {
    UnderWay,
    Kept,
    Refused,  ///< by the camera
    Lost,  ///< its packets did not come
  };

  /// `store`: where images are kept.
  explicit Acquisition(ImageStore& store) noexcept : store_{store} {}

  /// Endnodes COMMAND and IMAGE of the camera, and the set IMAGE: for use_device() and lend_link().
  [[nodiscard]] DevicePortBase& command() noexcept { return command_; }
  [[nodiscard]] DevicePortBase& packets() noexcept { return packets_; }
  [[nodiscard]] LoanOutputPort& lent() noexcept { return lent_; }

  /// Orders an image; `threshold`: what is darker is read as 0. False, and nothing is ordered: all places of the store are being read.
  [[nodiscard]] bool begin(TimePoint now, const Window& window, float exposure_ms, std::uint8_t threshold) noexcept;
  /// A cycle of the image under way. `temperature_c`: of the sensor.
  [[nodiscard]] Fate read_out(TimePoint now, float temperature_c) noexcept;
  /// An image that is under way is not kept.
  void give_up() noexcept { under_way_ = false; }
  /// Says to the camera which packet is wanted, if any: the last thing in a cycle.
  void ask() noexcept { packets_.output() = {under_way_ ? readout_.image() : 0U, readout_.ask()}; }

  /// An image is ordered, not complete.
  [[nodiscard]] bool under_way() const noexcept { return under_way_; }
  /// The newest that was ordered, and how far its packets are.
  [[nodiscard]] const Taken& image() const noexcept { return coming_; }
  [[nodiscard]] const Readout& readout() const noexcept { return readout_; }
  /// Since the start.
  [[nodiscard]] std::uint32_t wrong_packets() const noexcept { return wrong_; }

 private:
  // Structures of imager.xml: same members, same order.
  struct Order {
    std::uint32_t image;
    float exposure_ms;
    std::uint16_t x, y, width, height;
    std::uint8_t binning, threshold;
  };
  struct OrderTaken {
    std::uint32_t image;
    std::uint8_t refused;
  };
  struct Ask {
    std::uint32_t image;
    std::uint16_t packet;
  };
  struct Packet {
    std::uint32_t image;
    std::uint8_t shutter;
    std::uint16_t packets, packet;
    std::uint32_t start, pixels;
    std::uint16_t octets;
    std::array<std::uint8_t, packet_octets> coded;
  };
  /// IMAGE of imager.xml, as it is lent.
  struct Lent {
    std::uint32_t number;
    std::uint16_t width, height, x, y;
    std::uint8_t binning, shutter;
    float exposure_ms;
    std::array<std::uint8_t, most_pixels> pixel;
  };

  void take_packet(TimePoint now) noexcept;
  void keep(float temperature_c) noexcept;

  ImageStore& store_;
  DevicePort<OrderTaken, Order> command_;
  DevicePort<Packet, Ask> packets_;
  LoanOutput<Lent> lent_;
  bool under_way_{false};
  Readout readout_;
  MutableOctets place_;  ///< of the image under way
  Lent* lent_place_{nullptr};
  Taken coming_;
  TimePoint lost_at_{};
  std::uint32_t number_{0}, wrong_{0};
};

}  // namespace hirosco::imager
