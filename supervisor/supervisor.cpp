// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervisor.hpp"

#include <algorithm>
#include <cstring>

#include "hirosco/pus/st08_function.hpp"

/// Construction, life and stepping of the supervisor. Data handling is in data_handling.cpp, reactions in reactions.cpp.
namespace hirosco::supervisor {
namespace {

/// How often processes, hangs and time limits are looked at: the supervisor's own cycle (decision 32).
constexpr Duration watch_period = Guard::observation_period;
constexpr Duration shutdown_limit = 5s;
constexpr int messages_per_step = 256;
/// Fewer than its own engine and a subsystem work off in one step, with all their reports.
constexpr int ground_messages_per_step = 32;
constexpr Duration ground_pace = 1ms;
constexpr Duration loss_period = 1s;

}  // namespace

Supervisor::Supervisor(const Parts& parts)
    : parts_{parts},
      mission_{parts.mission},
      mode_{mission_.find_mode(mission_.initial_mode)},
      own_vital_{std::make_unique<VitalPage>()},
      own_permit_{std::make_unique<PermitPage>()},
      engine_{*this, mission_.supervisor, parts.world, own_channels_.subsystem_end(), *own_vital_, *own_permit_},
      links_{mission_, parts.world.memory, *this},
      sequence_{*this},
      ground_link_{*this},
      power_{mission_.power_budget_w},
      describer_{mission_},
      next_sequence_count_{parts.first_sequence_count} {
  members_.reserve(mission_.subsystems.size());
  for (const auto& described : mission_.subsystems) members_.emplace_back(described);
}

Supervisor::~Supervisor() = default;

Result<Step> Supervisor::software_init() {
  publish("MODE", mode_parameter_);
  publish("LINKS", links_parameter_);
  publish("REJECTIONS", rejections_parameter_);
  publish("COUNTS", counts_parameter_);
  publish("SUBSYSTEMS", subsystems_parameter_);
  publish("LINK_STATUS", link_status_parameter_);
  publish("POWER", power_parameter_);
  on_function("SET_MODE", [this](double mode) -> Outcome {
    const auto found = std::ranges::find(mission_.modes, static_cast<std::uint8_t>(mode), &descriptor::Mode::id);
    if (found == mission_.modes.end()) return refused(pus::FailureCode::UnknownIdentifier);
    // A mode whose members are dead is not that mode, whatever it is called (findings SF15).
    const auto lives = [&](const descriptor::CommissionStep& step) {
      const auto subject = std::ranges::find(members_, step.subsystem,
                                             [](const Member& m) -> const std::string& { return m.descriptor().name; });
      return subject != members_.end() && subject->alive();
    };
    if (!std::ranges::all_of(found->commission, lives)) return refused(pus::FailureCode::WrongStatus);
    set_mode(*found);
    return ok();
  });
  on_function("LINK", [this](double link, Call call) -> Outcome {
    const bool begun = links_.establish(static_cast<std::uint8_t>(link), now_, [this, call](bool success) {
      if (success) finish(call);
      else abort(call, pus::FailureCode::ExecutionError);
    });
    return begun ? running : refused(pus::FailureCode::WrongStatus);
  });
  on_function("UNLINK", [this](double link, Call call) -> Outcome {
    const bool begun = links_.release(static_cast<std::uint8_t>(link), [this, call](bool success) {
      if (success) finish(call);
      else abort(call, pus::FailureCode::Timeout);
    });
    return begun ? running : refused(pus::FailureCode::WrongStatus);
  });
  on_function("SET_DATABASE", [this](double strategy) -> Outcome {
    auto database = parts_.open_database(static_cast<DatabaseStrategy>(strategy));
    if (!database) return refused(pus::FailureCode::ExecutionError);
    tell("log switched to " + std::string{database->strategy()});
    parts_.log.switch_to(std::move(database));
    return ok();
  });
  on_function("SET_POWER_BUDGET", [this](double budget_w) -> Outcome {
    set_power_budget(budget_w);
    return ok();
  });
  // Carried out where they are received (carry_out_at_once): no cycle of the supervisor is in the way of these two.
  on_function("SAFE_ALL", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });
  on_function("SHUTDOWN", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });
  return done;
}

