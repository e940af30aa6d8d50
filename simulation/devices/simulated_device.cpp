// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace hirosco::simulation {
namespace {

constexpr std::int64_t most_cycles_at_once = 40;          // of catching up after the process itself was held up
constexpr std::size_t most_delayed_frames = 2048;         // 1 s at 2 kHz
constexpr std::size_t most_injections = 10'000;           // then the record ends; the faults still work
constexpr Duration longest_watchdog = std::chrono::seconds{1};
constexpr Duration longest_starvation = std::chrono::milliseconds{50};
constexpr Duration longest_unseen = std::chrono::microseconds{250};  // of a frame by a flow that is not waited for

Duration milliseconds_of(double ms) noexcept { return Duration{std::llround(ms * 1e6)}; }

FlowAddress held(FlowAddress address) {
  address.holder = FlowHolder::Supervisor;
  return address;
}

}  // namespace

Words::Words(std::string_view line) noexcept {
  constexpr std::string_view blank = " \t\r\n";
  while (true) {
    const auto start = line.find_first_not_of(blank);
    if (start == std::string_view::npos) return;
    line.remove_prefix(start);
    const auto length = std::min(line.find_first_of(blank), line.size());
    if (count_ == words_.size()) {
      too_many_ = true;
      return;
    }
    words_[count_++] = line.substr(0, length);
    line.remove_prefix(length);
  }
}

Result<double> Words::number(std::size_t i, double low, double high) const noexcept {
  const std::string_view word = (*this)[i];
  double value = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    return fail(ErrorCode::InvalidArgument, "not a number", static_cast<std::int64_t>(i));
  if (value < low || value > high) return fail(ErrorCode::OutOfRange, "number", static_cast<std::int64_t>(i));
  return value;
}

Result<> Words::expect(std::size_t expected) const noexcept {
  if (too_many_ || count_ != expected)
    return fail(ErrorCode::InvalidArgument, "wrong number of words", static_cast<std::int64_t>(count_));
  return ok();
}

SimulatedDevice::SimulatedDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : flows_{flows}, address_{std::move(address)}, settings_{settings}, delayed_(most_delayed_frames) {}

Result<> SimulatedDevice::plug() {
  if (flow_ != nullptr) return ok();
  if (!can(settings_.stop)) return fail(ErrorCode::InvalidArgument, "a stop that this device does not have");
  if (!world_made_) {
    HIROSCO_TRY(make_world());
  }
  world_made_ = true;
  if (settings_.enable && enable_flow_ == nullptr) {
    HIROSCO_TRY_LET(enable_flow_, flows_.open(held(*settings_.enable), FlowSide::Device));
  }
  if (settings_.power && !switch_) {
    HIROSCO_TRY_LET(auto flow, flows_.open(held(*settings_.power), FlowSide::Device));
    switch_.emplace(std::move(flow));
    had_power_ = false;
  }
  return open_all();
}

Result<> SimulatedDevice::open_all() {
  std::vector<FlowAddress> addresses{address_};
  addresses.insert(addresses.end(), settings_.fall_backs.begin(), settings_.fall_backs.end());
  HIROSCO_TRY_LET(auto flow, EndnodeWays::open(flows_, std::move(addresses)));
  std::vector<FurtherExchange> further;
  for (const FurtherEndnode& described : settings_.further) {
    HIROSCO_TRY_LET(auto ways, EndnodeWays::open(flows_, described.addresses));
    further.emplace_back(described, std::move(ways));
  }
  flow_ = std::move(flow);
  further_ = std::move(further);
  return ok();
}

