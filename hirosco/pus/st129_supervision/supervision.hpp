// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service_kind.hpp"
#include "hirosco/utilities/octets.hpp"

/// ST[129], ours: what ground and the supervisor say about telecommands before they are sent, and about those that were.
///
///   TC[129,1]  would this telecommand be permitted now?  the whole packet asked about
///   TM[129,2]  the answer: its request id u32, 1 or 0 u8, failure code of the refusal u16 (0 = none)
///   TM[129,3]  copy of a telecommand that the supervisor has received from a ground, to every ground: the whole packet
///   TC[129,4]  what would SET_MODE do now?  mode u8
///   TM[129,5]  the answer, also beside a SET_MODE that is refused: mode u8; how many reasons are against it u8 (0 = it is
///              possible), each as words; how many steps it would take u8, each its stage u8 from 1, its subject's APID u16, words.
///              A stage begins when the one before has ended.
///   TC[129,6]  what would a plan do now about this event?  APID of whose event u16, its number u16; nothing is done
///   TM[129,7]  the answer: APID u16, event u16, its severity u8, number of the plan u16 (0 = the default), its name as
///              words; then as in TM[129,5]: reasons against it, and its steps, whose stages are their order for each subject
///   TC[129,8]  pass this on to me from now on (adr 0098), of subsystems only: APID of whose u16, 1 structure or 2 event u8,
///              its number u16. A structure comes as its TM[3,25]; an event as a TM[5,n] of its source, destination who asks,
///              whether ST[05] reports it to ground or not. It ends with the process that asked
///   TC[129,9]  and from now on no more: the same three
///   TM[129,10] beside a REREAD that is refused (docs/adr/0095), one for each problem: whose descriptor, APID u16; how many there are
///              u16; file, as words; line u32, column u32 (0: the file as a whole); its number in docs/descriptor-errors.md, what is
///              wrong and what to do about it, as words
namespace hirosco::pus::st129 {

inline constexpr std::uint8_t service_type = 129;
extern const ServiceKind service_kind;
enum Subtype : std::uint8_t {
  permission_question = 1,
  permission_answer = 2,
  telecommand_copy = 3,
  mode_question = 4,
  mode_preview = 5,
  plan_question = 6,
  plan_preview = 7,
  subscribe = 8,
  unsubscribe = 9,
  descriptor_problem = 10
};

/// What TC[129,8] and [129,9] name.
struct Subscribed {
  enum class What : std::uint8_t { Structure = 1, Event = 2 };
  std::uint16_t apid{};
  What what{What::Structure};
  std::uint16_t id{};
  friend auto operator<=>(const Subscribed&, const Subscribed&) = default;
};
inline constexpr std::size_t subscribed_octets = 5;
[[nodiscard]] std::array<std::byte, subscribed_octets> write_subscribed(const Subscribed& subscribed) noexcept;
/// Empty: it is not of this form.
[[nodiscard]] std::optional<Subscribed> read_subscribed(Octets data) noexcept;

struct ModePreview {
  struct Step {
    std::uint8_t stage{};
    std::uint16_t subject{};
    std::string what;
  };
  std::uint8_t mode{};
  std::vector<std::string> against;
  std::vector<Step> steps;
};

struct DescriptorProblem {
  std::uint16_t apid{};
  std::uint16_t count{};
  std::string file;
  std::uint32_t line{}, column{};
  std::string code, what, hint;
};
/// Words are cut at 255 octets, a file's name in front.
[[nodiscard]] std::vector<std::byte> write_descriptor_problem(const DescriptorProblem& problem);
/// Empty: it is not of this form.
[[nodiscard]] std::optional<DescriptorProblem> read_descriptor_problem(Octets data);

struct PlanPreview {
  std::uint16_t subsystem{};
  std::uint16_t event{};
  std::uint8_t severity{};
  std::uint16_t plan{};
  std::string name;
  std::vector<std::string> against;
  std::vector<ModePreview::Step> steps;
};

inline constexpr std::size_t max_preview_octets = max_telemetry_octets - telemetry_overhead_octets;
/// Into `buffer`, of max_preview_octets. Steps and reasons beyond 255 of each, and steps that find no room, are left out; words
/// are cut at 255 octets.
[[nodiscard]] Octets write_mode_preview(MutableOctets buffer, const ModePreview& preview);
/// Empty: it is not of this form.
[[nodiscard]] std::optional<ModePreview> read_mode_preview(Octets data);
[[nodiscard]] Octets write_plan_preview(MutableOctets buffer, const PlanPreview& preview);
[[nodiscard]] std::optional<PlanPreview> read_plan_preview(Octets data);

}  // namespace hirosco::pus::st129
