// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/judgement.hpp"

#include <array>

#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/resource_management/power_handling.hpp"

namespace hirosco::supervisor {
namespace {

using pus::FailureCode;
using pus::FailureNotice;

}  // namespace

std::expected<Permitted, FailureNotice> Judgement::judge(const pus::TelecommandView& telecommand,
                                                         const Origin& origin) const {
  const auto decision = decide(telecommand, origin, situation_of(telecommand.apid()));
  // A stop is asked for no name: one by who may not is an unwanted stop at worst, a refused one would be none (adr 0068).
  const std::uint16_t source = telecommand.source();
  if (!origin.owns(source, craft_.mission) && !(decision && decision->stops_the_craft))
    return std::unexpected{FailureNotice{FailureCode::ForeignSource}.with(source)};
  // Who has failed, is stopped or on its way down commands nobody; towards safety it may.
  if (decision && !decision->essential && origin.is_subsystem() && !is_sound(origin.apid()))
    return std::unexpected{FailureNotice{FailureCode::WrongState}};
  if (!decision || !(decision->releases_stop || decision->starts)) return decision;
  // On the way down nobody begins to move any more, nor comes up.
  if (craft_.shutting_down) return std::unexpected{FailureNotice{FailureCode::NotPermittedNow}};
  // What a recovery has stopped is not released by a command that crosses it, nor who cannot hear it.
  if (const Member* addressee = craft_.member(telecommand.apid());
      addressee != nullptr && addressee->alive() && (addressee->recovery.running() || addressee->closed_at))
    return std::unexpected{FailureNotice{FailureCode::WrongState}};
  return decision;
}

bool Judgement::is_sound(std::uint16_t apid) const {
  const Member* member = craft_.member(apid);
  if (member == nullptr || member->recovery.running()) return false;
  const auto state = member->state();
  using enum descriptor::State;
  return state == PreOperational || state == SafeOperational || state == Operational;
}

Situation Judgement::situation_of(std::uint16_t apid) const {
  Situation situation{.mission = craft_.mission,
                      .mode = *craft_.mode,
                      .links = links_,
                      .state = std::nullopt,
                      .power = &power_.ledger(),
                      .down = false,
                      .changing = craft_.changing_to != nullptr,
                      .in_force = &tells_in_force_};
  if (apid == supervisor_apid) {
    situation.state = own_.state();
    situation.configuration = own_.configuration();
    return situation;
  }
  const Member* addressee = craft_.member(apid);
  situation.down = addressee != nullptr && !addressee->alive();
  if (addressee == nullptr || situation.down) return situation;
  situation.state = addressee->state();
  situation.configuration = addressee->configuration();
  situation.rereading = addressee->descriptor_changes;
  return situation;
}

std::vector<descriptor::InForce> Judgement::in_force() const {
  std::vector<descriptor::InForce> all;
  for (const Member& member : craft_.members) {
    if (!member.alive()) continue;
    const descriptor::SubsystemDescriptor& subsystem = member.descriptor();
    all.push_back({&subsystem, subsystem.find_configuration(member.configuration()),
                   descriptor::core_of(craft_.mission, member.described())});
  }
  return all;
}

void Judgement::answer(const pus::Request& request, Octets asked) const {
  const auto header = pus::read_primary_header(asked);
  pus::Verification& verification = own_.verification();
  if (!header) return verification.rejected(request, FailureNotice{FailureCode::DataLength});
  verification.accepted(request);
  verification.started(request);
  const auto telecommand = pus::TelecommandView::parse(asked);
  const auto decision = telecommand ? judge(*telecommand, Origin::of(request.source, craft_.mission))
                                    : std::unexpected{telecommand.error()};
  std::array<std::byte, 7> data;
  OctetWriter writer{data};
  writer.put(header->request_id);
  writer.put(static_cast<std::uint8_t>(decision ? 1 : 0));
  writer.put(static_cast<std::uint16_t>(decision ? 0 : static_cast<std::uint16_t>(decision.error().code())));
  own_.telemetry().report(pus::st129::service_type, pus::st129::permission_answer, request.source, data);
  verification.completed(request);
}

}  // namespace hirosco::supervisor
