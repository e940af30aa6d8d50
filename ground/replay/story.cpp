// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <vector>

#include "ground/model/json.hpp"
#include "ground/replay/missed_cycles.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::ground {
namespace {

using descriptor::Severity;
using descriptor::State;
using nlohmann::json;

/// What happens within it of the event before belongs to the same story.
constexpr Duration same_story = 3s;
constexpr Duration looked_back = 2s;
/// Two periods of the slowest cycles of a control loop.
constexpr Duration same_instant = 2ms;
/// An injected fault is timed by its answer, which may come later than the event that it causes.
constexpr Duration answer_delay = 500ms;

/// "SafeOperational" -> "Safe-Operational", as the paper writes the states.
[[nodiscard]] std::string state_words(std::string_view state) {
  std::string words;
  for (const char letter : state) {
    if (letter >= 'A' && letter <= 'Z' && !words.empty()) words += '-';
    words += letter;
  }
  return words;
}

/// "A", "A and B", "A, B and C".
[[nodiscard]] std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

[[nodiscard]] std::string milliseconds(Duration span) {
  const double ms = 1e3 * seconds(span);
  return ms < 10     ? fmt::format("{:.1f} ms", ms)
         : ms < 1000 ? fmt::format("{:.0f} ms", ms)
                     : fmt::format("{:.1f} s", ms / 1e3);
}

/// One line of the story. Lines of one `kind` are told in one, with all their `names`.
struct Line {
  std::optional<OnboardTime> t;  ///< empty: before the first, nobody knows how long
  Severity severity{Severity::Info};
  std::string kind;
  std::vector<std::string> names;
  std::string text;  ///< after the names
};

/// The first that belongs to the newest story; they come newest first.
[[nodiscard]] StoredEvent first_of(const std::vector<StoredEvent>& severe) {
  const StoredEvent* first = &severe.front();
  for (const StoredEvent& event : severe) {
    if (first->t - event.t > same_story) break;
    first = &event;
  }
  return *first;
}

/// A stop of everything that somebody asked for.
struct Asked {
  OnboardTime t{};
  std::string by;    ///< in a sentence: "By telecommand of NAME."
  std::string text;  ///< in the chain of causes
};

/// The newest one that was carried out, by telecommand or on the computer of the flight.
[[nodiscard]] std::optional<Asked> newest_asked(Archive& archive, const std::vector<StoredEvent>& weighty,
                                                OnboardTime to) {
  std::optional<Asked> newest;
  for (const auto& command : archive.commands({.span = {{}, to}, .text = "SAFE_ALL", .limit = 20})) {
    // Who does not confirm its stop makes it fail, and everybody was stopped all the same.
    const bool carried_out =
        command.stage != "failed" || command.code == static_cast<int>(pus::FailureCode::DeviceError);
    if (command.function != "SAFE_ALL" || !carried_out) continue;
    newest = {command.t, "By telecommand of " + command.sender + ".",
              "SAFE ALL by " + command.sender + ", " + command.stage};
    break;
  }
  const auto local = std::ranges::find(weighty, descriptor::event_of_local_stop, &StoredEvent::name);
  if (local == weighty.end() || (newest && newest->t > local->t)) return newest;
  return Asked{local->t, "On the computer of the flight: `hirosco safe`, a key or a signal.",
               "SAFE ALL on the computer of the flight"};
}

/// Who is to be up in this mode, and whose process does not run at the end of what is known until `to`.
[[nodiscard]] std::vector<std::string> down_at_the_end(const Catalogue& catalogue, Archive& archive,
                                                       const std::string& mode, OnboardTime to) {
  const OnboardTime end = std::min(to, archive.extent().value_or(Span{}).to);
  std::map<std::string, bool> runs;
  for (const auto& change : archive.changes({end, end}))
    if (change.kind == "state") runs[change.name] = !change.value.empty();
  std::vector<std::string> down;
  const auto& modes = catalogue.mission().modes;
  const auto found = std::ranges::find(modes, mode, &descriptor::Mode::name);
  if (found == modes.end()) return down;
  for (const auto& step : found->commission)
    if (const auto known = runs.find(step.subsystem); known != runs.end() && !known->second)
      down.push_back(step.subsystem);
  return down;
}

/// The mode that brings it up again: a story may begin in one that commissions nobody.
[[nodiscard]] std::optional<std::string> mode_up(const descriptor::Mission& mission, const std::string& now) {
  const auto* mode = descriptor::mode_up(mission, now, mission.start_mode);
  return mode != nullptr ? std::optional{mode->name} : std::nullopt;
}

[[nodiscard]] std::string advice(const std::string& lost_device, std::uint32_t missed,
                                 const std::optional<std::string>& up) {
  if (!lost_device.empty() && missed != 0) return advice_for_missed(lost_device, missed, up);
  return (lost_device.empty() ? "Look into it" : "Mend or plug in the device " + lost_device) +
         (up ? ", then bring " + *up + " up." : ".");
}

/// An event has '_' where the name of a device, or of an endnode of one, has what an event may not.
[[nodiscard]] bool names(std::string_view in_event, std::string_view device) {
  return std::ranges::equal(in_event, device, [](char said, char meant) {
    return said == meant || (said == '_' && (meant == '.' || meant == '-'));
  });
}

[[nodiscard]] std::optional<double> number_in(const json& values, const char* name) {
  const auto found = values.is_object() ? values.find(name) : values.end();
  if (!values.is_object() || found == values.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}
[[nodiscard]] std::optional<State> state_in(const json& values) {
  const auto number = number_in(values, "STATE");
  if (!number || *number < 0 || *number > static_cast<double>(State::SoftwareDeinit)) return std::nullopt;
  return static_cast<State>(*number);
}

/// ": watchdog let go": the reason that the framework gives for a loss; its counters stand in the event.
[[nodiscard]] std::string loss(const json& values) {
  const auto reason = number_in(values, "REASON");
  if (!reason) return {};
  // As a person would say it.
  if (*reason == static_cast<double>(descriptor::DeviceLoss::HungUp)) return ": the connection was closed";
  const std::string_view text = to_text(static_cast<descriptor::DeviceLoss>(*reason));
  return text == "?" ? std::string{} : ": " + std::string{text};
}

/// "HAND_STATE (the newest is 4 cycles old)": the set of a framework's event that it is late; empty for every other event.
[[nodiscard]] std::string late_set(const StoredEvent& event, const json& values) {
  constexpr std::string_view late = "_STALE";
  const auto age = number_in(values, "AGE");
  if (!age || !event.name.ends_with(late)) return {};
  const std::string set = event.name.substr(0, event.name.size() - late.size());
  // One that was taken away has no age.
  return *age > 0 ? fmt::format("{} (the newest is {:.0f} cycles old)", set, *age) : set;
}

/// Beside a device that was lost: who did not run heard it late, and it let go by itself. How many cycles that were.
[[nodiscard]] std::uint32_t tell_missed(const Catalogue& catalogue, Archive& archive, const StoredEvent& lost,
                                        std::vector<Line>& lines) {
  const std::uint32_t missed = missed_around(catalogue, archive, lost.subsystem, lost.t);
  if (missed != 0) lines.push_back({{}, Severity::Info, "missed", {}, missed_words(lost.subsystem, missed)});
  return missed;
}

class Teller {
 public:
  Teller(const Catalogue& catalogue, Archive& archive) : catalogue_{catalogue}, archive_{archive} {}

  [[nodiscard]] json tell(OnboardTime to) {
    auto severe =
        archive_.events({.span = {{}, to}, .severity = static_cast<int>(Severity::Medium), .text = {}, .limit = 1000});
    const auto asked = newest_asked(archive_, severe, to);
    std::erase_if(severe, [](const StoredEvent& event) { return event.name == descriptor::event_of_local_stop; });
    if (severe.empty() && !asked) return {{"causes", json::array()}};
    if (asked && belongs_to(*asked, severe)) return told_by_hand(*asked, severe, to);
    cause_ = first_of(severe);
    begin_ = cause_.t;
    // Who notices a loss by its effect may report in the very cycle of who has lost: the gravest of one instant is the cause.
    for (const StoredEvent& event : severe)
      if (event.t >= begin_ && event.t - begin_ <= same_instant && event.severity > cause_.severity) cause_ = event;
    mode_ = mode_at(begin_);
    tell_faults();
    tell_events(to);
    tell_links();
    return finished();
  }

 private:
  /// Nothing else stopped after it: what came within the time of one story is what it brought about.
  [[nodiscard]] static bool belongs_to(const Asked& asked, const std::vector<StoredEvent>& severe) {
    const std::vector<StoredEvent> after{
        severe.begin(), std::ranges::find_if(severe, [&](const StoredEvent& event) { return event.t < asked.t; })};
    return after.empty() || first_of(after).t - asked.t <= same_story;
  }

  [[nodiscard]] json told_by_hand(const Asked& asked, const std::vector<StoredEvent>& severe, OnboardTime to) {
    begin_ = asked.t;
    mode_ = mode_at(begin_);
    lines_.push_back({begin_, Severity::High, "cause", {}, asked.text});
    // Who stops everything may do so because of something.
    for (const StoredEvent& event : severe | std::views::reverse)
      if (event.t < begin_ && begin_ - event.t <= same_story) {
        const std::string text = sentence(event, json::parse(event.values, nullptr, false));
        lines_.push_back({std::nullopt, static_cast<Severity>(event.severity), "event", {}, text});
      }
    tell_events(to);
    const auto up = mode_up(catalogue_.mission(), mode_);
    return {{"t", json_time(begin_)},
            {"title", "SAFE ALL: the actuators of all subsystems are inhibited."},
            {"detail", asked.by},
            {"advice", "Bring " + up.value_or("whom you need") + " up again when all is clear."},
            {"plan", nullptr},
            {"mode", mode_.empty() ? catalogue_.mission().start_mode : mode_},
            {"mode_up", up ? json(*up) : json(nullptr)},
            {"severity", "high"},
            {"stopped", json::array({"all"})},
            {"causes", causes_json()}};
  }

  [[nodiscard]] std::string mode_at(OnboardTime t) {
    std::string mode;
    for (const auto& change : archive_.changes({t, t}))
      if (change.kind == "mode" && change.t <= t) mode = change.value;
    return mode;
  }

  void tell_faults() {
    std::size_t steps_of_hand = 0;
    std::vector<Line> found;
    for (const auto& fault : archive_.faults({begin_ - looked_back, begin_ + answer_delay})) {
      if (fault.answer != "ok") continue;
      if (fault.line.starts_with("hand ")) {
        ++steps_of_hand;
        continue;
      }
      found.push_back({.t = {},
                       .kind = "fault",
                       .names = {},
                       .text = fmt::format("Fault injected: {} {}", fault.device, fault.line)});
    }
    // The hand is of interest where nothing else was done.
    if (found.empty() && steps_of_hand > 0)
      found.push_back(
          {.t = {},
           .kind = "hand",
           .names = {},
           .text = steps_of_hand == 1 ? "The hand moved" : fmt::format("The hand moved ({} steps)", steps_of_hand)});
    lines_.insert(lines_.end(), found.begin(), found.end());
  }

  void tell_events(OnboardTime to) {
    const OnboardTime end = std::min(to, begin_ + 4 * same_story);
    OnboardTime last = begin_;
    for (const auto& event :
         archive_.events({.span = {begin_, end}, .text = {}, .limit = 1000, .newest_first = false})) {
      if (event.t - last > same_story) break;
      if (event.name == descriptor::event_of_local_stop) continue;  // told as the cause
      const auto severity = static_cast<Severity>(event.severity);
      const auto values = json::parse(event.values, nullptr, false);
      if (event.name == "STATE_CHANGED") {
        const auto state = state_in(values);
        if (!state) continue;
        // Who comes up again has begun another story.
        if (*state != State::Operational && *state <= State::PreOperational && *state != State::Offline) break;
        if (*state == State::Operational) break;
        finally_[event.subsystem] = *state;
        down_ = std::max(down_, event.t);
        if (*state > State::ErrorOperational) continue;  // passed through
        lines_.push_back({event.t,
                          severity,
                          "state " + std::string{to_text(*state)},
                          {event.subsystem},
                          " → " + state_words(to_text(*state))});
      } else if (event.name == "RECOVERY_STEP") {
        const auto state = state_in(values);
        const auto apid = number_in(values, "APID");
        if (!state || !apid) continue;
        lines_.push_back({event.t,
                          severity,
                          "plan " + std::string{to_text(*state)},
                          {catalogue_.name_of(static_cast<std::uint16_t>(*apid))},
                          fmt::format(": plan {} wants {}", plan(), state_words(to_text(*state)))});
      } else if (severity >= Severity::Medium) {
        last = event.t;
        const bool is_cause = event.t == cause_.t && event.id == cause_.id && event.subsystem == cause_.subsystem;
        lines_.push_back({event.t, severity, is_cause ? "cause" : "event", {}, sentence(event, values)});
      }
    }
  }

  void tell_links() {
    std::vector<std::string> names;
    OnboardTime t{};
    for (const auto& change : archive_.changes({begin_, begin_ + same_story})) {
      if (change.kind != "link" || change.value != "down" || change.t <= begin_) continue;
      if (std::ranges::find(names, change.name) != names.end()) continue;
      if (names.empty()) t = change.t;
      names.push_back(change.name);
    }
    if (names.empty()) return;
    const std::string text = (names.size() == 1 ? "Link " : "Links ") + listed(names) + " down, as housekeeping tells";
    lines_.push_back({t, Severity::Info, "link", {}, text});
  }

  /// As the supervisor chooses: the most specific plan, of equal ones the first (event, subsystem, mode, severity).
  [[nodiscard]] std::string plan() const {
    const descriptor::Plan* best = nullptr;
    int best_score = -1;
    for (const auto& one : catalogue_.mission().plans) {
      const auto severity = static_cast<Severity>(cause_.severity);
      const bool fits = (one.event.empty() || one.event == cause_.name) &&
                        (one.subsystem.empty() || one.subsystem == cause_.subsystem) &&
                        (one.mode.empty() || one.mode == mode_) &&
                        (one.severities.empty() || std::ranges::find(one.severities, severity) != one.severities.end());
      const int score = (one.event.empty() ? 0 : 8) + (one.subsystem.empty() ? 0 : 4) + (one.mode.empty() ? 0 : 2) +
                        (one.severities.empty() ? 0 : 1);
      if (!fits || score <= best_score) continue;
      best = &one;
      best_score = score;
    }
    return best != nullptr ? best->name : "default";
  }

  /// The device of a subsystem whose loss an event tells; empty when it is another event.
  [[nodiscard]] std::string lost_device(const StoredEvent& event) const {
    constexpr std::string_view ending = "_LOST";
    const auto* subsystem = catalogue_.find(std::string_view{event.subsystem});
    if (subsystem == nullptr || !event.name.ends_with(ending)) return {};
    const std::string name = event.name.substr(0, event.name.size() - ending.size());
    const auto found = std::ranges::find_if(subsystem->devices,
                                            [&](const descriptor::Device& device) { return names(name, device.name); });
    return found != subsystem->devices.end() ? found->name : std::string{};
  }

  /// "JOINT 2, VALUE 12.3 N m": arguments with their units.
  [[nodiscard]] std::string arguments(const StoredEvent& event, const json& values) const {
    std::string text;
    const auto* subsystem = catalogue_.find(std::string_view{event.subsystem});
    if (subsystem == nullptr) return text;
    const auto described = std::ranges::find(subsystem->events, event.id, &descriptor::Event::id);
    if (described == subsystem->events.end()) return text;
    for (const auto& argument : described->arguments) {
      if (argument.text) {
        const auto words = values.find(argument.name);
        if (words == values.end() || !words->is_string()) continue;
        text +=
            fmt::format("{}{} '{}'", text.empty() ? "" : ", ", lower_case(argument.name), words->get<std::string>());
        continue;
      }
      const auto value = number_in(values, argument.name.c_str());
      if (!value) continue;
      // The text of the event has the names of enumerations.
      const std::string marker = argument.name + "=";
      const auto at = event.text.find(marker);
      const bool named = at != std::string::npos && at + marker.size() < event.text.size() &&
                         std::isalpha(static_cast<unsigned char>(event.text[at + marker.size()])) != 0;
      const auto rest = named ? event.text.substr(at + marker.size()) : std::string{};
      if (argument.name == "APID") {
        text += (text.empty() ? "" : ", ") + catalogue_.name_of(static_cast<std::uint16_t>(*value));
        continue;
      }
      const std::string shown = named ? lower_case(rest.substr(0, rest.find(' '))) : fmt::format("{:.4g}", *value);
      text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", lower_case(argument.name), shown,
                          argument.unit.empty() ? "" : " ", argument.unit);
    }
    return text;
  }

  [[nodiscard]] std::string sentence(const StoredEvent& event, const json& values) const {
    const auto apid = number_in(values, "APID");
    if (apid && event.name == "PROCESS_DIED")
      return fmt::format("The process of {} died", catalogue_.name_of(static_cast<std::uint16_t>(*apid)));
    if (apid && event.name == "HANG")
      return fmt::format("{} does not cycle any more", catalogue_.name_of(static_cast<std::uint16_t>(*apid)));
    if (const auto set = late_set(event, values); !set.empty()) return event.subsystem + " misses samples of " + set;
    const std::string more = arguments(event, values);
    const std::string device = lost_device(event);
    if (!device.empty())
      return event.subsystem + " lost its device" + (device == event.subsystem ? "" : " " + device) + loss(values);
    std::string words = lower_case(event.name);
    std::ranges::replace(words, '_', ' ');
    return event.subsystem + ": " + words + (more.empty() ? "" : " (" + more + ")");
  }

  /// Lines in order of time as JSON; those of one kind are told in one: a state when all have reached it, a plan when it began.
  [[nodiscard]] json causes_json() {
    std::vector<Line> told;
    for (const Line& line : lines_) {
      const auto same = std::ranges::find(told, line.kind, &Line::kind);
      if (line.names.empty() || same == told.end()) {
        told.push_back(line);
        continue;
      }
      if (std::ranges::find(same->names, line.names.front()) == same->names.end())
        same->names.push_back(line.names.front());
      if (line.kind.starts_with("state ")) same->t = std::max(same->t, line.t);
    }
    // The cause first; at one instant the event stands before what it brought about.
    std::ranges::stable_sort(told, {}, [&](const Line& line) {
      return std::pair{line.kind == "cause" ? begin_ : line.t.value_or(OnboardTime{}), line.kind == "cause"   ? 0
                                                                                       : line.kind == "event" ? 1
                                                                                                              : 2};
    });
    json causes = json::array();
    for (const Line& line : told)
      causes.push_back({{"t", json_time(line.t.value_or(begin_))},
                        {"after_ms", line.t ? json(1e3 * seconds(*line.t - begin_)) : json(nullptr)},
                        {"severity", to_text(line.severity)},
                        {"text", listed(line.names) + line.text}});
    return causes;
  }

  /// "ARM and HAND went Offline": who of those who flew ended where.
  [[nodiscard]] std::string who_went() const {
    std::map<State, std::vector<std::string>> by_state;
    for (const auto& [name, state] : finally_) by_state[state].push_back(name);
    std::vector<std::string> parts;
    for (const auto& [state, names] : by_state) parts.push_back(listed(names) + " went " + state_words(to_text(state)));
    return listed(parts);
  }

  [[nodiscard]] std::vector<std::string> still_well() {
    std::map<std::string, std::string> states;
    for (const auto& change : archive_.changes({begin_, begin_ + same_story}))
      if (change.kind == "state") states[change.name] = change.value;
    std::vector<std::string> well;
    for (const auto& [name, state] : states)
      if (state == to_text(State::Operational) && !finally_.contains(name)) well.push_back(name);
    return well;
  }

  [[nodiscard]] json finished() {
    const auto missed = lost_device(cause_).empty() ? 0U : tell_missed(catalogue_, archive_, cause_, lines_);
    const auto values = json::parse(cause_.values, nullptr, false);
    std::vector<std::string> stopped;
    for (const auto& [name, state] : finally_) stopped.push_back(name);
    std::string title = sentence(cause_, values) + ".";
    if (!stopped.empty()) title += " " + listed(stopped) + (stopped.size() == 1 ? " was stopped." : " were stopped.");
    std::string detail;
    if (!stopped.empty())
      detail = fmt::format("{} within {}, by plan {}.", who_went(), milliseconds(down_ - begin_), plan());
    if (const auto well = still_well(); !well.empty())
      detail += (detail.empty() ? "" : " ") + listed(well) + (well.size() == 1 ? " goes on." : " go on.");
    const auto up = mode_up(catalogue_.mission(), mode_);
    return {{"t", json_time(begin_)},
            {"title", std::move(title)},
            {"detail", detail},
            {"advice", advice(lost_device(cause_), missed, up)},
            {"plan", plan()},
            {"mode", mode_.empty() ? catalogue_.mission().start_mode : mode_},
            {"mode_up", up ? json(*up) : json(nullptr)},
            {"severity", to_text(static_cast<Severity>(cause_.severity))},
            {"stopped", stopped},
            {"causes", causes_json()}};
  }

  const Catalogue& catalogue_;
  Archive& archive_;
  OnboardTime begin_{};
  OnboardTime down_{};
  StoredEvent cause_;
  std::string mode_;
  std::map<std::string, State> finally_;
  std::vector<Line> lines_;
};

}  // namespace

json newest_story(const Catalogue& catalogue, Archive& archive, OnboardTime to) {
  json story = Teller{catalogue, archive}.tell(to);
  if (!story["causes"].empty())
    story["down"] =
        story["mode_up"].is_null() ? json::array() : json(down_at_the_end(catalogue, archive, story["mode_up"], to));
  return story;
}

}  // namespace hirosco::ground
