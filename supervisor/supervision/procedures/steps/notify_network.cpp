// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/notify_network.hpp"

#include <vector>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"

namespace hirosco::supervisor::steps::notice {

void give(const ProcedureStep& step, const Means& means, const CommandDone& done) {
  Craft& craft = means.craft;
  const std::string& name = step.words.front();
  std::string told;
  for (const std::uint16_t apid : means.links.network_of(step.subject)) {
    const Member* member = craft.member(apid);
    if (apid == step.subject || member == nullptr || !member->alive()) continue;
    const auto* function = member->descriptor().find_function(name);
    if (function == nullptr || !descriptor::is_notice(*function)) continue;
    std::vector<double> arguments;
    if (!function->arguments.empty()) arguments.push_back(step.subject);
    const auto data = pus::encode_call(*function, std::span<const double>{arguments});
    if (!data) continue;
    told += (told.empty() ? "" : ", ") + craft.name_of(apid);
    means.desk.send(apid, pus::FunctionService::service_type, 1, *data, {}, nullptr, Duration{0});
  }
  craft.tell("plan " + step.occasion.plan + ": " + name + " to " + (told.empty() ? "nobody" : told) + " because of " +
                 step.occasion.event + " of " + craft.name_of(step.subject),
             step.subject);
  done(true, {});
}

}  // namespace hirosco::supervisor::steps::notice
