// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "supervisor/supervision/realtime_links/link_graph.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

/// Whether a telecommand may be executed, by sender, state, mode and what its addressee needs (paper 4.3): rules one after the other, and
/// nothing else is looked at. `Judgement::judge()` asks them, and besides whether the sender may speak under that name and is
/// sound, and whether a recovery or the end of the flight forbids it; it is what a question before sending and the sending
/// itself ask alike. Floods are refused after that (`Telecommands::refuse_flood()`), what an old mode permitted by who receives it.
namespace hirosco::supervisor {

/// What the decision looks at besides the telecommand.
struct Situation {
  const descriptor::Mission& mission;
  const descriptor::Mode& mode;
  const LinkGraph& links;
  /// Present state of the addressee; empty: it does not run.
  std::optional<descriptor::State> state;
  /// Configuration in force at the addressee, 0 = none.
  std::uint8_t configuration{0};
  /// Null: power is no matter here.
  const PowerLedger* power{nullptr};
  /// The addressee's process does not run; one that does may have no state that can be read.
  bool down{false};
  /// A change of mode is under way (docs/adr/0075).
  bool changing{false};
  /// Another text of the addressee's descriptor is on its way to it (docs/adr/0095).
  bool rereading{false};
  /// Who tells what is in force of everybody, for what their cycles take together; null: that is no matter here.
  const std::function<std::vector<descriptor::InForce>()>* in_force{nullptr};
};

struct Permitted {
  bool essential{false};  ///< forwarded first, logged after (decision 24)
  bool releases_stop{false};  ///< SET_STATE(Operational): lifts the addressee's stop flag
  bool acts{false};  ///< more than a look: a function, a value that is set, whatever is bound to a state
  bool starts{false};  ///< SET_STATE(Offline) to who is down: the supervisor starts its process
  bool stops_the_craft{false};  ///< SAFE_ALL: carried out whoever says it, under whatever source id
  double reserves_w{
      0};  ///< SET_STATE(SafeOperational), or CONFIGURE while it acts: what the addressee may draw from now on
};

/// Who is down answers nothing; what brings it up again is said with the refusal.
[[nodiscard]] pus::FailureNotice is_down();

/// What of acceptance is the supervisor's: codes 1, 6, 7, 10, 13, 14, 16, 18 and 0x0107 of docs/failure-codes.md. A notice with code UnknownApid belongs
/// into TM[1,10], every other into TM[1,2].
[[nodiscard]] std::expected<Permitted, pus::FailureNotice> decide(const pus::TelecommandView& telecommand,
                                                                  const Origin& origin, const Situation& situation);

}  // namespace hirosco::supervisor
