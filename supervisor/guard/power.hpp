// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

/// The power switches of the devices of one member (adr 0079): told again and again what they are to be, as one that hears
/// nothing switches off by itself. Thread: under the guard's mutex.
namespace hirosco::supervisor {

class PowerSwitches {
 public:
  void add(std::unique_ptr<DataFlow> flow) { switches_.push_back({std::move(flow)}); }
  [[nodiscard]] bool none() const noexcept { return switches_.empty(); }
  /// Hears what they say and tells each.  Realtime: bounded, no allocation.
  void step(bool on) noexcept;
  [[nodiscard]] bool told_on() const noexcept { return on_; }
  /// What they all say since they were told last to be something else.
  [[nodiscard]] Power said() const noexcept;

 private:
  struct Switch {
    std::unique_ptr<DataFlow> flow;
    std::uint32_t sequence{0};
    std::uint32_t changed_at{0};  ///< an answer to a later command knows what it is to be now
    PowerStatus last{};
    bool other_version{false};  ///< of its newest answer
  };
  std::vector<Switch> switches_;
  bool on_{false};
};

}  // namespace hirosco::supervisor
