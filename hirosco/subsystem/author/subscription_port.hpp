// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/subsystem/author/native_values.hpp"
#include "hirosco/subsystem/author/request_port.hpp"
#include "hirosco/utilities/octets.hpp"

/// What a subsystem hears of another one (adr 0098): its housekeeping and its events, passed on by the supervisor.
namespace hirosco {

/// A housekeeping structure or an event of another subsystem, as an author holds it: named, and bound in Software-Init.
/// Thread: the service loop.
class SubscriptionPort {
 public:
  enum class What : std::uint8_t { Structure, Event };
  [[nodiscard]] std::string_view subsystem() const noexcept { return subsystem_; }
  /// Of a structure its id.
  [[nodiscard]] std::string_view name() const noexcept { return name_; }
  [[nodiscard]] What what() const noexcept { return what_; }
  /// Empty: those that the other's descriptor declares, whatever they are.
  [[nodiscard]] const std::optional<std::span<const NativeField>>& fields() const noexcept { return fields_; }
  /// The supervisor passes it on.
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// Reports that came since Software-Init, and those among them that were of another form than declared: the ground may add
  /// parameters to a structure in flight.
  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  [[nodiscard]] std::uint64_t unreadable() const noexcept { return unreadable_; }

 protected:
  SubscriptionPort(std::string_view subsystem, std::string_view name, What what,
                   std::optional<std::span<const NativeField>> fields) noexcept
      : subsystem_{subsystem}, name_{name}, what_{what}, fields_{fields} {}
  SubscriptionPort(const SubscriptionPort&) = delete;
  SubscriptionPort& operator=(const SubscriptionPort&) = delete;
  ~SubscriptionPort() = default;

 private:
  friend class Subscriber;
  /// Its values, behind the number of the structure or event. False: they are not those of the declared fields.
  virtual bool take(Octets values) = 0;
  std::string_view subsystem_;
  std::string_view name_;
  What what_;
  std::optional<std::span<const NativeField>> fields_;
  bool active_{false};
  std::uint64_t received_{0};
  std::uint64_t unreadable_{0};
};

/// `Subscription<Meter> meter_{"LAMP", "4800"};` T: an aggregate with one member for each value of the structure, in its order: a
/// number, an enumeration, bool, a Text, or a std::array of all but text.
template <class T>
class Subscription final : public SubscriptionPort {
  static constexpr auto layout = layout_of<T>();
  static_assert(
      [] {
        for (const NativeField& field : layout)
          if (field.most != 0) return false;
        return true;
      }(),
      "what is heard has a fixed length: no Sized");

 public:
  using Handler = std::function<void(const T&)>;
  /// Both are string literals: the subsystem as <Subscribes> of the descriptor calls it.
  Subscription(const char* subsystem, const char* structure) noexcept
      : SubscriptionPort{subsystem, structure, What::Structure, layout} {}
  void handle(Handler handler) { handler_ = std::move(handler); }
  /// The newest; zeros before the first.
  [[nodiscard]] const T& value() const noexcept { return value_; }

 private:
  bool take(Octets values) override {
    if (!take_fields(values, layout, std::as_writable_bytes(std::span{&value_, 1}))) return false;
    if (handler_) handler_(value_);
    return true;
  }
  T value_{};
  Handler handler_;
};

/// `EventSubscription<std::uint8_t> burnt_out_{"LAMP", "BURNT_OUT"};` with one type for each argument, as of Event.
template <layout_detail::FieldType... Arguments>
class EventSubscription final : public SubscriptionPort {
  static_assert(((layout_detail::ArrayOf<Arguments>::count != 0) && ...),
                "an event's arguments have a fixed length: no Sized");
  static constexpr std::array<NativeField, sizeof...(Arguments)> layout{layout_detail::field_at<Arguments>(0)...};

 public:
  using Handler = std::function<void(const Arguments&...)>;
  EventSubscription(const char* subsystem, const char* event) noexcept
      : SubscriptionPort{subsystem, event, What::Event, layout} {}
  void handle(Handler handler) { handler_ = std::move(handler); }

 private:
  bool take(Octets values) override {
    OctetReader reader{values};
    const std::tuple<Arguments...> arguments{read<Arguments>(reader)...};  // braces: in their order
    if (!reader.exhausted()) return false;
    if (handler_) std::apply(handler_, arguments);
    return true;
  }
  template <class T>
  static T read(OctetReader& reader) noexcept {
    if constexpr (layout_detail::ArrayOf<T>::value) {
      T all{};
      for (auto& each : all) each = read<typename layout_detail::ArrayOf<T>::Element>(reader);
      return all;
    } else {
      return static_cast<T>(reader.get<typename layout_detail::NumberOf<T>::type>());
    }
  }
  Handler handler_;
};

/// An event, or a structure by its id, whose name is not known before the flight. Its handler has the octets of the values.
class OpenSubscription final : private detail::OwnNames, public SubscriptionPort {
 public:
  using Handler = std::function<void(Octets)>;
  OpenSubscription(std::string subsystem, What what, std::string name)
      : OwnNames{std::move(subsystem), std::move(name)}, SubscriptionPort{owner, named, what, std::nullopt} {}
  void handle(Handler handler) { handler_ = std::move(handler); }

 private:
  bool take(Octets values) override {
    if (handler_) handler_(values);
    return true;
  }
  Handler handler_;
};

}  // namespace hirosco