void SimulatedDevice::step(TimePoint now) {
  const bool first = !std::exchange(started_, true);
  if (!first) forgive_pause(now);
  now_ = now;
  follow_power(now);
  receive_enable(now);
  const bool exchanged = receive(now);
  // The first exchange moves the world by a cycle, as all that follow do.
  if (first) world_time_ = exchanged ? now - settings_.cycle : now;
  watch(now);
  choose_output(now);
  const std::int64_t due = due_cycles(now, exchanged);
  const Duration cycle =
      settings_.clock == 1 ? settings_.cycle : milliseconds_of(1e3 * settings_.clock * seconds(settings_.cycle));
  for (std::int64_t i = 0; i < due; ++i) {
    advance(cycle);
    count_down(cycle);
  }
  cycles_ += static_cast<std::uint64_t>(due);
  if (output_ == DeviceOutput::Active) obeyed_cycles_ = cycles_;
  if (!exchanged) own_cycles_ += static_cast<std::uint64_t>(due);
  if (due > 0 || exchanged) answer(now);
  send_due(now);
  answer_enable();
  exchange_further();
}

/// Without power it hears nothing and moves nothing; it comes back knowing nothing of what was before.
void SimulatedDevice::follow_power(TimePoint now) noexcept {
  if (!switch_) return;
  switch_->step(now);
  const bool has = switch_->on();
  if (std::exchange(had_power_, has) != has) begin_anew();
}

/// As it boots: it knows nothing of what was before, and what moves has brakes or nothing.
void SimulatedDevice::begin_anew() noexcept {
  begins_ = true;
  mode_ = DeviceMode::Off;
  epoch_ = sequence_ = 0;
  flags_ = 0;
  enable_.reset();
  enable_asked_.reset();
  for (FurtherExchange& each : further_) each.forget();
  output_ = settings_.stop == Stop::Drop ? DeviceOutput::Off : DeviceOutput::Holding;
  last_.size = 0;
  delayed_count_ = 0;
}

void SimulatedDevice::exchange_further() noexcept {
  for (FurtherExchange& each : further_) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto command = each.hear(buffer);
    if (!command || !powered()) continue;
    // One that was not taken is not answered, so that its subsystem hears of it.
    if (command->mode == DeviceMode::Active &&
        !take_at(each.name(), OctetReader{command->payload, each.byte_order()})) {
      ++damaged_commands_;
      continue;
    }
    std::array<std::byte, max_device_payload_octets> payload;
    OctetWriter writer{payload, each.byte_order()};
    write_sensors_at(each.name(), writer);
    if (now_ >= silent_until_) each.answer(writer.written(), flags_);
  }
}

Result<> SimulatedDevice::take_at(std::string_view, OctetReader payload) noexcept {
  return payload.remaining() == 0 ? ok() : fail(ErrorCode::Malformed, "this endnode takes nothing");
}

void SimulatedDevice::write_sensors_at(std::string_view, OctetWriter&) noexcept {}

TimePoint SimulatedDevice::next_wake() const noexcept {
  if (!started_) return now_;
  TimePoint wake = world_time_ + settings_.cycle * (by_own_clock_ ? 1 : 2);
  if (mode_ != DeviceMode::Off && !watchdog_tripped()) wake = std::min(wake, watchdog_at_);
  if (output_ == DeviceOutput::Active && settings_.enable) wake = std::min(wake, enable_until_);
  if (delayed_count_ > 0) wake = std::min(wake, delayed_[delayed_first_].due);
  if (switch_) wake = std::min(wake, switch_->off_at());
  return wake;
}

bool SimulatedDevice::wait(Duration timeout) noexcept {
  if (flow_ == nullptr || peer_gone_) return false;
  if (flow_->count() == 1 && further_.empty()) return flow_->wait(timeout);
  return flow_->wait(std::min(timeout, longest_unseen)) || timeout > longest_unseen;
}

/// True when an acceptable command came.
bool SimulatedDevice::receive(TimePoint now) noexcept {
  if (flow_ == nullptr) return false;
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = flow_->receive(buffer);
  peer_gone_ = !received && received.error().code == ErrorCode::Unavailable;
  if (!received || received->flow != Flow::New || !powered()) return false;
  const auto command = read_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
  if (!command) {
    ++damaged_commands_;
    return false;
  }
  return accept(*command, now);
}

