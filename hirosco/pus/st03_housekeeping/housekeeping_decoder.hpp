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
  std::vector<double> values;        ///< `count` numbers; of a repeatedly sampled one the newest sample
};

class HousekeepingDecoder {
 public:
  explicit HousekeepingDecoder(const descriptor::Subsystem& subsystem);
  /// Values in report order. NotFound: the descriptor has no such structure; Malformed: not of its length. A structure
  /// id that several configurations use is decoded by the one whose length fits.  Realtime: allocates.
  [[nodiscard]] Result<std::vector<HousekeepingValue>> decode(Octets source_data) const;

 private:
  struct Entry {
    HousekeepingValue prototype;
    Type type{};
    std::uint32_t count{1};
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
  [[nodiscard]] static std::vector<Entry> entries_of(const descriptor::Subsystem& subsystem,
                                                     const std::vector<descriptor::ParameterRef>& references);
  std::multimap<std::uint16_t, Layout> layouts_;
};

}  // namespace hirosco::pus
