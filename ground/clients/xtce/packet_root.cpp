// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/packet_root.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"

namespace hirosco::ground {
namespace {

using Texts = std::vector<descriptor::EnumerationText>;

[[nodiscard]] std::string text_of(auto number) { return std::to_string(static_cast<unsigned>(number)); }

template <class E>
[[nodiscard]] Texts texts_of() {
  Texts texts;
  for (const auto& row : EnumTexts<E>::table)
    texts.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
  return texts;
}

/// A report of service 1 about what has failed: request, code, and what stands behind the code.
class FailureReports {
 public:
  FailureReports(SpaceSystem& system, TypeSet& types, const PacketRoot& root, const Catalogue& catalogue)
      : system_{system}, root_{root} {
    code_ =
        system.add_parameter("failure_code", types.value({.type = Type::Uint16, .texts = texts_of<pus::FailureCode>()}),
                             "docs/failure-codes.md; an author's own codes have their names in the subsystem");
    Texts modes;
    for (const auto& mode : catalogue.mission().modes) modes.push_back({mode.id, mode.name});
    mode_ = system.add_parameter("failure_mode", types.value({.texts = modes}));
    state_ = system.add_parameter("failure_state", types.value({.texts = texts_of<descriptor::State>()}));
    mark_ = system.add_parameter("failure_first_octet", types.value({}));
    kind_ = system.add_parameter("failure_kind", types.value({.texts = texts_of<ErrorCode>()}));
    number_ = system.add_parameter("failure_number", types.value({.type = Type::Int64}));
    for (const bool step : {false, true}) {
      // Octets that the length field counts in front of what stands behind the first octet, and behind a reason.
      const int behind_mark = 8 * static_cast<int>(length_without_data + (step ? 9 : 7));
      const int behind_reason = behind_mark + 8 * 9;
      const char* const suffix = step ? "_of_step" : "";
      words_.push_back(system.add_parameter(std::string{"failure_words"} + suffix,
                                            types.words_by(root.packet_length, -behind_reason, 64)));
      rest_.push_back(system.add_parameter(std::string{"failure_data"} + suffix,
                                           types.octets_by(root.packet_length, -behind_mark)));
    }
  }

  /// `base` has been read up to the code.
  void add(const std::string& name, const std::string& base, std::vector<Condition> when,
           std::vector<Condition> or_when, bool step) {
    using pus::FailureCode;
    const std::size_t octets = step ? 8 : 6;  // request, step, code
    const std::string failed = add({.name = name,
                                    .entries = {entry_of(code_)},
                                    .base = base,
                                    .when = std::move(when),
                                    .or_when = std::move(or_when),
                                    .abstract = true});
    const auto code_is = [&](FailureCode code, const char* comparison) {
      return Condition{code_, text_of(code), comparison};
    };
    const std::vector<Condition> other{code_is(FailureCode::WrongState, "!="), code_is(FailureCode::WrongMode, "!=")};
    add({.name = name + "_without_data", .base = failed, .when = {with_data(root_, octets)}}, {});
    add({.name = name + "_in_state",
         .base = failed,
         .when = {code_is(FailureCode::WrongState, "=="), with_data(root_, octets + 1)}},
        {state_});
    add({.name = name + "_in_mode",
         .base = failed,
         .when = {code_is(FailureCode::WrongMode, "=="), with_data(root_, octets + 1)}},
        {mode_});
    Container data{
        .name = name + "_with_data", .entries = {entry_of(mark_)}, .base = failed, .when = other, .abstract = true};
    data.when.push_back(with_data(root_, octets, ">"));
    const std::string with = add(data);
    const Condition reason{mark_, text_of(pus::FailureNotice::reason_mark)};
    Condition no_reason = reason;
    no_reason.comparison = "!=";
    constexpr std::size_t mark_octets = 1, reason_octets = 10;
    add({.name = name + "_by_a_number", .base = with, .when = {reason, with_data(root_, octets + reason_octets)}},
        {kind_, number_});
    add({.name = name + "_by_a_reason", .base = with, .when = {reason, with_data(root_, octets + reason_octets, ">")}},
        {kind_, number_, words_[step ? 1 : 0]});
    add({.name = name + "_by_an_octet", .base = with, .when = {no_reason, with_data(root_, octets + mark_octets)}}, {});
    add({.name = name + "_by_octets", .base = with, .when = {no_reason, with_data(root_, octets + mark_octets, ">")}},
        {rest_[step ? 1 : 0]});
  }

