// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco {
namespace {

/// The service loop's pace while a transition is under way or a cycle runs whose reports wake nobody, and otherwise. Messages wake
/// it at once.
constexpr Duration busy_pace = 1ms;
constexpr Duration idle_pace = 10ms;

/// Whoever made the descriptor: the framework's events are there.
[[nodiscard]] descriptor::SubsystemDescriptor with_framework_events(descriptor::SubsystemDescriptor subsystem) {
  descriptor::add_framework_events(subsystem);
  return subsystem;
}

}  // namespace

GenericSubsystem::GenericSubsystem(Subsystem& author, descriptor::SubsystemDescriptor descriptor,
                                   const Platform& platform, Channel& channel, VitalPage& vital,
                                   const PermitPage& permit)
    : author_{author},
      descriptor_{with_framework_events(std::move(descriptor))},
      platform_{platform},
      channel_{channel},
      vital_{vital},
      rings_{descriptor_.resources.queues},
      orders_{vital},
      reports_{descriptor_, platform_.clock, channel_, vital},
      resources_{descriptor_.resources},
      permit_{{platform_.memory, channel_, cycle_, orders_, loops_}, permit, platform_.clock.now()},
      values_{descriptor_, at_, orders_, cycle_},
      loop_meter_{descriptor_.service_loops},
      loops_{{descriptor_, *this, vital, permit, platform_.clock, values_, loop_meter_}},
      loop_parameters_{values_, loops_.home_of(20)},
      cycle_{{author, descriptor_, platform_.clock, values_.dictionary(), values_.writes(), rings_, vital, permit,
              platform_.realtime, platform_.precise, resources_, loop_meter_}},
      links_{{platform_, at_, cycle_, rings_, resources_, reports_}},
      descriptor_changes_{descriptor_, platform_, at_, values_, loops_},
      self_tests_{verification(), reports_, platform_.clock},
      function_service_{descriptor_.functions, pus::common_functions(), *this, verification()},
      parameter_service_{parameters_for_its_loop(), loops_.home_of(20).verification(), loops_.home_of(20).telemetry()},
      housekeeping_service_{descriptor_, loops_.home_of(3).verification(), loops_.home_of(3).telemetry()},
      descriptor_service_{verification(), descriptor_changes_},
      services_{&housekeeping_service_, &reports_.event_service(), &function_service_,
                &parameter_service_,    &links_.service(),         &descriptor_service_},
      requester_{descriptor_, channel_, platform_.clock.now()},
      subscriber_{descriptor_, channel_},
      foreign_{descriptor_, values_.foreign_home([this](std::uint16_t parameter) {
                 reports_.raise(descriptor::framework_event::foreign_unknown,
                                std::array{static_cast<double>(parameter)});
               })},
      ports_{descriptor_},
      introduction_{{author, descriptor_, *this, values_, cycle_, resources_, ports_, loops_, services_, requester_,
                     subscriber_, foreign_, descriptor_changes_.in_force()}},
      calls_{verification()},
      bumpless_{{descriptor_, platform_, at_, values_, cycle_, rings_, vital, permit_, loops_, housekeeping_service_,
                 self_tests_, reports_}},
      configurations_{{author, descriptor_, platform_, at_, values_, cycle_, rings_, orders_, vital, resources_, ports_,
                       links_, loops_, services_, housekeeping_service_, self_tests_, calls_, bumpless_, reports_}},
      states_{at_,
              {author, descriptor_, platform_, cycle_, rings_, orders_, vital, permit_, values_, introduction_, links_,
               configurations_, self_tests_, reports_, cycle_reports_}},
      cycle_reports_{{rings_, reports_, calls_, states_, links_, bumpless_, self_tests_}},
      incoming_{{author, descriptor_, channel_, at_, permit_, loops_, values_, services_, requester_, subscriber_,
                 reports_}} {
  for (const pus::ServiceKind* kind : pus::standard_services()) {
    if (kind->make == nullptr) continue;
    made_services_.push_back(kind->make(loops_.home_of(kind->type)));
    services_.add(*made_services_.back());
  }
  descriptor_changes_.tell();
  for (pus::Service* service : services_.all())
    if (OwnLoop* const loop = loops_.of(service->type())) loop->host(*service);
  author_.framework_ = this;
  cycle_.functions().resize(descriptor_.functions.size());
  vital_.realtime.store(platform_.realtime ? 1 : 0, std::memory_order_relaxed);
  if (const auto started = author_.offline(); !started) introduction_.mistake(started.error().text);
}

