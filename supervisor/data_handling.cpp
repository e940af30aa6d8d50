// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hirosco/pus/st08_function.hpp"
#include "hirosco/pus/st129_supervision.hpp"
#include "supervisor/supervision/data_handling/telecommand_copy.hpp"
#include "supervisor/supervisor.hpp"

/// Data handling of the supervisor (paper 4.3): permits or refuses, logs and routes every telecommand, routes and logs
/// every telemetry packet.
namespace hirosco::supervisor {
namespace {

/// Source id of the supervisor's own telecommands (decision 27).
constexpr std::uint16_t own_source = 1;
/// Generous: a slow disk alone may hold a telecommand back for seconds (decision 24).
constexpr Duration own_request_limit = 15s;
/// A telecommand that is not durable after this time is refused: late execution surprises whoever gave it up. As long as
/// the supervisor waits for its own, so that none of those is executed after it was reported as failed.
constexpr Duration durable_limit = own_request_limit;
constexpr Duration log_patience = 1s;
/// Reports on damaged packets in one second (pus-c tailoring 5.3).
constexpr int damaged_reports_per_second = 10;
constexpr std::size_t most_waiting = 1024;

/// The supervisor's own source id is nobody else's: reports to a forged one would end its own requests.
[[nodiscard]] bool forged(const pus::Request& request, Sender sender) {
  return sender != Sender::Supervisor && request.source == own_source;
}

[[nodiscard]] std::string telecommand_text(const pus::TelecommandView& telecommand) {
  if (const auto call = called_function(telecommand)) {
    if (call->first_argument) return fmt::format("{} {}", call->name, *call->first_argument);
    return std::string{call->name};
  }
  return fmt::format("TC[{},{}]", telecommand.service(), telecommand.subtype());
}

}  // namespace

void Supervisor::handle_telecommand(const Incoming& incoming) {
  ++counts_.telecommands;
  const auto header = pus::read_primary_header(incoming.packet);
  const auto telecommand = pus::TelecommandView::parse(incoming.packet);
  if (!telecommand) {
    if (header && header->apid == pus::idle_apid) return;  // idle packets are dropped silently
    const std::uint32_t request_id = header ? header->request_id : 0;
    if (now_ - report_window_ >= 1s) {
      report_window_ = now_;
      reports_in_window_ = 0;
    }
    ++reports_in_window_;
    return reject(incoming, {request_id, 0, 0}, telecommand.error());
  }
  pus::Request request = pus::request_of(*telecommand);
  if (forged(request, incoming.sender)) request = {request.id, 0, 0};
  const std::uint16_t apid = telecommand->apid();
  const bool asks_only = apid == 1 && telecommand->service() == pus::st129::service_type;
  const auto copy_to_ground = [&] {
    if (incoming.sender == Sender::Ground && !asks_only) send_telecommand_copy(engine_.telemetry(), incoming.packet);
  };
  observe_power();
  const auto decision = judge(*telecommand, incoming.sender);
  if (!decision) {
    copy_to_ground();
    if (decision.error().code() == pus::FailureCode::PowerShort) tell_shortage(apid, decision.error());
    return reject(incoming, request, decision.error());
  }
  if (decision->reserves_w > 0) power_.reserve(apid, decision->reserves_w, request, now_ + own_request_limit);
  if (asks_only) return answer_query(incoming, *telecommand);
  const std::string text = telecommand_text(*telecommand);
  const LogEntry received{.kind = LogKind::TelecommandReceived,
                          .source = incoming.source,
                          .peer = apid,
                          .packet = incoming.packet,
                          .note = std::string_view{text}};
  const std::uint64_t fences = parts_.guard.fences(apid);
  // Nobody could command anything until the ground link is back: its own restoration waits for no disk either.
  const auto* ground = mission_.find_subsystem(mission_.ground.subsystem);
  const bool restores = incoming.sender == Sender::Supervisor && ground != nullptr && ground->subsystem.id == apid &&
                        ground_link_.running();
  if (decision->essential || restores) {
    if (const auto call = called_function(*telecommand);
        apid == 1 && call && carry_out_at_once(incoming, request, call->name)) {
      copy_to_ground();
      static_cast<void>(parts_.log.append(received));
      return;
    }
    forward({apid, incoming.packet, incoming.memory, request, 0, true, restores && decision->releases_stop, fences});
    copy_to_ground();
    static_cast<void>(parts_.log.append(received));
    return;
  }
  copy_to_ground();
  const std::uint64_t number = parts_.log.append(received);
  if (number == 0 || waiting_.size() == most_waiting)
    return reject(incoming, request, pus::FailureNotice{pus::FailureCode::QueueFull});
  // Its own telecommands were not permitted by the mode, so a change of mode does not void them.
  const std::uint32_t mode_epoch = incoming.sender == Sender::Supervisor ? 0 : mode_epoch_;
  waiting_.push_back({number,
                      apid,
                      {incoming.packet.begin(), incoming.packet.end()},
                      incoming.memory,
                      request,
                      mode_epoch,
                      now_,
                      decision->releases_stop,
                      fences});
  forward_durable();
}

/// All that may refuse a well-formed telecommand, without doing anything about it: what is asked before sending and what
/// is decided on sending are this one function.
std::expected<Permitted, pus::FailureNotice> Supervisor::judge(const pus::TelecommandView& telecommand,
                                                               Sender sender) const {
  if (forged(pus::request_of(telecommand), sender))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::IllegalField}};
  const auto decision = decide(telecommand, sender, situation_of(telecommand.apid()));
  if (!decision || !decision->releases_stop) return decision;
  // What a recovery has stopped is not released by a command that crosses it.
  const auto addressee = std::ranges::find(members_, telecommand.apid(), &Member::apid);
  if (addressee != members_.end() && addressee->recovering)
    return std::unexpected{pus::FailureNotice{pus::FailureCode::WrongState}};
  return decision;
}

