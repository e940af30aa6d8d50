// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/subsystem/author/native_values.hpp"
#include "hirosco/subsystem/author/typed_values.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"

/// What a subsystem asks of another one (adr 0062).
namespace hirosco {

/// How long a request is waited for unless its author says otherwise, by the requester and by the supervisor's count of those that are open. Longer
/// than a slow disk may hold a telecommand back: what timed out is not carried out later.
inline constexpr Duration request_patience = std::chrono::seconds{20};

/// What became of a request.
struct RequestReport {
  enum class Stage : std::uint8_t {
    Accepted,
    Started,
    Progressed,
    Answered,  ///< a report of the service that was asked: `data`
    Completed,  ///< an end, like those below
    Refused,  ///< nothing was done
    Failed,  ///< it had begun
    TimedOut,  ///< nobody said how it ended
    StepFailed,  ///< no end: one of its steps has failed, and it goes on
  };
  Stage stage{};
  std::uint32_t request{0};  ///< as request() returned it
  std::uint16_t step{0};  ///< of Progressed and StepFailed
  pus::FailureCode code{};  ///< of Refused, Failed and StepFailed
  std::string_view reason{};  ///< of StepFailed and every end but Completed; valid during the call, like `data`
  std::int64_t number{0};  ///< of a reason with words
  std::uint8_t subtype{0};  ///< of Answered
  Octets data{};
  [[nodiscard]] constexpr bool is_end() const noexcept {
    return stage >= Stage::Completed && stage != Stage::StepFailed;
  }
};
using RequestHandler = std::function<void(const RequestReport&)>;

namespace detail {
/// Of a port that is named in flight: before the port, which looks at them.
struct OwnNames {
  OwnNames(std::string whose, std::string what) : owner{std::move(whose)}, named{std::move(what)} {}
  std::string owner, named;
};
}  // namespace detail

/// What is asked for: a function or a request of an own service, or what a service of the framework does with something that the
/// other has (adr 0098).
enum class Ask : std::uint8_t {
  Function,
  SetValue,  ///< ST[20]: its value or values, those of a structure in order
  ReadValue,  ///< ST[20]: value_in() of what is answered
  EnableHousekeeping,  ///< ST[03], of a structure by its id, as the next four
  DisableHousekeeping,
  OneShotHousekeeping,  ///< once, to the ground and to who hears it
  SetInterval,  ///< in cycles, std::uint32_t
  EnableEvent,  ///< ST[05]: its report to the ground
  DisableEvent,
};

/// A function of another subsystem, or a request of its own services, as an author holds it: named, and bound in
/// Software-Init.
class RequestPort {
 public:
  [[nodiscard]] std::string_view subsystem() const noexcept { return subsystem_; }
  [[nodiscard]] std::string_view function() const noexcept { return function_; }
  [[nodiscard]] Ask what() const noexcept { return what_; }
  /// Empty: those that the other's descriptor declares, whatever they are.
  [[nodiscard]] const std::optional<std::span<const NativeField>>& arguments() const noexcept { return arguments_; }

 protected:
  RequestPort(std::string_view subsystem, Ask what, std::string_view function,
              std::optional<std::span<const NativeField>> arguments) noexcept
      : subsystem_{subsystem}, function_{function}, what_{what}, arguments_{arguments} {}
  RequestPort(const RequestPort&) = delete;
  RequestPort& operator=(const RequestPort&) = delete;
  ~RequestPort() = default;

 private:
  std::string_view subsystem_;
  std::string_view function_;
  Ask what_;
  std::optional<std::span<const NativeField>> arguments_;
};

/// `Request<double> dim_{"LAMP", "DIM"};` with one type for each <Argument> of the function, in their order: a number, an
/// enumeration, bool, std::string_view for text, or a std::array of all but text. `use_request(dim_, handler)` in
/// Software-Init, `request(dim_, 0.5)` in the service loop.
template <class... Arguments>
class Request final : public RequestPort {
 public:
  static_assert((detail::SentType<Arguments> && ...),
                "a request takes numbers or enumerations, bool, std::string_view for text, or a std::array of all but "
                "text: no Sized, for its length is the other's descriptor's");
  /// Both are string literals: the subsystem as <Commands> of the descriptor calls it.
  Request(const char* subsystem, const char* function) noexcept
      : RequestPort{subsystem, Ask::Function, function, fields} {}
  /// Of a framework's service: `Request<double> set_{"LAMP", Ask::SetValue, "BRIGHTNESS"};`
  Request(const char* subsystem, Ask what, const char* thing) noexcept : RequestPort{subsystem, what, thing, fields} {}

 private:
  static constexpr std::array<NativeField, sizeof...(Arguments)> fields{detail::native_argument<Arguments>()...};
};

/// One whose name and form are not known before the flight: of who passes on what others have written. Its values come as they are
/// (pus::GivenValues), in the order of the other's descriptor, and are judged by that.
class OpenRequest final : private detail::OwnNames, public RequestPort {
 public:
  OpenRequest(std::string subsystem, Ask what, std::string thing)
      : OwnNames{std::move(subsystem), std::move(thing)}, RequestPort{owner, what, named, std::nullopt} {}
};

/// What Ask::ReadValue was answered with. T: the type of the parameter, or an aggregate of its members. Empty: it is not that.
template <class T>
[[nodiscard]] std::optional<T> value_in(const RequestReport& report) {
  constexpr std::size_t head_octets = 5;  // how many, and which
  static constexpr auto layout = layout_of<T>();
  T value{};
  if (report.stage != RequestReport::Stage::Answered || report.data.size() < head_octets) return std::nullopt;
  if (!take_fields(report.data.subspan(head_octets), layout, std::as_writable_bytes(std::span{&value, 1})))
    return std::nullopt;
  return value;
}

}  // namespace hirosco
