// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/screen_model.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::terminal {
namespace {

using nlohmann::json;

[[nodiscard]] std::string text_in(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? printable_words(found->get<std::string>()) : std::string{};
}
[[nodiscard]] bool flag_in(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}
template <class Number>
[[nodiscard]] Number number_in(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number() ? found->get<Number>() : Number{};
}
/// Of what is no list: nothing.
[[nodiscard]] json list_in(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_array() ? *found : json::array();
}

[[nodiscard]] Overview overview_in(const json& told) {
  Overview overview{.mission = text_in(told, "mission"),
                    .mode = text_in(told, "mode"),
                    .initial_mode = text_in(told, "initial_mode"),
                    .usual_mode = text_in(told, "usual_mode"),
                    .waits_for = text_in(told, "waits_for"),
                    .members = {},
                    .links = {}};
  for (const json& one : list_in(told, "members")) {
    if (!one.is_object()) continue;
    Overview::Member member{.name = text_in(one, "name"),
                            .runs = flag_in(one, "runs"),
                            .state = text_in(one, "state"),
                            .wanted = text_in(one, "wanted")};
    member.counted = one.contains("cycles");
    member.cycling = flag_in(one, "cycling");
    member.realtime = flag_in(one, "realtime");
    member.inhibited = number_in<std::uint32_t>(one, "inhibited");
    member.period_ns = number_in<std::uint64_t>(one, "period_ns");
    member.cycles = number_in<std::uint64_t>(one, "cycles");
    member.overruns = number_in<std::uint64_t>(one, "overruns");
    member.missed = number_in<std::uint64_t>(one, "missed");
    member.latency_max_ns = number_in<std::uint32_t>(one, "latency_max_ns");
    member.execution_mean_ns = number_in<std::uint32_t>(one, "execution_mean_ns");
    overview.members.push_back(std::move(member));
  }
  for (const json& one : list_in(told, "links")) {
    if (!one.is_object()) continue;
    overview.links.push_back({.id = number_in<std::uint8_t>(one, "id"),
                              .from = text_in(one, "from"),
                              .to = text_in(one, "to"),
                              .up = flag_in(one, "up"),
                              .wanted = flag_in(one, "wanted")});
  }
  return overview;
}

/// "ARM high TORQUE_LIMIT_EXCEEDED ...": an event has its severity behind who tells it.
[[nodiscard]] Severity severity_of(std::string_view line) {
  const std::size_t begin = line.find(' ');
  if (begin == std::string_view::npos) return Severity::Info;
  const std::string_view word = line.substr(begin + 1, line.find(' ', begin + 1) - begin - 1);
  return from_text<Severity>(word).value_or(Severity::Info);
}

}  // namespace

Key take_key(std::string_view& octets) {
  constexpr std::array<std::pair<std::string_view, Key>, 6> sequences{{{"\x1b[A", Key::Up},
                                                                       {"\x1b[B", Key::Down},
                                                                       {"\x1b[5~", Key::PageUp},
                                                                       {"\x1b[6~", Key::PageDown},
                                                                       {"\x1b[F", Key::Newest},
                                                                       {"\x1b[4~", Key::Newest}}};
  for (const auto& [sequence, key] : sequences)
    if (octets.starts_with(sequence)) {
      octets.remove_prefix(sequence.size());
      return key;
    }
  const char first = octets.front();
  octets.remove_prefix(1);
  switch (first) {
    case 'q': return Key::End;
    case 'e': return Key::Filter;
    case 'S': return Key::Stop;
    case 'L' - '@': return Key::Redraw;
    case '\x1b': {
      // Of a key that is not ours nothing is left that would count as another one.
      if (!octets.starts_with('[')) return Key::Other;
      const auto end = std::ranges::find_if(octets.substr(1), [](char c) { return c >= '@' && c <= '~'; });
      octets.remove_prefix(std::min(octets.size(), static_cast<std::size_t>(end - octets.begin()) + 1));
      return Key::Other;
    }
    default: return Key::Other;
  }
}

void ScreenModel::add(ScreenEvent event) {
  if (event.text.size() > longest_text) event.text.resize(longest_text);
  event.text = printable_words(event.text);
  if (event.severity >= Severity::Medium) {
    ++grave_;
    if (!gravest_ || event.severity >= gravest_->severity) gravest_ = event;
  }
  if (scrolled_ != 0 && admits(event)) ++scrolled_;  // what is looked at stays where it is
  events_.push_back(std::move(event));
  if (events_.size() <= most_events) return;
  events_.pop_front();
  scrolled_ = std::min(scrolled_, events_.size());
}

void ScreenModel::take(std::string_view line) {
  if (line.empty()) return;
  const json told = line.front() == '{' ? json::parse(line, nullptr, false) : json{};
  if (line.front() == '{' && !told.is_object()) return;  // of a process that was killed while it wrote
  if (!told.is_object()) {
    errors_.emplace_back(printable_words(line.substr(0, longest_text)));
    if (errors_.size() > most_errors) errors_.pop_front();
    return add({.at_s = {}, .severity = Severity::Low, .text = std::string{line}});
  }
  if (told.contains("told")) {
    const std::string text = text_in(told, "told");
    if (text == "shutdown" || text.starts_with("shutdown, ")) ends_ = true;  // whoever asked for it
    return add({.at_s = number_in<double>(told, "at_s"), .severity = severity_of(text), .text = text});
  }
  if (told.contains("held")) return add({.at_s = {}, .severity = Severity::Info, .text = text_in(told, "held")});
  if (told.contains("url")) {
    url_ = text_in(told, "url");
    observer_url_ = text_in(told, "observer_url");
    return;
  }
  if (!told.contains("members")) return;
  overview_ = overview_in(told);
  up_s_ = number_in<double>(told, "up_s");
  ++heard_;
  if (!ends_) at_work_ = overview_;
  values_.clear();
  for (const json& one : list_in(told, "values"))
    if (one.is_array() && one.size() == 2 && one[0].is_string() && one[1].is_string())
      values_.emplace_back(printable_words(one[0].get<std::string>()), printable_words(one[1].get<std::string>()));
}

Wish ScreenModel::press(Key key, std::size_t page_rows) {
  if (std::exchange(asks_, false)) {
    if (key != Key::End) return Wish::None;
    ends_ = true;
    return Wish::EndFlight;
  }
  const auto seen =
      static_cast<std::size_t>(std::ranges::count_if(events_, [&](const ScreenEvent& event) { return admits(event); }));
  const std::size_t furthest = seen - std::min(seen, page_rows);
  switch (key) {
    case Key::End: asks_ = !ends_; break;
    case Key::Filter:
      only_low_and_up_ = !only_low_and_up_;
      scrolled_ = 0;
      break;
    case Key::Stop: return Wish::StopActuators;
    case Key::Up: scrolled_ = std::min(scrolled_ + 1, furthest); break;
    case Key::Down: scrolled_ -= std::min<std::size_t>(scrolled_, 1); break;
    case Key::PageUp: scrolled_ = std::min(scrolled_ + page_rows, furthest); break;
    case Key::PageDown: scrolled_ -= std::min(scrolled_, page_rows); break;
    case Key::Newest: scrolled_ = 0; break;
    case Key::Redraw: return Wish::DrawAnew;
    case Key::None:
    case Key::Other: break;
  }
  return Wish::None;
}

}  // namespace hirosco::terminal
