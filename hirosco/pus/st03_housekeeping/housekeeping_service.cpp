// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

#include <algorithm>

#include "hirosco/pus/st03_housekeeping/housekeeping_definition.hpp"

namespace hirosco::pus {
namespace {

using descriptor::HousekeepingStructure;

constexpr std::size_t id_octets = 2;
constexpr std::size_t id_and_interval_octets = 6;

[[nodiscard]] std::uint16_t id_at(Octets list, std::size_t index, std::size_t octets_each) noexcept {
  return OctetReader{list.subspan(1 + octets_each * index, id_octets)}.get<std::uint16_t>();
}
[[nodiscard]] std::uint32_t interval_at(Octets list, std::size_t index) noexcept {
  return OctetReader{list.subspan(1 + id_and_interval_octets * index + id_octets, 4)}.get<std::uint32_t>();
}

[[nodiscard]] FailureNotice failure(FailureCode code, std::size_t index) noexcept {
  return FailureNotice{code}.with(static_cast<std::uint8_t>(index));
}

template <class Wanted>
[[nodiscard]] std::optional<std::size_t> place_of(std::span<const SampledValue> values, Wanted&& wanted) noexcept {
  const auto found = std::ranges::find_if(values, wanted);
  if (found == values.end()) return std::nullopt;
  return static_cast<std::size_t>(found - values.begin());
}

}  // namespace

HousekeepingService::HousekeepingService(const descriptor::SubsystemDescriptor& subsystem, HousekeepingSampler& sampler,
                                         Verification& verification, TelemetrySink& sink)
    : subsystem_{subsystem}, sampler_{sampler}, verification_{verification}, sink_{sink} {
  structures_.reserve(max_housekeeping_structures);
  const auto add = [this](Type layout, std::uint8_t id, std::size_t parameter, int member, std::size_t octets) {
    values_.push_back({ParameterId{subsystem_.id, layout, id}.wire(), static_cast<std::uint16_t>(parameter),
                       static_cast<std::int16_t>(member),
                       static_cast<std::uint16_t>(std::min<std::size_t>(octets, UINT16_MAX))});
  };
  for (std::size_t i = 0; i < subsystem.parameters.size(); ++i) {
    const auto& parameter = subsystem.parameters[i];
    add(parameter.field.type, parameter.id, i, -1, parameter.octets());
    for (std::uint16_t m = 0; m < parameter.numbers(); ++m) {
      const auto inner = parameter.identity_of(m);
      add(inner.type, inner.id, i, m, parameter.octets(m));
    }
  }
}

HousekeepingService::Structure* HousekeepingService::find(std::uint16_t id) noexcept {
  const auto found = std::ranges::find(structures_, id, &Structure::id);
  return found == structures_.end() ? nullptr : &*found;
}
std::optional<std::size_t> HousekeepingService::find_value(std::uint32_t wire) const noexcept {
  return place_of(values_, [wire](const SampledValue& value) { return value.wire == wire; });
}
const HousekeepingLayout& HousekeepingService::layout_of(const Structure& structure) const noexcept {
  return sampler_.slots_[structure.slot].layout;
}

std::optional<std::size_t> HousekeepingService::resolve(const descriptor::ParameterRef& reference) const noexcept {
  const int member = reference.member ? static_cast<int>(*reference.member) : -1;
  return place_of(values_, [&reference, member](const SampledValue& value) {
    return value.parameter == reference.parameter && value.member == member;
  });
}

Result<> HousekeepingService::load(std::span<const HousekeepingStructure> structures) {
  for (const auto& declared : structures) HIROSCO_TRY(load_one(declared));
  return ok();
}

Result<> HousekeepingService::load_one(const HousekeepingStructure& declared) {
  draft_.begin(values_, declared.id, declared.interval_cycles);
  const auto has = [this](const descriptor::ParameterRef& each) { return resolve(each).has_value(); };
  bool known = std::ranges::all_of(declared.sampled_once, has), fits = true;
  for (const auto& set : declared.sampled_repeatedly) known = known && std::ranges::all_of(set.parameters, has);
  if (!known) return fail(ErrorCode::NotFound, "a value of a housekeeping structure", declared.id);
  for (const auto& each : declared.sampled_once) fits = draft_.add_once(*resolve(each)) && fits;
  for (const auto& set : declared.sampled_repeatedly) {
    fits = draft_.begin_set(set.repetitions) && fits;
    for (const auto& each : set.parameters) fits = draft_.add_to_set(*resolve(each)) && fits;
  }
  if (!draft_.allows(draft_.interval)) return fail(ErrorCode::OutOfRange, "housekeeping interval", declared.id);
  if (sampler_.free_commands() < 3) return fail(ErrorCode::Unavailable, "housekeeping commands", declared.id);
  if (!fits || check_capacity(draft_))
    return fail(ErrorCode::ResourceExhausted, "housekeeping structures", declared.id);
  if (Structure* existing = find(declared.id); existing != nullptr) {
    sampler_.send(HousekeepingSampler::Command::Kind::Remove, existing->slot);
    structures_.erase(structures_.begin() + (existing - structures_.data()));
  }
  const auto slot = static_cast<std::size_t>(sampler_.find_free_slot());
  structures_.push_back({declared.id, slot, draft_.interval, declared.enabled, true});
  sampler_.install(slot, draft_);
  if (declared.enabled) sampler_.send(HousekeepingSampler::Command::Kind::Enable, slot);
  return ok();
}

Result<> HousekeepingService::clear() {
  if (sampler_.free_commands() < structures_.size()) return fail(ErrorCode::Unavailable, "housekeeping commands");
  for (const auto& structure : structures_) sampler_.send(HousekeepingSampler::Command::Kind::Remove, structure.slot);
  structures_.clear();
  return ok();
}

void HousekeepingService::handle(const TelecommandView& telecommand, const Request& request) {
  const Octets data = telecommand.application_data();
  switch (telecommand.subtype()) {
    case create_structure: return create(data, request);
    case delete_structures: return remove(data, request);
    case enable_periodic: return switch_periodic(data, request, true);
    case disable_periodic: return switch_periodic(data, request, false);
    case report_structures: return report_layouts(data, request);
    case one_shot: return request_one_shots(data, request);
    case append_parameters: return append(data, request);
    case modify_interval: return modify_intervals(data, request);
    case report_properties: return report_periodic_properties(data, request);
    default: return verification_.rejected(request, unknown_subtype(telecommand));
  }
}

/// A notice names the position of the bad parameter among all of the request.
HousekeepingService::Notice HousekeepingService::extend(const HousekeepingDefinition& definition) noexcept {
  std::size_t index = 0;
  bool fits = true;
  Notice refused;
  definition.each_list([&](std::optional<std::uint16_t> repetitions, Octets ids) {
    if (repetitions) fits = draft_.begin_set(*repetitions) && fits;
    for (OctetReader reader{ids}; reader.remaining() != 0 && !refused; ++index) {
      const auto wire = reader.get<std::uint32_t>();
      const auto place = find_value(wire);
      if (!place) refused = instruction_failure(FailureCode::UnknownIdentifier, index, wire);
      else if (draft_.contains(*place)) refused = instruction_failure(FailureCode::IdentifierExists, index, wire);
      else fits = (repetitions ? draft_.add_to_set(*place) : draft_.add_once(*place)) && fits;
    }
  });
  if (refused) return refused;
  if (!draft_.allows(draft_.interval)) return instruction_failure(FailureCode::ValueNotAcceptable, 0, draft_.id);
  if (!fits) return failure(FailureCode::CapacityExceeded, 0);
  return check_capacity(draft_);
}

HousekeepingService::Notice HousekeepingService::check_capacity(const HousekeepingLayout& layout) const noexcept {
  const bool fits =
      layout.report_octets() <= max_housekeeping_octets && definition_octets(layout) <= max_housekeeping_octets;
  if (!fits || sampler_.find_free_slot() < 0) return failure(FailureCode::CapacityExceeded, 0);
  if (sampler_.free_commands() < 2) return FailureNotice{FailureCode::Busy};
  return std::nullopt;
}

void HousekeepingService::create(Octets data, const Request& request) {
  const auto definition = read_definition(data, DefinitionOf::NewStructure);
  if (!definition) return verification_.rejected(request, definition.error());
  verification_.accepted(request);
  if (find(definition->id) != nullptr)
    return verification_.start_failed(request, instruction_failure(FailureCode::IdentifierExists, 0, definition->id));
  draft_.begin(values_, definition->id, definition->interval);
  if (const auto notice = extend(*definition)) return verification_.start_failed(request, *notice);
  verification_.started(request);
  const auto slot = static_cast<std::size_t>(sampler_.find_free_slot());
  structures_.push_back({definition->id, slot, draft_.interval, false, false});
  sampler_.install(slot, draft_);
  verification_.completed(request);
}

void HousekeepingService::append(Octets data, const Request& request) {
  const auto definition = read_definition(data, DefinitionOf::AppendedParameters);
  if (!definition) return verification_.rejected(request, definition.error());
  verification_.accepted(request);
  Structure* structure = find(definition->id);
  const auto refuse = [&](FailureCode code) {
    verification_.start_failed(request, instruction_failure(code, 0, definition->id));
  };
  if (structure == nullptr) return refuse(FailureCode::UnknownIdentifier);
  if (structure->enabled) return refuse(FailureCode::WrongStatus);
  draft_ = layout_of(*structure);
  draft_.interval = structure->interval;
  if (const auto notice = extend(*definition)) return verification_.start_failed(request, *notice);
  verification_.started(request);
  // The cycle may be reading the old layout: the longer one goes into another slot.
  const auto slot = static_cast<std::size_t>(sampler_.find_free_slot());
  sampler_.send(HousekeepingSampler::Command::Kind::Remove, structure->slot);
  sampler_.install(slot, draft_);
  structure->slot = slot;
  verification_.completed(request);
}

HousekeepingService::Notice HousekeepingService::check_known(std::size_t index, std::uint16_t id,
                                                             std::size_t commands_before) noexcept {
  if (find(id) == nullptr) return instruction_failure(FailureCode::UnknownIdentifier, index, id);
  if (sampler_.free_commands() <= commands_before) return FailureNotice{FailureCode::Busy};
  return std::nullopt;
}

void HousekeepingService::remove(Octets data, const Request& request) {
  const auto count = list_count(data, id_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  const auto check = [&](std::size_t i) -> Notice {
    const std::uint16_t id = id_at(data, i, id_octets);
    if (const auto notice = check_known(i, id, i)) return notice;
    for (std::size_t earlier = 0; earlier < i; ++earlier)
      if (id_at(data, earlier, id_octets) == id) return instruction_failure(FailureCode::UnknownIdentifier, i, id);
    if (find(id)->enabled) return instruction_failure(FailureCode::WrongStatus, i, id);
    if (find(id)->predefined) return failure(FailureCode::NotPermittedNow, i);
    return std::nullopt;
  };
  run_instructions(verification_, request, *count, check, [&](std::size_t i) {
    const Structure* structure = find(id_at(data, i, id_octets));
    sampler_.send(HousekeepingSampler::Command::Kind::Remove, structure->slot);
    structures_.erase(structures_.begin() + (structure - structures_.data()));
  });
}

void HousekeepingService::switch_periodic(Octets data, const Request& request, bool enabled) {
  const auto count = list_count(data, id_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  run_instructions(
      verification_, request, *count, [&](std::size_t i) { return check_known(i, id_at(data, i, id_octets), i); },
      [&](std::size_t i) {
        Structure* structure = find(id_at(data, i, id_octets));
        structure->enabled = enabled;
        using enum HousekeepingSampler::Command::Kind;
        sampler_.send(enabled ? Enable : Disable, structure->slot);
      });
}

void HousekeepingService::request_one_shots(Octets data, const Request& request) {
  const auto count = list_count(data, id_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  run_instructions(
      verification_, request, *count, [&](std::size_t i) { return check_known(i, id_at(data, i, id_octets), i); },
      [&](std::size_t i) {
        sampler_.send(HousekeepingSampler::Command::Kind::OneShot, find(id_at(data, i, id_octets))->slot);
      });
}

void HousekeepingService::modify_intervals(Octets data, const Request& request) {
  const auto count = list_count(data, id_and_interval_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  const auto check = [&](std::size_t i) -> Notice {
    const std::uint16_t id = id_at(data, i, id_and_interval_octets);
    if (const auto notice = check_known(i, id, i)) return notice;
    if (layout_of(*find(id)).allows(interval_at(data, i))) return std::nullopt;
    return instruction_failure(FailureCode::ValueNotAcceptable, i, id);
  };
  run_instructions(verification_, request, *count, check, [&](std::size_t i) {
    Structure* structure = find(id_at(data, i, id_and_interval_octets));
    structure->interval = interval_at(data, i);
    sampler_.send(HousekeepingSampler::Command::Kind::SetInterval, structure->slot, structure->interval);
  });
}

void HousekeepingService::report_layouts(Octets data, const Request& request) {
  const auto count = list_count(data, id_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  run_instructions(
      verification_, request, *count,
      [&](std::size_t i) -> Notice {
        const std::uint16_t id = id_at(data, i, id_octets);
        if (find(id) == nullptr) return instruction_failure(FailureCode::UnknownIdentifier, i, id);
        return std::nullopt;
      },
      [&](std::size_t i) { send_layout(*find(id_at(data, i, id_octets)), request); });
}

void HousekeepingService::send_layout(const Structure& structure, const Request& request) {
  std::array<std::byte, max_housekeeping_octets> room;
  sink_.report(service_type, structure_report, request.source,
               write_definition(room, layout_of(structure), structure.enabled, structure.interval));
}

void HousekeepingService::report_periodic_properties(Octets data, const Request& request) {
  const auto count = list_count(data, id_octets);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  std::array<std::byte, 1 + max_instructions * 7> buffer;
  OctetWriter writer{MutableOctets{buffer}.subspan(1)};
  std::uint8_t known = 0;
  const auto check = [&](std::size_t i) -> Notice {
    const std::uint16_t id = id_at(data, i, id_octets);
    const Structure* structure = find(id);
    if (structure == nullptr) return instruction_failure(FailureCode::UnknownIdentifier, i, id);
    writer.put(id).put(static_cast<std::uint8_t>(structure->enabled ? 1 : 0)).put(structure->interval);
    ++known;
    return std::nullopt;
  };
  run_instructions(
      verification_, request, *count, check, [](std::size_t) {},
      [&] {
        buffer[0] = static_cast<std::byte>(known);
        sink_.report(service_type, properties_report, request.source, Octets{buffer}.first(1 + writer.size()));
      });
}

}  // namespace hirosco::pus