/// TC[129,1]: nothing is done but answered. Whoever asks is judged as the sender that it is.
void Supervisor::answer_query(const Incoming& incoming, const pus::TelecommandView& query) {
  const pus::Request request = pus::request_of(query);
  const Octets asked = query.application_data();
  const auto header = pus::read_primary_header(asked);
  if (!header) return reject(incoming, request, pus::FailureNotice{pus::FailureCode::DataLength});
  static_cast<void>(parts_.log.append({.kind = LogKind::TelecommandReceived,
                                       .source = incoming.source,
                                       .peer = 1,
                                       .packet = incoming.packet,
                                       .note = "is it permitted?"}));
  engine_.verification().accepted(request);
  engine_.verification().started(request);
  const auto telecommand = pus::TelecommandView::parse(asked);
  const auto decision = telecommand ? judge(*telecommand, incoming.sender) : std::unexpected{telecommand.error()};
  std::array<std::byte, 7> data;
  OctetWriter writer{data};
  writer.put(header->request_id);
  writer.put(static_cast<std::uint8_t>(decision ? 1 : 0));
  writer.put(static_cast<std::uint16_t>(decision ? 0 : static_cast<std::uint16_t>(decision.error().code())));
  engine_.telemetry().report(pus::st129::service_type, pus::st129::permission_answer, request.source, data);
  engine_.verification().completed(request);
}

/// Nothing that is not essential leaves before it is on the disk (decision 24).
void Supervisor::forward_durable() {
  while (!waiting_.empty() && waiting_.front().number <= parts_.log.durable()) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    // What was permitted before a fence is void after it: it was permitted for another situation (findings SF4).
    if (parts_.guard.fences(next.apid) != next.fences) {
      reject({.packet = next.packet, .memory = {}}, next.request,
             pus::FailureNotice{pus::FailureCode::NotPermittedNow});
      continue;
    }
    forward(
        {next.apid, next.packet, next.memory, next.request, next.mode_epoch, false, next.releases_stop, next.fences});
  }
}

