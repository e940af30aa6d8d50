// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/device_faults.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr Duration look_period = 200ms;

}  // namespace

void DeviceFaults::inject(const json& body, std::function<void(Answered<json>)> done) {
  const std::string device = text_of(body, "device");
  const std::string line = text_of(body, "line");
  const auto& devices = parts_.catalogue.mission().devices;
  // The name becomes part of a path: only what the mission declares gets there.
  if (std::ranges::none_of(devices, [&](const auto& known) { return known.name == device; }))
    return done(refuse(404, "the mission has no simulated device '" + device + "'"));
  constexpr std::size_t longest_line = 255;
  if (line.empty() || line.size() > longest_line || std::ranges::any_of(line, [](unsigned char c) { return c < ' '; }))
    return done(refuse(400, "line: one line of text is wanted"));
  constexpr std::size_t most_own = 100;
  if (parts_.injected) own_.emplace_back(device, line);
  if (own_.size() > most_own) own_.pop_front();
  parts_.ask_device(device, line, [this, device, line, done = std::move(done)](std::optional<std::string> answer) {
    if (answer != "ok") static_cast<void>(is_own(device, line));  // nothing was injected
    if (!answer) return done(refuse(503, "the device does not answer"));
    keep({parts_.now(), device, line, *answer});
    done(json{{"answer", *answer}});
  });
}

void DeviceFaults::keep(const StoredFault& fault) {
  parts_.archive.add(fault);
  parts_.tell({{"type", "fault"},
               {"t", json_time(fault.t)},
               {"device", fault.device},
               {"line", fault.line},
               {"answer", fault.answer}});
}

void DeviceFaults::tick(TimePoint now) {
  if (now < next_look_) return;
  next_look_ = now + look_period;
  if (!parts_.injected) return;
  for (const StoredFault& fault : parts_.injected())
    if (!is_own(fault.device, fault.line)) keep(fault);
}

bool DeviceFaults::is_own(const std::string& device, const std::string& line) {
  const auto own = std::ranges::find(own_, std::pair{device, line});
  if (own == own_.end()) return false;
  own_.erase(own);
  return true;
}

}  // namespace hirosco::ground
