// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/device_slot.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"

namespace hirosco {
namespace {

static_assert(descriptor::max_device_octets == max_device_payload_octets);

/// How long a device may follow an epoch before the commanded one, in silence limits: the guard names it every 5 ms.
constexpr std::uint32_t longest_introduction = 40;

[[nodiscard]] std::endian endian_of(descriptor::ByteOrder order) noexcept {
  return order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
}

}  // namespace

DeviceSlot::DeviceSlot(const descriptor::Device& device, const descriptor::DeviceUse& use, DevicePortBase& port,
                       std::vector<Way> ways, Duration sampling, bool realtime)
    : device_{&device},
      port_{&port},
      ways_{std::move(ways)},
      order_{endian_of(use.endnode.byte_order)},
      silence_limit_{realtime ? use.silence.realtime : use.silence.reduced},
      every_{use.every},
      watchdog_us_{realtime ? use.watchdog_us : use.watchdog_reduced_us},
      input_layout_{agreed_layout(port.input_layout_, device.input, port.input_)},
      output_{device, port.output_layout_, port.output_, order_},
      frame_(max_device_frame_octets) {
  port_->alive_ = false;
  port_->fresh_ = false;
  port_->damaged_frames_ = 0;
  port_->settings_ = use.settings;
  port_->endnode_ = taken();
  port_->fall_backs_ = 0;
  follow(sampling);
}

void DeviceSlot::follow(Duration sampling) noexcept {
  if (!device_->actuator) return;
  // What was counted in cycles of before is as long in those of now, or longer.
  const auto in_new_cycles = [&](std::uint32_t cycles) { return cycles * sampling_ / sampling; };
  if (sampling_ > Duration{}) {
    left_obeys_cycles_ =
        static_cast<std::uint32_t>(in_new_cycles(left_obeys_cycles_) + (left_obeys_cycles_ > 0 ? 1 : 0));
    // Never is never, in cycles of an hour too: no product of it is formed.
    if (since_active_ < never)
      since_active_ = static_cast<std::uint32_t>(std::min<std::int64_t>(in_new_cycles(since_active_), never));
  }
  sampling_ = sampling;
  left_obeys_ = static_cast<std::uint32_t>(std::chrono::microseconds{watchdog_us_} / sampling) + 1;
}

std::string DeviceSlot::difference(const descriptor::Device& device, const DevicePortBase& port) {
  const std::string input = layout_difference(port.input_layout(), device.input);
  const std::string output = layout_difference(port.output_layout(), outputs_of(device));
  std::string both = input.empty() ? input : "input, " + input;
  if (!output.empty()) both.append(both.empty() ? "" : "; ").append("output, ").append(output);
  return both;
}

void DeviceSlot::read(bool count_silence, bool counts) noexcept {
  counts_ = counts;
  port_->fresh_ = false;
  just_lost_ = false;
  if (std::exchange(just_fell_back_, false)) {
    since_good_ = {};
    hung_up_ = false;
  }
  if (left_obeys_cycles_ > 0 && counts_) --left_obeys_cycles_;
  if (counts_) count(since_active_);
  const auto received = ways_[way_].flow->receive(frame_);
  // A frame that no frame is as long as is damage, too: somebody is there.
  const bool too_long = !received && received.error().code == ErrorCode::Malformed;
  if (const std::uint32_t damaged = too_long ? 1 : received ? received->damaged : 0; damaged > 0) {
    port_->damaged_frames_ += damaged;
    count(since_good_.damaged);
  }
  if (received && received->flow == Flow::New) take_frame(Octets{frame_}.first(received->octets));
  if (port_->fresh_) {
    since_good_ = {};
    heard_ = ever_heard_ = true;
    awaits_ = false;
    port_->alive_ = true;
    return;
  }
  if (!heard_ && !count_silence) return;
  hung_up_ = !received && !too_long && heard_;
  const bool hangs_up = hung_up_ && port_->alive_;
  if (!counts_ && !hangs_up) return;
  count(since_good_.silent_cycles);
  if (since_good_.silent_cycles != silence_limit_ && !hangs_up) return;
  if (way_ + 1 < ways_.size()) return fall_back();
  just_lost_ = port_->alive_ || !heard_;  // a fall-back that is awaited has not been heard
  awaits_ = false;
  port_->alive_ = false;
}

/// From here on nothing counts but what answers a command that goes out by the new way.
void DeviceSlot::fall_back() noexcept {
  // What still listens there is told to let go; what does not has its watchdog.
  send(DeviceMode::Off, output_.safe());
  left_ = taken();
  ++way_;
  just_fell_back_ = true;
  awaits_ = true;
  heard_ = false;
  asked_ = sequence_ + 1;
  // Since it was told Active last: what it was told later it may not have heard, nor what one that was left before it heard.
  const std::uint32_t passed = since_active_ > 0 ? since_active_ - 1 : 0;
  left_obeys_cycles_ = std::max(left_obeys_cycles_, left_obeys_ > passed ? left_obeys_ - passed : 0);
  since_active_ = never;
  since_sent_ = every_;
  port_->alive_ = false;
  port_->endnode_ = taken();
  ++port_->fall_backs_;
}

void DeviceSlot::take_frame(Octets frame) noexcept {
  const auto status = read_status(frame);
  const bool fits = status && status->payload.size() == wire_octets(input_layout_);
  if (!fits) {
    ++port_->damaged_frames_;
    if (status) return count(since_good_.wrong_size);
    return count(status.error().code == ErrorCode::Mismatch ? since_good_.other_version : since_good_.damaged);
  }
  decode(input_layout_, status->payload, port_->input_, order_);
  // A frame that answers no newer command is a repetition: a frozen device must not look alive.
  const bool answers = heard_ || port_->fall_backs_ == 0 || static_cast<std::int32_t>(status->sequence - asked_) >= 0;
  // One that obeys a higher epoch than ours, another flight's, has heard nobody but that.
  const bool refuses = (status->flags & device_flag::old_epoch_refused) != 0 && status->epoch > epoch_;
  port_->fresh_ = answers && (heard_ ? status->sequence != echoed_ : !refuses);
  if (!port_->fresh_) count(refuses ? since_good_.refused : since_good_.repeated);
  echoed_ = status->sequence;
  port_->flags_ = status->flags;
  // Its watchdog has let go although it is commanded: it moves nothing any more, whatever its sensors say. Of an epoch
  // before the commanded one that says nothing at first: the guard has yet to name this one to it.
  const bool tripped = (status->flags & device_flag::watchdog_tripped) != 0;
  const std::uint32_t patience = status->epoch < epoch_ ? longest_introduction * silence_limit_ : silence_limit_;
  if (!tripped || active_cycles_ <= patience) return;
  if (port_->fresh_) count(since_good_.let_go);
  port_->fresh_ = false;
}

/// Up to a bound, so that a counter never wraps back to "fresh".
void DeviceSlot::count(std::uint32_t& cycles) noexcept { cycles = std::min(cycles + 1, never); }

DeviceSlot::Loss DeviceSlot::loss() const noexcept {
  Loss loss = since_good_;
  using enum descriptor::DeviceLoss;
  std::uint32_t most = 0;
  const auto blame = [&](std::uint32_t frames, descriptor::DeviceLoss reason) {
    if (frames <= most) return;
    most = frames;
    loss.reason = reason;
  };
  blame(loss.damaged, Damaged);
  blame(loss.wrong_size, WrongSize);
  blame(loss.other_version, OtherVersion);
  blame(loss.let_go, LetGo);
  blame(loss.repeated, Repeated);
  blame(loss.refused, OldEpoch);
  if (loss.reason == Silent && !ever_heard_) loss.reason = NeverHeard;
  if (hung_up_) loss.reason = HungUp;
  return loss;
}

void DeviceSlot::write(std::uint32_t epoch, bool active, bool stopping) noexcept {
  const bool pass = active || !device_->actuator;
  if (!active) active_cycles_ = 0;
  else if (counts_) count(active_cycles_);
  const std::uint32_t before = std::exchange(epoch_, epoch);
  const Octets payload = output_.put_out(pass);
  const DeviceMode mode = pass ? DeviceMode::Active : stopping ? DeviceMode::Stop : DeviceMode::Off;
  if (due(mode, before)) send(mode, payload);
}

/// Every so many cycles; what it may do is said at once.
bool DeviceSlot::due(DeviceMode mode, std::uint32_t epoch_before) noexcept {
  // Who takes each frame gets one in each cycle, whatever started it.
  if (counts_ || every_ == 1) ++since_sent_;
  if (since_sent_ < every_ && mode == sent_mode_ && epoch_ == epoch_before && sequence_ != 0) return false;
  since_sent_ = 0;
  sent_mode_ = mode;
  return true;
}

void DeviceSlot::send(DeviceMode mode, Octets payload) noexcept {
  const auto frame = write_command(
      frame_,
      DeviceCommand{
          .mode = mode, .epoch = epoch_, .sequence = ++sequence_, .watchdog_us = watchdog_us_, .payload = payload});
  if (mode == DeviceMode::Active) since_active_ = 0;
  // A device that does not listen is found by its silence, one cycle later: nothing to do here.
  if (frame) static_cast<void>(ways_[way_].flow->send(*frame));
}

}  // namespace hirosco
