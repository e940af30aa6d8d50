// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/console.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace hirosco::supervisor {
namespace {

constexpr Duration writer_patience = 500ms;

/// Names and event texts come from descriptors: nothing but printable characters reaches the terminal or the JSON.
[[nodiscard]] std::string json_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : shown(text)) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "\"";
}

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
  if (style_ == Style::Json) print(fmt::format("{{\"at_s\":{:.4f},\"told\":{}}}\n", at_s, json_string(line)));
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
  return style_ == Style::Json ? fmt::format("{{\"held\":{}}}\n", json_string(line))
                               : fmt::format("{:>12}{}\n", "", shown(line));
}

void Console::show(const Supervisor& supervisor, Duration since_start) {
  tell_held();
  print(style_ == Style::Json ? status_json(supervisor, since_start) : status_text(supervisor, since_start));
}

std::string Console::status_text(const Supervisor& supervisor, Duration since_start) const {
  std::string text = fmt::format("[{:6.1f} s] {}", seconds(since_start), supervisor.mode().name);
  for (const Member& member : supervisor.members()) {
    const auto state = member.state();
    text += fmt::format(" | {} {}", shown(member.descriptor().name),
                        member.alive() && state ? to_text(*state) : std::string_view{"not running"});
    const auto counts = member.statistics();
    if (!counts || !counts->cycling) continue;
    text +=
        fmt::format(" {:.0f} Hz exec {:.1f} us late max {:.0f} us overruns {} missed {}",
                    1e9 / static_cast<double>(std::max<std::uint64_t>(counts->period_ns, 1)),
                    counts->execution_mean_ns * 1e-3, counts->latency_max_ns * 1e-3, counts->overruns, counts->missed);
    if (counts->inhibited != 0) text += " INHIBITED";
    if (!counts->realtime) text += " (reduced promise: no real-time scheduling)";
  }
  text += fmt::format(" | links {}/{}", supervisor.links().up_count(), supervisor.links().defined_count());
  for (const auto& item : mission_.console)
    if (const auto value = values_.find(item.parameter); value != values_.end())
      text += fmt::format(" | {} {}{}{}", shown(item.label), value_text(value->second, item.decimals),
                          item.unit.empty() ? "" : " ", shown(item.unit));
  if (const std::string waiting = supervisor.waiting_for(); !waiting.empty()) text += " | waits for " + shown(waiting);
  return text + "\n";
}

std::string Console::status_json(const Supervisor& supervisor, Duration since_start) const {
  std::string text = fmt::format("{{\"up_s\":{:.3f},\"mode\":{},\"links_up\":{},\"links_defined\":{},\"subsystems\":[",
                                 seconds(since_start), json_string(supervisor.mode().name),
                                 supervisor.links().up_count(), supervisor.links().defined_count());
  bool first = true;
  for (const Member& member : supervisor.members()) {
    const auto state = member.state();
    const auto counts = member.statistics();
    text += fmt::format("{}{{\"name\":{},\"state\":{}", first ? "" : ",", json_string(member.descriptor().name),
                        json_string(member.alive() && state ? to_text(*state) : std::string_view{"not running"}));
    if (counts)
      text += fmt::format(
          ",\"cycles\":{},\"overruns\":{},\"missed\":{},\"latency_max_ns\":{},\"execution_mean_ns\":{},\"inhibited\":{}"
          ",\"inhibited_at_cycle\":{},\"stopped_at_cycle\":{},\"realtime\":{}",
          counts->cycles, counts->overruns, counts->missed, counts->latency_max_ns, counts->execution_mean_ns,
          counts->inhibited, counts->inhibited_at_cycle, member.stopped_at_cycle(), counts->realtime ? 1 : 0);
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
