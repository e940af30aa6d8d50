// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/native_values.hpp"

#include <algorithm>
#include <bit>

namespace hirosco {

bool take_fields(Octets wire, std::span<const NativeField> fields, MutableOctets object) noexcept {
  std::size_t wanted = 0;
  for (const NativeField& field : fields) wanted += field.octets();
  if (wire.size() != wanted) return false;
  for (const NativeField& field : fields) {
    const std::size_t octets = octets_of(field.type);
    for (std::uint32_t element = 0; element < field.count; ++element) {
      const MutableOctets place = object.subspan(field.offset + element * octets, octets);
      copy_octets(wire.first(octets), place);
      if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(place);
      if (field.type == Type::Bool) place[0] = place[0] == std::byte{0} ? std::byte{0} : std::byte{1};
      wire = wire.subspan(octets);
    }
  }
  return true;
}

}  // namespace hirosco
