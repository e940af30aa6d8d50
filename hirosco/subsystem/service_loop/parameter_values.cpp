// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/parameter_values.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/descriptor/model/wire_values.hpp"
#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"

namespace hirosco {
namespace {

[[nodiscard]] Dictionary make_dictionary(const descriptor::SubsystemDescriptor& subsystem, std::string& problem) {
  std::vector<ParameterSpec> specs;
  for (const auto& parameter : subsystem.parameters) {
    ParameterSpec spec{.name = parameter.field.name,
                       .id = {subsystem.id, parameter.field.type, parameter.id},
                       .fields = {},
                       .is_struct = parameter.field.type == Type::Struct,
                       .init = parameter.init};
    if (spec.is_struct)
      for (const auto& member : parameter.members)
        spec.fields.push_back({member.field.name, member.field.type, member.field.elements(), member.id});
    else spec.fields.push_back({parameter.field.name, parameter.field.type, parameter.field.elements()});
    for (const auto& part : parameter.parts) spec.parts.push_back({part.name, part.first, part.count, part.id});
    specs.push_back(std::move(spec));
  }
  auto dictionary = Dictionary::make(specs);
  if (dictionary) return std::move(*dictionary);
  problem = dictionary.error();
  return {};
}

/// Each number of these octets, which are of its length, within the range that it has.  Realtime: bounded.
[[nodiscard]] bool in_range(const descriptor::Parameter& declared, int member, Octets value) {
  OctetReader reader{value};
  const auto fits = [&](const descriptor::Field& field) {
    if (field.type == Type::Text) return static_cast<void>(reader.get(field.octets())), true;
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const Number number = read_number(reader, field.type);
      if (!(number == number)) return false;
      if (field.minimum && number < *field.minimum) return false;
      if (field.maximum && number > *field.maximum) return false;
    }
    return true;
  };
  if (declared.members.empty()) return fits(declared.field);
  const std::span<const descriptor::Parameter::Member> all{declared.members};
  const auto asked = member < 0 ? all : declared.members_at(static_cast<std::uint16_t>(member));
  return std::ranges::all_of(asked, [&](const auto& each) { return fits(each.field); });
}

}  // namespace

ParameterValues::ParameterValues(const descriptor::SubsystemDescriptor& descriptor, const Situation& at,
                                 const CycleOrders& orders, const CycleLoop& cycle)
    : descriptor_{descriptor},
      at_{at},
      orders_{orders},
      cycle_{cycle},
      dictionary_{make_dictionary(descriptor_, problem_)} {}

Result<> ParameterValues::initialise() {
  HIROSCO_TRY(dictionary_.initialise());
  initialised_ = true;
  return ok();
}

/// A process that goes through Offline loses no more than one that ends (docs/adr/0087). What could not be set is not taken along.
void ParameterValues::remember_persistent() {
  if (!std::exchange(initialised_, false)) return;
  {
    // A loop of ST[20]'s own is by here done with what it judged by the states before, and has told it as set (docs/adr/0200).
    const LockGuard lock{judging_};
    apply_at_rest();
  }
  std::array<std::byte, descriptor::max_persistent_octets> room;
  for (std::size_t index = 0; index < descriptor_.parameters.size(); ++index) {
    const descriptor::Parameter& parameter = descriptor_.parameters[index];
    if (!parameter.persistent) continue;
    const std::size_t octets = dictionary_.snapshot_encode(index, -1, room);
    if (auto values = descriptor::values_within(parameter, Octets{room}.first(octets)))
      dictionary_.begin_with(index, std::move(*values));
  }
}

std::expected<std::size_t, ErrorCode> ParameterValues::read(std::uint32_t parameter, MutableOctets big_endian) {
  const auto place = dictionary_.place_of(parameter);
  if (!place) return std::unexpected{ErrorCode::NotFound};
  const std::size_t octets = dictionary_.snapshot_encode(place->index, place->member, big_endian);
  if (octets == 0) return std::unexpected{ErrorCode::Unavailable};
  return octets;
}

