// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

#include <algorithm>
#include <bit>
#include <concepts>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/layout.hpp"

namespace hirosco::pus::st128 {
namespace {

using descriptor::ByteOrder;

/// An element of the handshake; the value is Refusal::item.
enum class Item : std::uint8_t { Method = 0, ByteOrder = 1, Kind = 2, Rate = 3, Field = 4, Depth = 5, Wake = 6 };

constexpr std::size_t max_choices = 16;          ///< methods, byte orders or kinds of one offer
constexpr std::size_t max_fields = 255;
constexpr std::size_t max_text = 255;

/// Of one sample: packed, or as C++ lays an aggregate that is lent.
[[nodiscard]] std::size_t octets_of(const std::vector<OfferedField>& fields, LinkKind kind) noexcept {
  NaturalLayout natural;
  std::size_t packed = 0;
  for (const auto& field : fields) {
    natural.add(field.type, field.count);
    packed += hirosco::octets_of(field.type) * field.count;
  }
  return kind == LinkKind::Loaned ? natural.octets() : packed;
}

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

/// Method and kind go together: each alone may be common while nothing carries both.
[[nodiscard]] std::expected<std::pair<LinkMethod, LinkKind>, Refusal> first_common_way(
    const descriptor::LinkTerms& producer, const descriptor::LinkTerms& consumer, bool wakes, const Carried& carried) {
  const auto method = first_common(Item::Method, "method", producer.methods, consumer.methods);
  if (!method) return std::unexpected{method.error()};
  const auto kind = first_common(Item::Kind, "kind", producer.kinds, consumer.kinds);
  if (!kind) return std::unexpected{kind.error()};
  const auto has = [](const auto& list, auto value) { return std::ranges::find(list, value) != list.end(); };
  for (const LinkMethod by : producer.methods)
    for (const LinkKind of : producer.kinds)
      if (has(consumer.methods, by) && has(consumer.kinds, of) && carried(by, of, wakes)) return std::pair{by, of};
  if (wakes && carried(*method, *kind, false))
    return refuse(Item::Wake, "wake: nothing here wakes a consumer by " + std::string{to_text(*method)});
  return refuse(Item::Method, "method and kind: nothing here carries what both sides know, as " +
                                  std::string{to_text(*method)} + " with " + std::string{to_text(*kind)});
}

[[nodiscard]] std::optional<Refusal> check_rates(Duration producer, Duration consumer) {
  const bool positive = producer.count() > 0 && consumer.count() > 0;
  if (positive && (producer % consumer == Duration{} || consumer % producer == Duration{})) return std::nullopt;
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
  const std::size_t payload = octets_of(producer, kind);
  if (payload == 0 || payload > max_payload_octets(kind))
    return Refusal{static_cast<std::uint8_t>(Item::Field), "payload of " + std::to_string(payload) + " octets"};
  return std::nullopt;
}

/// As the reader of descriptors has it: depth goes with kind Queued, and with that alone.
[[nodiscard]] bool is_depth(std::uint32_t depth, bool queued) noexcept {
  return queued ? depth >= min_link_depth && depth <= max_link_depth : depth == 0;
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

// -- Writing: what is longer than its count can say makes the whole too long for any buffer. --------------------------

class Writer {
 public:
  explicit Writer(MutableOctets to) noexcept : out_{to} {}
  template <WireNumber T>
  void number(T value) {
    out_.put(value);
  }
  template <class E>
    requires std::is_enum_v<E>
  void enumerator(E value) {
    out_.put(static_cast<std::uint8_t>(value));
  }
  void text(std::string_view text) {
    count(text.size(), max_text);
    out_.put(std::as_bytes(std::span{text}));
  }
  void duration(Duration span) { out_.put(static_cast<std::int64_t>(span.count())); }
  template <class E>
  void choices(const std::vector<E>& list) {
    count(list.size(), max_choices);
    for (const E value : list) enumerator(value);
  }
  void fields(const std::vector<OfferedField>& list) {
    count(list.size(), max_fields);
    for (const auto& field : list) {
      text(field.name);
      enumerator(field.type);
      number(field.count);
    }
  }
  void offer(const Offer& offer) {
    text(offer.set);
    duration(offer.period);
    choices(offer.terms.methods);
    choices(offer.terms.byte_orders);
    choices(offer.terms.kinds);
    depth(offer.depth, offer.wakes);
    fields(offer.fields);
  }
  void agreement(const Agreement& agreement) {
    enumerator(agreement.method);
    enumerator(agreement.byte_order);
    enumerator(agreement.kind);
    depth(agreement.depth, agreement.wakes);
    duration(agreement.producer_period);
    duration(agreement.consumer_period);
    fields(agreement.fields);
  }
  [[nodiscard]] Result<std::size_t> finish() const {
    if (!encodable_) return fail(ErrorCode::OutOfRange, "link message: a list or text is too long");
    if (!out_.good()) return fail(ErrorCode::ResourceExhausted, "link message buffer");
    return out_.size();
  }

 private:
  void depth(std::uint32_t samples, bool wakes) {
    encodable_ = encodable_ && samples <= max_link_depth;
    out_.put(static_cast<std::uint16_t>(samples)).put(static_cast<std::uint8_t>(wakes));
  }
  void count(std::size_t size, std::size_t limit) {
    encodable_ = encodable_ && size <= limit;
    out_.put(static_cast<std::uint8_t>(size));
  }
  OctetWriter out_;
  bool encodable_{true};
};

// -- Reading: sticky failure, asked for once at the end. --------------------------------------------------------------

class Reader {
 public:
  explicit Reader(Octets data) noexcept : in_{data} {}
  template <WireNumber T>
  void number(T& value) noexcept {
    value = in_.get<T>();
  }
  template <class E>
    requires std::is_enum_v<E>
  void enumerator(E& value, std::initializer_list<E> allowed) noexcept {
    value = static_cast<E>(in_.get<std::uint8_t>());
    require(std::ranges::find(allowed, value) != allowed.end());
  }
  template <class E>
    requires requires { EnumTexts<E>::table; }
  void enumerator(E& value) noexcept {
    value = static_cast<E>(in_.get<std::uint8_t>());
    require(to_text(value) != "?");
  }
  void text(std::string& text) {
    const Octets octets = in_.get(in_.get<std::uint8_t>());
    text.assign(reinterpret_cast<const char*>(octets.data()), octets.size());
    require(std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; }));
  }
  void name(std::string& name) {
    text(name);
    require(!name.empty());
  }
  void duration(Duration& span) noexcept {
    span = Duration{in_.get<std::int64_t>()};
    require(span.count() > 0);
  }
  void depth(std::uint32_t& samples, bool queued, bool& wakes) noexcept {
    samples = in_.get<std::uint16_t>();
    const auto flag = in_.get<std::uint8_t>();
    wakes = flag == 1;
    require(is_depth(samples, queued) && flag <= 1);
  }
  template <class E>
  void choices(std::vector<E>& list) {
    const std::size_t count = in_.get<std::uint8_t>();
    require(count >= 1 && count <= max_choices);
    list.clear();
    for (std::size_t i = 0; i < count && good(); ++i) enumerator(list.emplace_back());
  }
  void fields(std::vector<OfferedField>& list) {
    const std::size_t count = in_.get<std::uint8_t>();
    require(count >= 1);
    for (std::size_t i = 0; i < count && good(); ++i) {
      OfferedField& field = list.emplace_back();
      name(field.name);
      enumerator(field.type);
      number(field.count);
      require(is_carried(field.type) && field.count >= 1);
      require(std::ranges::count(list, field.name, &OfferedField::name) == 1);
    }
  }
  void offer(Offer& offer) {
    name(offer.set);
    duration(offer.period);
    choices(offer.terms.methods);
    choices(offer.terms.byte_orders);
    choices(offer.terms.kinds);
    depth(offer.depth, std::ranges::find(offer.terms.kinds, LinkKind::Queued) != offer.terms.kinds.end(), offer.wakes);
    fields(offer.fields);
  }
  void agreement(Agreement& agreement) {
    enumerator(agreement.method);
    enumerator(agreement.byte_order);
    enumerator(agreement.kind);
    depth(agreement.depth, agreement.kind == LinkKind::Queued, agreement.wakes);
    duration(agreement.producer_period);
    duration(agreement.consumer_period);
    fields(agreement.fields);
    const std::size_t payload = octets_of(agreement.fields, agreement.kind);
    require(payload <= max_payload_octets(agreement.kind));
    require(agreement.depth == 0 || queue_fits(agreement.depth, static_cast<std::uint32_t>(payload)));
  }
  void require(bool condition) noexcept { good_ = good_ && condition; }
  [[nodiscard]] bool good() const noexcept { return good_ && in_.good(); }

