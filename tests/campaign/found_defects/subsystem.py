# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review in the cycle and the generic subsystem."""
from .defect import CYCLE, LINK_ENDS, PERMISSION, PERMIT, SAYS, TELECOMMANDS, Defect

DEFECTS = [
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
]
