# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What defects_in_unit_tests.py puts back into a copy of the code: findings of review, each with the test that sees it."""
from dataclasses import dataclass

SUPERVISION, CYCLE = "supervisor/supervision", "hirosco/subsystem/cycle/cycle.cpp"
PERMIT, SAYS = "hirosco/subsystem/cycle/permit_watch.cpp", "hirosco/subsystem/cycle/report_writer.cpp"
GUARD, LOOP_WATCH = "supervisor/guard/guard.cpp", "supervisor/guard/loop_watch.cpp"
MANIPULATOR = "subsystems/manipulator/manipulator.cpp"
PERMISSION, LINK_ENDS = f"{SUPERVISION}/data_handling/permission.cpp", "hirosco/subsystem/service_loop/link_ends.cpp"
RECEPTION, GROUND_LINK = f"{SUPERVISION}/data_handling/reception.cpp", "subsystems/communication/ground_clients.cpp"
MODES = f"{SUPERVISION}/modes/modes.cpp"
TELECOMMANDS, RETRIEVAL = f"{SUPERVISION}/data_handling/telecommands.cpp", f"{SUPERVISION}/data_handling/retrieval.cpp"
DEVICE, LOG_STORE = "simulation/devices/simulated_device.cpp", "supervisor/platform/storage/log_store.cpp"
STANDARD_ERROR, MANIPULATOR_TEST = "supervisor/platform/launch/standard_error.cpp", "manipulator_subsystem_test"


