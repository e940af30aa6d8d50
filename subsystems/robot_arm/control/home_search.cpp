// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/home_search.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// In which a joint comes to its speed, and to rest: what that takes is little beside what stops it.
constexpr double changes_speed_s = 0.25;
/// In which what was pressed pushes it away.
constexpr double lets_go_s = 0.2;

}  // namespace

void HomeSearch::stand_at(const JointVector& position) noexcept {
  now_.position = position;
  now_.velocity.setZero(position.size());
  now_.acceleration.setZero(position.size());
}

void HomeSearch::remember(const Sees& sees) noexcept {
  last_position_ = sees.measured.position;
  last_velocity_ = sees.measured.velocity;
  for (std::size_t i = 0; i < knew_.size(); ++i) knew_[i] = i < sees.referenced.size() && sees.referenced[i] == 1;
}

void HomeSearch::begin(const Sees& sees) noexcept {
  stand_at(sees.measured.position);
  remember(sees);
  looks_ = goes_ = at_mark_ = false;
  yields_s_ = 0;
}

void HomeSearch::look(std::span<const std::uint8_t> order, std::span<const Way> ways) noexcept {
  count_ = std::min(order.size(), order_.size());
  std::ranges::copy(order.first(count_), order_.begin());
  std::ranges::copy(ways.first(std::min(ways.size(), ways_.size())), ways_.begin());
  next_ = found_ = 0;
  goes_ = at_mark_ = false;
  looks_ = true;
}

bool HomeSearch::at_rest() const noexcept { return !looks_ && yields_s_ <= 0 && now_.velocity.isZero(0); }

std::optional<std::size_t> HomeSearch::looking() const noexcept {
  if (!looks_ || !goes_ || at_mark_) return std::nullopt;
  return joint();
}

/// Where it would have been measured without the jump its last sample and speed tell. The first joint that knows its zero no more.
std::optional<std::size_t> HomeSearch::follow_zeros(const Sees& sees) noexcept {
  std::optional<std::size_t> lost;
  for (std::size_t i = 0; i < sees.referenced.size() && i < static_cast<std::size_t>(now_.position.size()); ++i) {
    const bool knows = sees.referenced[i] == 1;
    if (knows == knew_[i]) continue;
    const auto k = static_cast<Eigen::Index>(i);
    const double shift = sees.measured.position[k] - (last_position_[k] + last_velocity_[k] * cycle_s_);
    now_.position[k] += shift;
    if (goes_ && i == joint()) begun_at_ += shift;
    if (!knows && !lost) lost = i;
  }
  return lost;
}

/// Whoever looks has to come to rest now, or he would leave his distance.
bool HomeSearch::at_its_end() const noexcept {
  const auto i = static_cast<Eigen::Index>(joint());
  const Way& way = ways_[joint()];
  const double speed = std::abs(now_.velocity[i]);
  const double left = way.distance - std::abs(now_.position[i] - begun_at_);
  return speed * cycle_s_ + changes_speed_s / 2 * speed * speed / std::abs(way.speed) > left;
}

HomeSearch::News HomeSearch::search(const Sees& sees) noexcept {
  while (!goes_ && next_ < count_ && sees.referenced[joint()] == 1) ++next_;
  if (next_ == count_) {
    looks_ = false;
    return {.end = End::Done};
  }
  const auto i = static_cast<Eigen::Index>(joint());
  if (!goes_) {
    goes_ = true;
    at_mark_ = false;
    begun_at_ = now_.position[i];
    return {};
  }
  if (sees.referenced[joint()] == 1) at_mark_ = true;
  if (!at_mark_ && at_its_end()) {
    looks_ = false;
    return {.end = End::NotFound, .joint = joint()};
  }
  if (!at_mark_ || now_.velocity[i] != 0) return {};
  goes_ = false;
  ++next_;
  return {.found = ++found_};
}

void HomeSearch::move() noexcept {
  const std::optional<std::size_t> goes = looking();
  for (Eigen::Index i = 0; i < now_.position.size(); ++i) {
    const Way& way = ways_[static_cast<std::size_t>(i)];
    const double wanted = goes == static_cast<std::size_t>(i) ? way.speed : 0, before = now_.velocity[i];
    const double step = std::abs(way.speed) * (cycle_s_ / changes_speed_s);
    now_.velocity[i] += std::clamp(wanted - before, -step, step);
    now_.acceleration[i] = (now_.velocity[i] - before) / cycle_s_;
    now_.position[i] += now_.velocity[i] * cycle_s_;
  }
}

HomeSearch::News HomeSearch::advance(const Sees& sees) noexcept {
  const std::optional<std::size_t> lost = follow_zeros(sees);
  News news;
  if (looks_ && sees.presses) {
    looks_ = false;
    yields_s_ = lets_go_s;
    news = {.end = End::Presses, .joint = *sees.presses};
  } else if (looks_ && lost) {
    looks_ = false;
    news = {.end = End::Lost, .joint = *lost};
  } else if (looks_) {
    news = search(sees);
  }
  if (yields_s_ > 0) {
    yields_s_ -= cycle_s_;
    stand_at(sees.measured.position);
  } else {
    move();
  }
  remember(sees);
  return news;
}

}  // namespace hirosco::robot_arm