  template <class T>
  [[nodiscard]] Result<T> finish(T&& value, const char* what) const {
    if (!good() || !in_.exhausted()) return fail(ErrorCode::Malformed, what, static_cast<std::int64_t>(in_.position()));
    return std::forward<T>(value);
  }

 private:
  OctetReader in_;
  bool good_{true};
};

}  // namespace

std::uint32_t Agreement::payload_octets() const noexcept { return static_cast<std::uint32_t>(octets_of(fields, kind)); }

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
  const auto way = first_common_way(producer.terms, consumer.terms, consumer.wakes, carried);
  if (!way) return std::unexpected{way.error()};
  const auto order =
      first_common(Item::ByteOrder, "byte order", producer.terms.byte_orders, consumer.terms.byte_orders);
  if (!order) return std::unexpected{order.error()};
  constexpr auto native = std::endian::native == std::endian::little ? ByteOrder::Little : ByteOrder::Big;
  if (way->second == LinkKind::Loaned && *order != native)
    return refuse(Item::ByteOrder, "byte order: a lent sample has the machine's, not " + std::string{to_text(*order)});
  // Who waits for samples has the rate at which they come.
  if (auto refusal = check_rates(producer.period, consumer.period); refusal && !consumer.wakes)
    return std::unexpected{*std::move(refusal)};
  if (auto refusal = check_fields(producer.fields, consumer.fields, way->second))
    return std::unexpected{*std::move(refusal)};
  if (auto refusal = check_depth(consumer, way->second, octets_of(producer.fields, way->second)))
    return std::unexpected{*std::move(refusal)};
  const std::uint32_t depth = way->second == LinkKind::Queued ? consumer.depth : 0;
  return Agreement{way->first,      *order,          way->second,     depth,
                   producer.period, consumer.period, producer.fields, consumer.wakes};
}

