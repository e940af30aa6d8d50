// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"
#include "subsystems/imager/readout.hpp"

namespace hirosco::imager {

/// What is known of an image beside its pixels.
struct Taken {
  std::uint32_t number{0};  ///< counts from 1
  TimePoint exposed{};  ///< when the camera had its order
  Window window{};
  float exposure_ms{0};
  float temperature_c{0};
  std::uint8_t shutter{0};  ///< 1: it opened

  [[nodiscard]] std::uint32_t octets() const noexcept { return window.pixels(); }
};

/// The newest images, whole. The cycle makes the next one in the place of the oldest that nobody reads; whoever reads one holds it, and it stays.
/// All memory is there from the beginning.
class ImageStore {
  struct Place {
    std::atomic<std::uint32_t> number{0};  ///< 0: no image, or one that is being made
    std::atomic<std::uint32_t> readers{0};
    Taken taken;
    std::vector<std::byte> pixels = std::vector<std::byte>(most_pixels);
  };

 public:
  static constexpr std::size_t places = 4;

  /// An image that stays as long as this.
  class Held {
   public:
    Held(const ImageStore& store, std::size_t place) noexcept : store_{&store}, place_{place} {}
    Held(Held&& other) noexcept : store_{std::exchange(other.store_, nullptr)}, place_{other.place_} {}
    Held& operator=(Held&& other) noexcept {
      std::swap(store_, other.store_);
      std::swap(place_, other.place_);
      return *this;
    }
    ~Held() {
      if (store_ != nullptr) store_->places_[place_].readers.fetch_sub(1);
    }
    [[nodiscard]] const Taken& taken() const noexcept { return store_->places_[place_].taken; }
    [[nodiscard]] Octets pixels() const noexcept {
      return Octets{store_->places_[place_].pixels}.first(taken().octets());
    }

   private:
    const ImageStore* store_;
    std::size_t place_;
  };

  // --- the cycle -------------------------------------------------------------------------------------------------------
  /// Where the next image is made; the oldest one is gone by that. Empty: all are held.  Realtime: bounded.
  [[nodiscard]] MutableOctets begin() noexcept {
    if (begun_) return places_[*begun_].pixels;
    std::array<bool, places> tried{};
    for (std::size_t round = 0; round < places; ++round) {
      std::size_t oldest = places;
      for (std::size_t i = 0; i < places; ++i)
        if (!tried[i] && (oldest == places || places_[i].number.load() < places_[oldest].number.load())) oldest = i;
      tried[oldest] = true;
      if (places_[oldest].readers.load() != 0) continue;
      // First it is no image any more, then it is seen who has it: hold() does it the other way round.
      const std::uint32_t number = places_[oldest].number.exchange(0);
      if (places_[oldest].readers.load() == 0) {
        begun_ = oldest;
        return places_[oldest].pixels;
      }
      places_[oldest].number.store(number);
    }
    return {};
  }
  /// What was begun is an image from now on.  Realtime: wait-free.
  void keep(const Taken& taken) noexcept {
    if (!begun_) return;
    places_[*begun_].taken = taken;
    places_[*begun_].number.store(taken.number);
    begun_.reset();
  }

  // --- one other thread ------------------------------------------------------------------------------------------------
  /// The numbers of those that are there, oldest first; 0 behind them.
  [[nodiscard]] std::array<std::uint32_t, places> numbers() const noexcept;
  /// Nothing: it is gone, or was never there. 0: the newest.
  [[nodiscard]] std::optional<Held> hold(std::uint32_t number) const noexcept;

 private:
  mutable std::array<Place, places> places_;
  std::optional<std::size_t> begun_;  ///< of the cycle
};

}  // namespace hirosco::imager
