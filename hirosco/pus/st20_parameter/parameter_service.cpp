// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st20_parameter/parameter_service.hpp"

#include <array>

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace {
constexpr std::size_t max_source_octets = max_telemetry_octets - telemetry_overhead_octets;

/// Of one write: whoever set several must hear which it was, also where the standard's notice has an index only.
[[nodiscard]] FailureNotice refusal(FailureCode code, std::size_t index, std::uint32_t parameter) noexcept {
  FailureNotice notice = instruction_failure(code, index, parameter);
  return code == FailureCode::NotPermittedNow ? notice.with(parameter) : notice;
}
}  // namespace

namespace st20 {
constexpr Part id[]{number("PARAMETER", Type::Uint32)};
constexpr Part ids[]{list("PARAMETERS", id)};
constexpr Part value[]{number("PARAMETER", Type::Uint32), {.name = "VALUE", .form = Form::Value}};
constexpr Part values[]{list("PARAMETERS", value)};
using enum ParameterService::Subtype;
constexpr RequestKind requests[]{{report_values, "REPORT_VALUES", ids}, {set_values, "SET_VALUES", values}};
constexpr ReportKind reports[]{{value_report, "VALUES", values}};
}  // namespace st20

const ServiceKind ParameterService::service_kind{
    .type = service_type, .name = "parameters", .requests = st20::requests, .reports = st20::reports};

void ParameterService::handle(const TelecommandView& telecommand, const Request& request) {
  switch (telecommand.subtype()) {
    case report_values: return report(telecommand.application_data(), request);
    case set_values: return set(telecommand.application_data(), request);
    default: return verification_.rejected(request, unknown_subtype(telecommand));
  }
}

void ParameterService::report(Octets data, const Request& request) {
  const auto count = list_count(data, 4);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  std::array<std::byte, max_source_octets> buffer;
  std::size_t used = 1;
  std::uint8_t known = 0;
  access_.begin_report();
  // Values are read while the instructions are checked: what cannot be read is a rejected instruction.
  const auto check = [&](std::size_t i) -> std::optional<FailureNotice> {
    const auto id = OctetReader{data.subspan(1 + 4 * i, 4)}.get<std::uint32_t>();
    const std::size_t octets = access_.size_of(id);
    if (octets == 0) return instruction_failure(FailureCode::UnknownIdentifier, i, id);
    if (octets + 4 > buffer.size() - used)
      return FailureNotice{FailureCode::CapacityExceeded}.with(static_cast<std::uint8_t>(i));
    const MutableOctets place = MutableOctets{buffer}.subspan(used, octets + 4);
    const auto read = access_.read(id, place.subspan(4));
    if (!read || *read != octets) return FailureNotice{FailureCode::NotPermittedNow}.with(static_cast<std::uint8_t>(i));
    OctetWriter{place}.put(id);
    used += place.size();
    ++known;
    return std::nullopt;
  };
  run_instructions(
      verification_, request, *count, check, [](std::size_t) {},
      [&] {
        buffer[0] = static_cast<std::byte>(known);
        sink_.report(service_type, value_report, request.source, Octets{buffer}.first(used));
      });
}

void ParameterService::set(Octets data, const Request& request) {
  OctetReader reader{data};
  const auto count = reader.get<std::uint8_t>();
  if (!reader.good()) return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
  if (count == 0 && reader.exhausted())
    return verification_.rejected(request, FailureNotice{FailureCode::IllegalField}.with(std::uint16_t{0}));
  std::array<ParameterAccess::Write, max_instructions> writes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto id = reader.get<std::uint32_t>();
    if (!reader.good()) break;
    const std::size_t octets = access_.size_of(id);
    if (octets == 0) {  // all or nothing: its width, and so everything behind it, is unknown
      verification_.accepted(request);
      return verification_.start_failed(request, instruction_failure(FailureCode::UnknownIdentifier, i, id));
    }
    writes[i] = {id, reader.get(octets)};
  }
  if (!reader.exhausted()) return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
  verification_.accepted(request);
  execute_writes(std::span{writes}.first(count), request);
}

/// All of it or nothing: a controller must not run with the new gain and the old limit (adr 0074). Every mistake is told.
void ParameterService::execute_writes(std::span<const ParameterAccess::Write> asked, const Request& request) {
  bool good = true;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto checked = access_.check_write(asked[i].id, asked[i].value);
    if (checked) continue;
    good = false;
    verification_.start_failed(request, refusal(checked.error(), i, asked[i].id));
  }
  if (!good) return;
  if (const auto submitted = access_.submit_write(asked, request); !submitted)
    return verification_.start_failed(request, refusal(submitted.error(), asked.size() - 1, asked.back().id));
  verification_.started(request);
  verification_.completed(request);
}

}  // namespace hirosco::pus