Result<std::size_t> write_offer(MutableOctets to, std::uint8_t link, const Offer& offer) {
  Writer writer{to};
  writer.number(link);
  writer.offer(offer);
  return writer.finish();
}

Result<std::size_t> write_agreement(MutableOctets to, std::uint8_t link, const Agreement& agreement) {
  Writer writer{to};
  writer.number(link);
  writer.agreement(agreement);
  return writer.finish();
}

Result<std::size_t> write_refusal(MutableOctets to, std::uint8_t link, const Refusal& refusal) {
  Writer writer{to};
  writer.number(link);
  writer.number(refusal.item);
  // A reason is for people: its beginning says enough.
  writer.text(std::string_view{refusal.text}.substr(0, max_text));
  return writer.finish();
}

Result<LinkOffer> read_offer(Octets data) {
  Reader reader{data};
  LinkOffer message;
  reader.number(message.link);
  reader.offer(message.offer);
  return reader.finish(std::move(message), "link offer");
}

Result<LinkAgreement> read_agreement(Octets data) {
  Reader reader{data};
  LinkAgreement message;
  reader.number(message.link);
  reader.agreement(message.agreement);
  return reader.finish(std::move(message), "link agreement");
}

Result<LinkRefusal> read_refusal(Octets data) {
  Reader reader{data};
  LinkRefusal message;
  reader.number(message.link);
  reader.number(message.refusal.item);
  reader.require(message.refusal.item <= static_cast<std::uint8_t>(Item::Wake));
  reader.text(message.refusal.text);
  return reader.finish(std::move(message), "link refusal");
}

