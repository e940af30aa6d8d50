// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
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
/// the service loop: it may allocate, and must not wait. Types are compared with the descriptor; every difference fails
/// Software-Init.  Thread: the service loop.
class CustomService final : public pus::Service {
 public:
  explicit CustomService(std::string_view name) : name_{name} {}

  template <class Handler>
  void on_request(std::string_view request, Handler handler) {
    bind(request, detail::bound(std::move(handler)));
  }

  /// Sends a report to whom `to` is from: a value for each <Field>, text as std::string_view. NotFound: the descriptor declares
  /// none of this name; Mismatch: its fields are not of these types; OutOfRange, InvalidArgument: text that is longer than
  /// declared or no UTF-8; Unavailable: the service is provided to no subsystem.
  template <class... Values>
  Result<> report(std::string_view report, const Call& to, const Values&... values) {
    static_assert((detail::SentType<Values> && ...),
                  "a report takes numbers or enumerations, bool, std::string_view for text, or a std::array of all but "
                  "text, one for each <Field>");
    static constexpr std::array<NativeField, sizeof...(Values)> types{detail::native_argument<Values>()...};
    return send(report, to, types, detail::values_of<Values...>(values...));
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
  struct Bound {
    std::string request;
    BoundHandler handler;
  };

  void bind(std::string_view request, BoundHandler handler);
  [[nodiscard]] Result<> send(std::string_view report, const Call& to, std::span<const NativeField> types,
                              pus::GivenValues values);
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
