// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "hirosco/parameter/layout.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/subsystem/subsystem.hpp"

/// A PUS service of a subsystem's own (paper 4.1 "a list of services", 4.2 "custom services"), adr 0060.
namespace hirosco {

/// The service that `<CustomService name="BOOK" type="200">` of the descriptor declares. An author keeps it as a member,
/// gives each of its requests a handler and provides it in offline():
///
///   struct ReadPage { std::uint16_t number; };                       // its <Request>: arguments in order
///   struct Page { std::uint16_t number; std::array<double, 3> value; };  // its <Report>: fields in order
///
///   book_.on_request("READ_PAGE", [this](const ReadPage& asked, const Call& call) {
///     return book_.report("PAGE", call, Page{asked.number, ...});
///   });
///   provide(book_);
///
/// A handler takes the arguments as one structure (a number or std::array where there is one), a Call if it reports or
/// finishes later, both or nothing, and returns Result<> or Outcome. It runs in the service loop: it may allocate, and
/// must not wait. Types are compared with the descriptor; every difference fails Software-Init.  Thread: the service loop.
class CustomService final : public pus::Service {
 public:
  explicit CustomService(std::string_view name) : name_{name} {}

  template <class Handler>
  void on_request(std::string_view request, Handler handler) {
    using Argument = typename Traits<decltype(&Handler::operator())>::Argument;
    using Takes = Traits<decltype(&Handler::operator())>;
    static_assert(detail::Answers<typename Takes::Outcome>,
                  "on_request: a handler returns Result<> or Outcome: write '-> Result<>' and end with 'return ok();'");
    if constexpr (std::is_void_v<Argument>) {
      bind(request, {}, [handler](Octets, const Call& call) -> Outcome {
        if constexpr (Takes::wants_call) return handler(call);
        else return handler();
      });
    } else {
      static constexpr auto layout = layout_of<Argument>();
      bind(request, layout, [handler](Octets data, const Call& call) -> Outcome {
        Argument argument{};
        from_wire(layout, data, std::as_writable_bytes(std::span{&argument, 1}));
        if constexpr (Takes::wants_call) return handler(argument, call);
        else return handler(argument);
      });
    }
  }

  /// Sends a report to whom `to` is from. NotFound: the descriptor declares none of this name; Mismatch: its fields are
  /// not those of `T`; Unavailable: the service is provided to no subsystem.
  template <class T>
  Result<> report(std::string_view report, const Call& to, const T& values) {
    static constexpr auto layout = layout_of<T>();
    return send(report, to, layout, std::as_bytes(std::span{&values, 1}));
  }

  /// The end of a request whose handler said `running`: exactly one. What still runs when the configuration is released
  /// is aborted.
  void finish(const Call& call);
  void abort(const Call& call, const Error& why);

  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  // --- for the subsystem -----------------------------------------------------------------------------------------------
  void join(pus::ServiceHome& home);
  /// What the author has not done, or not as the descriptor says.
  [[nodiscard]] std::vector<std::string> problems() const;
  [[nodiscard]] const pus::ServiceKind& kind() const noexcept override { return kind_; }
  void handle(const pus::TelecommandView& telecommand, const pus::Request& request) override;
  void release() noexcept override;

 private:
  using Handler = std::function<Outcome(Octets, const Call&)>;
  struct Bound {
    std::string request;
    std::span<const NativeField> arguments;
    Handler handler;
  };

  template <class T>
  struct Traits;
  template <class C, class R>
  struct Traits<R (C::*)() const> {
    using Argument = void;
    using Outcome = R;
    static constexpr bool wants_call = false;
  };
  template <class C, class R, class A>
  struct Traits<R (C::*)(A) const> {
    static constexpr bool wants_call = std::is_same_v<std::remove_cvref_t<A>, Call>;
    using Argument = std::conditional_t<wants_call, void, std::remove_cvref_t<A>>;
    using Outcome = R;
  };
  template <class C, class R, class A, class B>
  struct Traits<R (C::*)(A, B) const> {
    static_assert(std::is_same_v<std::remove_cvref_t<B>, Call>, "the second argument of a handler is a Call");
    using Argument = std::remove_cvref_t<A>;
    using Outcome = R;
    static constexpr bool wants_call = true;
  };

  static void from_wire(std::span<const NativeField> fields, Octets data, MutableOctets native) noexcept;
  void bind(std::string_view request, std::span<const NativeField> arguments, Handler handler);
  [[nodiscard]] Result<> send(std::string_view report, const Call& to, std::span<const NativeField> fields,
                              Octets native);
  [[nodiscard]] bool is_open(const Call& call) const;
  /// False when it has had its final report.
  bool close(const Call& call);

  std::string name_;
  pus::ServiceHome* home_{nullptr};
  const descriptor::CustomService* declared_{nullptr};
  pus::ServiceKind kind_{};
  std::vector<Bound> bound_;
  std::vector<pus::Request> open_;
};

}  // namespace hirosco
