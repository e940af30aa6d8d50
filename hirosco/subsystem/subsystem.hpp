// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "hirosco/descriptor/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/pus/packet/failure.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/subsystem/event_port.hpp"
#include "hirosco/subsystem/ports.hpp"
#include "hirosco/subsystem/states.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// What a subsystem's author inherits and fills in (paper 4.2): one method per node of figure 4.
namespace hirosco {

class CustomService;
class GenericSubsystem;

/// Outcome of one phase of a transient state.
enum class Step : std::uint8_t { Again, Done };
inline constexpr Step again = Step::Again;
inline constexpr Step done = Step::Done;

/// The cycle that a steady state's node is called in.
struct Cycle {
  TimePoint planned{};               ///< when it was due
  Duration period{};
  std::uint64_t count{0};            ///< since the configuration was applied
  State state{State::PreOperational};
  bool first{false};                 ///< first cycle in this state
  bool active{false};                ///< Operational and not inhibited: what is put out reaches the actuators
};

/// One running execution of a function: kept by an author to report progress and completion later.
struct Call {
  pus::Request request{};
};

/// What a function handler says at once (decision 13).
struct Outcome {
  enum class Kind : std::uint8_t { Done, Running, Refused };
  Kind kind{Kind::Done};
  pus::FailureCode code{};
  Error reason{};  ///< words and number of a refusal; its text may be empty
  constexpr Outcome(Kind what, pus::FailureCode why = {}) noexcept : kind{what}, code{why} {}
  Outcome(const Result<>& result) noexcept;  // NOLINT: a handler may simply return a Result<>
};
inline constexpr Outcome running{Outcome::Kind::Running};

/// An author's own failure codes: `enum class Trouble : std::uint16_t { sensor_broken = 0x8001 };`, each named in the
/// descriptor: `<Failure code="0x8001" name="SENSOR_BROKEN"/>`.
template <class E>
concept FailureEnumeration = std::is_enum_v<E> && std::is_same_v<std::underlying_type_t<E>, std::uint16_t>;

/// `text` is a string literal; it reaches ground with `number`.
template <FailureEnumeration E>
[[nodiscard]] constexpr Outcome refused(E code, const char* text = "", std::int64_t number = 0) noexcept {
  Outcome outcome{Outcome::Kind::Refused, static_cast<pus::FailureCode>(code)};
  outcome.reason = {ErrorCode::NotPermitted, text, number};
  return outcome;
}

/// Largest number of arguments of a function.
using pus::max_function_arguments;
/// All numbers of a call in the descriptor's order, arrays element by element, as many as it declares.
using FunctionValues = Sized<double, max_function_arguments>;
using FunctionHandler = std::function<Outcome(const std::array<double, max_function_arguments>&, Call)>;

/// What a C++ type of a handler's argument can hold without changing it.
struct ArgumentRange {
  bool integer{false};
  double lowest{0.0};
  double highest{0.0};
  int digits{0};  ///< binary, of the significand
};

namespace detail {
template <class T>
[[nodiscard]] constexpr ArgumentRange range_of() noexcept {
  if constexpr (std::is_enum_v<T>) return range_of<std::underlying_type_t<T>>();
  else {
    using Limits = std::numeric_limits<T>;
    return {Limits::is_integer, static_cast<double>(Limits::lowest()), static_cast<double>(Limits::max()),
            Limits::digits};
  }
}

template <class T>
struct HandlerTraits;
template <class C, class R, class... A>
struct HandlerTraits<R (C::*)(A...) const> {
  using Answer = R;
  template <class T>
  static constexpr bool is_an_argument =
      std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Call> || std::is_same_v<T, FunctionValues>;
  static constexpr bool takes_what_a_call_brings = (is_an_argument<std::remove_cvref_t<A>> && ...);
  static constexpr bool takes_call = (std::is_same_v<std::remove_cvref_t<A>, Call> || ... || false);
  static constexpr bool takes_values = (std::is_same_v<std::remove_cvref_t<A>, FunctionValues> || ... || false);
  static constexpr std::size_t arguments = sizeof...(A) - (takes_call ? 1 : 0);
  [[nodiscard]] static constexpr auto ranges() noexcept {
    return []<std::size_t... I>(std::index_sequence<I...>) {
      return std::array<ArgumentRange, sizeof...(I)>{
          range_of<std::remove_cvref_t<std::tuple_element_t<I, std::tuple<A...>>>>()...};
    }(std::make_index_sequence<arguments>{});
  }
  template <class H, std::size_t... I>
  static Outcome invoke(const H& handler, const std::array<double, max_function_arguments>& values, const Call& call,
                        std::index_sequence<I...>) {
    using Types = std::tuple<A...>;
    if constexpr (takes_call) return handler(static_cast<std::tuple_element_t<I, Types>>(values[I])..., call);
    else return handler(static_cast<std::tuple_element_t<I, Types>>(values[I])...);
  }
};
/// Not `mutable`, not overloaded, no template.
template <class H>
concept Handler = requires { typename HandlerTraits<decltype(&H::operator())>::Answer; };
template <class R>
concept Answers = std::is_same_v<R, Result<>> || std::is_same_v<R, Outcome>;
}  // namespace detail

/// Base of every subsystem. Steady nodes run in the cycle: noexcept, no allocation, no lock, no I/O. Everything else
/// runs in the service loop.
class Subsystem {
 public:
  Subsystem() = default;
  Subsystem(const Subsystem&) = delete;
  Subsystem& operator=(const Subsystem&) = delete;
  virtual ~Subsystem() = default;

