// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/authority.hpp"

#include <algorithm>

#include "ground/model/json.hpp"

namespace hirosco::ground {

Answered<void> Authority::may_command(const Seat& seat, const Now& now) {
  if (!holder_) {
    // Who is alone never notices; a script without a seat neither takes it nor needs it.
    if (!seat.id.empty()) give(seat, "took", now);
    return {};
  }
  if (holder_->seat.id != seat.id)
    return refuse(409, holder_->seat.name + " commands: ask for the command, or wait until it is handed over");
  holder_->acted = holder_->seen = now.ground;
  return {};
}

Answered<void> Authority::take(const Seat& seat, const Now& now) {
  if (seat.id.empty() || seat.id.size() > longest_seat) return refuse(400, "seat: 1 to 64 characters are wanted");
  if (!holder_) {
    give(seat, "took", now);
    return {};
  }
  if (holder_->seat.id == seat.id) {
    holder_->acted = holder_->seen = now.ground;
    return {};
  }
  if (asking_ && asking_->seat.id != seat.id) return refuse(409, asking_->seat.name + " asks for the command already");
  if (asking_) return {};
  asking_ = Asking{.seat = seat, .since = now.ground};
  did("asked", seat, holder_->seat.name, now);
  return {};
}

Answered<void> Authority::keep(const Seat& seat, const Now& now) {
  if (const auto is = expect_holder(seat); !is) return is;
  holder_->acted = holder_->seen = now.ground;
  if (!asking_) return {};
  const std::string refused = asking_->seat.name;
  asking_.reset();
  did("kept", holder_->seat, refused, now);
  return {};
}

Answered<void> Authority::hand_over(const Seat& seat, const Now& now) {
  if (const auto is = expect_holder(seat); !is) return is;
  if (asking_) {
    give(Seat{asking_->seat}, "was handed", now);
    return {};
  }
  const Seat before = holder_->seat;
  holder_.reset();
  did("laid down", before, "", now);
  return {};
}

void Authority::see(std::set<std::string> present, const Now& now) {
  if (!holder_) return;
  if (present.contains(holder_->seat.id)) holder_->seen = now.ground;
  const bool idle = now.ground - holder_->acted > idle_limit;
  const bool absent = now.ground - holder_->seen > absence_limit;
  const bool silent = asking_ && now.ground - asking_->since > answer_limit;
  if (!idle && !absent && !silent) return;
  // Who asked and has gone meanwhile gets nothing.
  if (asking_ && (silent || absent || idle)) {
    const Seat next = asking_->seat;
    if (present.contains(next.id)) return give(next, "was left", now);
    asking_.reset();
    if (silent && !idle && !absent) return did("no longer asks", next, "", now);
  }
  const Seat before = holder_->seat;
  holder_.reset();
  did(absent ? "was away" : "was idle", before, "", now);
}

void Authority::give(const Seat& seat, std::string_view action, const Now& now) {
  const std::string before = holder_ ? holder_->seat.name : "";
  const Seat to{seat.id.substr(0, longest_seat), seat.name.substr(0, longest_name)};
  holder_ = Holder{.seat = to, .since = now.onboard, .acted = now.ground, .seen = now.ground};
  asking_.reset();
  did(action, to, before, now);
}

void Authority::did(std::string_view action, const Seat& who, const std::string& note, const Now& now) {
  did_({.t = now.onboard,
        .kind = "authority",
        .name = "",
        .action = std::string{action},
        .who = who.name,
        .note = note});
}

Answered<void> Authority::expect_holder(const Seat& seat) const {
  if (holder_ && holder_->seat.id == seat.id && !seat.id.empty()) return {};
  return refuse(409, holder_ ? holder_->seat.name + " commands" : "nobody commands");
}

nlohmann::json Authority::json(TimePoint now) const {
  nlohmann::json result{{"holder", nullptr}, {"asking", nullptr}};
  if (holder_)
    result["holder"] = {{"seat", holder_->seat.id}, {"name", holder_->seat.name}, {"since", json_time(holder_->since)}};
  if (asking_)
    result["asking"] = {{"seat", asking_->seat.id},
                        {"name", asking_->seat.name},
                        {"answer_s", std::max(0.0, seconds(answer_limit - (now - asking_->since)))}};
  return result;
}

}  // namespace hirosco::ground
