// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/obedience.hpp"

#include <algorithm>

namespace hirosco::simulation {
namespace {

constexpr Duration longest_watchdog = std::chrono::seconds{1};
constexpr Duration longest_starvation = std::chrono::milliseconds{50};

}  // namespace

Obedience::Judgement Obedience::judge(const DeviceCommand& command, TimePoint now) noexcept {
  if (command.epoch < epoch_) {
    raise(device_flag::old_epoch_refused, true);
    return {.verdict = Verdict::Refused};
  }
  // An epoch that the supervisor's side has not named yet: heard and answered, not obeyed. Taken over, a wrong one would
  // shut out all that come later.
  if (!inhibit_.has_named(command.epoch)) {
    sequence_ = command.sequence;
    mode_ = DeviceMode::Off;
    begins_ = begins_ && command.mode == DeviceMode::Active;
    return {.verdict = Verdict::Heard};
  }
  // An expired watchdog trips before a late command of the same epoch can hide it.
  watch(now);
  const bool begins = begins_ && declared_.actuator && command.mode == DeviceMode::Active;
  const bool latched = begins || (watchdog_tripped() && command.epoch == epoch_);
  const bool obeyed = command.mode == DeviceMode::Active && !latched && inhibit_.enabled(command.epoch, now);
  return {.verdict = obeyed ? Verdict::Obeyed : Verdict::Acceptable, .latched = latched};
}

void Obedience::accept(const DeviceCommand& command, const Judgement& judgement, TimePoint now) noexcept {
  raise(device_flag::old_epoch_refused, false);
  raise(device_flag::watchdog_tripped, judgement.latched);
  begins_ = false;
  epoch_ = command.epoch;
  sequence_ = command.sequence;
  mode_ = command.mode;
  starved_ = {};
  const Duration wanted = std::chrono::microseconds{command.watchdog_us};
  watchdog_at_ = now + (command.watchdog_us == 0 ? declared_.watchdog : std::min(wanted, longest_watchdog));
}

void Obedience::watch(TimePoint now) noexcept {
  if (mode_ != DeviceMode::Off && now >= watchdog_at_) raise(device_flag::watchdog_tripped, true);
}

/// Latches what was taken away from a moving device: a motion may not go on by itself when the enable comes back.
void Obedience::choose_output(TimePoint now) noexcept {
  const bool given = inhibit_.enabled(epoch_, now);
  const bool wanted = mode_ == DeviceMode::Active && !watchdog_tripped();
  if (given && wanted) {
    output_ = DeviceOutput::Active;
    return;
  }
  if (output_ == DeviceOutput::Active && wanted) raise(device_flag::watchdog_tripped, true);
  if (output_ != DeviceOutput::Active) return;
  using enum DeviceStop;
  stop_left_ = declared_.stop == Controlled ? declared_.stop_within : Duration{0};
  switch (declared_.stop) {
    case Drop: output_ = DeviceOutput::Off; return;
    case Hold: output_ = DeviceOutput::Holding; return;
    case Controlled: output_ = stop_left_ > Duration{0} ? DeviceOutput::Stopping : DeviceOutput::Holding; return;
  }
}

void Obedience::count_down(Duration cycle) noexcept {
  if (output_ != DeviceOutput::Stopping) return;
  stop_left_ -= cycle;
  if (stop_left_ <= Duration{0}) output_ = DeviceOutput::Holding;
}

/// Whom a machine that starves starves first is the subsystem, which waits for this program: the watchdog does not count such a step at
/// all, for a while.
Duration Obedience::forgive(const WorldClock::Held& held) noexcept {
  if (mode_ == DeviceMode::Off) return {};
  watchdog_at_ += held.pause;
  if (held.starved == Duration{0} || starved_ >= longest_starvation) return {};
  starved_ += held.starved;
  watchdog_at_ += held.starved;
  return held.starved;
}

void Obedience::begin_anew() noexcept {
  begins_ = true;
  mode_ = DeviceMode::Off;
  epoch_ = sequence_ = 0;
  flags_ = 0;
  output_ = declared_.stop == DeviceStop::Drop ? DeviceOutput::Off : DeviceOutput::Holding;
}

}  // namespace hirosco::simulation
