// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: permission (docs/safety/modules.csv).
#include "supervisor/supervision/data_handling/permission.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/descriptor/model/supervisor_functions.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::State;
using descriptor::Thing;
using pus::FailureCode;
using pus::FailureNotice;

[[nodiscard]] bool listed(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::any_of(names, [&](const std::string& entry) { return entry == "*" || entry == name; });
}

/// A telecommand with what is known of it before any rule is asked.
struct Asked {
  Asked(const pus::TelecommandView& of, const Origin& from, const Situation& now,
        const descriptor::SubsystemDescriptor& addressee)
      : telecommand{of}, origin{from}, situation{now}, subsystem{addressee} {
    if (service == pus::FunctionService::service_type) call = called_function(telecommand);
    if (call) request = subsystem.find_function(call->name);
    else if (kind == nullptr) request = subsystem.find_request(service, subtype);
  }

  const pus::TelecommandView& telecommand;
  const Origin& origin;
  const Situation& situation;
  const descriptor::SubsystemDescriptor& subsystem;
  const std::uint8_t service{telecommand.service()};
  /// Of a service of the framework, and its request; null: it is an author's, or there is none.
  const pus::ServiceKind* const kind{pus::standard_service(service)};
  const std::uint8_t subtype{
      telecommand.subtype()};  // not beside the service: asked for as one word both would be waited for
  const pus::RequestKind* const standard_request{kind != nullptr ? kind->request(subtype) : nullptr};
  /// What its service needs as a whole; one of an author, or that there is not: nothing.
  const pus::Needs needs{kind != nullptr ? kind->needs : pus::Needs::Nothing};
  std::optional<CalledFunction> call;
  /// The function called or the request of the subsystem's own service; null: none that the descriptor declares.
  const descriptor::Function* request{nullptr};

  [[nodiscard]] std::string_view name() const {
    if (call) return call->name;
    return request != nullptr ? std::string_view{request->name} : std::string_view{};
  }
  [[nodiscard]] bool calls(std::string_view name) const { return call && call->name == name; }
  [[nodiscard]] bool asks_for(State target) const {
    return calls("SET_STATE") && call->first_argument == static_cast<std::uint8_t>(target);
  }
  [[nodiscard]] bool to_supervisor() const { return subsystem.id == supervisor_apid; }
  [[nodiscard]] bool of_subsystem_to_supervisor() const { return origin.is_subsystem() && to_supervisor(); }
};

using Notice = std::optional<FailureNotice>;

// What a rule says that refuses. It is made apart from the rules: nothing of what they let pass waits for a notice's octets.
template <WireNumber... Numbers>
[[nodiscard, gnu::cold, gnu::noinline]] Notice refuse(FailureCode code, Numbers... numbers) {
  FailureNotice notice{code};
  static_cast<void>((notice.with(numbers), ...));
  return notice;
}
[[nodiscard, gnu::cold, gnu::noinline]] Notice refuse_because(const pus::Reason& reason) {
  return FailureNotice{FailureCode::NotPermittedNow}.because(reason);
}

[[nodiscard]] Notice wrong_mode(const Asked& asked) { return refuse(FailureCode::WrongMode, asked.situation.mode.id); }

/// Does this row of the mode mean addressee and sender? Where it names no sender it means whoever may ask; but a subsystem asks the
/// supervisor only where a row names it (docs/adr/0216).
[[nodiscard]] bool permit_means(const descriptor::Permit& permit, const Asked& asked) {
  if (permit.subsystem != "*" && permit.subsystem != asked.subsystem.name) return false;
  if (permit.from.empty()) return !asked.of_subsystem_to_supervisor();
  if (asked.origin.is_ground()) return permit.names(descriptor::ground_origin);
  const auto* sender = asked.situation.mission.find_subsystem(asked.origin.apid());
  return sender != nullptr && permit.names(sender->subsystem.name);
}

[[nodiscard]] bool is_a_write(const Asked& asked) {
  return asked.service == pus::ParameterService::service_type && asked.subtype == pus::ParameterService::set_values;
}