@dataclass(frozen=True)
class Defect:
    """Text `now` of a file was `was` where PLANTED, which is true in the run that has this defect; the tests of `filter` in the
    program `test` must see it. A descriptor is read by each run: there `was` is all that stands."""
    name: str
    file: str
    now: str
    was: str
    test: str
    filter: str

    @property
    def is_read(self):
        return self.file.endswith(".xml")

    @property
    def planted(self):
        return self.was.replace("PLANTED", f'::planted("{self.name}")')


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
    Defect("SF1 its states", PERMISSION, 'if (asked.calls("SET_STATE") || asked.calls("CONFIGURE")) return wrong_mode',
           'if (!PLANTED && (asked.calls("SET_STATE") || asked.calls("CONFIGURE"))) return wrong_mode',
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
    # Nobody said that telecommands were held back by a log that stores nothing.
    Defect("log fails without an event", f"{SUPERVISION}/data_handling/log_watch.cpp", 'if (!news_) own_',
           'if (!news_ && !PLANTED) own_', "supervisor_test", "LogWatchTest.ALogThatFailsIsAnEventOnceThoughItsStoreKnowsOfNoTrouble"),

    # --- the cycle and the generic subsystem -----------------------------------------------------------------------------
    # Framework events existed where the descriptor declared them: without one the unplug was never noticed.
    Defect("SF7 undeclared loss", "hirosco/descriptor/model/framework_events.cpp",
           "for (std::size_t i = 0; i < subsystem.devices.size(); ++i)\n    add(",
           "for (std::size_t i = PLANTED ? subsystem.devices.size() : 0; i < subsystem.devices.size(); ++i)\n    add(",
           "subsystem_test", "Events.OfTheFrameworkAreThereThoughTheDescriptorDeclaresNone"),
    # The report of a loss was anybody's to switch off.
    Defect("R38 silenced loss", PERMISSION, "    if (event->safety || (asked", "    if ((event->safety && !PLANTED) || (asked",
           "supervisor_test", "SafetyMark.NobodySwitchesOffWhatSafetyRestsOnInWhateverModeAndState"),
    # Recovery heard events as reports: one whose report was off was not heard.
    Defect("SF6 heard as a report", "hirosco/subsystem/service_loop/reports.cpp",
           "if (octets) backlog_.send(channel_, {.kind = MessageKind::Event",
           "if (octets && (!PLANTED || reported == pus::Reported::Yes)) backlog_.send(channel_, {.kind = MessageKind::Event",
           "subsystem_test", "Events.ReachTheSupervisorThoughTheirReportIsSwitchedOff"),
    # The cycle did not look at the supervisor's heartbeat.
    Defect("SF8 cycle without supervisor", PERMIT, "if (silent_cycles_ > silence_limit_) parts_.control.inhibit(",
           "if (silent_cycles_ > silence_limit_ && !PLANTED) parts_.control.inhibit(",
           "subsystem_test", "SupervisorGone.TheCycleItselfInhibitsTheActuatorsInItsOwnCyclesThoughTheServiceLoopIsStuck"),
    # In real time no sample started a cycle: the thread slept by the clock.
    Defect("no sample starts a cycle", "hirosco/subsystem/process/loops.cpp", "rest_until(planned, subsystem_.cycle_wait(), clock_);",
           "PLANTED ? (sleep_until(planned), std::optional<Duration>{}) : rest_until(planned, subsystem_.cycle_wait(), clock_);",
           "subsystem_concurrency_test", "CycleThreads.BeginACycleWithTheSampleThatStartsIt"),
    # One more than can be known to be under way left, and nobody told of it when its addressee died.
    Defect("more than can be told", TELECOMMANDS, "if (parts_.unanswered.full() && !essential && !to_itself)",
           "if (parts_.unanswered.full() && !essential && !to_itself && !PLANTED)",
           "supervisor_test", "TelecommandsTest.OneWhoseEndCouldNotBeToldIsRefusedButWhatProtectsLeaves"),
    # The entry into Operational forgot that a node had failed in the cycle before.
    Defect("SF10 entry forgets failure", CYCLE, "if (control_.failed()) return \"a node",
           "if (control_.failed() && !PLANTED) return \"a node",
           "subsystem_test", "FailedNode.StaysInhibitedAndRefusesAnEntryIntoOperationalThatWasOnItsWay"),
    # The pass of a self test that was voided on the way into Operational; the service loop alone had looked.
    Defect("entry without the self test", CYCLE, "return required && !self_test_.passed() ?",
           "return !PLANTED && required && !self_test_.passed() ?",
           "subsystem_test", "RequiredSelfTest.IsLookedAtAgainByTheCycleThatWouldPutOut"),
    Defect("pass outlives its device", "hirosco/subsystem/cycle/self_test_run.cpp",
           "lose_device(std::int64_t index) noexcept {\n  passed_", "lose_device(std::int64_t index) noexcept {\n  if (!PLANTED) passed_",
           "subsystem_test", "RequiredSelfTest.IsVoidAfterADeviceWasLost"),
    # One bit of the page decided: flipped, it enabled.
    Defect("SF19 one bit of the page", PERMIT, "(epoch != entered_epoch_ || !page().permits(epoch))",
           "(epoch != entered_epoch_ || (!PLANTED && !page().permits(epoch)))",
           "subsystem_test", "Devices.NoFlippedBitOfAFencedPermitPage*"),
    # An author's events without end took the room of what the framework has to tell.
    Defect("events crowd out the loss", SAYS, "if (event.id >= descriptor::framework_event::first) return answer(",
           "if (event.id >= descriptor::framework_event::first && !PLANTED) return answer(",
           "subsystem_test", "Rings.FullOfAnAuthorsEventsStillTellThatADeviceIsLost"),
    # ... and of answers to telecommands.
    Defect("events crowd out answers", SAYS,
           "RecordRing& ring = rings_.events;\n  if (event.severity < descriptor::Severity::Medium &&",
           "RecordRing& ring = PLANTED ? rings_.answers : rings_.events;\n"
           "  if (!PLANTED && event.severity < descriptor::Severity::Medium &&",
           "subsystem_test", "Rings.FullOfAnAuthorsEventsAndProgressLoseNoAnswerAndTellWhatTheyLost"),
    # Events with arrays had another length than their descriptor, and were never reported.
    Defect("events with arrays", "hirosco/pus/st05_event/event_service.cpp", "octets += argument.octets();",
           "octets += PLANTED ? hirosco::octets_of(argument.type) : argument.octets();",
           "subsystem_test", "Events.WithArrayArgumentsArriveWhole"),
    # A second link into a set was taken; its end ended the first.
    Defect("second link into a set", LINK_ENDS, 'return has_another ? "the set', 'return has_another && !PLANTED ? "the set',
           "subsystem_test", "Links.ASecondOneIntoARequiredSetIsRefusedAndDetachingItLeavesTheFirst"),
    # Links were made in Operational.
    Defect("link in Operational", LINK_ENDS, "if (settled && parts_.at.state != State::PreOperational)",
           "if (settled && parts_.at.state != State::PreOperational && !PLANTED)",
           "subsystem_test", "Links.IntoASetThatIsNeededAreMadeInPreOperationalOnly"),
    # The ninth consumer of a set was attached and never got a sample.
    Defect("ninth consumer", "hirosco/subsystem/cycle/link_slots.cpp",
           "    bool encoded = false;\n    for (AttachedLink* link = first_; link != nullptr; link = link->next) {",
           "    bool encoded = false;\n    int place = 0;\n"
           "    for (AttachedLink* link = first_; link != nullptr && (place < 8 || !PLANTED); link = link->next, ++place) {",
           "subsystem_test", "Links.AsManyConsumersOfASetAsThereAreLinksGetItsSamples"),
    # A failed Post-Operational reached Offline with configuration, plan and flows in place.
    Defect("failed way down keeps all", "hirosco/subsystem/service_loop/state_machine.cpp",
           "if (failed == State::PostOperational && at_.configuration != nullptr) {",
           "if (failed == State::PostOperational && at_.configuration != nullptr && !PLANTED) {",
           "subsystem_test", "FailedPostOperational.GivesBackConfigurationPlanAndFlowsWhenTheCycleHasComeToRest"),
    # A failed Software-Deinit left all that its author had named, in pools that went, and the next Software-Init found it there.
    Defect("failed deinit leaves all named", "hirosco/subsystem/service_loop/introduction.cpp", "if (begun_) forget();",
           "if (begun_ && !PLANTED) forget();",
           "subsystem_test", "PoolsOfStates.GoBackThoughTheAuthorsOwnSoftwareDeinitFails"),
    # Arguments were narrowed to the handler's types without a word.
    Defect("narrowed arguments", "hirosco/subsystem/service_loop/introduction.cpp",
           "handler.takes, found->arguments))\n    mistake(std::move(problem));",
           "handler.takes, found->arguments))\n    if (!PLANTED) mistake(std::move(problem));",
           "subsystem_test", "AuthorsMistakes.AHandlerThatWouldNarrowAnArgumentIsNotTaken"),
    # Ports were compared by CONFIGURE, in the configuration that was commanded: the others were found when a recovery plan wanted them.
    Defect("ports of the flown configuration only", "hirosco/subsystem/service_loop/introduction.cpp",
           "for (Mistake& made : parts_.ports.mistakes(configuration)) mistake(",
           "for (Mistake& made : parts_.ports.mistakes(configuration)) if (!PLANTED) mistake(",
           "subsystem_test", "AuthorsMistakes.AreToldAllAtOnce"),
    # What was wrong with the parameters of a descriptor that is built in code was told to a member not yet made.
    Defect("twice in a dictionary", "hirosco/subsystem/service_loop/introduction.cpp", "if (!parts_.values.problem().empty()) mistake(",
           "if (!parts_.values.problem().empty() && !PLANTED) mistake(",
           "subsystem_test", "AuthorsMistakes.OfADescriptorBuiltInCodeAreToldAndCrashNothing"),
    # An author's reason became "node failed".
    Defect("reason of a node", CYCLE, "result.error());",
           'PLANTED ? Error{ErrorCode::Internal, "node failed", 0} : result.error());',
           "subsystem_test", "Events.OfAFailedStateCarryTheAuthorsWordsAndNumber"),
    # A function's became a number.
    Defect("reason of a function", SAYS, ".request = request}, why);",
           '.request = request}, PLANTED ? Error{why.code, "", 0} : why);',
           "subsystem_test", "Refusals.CarryTheAuthorsCodeWordsAndNumber"),
    # A lost device was silent, whatever it had said.
    Defect("reason of a loss", "hirosco/subsystem/cycle/device_slot.cpp", "  blame(loss.damaged, Damaged);",
           "  if (!PLANTED) blame(loss.damaged, Damaged);",
           "subsystem_test", "Devices.ALostDeviceSaysWhetherItWasSilentDamagedOfTheWrongSizeOrRepeatedItself"),
    # A write was completed that the next cycle overwrote.
    Defect("overwritten parameter", "hirosco/subsystem/service_loop/parameter_values.cpp", "cycle_.writes_itself(place->index))",
           "cycle_.writes_itself(place->index) && !PLANTED)",
           "subsystem_test", "ParameterWrites.ThatTheNextCycleWouldOverwriteAreRefused"),

    # --- the manipulator -------------------------------------------------------------------------------------------------
    # The hard limit was silent once the soft one had tripped.
    Defect("SF21 silent hard limit", "subsystems/manipulator/control/sensor_limits.cpp", "if (finding.verdict <= told_) return",
           "if (finding.verdict <= told_ || (PLANTED && told_ != TorqueVerdict::Fine)) return",
           MANIPULATOR_TEST, "ManipulatorTest.TheHardLimitStaysOnWatchAfterTheSoftOneTripped"),
    # ... and was watched only while the actuators were enabled.
    Defect("SF21 limit when inhibited", MANIPULATOR, "  if (!found) return;\n  inhibit_actuators();",
           "  if (!found || (PLANTED && !cycle.active)) return;\n  inhibit_actuators();",
           MANIPULATOR_TEST, "ManipulatorTest.TheHardLimitIsOnWatchInSafeOperationalToo"),
    # A motion of any speed was taken.
    Defect("SF21 any speed", MANIPULATOR, "if (duration_s < manipulator::shortest_duration_s(",
           "if (duration_s < (PLANTED ? 0 : 1) * manipulator::shortest_duration_s(",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionFasterThanTheArmsLimitsIsRefused"),
    # MOVE_TO was done when its time was over.
    Defect("SF22 done by time", "subsystems/manipulator/control/trajectory.cpp", "<= tolerance_rad;",
           "<= tolerance_rad + (PLANTED ? 1e9 : 0);",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionThatDoesNotArriveFailsInsteadOfCompletingByTime"),
    # HOLD was completed where actuators were inhibited.
    Defect("SF22 function without effect", MANIPULATOR, "if (!moving_) return refused(Trouble::actuators_inhibited);\n    stop_tasks(",
           "if (!moving_ && !PLANTED) return refused(Trouble::actuators_inhibited);\n    stop_tasks(",
           MANIPULATOR_TEST, "ManipulatorTest.WhatCanHaveNoEffectIsRefused"),
    # New gains came as a kick.
    Defect("SF22 gains at once", "subsystems/manipulator/control/joint_controller.cpp",
           "towards(now_.kp_n_m_per_rad, wanted.kp_n_m_per_rad, kp_rate_per_s * span_s);",
           "PLANTED ? wanted.kp_n_m_per_rad\n                                : towards(now_.kp_n_m_per_rad, wanted.kp_n_m_per_rad, kp_rate_per_s * span_s);",
           MANIPULATOR_TEST, "ManipulatorTest.NewGainsAreReportedDoneWhenTheLawHasThem"),
    # Limits of temperature in any order were taken.
    Defect("limits out of order", MANIPULATOR,
           "if (!(warning_c < critical_c && critical_c < maximum_c)) return",
           "if (!(warning_c < critical_c && critical_c < maximum_c) && !PLANTED) return",
           MANIPULATOR_TEST, "ManipulatorTest.TemperatureLimitsAscend"),
    # A limit below the load was taken, and the next Operational lasted 0.2 s.
    Defect("limit below the load", MANIPULATOR, "< limit_n_m)) return refused(", "< limit_n_m) && !PLANTED) return refused(",
           MANIPULATOR_TEST, "ManipulatorTest.ATorqueLimitBelowThePresentLoadIsRefused"),
    # A motion that the limit ended said "aborted".
    Defect("tripped, told as aborted", "subsystems/manipulator/sensor_watch.cpp", "if (torque_guard_.tripped()) return static_cast",
           "if (torque_guard_.tripped() && !PLANTED) return static_cast",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionThatTheTorqueLimitEndsSaysSo"),

    # --- devices ---------------------------------------------------------------------------------------------------------
    # Whoever knew the epoch moved the actuator: there was no second inhibit.
    Defect("SF16 one inhibit", "simulation/devices/simulated_inhibit.cpp", "if (!endnode_) return true;", "if (!endnode_ || PLANTED) return true;",
           "robot_device_test", "Enable.*"),
    # Every stop was zero torque.
    Defect("SF17 every stop drops", "simulation/devices/obedience.cpp", "case Controlled: output_ = stop_left_ > Duration{0} ?",
           "case Controlled: output_ = PLANTED ? DeviceOutput::Off : stop_left_ > Duration{0} ?",
           "robot_device_test", "DeclaredStop.*"),
    # An exchange moved a device's clock by at least one cycle, and the rest was forgotten.
    Defect("own clock", "simulation/devices/world_clock.cpp", "  if (!exchanged && behind < planned_step()) return 0;",
           "  if (exchanged && PLANTED) {\n    by_own_clock_ = false;\n    world_time_ = now;\n"
           "    return std::max<std::int64_t>(1, (behind + cycle_ / 2) / cycle_);\n  }\n"
           "  if (!exchanged && behind < planned_step()) return 0;",
           "robot_device_test", "OwnClock.MakesTimeThroughPeriodCyclesWhateverTheRatioOfPeriods"),
    # A step that the watchdog of one device forgave had the world stand for all that are in it.
    Defect("a world of two stands", DEVICE, "&& acts() && has_world_alone();",
           "&& acts() && (PLANTED || has_world_alone());",
           "simulated_device_test", "StarvedDevice.WhoseWorldIsAnothersToo*"),
    # A device spoke its own byte order, whatever its endnode's was.
    Defect("byte order of a device", DEVICE, "OctetWriter writer{payload, settings_.byte_order};",
           "OctetWriter writer{payload, PLANTED ? std::endian::little : settings_.byte_order};",
           "robot_device_test", "RobotDevice.SpeaksTheByteOrderOfItsEndnode"),

    # A pressed finger crept for the step's sake.
    Defect("creeping finger", "simulation/devices/robot/world/two_joint_arm.cpp", "const int pieces = pieces_of(x, h);",
           "const int pieces = std::min(pieces_of(x, h), PLANTED ? 1 : 1'000'000);",
           "robot_world_test", "TwoJointArm.AFingerThatSticksDoesNotCreepForTheStepSizesSakeHoweverHardItPresses"),

    # --- ground link, log, descriptors -----------------------------------------------------------------------------------
    # A packet cut off by the end of its stream was in no counter.
    Defect("cut off and not counted", GROUND_LINK, "if (ended_) spoil(", "if (ended_ && !PLANTED) spoil(",
           "ground_link_test", "Deframer.SaysOfAPacketThatTheEndOfTheStreamCutsOffThatItIsIncomplete"),
    # What nobody could take was gone.
    Defect("SF3 excess is dropped", GROUND_LINK, "      ++counters_.held_back;\n      return false;",
           "      ++counters_.held_back;\n      if (!PLANTED) return false;",
           "ground_link_test", "GroundClients.KeepWhatNobodyTakesAndReadNoMoreOfWhoSentIt"),
    # Who had to make room or sent half a packet was cut without a word.
    Defect("cut without a word", "subsystems/communication/communication.cpp", "    if (closed == cuts_told_[place]) continue;",
           "    if (closed == cuts_told_[place] || (PLANTED && reason != CloseReason::Slow)) continue;",
           "communication_subsystem_test", "OpenLink.TellsEachConnectionThatTheSpacecraftEndsWithItsReasonAndNoOther"),
    # The addresses of the ground link in a mission were ignored.
    Defect("addresses of the ground link", "subsystems/communication/tcp_server.cpp",
           "  HIROSCO_TRY(split(telecommand, options.telecommand_address, options.telecommand_port));",
           "  if (!PLANTED) HIROSCO_TRY(split(telecommand, options.telecommand_address, options.telecommand_port));",
           "ground_link_test", "TcpServerTest.*Address*"),
    # The first epoch of every flight was 1.
    Defect("SF11 epoch of every flight", "supervisor/platform/storage/epoch_file.cpp", "static_cast<std::uint32_t>(first);",
           "static_cast<std::uint32_t>(PLANTED ? 1 : first);",
           "platform_test", "EpochFileTest.*"),
    # Telecommands went on as if durable after somebody had deleted the log.
    Defect("deleted log", LOG_STORE, "if (file_.none()) return Look::Whole;",
           "if (file_.none() || PLANTED) return Look::Whole;",
           "platform_test", "*NoticesThatItsFileWasDeletedBeginsAnewAndCountsWhatWentWithIt*"),
    # One failed fsync was the end of the log.
    Defect("failed fsync", LOG_STORE, "  leave_piece();\n", "  if (!PLANTED) leave_piece();\n",
           "platform_test", "LogStore.LeavesASegmentAfterAFailedFsyncAndWritesWhatWasNotAcknowledgedToTheNext"),
    # After a full disk storing did not resume by itself.
    Defect("full disk for ever", LOG_STORE, "  if (fault != StoreFault::Locked) store_.reset();",
           "  if (fault != StoreFault::Locked && !PLANTED) store_.reset();",
           "platform_test", "LogStore.StaysInItsSegmentWhenTheDiskIsFullAndResumesByItself"),
    # One talkative subsystem filled the console.
    Defect("talkative without limit", STANDARD_ERROR, "return ++found->second <= most_;",
           "return ++found->second <= most_ || PLANTED;",
           "platform_test", "StandardErrorLines.OfATalkativeSpeakerAreLimitedAndCountedExactlyAndNobodyElsesAre"),
    # ... and sent escape codes to the terminal.
    Defect("escape codes", STANDARD_ERROR,
           r'else clean += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(letter)));',
           r'else clean += PLANTED ? std::string(1, letter) : fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(letter)));',
           "platform_test", "StandardErrorLines.ShowControlCharactersAsText"),
    # The search of the log minded case and did not look at what is shown.
    Defect("search minds case", "supervisor/platform/storage/database.cpp",
           "return lower_case(words).find(lower_case(query.text)) != std::string::npos;",
           "return (PLANTED ? words.find(query.text) : lower_case(words).find(lower_case(query.text))) != std::string::npos;",
           "platform_test", "LogSearch.FindsWhatIsShownWhateverItsCase"),
    # SHUTDOWN waited for a stalled log and was then refused.
    Defect("SF12 SHUTDOWN waits for the disk", "supervisor/supervisor.xml",
           '<Function name="SHUTDOWN" states="PreOperational SafeOperational Operational ErrorOperational" essential="yes" confirm="yes">',
           '<Function name="SHUTDOWN" states="PreOperational SafeOperational Operational ErrorOperational" confirm="yes">',
           "descriptor_test", "ShippedMissions.WhatStopsOrEndsTheFlightOrReplacesTheLogWaitsForNoDisk"),
    # Numbers of a programme had no range: 1e300 was accepted.
    Defect("SF24 number without a range", "subsystems/manipulator/manipulator.xml",
           '<ParamRef name="SPEED" id="130" type="DOUBLE" unit="m/s" minimum="0.002" maximum="0.040"/>',
           '<ParamRef name="SPEED" id="130" type="DOUBLE" unit="m/s"/>',
           "descriptor_test", "ShippedMissions.EveryNumberFromOutsideHasARange"),
    # What was declared in one configuration held in all, without a word.
    Defect("function of one configuration", "hirosco/descriptor/read/read_services.cpp",
           "if (services.configurations < 2) return;",
           "if (services.configurations < 2 || PLANTED) return;",
           "descriptor_test", "SubsystemErrors.*"),
    # A function passed `check` that no telecommand can call.
    Defect("more than a call holds", "hirosco/descriptor/read/read_functions.cpp", "if (octets > max_argument_octets)",
           "if (octets > max_argument_octets && !PLANTED)",
           "descriptor_test", "SubsystemErrors.*"),
    # `check` took a period of which somebody else is declared hung.
    Defect("period of a microsecond", "hirosco/descriptor/read/read_configuration.cpp",
           '"sampling_us", least_sampling_us, max_sampling_us)',
           '"sampling_us", PLANTED ? 1 : least_sampling_us, max_sampling_us)',
           "descriptor_test", "SubsystemErrors.*"),
    # ... and names that differ in case only.
    Defect("names that differ in case", "hirosco/descriptor/read/detail/element_reader.cpp",
           "  std::ranges::transform(folded, folded.begin(), lower);",
           "  if (!PLANTED) std::ranges::transform(folded, folded.begin(), lower);",
           "descriptor_test", "SubsystemErrors.*"),
    # Two ends of a flow in shared memory that closed at once each found the other still there: a name of the flight was left.
    Defect("closing without a turn", "hirosco/data_transfer/device/shared_memory_flow.cpp",
           "  if (!take_turn_to_close(file_.get(), octet_of_closing)) return;",
           "  if (!PLANTED && !take_turn_to_close(file_.get(), octet_of_closing)) return;",
           "data_transfer_test", "SharedMemoryFlow.LeavesNoNameBehindWhenBothSidesCloseAtOnce"),
    # Whoever had a device in shared memory cut the frames of all others short, and they died of it.
    Defect("SF13 one folder of frames for all", "hirosco/data_transfer/device/shared_memory_flow.cpp",
           "let_write(device_memory_folder(address), sandbox);",
           "let_write(PLANTED ? device_memory_root : device_memory_folder(address), sandbox);",
           "platform_test", "SubsystemSandbox.OpensTheFolder*"),
    # A stop that a keeper had counted and not handed on when it died was carried out by nobody.
    Defect("R61 a stop that went with its keeper", "supervisor/keeper_watch.cpp",
           "found.stop = page_.stops_asked.load() != page_.stops_taken.load();",
           "found.stop = !PLANTED && page_.stops_asked.load() != page_.stops_taken.load();",
           "flight_shell_test", "KeeperWatchTest.AStopThat*"),
    # One that had ended, and that nobody had heard of, was said to have been signalled for a stop.
    Defect("R61 a keeper that has ended", "tools/hirosco/our_process.cpp",
           "  if (end && *end) return std::nullopt;",
           "  if (!PLANTED && end && *end) return std::nullopt;",
           "flights_test", "OurProcess.IsNoneThatHasEnded*"),
    # Whoever had the number of a supervisor by then would have been ended in its place.
    Defect("R61 a number that is somebody else's by now", "tools/hirosco/our_process.cpp",
           "  if (::poll(&connection, 1, 0) != 0) return std::nullopt;",
           "  if (!PLANTED && ::poll(&connection, 1, 0) != 0) return std::nullopt;",
           "flights_test", "OurListener.IsNobodyBehind*"),
]
