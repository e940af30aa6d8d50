// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guarded_member.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// From the order to stop until the last answer of a device that has nothing to wind down: its own cycle, an enable
/// command, and a busy computer.
constexpr Duration answer_limit = std::chrono::milliseconds{250};
/// A slow cycle stands still between its steps: so many of its own periods are granted to whatever it has to do.
constexpr int slow_steps = 3;

/// Damage of the page neither lowers an epoch, so that devices would not hear of it, nor uses up those that are left.
void restore_epoch(PermitPage& page, std::uint32_t epoch) noexcept {
  if (page.epoch.load(std::memory_order_relaxed) == epoch) return;
  page.go.store(0, std::memory_order_release);
  page.epoch.store(epoch, std::memory_order_release);
}

}  // namespace

// --- one device --------------------------------------------------------------------------------------------------------

bool WatchedDevice::knows() const noexcept {
  return heard && static_cast<std::int32_t>(last.sequence - fenced_at_sequence) > 0;
}

bool WatchedDevice::rests() const noexcept {
  return knows() && (last.output == DeviceOutput::Off || last.output == DeviceOutput::Holding);
}

std::string_view WatchedDevice::rests_otherwise() const noexcept {
  if (!acts || !rests()) return {};
  using descriptor::StopKind;
  const bool holds = last.output == DeviceOutput::Holding;
  // What comes to rest by a controlled stop may hold then, or not.
  if (stop == StopKind::Hold && !holds) return "it is off, and its descriptor declares that it holds";
  if (stop == StopKind::Drop && holds) return "it holds, and its descriptor declares that it lets go";
  return {};
}

void WatchedDevice::hear(TimePoint now) noexcept {
  for (std::size_t i = 0; i < ways.size(); ++i) hear_by(ways[i], i == way, now);
}

void WatchedDevice::hear_by(InhibitWay& by, bool in_use, TimePoint now) noexcept {
  std::array<std::byte, enable_frame_octets> frame;
  const auto received = by.flow->receive(frame);
  if (!received || received->flow != Flow::New) return;
  const auto status = read_enable_status(Octets{frame}.first(std::min(received->octets, frame.size())));
  if (in_use) other_version = !status && status.error().code == ErrorCode::Mismatch;
  if (!status) return;
  if (std::exchange(by.answered, status->sequence) != status->sequence) {
    by.heard_at = now;
    if (in_use) silence_told = false;
  }
  // It has one inhibit: what it said to a later command counts, by whichever way that went. One that has one way may begin to count anew.
  const bool newer = static_cast<std::int32_t>(status->sequence - last.sequence) >= 0;
  if (heard && ways.size() > 1 && !newer) return;
  last = *status;
  heard = true;
  acts = acts || last.output == DeviceOutput::Active;
}

bool WatchedDevice::falls_silent(TimePoint since, TimePoint now) noexcept {
  if (silence_told || !unconfirmed(since, inhibit_silence, now)) return false;
  silence_told = true;
  return true;
}

bool WatchedDevice::unconfirmed(TimePoint since, Duration limit, TimePoint now) const noexcept {
  const TimePoint heard_at = ways.empty() ? TimePoint{} : ways[way].heard_at;
  return limit > Duration{} && now - std::max({since, taken_at, heard_at}) >= limit;
}

bool WatchedDevice::fall_back(TimePoint now) noexcept {
  if (way + 1 >= ways.size()) return false;
  ++way;
  taken_at = now;
  return true;
}

bool WatchedDevice::choose_way(Duration limit, TimePoint now) noexcept {
  if (limit <= Duration{}) return false;
  const auto answers = [&](const InhibitWay& each) { return now - each.heard_at < limit; };
  const auto first = std::ranges::find_if(ways, answers);
  const std::size_t chosen = first != ways.end() ? static_cast<std::size_t>(first - ways.begin()) : 0;
  if (chosen == std::exchange(way, chosen)) return false;
  taken_at = now;
  return way != 0;
}

void WatchedDevice::tell(bool enabled, std::uint32_t epoch) noexcept {
  std::array<std::byte, enable_frame_octets> frame;
  const auto written = write_enable_command(
      frame, {.enabled = static_cast<std::uint8_t>(enabled ? 1 : 0), .epoch = epoch, .sequence = ++sequence});
  for (std::size_t i = 0; i < ways.size(); ++i) {
    // A stop goes by each; a permission by one, so that none gives what another one has taken.
    const bool told = !enabled || i == way;
    if (ways[i].note != nullptr && told) ways[i].note->note(enabled, epoch, sequence);
    if (ways[i].note != nullptr && !told) ways[i].note->note_untold(epoch, sequence);
    // A device that does not hear it stops by itself: that is what it waits for.
    if (told && written) static_cast<void>(ways[i].flow->send(*written));
  }
}