GenericSubsystem::~GenericSubsystem() {
  author_.framework_ = nullptr;
  author_.pools_left_ = resources_.leave_pools_behind(std::move(author_.pools_left_));
}

GenericSubsystem::Demand GenericSubsystem::cycle_demand() const noexcept {
  Demand demand{{orders_.order()}};
  if (!demand.wanted) return demand;
  // The cycle's own: it changes at a boundary between two cycles (adr 0096).
  const descriptor::Configuration& in_force = cycle_.in_force();
  demand.period = in_force.sampling;
  demand.priority = in_force.priority;
  return demand;
}

// --- the service loop --------------------------------------------------------------------------------------------------

/// Commissioning uses the heap, and so does each change of state or configuration: what is between them must not (adr 0103, 0220).
bool GenericSubsystem::commissioned() const noexcept {
  return (at_.state == State::SafeOperational || at_.state == State::Operational) && !at_.way && !bumpless_.under_way();
}

TimePoint GenericSubsystem::service_step(TimePoint now) {
  if (!commissioned()) return step_services(now);
  AllocationCount used;
  TimePoint next;
  {
    const RealtimeScope watched;
    next = step_services(now);
    used = watched.count();
  }
  if (!commissioned()) return next;
  used += loops_.take_heap_uses();
  if (!heap_watch_.account(used, now)) return next;
  const AllocationCount& sum = heap_watch_.sum();
  cycle_.note_service_heap(sum.allocations + sum.frees);
  reports_.raise(descriptor::framework_event::service_uses_heap,
                 std::array{static_cast<double>(sum.allocations), static_cast<double>(sum.frees)});
  return next;
}

TimePoint GenericSubsystem::step_services(TimePoint now) {
  known_stop_ = newest_stop();
  cycle_reports_.take();
  loops_.tell(reports_);
  // Set before the next request is looked at: whoever is told that ST[20] has done it in its loop may ask for more.
  values_.apply_at_rest();
  incoming_.receive();
  permit_.confirm();
  permit_.watch(now);
  states_.react_to_silence();
  states_.release_late();
  bumpless_.step(now);
  states_.advance(now);
  requester_.step(now);
  // As for what is asked: its own reports come first.
  if (reports_.empty()) subscriber_.step(now);
  foreign_.step(now, at_.state == State::SafeOperational || at_.state == State::Operational);
  author_.service(now);
  for (pus::Service* service : loops_.in_none(services_.all())) service->step(now);
  values_.apply_at_rest();
  reports_.flush();
  reports_.tell_losses(now, rings_, loops_.lost());
  look_at_resources(now);
  if (loops_.move(now, reports_)) vital_.service_steps.fetch_add(1, std::memory_order_relaxed);
  const bool looks = orders_.wanted() && !platform_.wakes;
  const bool busy = at_.way.has_value() || looks || !reports_.empty();
  return now + (busy ? busy_pace : std::clamp(author_.service_wake().pace, busy_pace, idle_pace));
}