/// Why a parameter write may not pass (hazard SF20): each parameter must be writable in this state by its descriptor,
/// and opened by this mode. Whether the values fit is the addressee's matter.
[[nodiscard]] Notice write_refused(const Asked& asked) {
  const Situation& situation = asked.situation;
  const descriptor::SubsystemDescriptor& subsystem = asked.subsystem;
  OctetReader reader{asked.telecommand.application_data()};
  const auto count = reader.get<std::uint8_t>();
  for (unsigned i = 0; i < count && reader.good(); ++i) {
    const auto id = reader.get<std::uint32_t>();
    const auto place = descriptor::find_parameter(subsystem, id);
    // An unknown one hides the width of all behind it; the addressee refuses the whole (adr 0074).
    if (!reader.good() || !place) return std::nullopt;
    const descriptor::Parameter* const parameter = &subsystem.parameters[place->parameter];
    static_cast<void>(reader.get(parameter->octets(place->member)));
    const bool opened = std::ranges::any_of(situation.mode.permits, [&](const descriptor::Permit& permit) {
      return permit_means(permit, asked) && listed(permit.parameters, parameter->field.name);
    });
    if (!parameter->writable() || !parameter->writable_in(*situation.state))
      return refuse(FailureCode::NotPermittedNow, static_cast<std::uint8_t>(i), id);
    if (!opened) return refuse(FailureCode::WrongMode, situation.mode.id, id);
  }
  return std::nullopt;
}

/// The addressee's configuration in force; null: it has none.
[[nodiscard]] inline const descriptor::Configuration* in_force(const Asked& asked) {
  const std::uint8_t configuration = asked.situation.configuration;
  return configuration == 0 ? nullptr : asked.subsystem.find_configuration(configuration);
}

[[nodiscard]] std::optional<std::uint8_t> absent_link(const Asked& asked) {
  const auto* configuration = in_force(asked);
  return configuration == nullptr ? std::nullopt : asked.situation.links.absent_for(asked.subsystem.id, *configuration);
}

/// Most that the addressee's configuration in force draws.
[[nodiscard]] double demand_w(const Asked& asked) {
  const auto* configuration = in_force(asked);
  return configuration != nullptr ? configuration->power_w : 0;
}

/// `shortage` in mW.
[[nodiscard]] Notice refuse_for(const Shortage& shortage) {
  return refuse(FailureCode::PowerShort, shortage.budget, shortage.reserved, shortage.requested);
}

/// Towards safety: never delayed or refused by mode (decision 24).
[[nodiscard]] bool towards_safety(const Asked& asked) {
  return asked.asks_for(State::ErrorOperational) || asked.asks_for(State::PostOperational) ||
         (asked.asks_for(State::SafeOperational) && asked.situation.state == State::Operational);
}

/// What the supervisor does for the whole craft is bound to the mode for a subsystem; stopping it is anybody's.
[[nodiscard]] bool stops_the_craft(const Asked& asked) { return asked.to_supervisor() && asked.calls("SAFE_ALL"); }

[[nodiscard]] bool is_essential(const Asked& asked) {
  const auto needs =
      asked.standard_request != nullptr ? asked.standard_request->needs.value_or(asked.needs) : asked.needs;
  if (needs == pus::Needs::Essential || needs == pus::Needs::SupervisorAnswers) return true;
  // The supervisor commands Offline at the end of a recovery or of the flight: no disk may hold that up (decision 24).
  const bool goes_down = asked.origin.is_supervisor() && asked.asks_for(State::Offline);
  if (goes_down || towards_safety(asked)) return true;
  return asked.request != nullptr && asked.request->essential &&
         (!asked.of_subsystem_to_supervisor() || stops_the_craft(asked));
}

[[nodiscard]] bool up_to_safe(const Asked& asked) {
  return asked.asks_for(State::SafeOperational) && asked.situation.state == State::PreOperational;
}
[[nodiscard]] bool up_to_operational(const Asked& asked) {
  return asked.asks_for(State::Operational) && asked.situation.state == State::SafeOperational;
}

/// Who is down is started again by the ground and nobody else: a plan has its limit, and nobody on board goes round that.
[[nodiscard]] bool starts(const Asked& asked) {
  return asked.situation.down && asked.origin.is_ground() && asked.asks_for(State::Offline);
}

