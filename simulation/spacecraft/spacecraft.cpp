// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/spacecraft.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <new>

#include "hirosco/pus/requests.hpp"
#include "simulation/devices/device_arguments.hpp"
#include "simulation/spacecraft/member.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::uint16_t ground_source = 0;

/// Hands the records of the supervisor's log on to a database that somebody else keeps.
class BorrowedDatabase final : public supervisor::Database {
 public:
  explicit BorrowedDatabase(supervisor::Database& target) : target_{target} {}

 private:
  Result<> do_append(std::span<const supervisor::LogRecord> batch) override { return target_.append(batch); }
  Result<supervisor::LogPage> do_read(const supervisor::LogQuery& query) override { return target_.read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return target_.strategy(); }
  supervisor::Database& target_;
};

[[nodiscard]] std::uint16_t first_count(std::uint64_t seed) {
  constexpr std::uint64_t multiplier = 0x9E37'79B9'7F4A'7C15;
  return static_cast<std::uint16_t>((seed * multiplier) >> 50);
}

}  // namespace

Spacecraft::Spacecraft(const Parts& parts) : parts_{parts} {
  // Away from zero, so that spans before the start stay positive.
  clock_.set(TimePoint{1s});
  log_ = parts.make_log
             ? parts.make_log(clock_)
             : std::make_unique<supervisor::DirectPacketLog>(clock_, std::make_unique<BorrowedDatabase>(parts.log));
  if (parts.make_log_readings) log_readings_ = parts.make_log_readings(clock_);
  else if (!parts.make_log)
    log_readings_ = std::make_unique<supervisor::DirectLogReadings>(
        [&log = parts.log](const supervisor::LogQuery& query) { return log.read(query); });
  for (const auto& described : parts.mission.devices) {
    const auto make = parts.devices.find(described.executable);
    if (make == parts.devices.end()) continue;
    auto wanted = device_arguments(parts.mission, described);
    const auto told = [&](std::string_view why) {
      parts.observer.told(clock_.onboard(), "no simulated device " + described.name + ": " + std::string{why});
    };
    if (!wanted) {
      told(wanted.error());
      continue;
    }
    const auto world = whose_world(parts.mission, described);
    if (world && *world != nullptr) wanted->settings.in_world_of = device((*world)->name);
    if (!world || (*world != nullptr && wanted->settings.in_world_of == nullptr)) {
      told(world ? "its world is not there" : world.error());
      continue;
    }
    wanted->settings.seed = described.seed * 1000 + parts.seed;
    if (!parts.realtime) wanted->settings.enable_limit = enable_limit_reduced;
    auto made = make->second(flows_, wanted->address(), wanted->settings);
    if (const auto plugged = made->plug(); !plugged) {
      told(plugged.error().text);
      continue;
    }
    // Settings of a simulated device are lines of its fault script: <Setting name="hand" value="wander"/>.
    for (const auto& [name, value, at] : described.settings)
      if (const auto taken = name == world_setting ? ok() : made->fault(name + " " + value); !taken)
        parts.observer.told(clock_.onboard(), "simulated device " + described.name + " does not take '" + name + " " +
                                                  value + "': " + taken.error().text);
    for (const std::string& remark : made->remarks())
      parts.observer.told(clock_.onboard(), "simulated device " + described.name + ": " + remark);
    devices_.push_back({&described, std::move(made)});
  }
  if (parts.revives_after) {
    journal_memory_.resize(parts.journal_octets);
    journal_.emplace(journal_memory_);
    std::vector<FlowAddress> endnodes;
    for (auto& endnode : supervisor::kept_endnodes(parts.mission)) endnodes.push_back(std::move(endnode.address));
    bridge_.emplace(*kept_, flows_, std::move(endnodes));
  }
  make_supervisor(1);
  supervisor_->start();
}