void Supervisor::start() {
  now_ = parts_.world.clock.now();
  own_permit_->release();
  own_permit_->mode_epoch.store(mode_epoch_);
  own_permit_->heartbeat.store(1);
  parts_.guard.beat();
  for (Member& member : members_) {
    const std::string& name = member.descriptor().name;
    if (const auto guarded = parts_.guard.add(member.described(), name == mission_.ground.subsystem); !guarded) {
      tell("cannot hold the second inhibit of " + name + "'s devices: " + guarded.error().text, member.apid());
      failed_ = true;
    }
    launch(member);
    for (const auto device : descriptor::actuators_without_enable(member.descriptor()))
      tell(name + "'s " + std::string{device} + " has no second inhibit: that it has stopped is known from " + name +
               " only",
           member.apid());
    for (const auto& changed : member.described().overrides)
      tell(name + " begins with " + to_string(changed), member.apid());
  }
  // Itself first: the functions of the others' commissioning are its own.
  const auto own = std::string{"SUPERVISOR"};
  const double configuration = mission_.supervisor.configurations.front().id;
  const auto state = [](State target) { return static_cast<double>(target); };
  sequence_.start({{{1, own, "SET_STATE", state(State::PreOperational), "PreOperational"}},
                   {{1, own, "CONFIGURE", configuration, "configuration"}},
                   {{1, own, "SET_STATE", state(State::SafeOperational), "SafeOperational"}},
                   {{1, own, "SET_STATE", state(State::Operational), "Operational"}}},
                  Sequence::OnFailure::Stop, [this](bool success, const std::string& why) {
                    if (success) return begin_commissioning();
                    tell("supervisor cannot start: " + why, 1);
                    failed_ = true;
                    request_shutdown();
                  });
}

void Supervisor::launch(Member& member) {
  auto launched = parts_.launcher.launch(member.described());
  if (!launched) {
    tell("cannot start " + member.descriptor().name + ": " + launched.error().text, member.apid());
    failed_ = true;
    return;
  }
  parts_.guard.adopt(member.apid(), *launched);
  member.started(std::move(*launched));
  member.permit()->mode_epoch.store(mode_epoch_, std::memory_order_release);
  tell("started " + member.descriptor().name, member.apid());
}

void Supervisor::begin_commissioning() {
  const descriptor::Mode* start_mode = mission_.find_mode(mission_.start_mode);
  if (start_mode == nullptr) {
    commissioned_ = true;
    return;
  }
  const auto state = [](State target) { return static_cast<double>(target); };
  Sequence::Stage pre, configure, link, safe, operational;
  for (const auto& step : start_mode->commission) {
    const auto& subsystem = mission_.find_subsystem(step.subsystem)->subsystem;
    const auto* configuration = subsystem.find_configuration(step.configuration);
    const auto add = [&](Sequence::Stage& stage, std::string_view function, double argument, std::string text) {
      stage.push_back({subsystem.id, subsystem.name, std::string{function}, argument, std::move(text)});
    };
    add(pre, "SET_STATE", state(State::PreOperational), "PreOperational");
    add(configure, "CONFIGURE", configuration->id, "configuration " + configuration->name);
    if (step.state == State::PreOperational) continue;
    add(safe, "SET_STATE", state(State::SafeOperational), "SafeOperational");
    if (step.state == State::Operational) add(operational, "SET_STATE", state(State::Operational), "Operational");
  }
  for (const std::uint8_t id : start_mode->establish)
    link.push_back({1, "SUPERVISOR", "LINK", id, "link " + std::to_string(id)});
  Sequence::Stage mode{{1, "SUPERVISOR", "SET_MODE", start_mode->id, "mode " + start_mode->name}};
  sequence_.start({pre, configure, link, safe, operational, mode}, Sequence::OnFailure::Stop,
                  [this](bool success, const std::string& why) {
                    std::string missing = why;
                    // A plan may have taken one down after its own step was done (findings LW2).
                    for (const auto& step : mission_.find_mode(mission_.start_mode)->commission) {
                      const Member* subject = member(mission_.find_subsystem(step.subsystem)->subsystem.id);
                      if (missing.empty() && (subject == nullptr || subject->state() != step.state))
                        missing = step.subsystem + " is not " + std::string{to_text(step.state)};
                    }
                    commissioned_ = success && missing.empty();
                    if (commissioned_) return tell("commissioned: mode " + mode_->name);
                    tell("commissioning stopped: " + missing);
                    failed_ = true;
                  });
}

