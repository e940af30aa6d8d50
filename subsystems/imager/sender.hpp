// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/subsystem/author/custom_service.hpp"
#include "subsystems/imager/image_store.hpp"

namespace hirosco::imager {

/// Failure codes of imager.xml.
enum class Trouble : std::uint16_t {
  acquiring = 0x8001,
  no_camera = 0x8002,
  bad_window = 0x8003,
  image_gone = 0x8004,
  no_such_part = 0x8005,
  too_many_requests = 0x8006,
};

/// The downlink: the service IMAGES of imager.xml (docs/adr/0136). An image goes down in parts of 2,048 octets, each with its number, no faster
/// than SEND_RATE; before them its description, with the checksum of the whole. Requests are carried out one after the other; who lacks parts
/// asks for these. Thread: the service's loop.
class Sender {
 public:
  static constexpr std::size_t part_octets = 2048;
  static constexpr std::size_t most_waiting = 8;

  /// What is being sent: SENDING of imager.xml.
  struct Sending {
    std::uint32_t image;  ///< 0: nothing
    std::uint16_t part;  ///< that comes next
    std::uint16_t left;
    std::uint32_t sent;  ///< parts, since the start
  };

  explicit Sender(const ImageStore& store) : store_{store} { waiting_.reserve(most_waiting); }
  /// In offline(). `rate`: octets a second; `shown`: SENDING.
  void serve(CustomService& service, const Parameter<std::uint32_t>& rate, const Parameter<Sending>& shown);
  /// The configuration was given back, and what was asked with it.  Thread: any.
  void forget() noexcept { forget_.store(true); }

 private:
  struct Wanted {
    Call call;
    std::uint32_t image;
    std::uint16_t first, count;  ///< count 0: all from there on
  };

  [[nodiscard]] Outcome list(const Call& call);
  [[nodiscard]] Outcome take(const Wanted& wanted);
  [[nodiscard]] Result<> stop();
  void end_all(const Error& why);
  void step(TimePoint now);
  /// False: there was no room; the next step goes on.
  [[nodiscard]] bool describe(const ImageStore::Held& held, const Call& to);
  [[nodiscard]] bool send_part(const Call& to);
  [[nodiscard]] bool begin();
  void show();

  const ImageStore& store_;
  CustomService* service_{nullptr};
  const Parameter<std::uint32_t>* rate_{nullptr};
  const Parameter<Sending>* shown_{nullptr};
  std::atomic<bool> forget_{false};
  std::vector<Wanted> waiting_;  ///< the first is under way once there is `held_`
  std::optional<ImageStore::Held> held_;
  bool described_{false};
  std::uint16_t next_{0}, end_{0};
  std::uint32_t sent_{0};
  double allowed_octets_{0};
  std::optional<TimePoint> last_;
  TimePoint now_{};
  std::uint32_t summed_{0}, sum_{0};  ///< image and its checksum
};

[[nodiscard]] constexpr std::uint16_t parts_of(std::uint32_t octets) noexcept {
  return static_cast<std::uint16_t>((octets + Sender::part_octets - 1) / Sender::part_octets);
}

}  // namespace hirosco::imager