/// Does anybody ask the addressee for something of this service?
[[nodiscard]] bool has_service(const Asked& asked) {
  return asked.kind != nullptr ? !asked.kind->requests.empty() : asked.subsystem.find_service(asked.service) != nullptr;
}

// --- the rules ---------------------------------------------------------------------------------------------------------

/// Is there such a request? Service and subtype are the framework's, or the addressee's own.
[[nodiscard]] Notice is_known(const Asked& asked) {
  const bool known = asked.standard_request != nullptr || (asked.kind == nullptr && asked.request != nullptr);
  const bool elsewhere = asked.needs == pus::Needs::SupervisorAnswers && !asked.to_supervisor();
  if (!known && !elsewhere && has_service(asked))
    return refuse(FailureCode::UnknownSubtype, asked.service, asked.subtype);
  // It may be left out, by its descriptor or by the configuration in force (docs/adr/0096).
  if (!known || elsewhere || !asked.subsystem.offers(asked.service, in_force(asked)))
    return refuse(FailureCode::UnknownService, asked.service);
  return std::nullopt;
}

/// What a request of the framework's services is about, where a descriptor can declare that.
[[nodiscard]] std::optional<Thing::Kind> thing_of(std::uint8_t service, std::uint8_t subtype) noexcept {
  using Housekeeping = pus::HousekeepingService;
  using Events = pus::EventService;
  using Parameters = pus::ParameterService;
  const auto is = [=](std::uint8_t type, std::initializer_list<std::uint8_t> subtypes) {
    return service == type && std::ranges::find(subtypes, subtype) != subtypes.end();
  };
  if (is(Parameters::service_type, {Parameters::set_values})) return Thing::Kind::Set;
  if (is(Parameters::service_type, {Parameters::report_values})) return Thing::Kind::Read;
  if (is(Events::service_type, {Events::enable_reports, Events::disable_reports})) return Thing::Kind::Event;
  if (is(Housekeeping::service_type, {Housekeeping::enable_periodic, Housekeeping::disable_periodic,
                                      Housekeeping::one_shot, Housekeeping::modify_interval}))
    return Thing::Kind::Housekeeping;
  return std::nullopt;
}

/// Is each that the telecommand names among these, and is there one?
[[nodiscard]] bool names_only(const Asked& asked, Thing::Kind kind, const std::vector<Thing>& things) {
  OctetReader reader{asked.telecommand.application_data()};
  const auto count = reader.get<std::uint8_t>();
  const bool of_parameters = kind == Thing::Kind::Set || kind == Thing::Kind::Read;
  const bool has_interval = asked.subtype == pus::HousekeepingService::modify_interval;
  for (unsigned i = 0; i < count; ++i) {
    const std::uint32_t id = of_parameters ? reader.get<std::uint32_t>() : reader.get<std::uint16_t>();
    const auto found =
        std::ranges::find_if(things, [&](const Thing& each) { return each.kind == kind && each.id == id; });
    if (!reader.good() || found == things.end()) return false;
    if (kind == Thing::Kind::Housekeeping && has_interval) static_cast<void>(reader.get<std::uint32_t>());
    if (kind == Thing::Kind::Set)
      for (const descriptor::Field& field : found->fields) static_cast<void>(reader.get(field.octets()));
  }
  return count > 0 && reader.exhausted();
}

/// Does the descriptor of who sends it say that it commands the addressee, and for this?
[[nodiscard]] bool is_declared(const Asked& asked) {
  const auto* sender = asked.situation.mission.find_subsystem(asked.origin.apid());
  if (sender == nullptr) return false;
  const auto kind = thing_of(asked.service, asked.subtype);
  return std::ranges::any_of(sender->subsystem.commands, [&](const descriptor::Commands& commands) {
    if (commands.apid != asked.telecommand.apid()) return false;
    if (kind) return names_only(asked, *kind, commands.things);
    return std::ranges::find(commands.functions, asked.name()) != commands.functions.end();
  });
}

[[nodiscard]] bool is_about_subscriptions(const Asked& asked) {
  const std::uint8_t subtype = asked.subtype;
  return asked.to_supervisor() && asked.service == pus::st129::service_type &&
         (subtype == pus::st129::subscribe || subtype == pus::st129::unsubscribe);
}

