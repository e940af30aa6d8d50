// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/commanded_state.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"

namespace hirosco::supervisor {
namespace {

using Structures = pus::HousekeepingService;
using EventReports = pus::EventService;
using ParameterValues = pus::ParameterService;

/// Of the application data of one telecommand that brings settings back.
constexpr std::size_t most_setting_octets = 800;

/// How far up it is: what is neither Offline nor Safe-Operational nor Operational has the rank of Pre-Operational.
[[nodiscard]] constexpr int rank(State state) noexcept {
  switch (state) {
    case State::Offline: return 0;
    case State::SafeOperational: return 2;
    case State::Operational: return 3;
    default: return 1;
  }
}
[[nodiscard]] constexpr State on_the_way_up(State state) noexcept {
  return rank(state) == 1 ? State::PreOperational : state;
}

[[nodiscard]] std::vector<std::uint16_t> ids_of(Octets data, std::size_t octets_each) {
  std::vector<std::uint16_t> ids;
  for (std::size_t at = 1; at + octets_each <= data.size(); at += octets_each)
    ids.push_back(OctetReader{data.subspan(at, 2)}.get<std::uint16_t>());
  return ids;
}

[[nodiscard]] std::vector<std::byte> copy(Octets octets) { return {octets.begin(), octets.end()}; }

/// N and what follows, N times.
[[nodiscard]] std::vector<std::byte> list_of_one(std::uint16_t id) {
  std::vector<std::byte> data(3);
  OctetWriter{data}.put(std::uint8_t{1}).put(id);
  return data;
}

/// A function, or a request of a service of its own: both may set what nobody sets again.
[[nodiscard]] const descriptor::Function* function_of(const pus::TelecommandView& telecommand,
                                                      const descriptor::SubsystemDescriptor& subsystem) {
  const auto call = called_function(telecommand);
  return call ? subsystem.find_function(call->name)
              : subsystem.find_request(telecommand.service(), telecommand.subtype());
}

[[nodiscard]] bool is_parameter_write(const pus::TelecommandView& telecommand) {
  return telecommand.service() == ParameterValues::service_type && telecommand.subtype() == ParameterValues::set_values;
}
[[nodiscard]] bool is_event_switch(const pus::TelecommandView& telecommand) {
  return telecommand.service() == EventReports::service_type &&
         (telecommand.subtype() == EventReports::enable_reports ||
          telecommand.subtype() == EventReports::disable_reports);
}
[[nodiscard]] bool is_definition(const pus::TelecommandView& telecommand) {
  constexpr std::array subtypes{Structures::create_structure,  Structures::delete_structures,
                                Structures::enable_periodic,   Structures::disable_periodic,
                                Structures::append_parameters, Structures::modify_interval};
  return telecommand.service() == Structures::service_type &&
         std::ranges::find(subtypes, telecommand.subtype()) != subtypes.end();
}

}  // namespace

void CommandedState::lower(State most) noexcept {
  if (rank(most) < rank(state_)) state_ = on_the_way_up(most);
}

bool CommandedState::concerns(const pus::TelecommandView& telecommand,
                              const descriptor::SubsystemDescriptor& subsystem) {
  if (is_parameter_write(telecommand) || is_event_switch(telecommand) || is_definition(telecommand)) return true;
  if (const auto call = called_function(telecommand); call && (call->name == "SET_STATE" || call->name == "CONFIGURE"))
    return call->first_argument.has_value();
  const auto* function = function_of(telecommand, subsystem);
  return function != nullptr && !function->unrepeated.empty();
}

Kept CommandedState::completed(const pus::TelecommandView& telecommand,
                               const descriptor::SubsystemDescriptor& subsystem) {
  const Octets data = telecommand.application_data();
  if (is_parameter_write(telecommand)) set_parameters(data, subsystem);
  else if (is_event_switch(telecommand)) switch_events(data, telecommand.subtype() == EventReports::enable_reports);
  else if (is_definition(telecommand)) return define(telecommand.subtype(), data, subsystem);
  else if (const auto call = called_function(telecommand); call && call->name == "SET_STATE" && call->first_argument)
    enter(static_cast<State>(*call->first_argument));
  else if (call && call->name == "CONFIGURE" && call->first_argument) configure(*call->first_argument, subsystem);
  else if (function_of(telecommand, subsystem) != nullptr) may_have_set(telecommand, subsystem);
  else return Kept::NoMatter;
  return Kept::Yes;
}

void CommandedState::may_have_set(const pus::TelecommandView& telecommand,
                                  const descriptor::SubsystemDescriptor& subsystem) {
  if (const auto* function = function_of(telecommand, subsystem); function != nullptr)
    unrepeated_.insert(function->unrepeated.begin(), function->unrepeated.end());
}

/// What a state gives back is gone with it: in Offline the values, below Safe-Operational, but by CONFIGURE, the configuration.
void CommandedState::enter(State state) noexcept {
  const bool from_offline = state_ == State::Offline;
  // Error- and Post-Operational are stages of a way down: what was commanded before that is not below them.
  if (state == State::ErrorOperational || state == State::PostOperational) lower(state);
  else state_ = state;
  const bool holds_configuration =
      state == State::SafeOperational || state == State::Operational || state == State::ErrorOperational;
  if (holds_configuration) return;
  configuration_ = 0;
  structures_.clear();
  if (state != State::Offline && !from_offline) return;
  parameters_.clear();
  unrepeated_.clear();
}

void CommandedState::configure(std::uint8_t id, const descriptor::SubsystemDescriptor& subsystem) {
  if (configuration_ == id) return;  // it was in force: nothing has happened
  configuration_ = id;
  structures_.clear();
  const auto* configuration = subsystem.find_configuration(id);
  if (configuration == nullptr) return;
  std::erase_if(parameters_, [&](const ParameterValue& set) {
    const auto place = descriptor::find_parameter(subsystem, set.id);
    return place && std::ranges::any_of(configuration->initial, [&](const auto& initial) {
             return descriptor::overlap(subsystem, initial.parameter, *place);
           });
  });
}

void CommandedState::set_parameters(Octets data, const descriptor::SubsystemDescriptor& subsystem) {
  OctetReader reader{data};
  const auto count = reader.get<std::uint8_t>();
  for (unsigned i = 0; i < count && reader.good(); ++i) {
    const auto id = reader.get<std::uint32_t>();
    const auto place = descriptor::find_parameter(subsystem, id);
    if (!reader.good() || !place) return;
    const descriptor::Parameter& parameter = subsystem.parameters[place->parameter];
    const Octets value = reader.get(parameter.octets(place->member));
    if (!reader.good()) return;
    // A whole structure takes the place of what is in it.
    std::erase_if(parameters_, [&](const ParameterValue& set) {
      const auto earlier = descriptor::find_parameter(subsystem, set.id);
      return earlier && descriptor::covers(subsystem, *place, *earlier);
    });
    parameters_.push_back({id, copy(value)});
  }
}

void CommandedState::switch_events(Octets data, bool enabled) {
  for (const std::uint16_t id : ids_of(data, 2))
    if (enabled) silent_events_.erase(id);
    else silent_events_.insert(id);
}

Kept CommandedState::define(std::uint8_t subtype, Octets data, const descriptor::SubsystemDescriptor& subsystem) {
  if (subtype == Structures::create_structure || subtype == Structures::append_parameters) {
    const auto id = OctetReader{data}.get<std::uint16_t>();
    const bool creates = subtype == Structures::create_structure;
    if (!creates && !is_defined(id, subsystem)) return Kept::NoRoom;
    if (definition_octets() + data.size() > most_definition_octets) return Kept::NoRoom;
    if (creates) std::erase_if(structures_, [id](const Structure& each) { return each.id == id; });
    if (creates) structure(id).created = copy(data);
    else structure(id).appended.push_back(copy(data));
    return Kept::Yes;
  }
  const bool intervals = subtype == Structures::modify_interval;
  bool all = true;
  const auto ids = ids_of(data, intervals ? 6 : 2);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (subtype == Structures::delete_structures) {
      std::erase_if(structures_, [&](const Structure& each) { return each.id == ids[i]; });
      continue;
    }
    if (!is_defined(ids[i], subsystem)) {
      all = false;  // its definition had no room
      continue;
    }
    Structure& one = structure(ids[i]);
    if (intervals) one.interval = OctetReader{data.subspan(1 + 6 * i + 2, 4)}.get<std::uint32_t>();
    else one.periodic = subtype == Structures::enable_periodic;
  }
  return all ? Kept::Yes : Kept::NoRoom;
}

