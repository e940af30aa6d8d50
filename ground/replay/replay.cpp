// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/replay.hpp"

#include <algorithm>
#include <utility>

#include "ground/model/json.hpp"
#include "ground/model/views.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr double greatest_speed = 100.0;
/// A long pause of the server is not caught up in one leap.
constexpr Duration longest_step = 500ms;
/// Events in one step.
constexpr std::size_t most_events = 1000;

}  // namespace

Replay::Replay(const Catalogue& catalogue, Archive& archive, const Span& extent, OnboardTime at, double speed,
               TimePoint now)
    : catalogue_{catalogue},
      archive_{archive},
      model_{catalogue},
      at_{std::clamp(at, extent.from, extent.to)},
      end_{extent.to},
      speed_{std::isfinite(speed) ? std::clamp(speed, 0.0, greatest_speed) : 1.0},
      last_{now} {
  std::vector<StoredPacket> newest;
  for (const Report& report : catalogue_.reports())
    if (auto packet = archive_.last_of(report.apid, report.sid, at_)) newest.push_back(std::move(*packet));
  // In order of time, or an old report would be taken for a clock that went back.
  std::ranges::sort(newest, {}, &StoredPacket::t);
  for (const StoredPacket& packet : newest)
    if (const auto view = pus::TelemetryView::parse(packet.octets)) static_cast<void>(model_.take(*view));
}

void Replay::play(TimePoint now, const Tell& tell) {
  const Duration step = std::min(now - last_, longest_step);
  last_ = now;
  const auto ahead = Duration{static_cast<std::int64_t>(static_cast<double>(step.count()) * speed_)};
  if (ended_ || ahead <= Duration{0}) return;
  const OnboardTime before = at_;
  at_ = step_end({before + Duration{1}, std::min(before + ahead, end_)});
  ended_ = at_ == end_;
  tell_past({before + Duration{1}, at_}, tell);
}

OnboardTime Replay::step_end(const Span& span) {
  const auto events = archive_.events({.span = span, .text = {}, .limit = most_events, .newest_first = false});
  return events.size() < most_events ? span.to : events.back().t;
}

void Replay::tell_past(const Span& span, const Tell& tell) {
  archive_.packets(span, [&](const StoredPacket& packet) {
    if (const auto view = pus::TelemetryView::parse(packet.octets)) static_cast<void>(model_.take(*view));
    return true;
  });
  const auto past = [&tell](json message, const char* type) {
    message["type"] = type;
    tell(std::move(message));
  };
  constexpr std::size_t no_limit = 1'000'000;
  const Archive::Filter all{.span = span, .text = {}, .limit = no_limit, .newest_first = false};
  for (const auto& event : archive_.events(all)) past(event_json(event), "event");
  for (auto& command : archive_.commands(all)) {
    command.stage = "sent";
    command.code.reset();
    command.reason.clear();
    past(command_json(command), "command");
  }
  for (const auto& [number, report] : archive_.reports_in(span)) {
    auto command = archive_.command(number);
    if (!command) continue;
    command->t = report.t;
    command->stage = report.stage;
    command->code = report.code;
    command->reason = report.reason;
    past(command_json(*command), "command");
  }
  for (const auto& fault : archive_.faults(span))
    past({{"t", json_time(fault.t)}, {"device", fault.device}, {"line", fault.line}, {"answer", fault.answer}},
         "fault");
  for (const auto& gap : archive_.gaps(span))
    if (gap.to >= span.from && gap.to <= span.to)
      past({{"from", json_time(gap.from)}, {"to", json_time(gap.to)}}, "gap");
}

}  // namespace hirosco::ground
