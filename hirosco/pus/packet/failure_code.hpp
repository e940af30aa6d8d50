// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::pus {

/// Failure codes of ST[01] notices (docs/failure-codes.md; 13 to 15 decision 26, 16 paper 4.3).
enum class FailureCode : std::uint16_t {
  UnknownApid = 1,
  IllegalLength = 2,
  IllegalPrimaryHeader = 3,
  IllegalPusVersion = 4,
  ErrorControl = 5,
  UnknownService = 6,
  UnknownSubtype = 7,
  DataLength = 8,
  IllegalField = 9,
  WrongState = 10,
  QueueFull = 11,
  IllegalSequenceFlags = 12,
  WrongMode = 13,
  LinkAbsent = 14,
  SetpointOwnedByLink = 15,
  PowerShort = 16,
  ForeignSource = 17,
  NotDeclared = 18,
  UnknownIdentifier = 0x0101,
  IdentifierExists = 0x0102,
  WrongStatus = 0x0103,
  CapacityExceeded = 0x0104,
  ValueNotAcceptable = 0x0105,
  InThePast = 0x0106,
  NotPermittedNow = 0x0107,
  Busy = 0x0108,
  ChecksumMismatch = 0x0109,
  SelfTestNotPassed = 0x010A,
  ExecutedInPart = 0x0201,
  ExecutionError = 0x0202,
  Timeout = 0x0203,
  Aborted = 0x0204,
  DeviceError = 0x0205,
  OutcomeUnknown = 0x0206,
};

/// Codes from here on are the author's own: its descriptor names them (<Failure>).
inline constexpr std::uint16_t first_own_failure_code = 0x8000;

/// Why something failed, in the words and with the number of whoever refused it.
struct Reason {
  ErrorCode kind{ErrorCode::Internal};
  std::int64_t number{0};
  std::string_view text{};
};

/// A failure notice: code and code-specific data.  Realtime: wait-free, trivially copyable.
class FailureNotice {
 public:
  /// Of a reason's words; longer ones are cut.
  static constexpr std::size_t max_reason_text_octets = 64;
  static constexpr std::size_t max_data_octets = 1 + 1 + 8 + max_reason_text_octets;
  FailureNotice() = default;
  explicit FailureNotice(FailureCode code) noexcept : code_{code} {}
  /// Appends a number of the failure data, big-endian.
  template <WireNumber T>
  FailureNotice& with(T value) noexcept {
    OctetWriter writer{MutableOctets{data_}.subspan(size_)};
    writer.put(value);
    size_ = static_cast<std::uint8_t>(size_ + writer.size());
    return *this;
  }
  FailureNotice& with(Octets octets) noexcept {
    OctetWriter writer{MutableOctets{data_}.subspan(size_)};
    writer.put(octets);
    size_ = static_cast<std::uint8_t>(size_ + writer.size());
    return *this;
  }
  /// Data of a failure that an author gave words or a number: 0xFF (no instruction has this index), kind of error u8,
  /// number i64, words.
  FailureNotice& because(const Reason& reason) noexcept {
    const std::string_view text = reason.text.substr(0, max_reason_text_octets);
    return with(reason_mark)
        .with(static_cast<std::uint8_t>(reason.kind))
        .with(reason.number)
        .with(std::as_bytes(std::span{text}));
  }
  static constexpr std::uint8_t reason_mark = 0xFF;
  [[nodiscard]] FailureCode code() const noexcept { return code_; }
  [[nodiscard]] Octets data() const noexcept { return Octets{data_}.first(size_); }

 private:
  FailureCode code_{FailureCode::ExecutionError};
  std::array<std::byte, max_data_octets> data_{};
  std::uint8_t size_{0};
};

/// The reason in the data of a failure; nothing where they are numbers of another kind.
[[nodiscard]] inline std::optional<Reason> reason_in(Octets data) noexcept {
  OctetReader reader{data};
  const auto mark = reader.get<std::uint8_t>();
  const auto kind = reader.get<std::uint8_t>();
  Reason reason;
  reason.number = reader.get<std::int64_t>();
  if (!reader.good() || mark != FailureNotice::reason_mark || kind > static_cast<std::uint8_t>(ErrorCode::Internal))
    return std::nullopt;
  const Octets words = reader.rest();
  if (words.size() > FailureNotice::max_reason_text_octets) return std::nullopt;
  reason.kind = static_cast<ErrorCode>(kind);
  reason.text = {reinterpret_cast<const char*>(words.data()), words.size()};
  return reason;
}

}  // namespace hirosco::pus

namespace hirosco {
template <>
struct EnumTexts<pus::FailureCode> {
  using enum pus::FailureCode;
  static constexpr auto table = enum_table<pus::FailureCode>({
      {UnknownApid, "unknown APID"},
      {IllegalLength, "illegal packet length"},
      {IllegalPrimaryHeader, "illegal primary header"},
      {IllegalPusVersion, "illegal PUS version"},
      {ErrorControl, "error control mismatch"},
      {UnknownService, "unknown service"},
      {UnknownSubtype, "unknown subtype"},
      {DataLength, "application data length"},
      {IllegalField, "illegal field value"},
      {WrongState, "not permitted in this state"},
      {QueueFull, "queue full"},
      {IllegalSequenceFlags, "illegal sequence flags"},
      {WrongMode, "not permitted in this mode"},
      {LinkAbsent, "required link absent"},
      {SetpointOwnedByLink, "setpoint owned by a link"},
      {PowerShort, "power budget exceeded"},
      {ForeignSource, "source id of somebody else"},
      {NotDeclared, "not declared by its sender's descriptor"},
      {UnknownIdentifier, "unknown identifier"},
      {IdentifierExists, "identifier already exists"},
      {WrongStatus, "wrong status"},
      {CapacityExceeded, "capacity exceeded"},
      {ValueNotAcceptable, "value not acceptable"},
      {InThePast, "time in the past"},
      {NotPermittedNow, "not permitted now"},
      {Busy, "busy"},
      {ChecksumMismatch, "checksum mismatch"},
      {SelfTestNotPassed, "required self test not passed"},
      {ExecutedInPart, "executed in part"},
      {ExecutionError, "execution error"},
      {Timeout, "timeout"},
      {Aborted, "aborted"},
      {DeviceError, "device error"},
      {OutcomeUnknown, "outcome unknown: its addressee is gone"},
  });
};
}  // namespace hirosco