void WatchedDevice::withdraw_notes() noexcept {
  for (const InhibitWay& each : ways)
    if (each.note != nullptr) each.note->withdraw();
}

// --- what a member's pages say -----------------------------------------------------------------------------------------

std::optional<State> GuardedMember::state() const noexcept {
  if (vital == nullptr) return std::nullopt;
  const std::uint32_t number = vital->state.load(std::memory_order_acquire);
  if (number > static_cast<std::uint32_t>(State::SoftwareDeinit)) return std::nullopt;
  return static_cast<State>(number);
}

bool GuardedMember::damaged() const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  // What it demands and how often it cycles follows from its configuration: one that nobody declared is none.
  const std::uint32_t id = vital->configuration.load(relaxed);
  const auto declared = [&](const descriptor::Configuration& configuration) { return configuration.id == id; };
  const bool known = id == 0 || std::ranges::any_of(described->subsystem.configurations, declared);
  // Nobody but the guard writes what gates: where it finds something else than it wrote, that page is believed no more.
  const std::uint64_t go = permit->go.load(relaxed);
  const bool gate = permit->magic == page_magic && permit->version == page_version &&
                    permit->epoch.load(relaxed) == epoch && (go == 0 || (released && go == permission_word(epoch)));
  return vital->magic != page_magic || vital->version != page_version || !state() || vital->cycling.load(relaxed) > 1 ||
         vital->realtime.load(relaxed) > 1 || !known || !gate;
}

const descriptor::Configuration* GuardedMember::in_force() const noexcept {
  if (vital == nullptr) return nullptr;
  const auto id = static_cast<std::uint8_t>(vital->configuration.load(std::memory_order_relaxed));
  return described->subsystem.find_configuration(id);
}

bool GuardedMember::uses(std::uint16_t device) const noexcept {
  const auto* configured = in_force();
  return configured != nullptr &&
         std::ranges::any_of(configured->devices, [&](const auto& use) { return use.device == device; });
}

Duration GuardedMember::sampling() const noexcept {
  const auto* configured = in_force();
  return configured != nullptr ? configured->sampling : Duration{};
}

Duration GuardedMember::limit_of(const WatchedDevice& device) const noexcept {
  return has_realtime() ? device.silence : device.silence_reduced;
}

bool GuardedMember::has_realtime() const noexcept {
  return vital != nullptr && vital->realtime.load(std::memory_order_relaxed) != 0 && taken != Taken::All;
}

std::uint32_t GuardedMember::hang_limit() const noexcept {
  const std::uint32_t limit = has_realtime() ? described->subsystem.hang.realtime : described->subsystem.hang.reduced;
  return std::max(limit, static_cast<std::uint32_t>(slow_steps * sampling() / guard_observation_period));
}

// --- its permission ----------------------------------------------------------------------------------------------------

bool GuardedMember::stands_fenced() const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  return !released && permit != nullptr && permit->stop.load(relaxed) != 0 && permit->go.load(relaxed) == 0 &&
         permit->epoch.load(relaxed) == epoch;
}

std::string_view GuardedMember::why_it_rests() const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  if (state() != State::Operational) return "it is not Operational";
  if (vital->inhibited.load(relaxed) != 0) return "it inhibits its actuators itself";
  if (vital->seen_epoch.load(relaxed) != epoch) return "it has not seen its permit of now";
  return {};
}

void GuardedMember::fence() noexcept {
  ++fences;
  for (WatchedDevice& device : devices) device.withdraw_notes();
  // Who stands fenced stays so: a further epoch, or a further answer to wait for, would only put off its word that it has stopped.
  if (stands_fenced()) return;
  released = false;
  if (permit != nullptr) {
    if (vital != nullptr && permit->stop.load(std::memory_order_relaxed) == 0)
      permit->stopped_at_cycle.store(vital->cycles.load(std::memory_order_acquire), std::memory_order_relaxed);
    restore_epoch(*permit, epoch);
    permit->fence();
    epoch = permit->epoch.load(std::memory_order_relaxed);
  }
  for (WatchedDevice& device : devices) device.fenced_at_sequence = device.sequence;
}

void GuardedMember::begin_stop(TimePoint now, TimePoint asked) noexcept {
  stop_begun = now;
  stop_asked = asked;
  stop_killed = false;
  stopped.reset();
  for (WatchedDevice& device : devices) device.stopped.reset();
}

