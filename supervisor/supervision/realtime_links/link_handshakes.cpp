// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_handshakes.hpp"

#include <algorithm>
#include <array>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/data_transfer/channel/channel.hpp"

namespace hirosco::supervisor {

namespace st128 = pus::st128;

namespace {

/// Where the mission puts an end, else in this computer at a port that the system chooses.
[[nodiscard]] std::string place_of(const std::string& declared) { return declared.empty() ? "127.0.0.1" : declared; }

/// An end may choose a port that the mission leaves open, and nothing else: it would draw samples to where nobody wants them.
[[nodiscard]] bool is_at(const std::string& told, const std::string& declared) {
  const auto at = read_internet_address(told), wanted = read_internet_address(declared);
  return at && wanted && at->same_host(*wanted) && at->port != 0 && (wanted->port == 0 || at->port == wanted->port);
}

}  // namespace

bool LinkHandshakes::establish(std::uint8_t id, TimePoint now, Done done) {
  const auto* link = mission_.find_link(id);
  if (link == nullptr || graph_.is_up(id) || handshakes_.contains(id) || releases(id)) return false;
  const auto* from = mission_.find_subsystem(link->from);
  const auto* to = mission_.find_subsystem(link->to);
  if (from == nullptr || to == nullptr) return false;
  Handshake& handshake = handshakes_[id];
  handshake.link = link;
  handshake.producer = from->subsystem.id;
  handshake.consumer = to->subsystem.id;
  handshake.deadline = now + LinkOperator::answer_limit;
  handshake.done = std::move(done);
  std::array<std::byte, max_packet_octets> buffer;
  if (const auto octets = st128::write_offer_request(buffer, {id, link->requires_}))
    operator_.send_link_command(handshake.consumer, st128::request_offer, Octets{buffer}.first(*octets), {});
  return true;
}

bool LinkHandshakes::release(std::uint8_t link, LinkReleases::Done done) {
  // One that a single end still holds may be released again: an earlier release may have ended without that end.
  if (!graph_.is_held(link) || releases(link) || handshakes_.contains(link)) return false;
  releases_.begin(link, std::move(done));
  return true;
}

void LinkHandshakes::handle(std::uint16_t from, const pus::TelemetryView& report) {
  const Octets data = report.source_data();
  if (data.empty()) return;
  const auto link = std::to_integer<std::uint8_t>(data[0]);
  if (report.subtype() == st128::detached) {
    if (is_end_of(link, from)) detached(link, from);
    return;
  }
  const auto found = handshakes_.find(link);
  if (found == handshakes_.end()) return;
  Handshake& handshake = found->second;
  const bool of_producer = from == handshake.producer;
  const bool of_consumer = from == handshake.consumer;
  if (!of_producer && !of_consumer) return;
  switch (report.subtype()) {
    case st128::offer:
      if (const auto offer = st128::read_offer(data); offer && of_consumer && handshake.stage == Stage::AwaitOffer)
        offered(handshake, offer->offer);
      break;
    case st128::agreement:
      if (const auto terms = st128::read_agreement(data);
          terms && of_producer && handshake.stage == Stage::AwaitAgreement)
        agreed(handshake, terms->agreement);
      break;
    case st128::refusal:
      if (const auto refusal = st128::read_refusal(data)) give_up(link, refusal->refusal.text, from);
      break;
    case st128::attached:
      if (const auto said = st128::read_attached(data);
          said && (said->role == st128::Role::Producer ? of_producer : of_consumer))
        attached(handshake, *said);
      break;
    default: break;
  }
}

void LinkHandshakes::detached(std::uint8_t link, std::uint16_t from) {
  const auto found = handshakes_.find(link);
  if (found == handshakes_.end()) down(link, "detached by " + std::to_string(from));
  graph_.let_go(link, from);
  if (found == handshakes_.end()) return releases_.end_those_let_go();
  // Reports of one subsystem come in order: a producer that attached in this handshake and detached since has left it.
  // Before that the report is a late one of the link's earlier life.
  const Handshake& handshake = found->second;
  if (handshake.stage >= Stage::AwaitConsumer && from == handshake.producer) give_up(link, "the producer left", from);
  else if (handshake.stage == Stage::AwaitReached) give_up(link, "the consumer left", from);
}

void LinkHandshakes::offered(Handshake& handshake, const st128::Offer& offer) {
  std::array<std::byte, max_packet_octets> buffer;
  st128::TermsRequest request{handshake.link->id, handshake.link->provides, offer};
  // A mission that knows its network says how this link travels; the ends say how they could.
  if (const auto& method = handshake.link->method) {
    if (std::ranges::find(offer.terms.methods, *method) == offer.terms.methods.end())
      return give_up(handshake.link->id,
                     "the mission wants " + std::string{to_text(*method)} + ", the consumer has it not");
    request.consumer.terms.methods = {*method};
  }
  const auto octets = st128::write_terms_request(buffer, request);
  if (!octets) return give_up(handshake.link->id, "the offer does not fit a packet");
  handshake.stage = Stage::AwaitAgreement;
  handshake.deadline += LinkOperator::answer_limit;
  operator_.send_link_command(handshake.producer, st128::negotiate_terms, Octets{buffer}.first(*octets), {});
}

void LinkHandshakes::agreed(Handshake& handshake, const st128::Agreement& agreement) {
  const std::uint32_t payload = agreement.payload_octets();
  if (payload == 0 || payload > max_payload_octets(agreement.kind))
    return give_up(handshake.link->id, "payload size out of range");
  const LinkMechanism* mechanism = memory_.mechanism_for(agreement);
  if (mechanism == nullptr) return give_up(handshake.link->id, "no mechanism here carries " + terms_text(agreement));
  if (const auto shared = share(handshake, agreement); !shared) return give_up(handshake.link->id, shared.error().text);
  handshake.agreement = agreement;
  if (!mechanism->in_memory())
    handshake.route = {.link = handshake.link->id,
                       .producer = place_of(handshake.link->from_address),
                       .consumer = place_of(handshake.link->to_address),
                       .key = 0};
  handshake.stage = Stage::AwaitProducer;
  handshake.deadline += LinkOperator::answer_limit;
  attach(handshake, st128::Role::Producer);
}

Result<> LinkHandshakes::share(Handshake& handshake, const st128::Agreement& agreement) {
  handshake.epoch = ++epoch_;
  const auto lends_still = [&](std::uint8_t id) {
    return handshakes_.contains(id) || (graph_.holds(id, handshake.producer) && !releases(id));
  };
  HIROSCO_TRY_LET(const auto shared, memory_.share(*handshake.link, agreement, handshake.epoch, lends_still));
  handshake.shared = shared.memory;
  handshake.made = shared.made;
  return ok();
}

void LinkHandshakes::attach(const Handshake& handshake, st128::Role role) {
  std::array<std::byte, max_packet_octets> buffer;
  const auto octets = handshake.write_attach(buffer, role);
  if (!octets) return;  // the same agreement came in a packet: it fits; else the stage's time limit ends it
  operator_.send_link_command(role == st128::Role::Producer ? handshake.producer : handshake.consumer, st128::attach,
                              Octets{buffer}.first(*octets), handshake.shared);
}

void LinkHandshakes::attached(Handshake& handshake, const st128::Attached& report) {
  const bool has_route = !handshake.route.producer.empty();
  if (handshake.stage == Stage::AwaitProducer && report.role == st128::Role::Producer) {
    if (has_route && !is_at(report.route.producer, handshake.route.producer))
      return give_up(handshake.link->id, "the producer stands at '" + report.route.producer + "'");
    handshake.stage = Stage::AwaitConsumer;
    handshake.deadline += LinkOperator::answer_limit;
    if (has_route) {
      handshake.route.producer = report.route.producer;
      handshake.route.key = report.route.key;
    }
    return attach(handshake, st128::Role::Consumer);
  }
  if (handshake.stage == Stage::AwaitConsumer && report.role == st128::Role::Consumer) {
    if (!has_route) return up(handshake);
    if (!is_at(report.route.consumer, handshake.route.consumer))
      return give_up(handshake.link->id, "the consumer stands at '" + report.route.consumer + "'");
    handshake.route.consumer = report.route.consumer;
    return reach(handshake);
  }
  if (handshake.stage == Stage::AwaitReached && report.role == st128::Role::Producer) up(handshake);
}

void LinkHandshakes::reach(Handshake& handshake) {
  std::array<std::byte, max_packet_octets> buffer;
  const auto octets = st128::write_reach_request(
      buffer, {.link = handshake.link->id, .epoch = handshake.epoch, .consumer = handshake.route.consumer});
  if (!octets) return;  // an address came in a packet: it fits; else the stage's time limit ends it
  handshake.stage = Stage::AwaitReached;
  handshake.deadline += LinkOperator::answer_limit;
  operator_.send_link_command(handshake.producer, st128::reach, Octets{buffer}.first(*octets), {});
}

void LinkHandshakes::up(Handshake& handshake) {
  const std::uint8_t link = handshake.link->id;
  Handshake finished = std::move(handshake);
  handshakes_.erase(link);
  // Without a view the link is only not told about.
  if (auto view = memory_.look(finished.agreement, finished.shared)) views_[link] = std::move(view);
  graph_.set_up(link, true);
  operator_.link_changed(*finished.link, true, finished.terms());
  if (finished.done) finished.done(true);
}

void LinkHandshakes::give_up(std::uint8_t link, const std::string& why, std::uint16_t without) {
  const auto found = handshakes_.find(link);
  if (found == handshakes_.end()) return;
  Handshake failed = std::move(found->second);
  handshakes_.erase(found);
  // Who could not lend in it may have lost it: the next try is made of its own.
  if (failed.made != 0) memory_.lend_no_more(failed.made);
  // Whoever was told to attach may have done so or may still do it: an end that stays attached would refuse the next try.
  const std::array data{std::byte{link}};
  if (failed.stage >= Stage::AwaitConsumer && failed.consumer != without)
    operator_.send_link_command(failed.consumer, st128::detach, data, {});
  if (failed.stage >= Stage::AwaitProducer && failed.producer != without)
    operator_.send_link_command(failed.producer, st128::detach, data, {});
  operator_.link_changed(*failed.link, false, why);
  if (failed.done) failed.done(false);
}

std::vector<std::uint8_t> LinkHandshakes::under_way() const {
  std::vector<std::uint8_t> links;
  for (const auto& [link, handshake] : handshakes_) links.push_back(link);
  for (const std::uint8_t link : releases_.links())
    if (!handshakes_.contains(link)) links.push_back(link);
  return links;
}

void LinkHandshakes::break_off(std::uint8_t link) {
  const auto* described = mission_.find_link(link);
  if (described == nullptr) return;
  const auto standing = graph_.standing(link);
  // An end that may have attached holds it until it says otherwise.
  if (standing == 0) graph_.stand(link, LinkGraph::from_holds | LinkGraph::to_holds);
  broken_off_.insert(link);
  if (!release(link, {})) return;
  operator_.link_changed(*described, false, "the supervisor died in the middle of it");
}

std::optional<LinkGlance> LinkHandshakes::glance(std::uint8_t link) const noexcept {
  const auto found = views_.find(link);
  return found != views_.end() ? found->second->glance() : std::nullopt;
}

void LinkHandshakes::down(std::uint8_t link, const std::string& why) {
  if (!graph_.is_up(link)) return;
  graph_.set_up(link, false);
  views_.erase(link);
  operator_.link_changed(*mission_.find_link(link), false, why);
}

bool LinkHandshakes::is_end_of(std::uint8_t link, std::uint16_t apid) const {
  const auto* described = mission_.find_link(link);
  if (described == nullptr) return false;
  const auto* subsystem = mission_.find_subsystem(apid);
  return subsystem != nullptr &&
         (described->from == subsystem->subsystem.name || described->to == subsystem->subsystem.name);
}

void LinkHandshakes::failed(std::uint16_t apid, std::uint8_t subtype, std::uint8_t link, const std::string& why) {
  const bool knows_nothing = why.find(to_text(pus::FailureCode::UnknownIdentifier)) != std::string::npos;
  if (subtype == st128::detach && broken_off_.contains(link) && knows_nothing) graph_.let_go(link, apid);
  if (subtype == st128::detach) releases_.refused(link, apid);
  const auto found = handshakes_.find(link);
  if (found == handshakes_.end()) return;
  // What belonged to an earlier handshake, or takes one down, ends none.
  if (found->second.awaits(apid, subtype)) found->second.failure = why;
}

void LinkHandshakes::forget(std::uint16_t apid) {
  std::vector<std::uint8_t> broken;
  for (const auto& [link, handshake] : handshakes_)
    if (handshake.is_between(apid)) broken.push_back(link);
  for (const std::uint8_t link : broken) give_up(link, "a partner is gone", apid);
  for (const std::uint8_t link : graph_.links_of(apid)) down(link, "subsystem " + std::to_string(apid) + " is gone");
  graph_.forget_all_of(apid);
  releases_.end_those_let_go();
}

void LinkHandshakes::step(TimePoint now) {
  std::map<std::uint8_t, std::string> over;
  for (const auto& [link, handshake] : handshakes_)
    if (!handshake.failure.empty()) over[link] = handshake.failure;
    else if (now > handshake.deadline) over[link] = "time limit of the handshake";
  for (const auto& [link, why] : over) give_up(link, why);
  releases_.step(now);
}

}  // namespace hirosco::supervisor
