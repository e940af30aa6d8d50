// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/subsystem/author/handler.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

/// A PUS service of a subsystem's own (paper 4.1 "a list of services", 4.2 "custom services"), adr 0060.
namespace hirosco {

/// The service that `<CustomService name="BOOK" type="200">` of the descriptor declares. An author keeps it as a member,
/// gives each of its requests a handler and provides it in offline():
///
///   book_.on_request("READ_PAGE", [this](std::uint16_t number, Call call) -> Result<> {
///     return book_.report("PAGE", call, number, std::string_view{...}, std::array<double, 3>{...});
///   });
///   provide(book_);
///
/// A handler is one as on_function() has it, with the <Argument>s of its <Request>; a report has its <Field>s. But it runs in
/// the service loop: it must not wait, and what it takes from the heap in Safe-Operational and Operational is told (adr 0220). Types are
/// compared with the descriptor; every difference fails Software-Init.
///
/// `<Service name="BOOK" loop="SLOW"/>` gives it a loop of its own (adr 0096): handlers and on_step() run in that thread, at its period
/// and priority. There they may use the service itself (report(), raise(), store(), finish(), abort(), state()), what is the
/// service's alone, `snapshot()` of every parameter, and resources() outside of Offline. Everything else of the subsystem is the other loops'.
/// Thread: its loop's.
class CustomService final : public pus::Service {
 public:
  explicit CustomService(std::string_view name) : name_{name} {}

  template <class Handler>
  void on_request(std::string_view request, Handler handler) {
    bind(request, detail::bound(std::move(handler)));
  }

  /// Called in each step of its loop: each period of one of its own, else as often as Subsystem::service().
  void on_step(std::function<void(TimePoint)> work) { work_ = std::move(work); }

  /// Sets a parameter of the subsystem at the next cycle boundary, whole, from whichever loop. NotFound: it is not published;
  /// ResourceExhausted: too many are on their way; Mismatch: its length is another one.
  template <class T>
  Result<> store(const Parameter<T>& parameter, const T& value) {
    const Parameter<T> wanted{value};
    std::array<std::byte, max_stored_octets> octets;
    return send_value(parameter, Octets{octets}.first(wanted.encode(wanted.fields(), octets)));
  }
  /// Reports an event of the descriptor, from whichever loop.
  template <class... Arguments>
  Result<> raise(const Event<Arguments...>& event, const std::type_identity_t<Arguments>&... arguments) {
    return send_event(event.name(), event.encode(arguments...));
  }
  /// Of the subsystem; Offline before it is provided.
  [[nodiscard]] State state() const noexcept { return home_ == nullptr ? State::Offline : home_->state(); }

  /// Sends a report to whom `to` is from: a value for each <Field>, text as std::string_view. NotFound: the descriptor declares
  /// none of this name; Mismatch: its fields are not of these types; OutOfRange, InvalidArgument: text that is longer than
  /// declared or no UTF-8; Unavailable: the service is provided to no subsystem; ResourceExhausted: the service loop is behind.
  template <class... Values>
  Result<> report(std::string_view report, const Call& to, const Values&... values) {
    static_assert((detail::SentType<Values> && ...),
                  "a report takes numbers or enumerations, bool, std::string_view for text, or a std::array of all but "
                  "text, one for each <Field>");
    static constexpr std::array<NativeField, sizeof...(Values)> types{detail::native_argument<Values>()...};
    return send(report, to, types, detail::views_of<Values...>(values...));
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
  void step(TimePoint now) override {
    if (work_) work_(now);
  }

 private:
  static constexpr std::size_t max_stored_octets = 2048;
  struct Bound {
    std::string request;
    BoundHandler handler;
  };

  void bind(std::string_view request, BoundHandler handler);
  [[nodiscard]] Result<> send(std::string_view report, const Call& to, std::span<const NativeField> types,
                              pus::GivenValues values);
  [[nodiscard]] Result<> send_value(const ParameterCell& parameter, Octets big_endian);
  [[nodiscard]] Result<> send_event(std::string_view event, Octets auxiliary);
  [[nodiscard]] bool is_open(const Call& call) const;
  /// False when it has had its final report.
  bool close(const Call& call);

  std::string name_;
  pus::ServiceHome* home_{nullptr};
  const descriptor::CustomService* declared_{nullptr};
  pus::ServiceKind kind_{};
  std::vector<Bound> bound_;
  std::function<void(TimePoint)> work_;
  std::vector<pus::Request> open_;
};

}  // namespace hirosco
