// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The octets of the handshake: write_* and read_* of link_handshake.hpp.
#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "hirosco/pus/st128_realtime_link/detail/handshake_items.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

namespace hirosco::pus::st128 {
namespace {

constexpr std::size_t max_choices = 16;          ///< methods, byte orders or kinds of one offer
constexpr std::size_t max_fields = 255;
constexpr std::size_t max_text = 255;

/// As the reader of descriptors has it: depth goes with kind Queued, and with that alone.
[[nodiscard]] bool is_depth(std::uint32_t depth, bool queued) noexcept {
  return queued ? depth >= min_link_depth && depth <= max_link_depth : depth == 0;
}

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
    const std::size_t payload = detail::sample_octets(agreement.fields, agreement.kind);
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
  reader.require(message.refusal.item <= static_cast<std::uint8_t>(detail::Item::Wake));
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