/// Does its descriptor say that it hears this? Nobody but a subsystem hears anything.
[[nodiscard]] bool may_hear(const Asked& asked) {
  const auto* sender =
      asked.origin.is_subsystem() ? asked.situation.mission.find_subsystem(asked.origin.apid()) : nullptr;
  const auto wanted = pus::st129::read_subscribed(asked.telecommand.application_data());
  if (sender == nullptr || !wanted) return false;
  const bool event = wanted->what == pus::st129::Subscribed::What::Event;
  const auto kind = event ? Thing::Kind::Event : Thing::Kind::Housekeeping;
  return std::ranges::any_of(sender->subsystem.subscribes, [&](const descriptor::Subscribes& subscribes) {
    return subscribes.apid == wanted->apid && std::ranges::any_of(subscribes.things, [&](const Thing& thing) {
             return thing.kind == kind && thing.id == wanted->id;
           });
  });
}

[[nodiscard]] bool is_about_the_log(const Asked& asked) {
  return asked.to_supervisor() && asked.service == pus::st129::service_type && asked.subtype == pus::st129::retrieve;
}

/// May this sender ask anybody for it? Inline: for whoever is not the supervisor it is the whole of is_the_senders().
[[nodiscard]] inline Notice may_ask(const Asked& asked) {
  if (asked.origin.is_supervisor()) return std::nullopt;
  if (asked.needs == pus::Needs::SupervisorAsks) return wrong_mode(asked);
  if (asked.origin.is_subsystem() && !stops_the_craft(asked) && !is_declared(asked))
    return refuse(FailureCode::NotDeclared);
  return std::nullopt;
}

