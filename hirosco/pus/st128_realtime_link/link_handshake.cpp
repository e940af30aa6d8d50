// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/pus/st128_realtime_link/detail/handshake_items.hpp"

namespace hirosco::pus::st128 {
namespace {

using descriptor::ByteOrder;
using detail::Item;
using detail::sample_octets;

[[nodiscard]] std::string text_of(const OfferedField& field) {
  std::string text{to_text(field.type)};
  return field.count == 1 ? text : text + "[" + std::to_string(field.count) + "]";
}

[[nodiscard]] std::unexpected<Refusal> refuse(Item item, std::string text) {
  return std::unexpected{Refusal{static_cast<std::uint8_t>(item), std::move(text)}};
}

template <class E>
[[nodiscard]] std::string list_text(const std::vector<E>& list) {
  std::string text;
  for (const E value : list) text += (text.empty() ? "" : ", ") + std::string{to_text(value)};
  return text.empty() ? "none" : text;
}

template <class E>
[[nodiscard]] std::expected<E, Refusal> first_common(Item item, const char* what, const std::vector<E>& producer,
                                                     const std::vector<E>& consumer) {
  for (const E choice : producer)
    if (std::ranges::find(consumer, choice) != consumer.end()) return choice;
  return refuse(item, std::string{what} + ": consumer " + list_text(consumer) + ", producer " + list_text(producer));
}

/// The way that both have, or why there is none.
[[nodiscard]] std::expected<descriptor::LinkWay, Refusal> way_or_refusal(const descriptor::LinkTerms& producer,
                                                                         const descriptor::LinkTerms& consumer,
                                                                         bool wakes, const Carried& carried) {
  const auto method = first_common(Item::Method, "method", producer.methods, consumer.methods);
  if (!method) return std::unexpected{method.error()};
  const auto kind = first_common(Item::Kind, "kind", producer.kinds, consumer.kinds);
  if (!kind) return std::unexpected{kind.error()};
  if (const auto way = descriptor::first_common_way(producer, consumer, wakes, carried)) return *way;
  if (wakes && carried(*method, *kind, false))
    return refuse(Item::Wake, "wake: nothing here wakes a consumer by " + std::string{to_text(*method)});
  return refuse(Item::Method, "method and kind: nothing here carries what both sides know, as " +
                                  std::string{to_text(*method)} + " with " + std::string{to_text(*kind)});
}

[[nodiscard]] std::optional<Refusal> check_rates(Duration producer, Duration consumer) {
  if (descriptor::rates_fit(producer, consumer)) return std::nullopt;
  return Refusal{static_cast<std::uint8_t>(Item::Rate), "rate: consumer " + std::to_string(consumer.count()) +
                                                            " ns, producer " + std::to_string(producer.count()) +
                                                            " ns"};
}

[[nodiscard]] std::optional<Refusal> check_fields(const std::vector<OfferedField>& producer,
                                                  const std::vector<OfferedField>& consumer, LinkKind kind) {
  const auto refusal = [](const OfferedField& field, const std::string& reason) {
    return Refusal{static_cast<std::uint8_t>(Item::Field), "field " + field.name + ": " + reason};
  };
  for (const auto& wanted : consumer) {
    const auto offered = std::ranges::find(producer, wanted.name, &OfferedField::name);
    if (offered == producer.end()) return refusal(wanted, "consumer " + text_of(wanted) + ", producer has none");
    if (*offered != wanted) return refusal(wanted, "consumer " + text_of(wanted) + ", producer " + text_of(*offered));
  }
  // What is lent nobody scatters: both sides see the same octets.
  if (kind == LinkKind::Loaned && producer != consumer)
    return Refusal{static_cast<std::uint8_t>(Item::Field), "fields of a lent sample: the same ones in the same order"};
  const std::size_t payload = sample_octets(producer, kind);
  if (payload == 0 || payload > max_payload_octets(kind))
    return Refusal{static_cast<std::uint8_t>(Item::Field), "payload of " + std::to_string(payload) + " octets"};
  return std::nullopt;
}

[[nodiscard]] std::optional<Refusal> check_depth(const Offer& consumer, LinkKind kind, std::size_t payload) {
  if (kind != LinkKind::Queued || queue_fits(consumer.depth, static_cast<std::uint32_t>(payload))) return std::nullopt;
  return Refusal{static_cast<std::uint8_t>(Item::Depth),
                 "depth: " + std::to_string(consumer.depth) + " samples of " + std::to_string(payload) + " octets"};
}

/// FNV-1a 64 over octets.
class Hash {
 public:
  void add(std::uint64_t value, int octets) noexcept {
    for (int i = octets - 1; i >= 0; --i) add_octet(value >> 8 * i & 0xFF);
  }
  void add(std::string_view text) noexcept {
    add(text.size(), 1);
    for (const char c : text) add_octet(static_cast<unsigned char>(c));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void add_octet(std::uint64_t octet) noexcept { value_ = (value_ ^ octet) * 0x0000'0100'0000'01B3; }
  std::uint64_t value_{0xCBF2'9CE4'8422'2325};
};

}  // namespace

std::size_t detail::sample_octets(const std::vector<OfferedField>& fields, LinkKind kind) noexcept {
  NaturalLayout natural;
  std::size_t packed = 0;
  for (const auto& field : fields) {
    natural.add(field.type, field.count);
    packed += hirosco::octets_of(field.type) * field.count;
  }
  return kind == LinkKind::Loaned ? natural.octets() : packed;
}

std::uint32_t Agreement::payload_octets() const noexcept {
  return static_cast<std::uint32_t>(sample_octets(fields, kind));
}

LinkLayout Agreement::layout(std::uint32_t epoch) const noexcept {
  return {.epoch = epoch,
          .payload_octets = payload_octets(),
          .layout_hash = layout_hash(),
          .period = producer_period,
          .depth = depth,
          .wakes = wakes};
}

std::uint64_t Agreement::layout_hash() const noexcept {
  Hash hash;
  hash.add(fields.size(), 1);
  for (const auto& field : fields) {
    hash.add(field.name);
    hash.add(static_cast<std::uint64_t>(field.type), 1);
    hash.add(field.count, 4);
  }
  hash.add(static_cast<std::uint64_t>(byte_order), 1);
  hash.add(static_cast<std::uint64_t>(kind), 1);
  return hash.value();
}

std::expected<Agreement, Refusal> negotiate(const Offer& producer, const Offer& consumer, const Carried& carried) {
  const auto way = way_or_refusal(producer.terms, consumer.terms, consumer.wakes, carried);
  if (!way) return std::unexpected{way.error()};
  const auto order =
      first_common(Item::ByteOrder, "byte order", producer.terms.byte_orders, consumer.terms.byte_orders);
  if (!order) return std::unexpected{order.error()};
  constexpr auto native = std::endian::native == std::endian::little ? ByteOrder::Little : ByteOrder::Big;
  if (way->kind == LinkKind::Loaned && *order != native)
    return refuse(Item::ByteOrder, "byte order: a lent sample has the machine's, not " + std::string{to_text(*order)});
  // Who waits for samples has the rate at which they come.
  if (auto refusal = check_rates(producer.period, consumer.period); refusal && !consumer.wakes)
    return std::unexpected{*std::move(refusal)};
  if (auto refusal = check_fields(producer.fields, consumer.fields, way->kind))
    return std::unexpected{*std::move(refusal)};
  if (auto refusal = check_depth(consumer, way->kind, sample_octets(producer.fields, way->kind)))
    return std::unexpected{*std::move(refusal)};
  const std::uint32_t depth = way->kind == LinkKind::Queued ? consumer.depth : 0;
  return Agreement{way->method,     *order,          way->kind,       depth,
                   producer.period, consumer.period, producer.fields, consumer.wakes};
}

}  // namespace hirosco::pus::st128