 private:
  std::string add(const Container& container) { return system_.add_container(container); }
  void add(Container container, const std::vector<std::string>& parameters) {
    for (const std::string& parameter : parameters) container.entries.push_back(entry_of(parameter));
    container.entries.push_back(entry_of(root_.crc));
    system_.add_container(container);
  }

  SpaceSystem& system_;
  const PacketRoot& root_;
  std::string code_, mode_, state_, mark_, kind_, number_;
  std::vector<std::string> words_, rest_;  ///< of a request, of a step
};

constexpr std::array<std::uint8_t, 4> failures_of_requests{2, 4, 8, 10};
constexpr std::uint8_t failure_of_step = 6;

[[nodiscard]] std::vector<Condition> one_failed(const PacketRoot& root) {
  std::vector<Condition> either;
  for (const std::uint8_t subtype : failures_of_requests) either.push_back({root.subtype, text_of(subtype)});
  return either;
}

void add_verification(SpaceSystem& system, TypeSet& types, PacketRoot& root, const Catalogue& catalogue) {
  const std::string service = text_of(pus::Verification::service_kind.type);
  const auto field = [&](const char* name, unsigned bits) {
    return entry_of(system.add_parameter(name, types.bits(bits)));
  };
  const std::string base = system.add_container(
      {.name = "verification",
       .says = "A report of service 1 about a request, which its own header names",
       .entries = {field("request_version", 3), field("request_type", 1), field("request_secondary_header", 1),
                   field("request_apid", 11), field("request_sequence_flags", 2), field("request_count", 14)},
       .base = root.telemetry,
       .when = {{root.service, service}},
       .abstract = true});
  const Element crc = entry_of(root.crc);
  const auto add_success = [&](const char* name, std::uint8_t subtype) {
    system.add_container({.name = name, .entries = {crc}, .base = base, .when = {{root.subtype, text_of(subtype)}}});
  };
  add_success("accepted", 1);
  add_success("started", 3);
  add_success("completed", 7);
  const Element step = field("request_step", 16);
  system.add_container({.name = "progress", .entries = {step, crc}, .base = base, .when = {{root.subtype, "5"}}});
  FailureReports failures{system, types, root, catalogue};
  failures.add("failed", base, {}, one_failed(root), false);
  const std::string failed_step = system.add_container({.name = "step_failed",
                                                        .entries = {step},
                                                        .base = base,
                                                        .when = {{root.subtype, text_of(failure_of_step)}},
                                                        .abstract = true});
  failures.add("failed_step", failed_step, {}, {}, true);
  // Read a second time, of reports to us alone: what verifies a command must not see those to others.
  root.verified_subtype = system.add_parameter("verified_subtype", types.bits(8));
  root.verified_apid = system.add_parameter("verified_apid", types.bits(11));
  root.verified_count = system.add_parameter("verified_count", types.bits(14));
  root.verification =
      system.add_container({.name = "own_verification",
                            .says = "The same, of what was commanded by this database",
                            .entries = {entry_at(root.verified_subtype, 64), entry_at(root.verified_apid, data_bit + 5),
                                        entry_at(root.verified_count, data_bit + 18)},
                            .base = root.telemetry,
                            .when = {{root.service, service}, {root.destination, text_of(exported_source)}}});
}

}  // namespace

EventNames event_names(const Catalogue& catalogue) {
  std::map<std::uint16_t, std::vector<std::string>> all;
  for (const auto* subsystem : catalogue.subsystems())
    for (const auto& event : subsystem->events) {
      auto& names = all[event.id];
      if (std::ranges::find(names, event.name) == names.end()) names.push_back(event.name);
    }
  EventNames result;
  std::set<std::string> taken;
  for (const auto& [id, names] : all) {
    std::string name = names.front();
    for (std::size_t i = 1; i < names.size(); ++i) name += " or " + names[i];
    if (!taken.insert(name).second) name += " (" + std::to_string(id) + ")";
    taken.insert(name);
    result.emplace(id, name);
  }
  return result;
}

Condition with_data(const PacketRoot& root, std::size_t octets, std::string comparison) {
  return {root.packet_length, std::to_string(length_without_data + octets), std::move(comparison)};
}

PacketRoot add_packet_root(SpaceSystem& system, TypeSet& types, const Catalogue& catalogue) {
  PacketRoot root;
  const auto field = [&](const char* name, unsigned bits, const char* says = "") {
    return system.add_parameter(name, types.bits(bits), says);
  };
  const std::string version = field("packet_version", 3), type = field("packet_type", 1),
                    secondary = field("secondary_header", 1);
  root.apid = field("apid", 11, "Application process: the subsystem");
  const std::string flags = field("sequence_flags", 2), count = field("sequence_count", 14);
  root.packet_length = field("packet_length", 16, "Octets behind the primary header, less one");
  const std::string packet =
      system.add_container({.name = "space_packet",
                            .entries = {entry_of(version), entry_of(type), entry_of(secondary), entry_of(root.apid),
                                        entry_of(flags), entry_of(count), entry_of(root.packet_length)},
                            .abstract = true});
  root.crc =
      system.add_parameter("packet_error_control", types.crc(), "CRC-16 of the whole packet, 0x1021, preset 0xFFFF");
  const std::string pus_version = field("pus_version", 4), time_status = field("time_status", 4);
  root.service = field("service", 8);
  root.subtype = field("subtype", 8);
  const std::string counter = field("message_counter", 16);
  root.destination = field("destination", 16, "Source id of whoever asked; 0 = nobody did");
  const std::string time = system.add_parameter("time", types.time(), "On board: TAI since 1958");
  root.telemetry = system.add_container(
      {.name = "report",
       .entries = {entry_of(pus_version), entry_of(time_status), entry_of(root.service), entry_of(root.subtype),
                   entry_of(counter), entry_of(root.destination), entry_of(time)},
       .base = packet,
       .when = {{type, "0"}, {secondary, "1"}},
       .abstract = true});
  add_verification(system, types, root, catalogue);

  root.structure_id = system.add_parameter("structure_id", types.bits(16));
  root.housekeeping =
      system.add_container({.name = "housekeeping",
                            .says = "One that was made in flight has no description here",
                            .entries = {entry_of(root.structure_id)},
                            .base = root.telemetry,
                            .when = {{root.service, text_of(pus::HousekeepingService::service_kind.type)},
                                     {root.subtype, text_of(pus::HousekeepingService::parameter_report)}},
                            .abstract = true});

  Texts events;
  for (const auto& [id, name] : event_names(catalogue)) events.push_back({id, name});
  root.event_id = system.add_parameter("event_id", types.value({.type = Type::Uint16, .texts = std::move(events)}));
  root.event = system.add_container({.name = "event",
                                     .entries = {entry_of(root.event_id)},
                                     .base = root.telemetry,
                                     .when = {{root.service, text_of(pus::EventService::service_kind.type)},
                                              {root.subtype, text_of(descriptor::Severity::High), "<="}},
                                     .abstract = true});
  system.add_container({.name = "event_without_arguments",
                        .entries = {entry_of(root.crc)},
                        .base = root.event,
                        .when = {with_data(root, 2)}});
  return root;
}

std::string add_failure_of(SpaceSystem& system, TypeSet& types, const PacketRoot& root,
                           const descriptor::SubsystemDescriptor& subsystem) {
  Texts codes = texts_of<pus::FailureCode>();
  for (const auto& own : subsystem.failures) codes.push_back({own.code, own.name});
  const std::string code =
      system.add_parameter("failure_code", types.value({.type = Type::Uint16, .texts = std::move(codes)}),
                           "Why the newest of our requests that has failed did");
  const Condition ours{root.verified_apid, text_of(subsystem.id)};
  constexpr unsigned request_bits = 32, step_bits = 16;
  system.add_container({.name = "failed",
                        .entries = {entry_at(code, data_bit + request_bits)},
                        .base = root.verification,
                        .when = {ours},
                        .or_when = one_failed(root)});
  system.add_container({.name = "step_failed",
                        .entries = {entry_at(code, data_bit + request_bits + step_bits)},
                        .base = root.verification,
                        .when = {ours, {root.subtype, text_of(failure_of_step)}}});
  return code;
}

}  // namespace hirosco::ground
