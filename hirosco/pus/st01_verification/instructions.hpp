// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>

#include "hirosco/pus/st01_verification/verification.hpp"

/// What services share: notices of one kind, and the end of requests with several instructions.
namespace hirosco::pus {

inline constexpr std::size_t max_instructions = 255;   ///< a count N is one octet

[[nodiscard]] inline FailureNotice unknown_subtype(const TelecommandView& telecommand) noexcept {
  return FailureNotice{FailureCode::UnknownSubtype}.with(telecommand.service()).with(telecommand.subtype());
}

/// Start failure of one instruction with the data that its code has: index and identifier, index alone, or none
/// (docs/failure-codes.md).
[[nodiscard]] inline FailureNotice instruction_failure(FailureCode code, std::size_t index, std::uint32_t id) noexcept {
  FailureNotice notice{code};
  if (code == FailureCode::Busy || code == FailureCode::WrongMode) return notice;
  notice.with(static_cast<std::uint8_t>(index));
  using enum FailureCode;
  if (code == CapacityExceeded || code == InThePast || code == NotPermittedNow) return notice;
  return notice.with(id);
}

/// Reads the count of a list N x (fixed size) whose N must be 1 or more and must fill `data` exactly; the notice is that
/// of acceptance.
[[nodiscard]] inline std::expected<std::size_t, FailureNotice> list_count(Octets data,
                                                                          std::size_t octets_each) noexcept {
  if (data.empty()) return std::unexpected{FailureNotice{FailureCode::DataLength}};
  const auto count = std::to_integer<std::size_t>(data[0]);
  if (data.size() != 1 + count * octets_each) return std::unexpected{FailureNotice{FailureCode::DataLength}};
  if (count == 0) return std::unexpected{FailureNotice{FailureCode::IllegalField}.with(std::uint16_t{0})};
  return count;
}

/// Runs an accepted request of `count` instructions (at most 255) and reports its stages. All are
/// checked before the first is executed: `check(i)` gives the notice of a rejected one, `execute(i)` does a valid one,
/// `finish()` follows once after at least one was executed, before the completion.
template <class Check, class Execute, class Finish>
void run_instructions(Verification& verification, const Request& request, std::size_t count, Check&& check,
                      Execute&& execute, Finish&& finish) {
  std::bitset<max_instructions + 1> valid;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<FailureNotice> notice = check(i);
    if (notice) verification.start_failed(request, *notice);
    else valid.set(i);
  }
  const std::size_t executed = valid.count();
  if (executed == count) verification.started(request);
  if (executed == 0) return;
  for (std::size_t i = 0; i < count; ++i)
    if (valid.test(i)) execute(i);
  finish();
  if (executed == count) return verification.completed(request);
  verification.completion_failed(request, FailureNotice{FailureCode::ExecutedInPart}
                                              .with(static_cast<std::uint8_t>(executed))
                                              .with(static_cast<std::uint8_t>(count - executed)));
}
template <class Check, class Execute>
void run_instructions(Verification& verification, const Request& request, std::size_t count, Check&& check,
                      Execute&& execute) {
  run_instructions(verification, request, count, check, execute, [] {});
}

}  // namespace hirosco::pus
