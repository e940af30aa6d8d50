// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "hirosco/descriptor/read/detail/function_reader.hpp"

/// A subsystem's own PUS services (adr 0060).
namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t max_subtypes = 255;
constexpr std::size_t max_fields = 64;
/// Octets of a request's or report's data: a packet of 4096 less headers and checksum.
constexpr std::size_t max_request_octets = 4096 - 13;
constexpr std::size_t max_report_octets = 4096 - 22;

}  // namespace

void CustomServiceReader::read(const xml::Element& element) {
  Attributes attributes{element, problems_};
  CustomService service;
  service.at = place(element.at);
  service.name = attributes.name();
  service.type = attributes.required_integer<std::uint8_t>("type", first_custom_service, 255);
  Unique subtypes{"subtype of the service", "E0202"}, reports{"report name", "E0201"};
  each_child(
      element, problems_,
      {{"Request", [&](const xml::Element& child) { read_request(child, service, subtypes); }, max_subtypes},
       {"Report", [&](const xml::Element& child) { read_report(child, service, subtypes, reports); }, max_subtypes}});
  if (service.requests.empty()) problems_.add(element, "E0106", "<CustomService> needs at least one <Request>");
  const std::size_t length = element.name.size() + 1;
  if (!service.name.empty()) service_names_.add(service.name, service.at, problems_, length);
  if (service.type != 0) service_types_.add(std::to_string(service.type), service.at, problems_, length);
  subsystem_.services.push_back(std::move(service));
}

void CustomServiceReader::read_request(const xml::Element& element, CustomService& service, Unique& subtypes) {
  Attributes attributes{element, problems_};
  Function request;
  request.at = place(element.at);
  request.name = attributes.name("name", NameKind::Function);
  request.service = service.type;
  request.subtype = attributes.required_integer<std::uint8_t>("subtype", 1, 255);
  request.essential = attributes.yes("essential", false);
  request.confirm = attributes.yes("confirm", false);
  request.states =
      read_states(attributes, "states",
                  {State::PreOperational, State::SafeOperational, State::Operational, State::ErrorOperational});
  functions_.read_sets(attributes, request);
  Unique names{"argument name", "E0201"};
  each_child(
      element, problems_,
      {{"Argument", [&](const xml::Element& child) { functions_.read_argument(child, request, names); }, max_fields},
       {"Description",
        [&](const xml::Element& child) {
          no_children(child, problems_, true);
          request.description = child.text;
        },
        1}});
  std::size_t octets = 0;
  for (const auto& argument : request.arguments) octets += argument.octets();
  if (octets > max_request_octets)
    problems_.add(element, "E0215", fmt::format("request '{}' takes {} octets", request.name, octets),
                  fmt::format("at most {}", max_request_octets));
  const std::size_t length = element.name.size() + 1;
  functions_.claim_name(element, request);
  if (request.subtype != 0) subtypes.add(std::to_string(request.subtype), request.at, problems_, length);
  service.requests.push_back(std::move(request));
}

void CustomServiceReader::read_report(const xml::Element& element, CustomService& service, Unique& subtypes,
                                      Unique& names) {
  Attributes attributes{element, problems_};
  CustomService::Report report;
  const Location at = place(element.at);
  report.name = attributes.name();
  report.subtype = attributes.required_integer<std::uint8_t>("subtype", 1, 255);
  Unique fields{"field name", "E0201"};
  each_child(element, problems_,
             {{"Field",
               [&](const xml::Element& child) {
                 std::vector<Field> one;
                 fields_.read_plain(child, one, fields, Says::Report);
                 report.fields.push_back({.field = std::move(one.front()), .of = {}, .fallback = {}, .texts = {}});
               },
               max_fields}});
  std::size_t octets = 0;
  for (const auto& field : report.fields) octets += field.octets();
  if (octets > max_report_octets)
    problems_.add(element, "E0215", fmt::format("report '{}' takes {} octets", report.name, octets),
                  fmt::format("at most {}", max_report_octets));
  const std::size_t length = element.name.size() + 1;
  if (!report.name.empty()) names.add(report.name, at, problems_, length);
  if (report.subtype != 0) subtypes.add(std::to_string(report.subtype), at, problems_, length);
  service.reports.push_back(std::move(report));
}

}  // namespace hirosco::descriptor::detail