const descriptor::HousekeepingStructure* CommandedState::declared(
    std::uint16_t id, const descriptor::SubsystemDescriptor& subsystem) const {
  const auto in = [id](const std::vector<descriptor::HousekeepingStructure>& all) {
    const auto found = std::ranges::find(all, id, &descriptor::HousekeepingStructure::id);
    return found != all.end() ? &*found : nullptr;
  };
  const auto* configuration = subsystem.find_configuration(configuration_);
  const auto* own = configuration != nullptr ? in(configuration->housekeeping) : nullptr;
  return own != nullptr ? own : in(subsystem.housekeeping);
}

bool CommandedState::is_defined(std::uint16_t id, const descriptor::SubsystemDescriptor& subsystem) const {
  if (declared(id, subsystem) != nullptr) return true;
  return std::ranges::any_of(structures_,
                             [id](const Structure& each) { return each.id == id && !each.created.empty(); });
}

CommandedState::Structure& CommandedState::structure(std::uint16_t id) {
  const auto found = std::ranges::find(structures_, id, &Structure::id);
  if (found != structures_.end()) return *found;
  structures_.push_back({.id = id});
  return structures_.back();
}

std::size_t CommandedState::definition_octets() const noexcept {
  std::size_t sum = 0;
  for (const Structure& each : structures_) {
    sum += each.created.size();
    for (const auto& part : each.appended) sum += part.size();
  }
  return sum;
}