/// A store that fails or stands still: said once, with cause and cure, and nothing waits for it for ever.
void Supervisor::watch_log(TimePoint now) {
  const StoreTrouble trouble = parts_.log.trouble();
  // Somebody who deletes the log in a loop does not fill the console: the text carries the count.
  const bool news = trouble.count != told_troubles_ && (told_troubles_ == 0 || now - trouble_told_ >= log_patience);
  if (news) {
    told_troubles_ = trouble.count;
    trouble_told_ = now;
    tell(trouble.text, 1);
    engine_.announce(trouble.fault == StoreFault::Damaged ? "LOG_DAMAGED" : "LOG_STORE");
  }
  const bool failing =
      parts_.log.failure().has_value() || (!waiting_.empty() && now - waiting_.front().since > log_patience);
  if (failing != log_failing_) {
    log_failing_ = failing;
    tell(failing ? "log storage fails: telecommands that must be durable are held back" : "log storage works", 1);
    if (failing && !news) engine_.announce("LOG_STORE");
  }
  while (!waiting_.empty() && now - waiting_.front().since >= durable_limit) {
    const Waiting late = std::move(waiting_.front());
    waiting_.pop_front();
    reject({.packet = late.packet, .memory = {}}, late.request, pus::FailureNotice{pus::FailureCode::QueueFull});
  }
}

void Supervisor::forward(const Outgoing& outgoing) {
  const auto& [apid, packet, memory, request, mode_epoch, essential, releases_stop, fences] = outgoing;
  Channel* channel = channel_of(apid);
  // The stop is lifted by exactly this telecommand, when it leaves.
  if (releases_stop && apid != 1 && !parts_.guard.release(apid, fences))
    return reject({.packet = packet, .memory = {}}, request, pus::FailureNotice{pus::FailureCode::NotPermittedNow});
  const Message message{.kind = MessageKind::Packet, .mode_epoch = mode_epoch, .packet = packet, .memory = memory};
  const bool sent = channel != nullptr && channel->send(message).has_value();
  if (!sent) {
    const auto code = channel == nullptr ? pus::FailureCode::UnknownApid : pus::FailureCode::QueueFull;
    return reject({.packet = packet, .memory = {}}, request, pus::FailureNotice{code});
  }
  if (const auto telecommand = pus::TelecommandView::parse(packet); apid != 1 && telecommand)
    outstanding_.forwarded(apid, *telecommand);
  static_cast<void>(parts_.log.append({.kind = LogKind::TelecommandForwarded,
                                       .source = 1,
                                       .peer = apid,
                                       .packet = packet,
                                       .note = essential ? "essential" : ""}));
}

bool Supervisor::carry_out_at_once(const Incoming&, const pus::Request& request, std::string_view function) {
  if (function != "SAFE_ALL" && function != "SHUTDOWN") return false;
  if (function == "SAFE_ALL") stops_.push_back({parts_.guard.stop_all(), request});
  engine_.verification().accepted(request);
  engine_.verification().started(request);
  if (function == "SAFE_ALL") {
    after_stop("SAFE_ALL");
  } else {
    request_shutdown();
    engine_.verification().completed(request);
  }
  return true;
}

void Supervisor::reject(const Incoming& incoming, const pus::Request& request, const pus::FailureNotice& notice) {
  const bool damaged = notice.code() == pus::FailureCode::ErrorControl ||
                       notice.code() == pus::FailureCode::IllegalLength ||
                       notice.code() == pus::FailureCode::IllegalPrimaryHeader ||
                       notice.code() == pus::FailureCode::IllegalSequenceFlags;
  // Beyond the cap they are counted only: a flood of them must not fill the log's queue before honest telecommands.
  if (damaged && reports_in_window_ > damaged_reports_per_second) return count_rejection(notice.code());
  const auto header = pus::read_primary_header(incoming.packet);
  static_cast<void>(parts_.log.append({.kind = LogKind::TelecommandRefused,
                                       .source = incoming.source,
                                       .peer = header ? header->apid : std::uint16_t{0},
                                       .packet = incoming.packet,
                                       .note = to_text(notice.code())}));
  if (notice.code() == pus::FailureCode::UnknownApid) engine_.verification().routing_failed(request, notice);
  else engine_.verification().rejected(request, notice);
}

