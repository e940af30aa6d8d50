// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"

/// A small mission for the tests of supervision: ARM (10), HAND (11) and CAMERA (12), two links between the first two.
namespace hirosco::supervisor::testing {

inline constexpr std::uint16_t arm = 10;
inline constexpr std::uint16_t hand = 11;
inline constexpr std::uint16_t camera = 12;

inline std::uint16_t in_states(std::initializer_list<descriptor::State> states) {
  unsigned bits = 0;
  for (const auto state : states) bits |= 1U << static_cast<unsigned>(state);
  return static_cast<std::uint16_t>(bits);
}

inline descriptor::Function function(std::string name, std::uint16_t states, bool essential = false) {
  descriptor::Function made;
  made.name = std::move(name);
  made.states = states;
  made.essential = essential;
  return made;
}

inline descriptor::Mission small_mission() {
  using enum descriptor::State;
  descriptor::Mission mission;
  mission.supervisor.name = "SUPERVISOR";
  mission.supervisor.id = 1;
  mission.supervisor.functions = {function("SET_MODE", in_states({Operational})),
                                  function("SAFE_ALL", in_states({Operational}), true)};
  for (const auto& [name, id] : {std::pair{"ARM", arm}, std::pair{"HAND", hand}, std::pair{"CAMERA", camera}}) {
    descriptor::MissionSubsystem member;
    member.subsystem.name = name;
    member.subsystem.id = id;
    member.subsystem.functions = {function("MOVE_TO", in_states({Operational})),
                                  function("BRAKE", in_states({Operational}), true)};
    mission.subsystems.push_back(member);
  }
  descriptor::Configuration coupled;
  coupled.name = "COUPLED";
  coupled.id = 2;
  coupled.sampling = std::chrono::milliseconds{1};
  coupled.power_w = 60;
  descriptor::Requires wanted;
  wanted.name = "HAND_STATE";
  coupled.requires_ = {wanted};
  mission.subsystems[0].subsystem.configurations = {coupled};
  mission.links = {
      {.id = 1, .from = "ARM", .provides = "ARM_STATE", .to = "HAND", .requires_ = "ARM_STATE", .at = {}},
      {.id = 2, .from = "HAND", .provides = "HAND_STATE", .to = "ARM", .requires_ = "HAND_STATE", .at = {}}};
  descriptor::Mode open;
  open.name = "open";
  open.id = 1;
  open.permits = {{.subsystem = "*", .functions = {"*"}, .services = {3, 5, 17, 20}, .parameters = {}, .at = {}}};
  descriptor::Mode narrow;
  narrow.name = "narrow";
  narrow.id = 2;
  narrow.permits = {{.subsystem = "ARM", .functions = {"MOVE_TO"}, .services = {}, .parameters = {}, .at = {}}};
  mission.modes = {open, narrow};
  return mission;
}

/// Octets of a telecommand, all acknowledgements wanted.
inline std::vector<std::byte> telecommand(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const auto packet = pus::write_telecommand(
      buffer, {.apid = apid, .ack = pus::ack_all, .service = service, .subtype = subtype, .source = 7}, data);
  buffer.resize(packet.value().size());
  return buffer;
}

/// Application data of TC[8,1] with no argument, or one of type UINT8.
inline std::vector<std::byte> call_data(std::string_view name, int argument = -1) {
  std::vector<std::byte> data(16);
  for (std::size_t i = 0; i < name.size(); ++i) data[i] = static_cast<std::byte>(name[i]);
  data.push_back(std::byte{argument < 0 ? std::uint8_t{0} : std::uint8_t{1}});
  if (argument >= 0) {
    data.push_back(std::byte{1});
    data.push_back(static_cast<std::byte>(argument));
  }
  return data;
}

}  // namespace hirosco::supervisor::testing