bool SimulatedDevice::accept(const DeviceCommand& command, TimePoint now) noexcept {
  if (command.epoch < epoch_) {
    raise(device_flag::old_epoch_refused, true);
    return false;
  }
  // An epoch that the supervisor's side has not named yet: heard and answered, not obeyed. Taken over, a wrong one would
  // shut out all that come later.
  if (settings_.enable && command.epoch > (enable_ ? enable_->epoch : 0)) {
    sequence_ = command.sequence;
    mode_ = DeviceMode::Off;
    begins_ = begins_ && command.mode == DeviceMode::Active;
    return true;
  }
  // An expired watchdog trips before a late command of the same epoch can hide it.
  watch(now);
  const bool begins = begins_ && settings_.actuator && command.mode == DeviceMode::Active;
  const bool latched = begins || (watchdog_tripped() && command.epoch == epoch_);
  const bool obeyed = command.mode == DeviceMode::Active && !latched && enabled(command.epoch, now);
  if (obeyed && !take(OctetReader{command.payload, settings_.byte_order})) {
    ++damaged_commands_;
    return false;
  }
  raise(device_flag::old_epoch_refused, false);
  raise(device_flag::watchdog_tripped, latched);
  begins_ = false;
  epoch_ = command.epoch;
  sequence_ = command.sequence;
  mode_ = command.mode;
  starved_ = {};
  const Duration wanted = std::chrono::microseconds{command.watchdog_us};
  watchdog_at_ = now + (command.watchdog_us == 0 ? settings_.watchdog : std::min(wanted, longest_watchdog));
  return true;
}

void SimulatedDevice::receive_enable(TimePoint now) noexcept {
  if (enable_flow_ == nullptr) return;
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = enable_flow_->receive(buffer);
  // Unplugged it hears nothing. The flow stays open: its other end is never opened a second time.
  if (!received || received->flow != Flow::New || flow_ == nullptr || !powered()) return;
  const auto command = read_enable_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
  if (!command) {
    ++damaged_commands_;
    return;
  }
  enable_asked_ = command->sequence;
  // A repetition is no sign of life, and nobody goes back to what was given before.
  if (enable_ && (command->sequence == enable_->sequence || command->epoch < enable_->epoch)) return;
  enable_ = *command;
  enable_until_ = now + settings_.enable_limit;
}

bool SimulatedDevice::enabled(std::uint32_t epoch, TimePoint now) const noexcept {
  if (!settings_.enable) return true;
  return enable_ && enable_->enabled == 1 && enable_->epoch == epoch && now < enable_until_;
}

/// Latches what was taken away from a moving device: a motion may not go on by itself when the enable comes back.
void SimulatedDevice::choose_output(TimePoint now) noexcept {
  const bool given = enabled(epoch_, now);
  const bool wanted = mode_ == DeviceMode::Active && !watchdog_tripped();
  if (given && wanted) {
    output_ = DeviceOutput::Active;
    return;
  }
  if (output_ == DeviceOutput::Active && wanted) raise(device_flag::watchdog_tripped, true);
  if (output_ != DeviceOutput::Active) return;
  stop_left_ = settings_.stop == Stop::Controlled ? settings_.stop_within : Duration{0};
  switch (settings_.stop) {
    case Stop::Drop: output_ = DeviceOutput::Off; return;
    case Stop::Hold: output_ = DeviceOutput::Holding; return;
    case Stop::Controlled: output_ = stop_left_ > Duration{0} ? DeviceOutput::Stopping : DeviceOutput::Holding; return;
  }
}

void SimulatedDevice::count_down(Duration cycle) noexcept {
  if (output_ != DeviceOutput::Stopping) return;
  stop_left_ -= cycle;
  if (stop_left_ <= Duration{0}) output_ = DeviceOutput::Holding;
}