 protected:
  // --- the nodes of figure 4 ------------------------------------------------------------------------------------
  /// Entered at start and at the end: custom services start here.
  virtual Result<> offline() { return ok(); }
  /// Publishes parameters, functions, links and devices. Called again while it returns `again`, within 10 s.
  virtual Result<Step> software_init() { return done; }
  /// Powers and tests hardware.
  virtual Result<Step> hardware_init() { return done; }
  /// Pre-Operational, once per CONFIGURE: parameters, links and devices of the configuration are already in place.
  virtual Result<> configure(const descriptor::Configuration&) { return ok(); }
  virtual Result<> pre_operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> safe_operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> error_operational(const Cycle&) noexcept { return ok(); }
  virtual Result<Step> post_operational() { return done; }
  virtual Result<Step> hardware_deinit() { return done; }
  virtual Result<Step> software_deinit() { return done; }
  /// Every step of the service loop, in all states: work that is not real-time.
  virtual void service(TimePoint) {}
  /// Telemetry that the supervisor routes to this subsystem (the communication subsystem's ground link).
  virtual void telemetry(Octets) {}

  // --- in offline() ----------------------------------------------------------------------------------------------------
  /// A service of its own, which its descriptor declares; `service` lives as long as this subsystem.
  void provide(CustomService& service);