void Supervisor::keeper_stands_still() {
  tell("the keeper stands still: nobody would end the devices and subsystems if this supervisor died", 1);
  engine_.announce("KEEPER_STILL");
}

void Supervisor::request_shutdown() {
  if (shutting_down_) return;
  shutting_down_ = true;
  shutdown_deadline_ = now_ + shutdown_limit;
  tell("shutdown");
  begin_shutdown();
}

void Supervisor::begin_shutdown() {
  Sequence::Stage safe, offline;
  for (Member& member : members_) {
    const auto state = member.state();
    if (!member.alive() || !state || *state == State::Offline) continue;
    const auto add = [&](Sequence::Stage& stage, State target) {
      stage.push_back({member.apid(), member.descriptor().name, "SET_STATE", static_cast<double>(target),
                       std::string{to_text(target)}});
    };
    if (*state == State::Operational) add(safe, State::SafeOperational);
    // The ground link goes last, so that the ground sees the others go.
    if (member.descriptor().name != mission_.ground.subsystem) add(offline, State::Offline);
  }
  Sequence::Stage ground;
  for (Member& member : members_)
    if (member.alive() && member.descriptor().name == mission_.ground.subsystem)
      ground.push_back(
          {member.apid(), member.descriptor().name, "SET_STATE", static_cast<double>(State::Offline), "Offline"});
  sequence_.start({safe, offline, ground}, Sequence::OnFailure::GoOn, [this](bool success, const std::string& why) {
    if (!success) tell("shutdown: " + why);
    for (Member& member : members_) member.died();  // closing the channel ends the process
    finished_ = true;
  });
}

TimePoint Supervisor::step(TimePoint now) {
  now_ = now;
  parts_.guard.beat();
  take_guard_findings();
  const std::uint64_t beat = own_permit_->heartbeat.load(std::memory_order_relaxed) + 1;
  own_permit_->heartbeat.store(beat, std::memory_order_release);
  for (Member& member : members_)
    if (PermitPage* page = member.permit()) page->heartbeat.store(beat, std::memory_order_release);

  for (Member& member : members_) receive_from(member);
  serve_ground_route();
  watch_ends(false);
  follow_stops();
  forward_durable();
  // Its own engine: the same two steps as everybody's, here in one thread.
  TimePoint wake = engine_.service_step(now);
  const auto demand = engine_.cycle_demand();
  if (demand.wanted && !own_cycle_running_) next_cycle_ = now;
  own_cycle_running_ = demand.wanted;
  if (!demand.wanted) engine_.cycle_parked(demand.ticket);
  if (demand.wanted && now >= next_cycle_) next_cycle_ = engine_.cycle_step(next_cycle_);
  receive_from_self();

  if (now >= next_watch_) {
    next_watch_ = now + watch_period;
    watch_ends(true);
    restart_due(now);
    watch_ground_link(now);
    watch_memory();
    observe_power();
    shed_load();
    links_.step(now);
    watch_log(now);
    expire_requests(now);
  }
  if (shutting_down_ && !finished_ && now > shutdown_deadline_) {
    tell("shutdown: time limit, ending what is left");
    for (Member& member : members_)
      if (member.alive()) parts_.launcher.kill(member.process());
    for (Member& member : members_) member.died();
    sequence_.cancel();
    failed_ = true;
    finished_ = true;
  }
  if (demand.wanted) wake = std::min(wake, next_cycle_);
  if (ground_route_.waiting()) wake = std::min(wake, now + ground_pace);
  return std::min(wake, next_watch_);
}

