// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// An event of the descriptor as an author holds it: named, and bound to its number in Software-Init.
class EventPort {
 public:
  [[nodiscard]] std::string_view name() const noexcept { return name_; }
  [[nodiscard]] std::span<const NativeField> arguments() const noexcept { return arguments_; }
  /// 0 before Software-Init: raised then, it is nothing.
  [[nodiscard]] std::uint16_t id() const noexcept { return id_; }
  void bind(std::uint16_t id) noexcept { id_ = id; }

 protected:
  EventPort(const char* name, std::span<const NativeField> arguments) noexcept : name_{name}, arguments_{arguments} {}
  EventPort(const EventPort&) = delete;
  EventPort& operator=(const EventPort&) = delete;
  ~EventPort() = default;

 private:
  std::string_view name_;
  std::span<const NativeField> arguments_;
  std::uint16_t id_{0};
};

/// What an event may tell.
template <class T>
concept ToldType = layout_detail::FieldType<T> || layout_detail::TextOf<T>::value;

/// `Event<std::uint8_t, double> torque_exceeded_{"TORQUE_LIMIT_EXCEEDED"};` with one type for each <Argument>, in their
/// order: a number, an enumeration, a std::array of those, or a Text. A member like a parameter: `use_event(torque_exceeded_)` in
/// Software-Init, `raise(torque_exceeded_, 1, 12.5)` in the cycle.
template <ToldType... Arguments>
class Event final : public EventPort {
 public:
  static_assert(((layout_detail::ArrayOf<Arguments>::count != 0) && ...),
                "an event's arguments have a fixed length: no Sized");
  /// `name` is a string literal.
  explicit Event(const char* name) noexcept : EventPort{name, fields} {}

  static constexpr std::size_t octets = (0 + ... + sizeof(Arguments));
  /// The auxiliary data of its report.  Realtime: wait-free.
  [[nodiscard]] static std::array<std::byte, octets> encode(const Arguments&... arguments) noexcept {
    std::array<std::byte, octets> data{};
    [[maybe_unused]] OctetWriter writer{data};
    (put(writer, arguments), ...);
    return data;
  }

 private:
  template <class T>
  static void put(OctetWriter& writer, const T& value) noexcept {
    if constexpr (layout_detail::TextOf<T>::value) {
      const std::string_view words = value.view();
      writer.put(std::as_bytes(std::span{words}));
      for (std::size_t i = words.size(); i < T::max_size(); ++i) writer.put(std::uint8_t{0});
    } else if constexpr (layout_detail::ArrayOf<T>::value) {
      for (const auto& element : value) put(writer, element);
    } else writer.put(static_cast<typename layout_detail::NumberOf<T>::type>(value));
  }
  static constexpr std::array<NativeField, sizeof...(Arguments)> fields{layout_detail::field_at<Arguments>(0)...};
};

}  // namespace hirosco