std::size_t ParameterValues::size_of(std::uint32_t parameter) {
  const auto place = dictionary_.place_of(parameter);
  if (!place || dictionary_.cell(place->index) == nullptr) return 0;
  return dictionary_.wire_octets(place->index, place->member);
}

std::expected<void, pus::FailureCode> ParameterValues::check_write(std::uint32_t parameter, Octets value) {
  return check_write_in(at_.state, parameter, value);
}

std::expected<void, pus::FailureCode> ParameterValues::check_write_in(State state, std::uint32_t parameter,
                                                                      Octets value) const {
  const auto place = dictionary_.place_of(parameter);
  if (!place) return std::unexpected{pus::FailureCode::UnknownIdentifier};
  const descriptor::Parameter& declared = descriptor_.parameters[place->index];
  if (!declared.writable_in(state)) return std::unexpected{pus::FailureCode::NotPermittedNow};
  // A value that the next cycle overwrites was not set, whatever a report said.
  if (orders_.wanted() && cycle_.writes_itself(place->index)) return std::unexpected{pus::FailureCode::NotPermittedNow};
  if (!dictionary_.accepts(place->index, place->member, value))
    return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  if (!in_range(declared, place->member, value)) return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  return {};
}

std::expected<void, pus::FailureCode> ParameterValues::submit_write(std::span<const pus::ParameterAccess::Write> writes,
                                                                    const pus::Request&) {
  if (auto queued = queue(writes); !queued) return queued;
  // While the cycle rests the service loop is the writer; one that is still coming to rest is applied for when it has.
  if (orders_.rests()) apply();
  return {};
}

std::expected<void, pus::FailureCode> ParameterValues::queue(std::span<const pus::ParameterAccess::Write> writes) {
  std::array<ParameterWrite, pus::max_instructions> batch;
  std::size_t count = 0;
  for (const auto& write : writes)
    if (const auto place = dictionary_.place_of(write.id); place && count < batch.size())
      batch[count++] = {place->index, place->member, write.value};
  if (const auto queued = writes_.enqueue(dictionary_, std::span{batch}.first(count)); !queued)
    return std::unexpected{queued.error().code == ErrorCode::OutOfRange ? pus::FailureCode::CapacityExceeded
                                                                        : pus::FailureCode::Busy};
  return {};
}

bool ParameterValues::set(std::size_t index, Octets big_endian) {
  const ParameterWrite write{static_cast<std::uint16_t>(index), -1, big_endian};
  if (!writes_.enqueue(dictionary_, {&write, 1})) return false;
  if (orders_.rests()) apply();
  return true;
}

Result<> ParameterValues::store(const ParameterCell& parameter, Octets big_endian) {
  for (std::size_t i = 0; i < dictionary_.size(); ++i) {
    if (dictionary_.cell(i) != &parameter) continue;
    const ParameterWrite write{static_cast<std::uint16_t>(i), -1, big_endian};
    HIROSCO_TRY(writes_.enqueue(dictionary_, {&write, 1}));
    if (orders_.rests()) apply();
    return ok();
  }
  return fail(ErrorCode::NotFound, "the parameter is not published");
}

void ParameterValues::apply_at_rest() {
  if (orders_.rests() && writes_.waiting() != 0) apply();
}

ForeignParameters::Home ParameterValues::foreign_home(std::function<void(std::uint16_t parameter)> tell) {
  const auto accepts = [this](std::uint16_t parameter, Octets value) {
    return dictionary_.accepts(parameter, -1, value) && in_range(descriptor_.parameters[parameter], -1, value);
  };
  return {.set = [this](std::uint16_t parameter, Octets value) { return set(parameter, value); },
          .accepts = accepts,
          .tell = std::move(tell)};
}

}  // namespace hirosco
