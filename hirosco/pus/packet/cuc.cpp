// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/cuc.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace hirosco::pus {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::uint8_t epoch_1958 = 1;
constexpr std::uint8_t epoch_agency = 2;
constexpr std::uint8_t max_fine_octets = 4;
constexpr std::uint8_t max_coarse_octets = 7;
constexpr std::int64_t max_seconds = std::numeric_limits<std::int64_t>::max() / second_ns - 1;

[[nodiscard]] constexpr std::int64_t fine_of(std::int64_t ns, unsigned bits) noexcept {
  return static_cast<std::int64_t>((static_cast<std::uint64_t>(ns) << bits) / static_cast<std::uint64_t>(second_ns));
}

/// Rounds up: the first nanosecond of the interval that the fraction stands for.
[[nodiscard]] constexpr std::int64_t ns_of(std::uint64_t fine, unsigned bits) noexcept {
  return static_cast<std::int64_t>((fine * static_cast<std::uint64_t>(second_ns) + (std::uint64_t{1} << bits) - 1) >>
                                   bits);
}

void put_big_endian(MutableOctets to, std::uint64_t value) noexcept {
  for (std::size_t i = to.size(); i-- > 0; value >>= 8) to[i] = static_cast<std::byte>(value & 0xFF);
}

[[nodiscard]] std::uint64_t get_big_endian(Octets from) noexcept {
  std::uint64_t value = 0;
  for (const std::byte octet : from) value = value << 8 | std::to_integer<std::uint64_t>(octet);
  return value;
}

[[nodiscard]] bool supported(const CucFormat& format) noexcept {
  return format.coarse_octets >= 1 && format.coarse_octets <= max_coarse_octets &&
         format.fine_octets <= max_fine_octets;
}

/// One octet, or two when a count exceeds what the first can say.
[[nodiscard]] std::size_t put_p_field(MutableOctets to, const CucFormat& format) noexcept {
  const unsigned coarse = std::min<unsigned>(format.coarse_octets, 4);
  const unsigned fine = std::min<unsigned>(format.fine_octets, 3);
  const unsigned more_coarse = format.coarse_octets - coarse;
  const unsigned more_fine = format.fine_octets - fine;
  const bool extended = more_coarse + more_fine != 0;
  const unsigned epoch = format.agency_epoch ? epoch_agency : epoch_1958;
  to[0] = static_cast<std::byte>((extended ? 0x80U : 0U) | epoch << 4 | (coarse - 1) << 2 | fine);
  if (!extended) return 1;
  to[1] = static_cast<std::byte>(more_coarse << 5 | more_fine << 2);
  return 2;
}

[[nodiscard]] std::size_t p_field_octets(const CucFormat& format) noexcept {
  if (!format.p_field) return 0;
  return format.coarse_octets > 4 || format.fine_octets > 3 ? 2 : 1;
}

}  // namespace

Cuc to_cuc(OnboardTime time) noexcept {
  const std::int64_t since = std::max<std::int64_t>(time.time_since_epoch().count(), 0);
  std::int64_t coarse = since / second_ns;
  std::int64_t fine = fine_of(since % second_ns, 24);
  if (coarse > 0xFFFF'FFFF) {
    coarse = 0xFFFF'FFFF;
    fine = 0xFF'FFFF;
  }
  Cuc code;
  put_big_endian(code, static_cast<std::uint64_t>(coarse << 24 | fine));
  return code;
}

