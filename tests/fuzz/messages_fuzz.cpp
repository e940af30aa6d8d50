// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/channel/envelope.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What supervisor, subsystems and ground say to each other over a channel beside plain packets, from whatever octets come: what is taken
/// is written to the octets that it came from.
namespace {

using namespace hirosco;
using namespace hirosco::pus;
using fuzz::expect;

/// `write` fills a buffer, and gives what it used or how much of it that is.
template <class Read, class Write>
void check(Octets octets, const Read& read, const Write& write) {
  const auto taken = read(octets);
  if (!taken) return;
  fuzz::taken();
  std::array<std::byte, max_telemetry_octets> buffer;
  const auto written = write(MutableOctets{buffer}, *taken);
  using Written = std::remove_cvref_t<decltype(written)>;
  Octets again;
  if constexpr (std::convertible_to<Written, Octets>) {
    again = written;
  } else {
    expect(written.has_value(), "what was taken can be said again");
    if constexpr (std::same_as<Written, Result<std::size_t>>) again = Octets{buffer}.first(*written);
    else again = *written;
  }
  expect(std::ranges::equal(again, octets), "a message is the octets that it came from");
}

void check_envelope(Octets octets) {
  OctetReader reader{octets};
  const auto message = envelope::read(reader);
  if (!message) return;
  fuzz::taken();
  expect(message->packet.empty() && reader.position() == envelope::octets, "an envelope is its head alone");
  std::array<std::byte, envelope::octets> buffer;
  OctetWriter writer{buffer};
  envelope::write(writer, *message);
  expect(writer.good() && std::ranges::equal(writer.written(), octets.first(envelope::octets)),
         "an envelope is the octets that it came from");
}

/// As a producer decides: what it agrees to, both ends can read.
void check_agreed(Octets octets) {
  const auto asked = st128::read_terms_request(octets);
  if (!asked) return;
  const auto agreed =
      st128::negotiate(asked->consumer, asked->consumer, [](LinkMethod, LinkKind, bool) { return true; });
  std::array<std::byte, max_telemetry_octets> buffer;
  if (!agreed) {
    const auto written = st128::write_refusal(buffer, asked->link, agreed.error());
    expect(written && st128::read_refusal(Octets{buffer}.first(*written)), "why there is no link can be read");
    return;
  }
  static_cast<void>(agreed->layout(1));
  const auto written = st128::write_agreement(buffer, asked->link, *agreed);
  expect(written.has_value(), "an agreement can be said");
}

void check_handshake(Octets octets) {
  using namespace st128;
  check(octets, read_offer,
        [](MutableOctets to, const LinkOffer& each) { return write_offer(to, each.link, each.offer); });
  check(octets, read_agreement, [](MutableOctets to, const LinkAgreement& each) {
    expect(each.agreement.payload_octets() <= max_payload_octets(each.agreement.kind), "a sample has room in a link");
    static_cast<void>(each.agreement.layout(1));
    return write_agreement(to, each.link, each.agreement);
  });
  check(octets, read_refusal,
        [](MutableOctets to, const LinkRefusal& each) { return write_refusal(to, each.link, each.refusal); });
  check(octets, read_offer_request, write_offer_request);
  check(octets, read_terms_request, write_terms_request);
  check(octets, read_attach_request, write_attach_request);
  check(octets, read_attached, write_attached);
  check(octets, read_reach_request, write_reach_request);
  check_agreed(octets);
}

/// What is written into octets of its own, in the form of those that fill a buffer.
template <class Data>
[[nodiscard]] Octets put(MutableOctets to, const Data& octets) {
  std::ranges::copy(octets, to.begin());
  return Octets{to}.first(octets.size());
}

void check_supervision(Octets octets) {
  using namespace st129;
  check(octets, read_subscribed,
        [](MutableOctets to, const Subscribed& each) { return put(to, write_subscribed(each)); });
  check(octets, read_descriptor_problem,
        [](MutableOctets to, const DescriptorProblem& each) { return put(to, write_descriptor_problem(each)); });
  check(octets, read_retrieve, [](MutableOctets to, const Retrieve& each) { return put(to, write_retrieve(each)); });
  check(octets, read_retrieved, write_retrieved);
  check(octets, read_retrieval_end,
        [](MutableOctets to, const RetrievalEnd& each) { return put(to, write_retrieval_end(each)); });
  check(octets, read_mode_preview, write_mode_preview);
  check(octets, read_plan_preview, write_plan_preview);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = fuzz::octets_of(data, size);
  if (octets.size() > st129::max_retrieved_octets) return 0;
  check_envelope(octets);
  check(octets, read_event_message, write_event_message);
  check_handshake(octets);
  check_supervision(octets);
  return 0;
}
