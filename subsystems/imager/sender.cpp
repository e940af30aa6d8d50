// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/sender.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/utilities/crc32.hpp"

namespace hirosco::imager {

void Sender::serve(CustomService& service, const Parameter<std::uint32_t>& rate, const Parameter<Sending>& shown) {
  service_ = &service;
  rate_ = &rate;
  shown_ = &shown;
  service.on_request("LIST_IMAGES", [this](const Call& call) -> Outcome { return list(call); });
  service.on_request(
      "SEND_IMAGE", [this](std::uint32_t image, std::uint16_t first, std::uint16_t count, const Call& call) -> Outcome {
        return take({call, image, first, count});
      });
  service.on_request("STOP_SENDING", [this]() -> Result<> { return stop(); });
  service.on_step([this](TimePoint now) { step(now); });
}

Outcome Sender::list(const Call& call) {
  for (const std::uint32_t number : store_.numbers()) {
    if (number == 0) break;
    // One that the cycle has taken away since is not there any more.
    const auto held = store_.hold(number);
    if (held && !describe(*held, call))
      return Result<>{fail(ErrorCode::ResourceExhausted, "too much is on its way: ask again")};
  }
  return ok();
}

Outcome Sender::take(const Wanted& wanted) {
  if (waiting_.size() == most_waiting) return refused(Trouble::too_many_requests, "so many wait already", most_waiting);
  const auto held = store_.hold(wanted.image);
  if (!held) return refused(Trouble::image_gone, "no such image is there", wanted.image);
  const std::uint16_t parts = parts_of(held->taken().octets());
  if (wanted.first >= parts || wanted.count > parts - wanted.first)
    return refused(Trouble::no_such_part, "parts of the image", parts);
  // The newest is the newest now, not when its turn comes.
  waiting_.push_back({wanted.call, held->taken().number, wanted.first, wanted.count});
  return running;
}

/// Those that had their end already, with their configuration, are not told another.
void Sender::end_all(const Error& why) {
  held_.reset();
  for (const Wanted& wanted : waiting_) service_->abort(wanted.call, why);
  waiting_.clear();
  show();
}

Result<> Sender::stop() {
  end_all({ErrorCode::NotPermitted, "ended by STOP_SENDING"});
  return ok();
}

bool Sender::describe(const ImageStore::Held& held, const Call& to) {
  const Taken& taken = held.taken();
  if (summed_ != taken.number) {
    sum_ = crc32(held.pixels());
    summed_ = taken.number;
  }
  const Window& window = taken.window;
  const auto age_ms = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>((now_ - taken.exposed) / std::chrono::milliseconds{1}, 0, 0xFFFF'FFFF));
  const std::array<std::uint16_t, 4> place{window.x, window.y, window.width, window.height};
  return service_
      ->report("IMAGE", to, taken.number, age_ms, taken.exposure_ms, taken.temperature_c, taken.shutter, place,
               window.binning, window.columns(), window.rows(), taken.octets(), parts_of(taken.octets()), sum_)
      .has_value();
}

bool Sender::send_part(const Call& to) {
  const std::size_t from = next_ * part_octets;
  const Octets pixels = held_->pixels();
  const std::size_t octets = std::min(part_octets, pixels.size() - from);
  std::array<std::uint8_t, part_octets> part{};
  copy_octets(pixels.subspan(from, octets), std::as_writable_bytes(std::span{part}));
  if (!service_->report("PART", to, held_->taken().number, next_, static_cast<std::uint16_t>(octets), part))
    return false;
  ++next_;
  ++sent_;
  allowed_octets_ -= static_cast<double>(octets);
  return true;
}

/// The first that waits, or the next whose image is still there. False: none.
bool Sender::begin() {
  while (!waiting_.empty()) {
    const Wanted& wanted = waiting_.front();
    held_ = store_.hold(wanted.image);
    if (held_) {
      next_ = wanted.first;
      end_ = static_cast<std::uint16_t>(wanted.count != 0 ? wanted.first + wanted.count
                                                          : parts_of(held_->taken().octets()));
      described_ = false;
      return true;
    }
    service_->abort(wanted.call, {ErrorCode::NotFound, "the image is gone", wanted.image});
    waiting_.erase(waiting_.begin());
  }
  return false;
}

void Sender::step(TimePoint now) {
  now_ = now;
  if (forget_.exchange(false)) end_all({ErrorCode::NotPermitted, "another configuration"});
  std::uint32_t rate = 0;
  // A rate that is being set just now: as in the last step.
  if (rate_->snapshot(rate) && last_) {
    const double most = std::max(static_cast<double>(rate) / 10, static_cast<double>(part_octets));
    allowed_octets_ = std::min(allowed_octets_ + rate * seconds(now - *last_), most);
  }
  last_ = now;
  if (waiting_.empty()) {
    held_.reset();
    return;
  }
  while (held_ || begin()) {
    const Call call = waiting_.front().call;
    if (!described_ && !(described_ = describe(*held_, call))) break;
    while (next_ < end_ && allowed_octets_ > 0)
      if (!send_part(call)) return show();
    if (next_ < end_) break;
    held_.reset();
    waiting_.erase(waiting_.begin());
    service_->finish(call);
  }
  show();
}

void Sender::show() {
  const Sending now = held_ ? Sending{held_->taken().number, next_, static_cast<std::uint16_t>(end_ - next_), sent_}
                            : Sending{0, 0, 0, sent_};
  // It is told again in the next step.
  static_cast<void>(service_->store(*shown_, now));
}

}  // namespace hirosco::imager
