// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/own_telecommands.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/words/describe.hpp"

namespace hirosco::supervisor {

namespace {
constexpr std::uint8_t ack_end = pus::ack_acceptance | pus::ack_completion;
constexpr std::uint8_t ack_begin_and_end = ack_end | pus::ack_start;
/// "execution error: sensor is broken 42"
std::string words_of(pus::FailureCode code, Octets data) {
  std::string text{to_text(code)};
  const auto reason = pus::reason_in(data);
  if (!reason) return text;
  text.append(": ").append(pus::text_of(std::as_bytes(std::span{reason->text})));
  return reason->number == 0 ? text : text.append(" ").append(std::to_string(reason->number));
}
}  // namespace

void OwnTelecommands::command(std::uint16_t apid, std::string_view name, std::optional<double> argument,
                              CommandDone done, std::optional<std::uint64_t> free_at) {
  const descriptor::SubsystemDescriptor* subsystem = craft_.mission.find_member(apid);
  static const auto built_in = pus::common_functions();
  const auto common = std::ranges::find(built_in, name, &descriptor::Function::name);
  const descriptor::Function* function = common != built_in.end() ? &*common
                                         : subsystem != nullptr   ? subsystem->find_function(name)
                                                                  : nullptr;
  std::vector<double> values;
  if (argument) values.push_back(*argument);
  const auto data = function != nullptr ? pus::encode_call(*function, std::span<const double>{values})
                                        : Result<std::vector<std::byte>>{fail(ErrorCode::NotFound, "unknown function")};
  if (!data) {
    if (done) done(false, data.error().text);
    return;
  }
  send({.apid = apid, .service = 8, .subtype = 1, .data = *data, .free_at = free_at}, std::move(done), Duration{0});
}

void OwnTelecommands::send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                           const MemoryHandle& memory, CommandDone done, Duration takes) {
  send({.apid = apid, .service = service, .subtype = subtype, .data = data, .memory = memory}, std::move(done), takes);
}

void OwnTelecommands::send(const Packet& what, CommandDone done, Duration takes) {
  const std::uint16_t apid = what.apid;
  std::array<std::byte, max_packet_octets> buffer;
  const std::uint16_t count = next_sequence_count_;
  next_sequence_count_ = static_cast<std::uint16_t>((count + 1) % pus::sequence_counts);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = apid,
                                              .sequence_count = count,
                                              .ack = takes > Duration{0} ? ack_begin_and_end : ack_end,
                                              .service = what.service,
                                              .subtype = what.subtype,
                                              .source = supervisor_apid},
                                             what.data);
  if (!packet) {
    if (done) done(false, packet.error().text);
    return;
  }
  const auto telecommand = pus::TelecommandView::parse(*packet);
  sent_[telecommand->request_id()] = {std::move(done), craft_.now + answer_limit,
                                      craft_.name_of(apid) + " " + telecommand_text(*telecommand), apid, takes};
  telecommands_.take(
      {.packet = *packet, .origin = Origin::supervisor(), .memory = what.memory, .free_at = what.free_at});
}

void OwnTelecommands::Sent::begins() {
  if (std::exchange(begun, takes > Duration{0})) return;
  deadline += takes;
}

std::string OwnTelecommands::Sent::why() const {
  if (!begun) return "no answer";
  const auto limit = std::chrono::duration_cast<std::chrono::seconds>(answer_limit + takes);
  return "begun, and not completed within " + std::to_string(limit.count()) + " s";
}

void OwnTelecommands::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (report.service() != 1 || report.destination() != supervisor_apid) return;
  OctetReader reader{report.source_data()};
  const auto found = sent_.find(reader.get<std::uint32_t>());
  if (found == sent_.end() || !reader.good()) return;
  // Its end is told by whom it was for, or by the supervisor that did not let it go there.
  if (from != found->second.apid && from != supervisor_apid) return;
  if (report.subtype() == 3) found->second.begins();
  if (report.subtype() == 6) return;  // one of its steps: it goes on, and the log has why
  const bool failure = report.subtype() % 2 == 0;
  const bool completed = report.subtype() == 7;
  if (!failure && !completed) return;
  const Sent ended = std::move(found->second);
  sent_.erase(found);
  const auto code = static_cast<pus::FailureCode>(failure ? reader.get<std::uint16_t>() : 0);
  const std::string why = failure ? words_of(code, reader.rest()) : std::string{};
  if (failure) craft_.tell(ended.what + " failed: " + why, report.apid());
  if (ended.done) ended.done(completed, why);
}

void OwnTelecommands::watch(TimePoint now) {
  std::vector<Sent> expired;
  std::erase_if(sent_, [&](auto& entry) {
    if (entry.second.deadline > now) return false;
    expired.push_back(std::move(entry.second));
    return true;
  });
  for (const Sent& late : expired) {
    const std::string why = late.why();
    craft_.tell(late.what + ": " + why);
    if (late.done) late.done(false, why);
  }
}

void OwnTelecommands::fail_all_to(std::uint16_t apid, const std::string& why) {
  std::vector<CommandDone> ended;
  std::erase_if(sent_, [&](auto& entry) {
    if (entry.second.apid != apid) return false;
    ended.push_back(std::move(entry.second.done));
    return true;
  });
  for (const CommandDone& done : ended)
    if (done) done(false, why);
}

}  // namespace hirosco::supervisor
