// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "hirosco/parameter/type.hpp"

/// What a PUS service takes and reports, said once: permission, words, forms, exports and the table of services read it
/// here (adr 0059). Constants of the program; a subsystem's own services stand in its descriptor.
namespace hirosco::pus {

/// How one part of a packet's data is laid out.
enum class Form : std::uint8_t {
  Number,  ///< `count` numbers of `type`
  Text,  ///< `count` octets of ASCII, ended early by zeros
  Word,  ///< length u8, then as many octets of ASCII
  Time,  ///< on-board time, 7 octets (packet/cuc.hpp)
  List,  ///< count u8, then so many times `each`
  Value,  ///< of the parameter whose id stands before it
  Arguments,  ///< of the function whose name stands before it: count u8, then argument id u8 and value each
  Rest,  ///< all that is left, which another shape describes
};

struct Part {
  std::string_view name;
  Form form{Form::Number};
  Type type{Type::Uint8};
  std::uint16_t count{1};
  const Part* each{nullptr};  ///< of a List
  std::size_t each_count{0};
  std::span<const std::string_view> names{};  ///< of the values of a Number: 0, 1, ...; empty = they have none
  [[nodiscard]] constexpr std::span<const Part> repeated() const noexcept { return {each, each_count}; }
};

/// Parts in the order in which they stand; empty = no data.
using Shape = std::span<const Part>;

[[nodiscard]] constexpr Part number(std::string_view name, Type type) noexcept {
  return {.name = name, .form = Form::Number, .type = type};
}
template <std::size_t N>
[[nodiscard]] constexpr Part list(std::string_view name, const Part (&each)[N]) noexcept {
  return {.name = name, .form = Form::List, .each = each, .each_count = N};
}

/// Who may ask for a service, and how it is passed on.
enum class Needs : std::uint8_t {
  Nothing,  ///< as mode and state permit
  Essential,  ///< forwarded first, in every mode (decision 24)
  SupervisorAsks,  ///< nobody else may ask for it (decision 10)
  SupervisorAnswers,  ///< essential, and no other subsystem has it
};

struct RequestKind {
  std::uint8_t subtype{};
  std::string_view name;
  Shape data;
  /// What it does, in words for whoever commands by name: forms, clients, `hirosco tc`. Empty: it is for programs. One with
  /// words has no data.
  std::string_view words{};
  std::uint16_t states{0x03FF};  ///< bit n set: permitted in State n
  std::optional<Needs> needs{};  ///< where it differs from its service's
};
struct ReportKind {
  std::uint8_t subtype{};
  std::string_view name;
  Shape data;
};

class Service;
class ServiceHome;

struct ServiceKind {
  std::uint8_t type{};
  std::string_view name;
  Needs needs{Needs::Nothing};
  std::span<const RequestKind> requests;
  std::span<const ReportKind> reports;
  /// Makes the service of a subsystem, of every one. Null: it is more than its surroundings that the service needs, and
  /// whoever has that makes it.
  std::unique_ptr<Service> (*make)(ServiceHome& home){nullptr};

  [[nodiscard]] constexpr const RequestKind* request(std::uint8_t subtype) const noexcept {
    const auto found = std::ranges::find(requests, subtype, &RequestKind::subtype);
    return found == requests.end() ? nullptr : &*found;
  }
  /// Of a request that it has not: the service's.
  [[nodiscard]] constexpr Needs needs_of(std::uint8_t subtype) const noexcept {
    const RequestKind* const found = request(subtype);
    return found != nullptr ? found->needs.value_or(needs) : needs;
  }
  [[nodiscard]] constexpr const ReportKind* report(std::uint8_t subtype) const noexcept {
    const auto found = std::ranges::find(reports, subtype, &ReportKind::subtype);
    return found == reports.end() ? nullptr : &*found;
  }
};

/// Lowest type of a service that a subsystem's author may define; those from 128 on are the framework's own.
inline constexpr std::uint8_t first_custom_service = 192;

}  // namespace hirosco::pus