std::vector<SettingCommand> CommandedState::settings_for(State state,
                                                         const descriptor::SubsystemDescriptor& subsystem) const {
  std::vector<SettingCommand> all;
  for (const ParameterValue& set : parameters_) {
    const auto place = descriptor::find_parameter(subsystem, set.id);
    if (!place) continue;
    const descriptor::Parameter& parameter = subsystem.parameters[place->parameter];
    const bool earlier = state == State::SafeOperational && parameter.writable_in(State::PreOperational);
    if (earlier || !parameter.writable_in(state)) continue;
    const bool fits = !all.empty() && all.back().data.size() + 4 + set.value.size() <= most_setting_octets &&
                      all.back().data.front() != std::byte{255};
    if (!fits) all.push_back({ParameterValues::service_type, ParameterValues::set_values, {std::byte{0}}});
    std::vector<std::byte>& data = all.back().data;
    data.front() = static_cast<std::byte>(std::to_integer<unsigned>(data.front()) + 1);
    const std::size_t at = data.size();
    data.resize(at + 4);
    OctetWriter{MutableOctets{data}.subspan(at)}.put(set.id);
    data.insert(data.end(), set.value.begin(), set.value.end());
  }
  if (state != State::PreOperational) return all;
  for (const std::uint16_t id : silent_events_)
    all.push_back({EventReports::service_type, EventReports::disable_reports, list_of_one(id)});
  const auto say = [&all](std::uint8_t subtype, std::vector<std::byte> data) {
    all.push_back({Structures::service_type, subtype, std::move(data)});
  };
  for (const Structure& each : structures_) {
    const auto* as_declared = each.created.empty() ? declared(each.id, subsystem) : nullptr;
    if (!each.created.empty()) say(Structures::create_structure, each.created);
    // What is on is not lengthened, and first ends the interval that it is in; its interval is one that all it will have
    // can keep.
    else if (!each.appended.empty() || each.interval) say(Structures::disable_periodic, list_of_one(each.id));
    if (each.interval) {
      std::vector<std::byte> data = list_of_one(each.id);
      data.resize(7);
      OctetWriter{MutableOctets{data}.subspan(3)}.put(*each.interval);
      say(Structures::modify_interval, std::move(data));
    }
    for (const auto& part : each.appended) say(Structures::append_parameters, part);
    const bool on_as_declared = as_declared != nullptr && as_declared->enabled;
    if (each.periodic || (each.interval && on_as_declared))
      say(each.periodic.value_or(on_as_declared) ? Structures::enable_periodic : Structures::disable_periodic,
          list_of_one(each.id));
  }
  return all;
}

