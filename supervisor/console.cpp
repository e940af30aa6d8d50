// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/console.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace hirosco::supervisor {
namespace {

constexpr Duration writer_patience = 500ms;
/// Of what one speaker may say, and of counts that rise all the time.
constexpr Duration turn = 1s;
constexpr Duration counts_turn = 10s;

[[nodiscard]] std::string value_text(const pus::HousekeepingValue& value, int decimals) {
  std::string text;
  if (is_carried(value.type))
    for (const double number : value.values)
      text += fmt::format("{}{:+.{}f}", text.empty() ? "" : ", ", number, decimals);
  else
    for (const std::string& words : value.texts()) text += (text.empty() ? "" : ", ") + words;
  return "(" + text + ")";
}

}  // namespace

Console::Console(const descriptor::Mission& mission, Style style, std::FILE* terminal)
    : mission_{mission}, style_{style}, terminal_{terminal} {
  for (const auto& member : mission.subsystems)
    decoders_.emplace(member.subsystem.id, pus::HousekeepingDecoder{member.subsystem});
  if (style != Style::Quiet) writer_ = std::thread{[this] { write_lines(); }};
}

Console::~Console() {
  tell_held();
  {
    const std::lock_guard guard{mutex_};
    ending_ = true;
  }
  wake_.notify_all();
  if (writer_.joinable()) writer_.join();
}

void Console::told(OnboardTime when, std::string_view line) {
  if (first_ == OnboardTime{}) first_ = when;
  if (!limit_.admit(line.substr(0, line.find(' ')))) return;  // it is in the log
  const double at_s = seconds(when - first_);
  if (style_ == Style::Json || style_ == Style::Screen)
    print(fmt::format("{{\"at_s\":{:.4f},\"told\":{}}}\n", at_s, json_string(line)));
  else print(fmt::format("{:9.4f} s  {}\n", at_s, shown(line)));
}

void Console::routed(const pus::TelemetryView& packet) {
  if (packet.service() != 3 || packet.subtype() != 25) return;
  const auto decoder = decoders_.find(packet.apid());
  if (decoder == decoders_.end()) return;
  const auto values = decoder->second.decode(packet.source_data());
  if (!values) return;
  const std::string& name = mission_.find_subsystem(packet.apid())->subsystem.name;
  for (const auto& value : *values) values_[name + "." + value.name] = value;
}

/// A speaker is the first word of a line: a subsystem's name where it tells an event.
void Console::tell_held() {
  for (const auto& [speaker, lines] : limit_.turn()) {
    print(held_text(fmt::format("{}: {} more lines in this second are in the log only", speaker, lines)));
  }
}

std::string Console::held_text(const std::string& line) const {
  return style_ == Style::Json || style_ == Style::Screen ? fmt::format("{{\"held\":{}}}\n", json_string(line))
                                                          : fmt::format("{:>12}{}\n", "", shown(line));
}

void Console::show(const Overview& overview, Duration since_start) {
  if (since_start >= next_turn_) {
    next_turn_ = since_start + turn;
    tell_held();
  }
  switch (style_) {
    case Style::Json: return print(status_json(overview, since_start));
    case Style::Screen: return print(json_of(overview, seconds(since_start), shown_values()) + "\n");
    case Style::Text: return tell_changes(overview, since_start);
    case Style::Quiet: return;
  }
}

std::vector<std::pair<std::string, std::string>> Console::shown_values() const {
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& item : mission_.console)
    if (const auto value = values_.find(item.parameter); value != values_.end())
      values.emplace_back(item.label,
                          value_text(value->second, item.decimals) + (item.unit.empty() ? "" : " " + item.unit));
  return values;
}

