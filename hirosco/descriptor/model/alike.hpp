// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// What of two texts of one descriptor is the same: by that it is compared, and what is the same is not written (in_flight.hpp).
namespace hirosco::descriptor::alike {

[[nodiscard]] inline bool same_limit(const CycleLimit& a, const CycleLimit& b) {
  return a.realtime == b.realtime && a.reduced == b.reduced;
}
[[nodiscard]] inline bool same_address(const Endnode& a, const Endnode& b) {
  return a.transfer == b.transfer && a.address == b.address && a.byte_order == b.byte_order && a.framing == b.framing;
}
[[nodiscard]] inline bool same_held(const HeldTerms& a, const HeldTerms& b) {
  return std::ranges::equal(a.fall_backs, b.fall_backs, same_address) && a.silence == b.silence &&
         a.silence_reduced == b.silence_reduced && a.goes_on == b.goes_on;
}
/// In descriptors whose parameters are the same ones in the same order.
[[nodiscard]] inline bool same_reference(const ParameterRef& a, const ParameterRef& b) {
  return a.parameter == b.parameter && a.member == b.member;
}
[[nodiscard]] inline bool same_content(const HousekeepingStructure& a, const HousekeepingStructure& b) {
  return std::ranges::equal(a.sampled_once, b.sampled_once, same_reference) &&
         std::ranges::equal(a.sampled_repeatedly, b.sampled_repeatedly,
                            [](const HousekeepingStructure::SampledSet& x, const HousekeepingStructure::SampledSet& y) {
                              return x.repetitions == y.repetitions &&
                                     std::ranges::equal(x.parameters, y.parameters, same_reference);
                            });
}
[[nodiscard]] inline bool same_structures(const std::vector<HousekeepingStructure>& a,
                                          const std::vector<HousekeepingStructure>& b) {
  return std::ranges::equal(a, b, [](const HousekeepingStructure& x, const HousekeepingStructure& y) {
    return x.id == y.id && x.interval_cycles == y.interval_cycles && x.enabled == y.enabled && same_content(x, y);
  });
}
[[nodiscard]] inline bool same_outputs(const Device& a, const Device& b) {
  return std::ranges::equal(a.output, b.output, [](const Device::Output& x, const Device::Output& y) {
    return x.safe == y.safe && x.field.minimum == y.field.minimum && x.field.maximum == y.field.maximum;
  });
}
/// But for which device it is.
[[nodiscard]] inline bool same_use(const DeviceUse& a, const DeviceUse& b) {
  return same_limit(a.silence, b.silence) && a.every == b.every && a.watchdog_us == b.watchdog_us &&
         a.watchdog_reduced_us == b.watchdog_reduced_us && same_address(a.endnode, b.endnode) &&
         std::ranges::equal(a.fall_backs, b.fall_backs, same_address) &&
         std::ranges::equal(a.settings, b.settings, {}, &Setting::value, &Setting::value);
}

}  // namespace hirosco::descriptor::alike