void SimulatedDevice::answer_enable() noexcept {
  const auto asked = std::exchange(enable_asked_, std::nullopt);
  if (!asked || flow_ == nullptr) return;
  std::array<std::byte, enable_frame_octets> buffer;
  const auto status =
      write_enable_status(buffer, {.output = output_, .flags = flags_, .epoch = epoch_, .sequence = *asked});
  // Nobody listening is no matter of a device's.
  if (status) (void)enable_flow_->send(*status);
}

/// A pause of this very program (a stopped virtual machine, a debugger) is no time that the device had: real hardware
/// would have run on, so neither its world nor its watchdog may jump. While it runs it wakes after a cycle by its own
/// clock, after two while it is driven by exchanges; what is longer was a pause. Up to half a cycle it was jitter, which
/// the world catches up with: its clock may not go slow by it. Woken later than that the machine starves, and whom it
/// starves first is the subsystem, which waits for this program: the watchdog does not count such a step at all, for a
/// while.
void SimulatedDevice::forgive_pause(TimePoint now) noexcept {
  const Duration expected = settings_.cycle * (by_own_clock_ ? 1 : 2);
  const Duration pause = now - now_ - expected;
  if (pause <= Duration{0}) return;
  // The world may be ahead by less than a cycle: then the wake that was planned lay later by that.
  if (const Duration lost = std::min(pause, now - world_time_ - expected); lost > settings_.cycle / 2)
    world_time_ += lost;
  enable_until_ += pause;
  if (mode_ == DeviceMode::Off) return;
  watchdog_at_ += pause;
  if (pause <= settings_.cycle / 2 || starved_ >= longest_starvation) return;
  starved_ += expected;
  watchdog_at_ += expected;
  enable_until_ += expected;
}

void SimulatedDevice::watch(TimePoint now) noexcept {
  if (mode_ != DeviceMode::Off && now >= watchdog_at_) raise(device_flag::watchdog_tripped, true);
}

/// The world's clock is the craft's: it is moved by whole cycles and never away from `now` by more than one. An exchange
/// moves it by one cycle when the subsystem is as fast as the device, whatever their jitter; by all that is missing when
/// the subsystem is slower; by none when the own clock was there at the same instant. Without an exchange nothing until a
/// command is overdue by a cycle, then by the clock.
std::int64_t SimulatedDevice::due_cycles(TimePoint now, bool exchanged) noexcept {
  const Duration behind = now - world_time_;
  if (!exchanged && behind < settings_.cycle * (by_own_clock_ ? 1 : 2)) return 0;
  std::int64_t due = behind / settings_.cycle;
  if (exchanged && behind > Duration{0}) due = std::max<std::int64_t>(due, 1);
  if (exchanged && behind <= Duration{0}) due = 0;
  by_own_clock_ = !exchanged;
  world_time_ += settings_.cycle * due;
  return std::min(due, most_cycles_at_once);
}

void SimulatedDevice::answer(TimePoint now) noexcept {
  if (now >= frozen_until_ || last_.size == 0) compose(last_);
  if (flow_ == nullptr || now < silent_until_ || !powered()) return;
  if (delayed_count_ == delayed_.size()) return;
  Frame& frame = delayed_[(delayed_first_ + delayed_count_) % delayed_.size()];
  frame = last_;
  frame.due = now + delay_;
  ++delayed_count_;
}

void SimulatedDevice::send_due(TimePoint now) noexcept {
  while (delayed_count_ > 0 && delayed_[delayed_first_].due <= now) {
    Frame& frame = delayed_[delayed_first_];
    if (corrupt_frames_ > 0) {
      --corrupt_frames_;
      frame.octets[frame.size / 2] ^= std::byte{0x40};
    }
    // Nobody listening is no matter of a device's.
    if (flow_ != nullptr && now >= silent_until_) (void)flow_->send(Octets{frame.octets}.first(frame.size));
    delayed_first_ = (delayed_first_ + 1) % delayed_.size();
    --delayed_count_;
  }
}