void Spacecraft::make_supervisor(std::uint32_t first_epoch) {
  const Parts& parts = parts_;
  kept_->starts.fetch_add(1);
  stops_.emplace(*kept_);
  const Platform platform{.clock = clock_,
                          .memory = memory_,
                          .flows = flows_,
                          .realtime = parts.realtime,
                          .explain = {},
                          .links = local_link_mechanisms()};
  guard_.emplace(supervisor::Guard::Parts{.clock = clock_,
                                          .flows = flows_,
                                          .first_epoch = first_epoch,
                                          .notes = supervisor::InhibitNotes{parts.mission, *kept_},
                                          .on_finding = [this] {
                                            if (supervisor_wake_ != never) supervisor_wake_ = clock_.now();
                                          }});
  guard_wake_ = clock_.now();
  supervisor_ = std::make_unique<supervisor::Supervisor>(supervisor::Supervisor::Parts{
      .mission = parts.mission,
      .platform = platform,
      .launcher = *this,
      .guard = *guard_,
      .log = *log_,
      .open_database = parts.open_database ? parts.open_database : [](supervisor::DatabaseStrategy)
          -> std::unique_ptr<supervisor::Database> { return std::make_unique<supervisor::MemoryDatabase>(); },
      .observer = parts.observer,
      .first_sequence_count = first_count(parts.seed + kept_->starts.load() - 1),
      .journal = journal_ ? &*journal_ : nullptr,
      .values = parts.values != nullptr ? parts.values : &own_values_,
      .log_readings = log_readings_.get(),
      .readings = &readings_});
  supervisor_wake_ = clock_.now();
}

Result<supervisor::LaunchedSubsystem> Spacecraft::launch(const descriptor::MissionSubsystem& described) {
  const auto maker = parts_.subsystems.find(described.executable);
  if (maker == parts_.subsystems.end() || !maker->second.make)
    return fail(ErrorCode::NotFound, "no such subsystem in this program");
  const bool holds_ground_link = described.subsystem.name == parts_.mission.ground.subsystem;
  if (holds_ground_link && !maker->second.make_on_transport)
    return fail(ErrorCode::InvalidArgument, SubsystemMaker::no_ground_link);
  auto author = holds_ground_link ? maker->second.make_on_transport(ground_.transport()) : maker->second.make();
  const Platform platform{.clock = clock_,
                          .memory = memory_,
                          .flows = flows_,
                          .realtime = parts_.realtime,
                          .explain = [this](std::string_view text) { parts_.observer.told(clock_.onboard(), text); },
                          .links = local_link_mechanisms()};
  const Member* before = nullptr;
  for (const auto& earlier : members_)
    if (earlier->described->subsystem.id == described.subsystem.id) before = earlier.get();
  members_.push_back(std::make_unique<Member>(described, std::move(author), platform));
  Member& member = *members_.back();
  // Counts outlive the process (decision 8b).
  if (before != nullptr) member.vital->counters = before->vital->counters;
  member.service_wake = clock_.now();
  for (std::size_t i = 0; i < member.engine->own_loops(); ++i)
    member.loop_wakes.push_back(clock_.now() + member.engine->own_loop(i).period);
  supervisor::LaunchedSubsystem launched;
  launched.vital = mapping_of(member.vital);
  launched.permit = mapping_of(member.permit);
  launched.port =
      std::make_unique<supervisor::LocalMemberPort>(supervisor_end(member), launched.vital, launched.permit);
  launched.process = static_cast<std::uint32_t>(members_.size());
  launched.grip = std::make_shared<Grip>(*this, members_.size() - 1);
  return launched;
}

std::optional<supervisor::ProcessEnd> Spacecraft::ended(std::uint32_t process) { return members_[process - 1]->end; }

void Spacecraft::kill(std::uint32_t process) {
  Member& member = *members_[process - 1];
  if (member.end) return;
  constexpr int killed = 9;
  member.end = supervisor::ProcessEnd{true, killed};
  member.engine.reset();
  member.author.reset();  // with all that it holds, as the end of a process takes it
  member.channels.close_subsystem_end();
}

void Spacecraft::kill(std::string_view name) {
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (members_[i]->described->subsystem.name == name && !members_[i]->end) kill(static_cast<std::uint32_t>(i + 1));
}

void Spacecraft::stop(std::string_view name, bool stopped) {
  if (name == parts_.mission.supervisor.name) supervisor_wake_ = guard_wake_ = stopped ? never : clock_.now();
  else if (Member* member = find(name)) member->stopped = stopped;
}

void Spacecraft::spin(std::string_view name) {
  Member* member = find(name);
  if (member == nullptr) return;
  member->spinning = true;
  member->spins_since = clock_.now();
}

void Spacecraft::call_spin_off(std::string_view name) {
  if (Member* member = find(name); member != nullptr && !member->cycling) member->spinning = false;
}

void Spacecraft::stick(std::string_view name, bool stuck) {
  if (Member* member = find(name)) member->stuck = stuck;
}