/// States, modes and links are told when they change, cycles that were missed or took too long in turns of their own.
void Console::tell_changes(const Overview& overview, Duration since_start) {
  std::string changes;
  const auto change = [&](const std::string& what, std::string now) {
    std::string& before = standing_[what];
    if (before == now) return;
    if (!now.empty()) changes += (changes.empty() ? "" : "; ") + now;
    before = std::move(now);
  };
  change("mode", "mode " + std::string{shown(overview.mode)});
  const bool counts = since_start >= next_counts_;
  if (counts) next_counts_ = since_start + counts_turn;
  std::size_t up = 0;
  for (const Overview::Member& member : overview.members) {
    const std::string name{shown(member.name)};
    change(name, fmt::format("{} {}{}", name, member.state, member.inhibited != 0 ? ", inhibited" : ""));
    if (member.counted && member.cycles != 0) cycled_[member.name] = member;
    if (!counts || !member.counted) continue;
    change(name + " missed", member.missed == 0 ? "" : fmt::format("{} missed {} cycles", name, member.missed));
    change(name + " overruns", member.overruns == 0 ? "" : fmt::format("{} overran {} times", name, member.overruns));
  }
  for (const Overview::Link& link : overview.links) up += link.up ? 1U : 0U;
  change("links", overview.links.empty() ? "" : fmt::format("links {}/{}", up, overview.links.size()));
  change("waits", overview.waits_for.empty() ? "" : "waits for " + std::string{shown(overview.waits_for)});
  if (!changes.empty()) print(fmt::format("[{:6.1f} s] {}\n", seconds(since_start), changes));
}

void Console::ended() {
  if (style_ != Style::Text) return;
  for (const auto& [name, member] : cycled_)
    print(fmt::format("{}: {} cycles, {} missed, {} overran, {:.1f} us late at most{}\n", shown(name), member.cycles,
                      member.missed, member.overruns, member.latency_max_ns * 1e-3,
                      member.realtime ? "" : " (reduced promise: no real-time scheduling)"));
}

std::string Console::status_json(const Overview& overview, Duration since_start) const {
  std::size_t up = 0;
  for (const Overview::Link& link : overview.links) up += link.up ? 1U : 0U;
  std::string text = fmt::format("{{\"up_s\":{:.3f},\"mode\":{},\"links_up\":{},\"links_defined\":{},\"subsystems\":[",
                                 seconds(since_start), json_string(overview.mode), up, overview.links.size());
  bool first = true;
  for (const Overview::Member& member : overview.members) {
    text += fmt::format("{}{{\"name\":{},\"state\":{}", first ? "" : ",", json_string(member.name),
                        json_string(member.state));
    if (member.counted)
      text += fmt::format(
          ",\"cycles\":{},\"overruns\":{},\"missed\":{},\"latency_max_ns\":{},\"execution_mean_ns\":{},\"inhibited\":{}"
          ",\"inhibited_at_cycle\":{},\"stopped_at_cycle\":{},\"realtime\":{}",
          member.cycles, member.overruns, member.missed, member.latency_max_ns, member.execution_mean_ns,
          member.inhibited, member.inhibited_at_cycle, member.stopped_at_cycle, member.realtime ? 1 : 0);
    text += "}";
    first = false;
  }
  text += "],\"values\":{";
  first = true;
  for (const auto& [name, value] : values_) {
    text += fmt::format("{}{}:{}", first ? "" : ",", json_string(name), value.json());
    first = false;
  }
  return text + "}}\n";
}

void Console::print(std::string line) {
  if (style_ == Style::Quiet) return;
  {
    const std::lock_guard guard{mutex_};
    if (lines_.size() == most_lines) {
      lines_.pop_front();
      ++dropped_;
    }
    lines_.push_back(std::move(line));
  }
  wake_.notify_one();
}

void Console::write_lines() {
  std::unique_lock lock{mutex_};
  for (;;) {
    wake_.wait_for(lock, writer_patience, [this] { return ending_ || !lines_.empty(); });
    if (lines_.empty() && ending_) return;
    std::deque<std::string> taken;
    taken.swap(lines_);
    const std::size_t dropped = std::exchange(dropped_, 0);
    lock.unlock();
    if (dropped != 0)
      std::fputs(held_text(fmt::format("{} lines are in the log only: the terminal stood still", dropped)).c_str(),
                 terminal_);
    for (const std::string& line : taken) std::fputs(line.c_str(), terminal_);
    std::fflush(terminal_);
    lock.lock();
  }
}

}  // namespace hirosco::supervisor
