// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/devices/imager/sky.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// A camera of 1024 x 1024 elements that looks at a sky of stars and turns as it is told to drift. Three endnodes: COMMAND takes an order
/// (exposure and window), STATUS tells temperature and shutter, IMAGE hands out the newest image in packets, each that is asked for by its
/// number. An image follows from seed, order, time and pointing alone.
class Camera final : public SimulatedDevice {
 public:
  static constexpr std::array fault_lines{
      FaultLine{"point 500 200", "looks at this place of the sky, in picture elements"},
      FaultLine{"drift 20 0", "turns by as many picture elements a second"},
      FaultLine{"temperature 45", "of the sensor, C: twice as much dark current each 10 C"},
      FaultLine{"shutter stuck", "does not open any more; free: again"},
      FaultLine{"hot 40", "so many picture elements are white, whatever they see"},
      FaultLine{"noise 8", "up to so many counts more in each picture element"},
  };
  static constexpr std::size_t packet_octets = 968;
  static constexpr std::size_t most_packets = 1200;

  Camera(FlowFactory& flows, FlowAddress address, const Settings& settings);

  /// The image that is read out, and what of.
  [[nodiscard]] std::span<const std::uint8_t> image() const noexcept { return image_; }
  [[nodiscard]] const Shot& shot() const noexcept { return shot_; }

 private:
  struct Order {
    std::uint32_t number{0};
    std::uint32_t exposure_us{0};
    SensorWindow window{};
    std::uint8_t threshold{0};
  };
  struct Packet {
    std::uint32_t start{0}, pixels{0};
    std::uint16_t octets{0};
    std::array<std::uint8_t, packet_octets> coded;
  };

  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> take_at(std::string_view endnode, OctetReader payload) noexcept override;
  void write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;

  void read_out() noexcept;
  void write_packet(OctetWriter& payload) const noexcept;

  Sky sky_;
  std::array<double, 2> point_{}, drift_per_s_{};  ///< picture elements
  double temperature_c_{20};
  bool stuck_{false};
  std::uint32_t hot_{0}, noise_{0};

  Order order_;  ///< that was taken last
  bool refused_{false};
  bool exposing_{false};
  Duration left_{};  ///< of its exposure
  Shot shot_;  ///< of the image
  std::span<const std::uint8_t> image_;
  std::vector<Packet> packets_;  ///< room for the largest image
  std::size_t packet_count_{0};
  struct Asked {
    std::uint32_t number{0};
    std::uint16_t packet{0};
  } asked_;
};

}  // namespace hirosco::simulation