bool Spacecraft::send_as(std::string_view name, Octets packet) {
  Member* member = find(name);
  if (member == nullptr) return false;
  const std::uint32_t known_stop = member->newest_permit().newest_stop.load(std::memory_order_acquire);
  return member->channels.subsystem_end().send({.epoch = known_stop, .packet = packet}).has_value();
}

void Spacecraft::strain(std::string_view name, int cycles, Duration takes) {
  Member* member = find(name);
  if (member == nullptr) return;
  member->strained_cycles = cycles;
  member->cycle_takes = takes;
}

// --- virtual time ------------------------------------------------------------------------------------------------------

void Spacecraft::run(Duration span) {
  const TimePoint end = clock_.now() + span;
  while (advance(end)) {}
}

bool Spacecraft::run_until(const std::function<bool()>& condition, Duration limit) {
  const TimePoint end = clock_.now() + limit;
  while (!condition())
    if (!advance(end)) return condition();
  return true;
}

/// Goes to the next thing that is due and does it. At one instant the order is fixed: devices, cycles, service loops, loops of
/// services of their own, guard, supervisor, each in mission order. False when nothing is left before `end`.
bool Spacecraft::advance(TimePoint end) {
  if (supervisor_ && supervisor_->finished()) return false;
  TimePoint next = std::min({supervisor_wake_, guard_wake_, revive_at_.value_or(never)});
  for (const Device& device : devices_) next = std::min(next, device.device->next_wake());
  for (const auto& member : members_) {
    if (!member->engine || member->stopped) continue;
    if (!member->stuck) next = std::min(next, member->service_wake);
    if (may_cycle(*member)) next = std::min(next, member->cycle_wake);
    for (const TimePoint wake : member->loop_wakes) next = std::min(next, wake);
  }
  if (next > end) {
    clock_.set(end);
    return false;
  }
  next = std::max(next, clock_.now());
  clock_.set(next);
  for (std::size_t i = 0; i < devices_.size(); ++i)
    if (devices_[i].device->next_wake() <= next) step_device(i);
  for (const auto& member : members_)
    if (may_cycle(*member) && member->cycle_wake <= next) step_cycle(*member);
  for (const auto& member : members_)
    if (member->engine && !member->stopped && !member->stuck && member->service_wake <= next) step_service(*member);
  for (const auto& member : members_)
    for (std::size_t i = 0; i < member->loop_wakes.size() && member->engine && !member->stopped; ++i)
      if (member->loop_wakes[i] <= next)
        member->loop_wakes[i] = member->engine->own_loop_step(i, member->loop_wakes[i]);
  if (revive_at_ && *revive_at_ <= next) revive_supervisor();
  if (guard_wake_ <= next && !guard_) {
    static_cast<void>(bridge_->step(next));
    guard_wake_ = next + supervisor::InhibitBridge::pace;
  } else if (guard_wake_ <= next) {
    guard_wake_ = guard_->step(next);
  }
  if (supervisor_wake_ <= next) step_supervisor();
  return true;
}

/// One that spins in a cycle has the processor of all cycles as long as it has real-time priority, and makes none.
bool Spacecraft::may_cycle(const Member& member) const noexcept {
  const auto spins = [](const auto& other) {
    return other->engine && !other->stopped && other->spinning && other->cycling && !other->realtime_taken;
  };
  return member.engine && !member.spinning && !member.stopped && std::ranges::none_of(members_, spins);
}

void Spacecraft::step_device(std::size_t device) { devices_[device].device->step(clock_.now()); }

void Spacecraft::step_cycle(Member& member) {
  const auto demand = member.engine->cycle_demand();
  if (!demand.wanted) {
    member.engine->cycle_parked(demand.ticket);
    member.cycling = false;
    member.cycle_wake = never;
    return;
  }
  if (member.strained_cycles > 0) {
    --member.strained_cycles;
    member.clock.begin(member.cycle_takes);
  }
  member.cycle_wake = member.engine->cycle_step(member.cycle_wake);
  member.clock.end();
  // The device answers the exchange at once: its status is there for the next cycle (decision 29).
  for (std::size_t i = 0; i < devices_.size(); ++i)
    if (devices_[i].described->subsystem == member.described->subsystem.name) step_device(i);
  if (watch_) watch_(member.described->subsystem.name, clock_.now());
  wake_who_waits();
}