void GuardedMember::release(TimePoint now) noexcept {
  // Who may move has the priority that its limits are made for.
  if ((taken != Taken::Nothing || guarded_before) && grip) grip->give_realtime();
  taken = Taken::Nothing;
  guarded_before = false;
  restore_epoch(*permit, epoch);
  permit->release();
  epoch = permit->epoch.load(std::memory_order_relaxed);
  released = true;
  seen_operational = false;
  released_at = now;
  for (WatchedDevice& device : devices) device.falls_back = device.choose_way(limit_of(device), now);
  // Whoever lets it move is told again of whom nobody would hear; what it stops is what has acted since.
  for (WatchedDevice& device : devices) device.silence_told = device.acts = false;
}

void GuardedMember::end_permission(TimePoint now) noexcept {
  if (!released) return;
  const bool operational = state() == State::Operational;
  seen_operational = seen_operational || operational;
  const Duration to_enter = std::max(permission_entry_limit, slow_steps * sampling());
  const bool over = seen_operational ? !operational : now - released_at >= to_enter;
  if (!over) return;
  released = false;
  if (permit != nullptr) permit->go.store(0, std::memory_order_release);
}

void GuardedMember::take_realtime(Taken what) noexcept {
  if (what == Taken::All) grip->take_realtime();
  else grip->take_loops_realtime();
  taken = std::max(taken, what);
}

// --- power -------------------------------------------------------------------------------------------------------------

void GuardedMember::drive_power(TimePoint now) noexcept {
  if (power.none()) return;
  const bool needed = needs_power();
  if (needed) not_needed_since.reset();
  // Told nothing, a switch stays as it is for a while (data_transfer/device/power_frame.hpp): that is long enough for most stops.
  power_unknown = power_unknown && !needed && may_still_move(now);
  if (power_unknown) return;
  power.step(needed || (power.told_on() && may_still_move(now)), has_realtime(), now);
  if (permit != nullptr) permit->powered.store(power.said(), std::memory_order_release);
}

std::optional<GuardFinding> GuardedMember::power_finding(TimePoint now) noexcept {
  // Where nothing is wanted of a switch its silence is a matter of the way to Offline, which tells it.
  const auto found = power.told_on() ? power.find_silence(now) : std::nullopt;
  if (!found) return std::nullopt;
  using enum GuardFinding::Kind;
  return GuardFinding{found->falls_back ? PowerFellBack : PowerSilent, apid(), found->place};
}

bool GuardedMember::needs_power() const noexcept {
  if (vital == nullptr || killed) return false;
  const auto in = state();
  // A page that says nothing is no reason to take the power from a brake: its member is being ended.
  return !in || (*in != State::Offline && *in != State::SoftwareInit && *in != State::SoftwareDeinit);
}

/// What moves is brought to rest first: without power no device could carry out the stop that it declares.
bool GuardedMember::may_still_move(TimePoint now) noexcept {
  if (!not_needed_since) not_needed_since = now;
  const bool rests = not_asked.empty() && std::ranges::all_of(devices, &WatchedDevice::rests);
  return !rests && now - *not_needed_since < rest_within + answer_limit;
}

// --- a stop ------------------------------------------------------------------------------------------------------------

bool GuardedMember::has_stopped() const noexcept {
  const bool told =
      std::ranges::all_of(devices, [](const WatchedDevice& device) { return device.stopped.has_value(); });
  const bool answers_itself = devices.empty() || !not_asked.empty();
  return told && (!answers_itself || says_stopped());
}

bool GuardedMember::says_stopped() const noexcept {
  if (vital == nullptr) return true;  // there is no process that could move anything
  const auto now = state();
  if (!now) return false;  // what a damaged page says is nothing
  if (*now == State::Offline) return true;
  const bool rests = vital->cycling.load(std::memory_order_acquire) == 0;
  const bool knows = vital->seen_epoch.load(std::memory_order_acquire) == epoch;
  const bool inhibited = *now != State::Operational || vital->inhibited.load(std::memory_order_acquire) != 0;
  return rests || (knows && inhibited);
}

bool GuardedMember::to_blame() const noexcept {
  const auto moves = [](const WatchedDevice& device) { return device.knows() && !device.stopped; };
  return !says_stopped() || std::ranges::any_of(devices, moves);
}

Duration GuardedMember::stop_limit() const noexcept {
  Duration longest{};
  for (const WatchedDevice& device : devices) longest = std::max(longest, device.stop_within);
  // Its own word comes with its cycle.
  return std::max(longest, slow_steps * sampling()) + answer_limit;
}

}  // namespace hirosco::supervisor
