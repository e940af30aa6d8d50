// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/descriptor_changes.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/in_flight.hpp"
#include "hirosco/descriptor/model/wire_values.hpp"
#include "hirosco/parameter/number.hpp"
#include "hirosco/utilities/crc32.hpp"

namespace hirosco {
namespace {

using pus::FailureCode;
using pus::FailureNotice;
using Refused = std::optional<FailureNotice>;

[[nodiscard]] FailureNotice refuse(FailureCode code, const char* words, std::int64_t number = 0) {
  FailureNotice notice{code};
  return notice.because({ErrorCode::NotPermitted, number, words});
}

[[nodiscard]] bool within(const descriptor::Field& field, const Value& value) {
  const Number* const number = std::get_if<Number>(&value);
  return number == nullptr ||
         !((field.minimum && *number < *field.minimum) || (field.maximum && *number > *field.maximum));
}

/// `values`: all that it begins with, or none for zeros.
[[nodiscard]] bool within(const descriptor::Parameter& parameter, const std::vector<Value>& values) {
  auto value = values.begin();
  const auto fits = [&](const descriptor::Field& field) {
    bool good = true;
    for (std::uint32_t i = 0; i < field.values() && value != values.end(); ++i) good = within(field, *value++) && good;
    return good;
  };
  if (parameter.members.empty()) return fits(parameter.field);
  return std::ranges::all_of(parameter.members, [&](const auto& member) { return fits(member.field); });
}

}  // namespace

std::optional<FailureNotice> DescriptorChanges::judge(std::size_t octets, const MemoryHandle& text) {
  newest_ = false;  // whatever becomes of it, the text before it is the newest no more
  // Before anything is read, or given back: what has been commissioned uses the heap for nothing (adr 0220).
  if (auto refused = not_now()) return refused;
  coming_.reset();
  if (!platform_.read_again) return refuse(FailureCode::NotPermittedNow, "nobody reads descriptors here");
  if (!text) return refuse(FailureCode::IllegalField, "no text came beside it");
  if (const auto sound = platform_.memory.verify(text, octets, true); !sound)
    return refuse(FailureCode::IllegalField, sound.error().text, sound.error().value);
  const auto mapped = platform_.memory.map(text, Access::ReadOnly);
  if (!mapped) return refuse(FailureCode::CapacityExceeded, mapped.error().text, mapped.error().value);
  auto reading = platform_.read_again({reinterpret_cast<const char*>(mapped->octets.data()), octets});
  if (!reading.value) {
    if (platform_.explain)
      for (const auto& problem : reading.problems)
        platform_.explain(descriptor_.name + ": " + std::to_string(problem.at.line) + ": " + problem.message);
    return refuse(FailureCode::ValueNotAcceptable, "errors in the descriptor, the first in line",
                  reading.problems.empty() ? 0 : reading.problems.front().at.line);
  }
  descriptor::add_framework_events(*reading.value);
  if (auto refused = against(*reading.value)) return refused;
  coming_ = std::move(reading.value);
  newest_ = true;
  return std::nullopt;
}

/// Whatever it is.
std::optional<FailureNotice> DescriptorChanges::not_now() const noexcept {
  if (at_.way || at_.release_owed) return FailureNotice{FailureCode::Busy};
  if (at_.state != State::Offline && at_.state != State::PreOperational) return at_.wrong_state();
  return std::nullopt;
}

/// Why it cannot be taken.
std::optional<FailureNotice> DescriptorChanges::against(const descriptor::SubsystemDescriptor& fresh) {
  if (auto refused = not_now()) return refused;
  auto found = descriptor::obstacles(descriptor_, fresh);
  if (found.empty() && at_.configuration != nullptr)
    found = descriptor::obstacles_in_force(descriptor_, fresh, at_.configuration->id);
  if (!found.empty()) {
    const std::string words = found.front().what + ": " + std::string{found.front().why};
    return refuse(FailureCode::NotPermittedNow, words.c_str(), found.front().at.line);
  }
  return left_outside(fresh);
}

/// A value that is there, and that a telecommand could not set any more: it is set first, or the range stays.
std::optional<FailureNotice> DescriptorChanges::left_outside(const descriptor::SubsystemDescriptor& fresh) {
  const auto outside = [&](const descriptor::Parameter& parameter) {
    const std::string words = "the value of " + parameter.field.name + " is outside its new range: set it before";
    return refuse(FailureCode::NotPermittedNow, words.c_str(), parameter.field.at.line);
  };
  // What a cycle that runs has not set yet is looked at before what it has.
  if (const auto waits = values_.waits_outside(fresh.parameters)) return outside(fresh.parameters[*waits]);
  std::vector<std::byte> room;
  for (std::size_t index = 0; index < fresh.parameters.size(); ++index) {
    const descriptor::Parameter& parameter = fresh.parameters[index];
    if (parameter.persistent && !within(parameter, values_.dictionary().spec(index).init)) return outside(parameter);
    if (!parameter.writable() || !values_.initialised()) continue;
    room.resize(parameter.octets());
    if (values_.dictionary().snapshot_encode(index, -1, room) != room.size()) return FailureNotice{FailureCode::Busy};
    OctetReader reader{room};
    const auto fits = [&](const descriptor::Field& field) {
      return descriptor::values_within(field, reader.get(field.octets())).has_value();
    };
    bool good = parameter.members.empty() ? fits(parameter.field) : true;
    for (const auto& member : parameter.members) good = fits(member.field) && good;
    if (!good) return outside(parameter);
  }
  return std::nullopt;
}

std::optional<FailureNotice> DescriptorChanges::take() {
  if (!coming_ || !newest_) return FailureNotice{FailureCode::WrongStatus};
  if (auto refused = not_now()) return refused;
  descriptor::SubsystemDescriptor fresh = std::move(*coming_);
  coming_.reset();
  {
    // Ranges, and what may be written when, are read in the threads of these. What they have told as set is looked at.
    const LoopsAtRest at_rest{loops_.all()};
    values_.apply_at_rest();
    if (auto refused = against(fresh)) return refused;
    descriptor::take_over(descriptor_, std::move(fresh));
  }
  ++changes_;
  // What a persistent parameter was left with outlives its descriptor.
  for (std::size_t index = 0; index < descriptor_.parameters.size(); ++index)
    if (const auto& parameter = descriptor_.parameters[index]; !parameter.persistent)
      values_.dictionary().begin_with(index, descriptor::values_at_begin(parameter));
  tell();
  return std::nullopt;
}

void DescriptorChanges::tell() {
  const auto index = values_.dictionary().index_of(descriptor::framework_parameter::descriptor);
  if (!index || !descriptor_.text) return;
  const std::uint32_t hash = crc32(std::as_bytes(std::span{*descriptor_.text}));
  values_.dictionary().begin_with(*index, {Number{hash}, Number{changes_}});
  if (!values_.initialised()) return;
  std::array<std::byte, 6> data;
  OctetWriter{data}.put(hash).put(changes_);
  values_.set(*index, data);
}

}  // namespace hirosco