OnboardTime from_cuc(Octets code) noexcept {
  const std::uint64_t raw = get_big_endian(code.first<cuc_octets>());
  return OnboardTime{Duration{static_cast<std::int64_t>(raw >> 24) * second_ns + ns_of(raw & 0xFF'FFFF, 24)}};
}

Cuc to_relative_cuc(Duration span) noexcept {
  constexpr std::int64_t limit_s = std::int64_t{1} << 31;
  std::int64_t coarse = span.count() / second_ns;
  std::int64_t ns = span.count() % second_ns;
  if (ns < 0) {
    ns += second_ns;
    --coarse;
  }
  std::int64_t units = (coarse << 24) + fine_of(ns, 24);
  if (coarse >= limit_s) units = (limit_s << 24) - 1;
  if (coarse < -limit_s) units = -(limit_s << 24);
  Cuc code;
  put_big_endian(code, static_cast<std::uint64_t>(units));
  return code;
}

Duration from_relative_cuc(Octets code) noexcept {
  const std::uint64_t raw = get_big_endian(code.first<cuc_octets>());
  const std::int64_t units = static_cast<std::int64_t>(raw << 8) >> 8;
  return Duration{(units >> 24) * second_ns + ns_of(static_cast<std::uint64_t>(units & 0xFF'FFFF), 24)};
}

Result<std::size_t> write_cuc(MutableOctets to, const CucTime& time) noexcept {
  const CucFormat& format = time.format;
  if (!supported(format)) return fail(ErrorCode::InvalidArgument, "CUC format");
  const std::int64_t since = time.time.time_since_epoch().count();
  const std::int64_t coarse = since / second_ns;
  if (since < 0) return fail(ErrorCode::OutOfRange, "CUC before its epoch");
  if (static_cast<std::uint64_t>(coarse) >> (8U * format.coarse_octets) != 0)
    return fail(ErrorCode::OutOfRange, "CUC seconds", coarse);
  const std::size_t preamble = p_field_octets(format);
  const std::size_t total = preamble + format.coarse_octets + format.fine_octets;
  if (to.size() < total) return fail(ErrorCode::ResourceExhausted, "CUC buffer", static_cast<std::int64_t>(total));
  if (preamble != 0) std::ignore = put_p_field(to, format);
  put_big_endian(to.subspan(preamble, format.coarse_octets), static_cast<std::uint64_t>(coarse));
  put_big_endian(to.subspan(preamble + format.coarse_octets, format.fine_octets),
                 static_cast<std::uint64_t>(fine_of(since % second_ns, 8U * format.fine_octets)));
  return total;
}

Result<CucTime> read_cuc(Octets octets) noexcept {
  OctetReader reader{octets};
  const auto first = reader.get<std::uint8_t>();
  const unsigned epoch = first >> 4 & 7;
  CucFormat format{static_cast<std::uint8_t>((first >> 2 & 3) + 1), static_cast<std::uint8_t>(first & 3), true,
                   epoch == epoch_agency};
  if ((first & 0x80) != 0) {
    const auto second = reader.get<std::uint8_t>();
    if ((second & 0x80) != 0) return fail(ErrorCode::Malformed, "CUC P-field extended twice", second);
    format.coarse_octets = static_cast<std::uint8_t>(format.coarse_octets + (second >> 5 & 3));
    format.fine_octets = static_cast<std::uint8_t>(format.fine_octets + (second >> 2 & 7));
  }
  if (!reader.good() || (epoch != epoch_1958 && epoch != epoch_agency) || !supported(format))
    return fail(ErrorCode::Malformed, "CUC P-field", first);
  CucFormat bare = format;
  bare.p_field = false;
  HIROSCO_TRY_LET(const OnboardTime time, read_cuc(reader.rest(), bare));
  return CucTime{time, format};
}

Result<OnboardTime> read_cuc(Octets octets, const CucFormat& format) noexcept {
  if (format.p_field || !supported(format)) return fail(ErrorCode::InvalidArgument, "CUC format");
  if (octets.size() != std::size_t{format.coarse_octets} + format.fine_octets)
    return fail(ErrorCode::Malformed, "CUC length", static_cast<std::int64_t>(octets.size()));
  const std::uint64_t coarse = get_big_endian(octets.first(format.coarse_octets));
  if (coarse > static_cast<std::uint64_t>(max_seconds)) return fail(ErrorCode::Malformed, "CUC seconds");
  const std::uint64_t fine = get_big_endian(octets.subspan(format.coarse_octets));
  return OnboardTime{Duration{static_cast<std::int64_t>(coarse) * second_ns + ns_of(fine, 8U * format.fine_octets)}};
}

}  // namespace hirosco::pus
