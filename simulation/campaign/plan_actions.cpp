// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/plan_actions.hpp"

#include <array>
#include <chrono>
#include <cstdint>

namespace hirosco::campaign {

void PlanActions::perform(const Action& action) {
  if (parts_.craft.finished()) return;
  const bool done = do_action(action.words);
  if (parts_.defect.after_action) parts_.defect.after_action(action.words);
  std::string words;
  for (const std::string& word : action.words)
    if (words.size() < 60) words += " " + word;
  parts_.trace.say("{}{}", done ? "did" : "refused", words);
  parts_.trace.look();
}

bool PlanActions::do_action(const std::vector<std::string>& words) {
  const std::string& verb = words[0];
  const std::string subject = words.size() > 1 ? words[1] : "";
  if (verb == "tc") return telecommand(words);
  if (verb == "raw" && words.size() == 3) {
    const auto octets = octets_of_hex(words[2]);
    return octets && parts_.traffic.send_packet(subject, *octets);
  }
  if (verb == "flood") return flood(words);
  if (verb == "edit") return edit(words);
  if (verb == "log") return disk_fault(words);
  if (verb == "safe") {
    parts_.craft.stop_beside_flight();
    return true;
  }
  if (verb == "fault") {
    auto* device = parts_.craft.device(subject);
    std::string line;
    for (std::size_t i = 2; i < words.size(); ++i) line += words[i] + " ";
    return device != nullptr && device->fault(line).has_value();
  }
  if (subject == parts_.mission.supervisor.name) return supervisor_fault(words);
  if (!parts_.craft.alive(subject)) return false;
  if (verb == "kill") parts_.craft.kill(subject);
  else if (verb == "stop" || verb == "go") parts_.craft.stop(subject, verb == "stop");
  else if (verb == "spin") parts_.craft.spin(subject);
  else if (verb == "stick" || verb == "unstick") parts_.craft.stick(subject, verb == "stick");
  else if (verb == "strain" && words.size() == 4) {
    const auto cycles = number_of(words[2]), takes_us = number_of(words[3]);
    if (!cycles || !takes_us) return false;
    parts_.craft.strain(subject, static_cast<int>(*cycles), std::chrono::microseconds{*takes_us});
  } else return false;
  return true;
}

/// stop|go|kill|hang SUPERVISOR; of the last two with the milliseconds for which nobody is there, or nothing is done
bool PlanActions::supervisor_fault(const std::vector<std::string>& words) {
  const std::string& verb = words[0];
  if (verb == "stop" || verb == "go") {
    supervisor_stopped_ = verb == "stop";
    parts_.craft.stop(words[1], supervisor_stopped_);
    return true;
  }
  const auto milliseconds = number_of(words.size() > 2 ? words[2] : "");
  if (!milliseconds || !parts_.craft.supervised()) return false;
  const Duration span = std::chrono::milliseconds{*milliseconds};
  if (verb == "kill") parts_.craft.kill_supervisor(span);
  else if (verb == "hang") parts_.craft.hang_supervisor(span);
  else return false;
  return true;
}

bool PlanActions::disk_fault(const std::vector<std::string>& words) {
  const std::string what = words.size() > 1 ? words[1] : "";
  if (what == "failing") parts_.disk.fault = DiskFault::Failing;
  else if (what == "full") parts_.disk.fault = DiskFault::Full;
  else if (what == "deleted") parts_.disk.fault = DiskFault::Deleted;
  else if (what == "frozen") parts_.disk.delay = Duration::max();
  else if (what == "heal") {
    parts_.disk.fault = DiskFault::None;
    parts_.disk.delay = {};
  } else if (what == "slow" && words.size() == 3) {
    const auto milliseconds = number_of(words[2]);
    if (!milliseconds) return false;
    parts_.disk.delay = std::chrono::milliseconds{*milliseconds};
  } else return false;
  return true;
}

/// tc ORIGIN APID SERVICE SUBTYPE ACK [HEX]
bool PlanActions::telecommand(const std::vector<std::string>& words) {
  if (words.size() < 6) return false;
  std::array<std::uint64_t, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = number_of(words[i + 2]);
    if (!number) return false;
    numbers[i] = *number;
  }
  const auto data = octets_of_hex(words.size() > 6 ? words[6] : "");
  return data && parts_.traffic.send(words[1],
                                     {.apid = static_cast<std::uint16_t>(numbers[0]),
                                      .service = static_cast<std::uint8_t>(numbers[1]),
                                      .subtype = static_cast<std::uint8_t>(numbers[2]),
                                      .ack = static_cast<std::uint8_t>(numbers[3])},
                                     *data);
}

/// edit MEMBER HOW: what its file says from now on
bool PlanActions::edit(const std::vector<std::string>& words) {
  if (words.size() != 3) return false;
  const auto edit = parts_.texts.edit(words[1], words[2]);
  if (!edit) return false;
  parts_.trace.say("wrote {} {:08x} {}", words[1], edit->crc, edit->sound ? "sound" : "faulty");
  return true;
}

/// flood ORIGIN valid|damaged COUNT: all in one instant
bool PlanActions::flood(const std::vector<std::string>& words) {
  if (words.size() != 4) return false;
  const auto count = number_of(words[3]);
  if (!count) return false;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (words[2] == "valid") {
      parts_.traffic.send(words[1], {.apid = parts_.mission.supervisor.id, .service = 17, .subtype = 1, .ack = 9}, {});
    } else {
      constexpr std::array damaged{std::byte{0x18}, std::byte{0x01}, std::byte{0xC0}, std::byte{0x00}, std::byte{0x00},
                                   std::byte{0x06}, std::byte{0x2F}, std::byte{0x11}, std::byte{0x01}, std::byte{0x00},
                                   std::byte{0x00}, std::byte{0x00}, std::byte{0x01}};
      parts_.traffic.send_packet(words[1], damaged);
    }
  }
  return true;
}

void PlanActions::end_faults() {
  for (const auto& device : parts_.mission.devices) {
    if (auto* simulated = parts_.craft.device(device.name)) {
      static_cast<void>(simulated->fault("heal"));
      static_cast<void>(simulated->fault("plug"));
      // The hand moves as at the beginning: one that stirs the robot against the rail trips limits, and rightly so.
      for (const auto& [name, value, at] : device.settings) static_cast<void>(simulated->fault(name + " " + value));
    }
  }
  for (const auto& member : parts_.mission.subsystems) {
    parts_.craft.stop(member.subsystem.name, false);
    parts_.craft.stick(member.subsystem.name, false);
    parts_.craft.strain(member.subsystem.name, 0, {});
    parts_.craft.call_spin_off(member.subsystem.name);
  }
  if (supervisor_stopped_) parts_.craft.stop(parts_.mission.supervisor.name, false);
  supervisor_stopped_ = false;
  parts_.disk.fault = DiskFault::None;
  parts_.disk.delay = {};
  parts_.trace.say("calm");
}

void PlanActions::rest_hands() {
  for (const auto& device : parts_.mission.devices)
    if (auto* simulated = parts_.craft.device(device.name)) static_cast<void>(simulated->fault("hand hold 0 0"));
}

}  // namespace hirosco::campaign