/// Whose cycle starts with a sample is woken when its producer's cycle is over, by the word that wakes a process; in the order of
/// members, so that one seed stays one flight.
void Spacecraft::wake_who_waits() {
  for (const auto& member : members_) {
    if (!member->engine || !member->cycling) continue;
    const CycleWait wait = member->engine->cycle_wait();
    if (wait.arrived()) member->cycle_wake = std::min(member->cycle_wake, std::max(wait.earliest, clock_.now()));
  }
}

void Spacecraft::step_service(Member& member) {
  member.service_wake = member.engine->service_step(clock_.now());
  const auto demand = member.engine->cycle_demand();
  if (demand.wanted && !member.cycling) {
    member.cycling = true;
    member.cycle_wake = clock_.now() + demand.period;
  } else if (!demand.wanted && !member.cycling) {
    member.engine->cycle_parked(demand.ticket);
  }
  if (!member.engine->finished()) return;
  member.end = supervisor::ProcessEnd{};
  member.engine.reset();
  member.channels.close_subsystem_end();
}

// --- looking in --------------------------------------------------------------------------------------------------------

Spacecraft::Member* Spacecraft::find(std::string_view name) noexcept {
  const auto found = std::ranges::find_if(
      members_, [&](const auto& member) { return member->described->subsystem.name == name && !member->end; });
  return found != members_.end() ? found->get() : nullptr;
}
const Spacecraft::Member* Spacecraft::find(std::string_view name) const noexcept {
  return const_cast<Spacecraft*>(this)->find(name);
}

SimulatedDevice* Spacecraft::device(std::string_view name) noexcept {
  const auto found =
      std::ranges::find_if(devices_, [&](const Device& device) { return device.described->name == name; });
  return found != devices_.end() ? found->device.get() : nullptr;
}

const GenericSubsystem* Spacecraft::subsystem(std::string_view name) const noexcept {
  const Member* member = find(name);
  return member != nullptr && member->engine ? &*member->engine : nullptr;
}

const VitalPage* Spacecraft::vital(std::string_view name) const noexcept {
  const Member* member = find(name);
  return member != nullptr ? member->vital.get() : nullptr;
}

PermitPage* Spacecraft::permit(std::string_view name) noexcept {
  Member* member = find(name);
  return member != nullptr ? &member->newest_permit() : nullptr;
}

CommandOutcome Spacecraft::command(std::string_view subsystem, std::string_view name,
                                   const std::vector<Value>& arguments, Duration limit) {
  CommandOutcome outcome;
  const auto* target = parts_.mission.find_member(subsystem);
  if (target == nullptr) return outcome;
  const std::vector<descriptor::Function> requests = pus::requests_of(*target);
  const auto request = std::ranges::find(requests, name, &descriptor::Function::name);
  if (request == requests.end()) return outcome;
  const std::vector<std::optional<Value>> given(arguments.begin(), arguments.end());
  const auto data = pus::encode_request(*request, pus::GivenValues{given});
  if (!data) return outcome;
  static constexpr std::uint16_t modulo = 16'384;
  std::array<std::byte, max_packet_octets> buffer;
  sequence_ = static_cast<std::uint16_t>((sequence_ + 1) % modulo);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = target->id,
                                              .sequence_count = sequence_,
                                              .ack = pus::ack_all,
                                              .service = request->service,
                                              .subtype = request->subtype,
                                              .source = ground_source},
                                             *data);
  if (!packet) return outcome;
  const std::uint32_t id = pus::read_primary_header(*packet)->request_id;
  ground_.on_telemetry([&](Octets octets) {
    const auto report = pus::TelemetryView::parse(octets);
    if (!report || report->service() != 1) return;
    OctetReader reader{report->source_data()};
    if (reader.get<std::uint32_t>() != id) return;
    switch (report->subtype()) {
      case 1: outcome.accepted = true; return;
      case 3: outcome.started = true; return;
      case 5: ++outcome.progress_reports; return;
      case 7: outcome.completed = true; return;
      default: break;
    }
    if (report->subtype() == 6) static_cast<void>(reader.get<std::uint16_t>());
    outcome.failure = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
    outcome.failure_subtype = report->subtype();
  });
  ground_.send(*packet);
  static_cast<void>(run_until([&] { return outcome.completed || outcome.failure.has_value(); }, limit));
  ground_.on_telemetry({});
  return outcome;
}

}  // namespace hirosco::simulation