Situation Supervisor::situation_of(std::uint16_t apid) const {
  Situation situation{
      .mission = mission_, .mode = *mode_, .links = links_.graph(), .state = std::nullopt, .power = &power_};
  if (apid == 1) {
    situation.state = engine_.state();
    situation.configuration = static_cast<std::uint8_t>(own_vital_->configuration.load(std::memory_order_relaxed));
    return situation;
  }
  const auto found = std::ranges::find(members_, apid, &Member::apid);
  if (found == members_.end() || !found->alive()) return situation;
  situation.state = found->state();
  situation.configuration = found->configuration();
  return situation;
}

// --- telemetry ---------------------------------------------------------------------------------------------------------

void Supervisor::handle_telemetry(std::uint16_t from, Octets packet) {
  const auto report = pus::TelemetryView::parse(packet);
  // Who sends is known from the channel (decision 2): a packet with another APID is not passed on.
  if (!report || report->apid() != from) return count_unreadable(from);
  ++counts_.telemetry;
  const bool event = report->service() == 5 && report->subtype() <= 4;
  static_cast<void>(parts_.log.append({.kind = event ? LogKind::Event : LogKind::Telemetry,
                                       .source = from,
                                       .peer = report->destination(),
                                       .packet = packet}));
  parts_.observer.routed(*report);
  const auto* ground = mission_.find_subsystem(mission_.ground.subsystem);
  if (ground != nullptr) {
    Member* link = member(ground->subsystem.id);
    if (link != nullptr && link->alive() && link->state() != State::Offline)
      ground_route_.send(*link->channel(), packet, GroundRoute::kind_of(*report), now_);
  }
  interpret(from, *report);
}

/// Every telecommand that is not carried out, whoever says so: each failure report passes here.
void Supervisor::count_failure(const pus::TelemetryView& report) {
  const bool failure = report.service() == 1 && report.subtype() % 2 == 0;
  if (!failure) return;
  OctetReader reader{report.source_data()};
  static_cast<void>(reader.get<std::uint32_t>());
  if (report.subtype() == 6) static_cast<void>(reader.get<std::uint16_t>());
  const auto code = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
  if (reader.good()) count_rejection(code);
}

void Supervisor::count_rejection(pus::FailureCode code) {
  const auto place = static_cast<std::size_t>(code);
  ++rejections_[place < rejection_reasons ? place : 0];
}

void Supervisor::interpret(std::uint16_t from, const pus::TelemetryView& report) {
  count_failure(report);
  const std::size_t under_way = outstanding_.size();
  outstanding_.reported(report);
  if (outstanding_.size() < under_way) outstanding_moved_ = now_;
  // A failure of any stage, or completion: the telecommand is over.
  if (report.service() == 1 && (report.subtype() % 2 == 0 || report.subtype() == 7)) {
    OctetReader reader{report.source_data()};
    const auto id = reader.get<std::uint32_t>();
    if (reader.good()) power_.ended({id, report.destination(), 0});
  }
  if (report.service() == 1 && report.destination() == own_source) handle_verification(report);
  if (report.service() == pus::st128::service_type) links_.handle(from, report);
}