void Supervisor::receive_from(Member& member) {
  MessageBuffer buffer;
  const bool ground_link = is_ground_link(member);
  for (int left = ground_link ? ground_messages_per_step : messages_per_step; left > 0 && member.alive(); --left) {
    if (!reads(member)) return;
    auto found = member.channel()->receive(buffer);
    if (!found && found.error().code != ErrorCode::Unavailable) {
      // Damage is no loss: it is counted and told, and what follows is read.
      ++member.unreadable;
      continue;
    }
    if (!found && !member.closed_at) {
      // Whoever can be neither commanded nor heard moves nothing any more.
      member.closed_at = now_;
      parts_.guard.fence(member.apid());
    }
    if (!found || found->flow == Flow::None) return;
    const Message& message = found->message;
    if (message.kind == MessageKind::Event) {
      receive_from_self();
      handle_event(member.apid(), message.packet);
      continue;
    }
    const auto header = pus::read_primary_header(message.packet);
    // Only the ground link brings what ground sent.
    const bool from_ground = message.kind == MessageKind::GroundTelecommand;
    if (!header || (from_ground && (!ground_link || !header->telecommand))) {
      ++member.unreadable;
      continue;
    }
    if (!header->telecommand) {
      // Before an answer, what was said before it: the copy of the telecommand that it answers.
      receive_from_self();
      handle_telemetry(member.apid(), message.packet);
    } else if (from_ground) {
      handle_telecommand({.packet = message.packet, .sender = Sender::Ground, .source = 0, .memory = {}});
      receive_from_self();  // what it said about that: its own backlog must not overflow in a flood
    } else {
      handle_telecommand(
          {.packet = message.packet, .sender = Sender::Subsystem, .source = member.apid(), .memory = {}});
    }
  }
}

void Supervisor::receive_from_self() {
  MessageBuffer buffer;
  for (int left = messages_per_step; left > 0; --left) {
    auto found = own_channels_.supervisor_end().receive(buffer);
    if (!found || found->flow == Flow::None) return;
    if (found->message.kind == MessageKind::Event) handle_event(1, found->message.packet);
    else handle_telemetry(1, found->message.packet);
  }
}

bool Supervisor::is_ground_link(const Member& member) const {
  return member.descriptor().name == mission_.ground.subsystem;
}

/// What waits for the ground link goes on as soon as that takes it; what it could not take is told once a second.
void Supervisor::serve_ground_route() {
  for (Member& member : members_) {
    if (!is_ground_link(member)) continue;
    if (member.alive() && member.state() != State::Offline) ground_route_.flush(*member.channel(), now_);
    else ground_route_.clear();
  }
  const GroundRoute::Lost lost = ground_route_.lost();
  if (lost == ground_lost_told_ || now_ < next_loss_told_) return;
  counts_.housekeeping_lost = lost.housekeeping;
  counts_.reports_lost = lost.reports;
  engine_.announce("TELEMETRY_LOST", {static_cast<double>(lost.housekeeping - ground_lost_told_.housekeeping),
                                      static_cast<double>(lost.reports - ground_lost_told_.reports)});
  ground_lost_told_ = lost;
  next_loss_told_ = now_ + loss_period;
}

Channel* Supervisor::channel_of(std::uint16_t apid) {
  if (apid == 1) return &own_channels_.supervisor_end();
  Member* found = member(apid);
  return found != nullptr ? found->channel() : nullptr;
}

Member* Supervisor::member(std::uint16_t apid) {
  const auto found = std::ranges::find(members_, apid, &Member::apid);
  return found != members_.end() ? &*found : nullptr;
}

std::string Supervisor::name_of(std::uint16_t apid) const {
  if (apid == 1) return mission_.supervisor.name;
  const auto* found = mission_.find_subsystem(apid);
  return found != nullptr ? found->subsystem.name : "APID " + std::to_string(apid);
}

void Supervisor::tell(std::string_view line, std::uint16_t subject) {
  static_cast<void>(
      parts_.log.append({.kind = LogKind::Action, .source = 1, .peer = subject, .packet = {}, .note = line}));
  parts_.observer.told(parts_.world.clock.onboard(), line);
}

void Supervisor::set_mode(const descriptor::Mode& mode) {
  mode_ = &mode;
  ++mode_epoch_;
  own_permit_->mode_epoch.store(mode_epoch_, std::memory_order_release);
  for (Member& member : members_)
    if (PermitPage* page = member.permit()) page->mode_epoch.store(mode_epoch_, std::memory_order_release);
  tell("mode " + mode.name, 1);
}

}  // namespace hirosco::supervisor
