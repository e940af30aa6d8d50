// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/time.hpp"

/// What the archive keeps, as its rows.
namespace hirosco::ground {

struct StoredPacket {
  std::int64_t number{};             ///< in the archive; set by packets_back()
  OnboardTime t{};
  std::uint16_t apid{};
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint16_t sid{};               ///< of TM[3,25], else 0
  std::vector<std::byte> octets;
};
struct StoredEvent {
  OnboardTime t{};
  std::uint16_t apid{};
  std::string subsystem;
  std::uint16_t id{};
  std::string name;
  int severity{};
  std::string text;
  std::string values;                ///< a JSON object
};
struct StoredCommand {
  std::int64_t number{};
  OnboardTime t{};
  std::string sender;
  std::uint16_t apid{};
  std::string subsystem;
  std::string function;
  std::string arguments;             ///< a JSON object
  std::string stage;
  std::optional<int> code;
  std::string reason;
};
struct StoredReport {
  OnboardTime t{};
  std::string stage;
  std::optional<int> code;
  std::string reason;
};
/// The mode, a subsystem's state, a link: what it is from `t` on.
struct StoredChange {
  OnboardTime t{};
  std::string kind;                  ///< "mode", "state", "link"
  std::string name;                  ///< of the subsystem, id of the link, "" of the mode
  std::string value;
};
struct StoredGap {
  OnboardTime from{};
  OnboardTime to{};
};
struct StoredFault {
  OnboardTime t{};
  std::string device;
  std::string line;
  std::string answer;
};
/// What somebody at the station did, or the station itself: of an alarm, of who commands, of a flight, of a stack.
struct StoredMark {
  OnboardTime t{};
  std::string kind;                  ///< "alarm", "authority", "flight", "stack"
  std::string name;  ///< of the alarm "APID/EVENT", of the flight its number, of the stack its own, "" of who commands
  std::string action;
  std::string who;
  std::string note;
  OnboardTime until{};  ///< of what has an end
};
/// A span of time and what is wanted of it.
struct Span {
  OnboardTime from{};
  OnboardTime to{OnboardTime::max()};
};

}  // namespace hirosco::ground