/// An event once for each crossing of the level that the descriptor says.
void GenericSubsystem::look_at_resources(TimePoint now) {
  if (now < look_at_resources_at_) return;
  look_at_resources_at_ = now + ResourceMeter::look_every;
  if (platform_.usage)
    if (const auto usage = platform_.usage()) resources_.note(*usage, now);
  resources_.note_held();
  resources_.note_waiting(reports_.take_most_waiting());
  QueueFills queues = rings_.take_fills();
  const OwnLoop::Fills of_loops = loops_.take_fills();
  queues[place_of(descriptor::Resource::LoopRequests)] = of_loops.requests;
  queues[place_of(descriptor::Resource::LoopReports)] = of_loops.reports;
  queues[place_of(descriptor::Resource::Channel)] = reports_.take_channel_fill();
  QueueFills judged = queues;
  judged[place_of(descriptor::Resource::LoopRequests)] = of_loops.judged;
  if (!descriptor_.resources.channel_kb) judged[place_of(descriptor::Resource::Channel)] = {};
  resources_.note_queues(queues, judged);
  resources_.tell_crossings([this](const ResourceMeter::Crossing& found) {
    const std::array<double, 5> arguments{static_cast<double>(found.resource), static_cast<double>(found.block_octets),
                                          static_cast<double>(found.used), static_cast<double>(found.limit),
                                          static_cast<double>(found.times)};
    reports_.raise(descriptor::framework_event::resource_warning, arguments);
  });
}

/// A loop is never the writer of a parameter; the service loop is while the cycle rests.
pus::ParameterAccess& GenericSubsystem::parameters_for_its_loop() noexcept {
  if (loops_.of(pus::ParameterService::service_type) != nullptr) return loop_parameters_;
  return values_;
}

// --- functions ---------------------------------------------------------------------------------------------------------

std::expected<void, pus::FailureNotice> GenericSubsystem::submit(const pus::FunctionCall& call,
                                                                 const pus::Request& request) {
  const auto first = std::to_integer<std::uint8_t>(call.arguments.front());
  if (call.function == pus::set_state_function) return states_.command(static_cast<State>(first), request);
  if (call.function == pus::configure_function) return configurations_.command(first, request);
  const descriptor::Function& function = descriptor_.functions[call.function];
  if (!function.permitted_in(at_.state) || !orders_.wanted() || at_.way) return std::unexpected{at_.wrong_state()};
  if (!cycle_.functions()[call.function]) return std::unexpected{pus::FailureNotice{pus::FailureCode::ExecutionError}};
  CycleCommand command{.kind = CommandKind::Function, .index = call.function, .request = request};
  command.arguments = call.arguments;
  if (!calls_.have_room() || !rings_.command(command))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  calls_.handed_over();
  return {};
}

std::expected<void, pus::FailureNotice> GenericSubsystem::begin_self_test(const pus::Request& request) {
  if (at_.state != State::SafeOperational || at_.way) return std::unexpected{at_.wrong_state()};
  const auto refuse = [](pus::FailureCode code) { return std::unexpected{pus::FailureNotice{code}}; };
  // Of which configuration would it be told while another one is on its way to the cycle?
  if (self_tests_.running() || bumpless_.under_way()) return refuse(pus::FailureCode::Busy);
  if (!rings_.command({.kind = CommandKind::SelfTest, .request = request})) return refuse(pus::FailureCode::QueueFull);
  self_tests_.begun(request);
  return {};
}

// --- what the author says ----------------------------------------------------------------------------------------------

Result<> GenericSubsystem::submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop) {
  // Its own reports come first: telecommands that overtake them would keep them from ever being sent.
  if (!reports_.empty()) return fail(ErrorCode::ResourceExhausted, "reports wait for the supervisor");
  return channel_.send({.kind = MessageKind::GroundTelecommand, .epoch = known_stop, .link = client, .packet = packet});
}

Result<std::uint32_t> GenericSubsystem::send_request(const RequestPort& asked, pus::GivenValues values) {
  // As above: what is under way would never be heard to end.
  if (!reports_.empty()) return fail(ErrorCode::ResourceExhausted, "reports wait for the supervisor");
  return requester_.send(asked, values, platform_.clock.now(), known_stop_);
}

Result<> GenericSubsystem::raise(std::string_view event, Octets auxiliary) {
  reports_.raise_named(event, auxiliary);
  return ok();
}

}  // namespace hirosco
