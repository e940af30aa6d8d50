// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/requester.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"

namespace hirosco {
namespace {

/// Of its own half, whatever `number` is.
[[nodiscard]] constexpr std::uint16_t count_of_request(std::int64_t number) noexcept {
  constexpr std::int64_t half = pus::sequence_counts - Requester::first_count;
  return static_cast<std::uint16_t>(Requester::first_count + number % half);
}

using Stage = RequestReport::Stage;

[[nodiscard]] std::optional<Stage> stage_of(std::uint8_t subtype) noexcept {
  switch (subtype) {
    case 1: return Stage::Accepted;
    case 3: return Stage::Started;
    case 5: return Stage::Progressed;
    case 6: return Stage::StepFailed;
    case 7: return Stage::Completed;
    case 2:
    case 4:
    case 10: return Stage::Refused;
    case 8: return Stage::Failed;
    default: return std::nullopt;
  }
}

struct Service {
  Ask asked{};
  descriptor::Thing::Kind of{};
  std::string_view attribute;  ///< of <Commands>
  std::uint8_t type{}, subtype{};
  std::size_t id_octets{};
};
[[nodiscard]] const Service& service_of(Ask asked) noexcept {
  using enum Ask;
  using Kind = descriptor::Thing::Kind;
  using Housekeeping = pus::HousekeepingService;
  using Events = pus::EventService;
  using Parameters = pus::ParameterService;
  static constexpr std::array table{
      Service{SetValue, Kind::Set, "sets", Parameters::service_type, Parameters::set_values, 4},
      Service{ReadValue, Kind::Read, "reads", Parameters::service_type, Parameters::report_values, 4},
      Service{EnableHousekeeping, Kind::Housekeeping, "housekeeping", Housekeeping::service_type,
              Housekeeping::enable_periodic, 2},
      Service{DisableHousekeeping, Kind::Housekeeping, "housekeeping", Housekeeping::service_type,
              Housekeeping::disable_periodic, 2},
      Service{OneShotHousekeeping, Kind::Housekeeping, "housekeeping", Housekeeping::service_type,
              Housekeeping::one_shot, 2},
      Service{SetInterval, Kind::Housekeeping, "housekeeping", Housekeeping::service_type,
              Housekeeping::modify_interval, 2},
      Service{EnableEvent, Kind::Event, "events", Events::service_type, Events::enable_reports, 2},
      Service{DisableEvent, Kind::Event, "events", Events::service_type, Events::disable_reports, 2}};
  return *std::ranges::find(table, asked, &Service::asked);
}

/// A parameter's words have all their octets, where an argument's have their length before them.
[[nodiscard]] Result<Octets> write_thing(MutableOctets room, Octets before, const descriptor::Function& function,
                                         pus::GivenValues values) noexcept {
  OctetWriter writer{room};
  writer.put(before);
  std::size_t next = 0;
  for (const pus::Argument& argument : function.arguments)
    for (std::size_t i = 0; i < pus::value_count(argument); ++i) {
      const auto value = values.at(next++);
      if (!value) return fail(ErrorCode::InvalidArgument, "argument missing", static_cast<std::int64_t>(next));
      HIROSCO_TRY(pus::write_value(writer, argument, *value, pus::Words::Padded));
    }
  if (next < values.size()) return fail(ErrorCode::InvalidArgument, "too many arguments");
  return pus::all_written(writer);
}

}  // namespace

/// A subsystem that was started again must not take answers to its predecessor for its own: it goes on counting elsewhere.
Requester::Requester(const descriptor::SubsystemDescriptor& described, Channel& channel, TimePoint now)
    : descriptor_{described},
      channel_{channel},
      next_count_{count_of_request(now.time_since_epoch() / std::chrono::milliseconds{1})} {
  open_.reserve(most_open);
}

std::string Requester::use(const RequestPort& port, RequestHandler handler, Duration patience) {
  const std::string who = "use_request " + std::string{port.subsystem()} + " " + std::string{port.function()} + ": ";
  const auto commands = std::ranges::find(descriptor_.commands, port.subsystem(), &descriptor::Commands::subsystem);
  if (commands == descriptor_.commands.end()) return who + "the descriptor has no <Commands> of this subsystem";
  Bound made{.port = &port, .apid = commands->apid, .handler = std::move(handler), .patience = patience};
  const std::string problem =
      port.what() == Ask::Function ? bind_function(port, *commands, made) : bind_thing(port, *commands, made);
  if (!problem.empty()) return who + problem;
  if (port.arguments() && !same_types(*port.arguments(), made.function.arguments))
    return who + "its arguments are (" + types_text(*port.arguments()) + "), the descriptor of " +
           std::string{port.subsystem()} + " declares (" + types_text(pus::ArgumentList{made.function.arguments}) + ")";
  const auto before = std::ranges::find(bound_, &port, &Bound::port);
  Bound& bound = before != bound_.end() ? *before : bound_.emplace_back();
  bound = std::move(made);
  return {};
}

std::string Requester::bind_function(const RequestPort& port, const descriptor::Commands& commands,
                                     Bound& bound) const {
  const auto named = std::ranges::find(commands.functions, port.function());
  if (named == commands.functions.end()) return "<Commands> does not name this function";
  if (commands.requests.size() != commands.functions.size()) return "no mission says who that is";
  bound.function = commands.requests[static_cast<std::size_t>(named - commands.functions.begin())];
  return {};
}

std::string Requester::bind_thing(const RequestPort& port, const descriptor::Commands& commands, Bound& bound) const {
  const Service& service = service_of(port.what());
  const auto named = std::ranges::find_if(commands.things, [&](const descriptor::Thing& each) {
    return each.kind == service.of && each.name == port.function();
  });
  if (named == commands.things.end()) return "<Commands> does not name it in '" + std::string{service.attribute} + "'";
  if (commands.apid == 0) return "no mission says who that is";
  bound.function.name = named->name;
  bound.function.service = service.type;
  bound.function.subtype = service.subtype;
  bound.before.resize(1 + service.id_octets);
  OctetWriter writer{bound.before};
  writer.put(std::uint8_t{1});
  if (service.id_octets == sizeof(std::uint32_t)) writer.put(named->id);
  else writer.put(static_cast<std::uint16_t>(named->id));
  const auto add = [&](descriptor::Field field) {
    bound.function.arguments.push_back({.field = std::move(field), .of = {}, .fallback = {}});
  };
  if (port.what() == Ask::SetValue)
    for (const descriptor::Field& field : named->fields) add(field);
  if (port.what() == Ask::SetInterval) {
    descriptor::Field cycles;
    cycles.name = "INTERVAL";
    cycles.type = Type::Uint32;
    add(std::move(cycles));
  }
  return {};
}

Result<std::uint32_t> Requester::send(const RequestPort& port, pus::GivenValues values, TimePoint now,
                                      std::uint32_t known_stop) {
  const auto bound = std::ranges::find(bound_, &port, &Bound::port);
  if (bound == bound_.end()) return fail(ErrorCode::NotPermitted, "not bound: use_request() in software_init()");
  if (open_.size() == most_open)
    return fail(ErrorCode::ResourceExhausted, "requests under way", static_cast<std::int64_t>(most_open));
  if (now - window_ >= std::chrono::seconds{1}) {
    window_ = now;
    sent_in_window_ = 0;
  }
  if (sent_in_window_ == most_a_second)
    return fail(ErrorCode::ResourceExhausted, "requests in a second", static_cast<std::int64_t>(most_a_second));
  std::array<std::byte, pus::max_telecommand_octets> room;
  HIROSCO_TRY_LET(const Octets data, bound->before.empty() ? pus::write_request(room, bound->function, values)
                                                           : write_thing(room, bound->before, bound->function, values));
  std::array<std::byte, max_packet_octets> buffer;
  HIROSCO_TRY_LET(const Octets packet, pus::write_telecommand(buffer,
                                                              {.apid = bound->apid,
                                                               .sequence_count = next_count_,
                                                               .ack = pus::ack_all,
                                                               .service = bound->function.service,
                                                               .subtype = bound->function.subtype,
                                                               .source = descriptor_.id},
                                                              data));
  HIROSCO_TRY(channel_.send({.epoch = known_stop, .packet = packet}));
  next_count_ = count_of_request(next_count_ + 1 - first_count);
  ++sent_in_window_;
  const std::uint32_t id = pus::read_primary_header(packet)->request_id;
  open_.push_back({id, &*bound, now + bound->patience});
  return id;
}

void Requester::hear(const pus::TelemetryView& report) {
  if (report.service() == pus::Verification::service_type) hear_verification(report);
  else hear_answer(report);
}

void Requester::hear_verification(const pus::TelemetryView& report) {
  OctetReader reader{report.source_data()};
  const auto id = reader.get<std::uint32_t>();
  const auto stage = stage_of(report.subtype());
  const auto open = std::ranges::find(open_, id, &Open::id);
  if (!reader.good() || !stage || open == open_.end()) return;
  // Only who was asked says how it went, and the supervisor for it.
  if (report.apid() != open->bound->apid && report.apid() != pus::supervisor_apid) return;
  RequestReport heard{.stage = *stage, .request = id};
  if (*stage == Stage::Progressed || *stage == Stage::StepFailed) heard.step = reader.get<std::uint16_t>();
  if (*stage == Stage::Refused || *stage == Stage::Failed || *stage == Stage::StepFailed) {
    heard.code = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
    const bool own = static_cast<std::uint16_t>(heard.code) >= pus::first_own_failure_code;
    heard.reason = own ? std::string_view{"a failure code of its own"} : to_text(heard.code);
    if (const auto why = pus::reason_in(reader.rest())) {
      heard.number = why->number;
      if (!why->text.empty()) heard.reason = why->text;
    }
  }
  if (!heard.is_end()) {
    if (open->bound->handler) open->bound->handler(heard);
    return;
  }
  end(static_cast<std::size_t>(open - open_.begin()), heard);
}

/// No other report says whom it answers: it is the oldest request to this service.
void Requester::hear_answer(const pus::TelemetryView& report) {
  const auto open = std::ranges::find_if(open_, [&](const Open& each) {
    return each.bound->apid == report.apid() && each.bound->function.service == report.service();
  });
  if (open == open_.end() || !open->bound->handler) return;
  open->bound->handler(
      {.stage = Stage::Answered, .request = open->id, .subtype = report.subtype(), .data = report.source_data()});
}

/// Forgotten first: its handler may ask again.
void Requester::end(std::size_t place, RequestReport report) {
  const Bound& bound = *open_[place].bound;
  open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(place));
  if (bound.handler) bound.handler(report);
}

void Requester::step(TimePoint now) {
  for (std::size_t left = open_.size(), place = 0; left > 0; --left) {
    if (now < open_[place].deadline) ++place;
    else
      end(place, {.stage = Stage::TimedOut,
                  .request = open_[place].id,
                  .code = pus::FailureCode::Timeout,
                  .reason = "nobody said how it ended"});
  }
}

void Requester::forget() {
  for (std::size_t left = open_.size(); left > 0 && !open_.empty(); --left)
    end(0, {.stage = Stage::TimedOut,
            .request = open_.front().id,
            .code = pus::FailureCode::Aborted,
            .reason = "who asked was taken down"});
  open_.clear();
  bound_.clear();
}

}  // namespace hirosco
