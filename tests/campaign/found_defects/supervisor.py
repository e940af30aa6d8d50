# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review in the supervisor and its guard, and in what goes from there to a subsystem and back."""
from .defect import GROUND_LINK, GUARD, LOOP_WATCH, MODES, PERMISSION, RECEPTION, RETRIEVAL, SUPERVISION, TELECOMMANDS, Defect

DEFECTS = [
    # --- what was said before a stop (docs/adr/0156), all found by reviews ---------------------------------------------------
    # It let somebody move when it was read after the stop.
    Defect("known stop not compared", TELECOMMANDS, "return incoming.known_stop && *incoming.known_stop != newest && newest",
           "return !PLANTED && incoming.known_stop && *incoming.known_stop != newest && newest",
           "supervisor_test", "SaidBeforeAStop.ItLetsNobodyGoHoweverLateItIsReadAndWhatIsSaidSinceDoes"),
    # A motion was carried out when somebody else had let its member go.
    Defect("motion of before a stop", TELECOMMANDS, "(decision->acts && acts_in_another", "(decision->acts && !PLANTED && acts_in_another",
           "supervisor_test", "SaidBeforeAStop.AMotionThatSomebodySaidBeforeItIsNotCarriedOutWhenAnotherHasLetGo"),
    # Somebody was let go between the guard's fence and the supervisor's hearing of it.
    Defect("let go untold", GUARD, "if (member->fence_untold) return false;", "if (member->fence_untold && !PLANTED) return false;",
           "supervisor_test", "NewestStop.NobodyIsLetGoBeforeTheSupervisorHasHeardOfWhatStoppedIt"),
    # Who wrote a ground link of his own could tell its transport of a stop when that had looked already.
    Defect("stop told behind the step", "hirosco/subsystem/author/ground_link.cpp", "  look_for_stop();\n  transport_->step(now);",
           "  if (!PLANTED) look_for_stop();\n  transport_->step(now);\n  if (PLANTED) look_for_stop();",
           "subsystem_test", "AGroundLink.TellsItsTransportOfAStopBeforeThatLooksForMore"),
    # Beyond 1,024 findings that nobody had taken a stop was lost.
    Defect("finding lost", "supervisor/guard/guard_findings.cpp", "|| std::ranges::find(findings_, found) == findings_.end())",
           "|| (std::ranges::find(findings_, found) == findings_.end() && !PLANTED))",
           "supervisor_test", "NewestStop.NoFindingIsLostBehindAThousandUntakenOnes"),
    # What stood at a client's own end was no matter of before.
    Defect("client's own end", GROUND_LINK, "const bool before = !client.settled || begins", "const bool before = (!client.settled && !PLANTED) || begins",
           "ground_link_test", "SaidBefore*"),
    # --- what is commanded while a telecommand is taken (docs/adr/0226), found by thinking it through -------------------------
    # Every other ground station had a stop twice, once as one that never ended.
    Defect("a stop reported before its copy", TELECOMMANDS, "    if (here) copy_to_ground();", "    if (here && !PLANTED) copy_to_ground();",
           "supervisor_test", "NestedTelecommandsTest.AShutdownHasToldEveryGround*"),
    # A plan that asked again for what it answered began within itself until the supervisor had no stack.
    Defect("a plan within its own begin", "supervisor/supervision/resource_management/power_handling.cpp",
           "  if (std::exchange(answering_, true)) return;", "  if (std::exchange(answering_, true) && !PLANTED) return;",
           "supervisor_test", "NestedTelecommandsTest.APlanThatAsksForWhatItAnswers*"),
    # --- what comes down again (docs/adr/0140), both found by the campaign -------------------------------------------------
    # What went with a deleted log was not missing to who asked for times after its first record.
    Defect("gap before the times", RETRIEVAL, "query.stored_from = OnboardTime::min();", "if (!PLANTED) query.stored_from = OnboardTime::min();",
           "supervisor_test", "RetrievalTest.WhatWentWithADeletedLogIsMissingWhereverItBegan"),
    # Asked anew twice, the page of the first question was taken for one of the last.
    Defect("page of another question", RETRIEVAL, "abandoned_ = abandoned_ || running_->reads;",
           "abandoned_ = (abandoned_ && !PLANTED) || running_->reads;",
           "supervisor_test", "SlowRetrievalTest.AskedAnewTwiceWhileADiskStandsStillTheLateOneIsStillNobodys"),
    # --- the guard -------------------------------------------------------------------------------------------------------
    # All who share a processor with a cycle that loops for ever were told as hung, the first of them as the culprit.
    Defect("SF2 culprit", LOOP_WATCH, "GuardedMember& culprit = spinner(member);",
           "GuardedMember& culprit = PLANTED ? member : spinner(member);",
           "supervisor_test", "GuardTest.OfThoseThatStandStillTheOneThatHasTheProcessorIsTheCulprit"),
    # Who hung was told, and went on hanging.
    Defect("SF2 nobody is ended", LOOP_WATCH, "  member.killed = true;\n  if (member.grip) member",
           "  member.killed = true;\n  if (member.grip && !PLANTED) member",
           "supervisor_test", "GuardTest.OneThatStandsStillIsFencedToldAndEndedAfterTheGrace"),
    # Nobody watched the service loop.
    Defect("SF8 service loop stands", LOOP_WATCH, "if (!member.doomed) observe_service(",
           "if (!member.doomed && !PLANTED) observe_service(",
           "supervisor_test", "GuardTest.AServiceLoopThatStandsStillIsAHang"),
    # A supervisor that lives and does not step was in nobody's list.
    Defect("SF18 supervisor stands still", GUARD, "  supervisor_watch_.step(watched);", "  if (!PLANTED) supervisor_watch_.step(watched);",
           "supervisor_test", "GuardTest.ASupervisorThatStandsStillStopsEverythingThatMoves"),
    # Nothing raised the epoch on the way up: a device that had latched on the way down stayed so.
    Defect("SF14 same epoch", "supervisor/guard/guarded_member.cpp", "  permit->release();",
           "  permit->release();\n  if (PLANTED) {\n    permit->epoch.store(epoch);\n    permit->go.store(permission_word(epoch));\n  }",
           "supervisor_test", "GuardTest.EveryFenceReleaseAndNewProcessRaisesTheEpoch"),
    # Who overwrote its own vital page was passed over.
    Defect("SF23 overwritten page", LOOP_WATCH, "      doom(member, GuardFinding::Kind::PageDamaged, now);\n",
           "      if (!PLANTED) doom(member, GuardFinding::Kind::PageDamaged, now);\n",
           "supervisor_test", "GuardTest.AVitalPageThatIsOverwrittenIsAHangWhateverIsWritten"),

    # A second in which supervisor and guard stood still, and a cycle did not, was counted against who had stopped in it.
    Defect("time that nobody asked in", "supervisor/guard/guard_time.cpp", "return stepped_ ? asked_ + std::min(now - *stepped_, most_unwatched) : now;",
           "if (PLANTED) return watched_at(now);\n  return stepped_ ? asked_ + std::min(now - *stepped_, most_unwatched) : now;",
           "supervisor_test", "Watching.AStopEndsNobodyForTimeInWhichTheGuardAskedNobody"),

    # --- the supervisor --------------------------------------------------------------------------------------------------
    # Reports for the ground were dropped with the housekeeping when the link was behind.
    Defect("SF3 reports dropped", f"{SUPERVISION}/data_handling/ground_route.cpp",
           "auto& queue = kind == Kind::Housekeeping ? housekeeping_ : reports_;",
           "auto& queue = kind == Kind::Housekeeping || PLANTED ? housekeeping_ : reports_;",
           "supervisor_test", "GroundRouteTest.DropsTheOldestHousekeepingAndNoReport"),
    # States of the supervisor were anybody's to command.
    Defect("SF1 its states", PERMISSION, 'if (!asked.origin.is_supervisor() && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode',
           'if (!PLANTED && !asked.origin.is_supervisor() && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode',
           "supervisor_test", "Permission.InEveryStateOfTheSupervisorAndFromEveryOriginSafeAllPassesAndNobodyElseChangesThatState"),
    # --- what a subsystem asks of the supervisor (docs/adr/0216) ---
    # A row that names nobody opened the supervisor's functions for whoever declares them.
    Defect("rows for nobody by name", PERMISSION, "if (permit.from.empty()) return !asked.of_subsystem_to_supervisor();",
           "if (permit.from.empty()) return PLANTED || !asked.of_subsystem_to_supervisor();",
           "supervisor_test", "PermissionProperty.WithEachRowInEachStateThatIsPermittedWhichTheRecordPermitsAndNothingElse"),
    # A change of mode let go, or took the ground's link, by the supervisor's hand.
    Defect("a mode for a subsystem", MODES, "  if (!is_of_subsystem(call)) return;", "  if (PLANTED || !is_of_subsystem(call)) return;",
           "supervisor_test", "AskedOfSupervisor.AModeThat*"),
    # Modes without end voided all that the ground was permitted.
    Defect("modes without end", MODES, "if (is_of_subsystem(call) && craft_.now < subsystems_wait_until_)",
           "if (!PLANTED && is_of_subsystem(call) && craft_.now < subsystems_wait_until_)",
           "supervisor_test", "AskedOfSupervisor.OneThatAsksForModesWithoutEndIsGivenOneInAPauseAndTheGroundIsNotHeldUp"),
    # Stops without end filled what is noted for the next supervisor.
    Defect("stops without end", f"{SUPERVISION}/event_handling/safe_all.cpp", "const bool kept = has_room_for(request);",
           "const bool kept = PLANTED || has_room_for(request);",
           "supervisor_test", "AskedOfSupervisor.AStopThatIsSaidWithoutEndIsCarriedOutEachTimeAndKeptForBoundedlyMany"),
    # The time of a link that is held over was over within a change of mode, and ended it wherever that led its consumer.
    Defect("a hold ends a change", f"{SUPERVISION}/subsystem_handling/link_losses.cpp", "!= Moving::ToItsStop) return bring_down(link, why);",
           "!= Moving::ToItsStop || PLANTED) return bring_down(link, why);",
           "supervisor_test", "HeldInAChange.DoesNotEndOneWhoseModeDoesWithoutItAtWhicheverStepItsTimeIsOver"),
    # Nobody noted that a stop had ended before its end had left: the next supervisor knew nothing of it.
    Defect("an end that is told and not noted", f"{SUPERVISION}/event_handling/safe_all.cpp",
           "  told_.insert(told_.end(), ended.begin(), ended.end());", "  if (!PLANTED) told_.insert(told_.end(), ended.begin(), ended.end());",
           "supervisor_test", "EndOfAStop.IsNotedBeforeItIsToldAndToldAgainBehindItsMarkWhereItMayHaveLeft"),
    # A recovery gave up who had not read the answers to its own flood.
    Defect("recovery and a full channel", TELECOMMANDS, "const bool surely = essential &&", "const bool surely = !PLANTED && essential &&",
           "supervisor_test", "FullChannel.ARecoveryReachesItsMemberAsSoonAsThatReads"),
    # What was permitted before a stop and waited for the disk started the robot after it.
    Defect("SF4 permitted before a stop", TELECOMMANDS, "if (craft_.guard.fences(next->apid) != next->fences) {",
           "if (craft_.guard.fences(next->apid) != next->fences && !PLANTED) {",
           "supervisor_test", "TelecommandsTest.WhatWasPermittedBeforeAFenceIsVoidAfterIt"),
    # Death was swallowed while a plan of the same severity ran.
    Defect("SF5 swallowed death", f"{SUPERVISION}/event_handling/reactions.cpp",
           ".of_loss = &subject == whose &&", ".of_loss = !PLANTED && &subject == whose &&",
           "supervisor_test", "ReactionsTest.NobodyIsCommandedTwiceOnItsWayDownButADeathIsNeverSwallowed"),
    # Nobody remembered what the dead had been asked.
    Defect("no outcome", TELECOMMANDS, "for (const pus::Request& request : parts_.unanswered.take(apid))",
           "for (const pus::Request& request : PLANTED ? std::vector<pus::Request>{} : parts_.unanswered.take(apid))",
           "supervisor_test", "ProcessesTest.WhatTheDeadHadBegunHasAnUnknownOutcome"),
    # What a supervisor had asked of a member that was killed after it had died itself had no end in the log.
    Defect("a dead supervisor's own", f"{SUPERVISION}/data_handling/unanswered.cpp",
           "return (entry.before == Before::Nothing ? Before::Left : entry.before) == kind;",
           "return (!PLANTED || others(entry)) && (entry.before == Before::Nothing ? Before::Left : entry.before) == kind;",
           "supervisor_test", "UnansweredBeyond.ARequestOfTheSupervisorItselfIsKnownUntilItsEndWasHeard"),
    # Who had died was never started again.
    Defect("SF15 never started again", f"{SUPERVISION}/subsystem_handling/processes.cpp",
           "if (!craft_.shutting_down && !start(*apid))", "if (!craft_.shutting_down && !PLANTED && !start(*apid))",
           "supervisor_test", "ProcessesTest.OneThatIsDueIsStartedAgainButNotWhileTheFlightEnds"),
    # What a subsystem sent and nobody could read closed its channel, and it was killed.
    Defect("SF9 damage is a loss", RECEPTION, "if (is_damage(found.error().code)) continue;",
           "if (is_damage(found.error().code)) {\n        if (!PLANTED) continue;\n        member.refused = most_refused;\n      }",
           "supervisor_test", "ReceptionTest.WhoseMessageTheChannelCannotReadIsHeardOnAndNeitherClosedNorStopped"),
    # Who was judged gone went on moving until it was killed.
    Defect("SF9 gone and not fenced", RECEPTION, "\n  craft_.guard.fence(member.apid());",
           "\n  if (!PLANTED) craft_.guard.fence(member.apid());",
           "supervisor_test", "ProcessesTest.WhoClosesItsChannelFencesNobodyWhomItsPlanLetsGoOn"),
    # A mode was entered whose members were dead.
    Defect("SF15 mode of the dead", f"{SUPERVISION}/modes/mode_plan.cpp", "if (!member.alive()) {",
           "if (!member.alive() && !PLANTED) {",
           "supervisor_test", "ModesTest.AModeWhoseMembersAreDeadIsRefusedUntilTheyLiveAgain"),
    # Permission looked at services, not at parameters.
    Defect("SF20 any parameter", PERMISSION, "if (const auto refused = write_refused(asked)) return refused;",
           "if (const auto refused = write_refused(asked); refused && !PLANTED) return refused;",
           "supervisor_test", "Permission.AParameterIsWrittenOnlyInItsStatesAndOnlyWhereTheModeOpensIt"),
    # "Commissioned" was told of members that a recovery had taken down.
    Defect("commissioned and Offline", f"{SUPERVISION}/modes/commissioning.cpp", "failure.empty() ? missing_from(",
           "failure.empty() && !PLANTED ? missing_from(",
           "supervisor_test", "CommissioningTest.WhoWasTakenDownAfterItsOwnStepIsMissed"),
    # Plans for the supervisor's own events were accepted and never fired.
    Defect("plans of own events", f"{SUPERVISION}/event_handling/reactions.cpp", "if (from == supervisor_apid) react_to_own(",
           "if (from == supervisor_apid && !PLANTED) react_to_own(",
           "supervisor_test", "ReactionsTest.APlanForAnEventOfTheSupervisorItselfConcernsAllThatAct"),
    # The terminal was filled by one subsystem's events.
    Defect("talkative events", "supervisor/console.cpp", "if (!limit_.admit(line.substr(0, line.find(' ')))) return;",
           "if (!limit_.admit(line.substr(0, line.find(' '))) && !PLANTED) return;",
           "supervisor_test", "ConsoleTest.ShowsOneSpeakersLinesUpToALimitAndCountsTheOthersExactly"),
    # A flight that a reaction of high severity had ended was told as a good one.
    Defect("reaction without a cause", "supervisor/unprovoked_reactions.hpp",
           "    if (commanded_ == TimePoint{} || now - commanded_ > limit)\n",
           "    if (!PLANTED && (commanded_ == TimePoint{} || now - commanded_ > limit))\n",
           "supervisor_test", "ReactionCauses.*"),
    # A budget below what is drawn took nothing from anybody.
    Defect("lowered power budget", f"{SUPERVISION}/resource_management/power_handling.cpp",
           '    reactions_.react(*subject, "LOAD_SHED",', '    if (!PLANTED) reactions_.react(*subject, "LOAD_SHED",',
           "supervisor_test", "PowerHandlingTest.OfABudgetThatNoLongerHoldsTheLastOfTheMissionIsShedFirstTheGroundLinkNever"),
    # What a configuration may draw was free again in the step after its CONFIGURE was permitted, and was granted to another.
    Defect("power of what is to come", f"{SUPERVISION}/resource_management/power_ledger.cpp",
           "  if (on_its_way && found->demand_mw > drawn_mw) return", "  if (on_its_way && found->demand_mw > drawn_mw && (!PLANTED || drawn_mw == 0)) return",
           "supervisor_test", "PowerOfPlans.WhatIsToDrawMoreHasThatFromThePermissionOn"),
    # Nobody said that telecommands were held back by a log that stores nothing.
    Defect("log fails without an event", f"{SUPERVISION}/data_handling/log_watch.cpp", 'if (!news_) own_',
           'if (!news_ && !PLANTED) own_', "supervisor_test", "LogWatchTest.ALogThatFailsIsAnEventOnceThoughItsStoreKnowsOfNoTrouble"),
]
