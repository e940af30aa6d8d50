// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/configurations.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/frame_protocol.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"

namespace hirosco {
namespace {

[[nodiscard]] Failure mismatch(std::string text) { return {ErrorCode::Mismatch, std::move(text)}; }

[[nodiscard]] Failure failure_of(const std::string& whose, const Error& error) {
  return {error.code, whose + error.text, error.value};
}

}  // namespace

std::expected<void, pus::FailureNotice> Configurations::command(std::uint8_t id, const pus::Request& request) {
  if (parts_.at.way) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  const descriptor::Configuration* wanted = parts_.descriptor.find_configuration(id);
  const bool acts = parts_.at.state == State::SafeOperational || parts_.at.state == State::Operational;
  if (acts && wanted != nullptr && parts_.at.configuration != nullptr &&
      parts_.descriptor.bumpless_between(parts_.at.configuration->id, id) != nullptr)
    return parts_.bumpless.command(*wanted, request);
  if (parts_.at.state != State::PreOperational) return std::unexpected{parts_.at.wrong_state()};
  const auto refuse = [&](pus::FailureCode code) {
    return std::unexpected{pus::FailureNotice{code}.with(std::uint8_t{0}).with(std::uint32_t{id})};
  };
  if (wanted == nullptr) return refuse(pus::FailureCode::UnknownIdentifier);
  // Another configuration goes by way of Post-Operational: devices and links are given back there.
  if (parts_.at.configuration != nullptr && parts_.at.configuration != wanted)
    return refuse(pus::FailureCode::WrongStatus);
  parts_.reports.verification().started(request);
  if (parts_.at.configuration == wanted) {
    parts_.reports.verification().completed(request);
    return {};
  }
  if (const auto problem = apply(*wanted)) {
    if (parts_.platform.explain)
      parts_.platform.explain(parts_.descriptor.name + ": CONFIGURE " + wanted->name + " failed: " + problem->text);
    release();
    parts_.reports.raise_failure(descriptor::framework_event::configuration_failed, id, *problem);
    parts_.reports.verification().completion_failed(
        request,
        pus::FailureNotice{pus::FailureCode::ExecutionError}.because({problem->code, problem->number, problem->text}));
    return {};
  }
  parts_.reports.verification().completed(request);
  return {};
}

/// The preferred endnode and its fall-backs. One that cannot be opened is passed over and told; if none can, the error is the
/// first one's.
Result<std::vector<DeviceSlot::Way>> Configurations::open_ways(const descriptor::DeviceUse& use,
                                                               const DevicePortBase& port) {
  std::vector<DeviceSlot::Way> ways;
  std::optional<Error> first;
  const auto open = [&](const descriptor::Endnode& endnode, std::size_t at) {
    Result<Quota::Held> held = Quota::Held{};
    const FlowMeans* means = find_flow_means(endnode.transfer);
    if (means != nullptr && means->form == AddressForm::HostPort) held = parts_.resources.ports().take();
    auto flow =
        held ? parts_.platform.flows.open({endnode.transfer, endnode.address, endnode.framing}, FlowSide::Subsystem)
             : Result<std::unique_ptr<DataFlow>>{std::unexpected{held.error()}};
    if (flow && endnode.framing == Framing::Raw) flow = make_raw_flow(std::move(*flow), *port.protocol());
    if (flow) return ways.push_back({std::move(*flow), static_cast<std::uint8_t>(at), std::move(*held)});
    if (!first) first = flow.error();
    const std::array arguments{static_cast<double>(descriptor::DeviceLoss::NotOpened), static_cast<double>(at),
                               static_cast<double>(ways.empty() ? at + 1 : ways.front().endnode), 0.0};
    if (!use.fall_backs.empty()) parts_.reports.raise(descriptor::framework_event::fell_back(use.device), arguments);
  };
  open(use.endnode, 0);
  for (std::size_t i = 0; i < use.fall_backs.size(); ++i) open(use.fall_backs[i], i + 1);
  if (ways.empty()) return std::unexpected{*first};
  return ways;
}

std::optional<Failure> Configurations::apply(const descriptor::Configuration& configuration) {
  parts_.at.configuration = &configuration;
  for (const auto& initial : configuration.initial) {
    const int member = initial.parameter.member ? static_cast<int>(*initial.parameter.member) : -1;
    if (!parts_.values.dictionary().set(initial.parameter.parameter, member, initial.values))
      return mismatch("initial value of " + initial.parameter.text);
  }
  // Software-Init has compared those of all configurations; since then an author may have named another port.
  if (const auto mistakes = parts_.ports.mistakes(configuration); !mistakes.empty())
    return mismatch(mistakes.front().text);
  CyclePlan plan;
  plan.configuration = &configuration;
  plan_links(configuration, plan);
  if (auto problem = plan_devices(configuration, plan)) return problem;
  {
    const LoopsAtRest at_rest{parts_.loops.all()};
    parts_.loops.follow(&configuration);
    for (pus::Service* service : parts_.services.all())
      if (parts_.descriptor.offers(service->type(), &configuration))
        if (const auto set_up = service->configure(configuration); !set_up) return failure_of("", set_up.error());
  }
  plan.sampler = parts_.housekeeping.sampler();
  if (const auto configured = parts_.author.configure(configuration); !configured)
    return failure_of("", configured.error());
  parts_.self_tests.applied(configuration.id);
  parts_.cycle.prepare(std::move(plan));
  parts_.vital.configuration.store(configuration.id, std::memory_order_relaxed);
  parts_.vital.period_ns.store(static_cast<std::uint64_t>(configuration.sampling.count()), std::memory_order_relaxed);
  parts_.orders.want();
  return std::nullopt;
}

/// With the ports that this configuration wants, as for its devices: apply() has compared them.
void Configurations::plan_links(const descriptor::Configuration& configuration, CyclePlan& plan) {
  const auto sets = descriptor::required_sets(parts_.descriptor);
  for (const auto& wanted : configuration.requires_) {
    plan.inputs.emplace_back(wanted, parts_.ports.link(wanted.name), parts_.platform.realtime);
    const auto set = std::ranges::find(sets, wanted.name) - sets.begin();
    plan.input_stale_events.push_back(descriptor::framework_event::set_stale(static_cast<std::size_t>(set)));
  }
  for (const auto& provided : configuration.provides) {
    LoanOutputPort* const port = provided.terms.lent() ? parts_.ports.lent(provided.name) : nullptr;
    plan.outputs.emplace_back(parts_.descriptor, provided, parts_.values.dictionary(), port);
  }
}

std::optional<Failure> Configurations::plan_devices(const descriptor::Configuration& configuration, CyclePlan& plan) {
  for (const auto& use : configuration.devices) {
    const descriptor::Device& device = parts_.descriptor.devices[use.device];
    DevicePortBase& port = *parts_.ports.device(device.name);
    auto ways = open_ways(use, port);
    if (!ways) return failure_of("device " + device.name + ": ", ways.error());
    plan.devices.emplace_back(device, use, port, std::move(*ways), configuration.sampling, parts_.platform.realtime);
    plan.device_lost_events.push_back(descriptor::framework_event::device_lost(use.device));
    plan.fell_back_events.push_back(descriptor::framework_event::fell_back(use.device));
  }
  return std::nullopt;
}

void Configurations::end() {
  parts_.links.end();
  parts_.calls.abort_all();
  parts_.self_tests.abandon();
  parts_.bumpless.give_up(pus::FailureCode::Aborted);
}

void Configurations::release() {
  end();
  parts_.links.release();
  CycleCommand forgotten;
  while (parts_.rings.commands.try_pop(forgotten)) {
    // A function that never reached the cycle still ends: nothing accepted is lost.
    if (forgotten.kind == CommandKind::Function)
      parts_.calls.refused(forgotten.request, pus::FailureNotice{pus::FailureCode::Aborted});
  }
  parts_.calls.forget_handed_over();
  parts_.values.apply();
  parts_.bumpless.release();
  parts_.cycle.release();
  {
    const LoopsAtRest at_rest{parts_.loops.all()};
    parts_.loops.follow(nullptr);
    for (pus::Service* service : parts_.services.all()) service->release();
  }
  parts_.at.configuration = nullptr;
  parts_.vital.configuration.store(0, std::memory_order_relaxed);
  parts_.vital.inhibited.store(0, std::memory_order_relaxed);
}

}  // namespace hirosco