void SimulatedDevice::compose(Frame& frame) noexcept {
  std::array<std::byte, max_device_payload_octets> payload;
  OctetWriter writer{payload, settings_.byte_order};
  write_sensors(writer);
  const auto written = write_status(
      frame.octets, {.epoch = epoch_, .sequence = sequence_, .flags = flags_, .payload = writer.written()});
  frame.size = written ? written->size() : 0;
}

Result<> SimulatedDevice::fault(std::string_view line) {
  const Words words{line};
  HIROSCO_TRY(apply_fault(words));
  if (injections_.size() < most_injections) injections_.push_back({now_, std::string{line}});
  return ok();
}

std::string SimulatedDevice::truth() const {
  const double cycle_s = seconds(settings_.cycle);
  return fmt::format("{} world_s={:.4f} obeyed_s={:.4f}{}", do_truth(), static_cast<double>(cycles_) * cycle_s,
                     static_cast<double>(obeyed_cycles_) * cycle_s,
                     switch_ ? fmt::format(" powered={}", switch_->on() ? 1 : 0) : "");
}

void SimulatedDevice::heal() noexcept {
  silent_until_ = frozen_until_ = {};
  delay_ = {};
  corrupt_frames_ = 0;
  if (flow_ != nullptr) flow_->heal();
  for (FurtherExchange& each : further_) each.ways().heal();
  do_heal();
}

Result<> SimulatedDevice::apply_fault(const Words& words) {
  const std::string_view what = words[0];
  if (what == "unplug" || what == "plug" || what == "silent" || what == "reboot" || what == "heal") {
    HIROSCO_TRY(words.expect(1));
    if (what == "reboot") begin_anew();
    if (what == "silent") silent_until_ = TimePoint::max();
    if (what == "heal") heal();
    if (what == "plug") return plug();
    if (what != "unplug") return ok();
    flow_.reset();
    further_.clear();
    enable_.reset();
    delayed_count_ = 0;
    return ok();
  }
  if (what == "stall" || what == "freeze" || what == "delay") {
    HIROSCO_TRY(words.expect(2));
    const double longest_ms = what == "delay" ? 500 : 3'600'000;
    HIROSCO_TRY_LET(const double ms, words.number(1, 0, longest_ms));
    if (what == "stall") silent_until_ = now_ + milliseconds_of(ms);
    if (what == "freeze") frozen_until_ = now_ + milliseconds_of(ms);
    if (what == "delay") delay_ = milliseconds_of(ms);
    return ok();
  }
  if (what == "corrupt") {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double frames, words.number(1, 0, 1e9));
    corrupt_frames_ = static_cast<std::uint32_t>(frames);
    return ok();
  }
  if (what == "way") return fault_of_way(flow_.get(), words, 1);
  if (what == "endnode") return fault_of_way(ways_of(words[1]), words, 2);
  return do_fault(words);
}

EndnodeWays* SimulatedDevice::ways_of(std::string_view endnode) noexcept {
  if (endnode == settings_.endnode) return flow_.get();
  const auto found = std::ranges::find(further_, endnode, &FurtherExchange::name);
  return found != further_.end() ? &found->ways() : nullptr;
}

Result<> SimulatedDevice::fault_of_way(EndnodeWays* ways, const Words& words, std::size_t at) {
  if (ways == nullptr) return fail(ErrorCode::NotFound, "no such endnode, or it is unplugged");
  const bool counted = words[at + 1] == "corrupt";
  HIROSCO_TRY(words.expect(at + (counted ? 3 : 2)));
  HIROSCO_TRY_LET(const double way, words.number(at, 0, static_cast<double>(ways->count()) - 1));
  double frames = 0;
  if (counted) {
    HIROSCO_TRY_LET(frames, words.number(at + 2, 0, 1e9));
  }
  return ways->fault(static_cast<std::size_t>(way), words[at + 1], static_cast<std::uint32_t>(frames));
}

}  // namespace hirosco::simulation
