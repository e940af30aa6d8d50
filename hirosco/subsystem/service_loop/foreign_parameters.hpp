// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/subsystem/service_loop/subscriber.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Parameters that have the values of other subsystems (docs/adr/0103): what is heard goes into them as what a telecommand sets does,
/// at a boundary of the cycle; what was not heard for longer than its age is what the descriptor begins it with.
/// Thread: the service loop.
class ForeignParameters {
 public:
  struct Home {
    /// Sets a parameter that this accepted; false: there is no room now.
    std::function<bool(std::uint16_t parameter, Octets big_endian)> set;
    /// Whether it could be set to this, by its type and range.
    std::function<bool(std::uint16_t parameter, Octets big_endian)> accepts;
    /// FOREIGN_UNKNOWN of this one.
    std::function<void(std::uint16_t parameter)> tell;
  };
  ForeignParameters(const descriptor::SubsystemDescriptor& described, Home home);
  ~ForeignParameters();
  ForeignParameters(const ForeignParameters&) = delete;
  ForeignParameters& operator=(const ForeignParameters&) = delete;

  /// Asks for what they come by. What is wrong in words; empty: nothing.
  [[nodiscard]] std::string use(Subscriber& subscriber);
  /// The dictionary holds what they begin with: that is what they are while nothing is known.
  void begin(const Dictionary& dictionary);
  /// `acts`: it is Safe-Operational or Operational, where what is not known is told, once until it is.
  void step(TimePoint now, bool acts);
  void forget() noexcept;

 private:
  struct Entry {
    std::uint16_t parameter{};
    std::size_t offset{};
    std::size_t octets{};
    Duration age{};
    std::vector<std::byte> unknown{};  ///< what it is while nothing is known
    TimePoint heard{};
    bool known{false};
    bool told{false};
  };
  /// Of one structure of one subsystem.
  class Port;
  [[nodiscard]] bool take(Entry& entry, Octets values);

  const descriptor::SubsystemDescriptor& descriptor_;
  Home home_;
  std::vector<Entry> entries_;
  std::vector<std::unique_ptr<Port>> ports_;
  TimePoint now_{};
};

}  // namespace hirosco
