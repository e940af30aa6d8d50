// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// What the simulated camera sees, as whole numbers: whoever has the same numbers reckons the same image (the flight test does, in Python).
namespace hirosco::simulation {

/// A picture element has 8 bits; a sensor has this many in a row, and rows.
inline constexpr std::uint32_t sensor_pixels = 1024;

/// What is read of the sensor: binning x binning elements become one, their sum.
struct SensorWindow {
  std::uint32_t x{0}, y{0}, width{sensor_pixels}, height{sensor_pixels};  ///< of elements
  std::uint32_t binning{1};

  [[nodiscard]] bool possible() const noexcept {
    return binning != 0 && width != 0 && height != 0 && x + width <= sensor_pixels && y + height <= sensor_pixels &&
           width % binning == 0 && height % binning == 0;
  }
  /// Of the image.
  [[nodiscard]] std::uint32_t pixels() const noexcept { return (width / binning) * (height / binning); }
};

/// Everything that an image depends on.
struct Shot {
  std::uint64_t sky{1};  ///< seed of the stars
  std::int64_t u{0}, v{0};  ///< where in the sky the sensor's first element looks, in elements
  std::uint32_t exposure_us{1000};
  std::uint32_t dark_counts{0};  ///< of each element, of its warmth
  bool shutter{true};  ///< it opened
  std::uint32_t hot{0};  ///< elements that are white, whatever they see
  std::uint32_t noise{0};  ///< each element has up to as many counts more
  std::uint32_t number{0};  ///< of the image: noise is another in each
  std::uint8_t threshold{0};  ///< what is below it is read as 0
  SensorWindow window{};
};

/// Stars as the sensor sees them. Its memory is there from the beginning.
class Sky {
 public:
  Sky() : sensor_(std::size_t{sensor_pixels} * sensor_pixels), image_(sensor_.size()) {}
  /// Rows of the window from its first element on; they stay until the next call. `shot.window` is possible.  Realtime: bounded.
  [[nodiscard]] std::span<const std::uint8_t> expose(const Shot& shot) noexcept;

 private:
  void add_stars(const Shot& shot) noexcept;
  void add(std::int64_t x, std::int64_t y, std::uint32_t counts) noexcept;

  std::vector<std::uint8_t> sensor_;
  std::vector<std::uint8_t> image_;
};

}  // namespace hirosco::simulation
