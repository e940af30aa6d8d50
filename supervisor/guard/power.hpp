// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

/// The power switches of the devices of one member (adr 0079): told again and again what they are to be, as one that hears
/// nothing switches off by itself. Each is told by all its ways, and what it says to the latest command counts, by whichever way (adr 0237).
/// Thread: under the guard's mutex.
namespace hirosco::supervisor {

class PowerSwitches {
 public:
  /// Its preferred way and the fall-backs, and how old its newest word may be, with and without real-time scheduling; 0: as old as it likes.
  struct Held {
    std::vector<std::unique_ptr<DataFlow>> ways;
    Duration silence{};
    Duration silence_reduced{};
  };
  void add(Held held);
  [[nodiscard]] bool none() const noexcept { return switches_.empty(); }
  /// Hears what they say and tells each.  Realtime: bounded, no allocation.
  void step(bool on, bool realtime, TimePoint now) noexcept;
  [[nodiscard]] bool told_on() const noexcept { return on_; }
  /// What they all say since they were told last to be something else; what is older than it may be says nothing.
  [[nodiscard]] Power said() const noexcept;

  struct Silence {
    std::uint16_t place{0};  ///< of the switch, in the order of add()
    bool falls_back{false};  ///< its words come by another way than before; false: none is young enough
  };
  /// Once each, of switches whose words have an age limit; counted from when they were told to be what they are to be.
  [[nodiscard]] std::optional<Silence> find_silence(TimePoint now) noexcept;

 private:
  struct Way {
    std::unique_ptr<DataFlow> flow;
    TimePoint heard_at{};
  };
  struct Switch {
    std::vector<Way> ways;
    Duration silence{};
    Duration silence_reduced{};
    Duration limit{};  ///< the one that holds
    std::size_t way{0};  ///< the first whose words are young enough
    std::uint32_t sequence{0};
    std::uint32_t changed_at{0};  ///< an answer to a later command knows what it is to be now
    PowerStatus last{};
    bool heard{false};
    bool other_version{false};  ///< of its newest answer
    bool too_old{false};
    bool told_silent{false};
  };
  static void hear(Switch& each, TimePoint now) noexcept;
  static void tell(Switch& each, bool on) noexcept;
  /// The first way that has said something since `since` or within the limit; as many as there are: none.
  [[nodiscard]] static std::size_t first_heard(const Switch& each, TimePoint since, TimePoint now) noexcept;

  std::vector<Switch> switches_;
  bool on_{false};
  bool begun_{false};
  TimePoint changed_at_{};
};

}  // namespace hirosco::supervisor
