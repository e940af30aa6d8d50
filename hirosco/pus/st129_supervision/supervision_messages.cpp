// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include "hirosco/pus/packet/cuc.hpp"

namespace hirosco::pus::st129 {
namespace kind {

constexpr Part word(std::string_view name) noexcept { return {.name = name, .form = Form::Word}; }

constexpr Part packet[]{{.name = "TELECOMMAND", .form = Form::Rest}};
constexpr Part answer[]{number("REQUEST", Type::Uint32), number("PERMITTED", Type::Uint8),
                        number("CODE", Type::Uint16)};
constexpr Part mode[]{number("MODE", Type::Uint8)};
constexpr Part reason[]{word("WHY")};
constexpr Part step[]{number("STAGE", Type::Uint8), number("SUBSYSTEM", Type::Uint16), word("WHAT")};
constexpr Part preview[]{number("MODE", Type::Uint8), list("AGAINST", reason), list("STEPS", step)};
constexpr Part problem[]{number("SUBSYSTEM", Type::Uint16),
                         number("COUNT", Type::Uint16),
                         word("FILE"),
                         number("LINE", Type::Uint32),
                         number("COLUMN", Type::Uint32),
                         word("CODE"),
                         word("WHAT"),
                         word("HINT")};
constexpr Part event[]{number("SUBSYSTEM", Type::Uint16), number("EVENT", Type::Uint16)};
constexpr Part plan[]{number("SUBSYSTEM", Type::Uint16),
                      number("EVENT", Type::Uint16),
                      number("SEVERITY", Type::Uint8),
                      number("PLAN", Type::Uint16),
                      word("NAME"),
                      list("AGAINST", reason),
                      list("STEPS", step)};
constexpr std::string_view what_may_be_heard[]{"", "structure", "event"};
constexpr Part subscribed[]{number("SUBSYSTEM", Type::Uint16),
                            {.name = "WHAT", .type = Type::Uint8, .names = what_may_be_heard},
                            number("ID", Type::Uint16)};
constexpr std::string_view yes_or_no[]{"no", "yes"};
constexpr Part times[]{{.name = "FROM", .form = Form::Time},
                       {.name = "TO", .form = Form::Time},
                       {.name = "HOUSEKEEPING", .type = Type::Uint8, .names = yes_or_no}};
constexpr Part retrieved_report[]{number("NUMBER", Type::Uint64), {.name = "REPORT", .form = Form::Rest}};
constexpr Part counts[]{number("REQUEST", Type::Uint32),  number("REPORTS", Type::Uint32),
                        number("LEFT_OUT", Type::Uint32), number("MISSING", Type::Uint32),
                        number("DAMAGED", Type::Uint32),  word("WHY")};
constexpr RequestKind requests[]{
    {permission_question, "IS_IT_PERMITTED", packet}, {mode_question, "PREVIEW_MODE", mode},
    {plan_question, "PREVIEW_PLAN", event},           {subscribe, "SUBSCRIBE", subscribed},
    {unsubscribe, "UNSUBSCRIBE", subscribed},         {retrieve, "RETRIEVE", times}};
constexpr ReportKind reports[]{{permission_answer, "PERMISSION", answer},
                               {telecommand_copy, "COPY", packet},
                               {mode_preview, "MODE_PREVIEW", preview},
                               {plan_preview, "PLAN_PREVIEW", plan},
                               {descriptor_problem, "DESCRIPTOR_PROBLEM", problem},
                               {retrieved, "RETRIEVED", retrieved_report},
                               {retrieval_end, "RETRIEVAL_END", counts}};

}  // namespace kind

namespace {

constexpr std::size_t most = 255;  // a count and a length have one octet each

void put_words(OctetWriter& writer, std::string_view words) {
  words = words.substr(0, most);
  writer.put(static_cast<std::uint8_t>(words.size())).put(std::as_bytes(std::span{words}));
}

[[nodiscard]] std::string get_words(OctetReader& reader) {
  const Octets words = reader.get(reader.get<std::uint8_t>());
  return {reinterpret_cast<const char*>(words.data()), words.size()};
}

/// Reasons and steps, as both previews end.
void get_outlook(OctetReader& reader, std::vector<std::string>& against, std::vector<ModePreview::Step>& steps) {
  for (auto left = reader.get<std::uint8_t>(); left != 0 && reader.good(); --left) against.push_back(get_words(reader));
  for (auto left = reader.get<std::uint8_t>(); left != 0 && reader.good(); --left) {
    ModePreview::Step step{.stage = reader.get<std::uint8_t>(), .subject = reader.get<std::uint16_t>(), .what = {}};
    step.what = get_words(reader);
    steps.push_back(std::move(step));
  }
}

/// What stands in `writer` already, and these.
[[nodiscard]] Octets put_outlook(MutableOctets buffer, OctetWriter& writer, const std::vector<std::string>& against,
                                 const std::vector<ModePreview::Step>& steps) {
  const std::size_t reasons = std::min(against.size(), most);
  writer.put(static_cast<std::uint8_t>(reasons));
  for (std::size_t i = 0; i < reasons; ++i) put_words(writer, against[i]);
  const std::size_t count_at = writer.size();
  writer.put(std::uint8_t{0});
  std::size_t octets = writer.size();
  std::uint8_t count = 0;
  for (const ModePreview::Step& each : steps) {
    if (count == most) break;
    writer.put(each.stage).put(each.subject);
    put_words(writer, each.what);
    if (!writer.good()) break;
    octets = writer.size();
    ++count;
  }
  if (octets <= count_at) return {};  // reasons alone found no room: a buffer that is too small
  buffer[count_at] = std::byte{count};
  return Octets{buffer}.first(octets);
}

}  // namespace

std::vector<std::byte> write_descriptor_problem(const DescriptorProblem& problem) {
  constexpr std::size_t words = 4, octets_before = 12;
  std::vector<std::byte> data(octets_before + words * (most + 1));
  OctetWriter writer{data};
  const std::string_view file{problem.file};
  writer.put(problem.apid).put(problem.count);
  put_words(writer, file.substr(file.size() - std::min(file.size(), most)));
  writer.put(problem.line).put(problem.column);
  for (const std::string_view text : {problem.code, problem.what, problem.hint}) put_words(writer, text);
  data.resize(writer.size());
  return data;
}

std::optional<DescriptorProblem> read_descriptor_problem(Octets data) {
  OctetReader reader{data};
  DescriptorProblem problem;
  problem.apid = reader.get<std::uint16_t>();
  problem.count = reader.get<std::uint16_t>();
  problem.file = get_words(reader);
  problem.line = reader.get<std::uint32_t>();
  problem.column = reader.get<std::uint32_t>();
  for (std::string* const text : {&problem.code, &problem.what, &problem.hint}) *text = get_words(reader);
  return reader.exhausted() ? std::optional{std::move(problem)} : std::nullopt;
}

std::optional<ModePreview> read_mode_preview(Octets data) {
  OctetReader reader{data};
  ModePreview preview{.mode = reader.get<std::uint8_t>(), .against = {}, .steps = {}};
  get_outlook(reader, preview.against, preview.steps);
  return reader.exhausted() ? std::optional{std::move(preview)} : std::nullopt;
}

Octets write_mode_preview(MutableOctets buffer, const ModePreview& preview) {
  OctetWriter writer{buffer};
  writer.put(preview.mode);
  return put_outlook(buffer, writer, preview.against, preview.steps);
}

std::optional<PlanPreview> read_plan_preview(Octets data) {
  OctetReader reader{data};
  PlanPreview preview;
  preview.subsystem = reader.get<std::uint16_t>();
  preview.event = reader.get<std::uint16_t>();
  preview.severity = reader.get<std::uint8_t>();
  preview.plan = reader.get<std::uint16_t>();
  preview.name = get_words(reader);
  get_outlook(reader, preview.against, preview.steps);
  return reader.exhausted() ? std::optional{std::move(preview)} : std::nullopt;
}

Octets write_plan_preview(MutableOctets buffer, const PlanPreview& preview) {
  OctetWriter writer{buffer};
  writer.put(preview.subsystem).put(preview.event).put(preview.severity).put(preview.plan);
  put_words(writer, preview.name);
  return put_outlook(buffer, writer, preview.against, preview.steps);
}

std::array<std::byte, subscribed_octets> write_subscribed(const Subscribed& subscribed) noexcept {
  std::array<std::byte, subscribed_octets> data{};
  OctetWriter{data}.put(subscribed.apid).put(static_cast<std::uint8_t>(subscribed.what)).put(subscribed.id);
  return data;
}

std::optional<Subscribed> read_subscribed(Octets data) noexcept {
  OctetReader reader{data};
  Subscribed subscribed{.apid = reader.get<std::uint16_t>()};
  const auto what = reader.get<std::uint8_t>();
  subscribed.what = static_cast<Subscribed::What>(what);
  subscribed.id = reader.get<std::uint16_t>();
  const bool known = what == 1 || what == 2;
  return known && reader.exhausted() ? std::optional{subscribed} : std::nullopt;
}

std::array<std::byte, retrieve_octets> write_retrieve(const Retrieve& wanted) noexcept {
  std::array<std::byte, retrieve_octets> data{};
  OctetWriter{data}.put(to_cuc(wanted.from)).put(to_cuc(wanted.to)).put(static_cast<std::uint8_t>(wanted.housekeeping));
  return data;
}

std::optional<Retrieve> read_retrieve(Octets data) noexcept {
  OctetReader reader{data};
  const Octets from = reader.get(cuc_octets), to = reader.get(cuc_octets);
  const auto housekeeping = reader.get<std::uint8_t>();
  if (!reader.exhausted() || housekeeping > 1) return std::nullopt;
  return Retrieve{from_cuc(from), from_cuc(to), housekeeping == 1};
}

Octets write_retrieved(MutableOctets buffer, const Retrieved& report) noexcept {
  if (report.packet.size() > max_retrieved_octets) return {};
  OctetWriter writer{buffer};
  writer.put(report.number).put(report.packet);
  return writer.good() ? Octets{buffer}.first(writer.size()) : Octets{};
}

std::optional<Retrieved> read_retrieved(Octets data) noexcept {
  OctetReader reader{data};
  const auto number = reader.get<std::uint64_t>();
  if (!reader.good()) return std::nullopt;
  return Retrieved{number, reader.rest()};
}

bool is_retrieved(const TelemetryView& report) noexcept {
  return report.apid() == supervisor_apid && report.service() == service_type && report.subtype() == retrieved;
}

std::vector<std::byte> write_retrieval_end(const RetrievalEnd& end) {
  constexpr std::size_t numbers = 20;
  std::vector<std::byte> data(numbers + 1 + most);
  OctetWriter writer{data};
  writer.put(end.request).put(end.reports).put(end.left_out).put(end.missing).put(end.damaged);
  put_words(writer, end.why);
  data.resize(writer.size());
  return data;
}

std::optional<RetrievalEnd> read_retrieval_end(Octets data) {
  OctetReader reader{data};
  RetrievalEnd end;
  for (std::uint32_t* const count : {&end.request, &end.reports, &end.left_out, &end.missing, &end.damaged})
    *count = reader.get<std::uint32_t>();
  end.why = get_words(reader);
  return reader.exhausted() ? std::optional{std::move(end)} : std::nullopt;
}

const ServiceKind service_kind{.type = service_type,
                               .name = "supervision",
                               .needs = Needs::SupervisorAnswers,
                               .requests = kind::requests,
                               .reports = kind::reports};

}  // namespace hirosco::pus::st129
