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
///   TM[129,5]  the answer, also beside a SET_MODE or ENTER_MODE that is refused: mode u8; how many reasons are against it u8 (0 = it is
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
///   TC[129,11] send down what the log of this flight has (docs/adr/0140): the reports that were stored from one time to another, 7 octets
///              each, and whether housekeeping is among them, 1 or 0 u8. Of a ground only; completed as soon as it is begun
///   TM[129,12] one report of these: its number in the log u64; the whole packet as it was sent. It is not logged again
///   TM[129,13] and the end of it: request id of the TC[129,11] u32; how many reports came u32; how many were left out, as they find no room in a report u32; how many numbers of
///              the log are missing there u32, how many of its records are damaged u32; why it ended early, as words (none: it did not)
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
  descriptor_problem = 10,
  retrieve = 11,
  retrieved = 12,
  retrieval_end = 13
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

/// What TC[129,11] asks for. Times are cut to what 7 octets can say.
struct Retrieve {
  OnboardTime from{}, to{};  ///< both included
  bool housekeeping{true};
  friend bool operator==(const Retrieve&, const Retrieve&) = default;
};
inline constexpr std::size_t retrieve_octets = 15;
[[nodiscard]] std::array<std::byte, retrieve_octets> write_retrieve(const Retrieve& wanted) noexcept;
/// Empty: it is not of this form.
[[nodiscard]] std::optional<Retrieve> read_retrieve(Octets data) noexcept;

/// A report that was sent before. `packet` views what it was read from.
struct Retrieved {
  std::uint64_t number{};  ///< in the log
  Octets packet{};
};
inline constexpr std::size_t max_retrieved_octets =
    max_telemetry_octets - telemetry_overhead_octets - sizeof(std::uint64_t);
/// Into `buffer`; empty: the packet has more than max_retrieved_octets.
[[nodiscard]] Octets write_retrieved(MutableOctets buffer, const Retrieved& report) noexcept;
[[nodiscard]] std::optional<Retrieved> read_retrieved(Octets data) noexcept;
/// Whether it says again what was said before.
[[nodiscard]] bool is_retrieved(const TelemetryView& report) noexcept;

struct RetrievalEnd {
  std::uint32_t request{};  ///< id of the TC[129,11]
  std::uint32_t reports{}, left_out{}, missing{}, damaged{};
  std::string why{};  ///< it ended early; empty: it did not
  [[nodiscard]] bool whole() const noexcept { return why.empty() && left_out == 0 && missing == 0 && damaged == 0; }
  friend bool operator==(const RetrievalEnd&, const RetrievalEnd&) = default;
};
/// Words are cut at 255 octets.
[[nodiscard]] std::vector<std::byte> write_retrieval_end(const RetrievalEnd& end);
[[nodiscard]] std::optional<RetrievalEnd> read_retrieval_end(Octets data);

inline constexpr std::size_t max_preview_octets = max_telemetry_octets - telemetry_overhead_octets;
/// Into `buffer`, of max_preview_octets. Steps and reasons beyond 255 of each, and steps that find no room, are left out; words
/// are cut at 255 octets.
[[nodiscard]] Octets write_mode_preview(MutableOctets buffer, const ModePreview& preview);
/// Empty: it is not of this form.
[[nodiscard]] std::optional<ModePreview> read_mode_preview(Octets data);
[[nodiscard]] Octets write_plan_preview(MutableOctets buffer, const PlanPreview& preview);
[[nodiscard]] std::optional<PlanPreview> read_plan_preview(Octets data);

}  // namespace hirosco::pus::st129