std::vector<std::string> CommandedState::out_of_reach(const descriptor::SubsystemDescriptor& subsystem) const {
  std::vector<std::string> names;
  for (const ParameterValue& set : parameters_)
    if (const auto place = descriptor::find_parameter(subsystem, set.id)) {
      const descriptor::Parameter& parameter = subsystem.parameters[place->parameter];
      if (!parameter.writable_in(State::PreOperational) && !parameter.writable_in(State::SafeOperational))
        names.push_back(parameter.field.name);
    }
  return names;
}

std::vector<std::string> CommandedState::unrepeated_names(const descriptor::SubsystemDescriptor& subsystem) const {
  std::vector<std::string> names;
  for (const std::uint16_t parameter : unrepeated_)
    if (parameter < subsystem.parameters.size()) names.push_back(subsystem.parameters[parameter].field.name);
  return names;
}

namespace {

void put_octets(OctetWriter& writer, Octets octets) {
  writer.put(static_cast<std::uint16_t>(octets.size())).put(octets);
}

[[nodiscard]] std::vector<std::byte> get_octets(OctetReader& reader) {
  const Octets octets = reader.get(reader.get<std::uint16_t>());
  return {octets.begin(), octets.end()};
}

}  // namespace

void CommandedState::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(state_)).put(configuration_);
  writer.put(static_cast<std::uint16_t>(unrepeated_.size()));
  for (const std::uint16_t parameter : unrepeated_) writer.put(parameter);
  writer.put(static_cast<std::uint16_t>(parameters_.size()));
  for (const ParameterValue& each : parameters_) {
    writer.put(each.id);
    put_octets(writer, each.value);
  }
  writer.put(static_cast<std::uint16_t>(silent_events_.size()));
  for (const std::uint16_t event : silent_events_) writer.put(event);
  writer.put(static_cast<std::uint16_t>(structures_.size()));
  for (const Structure& each : structures_) {
    writer.put(each.id).put(static_cast<std::uint8_t>(each.interval ? 1 : 0)).put(each.interval.value_or(0));
    writer.put(static_cast<std::uint8_t>(each.periodic ? (*each.periodic ? 2 : 1) : 0));
    put_octets(writer, each.created);
    writer.put(static_cast<std::uint16_t>(each.appended.size()));
    for (const auto& appended : each.appended) put_octets(writer, appended);
  }
}

void CommandedState::recall(OctetReader& reader) {
  *this = {};
  const auto state = reader.get<std::uint8_t>();
  if (state <= static_cast<std::uint8_t>(State::SoftwareDeinit)) state_ = static_cast<State>(state);
  configuration_ = reader.get<std::uint8_t>();
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left)
    unrepeated_.insert(reader.get<std::uint16_t>());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto id = reader.get<std::uint32_t>();
    parameters_.push_back({id, get_octets(reader)});
  }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left)
    silent_events_.insert(reader.get<std::uint16_t>());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    Structure each;
    each.id = reader.get<std::uint16_t>();
    const bool paced = reader.get<std::uint8_t>() != 0;
    const auto interval = reader.get<std::uint32_t>();
    if (paced) each.interval = interval;
    const auto periodic = reader.get<std::uint8_t>();
    if (periodic != 0) each.periodic = periodic == 2;
    each.created = get_octets(reader);
    for (auto more = reader.get<std::uint16_t>(); more > 0 && reader.good(); --more)
      each.appended.push_back(get_octets(reader));
    structures_.push_back(std::move(each));
  }
}

}  // namespace hirosco::supervisor
