// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <string_view>

#include "hirosco/utilities/enum_text.hpp"

namespace hirosco {

/// What kind of thing went wrong. One vocabulary for the whole framework; PUS failure codes are derived from it.
enum class ErrorCode : std::uint8_t {
  InvalidArgument,   ///< the value has no meaning here
  OutOfRange,        ///< the value is outside its declared range
  NotFound,          ///< the named thing does not exist
  AlreadyExists,     ///< the name or id is taken
  NotPermitted,      ///< state, mode or right forbids it
  Unavailable,       ///< not now: peer absent, not connected, would block
  ResourceExhausted, ///< a declared limit is reached
  Malformed,         ///< outside data do not have their declared form
  Mismatch,          ///< two sides disagree (layout, epoch, version)
  Timeout,           ///< a time limit passed
  SystemFailure,     ///< the operating system refused; `value` is errno
  Internal,          ///< an invariant of ours does not hold
};

template <>
struct EnumTexts<ErrorCode> {
  static constexpr auto table = enum_table<ErrorCode>({
      {ErrorCode::InvalidArgument, "invalid argument"},
      {ErrorCode::OutOfRange, "out of range"},
      {ErrorCode::NotFound, "not found"},
      {ErrorCode::AlreadyExists, "already exists"},
      {ErrorCode::NotPermitted, "not permitted"},
      {ErrorCode::Unavailable, "unavailable"},
      {ErrorCode::ResourceExhausted, "resource exhausted"},
      {ErrorCode::Malformed, "malformed"},
      {ErrorCode::Mismatch, "mismatch"},
      {ErrorCode::Timeout, "timeout"},
      {ErrorCode::SystemFailure, "system failure"},
      {ErrorCode::Internal, "internal"},
  });
};

/// One error, trivially copyable so that a control loop can hand it over. `text` is a string literal; `value` is the
/// number that was wrong (a length, an id, errno), 0 where there is none.
struct Error {
  ErrorCode code{ErrorCode::Internal};
  const char* text{""};
  std::int64_t value{0};
};

/// The outcome of whatever can fail outside our control. `Result<>` carries nothing on success.
template <class T = void>
using Result = std::expected<T, Error>;

/// `return fail(ErrorCode::OutOfRange, "joint limit", 3);`  Realtime: wait-free.
[[nodiscard]] constexpr std::unexpected<Error> fail(ErrorCode code, const char* text, std::int64_t value = 0) noexcept {
  return std::unexpected<Error>(Error{code, text, value});
}
[[nodiscard]] constexpr std::unexpected<Error> fail(const Error& error) noexcept {
  return std::unexpected<Error>(error);
}

/// Success of a `Result<>`.  Realtime: wait-free.
[[nodiscard]] constexpr Result<> ok() noexcept { return {}; }

/// What a read found: nothing yet, the same as before, or something new. Receiving nothing is not an error.
enum class Flow : std::uint8_t { None, Old, New };

}  // namespace hirosco

#define HIROSCO_JOIN_(a, b) a##b
#define HIROSCO_JOIN(a, b) HIROSCO_JOIN_(a, b)
/// Passes an error of `expression` (a `Result<>`) up.
#define HIROSCO_TRY(expression)                                                                    \
  if (auto HIROSCO_JOIN(try_, __LINE__) = (expression); !HIROSCO_JOIN(try_, __LINE__).has_value()) \
  return ::hirosco::fail(HIROSCO_JOIN(try_, __LINE__).error())
/// Declares `declaration` from the value of `expression`, or passes the error up.
#define HIROSCO_TRY_LET(declaration, expression)                                                               \
  auto HIROSCO_JOIN(let_, __LINE__) = (expression);                                                            \
  if (!HIROSCO_JOIN(let_, __LINE__).has_value()) return ::hirosco::fail(HIROSCO_JOIN(let_, __LINE__).error()); \
  declaration = std::move(*HIROSCO_JOIN(let_, __LINE__))