void Supervisor::handle_verification(const pus::TelemetryView& report) {
  OctetReader reader{report.source_data()};
  const auto found = own_requests_.find(reader.get<std::uint32_t>());
  if (found == own_requests_.end() || !reader.good()) return;
  const bool failure = report.subtype() % 2 == 0;
  const bool completed = report.subtype() == 7;
  if (!failure && !completed) return;
  OwnRequest request = std::move(found->second);
  own_requests_.erase(found);
  if (report.subtype() == 6) static_cast<void>(reader.get<std::uint16_t>());
  const auto code = static_cast<pus::FailureCode>(failure ? reader.get<std::uint16_t>() : 0);
  if (failure) tell(request.what + " failed: " + std::string{to_text(code)}, report.apid());
  if (request.done) request.done(completed, failure ? std::string{to_text(code)} : std::string{});
}

// --- the supervisor's own telecommands ---------------------------------------------------------------------------------

void Supervisor::command(std::uint16_t apid, std::string_view name, std::optional<double> argument, CommandDone done) {
  const auto* member = apid == 1 ? nullptr : mission_.find_subsystem(apid);
  const descriptor::Subsystem& subsystem = member != nullptr ? member->subsystem : mission_.supervisor;
  static const auto built_in = pus::common_functions();
  const auto common = std::ranges::find(built_in, name, &descriptor::Function::name);
  const descriptor::Function* function = common != built_in.end() ? &*common : subsystem.find_function(name);
  std::vector<double> values;
  if (argument) values.push_back(*argument);
  const auto data = function != nullptr ? pus::encode_call(*function, std::span<const double>{values})
                                        : Result<std::vector<std::byte>>{fail(ErrorCode::NotFound, "unknown function")};
  if (!data) {
    if (done) done(false, data.error().text);
    return;
  }
  send_own(apid, 8, 1, *data, {}, std::move(done));
}

void Supervisor::send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) {
  const auto link = data.empty() ? std::uint8_t{0} : std::to_integer<std::uint8_t>(data[0]);
  send_own(apid, pus::st128::service_type, subtype, data, memory, [=, this](bool success, const std::string& why) {
    if (!success) links_.failed(apid, subtype, link, name_of(apid) + ": " + why);
  });
}

void Supervisor::send_own(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                          const MemoryHandle& memory, CommandDone done) {
  std::array<std::byte, max_packet_octets> buffer;
  constexpr std::uint16_t modulo = 16'384;
  const std::uint16_t count = next_sequence_count_;
  next_sequence_count_ = static_cast<std::uint16_t>((count + 1) % modulo);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = apid,
                                              .sequence_count = count,
                                              .ack = pus::ack_acceptance | pus::ack_completion,
                                              .service = service,
                                              .subtype = subtype,
                                              .source = own_source},
                                             data);
  if (!packet) {
    if (done) done(false, packet.error().text);
    return;
  }
  const auto telecommand = pus::TelecommandView::parse(*packet);
  own_requests_[telecommand->request_id()] = {std::move(done), now_ + own_request_limit,
                                              name_of(apid) + " " + telecommand_text(*telecommand), apid};
  handle_telecommand({.packet = *packet, .sender = Sender::Supervisor, .source = 1, .memory = memory});
}

void Supervisor::expire_requests(TimePoint now) {
  std::vector<OwnRequest> expired;
  std::erase_if(own_requests_, [&](auto& entry) {
    if (entry.second.deadline > now) return false;
    expired.push_back(std::move(entry.second));
    return true;
  });
  for (OwnRequest& request : expired) {
    tell(request.what + ": no answer");
    if (request.done) request.done(false, "no answer");
  }
}

/// Who has died answers nothing any more: what waits for it goes on at once.
void Supervisor::fail_requests_to(std::uint16_t apid, const std::string& why) {
  std::vector<CommandDone> ended;
  std::erase_if(own_requests_, [&](auto& entry) {
    if (entry.second.apid != apid) return false;
    ended.push_back(std::move(entry.second.done));
    return true;
  });
  for (const CommandDone& done : ended)
    if (done) done(false, why);
}

}  // namespace hirosco::supervisor
