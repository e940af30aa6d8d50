// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/cycle/queue_fill.hpp"
#include "hirosco/utilities/record_ring.hpp"
#include "hirosco/utilities/spsc_ring.hpp"

/// What the two loops of a subsystem tell each other. Trivially copyable records in preallocated rings: the only way
/// of commands and reports between them (architecture, rule 1). Single words stand in atomics of CycleLoop, its
/// parts and CycleOrders, values to be set in WriteQueue.
namespace hirosco {

struct AttachedLink;
struct Reconfiguration;

enum class CommandKind : std::uint8_t {
  Function,       ///< run handler `index` with `arguments`
  EnterState,     ///< `index` is the State
  AttachInput,    ///< `link` to input slot `index`
  DetachInput,
  AttachOutput,   ///< `link` to output slot `index`
  DetachOutput,
  SelfTest,       ///< run it, for `request`
  Reconfigure,    ///< go over to another configuration without a break (adr 0096)
};

/// Service loop -> cycle. What it and a report take is reckoned with where a descriptor is read (docs/adr/0188).
struct CycleCommand {
  CommandKind kind{};
  std::uint16_t index{0};
  pus::Request request{};
  AttachedLink* link{nullptr};
  Reconfiguration* reconfiguration{nullptr};
  pus::ArgumentData arguments{};
};
static_assert(sizeof(CycleCommand) <= descriptor::command_octets);

enum class ReportKind : std::uint8_t {
  Housekeeping,   ///< payload: source data of TM[3,25], `index` the structure id
  Event,          ///< payload: auxiliary data, `index` the event id
  Started,
  Refused,        ///< `index` the code; payload: AuthorsError
  Progressed,
  StepFailed,     ///< `index` the code; payload: FailedStep
  Finished,
  Aborted,        ///< of a function; `index` code or step; payload of Aborted: AuthorsError
  StateEntered,   ///< `index` the State
  EntryRefused,   ///< `index` the State; payload: AuthorsError
  NodeFailed,     ///< `index` the State; payload: AuthorsError
  InputDetached,
  OutputDetached,  ///< `link` may be freed
  Reconfigured,   ///< `index` the configuration that is in force from the cycle before this on
  NotReconfigured,  ///< `index` the configuration that was wanted; payload: AuthorsError
  SelfTestEnded,  ///< `index` 0: passed, else the code; payload: AuthorsError
};

/// An author's error: the words are copied, as who said them may be gone when they are read.
struct AuthorsError {
  ErrorCode code{ErrorCode::Internal};
  std::uint8_t text_octets{0};
  std::int64_t number{0};
  std::array<char, descriptor::framework_event::text_octets> text{};
  AuthorsError() = default;
  explicit AuthorsError(const Error& error) noexcept : code{error.code}, number{error.value} {
    if (error.text == nullptr) return;
    while (text_octets < text.size() && error.text[text_octets] != '\0') {
      text[text_octets] = error.text[text_octets];
      ++text_octets;
    }
  }
};
static_assert(sizeof(AuthorsError) <= descriptor::reason_octets);
/// A step of a running function, which goes on.
struct FailedStep {
  AuthorsError why{};
  std::uint16_t step{0};
};

/// Cycle -> service loop; a payload may follow in the same record.
struct CycleReport {
  ReportKind kind{};
  std::uint16_t index{0};
  std::uint32_t number{0};  ///< answers and events count together: they are taken in the order in which they were made
  pus::Request request{};
  AttachedLink* link{nullptr};
};
static_assert(sizeof(CycleReport) <= descriptor::report_head_octets);

/// Commands and reports between the loops of one subsystem, as large as its descriptor says. Three rings of reports, so that none is
/// crowded out by another kind: whatever an author raises, and however much housekeeping is asked for, who waits for an answer gets it.
struct LoopRings {
  explicit LoopRings(const descriptor::Queues& sizes = {})
      : commands{sizes.commands},
        answers{sizes.answers_octets},
        events{sizes.events_octets},
        housekeeping{sizes.housekeeping_octets} {}
  /// False: the cycle has not taken those before it.  Thread: the service loop.
  [[nodiscard]] bool command(const CycleCommand& wanted) noexcept {
    const bool taken = commands.try_push(wanted);
    commands_mark.note(commands.size(), commands.dropped(), commands.capacity());
    return taken;
  }
  /// Before reports are taken, when most of them wait.  Thread: the service loop.
  void look() noexcept {
    answers_mark.note(answers.used(), lost_answers(), answers.capacity());
    events_mark.note(events.used(), lost_events(), events.capacity());
    housekeeping_mark.note(housekeeping.used(), housekeeping.dropped(), housekeeping.capacity());
  }
  /// Since this was asked last.  Thread: the service loop.
  [[nodiscard]] QueueFills take_fills() noexcept {
    look();
    commands_mark.note(commands.size(), commands.dropped(), commands.capacity());
    const auto fill = [](FillMark& mark, std::size_t room) {
      return QueueFill{mark.take(), static_cast<std::uint32_t>(room)};
    };
    return {fill(commands_mark, commands.capacity()), fill(answers_mark, answers.capacity()),
            fill(events_mark, events.capacity()), fill(housekeeping_mark, housekeeping.capacity())};
  }
  SpscRing<CycleCommand> commands;
  RecordRing answers;  ///< somebody waits: at most two for each command, progress, failed or not, framework events
  RecordRing events;  ///< the author's
  RecordRing housekeeping;
  FillMark commands_mark, answers_mark, events_mark, housekeeping_mark;  ///< the service loop's
  // Written by the cycle, besides what the rings count themselves: what may not take the last half of one.
  std::atomic<std::uint64_t> lost_progress{0};
  std::atomic<std::uint64_t> lost_remarks{0};
  [[nodiscard]] std::uint64_t lost_answers() const noexcept {
    return answers.dropped() + lost_progress.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t lost_events() const noexcept {
    return events.dropped() + lost_remarks.load(std::memory_order_relaxed);
  }
  /// A moment's view.  Thread: any.
  [[nodiscard]] bool reports_wait() const noexcept {
    return answers.used() != 0 || events.used() != 0 || housekeeping.used() != 0;
  }
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return lost_answers() + lost_events() + housekeeping.dropped();
  }
};

}  // namespace hirosco
