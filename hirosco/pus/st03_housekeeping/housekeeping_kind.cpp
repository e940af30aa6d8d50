// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {
namespace st03 {

constexpr Part structure_id[]{number("STRUCTURE", Type::Uint16)};
constexpr Part structures[]{list("STRUCTURES", structure_id)};
constexpr Part parameter[]{number("PARAMETER", Type::Uint32)};
constexpr Part sampled_set[]{number("REPETITIONS", Type::Uint16), list("PARAMETERS", parameter)};
constexpr Part definition[]{number("STRUCTURE", Type::Uint16), number("INTERVAL", Type::Uint32),
                            list("PARAMETERS", parameter), list("SETS", sampled_set)};
constexpr Part addition[]{number("STRUCTURE", Type::Uint16), list("PARAMETERS", parameter), list("SETS", sampled_set)};
constexpr Part new_interval[]{number("STRUCTURE", Type::Uint16), number("INTERVAL", Type::Uint32)};
constexpr Part new_intervals[]{list("STRUCTURES", new_interval)};
constexpr Part defined[]{number("STRUCTURE", Type::Uint16), number("PERIODIC", Type::Uint8),
                         number("INTERVAL", Type::Uint32), list("PARAMETERS", parameter), list("SETS", sampled_set)};
constexpr Part properties[]{number("STRUCTURE", Type::Uint16), number("PERIODIC", Type::Uint8),
                            number("INTERVAL", Type::Uint32)};
constexpr Part all_properties[]{list("STRUCTURES", properties)};
constexpr Part values[]{number("STRUCTURE", Type::Uint16), {.name = "VALUES", .form = Form::Rest}};

using enum HousekeepingService::Subtype;
constexpr RequestKind requests[]{
    {create_structure, "CREATE_STRUCTURE", definition},   {delete_structures, "DELETE_STRUCTURES", structures},
    {enable_periodic, "ENABLE_PERIODIC", structures},     {disable_periodic, "DISABLE_PERIODIC", structures},
    {report_structures, "REPORT_STRUCTURES", structures}, {one_shot, "ONE_SHOT", structures},
    {append_parameters, "APPEND_PARAMETERS", addition},   {modify_interval, "MODIFY_INTERVAL", new_intervals},
    {report_properties, "REPORT_PROPERTIES", structures},
};
constexpr ReportKind reports[]{{structure_report, "STRUCTURE", defined},
                               {parameter_report, "HOUSEKEEPING", values},
                               {properties_report, "PROPERTIES", all_properties}};

}  // namespace st03

const ServiceKind HousekeepingService::service_kind{
    .type = service_type, .name = "housekeeping", .requests = st03::requests, .reports = st03::reports};

}  // namespace hirosco::pus