/// May it ask the supervisor? What is said of anybody besides holds here, too.
[[nodiscard]] Notice may_ask_supervisor(const Asked& asked) {
  // What was said before goes to ground: the downlink is no subsystem's to fill.
  if (is_about_the_log(asked) && !asked.origin.is_ground()) return refuse(FailureCode::NotDeclared);
  if (is_about_subscriptions(asked)) return may_hear(asked) ? std::nullopt : refuse(FailureCode::NotDeclared);
  // Its states are what everything else stands on: SHUTDOWN and SET_MODE are the ways to change them (hazard SF1).
  if (!asked.origin.is_supervisor() && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode(asked);
  if (auto refused = may_ask(asked)) return refused;
  // Whatever a descriptor declares and a mode permits: what lifts, raises or replaces what safety rests on is no subsystem's to ask for.
  if (asked.origin.is_subsystem() && asked.call && !descriptor::is_for_subsystems(asked.call->name))
    return refuse_because({ErrorCode::NotPermitted, 0, "of the supervisor the ground alone may ask for that"});
  return std::nullopt;
}

/// May this sender ask this addressee for it?
[[nodiscard]] Notice is_the_senders(const Asked& asked) {
  return asked.to_supervisor() ? may_ask_supervisor(asked) : may_ask(asked);
}

/// The configuration that would follow the one in force without a break (docs/adr/0096); null: it is asked for nothing of the kind.
[[nodiscard]] const descriptor::Configuration* following(const Asked& asked) {
  const auto state = asked.situation.state;
  const bool acts = state == State::SafeOperational || state == State::Operational;
  if (!acts || !asked.calls("CONFIGURE") || !asked.call->first_argument) return nullptr;
  const std::uint8_t wanted = *asked.call->first_argument;
  if (asked.subsystem.bumpless_between(asked.situation.configuration, wanted) == nullptr) return nullptr;
  return asked.subsystem.find_configuration(wanted);
}

/// Whom no shortage refuses: without the supervisor, which may have been started anew meanwhile, or the ground link nobody could give the
/// craft more power, without who measures it nobody would know of any.
[[nodiscard]] bool needs_no_grant(const Asked& asked) {
  const descriptor::Mission& mission = asked.situation.mission;
  return asked.to_supervisor() || asked.subsystem.name == mission.ground.subsystem ||
         (mission.power_measured && mission.power_measured->apid == asked.subsystem.id);
}

/// With power that it is not granted, or a cycle that may keep others waiting, nobody goes on.
[[nodiscard]] Notice is_carried(const Asked& asked, const descriptor::Configuration& wanted) {
  const Situation& situation = asked.situation;
  if (situation.power != nullptr && !needs_no_grant(asked))
    if (const auto shortage = situation.power->shortage(asked.subsystem.id, wanted.power_w))
      return refuse_for(*shortage);
  if (situation.in_force == nullptr) return std::nullopt;
  auto all = (*situation.in_force)();
  for (descriptor::InForce& each : all)
    if (each.subsystem->id == asked.subsystem.id) each.configuration = &wanted;
  // Each of them may be brought down later, which takes its loops of services back to what it says itself.
  for (const descriptor::CycleResponse& cycle : descriptor::cycle_responses_around(all)) {
    if (cycle.longest) continue;
    const std::string why =
        "may not end in time then: " + std::string{cycle.subsystem} + " " + std::string{cycle.name()};
    return refuse_because({ErrorCode::NotPermitted, cycle.period() / std::chrono::microseconds{1}, why});
  }
  return std::nullopt;
}

/// Has the addressee what it needs on its way up, or for another configuration while it acts: links, power, its cycle's time?
[[nodiscard]] Notice is_provided_for(const Asked& asked) {
  const Situation& situation = asked.situation;
  if (const auto* wanted = following(asked)) return is_carried(asked, *wanted);
  if (up_to_safe(asked) || up_to_operational(asked))
    if (const auto link = absent_link(asked)) return refuse(FailureCode::LinkAbsent, *link);
  if (!(up_to_safe(asked) || up_to_operational(asked)) || situation.power == nullptr) return std::nullopt;
  if (needs_no_grant(asked)) return std::nullopt;
  if (const auto shortage = situation.power->shortage(asked.subsystem.id, demand_w(asked)))
    return refuse_for(*shortage);
  return std::nullopt;
}

/// What is neither essential nor the supervisor's own is bound to mode and state.
[[nodiscard]] bool is_bound(const Asked& asked, bool essential) {
  if (essential || asked.origin.is_supervisor()) return false;
  // Whether a function exists is a start-of-execution matter (decision 26): the addressee says so in TM[1,4].
  const bool unknown_function =
      asked.call && asked.request == nullptr && !asked.calls("SET_STATE") && !asked.calls("CONFIGURE");
  return !unknown_function;
}

constexpr unsigned all_states = 0x03FF;

/// In which states it is permitted, by the addressee's descriptor or the service's own table: is_known() has found it in one of them.
[[nodiscard]] unsigned states_of(const Asked& asked) {
  if (asked.request != nullptr) return asked.request->states;
  return asked.standard_request->states;
}

/// What safety rests on is switched off by nobody, in whatever mode, state or language of its subsystem (docs/adr/0091).
[[nodiscard]] Notice spares_safety(const Asked& asked) {
  using pus::EventService;
  if (asked.service != EventService::service_type || asked.subtype != EventService::disable_reports)
    return std::nullopt;
  OctetReader reader{asked.telecommand.application_data()};
  const auto count = reader.get<std::uint8_t>();
  for (unsigned i = 0; i < count && reader.good(); ++i) {
    const std::uint32_t id = reader.get<std::uint16_t>();
    const auto event = std::ranges::find(asked.subsystem.events, id, &descriptor::Event::id);
    if (!reader.good() || event == asked.subsystem.events.end()) continue;
    if (event->safety || (asked.to_supervisor() && descriptor::is_about_subsystem(event->name)))
      return refuse(FailureCode::NotPermittedNow, static_cast<std::uint8_t>(i), id);
  }
  return std::nullopt;
}

/// More than a look. What a service itself permits in some states only is that, too, as a self test.
[[nodiscard]] bool acts(const Asked& asked) {
  const std::uint8_t service = asked.service;
  return service == pus::FunctionService::service_type || asked.kind == nullptr || is_a_write(asked) ||
         states_of(asked) != all_states;
}

/// What the old mode permitted and the new one may not would cross the change: until it has ended the craft is looked at, and taken
/// towards safety, nothing else.
[[nodiscard]] Notice crosses_no_change(const Asked& asked) {
  const Situation& situation = asked.situation;
  if (!situation.changing && !situation.rereading) return std::nullopt;
  if (!acts(asked)) return std::nullopt;
  if (situation.rereading) return refuse_because({ErrorCode::NotPermitted, 0, "its descriptor is being read again"});
  return refuse_because({ErrorCode::NotPermitted, situation.mode.id, "a change of mode is under way, from mode"});
}

/// Does the mode open it?
[[nodiscard]] Notice is_in_mode(const Asked& asked) {
  const std::uint8_t service = asked.service;
  const bool sets = is_a_write(asked);
  if (sets)
    if (const auto refused = write_refused(asked)) return refused;
  const std::string_view name = asked.name();
  const bool opened = std::ranges::any_of(asked.situation.mode.permits, [&](const descriptor::Permit& permit) {
    if (!permit_means(permit, asked)) return false;
    if (std::ranges::find(permit.services, service) != permit.services.end()) return true;
    // Each parameter that it sets is opened, else it were refused by now; of one that is unknown the addressee refuses the whole.
    if (sets) return !permit.parameters.empty();
    return (asked.request != nullptr || service == pus::FunctionService::service_type) &&
           listed(permit.functions, name);
  });
  if (!opened) return wrong_mode(asked);
  return std::nullopt;
}

/// Is it permitted in the addressee's state?
[[nodiscard]] Notice is_in_state(const Asked& asked) {
  const auto state = asked.situation.state;
  if (!state || (states_of(asked) >> static_cast<int>(*state) & 1) != 0) return std::nullopt;
  return refuse(FailureCode::WrongState, static_cast<std::uint8_t>(*state));
}

/// What the first rule says that refuses. A look at what is essential has passed with three of them.
[[nodiscard]] Notice refusal_of(const Asked& asked, bool bound) {
  if (auto refused = is_known(asked)) return refused;
  if (auto refused = is_the_senders(asked)) return refused;
  if (auto refused = spares_safety(asked)) return refused;
  if (asked.call)
    if (auto refused = is_provided_for(asked)) return refused;
  if (!bound) return std::nullopt;
  if (auto refused = crosses_no_change(asked)) return refused;
  if (auto refused = is_in_mode(asked)) return refused;
  return is_in_state(asked);
}

}  // namespace

