// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "hirosco/parameter/layout.hpp"
#include "hirosco/pus/packet/failure.hpp"
#include "hirosco/utilities/octets.hpp"

/// What a subsystem asks of another one (adr 0062).
namespace hirosco {

/// What became of a request.
struct RequestReport {
  enum class Stage : std::uint8_t {
    Accepted,
    Started,
    Progressed,
    Answered,   ///< a report of the service that was asked: `data`
    Completed,  ///< an end, like those below
    Refused,    ///< nothing was done
    Failed,     ///< it had begun
    TimedOut,   ///< nobody said how it ended
  };
  Stage stage{};
  std::uint32_t request{0};          ///< as request() returned it
  std::uint16_t step{0};             ///< of Progressed
  pus::FailureCode code{};           ///< of Refused and Failed
  std::string_view reason{};         ///< of every end but Completed; valid during the call, like `data`
  std::int64_t number{0};            ///< of a reason with words
  std::uint8_t subtype{0};           ///< of Answered
  Octets data{};
  [[nodiscard]] constexpr bool is_end() const noexcept { return stage >= Stage::Completed; }
};
using RequestHandler = std::function<void(const RequestReport&)>;

/// A function of another subsystem, or a request of its own services, as an author holds it: named, and bound in
/// Software-Init.
class RequestPort {
 public:
  [[nodiscard]] std::string_view subsystem() const noexcept { return subsystem_; }
  [[nodiscard]] std::string_view function() const noexcept { return function_; }
  [[nodiscard]] std::span<const NativeField> arguments() const noexcept { return arguments_; }

 protected:
  RequestPort(const char* subsystem, const char* function, std::span<const NativeField> arguments) noexcept
      : subsystem_{subsystem}, function_{function}, arguments_{arguments} {}
  RequestPort(const RequestPort&) = delete;
  RequestPort& operator=(const RequestPort&) = delete;
  ~RequestPort() = default;

 private:
  std::string_view subsystem_;
  std::string_view function_;
  std::span<const NativeField> arguments_;
};

/// `Request<double> dim_{"LAMP", "DIM"};` with one type for each <Argument> of the function, in their order: a number, an
/// enumeration or a std::array of those. `use_request(dim_, handler)` in Software-Init, `request(dim_, 0.5)` in the service
/// loop.
template <layout_detail::FieldType... Arguments>
class Request final : public RequestPort {
 public:
  static_assert(((layout_detail::ArrayOf<Arguments>::count != 0) && ...),
                "a request's arguments have a fixed length: no Sized");
  /// Both are string literals: the subsystem as <Commands> of the descriptor calls it.
  Request(const char* subsystem, const char* function) noexcept : RequestPort{subsystem, function, fields} {}

  static constexpr std::size_t values = (0 + ... + layout_detail::ArrayOf<Arguments>::count);
  /// Element by element, as the encoder of ST[08] takes them.
  [[nodiscard]] static std::array<std::optional<double>, values> flatten(const Arguments&... arguments) noexcept {
    std::array<std::optional<double>, values> all;
    [[maybe_unused]] std::size_t next = 0;
    (put(all, next, arguments), ...);
    return all;
  }

 private:
  template <class T>
  static void put(std::array<std::optional<double>, values>& all, std::size_t& next, const T& value) noexcept {
    if constexpr (layout_detail::ArrayOf<T>::value)
      for (const auto& element : value) put(all, next, element);
    else all[next++] = number(static_cast<typename layout_detail::NumberOf<T>::type>(value));
  }
  /// A number that a double would change is none: its encoder refuses it.
  template <class T>
  [[nodiscard]] static double number(T value) noexcept {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
      constexpr auto exact = T{1} << std::numeric_limits<double>::digits;
      if (value > exact) return std::numeric_limits<double>::quiet_NaN();
      if constexpr (std::is_signed_v<T>)
        if (value < -exact) return std::numeric_limits<double>::quiet_NaN();
    }
    return static_cast<double>(value);
  }
  static constexpr std::array<NativeField, sizeof...(Arguments)> fields{layout_detail::field_at<Arguments>(0)...};
};

}  // namespace hirosco