  // --- in software_init() -----------------------------------------------------------------------------------------
  /// Makes a parameter known under its descriptor name. A layout that differs from the descriptor's fails Software-Init.
  void publish(std::string_view name, ParameterCell& parameter);
  /// Names the author's view of a required set of real-time data.
  void require_link(std::string_view set, LinkInputPort& port);
  /// Names the author's view of a device.
  void use_device(std::string_view name, DevicePortBase& port);
  /// Names an event that the author raises. Arguments that differ from the descriptor's fail Software-Init.
  void use_event(EventPort& event);
  /// Gives a function of the descriptor its handler: any callable of up to eight numbers and, last, a Call if it wants
  /// to report later. Returns Result<> or Outcome. Runs at a cycle boundary; must not throw. An argument's C++ type holds
  /// every value that the descriptor permits, or Software-Init fails. One that takes FunctionValues instead takes as many
  /// numbers as the descriptor declares.
  template <class Handler>
  void on_function(std::string_view name, Handler handler) {
    static_assert(detail::Handler<Handler>,
                  "on_function: a handler is a lambda with arguments of definite types, and not mutable");
    using Traits = detail::HandlerTraits<decltype(&Handler::operator())>;
    static_assert(
        detail::Answers<typename Traits::Answer>,
        "on_function: a handler returns Result<> or Outcome: write '-> Result<>' and end with 'return ok();'");
    static_assert(
        Traits::takes_what_a_call_brings,
        "on_function: a handler takes numbers or enumerations, or FunctionValues, and last a Call if it reports later");
    using Values = std::array<double, max_function_arguments>;
    if constexpr (Traits::takes_values) {
      static_assert(Traits::arguments == 1,
                    "FunctionValues are all numbers of a call; beside them there is a Call only");
      const std::vector<ArgumentRange> ranges(declared_values(name), detail::range_of<double>());
      bind_function(name, ranges, [handler, count = ranges.size()](const Values& values, Call call) -> Outcome {
        const auto given = FunctionValues::of(std::span{values}.first(count));
        if constexpr (Traits::takes_call) return handler(given, call);
        else return handler(given);
      });
    } else {
      static_assert(Traits::arguments <= max_function_arguments);
      static constexpr auto ranges = Traits::ranges();
      bind_function(name, ranges, [handler](const Values& values, Call call) -> Outcome {
        return Traits::invoke(handler, values, call, std::make_index_sequence<Traits::arguments>{});
      });
    }
  }

  // --- in the cycle and in function handlers ----------------------------------------------------------------------
  /// Reports an event; arguments in the unit of the descriptor.  Realtime: wait-free.
  template <class... Arguments>
  void raise(const Event<Arguments...>& event, const std::type_identity_t<Arguments>&... arguments) noexcept {
    raise_encoded(event.id(), event.encode(arguments...));
  }
  /// Latches "actuators inhibited" in this cycle; released by the next entry into Operational.  Realtime: wait-free.
  void inhibit_actuators() noexcept;
  /// Later reports of a running function.  Realtime: wait-free.
  void progress(const Call& call, std::uint16_t step) noexcept;
  void finish(const Call& call) noexcept;
  /// `text` is a string literal; it reaches ground with `number`.
  template <FailureEnumeration E>
  void abort(const Call& call, E code, const char* text = "", std::int64_t number = 0) noexcept {
    abort_call(call, static_cast<pus::FailureCode>(code), {ErrorCode::Internal, text, number});
  }
  void abort(const Call& call, const Error& why) noexcept;

  // --- in the service loop ----------------------------------------------------------------------------------------
  /// Sends a telecommand that came from the ground link client `client` to the supervisor. ResourceExhausted: the
  /// supervisor is behind; offer it again.
  Result<> submit_ground_telecommand(std::uint16_t client, Octets packet);
  /// Reports an event from the service loop, in any state.
  template <class... Arguments>
  void raise_in_service(const Event<Arguments...>& event, const std::type_identity_t<Arguments>&... arguments) {
    raise_encoded_in_service(event, event.encode(arguments...));
  }
  [[nodiscard]] State state() const noexcept;
  [[nodiscard]] const descriptor::Subsystem& own_descriptor() const noexcept;

 private:
  friend class GenericSubsystem;
  friend class CycleLoop;
  /// Numbers in a call of a function of the descriptor, max_function_arguments at most.
  [[nodiscard]] std::size_t declared_values(std::string_view function) const noexcept;
  void bind_function(std::string_view name, std::span<const ArgumentRange> arguments, FunctionHandler handler);
  void raise_encoded(std::uint16_t event, Octets auxiliary) noexcept;
  void raise_encoded_in_service(const EventPort& event, Octets auxiliary);
  void abort_call(const Call& call, pus::FailureCode code, const Error& why) noexcept;
  GenericSubsystem* framework_{nullptr};
};

}  // namespace hirosco
