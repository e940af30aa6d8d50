// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/confirmation.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/named_request.hpp"
#include "tools/terminal/permitted.hpp"

namespace hirosco::tools {
namespace {

/// Printable, and without what would end a JSON string.
[[nodiscard]] std::string words_of(const pus::Reason& reason) {
  std::string text = pus::text_of(std::as_bytes(std::span{reason.text}));
  std::ranges::replace_if(text, [](char c) { return c == '"' || c == '\\'; }, '\'');
  return reason.number == 0 ? text : fmt::format("{} {}", text, reason.number);
}

/// As docs/failure-codes.md has them: the first in decimal, all others in hexadecimal numbers.
[[nodiscard]] std::string code_text(std::uint16_t code) {
  return code < 0x0100 ? fmt::format("code {}", code) : fmt::format("code 0x{:04X}", code);
}

/// By its name, the author's own by the one that the subsystem's descriptor gives it.
[[nodiscard]] std::string failure_text(std::uint16_t code, const descriptor::SubsystemDescriptor& subsystem) {
  if (code < pus::first_own_failure_code)
    return fmt::format("{} ({})", to_text(static_cast<pus::FailureCode>(code)), code_text(code));
  const auto own = std::ranges::find(subsystem.failures, code, &descriptor::FailureName::code);
  return own != subsystem.failures.end() ? fmt::format("{} ({})", own->name, code_text(code)) : code_text(code);
}

/// Where a request that was refused by mode or state would be permitted, or to whom; empty: refused for another reason.
[[nodiscard]] std::string way_out(const pus::TelemetryView& report, const descriptor::Mission& mission,
                                  const descriptor::SubsystemDescriptor& subsystem, const NamedRequest& encoded) {
  OctetReader reader{report.source_data()};
  static_cast<void>(reader.get<std::uint32_t>());
  const auto code = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
  // A success has no code there, and that of a failed step stands behind the step's number.
  if (report.subtype() % 2 != 0 || report.subtype() == 6) return {};
  std::string request = encoded.request.name;
  if (code == pus::FailureCode::NotPermittedNow && request.starts_with(pus::setting_prefix))
    return terminal::while_in(encoded.request.states);
  if (report.subtype() != 2 || (code != pus::FailureCode::WrongMode && code != pus::FailureCode::WrongState)) return {};
  if (request == "SET_STATE" && !encoded.data.empty())
    request += fmt::format(" {}", to_text(static_cast<descriptor::State>(encoded.data.back())));
  const std::string where = terminal::permitted_where(mission, subsystem, request);
  if (!where.empty()) return "in " + where;
  const std::string others = terminal::permitted_to_others(mission, subsystem, request);
  return others.empty() ? others : "to " + others + " alone";
}

/// Prints one verification report, with `where` the request would be permitted if that is known; true when it was the last of the request.
[[nodiscard]] bool print_report(const pus::TelemetryView& report, const descriptor::SubsystemDescriptor& subsystem,
                                double after_ms, const std::string& where, bool json, bool& success) {
  OctetReader reader{report.source_data()};
  static_cast<void>(reader.get<std::uint32_t>());
  constexpr std::array names{"",          "accepted", "refused", "started",   "start failed", "step", "step failed",
                             "completed", "failed",   "",        "not routed"};
  const std::uint8_t subtype = report.subtype();
  if (subtype >= names.size()) return false;
  const bool failure = subtype % 2 == 0;
  std::string detail;
  if (subtype == 5 || subtype == 6) detail = fmt::format(" {}", reader.get<std::uint16_t>());
  if (failure) {
    const auto code = reader.get<std::uint16_t>();
    detail += ": " + failure_text(code, subsystem);
    if (const auto reason = pus::reason_in(reader.rest())) detail += ": " + words_of(*reason);
    else if (const std::string by = terminal::ended_by(code); !by.empty()) detail += ", " + by;
  }
  if (json) {
    nlohmann::ordered_json object{{"report", fmt::format("1,{}", subtype)},
                                  {"text", names[subtype] + detail},
                                  {"from", report.apid()},
                                  {"after_ms", std::round(100 * after_ms) / 100}};
    if (!where.empty()) object["permitted"] = where;
    fmt::print("{}\n", json_line(object));
  } else {
    fmt::print("{:9.2f} ms  TM[1,{}] {}{}\n", after_ms, subtype, names[subtype], detail);
    if (!where.empty()) fmt::print("              permitted {}\n", where);
  }
  success = subtype == 7;
  return subtype == 7 || (failure && subtype != 6);
}

/// What keeps a descriptor from being read again, as `hirosco check` would say it.
void print_problem(const pus::TelemetryView& report, bool json) {
  if (report.subtype() != pus::st129::descriptor_problem) return;
  const auto problem = pus::st129::read_descriptor_problem(report.source_data());
  if (!problem) return;
  const auto printable = [](const std::string& text) { return pus::text_of(std::as_bytes(std::span{text})); };
  std::string text = fmt::format("{}:{}:{}: error: {}: {}", printable(problem->file), problem->line, problem->column,
                                 printable(problem->code), printable(problem->what));
  if (!problem->hint.empty()) text += " (" + printable(problem->hint) + ")";
  if (!json) return fmt::print("{}\n", text);
  fmt::print("{}\n", json_line({{"report", "129,10"}, {"text", text}, {"from", report.apid()}}));
}

/// What is against a change of mode that is refused, as `hirosco mode --preview` would say it.
void print_against(const pus::TelemetryView& report, bool json) {
  if (report.subtype() != pus::st129::mode_preview) return;
  const auto preview = pus::st129::read_mode_preview(report.source_data());
  if (!preview) return;
  for (const std::string& each : preview->against) {
    const std::string text = pus::text_of(std::as_bytes(std::span{each}));
    if (json)
      fmt::print("{}\n", json_line({{"report", "129,5"}, {"text", "impossible: " + text}, {"from", report.apid()}}));
    else fmt::print("              impossible: {}\n", text);
  }
}

/// What a person at the terminal says; nothing at its end.
[[nodiscard]] std::string ask(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Function& request) {
  fmt::print(stderr, "{} {} wants to be confirmed: send it? [y/N] ", subsystem.name, request.name);
  std::array<char, 16> answer{};
  return std::fgets(answer.data(), static_cast<int>(answer.size()), stdin) != nullptr ? answer.data() : "";
}

}  // namespace

int telecommand(const TelecommandOptions& options) {
  const auto place = find_ground_link("tc", options.connection);
  if (!place) return place.error();
  const descriptor::Mission& mission = place->mission;
  const auto encoded = named_request(mission, options.subsystem, options.function, options.arguments);
  if (!encoded) {
    fmt::print(stderr, "hirosco tc: {}\n", encoded.error());
    return exit_usage;
  }
  const descriptor::SubsystemDescriptor* const subsystem = encoded->subsystem;
  const descriptor::Function& request = encoded->request;
  const bool person = ::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0;
  if (!may_be_sent(request.confirm, options.yes, person, [&] { return ask(*subsystem, request); })) {
    fmt::print(stderr, "hirosco tc: not sent\n");
    return exit_finding;
  }
  auto connection = GroundConnection::open(place->host, place->port);
  if (!connection) {
    fmt::print(stderr, "hirosco tc: {}:{}: {}\n", place->host, place->port, connection.error().text);
    return exit_environment;
  }
  // A source id and a first count of its own: reports find back to this call and to no other (decision 27).
  const auto source = static_cast<std::uint16_t>(0x4000 | (::getpid() & 0x3FFF));
  const auto count = static_cast<std::uint16_t>(std::chrono::steady_clock::now().time_since_epoch().count() & 0x3FFF);
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = subsystem->id,
                                              .sequence_count = count,
                                              .ack = pus::ack_all,
                                              .service = request.service,
                                              .subtype = request.subtype,
                                              .source = source},
                                             encoded->data);
  // What is essential gets in by the telecommand port whoever fills the other one (docs/adr/0028); without that port the
  // connection for the reports has to do.
  auto own = pus::goes_alone(request) ? GroundConnection::open(place->host, telecommand_port(mission, place->port))
                                      : Result<GroundConnection>{fail(ErrorCode::NotFound, "not essential")};
  GroundConnection& way = own ? *own : *connection;
  if (!packet || !way.send(*packet)) {
    fmt::print(stderr, "hirosco tc: the telecommand could not be sent\n");
    return exit_environment;
  }
  const auto start = std::chrono::steady_clock::now();
  const std::uint32_t id = pus::read_primary_header(*packet)->request_id;
  for (;;) {
    const auto left = options.limit - (std::chrono::steady_clock::now() - start);
    const auto received = connection->receive(std::max(std::chrono::duration_cast<Duration>(left), Duration{0}));
    if (!received || !*received) {
      fmt::print(stderr, "hirosco tc: {}\n", received ? "no final report within the limit" : received.error().text);
      return exit_finding;
    }
    const auto report = pus::TelemetryView::parse(**received);
    if (!report || report->destination() != source) continue;
    if (report->service() == pus::st129::service_type) {
      print_problem(*report, options.connection.json);
      print_against(*report, options.connection.json);
    }
    if (report->service() != 1) continue;
    if (OctetReader{report->source_data()}.get<std::uint32_t>() != id) continue;
    const double after_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    bool success = false;
    const std::string where = way_out(*report, mission, *subsystem, *encoded);
    if (!print_report(*report, *subsystem, after_ms, where, options.connection.json, success)) continue;
    return success ? exit_ok : exit_finding;
  }
}

}  // namespace hirosco::tools
