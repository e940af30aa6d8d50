// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: permission (docs/safety/modules.csv).
#include "supervisor/supervision/data_handling/permission.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/st129_supervision.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::State;
using pus::FailureCode;
using pus::FailureNotice;

constexpr std::size_t name_octets = 16;

/// Services of every subsystem, and the subtypes that are requests.
[[nodiscard]] bool known_subtype(std::uint8_t service, std::uint8_t subtype) {
  switch (service) {
    case 3: {
      constexpr std::array requests{1, 3, 5, 6, 9, 27, 29, 31, 33};
      return std::ranges::find(requests, int{subtype}) != requests.end();
    }
    case 5: return subtype >= 5 && subtype <= 7;
    case 8:
    case 17: return subtype == 1;
    case 20: return subtype == 1 || subtype == 3;
    case 128: return subtype >= 1 && subtype <= 4;
    case pus::st129::service_type: return subtype == pus::st129::permission_question;
    default: return false;
  }
}

[[nodiscard]] bool known_service(std::uint8_t service, std::uint16_t apid) {
  if (service == pus::st129::service_type) return apid == supervisor_apid;
  constexpr std::array services{3, 5, 8, 17, 20, 128};
  return std::ranges::find(services, int{service}) != services.end();
}

[[nodiscard]] const descriptor::Subsystem* addressee(const descriptor::Mission& mission, std::uint16_t apid) {
  if (apid == supervisor_apid) return &mission.supervisor;
  const auto* found = mission.find_subsystem(apid);
  return found != nullptr ? &found->subsystem : nullptr;
}

[[nodiscard]] bool listed(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::any_of(names, [&](const std::string& entry) { return entry == "*" || entry == name; });
}

[[nodiscard]] bool mode_permits(const descriptor::Mode& mode, const descriptor::Subsystem& subsystem,
                                std::uint8_t service, std::string_view function) {
  return std::ranges::any_of(mode.permits, [&](const descriptor::Permit& permit) {
    if (permit.subsystem != "*" && permit.subsystem != subsystem.name) return false;
    if (std::ranges::find(permit.services, service) != permit.services.end()) return true;
    return service == 8 && listed(permit.functions, function);
  });
}

/// Its states are what everything else stands on: SHUTDOWN and SET_MODE are the ways to change them (findings SF1).
[[nodiscard]] bool changes_supervisor(std::uint16_t apid, const CalledFunction& call) {
  return apid == supervisor_apid && (call.name == "SET_STATE" || call.name == "CONFIGURE");
}

/// Why a parameter write may not pass (findings SF20): each parameter must be writable in this state by its descriptor,
/// and opened by this mode. Whether the values fit is the addressee's matter.
[[nodiscard]] std::optional<FailureNotice> write_refused(const pus::TelecommandView& telecommand,
                                                         const descriptor::Subsystem& subsystem,
                                                         const Situation& situation) {
  OctetReader reader{telecommand.application_data()};
  const auto count = reader.get<std::uint8_t>();
  for (unsigned i = 0; i < count && reader.good(); ++i) {
    const auto id = reader.get<std::uint32_t>();
    const auto parameter = std::ranges::find_if(subsystem.parameters, [&](const descriptor::Parameter& candidate) {
      return ParameterId{subsystem.id, candidate.field.type, candidate.id}.wire() == id;
    });
    // An unknown one hides the width of all behind it; the addressee refuses the whole (pus-c tailoring, ST[20]).
    if (!reader.good() || parameter == subsystem.parameters.end()) return std::nullopt;
    static_cast<void>(reader.get(parameter->octets()));
    const bool opened = std::ranges::any_of(situation.mode.permits, [&](const descriptor::Permit& permit) {
      return (permit.subsystem == "*" || permit.subsystem == subsystem.name) &&
             listed(permit.parameters, parameter->field.name);
    });
    if (!parameter->writable() || !parameter->writable_in(*situation.state))
      return FailureNotice{FailureCode::NotPermittedNow}.with(static_cast<std::uint8_t>(i)).with(id);
    if (!opened) return FailureNotice{FailureCode::WrongMode}.with(situation.mode.id).with(id);
  }
  return std::nullopt;
}

[[nodiscard]] std::optional<std::uint8_t> absent_link(const descriptor::Subsystem& subsystem,
                                                      const Situation& situation) {
  const auto* configuration = subsystem.find_configuration(situation.configuration);
  return configuration == nullptr ? std::nullopt : situation.links.absent_for(subsystem.id, *configuration);
}

/// Most that the addressee's configuration in force draws.
[[nodiscard]] double demand_w(const descriptor::Subsystem& subsystem, const Situation& situation) {
  const auto* configuration = subsystem.find_configuration(situation.configuration);
  return configuration != nullptr ? configuration->power_w : 0;
}

[[nodiscard]] FailureNotice notice_of(const PowerShortage& shortage) {
  FailureNotice notice{FailureCode::PowerShort};
  return notice.with(shortage.budget_mw).with(shortage.reserved_mw).with(shortage.requested_mw);
}