Result<std::size_t> write_offer_request(MutableOctets to, const OfferRequest& request) {
  Writer writer{to};
  writer.number(request.link);
  writer.text(request.set);
  return writer.finish();
}

Result<std::size_t> write_terms_request(MutableOctets to, const TermsRequest& request) {
  Writer writer{to};
  writer.number(request.link);
  writer.text(request.set);
  writer.number(request.link);  // the consumer's offer data whole, which begin with the link id
  writer.offer(request.consumer);
  return writer.finish();
}

Result<std::size_t> write_attach_request(MutableOctets to, const AttachRequest& request) {
  Writer writer{to};
  writer.number(request.link);
  writer.enumerator(request.role);
  writer.number(request.epoch);
  writer.number(request.made);
  writer.text(request.set);
  writer.agreement(request.agreement);
  writer.text(request.route.producer);
  writer.text(request.route.consumer);
  writer.number(request.route.key);
  return writer.finish();
}

Result<std::size_t> write_attached(MutableOctets to, const Attached& report) {
  Writer writer{to};
  writer.number(report.route.link);
  writer.enumerator(report.role);
  writer.text(report.role == Role::Producer ? report.route.producer : report.route.consumer);
  writer.number(report.route.key);
  return writer.finish();
}

Result<std::size_t> write_reach_request(MutableOctets to, const ReachRequest& request) {
  Writer writer{to};
  writer.number(request.link);
  writer.number(request.epoch);
  writer.text(request.consumer);
  return writer.finish();
}

Result<OfferRequest> read_offer_request(Octets data) {
  Reader reader{data};
  OfferRequest message;
  reader.number(message.link);
  reader.name(message.set);
  return reader.finish(std::move(message), "link offer request");
}

Result<TermsRequest> read_terms_request(Octets data) {
  Reader reader{data};
  TermsRequest message;
  reader.number(message.link);
  reader.name(message.set);
  std::uint8_t link_of_offer{};
  reader.number(link_of_offer);
  reader.require(link_of_offer == message.link);
  reader.offer(message.consumer);
  return reader.finish(std::move(message), "link terms request");
}

Result<AttachRequest> read_attach_request(Octets data) {
  Reader reader{data};
  AttachRequest message;
  reader.number(message.link);
  reader.enumerator(message.role, {Role::Producer, Role::Consumer});
  reader.number(message.epoch);
  reader.number(message.made);
  reader.name(message.set);
  reader.agreement(message.agreement);
  reader.require(message.made == 0 || (message.made < message.epoch && message.agreement.kind == LinkKind::Loaned));
  message.route.link = message.link;
  reader.text(message.route.producer);
  reader.text(message.route.consumer);
  reader.number(message.route.key);
  return reader.finish(std::move(message), "link attach request");
}

Result<Attached> read_attached(Octets data) {
  Reader reader{data};
  Attached message;
  reader.number(message.route.link);
  reader.enumerator(message.role, {Role::Producer, Role::Consumer});
  reader.text(message.role == Role::Producer ? message.route.producer : message.route.consumer);
  reader.number(message.route.key);
  return reader.finish(std::move(message), "link attached report");
}

Result<ReachRequest> read_reach_request(Octets data) {
  Reader reader{data};
  ReachRequest message;
  reader.number(message.link);
  reader.number(message.epoch);
  reader.name(message.consumer);
  return reader.finish(std::move(message), "link reach request");
}

}  // namespace hirosco::pus::st128
