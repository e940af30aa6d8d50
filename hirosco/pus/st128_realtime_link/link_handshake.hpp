// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/model/common_link_way.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/service/service_kind.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// ST[128] real-time links: the handshake between a consumer and a producer (paper 4.1, decisions 19 and 20).
///
/// The supervisor relays; it decides nothing about layouts:
///   TC[128,1]   supervisor -> consumer   request offer: link id, set name
///   TM[128,129] consumer -> supervisor   offer: link id + Offer (what it requires)
///   TC[128,2]   supervisor -> producer   negotiate: link id, set name + that Offer
///   TM[128,130] producer -> supervisor   agreement: link id + Agreement
///   TM[128,131] either -> supervisor     refusal: link id + Refusal
///   TC[128,3]   supervisor -> producer, then consumer   attach: link id, role, epoch + Agreement + route; memory beside the packet
///   TM[128,132] both -> supervisor       attached: link id, role, where this end stands
///   TC[128,5]   supervisor -> producer   reach: link id, epoch, where the consumer stands; of a link that is not memory only,
///                                        and answered as attach is
///   TC[128,4]   supervisor -> both       detach: link id
///   TM[128,133] both -> supervisor       detached: link id, role
namespace hirosco::pus::st128 {

inline constexpr std::uint8_t service_type = 128;
extern const ServiceKind service_kind;
enum Subtype : std::uint8_t {
  request_offer = 1,
  negotiate_terms = 2,
  attach = 3,
  detach = 4,
  reach = 5,
  offer = 129,
  agreement = 130,
  refusal = 131,
  attached = 132,
  detached = 133,
};
enum class Role : std::uint8_t { Producer = 1, Consumer = 2 };

struct OfferedField {
  std::string name;
  Type type{};
  std::uint32_t count{1};
  friend bool operator==(const OfferedField&, const OfferedField&) = default;
};

/// What one side brings to the handshake: its fields and what it can do, in order of preference.
struct Offer {
  std::string set;
  Duration period{};  ///< sampling time of the configuration
  descriptor::LinkTerms terms;
  std::uint32_t depth{0};  ///< of a consumer that wants every sample; else 0
  std::vector<OfferedField> fields;
  bool wakes{false};  ///< of a consumer whose cycle a sample of this set starts
};

/// What was agreed: the producer's whole layout in order, and the terms.
struct Agreement {
  LinkMethod method{};
  descriptor::ByteOrder byte_order{};
  LinkKind kind{};
  std::uint32_t depth{0};  ///< of kind Queued, the consumer's; else 0
  Duration producer_period{};
  Duration consumer_period{};
  /// The producer's in their order: packed, or of a lent sample as in a C++ aggregate.
  std::vector<OfferedField> fields;
  bool wakes{false};  ///< the producer wakes the consumer after each sample, as that asked
  [[nodiscard]] std::uint32_t payload_octets() const noexcept;  ///< of a lent sample as a C++ aggregate has them
  [[nodiscard]] std::uint64_t layout_hash() const noexcept;  ///< FNV-1a 64 over fields, order, kind
  /// What supervisor and both ends make their parts of the link of.
  [[nodiscard]] LinkLayout layout(std::uint32_t epoch) const noexcept;
};

/// Why there is nothing common. `item`: 0 method, 1 byte order, 2 kind, 3 rate, 4 field, 5 depth, 6 wake.
struct Refusal {
  std::uint8_t item{};
  std::string text;  ///< "field POSITION: consumer FLOAT[2], producer DOUBLE[2]"
};

using descriptor::Carried;

/// The handshake's decision, made by the producer: the first method, byte order and kind of the producer's list that the
/// consumer has too; an integer ratio of the rates either way, but for a consumer whose cycle starts with a sample; every
/// field the consumer requires present with the same name, type and count (the producer may have more). Method and kind are
/// chosen together, by what can be carried. A lent sample has the same fields in the same order on both sides, and the byte
/// order of the machine. How many samples are kept for a consumer that wants every one of them it says itself. Pure.
[[nodiscard]] std::expected<Agreement, Refusal> negotiate(const Offer& producer, const Offer& consumer,
                                                          const Carried& carried);

/// Wire forms. write_* return the octets used; read_* refuse what is not exactly of the form (Malformed) and bound every
/// count. Strings are u8 length + ASCII.
[[nodiscard]] Result<std::size_t> write_offer(MutableOctets to, std::uint8_t link, const Offer& offer);
[[nodiscard]] Result<std::size_t> write_agreement(MutableOctets to, std::uint8_t link, const Agreement& agreement);
[[nodiscard]] Result<std::size_t> write_refusal(MutableOctets to, std::uint8_t link, const Refusal& refusal);
struct LinkOffer {
  std::uint8_t link{};
  Offer offer;
};
struct LinkAgreement {
  std::uint8_t link{};
  Agreement agreement;
};
struct LinkRefusal {
  std::uint8_t link{};
  Refusal refusal;
};
[[nodiscard]] Result<LinkOffer> read_offer(Octets data);
[[nodiscard]] Result<LinkAgreement> read_agreement(Octets data);
[[nodiscard]] Result<LinkRefusal> read_refusal(Octets data);

/// TC[128,1]: link id u8, set name.  TC[128,2]: link id u8, producer's set name, then the consumer's offer data whole.
struct OfferRequest {
  std::uint8_t link{};
  std::string set;
};
struct TermsRequest {
  std::uint8_t link{};
  std::string set;
  Offer consumer;
};
struct AttachRequest {
  std::uint8_t link{};
  Role role{};
  std::uint32_t epoch{};
  std::string set;
  Agreement agreement;
  LinkRoute route{};  ///< its `link` is the one above
  /// Of a set that is lent to somebody else already: epoch of the link for which the memory was made. 0: of this one.
  std::uint32_t made{0};
  /// What the header of the memory says.
  [[nodiscard]] std::uint32_t header_epoch() const noexcept { return made != 0 ? made : epoch; }
};
/// TM[128,132]: of a link in memory the route is empty.
struct Attached {
  Role role{};
  LinkRoute route{};  ///< the link, where this end stands, and the producer's key
};
/// TC[128,5].
struct ReachRequest {
  std::uint8_t link{};
  std::uint32_t epoch{};
  std::string consumer;
};
[[nodiscard]] Result<std::size_t> write_offer_request(MutableOctets to, const OfferRequest& request);
[[nodiscard]] Result<std::size_t> write_terms_request(MutableOctets to, const TermsRequest& request);
[[nodiscard]] Result<std::size_t> write_attach_request(MutableOctets to, const AttachRequest& request);
[[nodiscard]] Result<OfferRequest> read_offer_request(Octets data);
[[nodiscard]] Result<TermsRequest> read_terms_request(Octets data);
[[nodiscard]] Result<AttachRequest> read_attach_request(Octets data);
[[nodiscard]] Result<std::size_t> write_attached(MutableOctets to, const Attached& report);
[[nodiscard]] Result<Attached> read_attached(Octets data);
[[nodiscard]] Result<std::size_t> write_reach_request(MutableOctets to, const ReachRequest& request);
[[nodiscard]] Result<ReachRequest> read_reach_request(Octets data);

}  // namespace hirosco::pus::st128