/// Towards safety: never delayed or refused by mode (decision 24).
[[nodiscard]] bool towards_safety(const CalledFunction& call, std::optional<State> state) {
  if (call.name != "SET_STATE" || !call.first_argument) return false;
  const auto target = static_cast<State>(*call.first_argument);
  return target == State::ErrorOperational || target == State::PostOperational ||
         (target == State::SafeOperational && state == State::Operational);
}

}  // namespace

std::optional<CalledFunction> called_function(const pus::TelecommandView& telecommand) {
  if (telecommand.service() != 8 || telecommand.subtype() != 1) return std::nullopt;
  const Octets data = telecommand.application_data();
  if (data.size() < name_octets) return std::nullopt;
  const auto* letters = reinterpret_cast<const char*>(data.data());
  CalledFunction call;
  call.name = std::string_view{letters, name_octets};
  call.name = call.name.substr(0, call.name.find('\0'));
  // N u8, argument id u8, value u8: the shape of SET_STATE and its kin.
  if (data.size() == name_octets + 3) call.first_argument = std::to_integer<std::uint8_t>(data[name_octets + 2]);
  return call;
}

std::expected<Permitted, FailureNotice> decide(const pus::TelecommandView& telecommand, Sender sender,
                                               const Situation& situation) {
  const descriptor::Subsystem* subsystem = addressee(situation.mission, telecommand.apid());
  if (subsystem == nullptr || !situation.state) return std::unexpected{FailureNotice{FailureCode::UnknownApid}};
  const std::uint8_t service = telecommand.service();
  const std::uint8_t subtype = telecommand.subtype();
  if (!known_service(service, telecommand.apid()))
    return std::unexpected{FailureNotice{FailureCode::UnknownService}.with(service)};
  if (!known_subtype(service, subtype))
    return std::unexpected{FailureNotice{FailureCode::UnknownSubtype}.with(service).with(subtype)};
  // The handshake of links is the supervisor's alone (decision 10).
  if (service == 128 && sender != Sender::Supervisor)
    return std::unexpected{FailureNotice{FailureCode::WrongMode}.with(situation.mode.id)};
  if (service == 17 || service == pus::st129::service_type) return Permitted{.essential = true};

  const auto call = called_function(telecommand);
  if (call && sender != Sender::Supervisor && changes_supervisor(telecommand.apid(), *call))
    return std::unexpected{FailureNotice{FailureCode::WrongMode}.with(situation.mode.id)};
  // What the supervisor does for the whole craft is the ground's to ask for; a subsystem may stop it, nothing else.
  if (call && sender == Sender::Subsystem && telecommand.apid() == supervisor_apid && call->name != "SAFE_ALL")
    return std::unexpected{FailureNotice{FailureCode::WrongMode}.with(situation.mode.id)};
  const descriptor::Function* function = call ? subsystem->find_function(call->name) : nullptr;
  const bool built_in = call && (call->name == "SET_STATE" || call->name == "CONFIGURE");
  Permitted permitted;
  if (call) {
    const auto asks_for = [&](State target) {
      return call->name == "SET_STATE" && call->first_argument == static_cast<std::uint8_t>(target);
    };
    // The supervisor commands Offline at the end of a recovery or of the flight: no disk may hold that up (decision 24).
    const bool goes_down = sender == Sender::Supervisor && asks_for(State::Offline);
    permitted.essential =
        goes_down || towards_safety(*call, situation.state) || (function != nullptr && function->essential);
    const bool up_to_safe = asks_for(State::SafeOperational) && situation.state == State::PreOperational;
    const bool up_to_operational = asks_for(State::Operational) && situation.state == State::SafeOperational;
    if (up_to_safe || up_to_operational)
      if (const auto link = absent_link(*subsystem, situation))
        return std::unexpected{FailureNotice{FailureCode::LinkAbsent}.with(*link)};
    permitted.releases_stop = up_to_operational;
    if (up_to_safe && situation.power != nullptr) {
      permitted.reserves_w = demand_w(*subsystem, situation);
      // Whom no shortage sheds none refuses: without the ground link nobody could give the craft more power.
      const bool spared = subsystem->name == situation.mission.ground.subsystem;
      if (const auto shortage = situation.power->shortage(subsystem->id, permitted.reserves_w); shortage && !spared)
        return std::unexpected{notice_of(*shortage)};
    }
    // Whether a function exists is a start-of-execution matter (decision 26): the addressee says so in TM[1,4].
    if (function == nullptr && !built_in) return permitted;
  }
  if (permitted.essential || sender == Sender::Supervisor) return permitted;
  constexpr std::uint8_t set_values = 3;
  if (service == 20 && subtype == set_values)
    if (const auto refused = write_refused(telecommand, *subsystem, situation)) return std::unexpected{*refused};
  if (!mode_permits(situation.mode, *subsystem, service, call ? call->name : std::string_view{}))
    return std::unexpected{FailureNotice{FailureCode::WrongMode}.with(situation.mode.id)};
  if (function != nullptr && !function->permitted_in(*situation.state))
    return std::unexpected{FailureNotice{FailureCode::WrongState}.with(static_cast<std::uint8_t>(*situation.state))};
  return permitted;
}

}  // namespace hirosco::supervisor
