// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/packet.hpp"

/// The receiving side of TM[3,25]: values by name from the descriptor, for displays, clients and tests.
namespace hirosco::pus {

/// One parameter or member of a report.
struct HousekeepingValue {
  std::string name;                  ///< "CUR_VALUES.POSITION", "DES_POSITION"
  std::string unit;
  std::vector<double> values{};  ///< `count` numbers, none of TEXT; of a repeatedly sampled one the newest sample
  Type type{Type::Double};
  std::string words{};  ///< of TEXT, what is no UTF-8 replaced

  /// Its values one after the other as people read them: "on", "'dusk'", "1.5".
  [[nodiscard]] std::vector<std::string> texts() const;
  /// As a list of JSON: of numbers, of true and false, or of one string; null for what is not finite.
  [[nodiscard]] std::string json() const;
};

class HousekeepingDecoder {
 public:
  explicit HousekeepingDecoder(const descriptor::SubsystemDescriptor& subsystem);
  /// Values in report order. NotFound: the descriptor has no such structure; Malformed: not of its length. A structure
  /// id that several configurations use is decoded by the one whose length fits.  Realtime: allocates.
  [[nodiscard]] Result<std::vector<HousekeepingValue>> decode(Octets source_data) const;

 private:
  struct Entry {
    HousekeepingValue prototype;
    std::uint32_t elements{1};
  };
  struct Layout {
    std::vector<Entry> once;
    struct Set {
      std::uint16_t repetitions{};
      std::vector<Entry> entries;
    };
    std::vector<Set> sets;
    std::size_t octets{0};
  };
  [[nodiscard]] static std::vector<Entry> entries_of(const descriptor::SubsystemDescriptor& subsystem,
                                                     const std::vector<descriptor::ParameterRef>& references);
  std::multimap<std::uint16_t, Layout> layouts_;
};

}  // namespace hirosco::pus
