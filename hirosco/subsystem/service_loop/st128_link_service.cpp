// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/st128_link_service.hpp"

#include <array>

#include "hirosco/data_transfer/channel/channel.hpp"

namespace hirosco {

namespace st128 = pus::st128;

void LinkService::handle(const pus::TelecommandView& telecommand, const pus::Request& request) {
  const Octets data = telecommand.application_data();
  switch (telecommand.subtype()) {
    case st128::request_offer: offer(data, request); break;
    case st128::negotiate_terms: negotiate(data, request); break;
    case st128::attach: attach(data, request); break;
    case st128::detach: detach(data, request); break;
    case st128::reach: reach(data, request); break;
    default:
      verification_.rejected(
          request,
          pus::FailureNotice{pus::FailureCode::UnknownSubtype}.with(telecommand.service()).with(telecommand.subtype()));
  }
  memory_ = {};
}

void LinkService::offer(Octets data, const pus::Request& request) {
  const auto asked = st128::read_offer_request(data);
  if (!asked) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::DataLength});
  verification_.accepted(request);
  const descriptor::Requires* required = owner_.find_required(asked->set);
  if (required == nullptr)
    return refuse(asked->link, {4, "no configuration in force requires a set '" + asked->set + "'"}, request);
  if (auto why = owner_.refuse_link(st128::Role::Consumer, asked->set, asked->link); !why.empty())
    return refuse(asked->link, {4, std::move(why)}, request);
  st128::Offer own{.set = required->name,
                   .period = owner_.period(),
                   .terms = required->terms,
                   .depth = required->depth,
                   .fields = {},
                   .wakes = required->starts};
  for (const auto& field : required->fields) own.fields.push_back({field.name, field.type, field.count});
  std::array<std::byte, max_packet_octets> buffer;
  const auto octets = st128::write_offer(buffer, asked->link, own);
  if (!octets) return refuse(asked->link, {4, "the offer does not fit a packet"}, request);
  verification_.started(request);
  sink_.report(type(), st128::offer, request.source, Octets{buffer}.first(*octets));
  verification_.completed(request);
}

void LinkService::negotiate(Octets data, const pus::Request& request) {
  const auto asked = st128::read_terms_request(data);
  if (!asked) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::DataLength});
  verification_.accepted(request);
  const LinkOutputSlot* provided = owner_.find_provided(asked->set);
  if (provided == nullptr)
    return refuse(asked->link, {4, "no configuration in force provides a set '" + asked->set + "'"}, request);
  if (auto why = owner_.refuse_link(st128::Role::Producer, asked->set, asked->link); !why.empty())
    return refuse(asked->link, {4, std::move(why)}, request);
  const st128::Offer own{
      .set = asked->set, .period = owner_.period(), .terms = provided->terms().terms, .fields = provided->fields()};
  const auto outcome = st128::negotiate(own, asked->consumer, [this](LinkMethod method, LinkKind kind, bool wakes) {
    return owner_.carries(method, kind, wakes);
  });
  if (!outcome) return refuse(asked->link, outcome.error(), request);
  std::array<std::byte, max_packet_octets> buffer;
  const auto octets = st128::write_agreement(buffer, asked->link, *outcome);
  if (!octets) return refuse(asked->link, {4, "the agreement does not fit a packet"}, request);
  verification_.started(request);
  sink_.report(type(), st128::agreement, request.source, Octets{buffer}.first(*octets));
  verification_.completed(request);
}

void LinkService::attach(Octets data, const pus::Request& request) {
  const auto asked = st128::read_attach_request(data);
  if (!asked) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::DataLength});
  verification_.accepted(request);
  answer(asked->link, asked->role, owner_.attach(*asked, memory_), request);
}

void LinkService::reach(Octets data, const pus::Request& request) {
  const auto asked = st128::read_reach_request(data);
  if (!asked) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::DataLength});
  verification_.accepted(request);
  answer(asked->link, st128::Role::Producer, owner_.reach(*asked), request);
}

void LinkService::answer(std::uint8_t link, st128::Role role, const Result<LinkRoute>& outcome,
                         const pus::Request& request) {
  if (!outcome) return refuse(link, {0, outcome.error().text}, request);
  st128::Attached report{.role = role, .route = *outcome};
  report.route.link = link;
  std::array<std::byte, max_packet_octets> buffer;
  const auto octets = st128::write_attached(buffer, report);
  if (!octets) return refuse(link, {0, "where this end stands does not fit a packet"}, request);
  verification_.started(request);
  sink_.report(type(), st128::attached, request.source, Octets{buffer}.first(*octets));
  verification_.completed(request);
}

void LinkService::detach(Octets data, const pus::Request& request) {
  if (data.size() != 1) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::DataLength});
  verification_.accepted(request);
  const auto link = std::to_integer<std::uint8_t>(data[0]);
  if (!owner_.detach(link))
    return verification_.start_failed(
        request,
        pus::FailureNotice{pus::FailureCode::UnknownIdentifier}.with(std::uint8_t{0}).with(std::uint32_t{link}));
  verification_.started(request);
  verification_.completed(request);
}

void LinkService::report_detached(std::uint8_t link, st128::Role role) {
  const std::array answer{std::byte{link}, static_cast<std::byte>(role)};
  sink_.report(type(), st128::detached, 0, answer);
}

void LinkService::refuse(std::uint8_t link, const st128::Refusal& refusal, const pus::Request& request) {
  std::array<std::byte, max_packet_octets> buffer;
  if (const auto octets = st128::write_refusal(buffer, link, refusal))
    sink_.report(type(), st128::refusal, request.source, Octets{buffer}.first(*octets));
  verification_.start_failed(request, pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0}));
}

}  // namespace hirosco