FailureNotice is_down() {
  FailureNotice notice{FailureCode::UnknownApid};
  return notice.because({ErrorCode::Unavailable, 0, "it is down; SET_STATE Offline starts it again"});
}

std::expected<Permitted, FailureNotice> decide(const pus::TelecommandView& telecommand, const Origin& origin,
                                               const Situation& situation) {
  const descriptor::SubsystemDescriptor* subsystem = situation.mission.find_member(telecommand.apid());
  if (subsystem == nullptr) return std::unexpected{FailureNotice{FailureCode::UnknownApid}};
  const Asked asked{telecommand, origin, situation, *subsystem};
  if (!situation.state && !starts(asked))
    return std::unexpected{situation.down ? is_down() : FailureNotice{FailureCode::UnknownApid}};
  const bool essential = is_essential(asked);
  const bool bound = is_bound(asked, essential);
  if (const auto refused = refusal_of(asked, bound)) return std::unexpected{*refused};
  if (!bound && !asked.call) return Permitted{.essential = essential};  // a look, mostly
  Permitted permitted{.essential = essential, .acts = bound && acts(asked)};
  if (!asked.call) return permitted;
  const auto* const wanted = following(asked);
  const bool reserves = (up_to_safe(asked) || wanted != nullptr) && situation.power != nullptr;
  // Until it has gone over it draws what it draws.
  const double reserves_w = wanted == nullptr ? demand_w(asked) : std::max(wanted->power_w, demand_w(asked));
  permitted.releases_stop = up_to_operational(asked);
  permitted.starts = starts(asked);
  permitted.stops_the_craft = stops_the_craft(asked);
  permitted.reserves_w = reserves ? reserves_w : 0;
  return permitted;
}

}  // namespace hirosco::supervisor
