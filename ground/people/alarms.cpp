// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/alarms.hpp"

#include <algorithm>
#include <cstdlib>
#include <ranges>

#include "ground/model/json.hpp"
#include "ground/model/views.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// Instead of one alarm.
constexpr const char* everything = "*";

[[nodiscard]] std::string name_of(std::uint16_t apid, std::uint16_t event) {
  return std::to_string(apid) + "/" + std::to_string(event);
}

[[nodiscard]] json act_json(const std::optional<Alarms::Act>& act) {
  if (!act) return nullptr;
  json result{{"t", json_time(act->t)}, {"who", act->who}, {"note", act->note}};
  if (act->until != OnboardTime{}) result["until"] = json_time(act->until);
  return result;
}

/// Whether it calls somebody.
[[nodiscard]] bool calls(const Alarms::Alarm& alarm) { return alarm.fresh > 0 && !alarm.shelved; }

[[nodiscard]] json alarm_json(const Alarms::Alarm& alarm) {
  json result = event_json(alarm.newest);
  result["first"] = json_time(alarm.first);
  result["count"] = alarm.count;
  result["fresh"] = alarm.fresh;
  result["calls"] = calls(alarm);
  result["acknowledged"] = act_json(alarm.acknowledged);
  result["shelved"] = act_json(alarm.shelved);
  return result;
}

}  // namespace

Alarms::Alarms(Archive& archive, OnboardTime began) : archive_{archive} { begin(began); }

void Alarms::begin(OnboardTime began) {
  alarms_.clear();
  seen_until_ = {};
  constexpr std::size_t most_events = 100'000;
  const auto events = archive_.events(
      {.span = {.from = began}, .severity = lowest_severity, .text = {}, .limit = most_events, .newest_first = true});
  const auto marks = archive_.marks("alarm", {.from = began});
  auto mark = marks.begin();
  for (const StoredEvent& event : events | std::views::reverse) {
    for (; mark != marks.end() && mark->t < event.t; ++mark) apply(*mark);
    note(event);
  }
  for (; mark != marks.end(); ++mark) apply(*mark);
}

void Alarms::note(const StoredEvent& event) {
  const Key key{event.apid, event.id};
  if (!alarms_.contains(key) && alarms_.size() >= most_alarms) return;
  Alarm& alarm = alarms_[key];
  // What was missed is heard late.
  if (alarm.count == 0 || event.t < alarm.first) alarm.first = event.t;
  if (alarm.count == 0 || event.t >= alarm.newest.t) alarm.newest = event;
  ++alarm.count;
  ++alarm.fresh;
}

void Alarms::apply(const StoredMark& mark) {
  const Act act{.t = mark.t, .who = mark.who, .note = mark.note, .until = mark.until};
  if (mark.name == everything) {
    seen_until_ = mark.t;
    for (auto& [key, alarm] : alarms_) {
      if (alarm.fresh == 0) continue;
      alarm.fresh = 0;
      alarm.acknowledged = act;
    }
    return;
  }
  const auto slash = mark.name.find('/');
  if (slash == std::string::npos) return;
  const auto found = alarms_.find({static_cast<std::uint16_t>(std::atoi(mark.name.c_str())),
                                   static_cast<std::uint16_t>(std::atoi(mark.name.c_str() + slash + 1))});
  if (found == alarms_.end()) return;
  Alarm& alarm = found->second;
  if (mark.action == "acknowledge") {
    alarm.fresh = 0;
    alarm.acknowledged = act;
  }
  if (mark.action == "shelve") alarm.shelved = act;
  if (mark.action == "unshelve" || mark.action == "shelf over") alarm.shelved.reset();
}

std::optional<json> Alarms::hear(const StoredEvent& event) {
  if (event.severity < lowest_severity) return std::nullopt;
  note(event);
  const auto found = alarms_.find({event.apid, event.id});
  return found != alarms_.end() ? std::optional{alarm_json(found->second)} : std::nullopt;
}

Answered<json> Alarms::act(const json& body, const std::string& who, OnboardTime now) {
  const std::string subsystem = text_of(body, "subsystem"), event = text_of(body, "event");
  const std::string action = text_of(body, "action");
  if (action != "acknowledge" && action != "shelve" && action != "unshelve")
    return refuse(400, "action: acknowledge, shelve or unshelve is wanted");
  const bool all = subsystem == everything;
  if (all && action != "acknowledge") return refuse(400, "action: all are acknowledged, or nothing else");
  const auto found = std::ranges::find_if(alarms_, [&](const auto& entry) {
    return entry.second.newest.subsystem == subsystem && entry.second.newest.name == event;
  });
  if (found == alarms_.end() && !all)
    return refuse(404, "no alarm " + event + " of '" + subsystem + "' in this flight");
  StoredMark mark{.t = now,
                  .kind = "alarm",
                  .name = all ? everything : name_of(found->first.first, found->first.second),
                  .action = action,
                  .who = who,
                  .note = text_of(body, "note")};
  if (mark.note.size() > longest_note) return refuse(400, "note: at most 200 characters are wanted");
  if (action == "shelve") {
    const auto given = body.find("for_s");
    const double for_s = given != body.end() && given->is_number() ? given->get<double>() : 0.0;
    if (!(for_s >= 1.0 && for_s <= seconds(longest_shelf)))
      return refuse(400, "for_s: 1 to 86400 seconds are wanted, after which it calls again");
    mark.until = now + Duration{static_cast<std::int64_t>(for_s * 1e9)};
  }
  archive_.add(mark);
  archive_.commit();
  apply(mark);
  return all ? list() : alarm_json(found->second);
}

std::vector<json> Alarms::expire(OnboardTime now) {
  std::vector<json> changed;
  for (auto& [key, alarm] : alarms_) {
    if (!alarm.shelved || now < alarm.shelved->until) continue;
    archive_.add(StoredMark{.t = now,
                            .kind = "alarm",
                            .name = name_of(key.first, key.second),
                            .action = "shelf over",
                            .who = alarm.shelved->who,
                            .note = alarm.shelved->note});
    alarm.shelved.reset();
    changed.push_back(alarm_json(alarm));
  }
  return changed;
}

json Alarms::list() const {
  std::vector<const Alarm*> sorted;
  for (const auto& entry : alarms_) sorted.push_back(&entry.second);
  std::ranges::sort(sorted, [](const Alarm* one, const Alarm* other) {
    if (calls(*one) != calls(*other)) return calls(*one);
    if (one->newest.severity != other->newest.severity) return one->newest.severity > other->newest.severity;
    return one->newest.t > other->newest.t;
  });
  json alarms = json::array();
  for (const Alarm* alarm : sorted) alarms.push_back(alarm_json(*alarm));
  return {{"alarms", std::move(alarms)},
          {"seen_until", seen_until_ != OnboardTime{} ? json(json_time(seen_until_)) : json(nullptr)}};
}

}  // namespace hirosco::ground
