#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review and the unit test that sees each: the old mistake is put back into a copy of the sources, one at a time;
the one test that guards it is built and must fail there, and pass once the code is as it is. plants_in_code.py does the same
with flights (SF1, SF4, SF5, SF6, SF14, outcomes and clocks), tests/fault with real processes (SF2, SF3, SF13).
defects_in_code.py [--list] [--only NAME]...
"""
import argparse, os, pathlib, re, shutil, subprocess, sys, time
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
COPY = ROOT / "build" / "defects" / "sources"
BUILD = COPY / "build" / "release"
TEST_LIMIT_S = 300

SUPERVISION, CYCLE = "supervisor/supervision", "hirosco/subsystem/cycle/cycle.cpp"
GUARD, MANIPULATOR = "supervisor/guard/guard.cpp", "subsystems/manipulator/manipulator.cpp"
PERMISSION, LINK_ENDS = f"{SUPERVISION}/data_handling/permission.cpp", "hirosco/subsystem/engine/link_ends.cpp"
RECEPTION, GROUND_LINK = f"{SUPERVISION}/data_handling/reception.cpp", "subsystems/communication/ground_link.cpp"
DEVICE, LOG_STORE = "simulation/devices/simulated_device.cpp", "supervisor/platform/storage/log_store.cpp"
ERROR_LINES, MANIPULATOR_TEST = "supervisor/platform/launch/error_lines.cpp", "manipulator_subsystem_test"


@dataclass(frozen=True)
class Defect:
    """Text `now` of a file was `was`; the tests of `filter` in the program `test` are those that must see it."""
    name: str
    file: str
    now: str
    was: str
    test: str
    filter: str


DEFECTS = [
    # --- the guard -------------------------------------------------------------------------------------------------------
    # All who share a processor with a cycle that loops for ever were told as hung, the first of them as the culprit.
    Defect("SF2 culprit", GUARD, "GuardedMember& culprit = spinner(member);", "GuardedMember& culprit = member;",
           "supervisor_test", "GuardTest.OfThoseThatStandStillTheOneThatHasTheProcessorIsTheCulprit"),
    # Who hung was told, and went on hanging.
    Defect("SF2 nobody is ended", GUARD, "  member.killed = true;\n  if (member.grip) member.grip->kill();\n", "  member.killed = true;\n",
           "supervisor_test", "GuardTest.OneThatStandsStillIsFencedToldAndEndedAfterTheGrace"),
    # Nobody watched the service loop.
    Defect("SF8 service loop stands", GUARD, "    if (!member.doomed) observe_service(member, now);\n", "",
           "supervisor_test", "GuardTest.AServiceLoopThatStandsStillIsAHang"),
    # A supervisor that lives and does not step was in nobody's list.
    Defect("SF18 supervisor stands still", GUARD, "  watch_supervisor(watched_);\n", "",
           "supervisor_test", "GuardTest.ASupervisorThatStandsStillStopsEverythingThatMoves"),
    # Who overwrote its own vital page was passed over.
    Defect("SF23 overwritten page", GUARD, "      doom(member, GuardFinding::Kind::PageDamaged, now);\n      continue;", "      continue;",
           "supervisor_test", "GuardTest.AVitalPageThatIsOverwrittenIsAHangWhateverIsWritten"),

    # --- the supervisor --------------------------------------------------------------------------------------------------
    # Reports for the ground were dropped with the housekeeping when the link was behind.
    Defect("SF3 reports dropped", f"{SUPERVISION}/data_handling/ground_route.cpp", "auto& queue = kind == Kind::Housekeeping ? housekeeping_ : reports_;",
           "auto& queue = housekeeping_;",
           "supervisor_test", "GroundRouteTest.DropsTheOldestHousekeepingAndNoReport"),
    # What a subsystem sent and nobody could read closed its channel, and it was killed.
    Defect("SF9 damage is a loss", RECEPTION, "if (is_damage(found.error().code)) continue;",
           "if (is_damage(found.error().code)) member.refused = most_refused;",
           "supervisor_test", "ReceptionTest.DamageIsCountedAndWhatFollowsIsRead"),
    # Who was judged gone went on moving until it was killed.
    Defect("SF9 gone and not fenced", RECEPTION, "      craft_.guard.fence(member.apid());\n", "",
           "supervisor_test", "ReceptionTest.WhoCanBeNeitherCommandedNorHeardIsStoppedAtOnce"),
    # A mode was entered whose members were dead.
    Defect("SF15 mode of the dead", f"{SUPERVISION}/modes/modes.cpp", "[&](const auto& step) { return lives(step); }",
           "[&](const auto& step) { return lives(step) || true; }",
           "supervisor_test", "ModesTest.AModeWhoseMembersAreDeadIsRefusedUntilTheyLiveAgain"),
    # Permission looked at services, not at parameters.
    Defect("SF20 any parameter", PERMISSION, "if (const auto refused = write_refused(asked)) return refused;",
           "if (const auto refused = write_refused(asked); refused && false) return refused;",
           "supervisor_test", "Permission.AParameterIsWrittenOnlyInItsStatesAndOnlyWhereTheModeOpensIt"),
    # "Commissioned" was told of members that a recovery had taken down.
    Defect("commissioned and Offline", f"{SUPERVISION}/modes/commissioning.cpp", "if (missing.empty() && (subject == nullptr ||",
           "if (missing.empty() && false && (subject == nullptr ||",
           "supervisor_test", "CommissioningTest.WhoWasTakenDownAfterItsOwnStepIsMissed"),
    # Plans for the supervisor's own events were accepted and never fired.
    Defect("plans of own events", f"{SUPERVISION}/event_handling/reactions.cpp",
           "if (from == supervisor_apid) react_to_own(name, severity);\n  else if", "if",
           "supervisor_test", "ReactionsTest.APlanForAnEventOfTheSupervisorItselfConcernsAllThatAct"),
    # A budget below what is drawn took nothing from anybody.
    Defect("lowered power budget", f"{SUPERVISION}/resource_management/power_handling.cpp",
           '    reactions_.react(*subject, "LOAD_SHED", Severity::High);\n', "",
           "supervisor_test", "PowerHandlingTest.OfABudgetThatNoLongerHoldsTheLastOfTheMissionIsShedFirstTheGroundLinkNever"),
    # Nobody said that telecommands were held back by a log that stores nothing.
    Defect("log fails without an event", f"{SUPERVISION}/data_handling/log_watch.cpp", '  if (failing && !news) own_.announce("LOG_STORE");\n', "", "supervisor_test", "LogWatchTest.*"),

    # --- the cycle and the generic subsystem -----------------------------------------------------------------------------
    # Framework events existed where the descriptor declared them: without one the unplug was never noticed.
    Defect("SF7 undeclared loss", "hirosco/descriptor/model/framework_events.cpp", "for (std::size_t i = 0; i < subsystem.devices.size(); ++i)",
           "for (std::size_t i = subsystem.devices.size(); i < subsystem.devices.size(); ++i)",
           "subsystem_test", "Events.OfTheFrameworkAreThereThoughTheDescriptorDeclaresNone"),
    # The cycle did not look at the supervisor's heartbeat.
    Defect("SF8 cycle without supervisor", CYCLE, "  if (silent_cycles_ > silence_limit_) inhibit(inhibited_by_supervisor);\n", "",
           "subsystem_test", "SupervisorGone.TheCycleItselfInhibitsTheActuatorsInItsOwnCyclesThoughTheServiceLoopIsStuck"),
    # The entry into Operational forgot that a node had failed in the cycle before.
    Defect("SF10 entry forgets failure", CYCLE, "(inhibited_ & inhibited_by_failure) != 0)\n    return report(",
           "(inhibited_ & inhibited_by_failure) != 0 && false)\n    return report(",
           "subsystem_test", "FailedNode.StaysInhibitedAndRefusesAnEntryIntoOperationalThatWasOnItsWay"),
    # One bit of the page decided: flipped, it enabled.
    Defect("SF19 one bit of the page", CYCLE, "(epoch != entered_epoch_ || !parts_.permit.permits(epoch))", "epoch != entered_epoch_",
           "subsystem_test", "Devices.NoFlippedBitOfAFencedPermitPageReachesAnActuator"),
    # An author's events without end took the room of what the framework has to tell.
    Defect("events crowd out the loss", CYCLE, "  if (event.id >= descriptor::framework_event::first) return answer(head, auxiliary);\n", "",
           "subsystem_test", "Rings.FullOfAnAuthorsEventsStillTellThatADeviceIsLost"),
    # ... and of answers to telecommands.
    Defect("events crowd out answers", CYCLE, "RecordRing& ring = parts_.handover.events;\n  if (event.severity < descriptor::Severity::Medium &&",
           "RecordRing& ring = parts_.handover.answers;\n  if (event.severity < descriptor::Severity::Info &&",
           "subsystem_test", "Rings.FullOfAnAuthorsEventsAndProgressLoseNoAnswerAndTellWhatTheyLost"),
    # Events with arrays had another length than their descriptor, and were never reported.
    Defect("events with arrays", "hirosco/pus/st05_event/event_service.cpp", "octets += argument.octets();",
           "octets += hirosco::octets_of(argument.type);", "subsystem_test", "Events.WithArrayArgumentsArriveWhole"),
    # A second link into a set was taken; its end ended the first.
    Defect("second link into a set", LINK_ENDS, 'return has_another ? "the set', 'return has_another && false ? "the set',
           "subsystem_test", "Links.ASecondOneIntoARequiredSetIsRefusedAndDetachingItLeavesTheFirst"),
    # Links were made in Operational.
    Defect("link in Operational", LINK_ENDS, "if (settled && state_ != State::PreOperational)", "if (settled && !is_cyclic(state_))",
           "subsystem_test", "Links.IntoASetThatIsNeededAreMadeInPreOperationalOnly"),
    # The ninth consumer of a set was attached and never got a sample.
    Defect("ninth consumer", "hirosco/subsystem/cycle/link_slots.cpp",
           "    bool encoded = false;\n    for (AttachedLink* link = first_; link != nullptr; link = link->next) {",
           "    bool encoded = false;\n    int place = 0;\n    for (AttachedLink* link = first_; link != nullptr && place < 8; link = link->next, ++place) {",
           "subsystem_test", "Links.AsManyConsumersOfASetAsThereAreLinksGetItsSamples"),
    # A failed Post-Operational reached Offline with configuration, plan and flows in place.
    Defect("failed way down keeps all", "hirosco/subsystem/engine/state_machine.cpp",
           "if (at == State::PostOperational && configuration_ != nullptr) {",
           "if (at == State::PostOperational && configuration_ != nullptr && false) {",
           "subsystem_test", "FailedPostOperational.GivesBackConfigurationPlanAndFlowsWhenTheCycleHasComeToRest"),
    # Arguments were narrowed to the handler's types without a word.
    Defect("narrowed arguments", "hirosco/subsystem/engine/bindings.cpp", "handler.takes, found->arguments))\n    mistake(std::move(problem));",
           "handler.takes, found->arguments))\n    static_cast<void>(problem);",
           "subsystem_test", "AuthorsMistakes.AHandlerThatWouldNarrowAnArgumentIsNotTaken"),
    # What was wrong with the parameters of a descriptor that is built in code was told to a member not yet made.
    Defect("twice in a dictionary", "hirosco/subsystem/engine/bindings.cpp",
           "  if (!dictionary_problem_.empty()) mistake(dictionary_problem_);\n", "",
           "subsystem_test", "AuthorsMistakes.OfADescriptorBuiltInCodeAreToldAndCrashNothing"),
    # An author's reason became "node failed".
    Defect("reason of a node", CYCLE, "const AuthorsError failure{result.error()};",
           'const AuthorsError failure{Error{ErrorCode::Internal, "node failed", 0}};',
           "subsystem_test", "Events.OfAFailedStateCarryTheAuthorsWordsAndNumber"),
    # A function's became a number.
    Defect("reason of a function", CYCLE, "const AuthorsError error{why};", 'const AuthorsError error{Error{why.code, "", 0}};',
           "subsystem_test", "Refusals.CarryTheAuthorsCodeWordsAndNumber"),
    # A lost device was silent, whatever it had said.
    Defect("reason of a loss", "hirosco/subsystem/cycle/device_slot.cpp", "  blame(loss.damaged, Damaged);\n", "",
           "subsystem_test", "Devices.ALostDeviceSaysWhetherItWasSilentDamagedOfTheWrongSizeOrRepeatedItself"),
    # A write was completed that the next cycle overwrote.
    Defect("overwritten parameter", "hirosco/subsystem/engine/generic_subsystem.cpp", "cycle_.writes_itself(*index))",
           "cycle_.writes_itself(*index) && false)",
           "subsystem_test", "ParameterWrites.ThatTheNextCycleWouldOverwriteAreRefused"),

    # --- the manipulator -------------------------------------------------------------------------------------------------
    # The hard limit was silent once the soft one had tripped.
    Defect("SF21 silent hard limit", "subsystems/manipulator/control/sensor_limits.cpp", "if (finding.verdict <= told_) return",
           "if (finding.verdict == TorqueVerdict::Fine || told_ != TorqueVerdict::Fine) return",
           MANIPULATOR_TEST, "ManipulatorTest.TheHardLimitStaysOnWatchAfterTheSoftOneTripped"),
    # ... and was watched only while the actuators were enabled.
    Defect("SF21 limit when inhibited", MANIPULATOR, "  if (!finding) return;\n  inhibit_actuators();\n  const bool is_hard",
           "  if (!finding || !cycle.active) return;\n  inhibit_actuators();\n  const bool is_hard",
           MANIPULATOR_TEST, "ManipulatorTest.TheHardLimitIsOnWatchInSafeOperationalToo"),
    # A motion of any speed was taken.
    Defect("SF21 any speed", MANIPULATOR, "if (duration_s < manipulator::shortest_duration_s(", "if (duration_s < 0 * manipulator::shortest_duration_s(",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionFasterThanTheArmsLimitsIsRefused"),
    # MOVE_TO was done when its time was over.
    Defect("SF22 done by time", "subsystems/manipulator/control/trajectory.cpp", "<= tolerance_rad;", "<= tolerance_rad + 1e9;",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionThatDoesNotArriveFailsInsteadOfCompletingByTime"),
    # HOLD was completed where actuators were inhibited.
    Defect("SF22 function without effect", "subsystems/manipulator/manipulator_setup.cpp", "    if (!moving_) return refused(Trouble::actuators_inhibited);\n", "",
           MANIPULATOR_TEST, "ManipulatorTest.WhatCanHaveNoEffectIsRefused"),
    # New gains came as a kick.
    Defect("SF22 gains at once", "subsystems/manipulator/control/joint_controller.cpp",
           "towards(now_.kp_n_m_per_rad, wanted.kp_n_m_per_rad, kp_rate_per_s * span_s);", "wanted.kp_n_m_per_rad;",
           MANIPULATOR_TEST, "ManipulatorTest.NewGainsAreReportedDoneWhenTheLawHasThem"),
    # Limits of temperature in any order were taken.
    Defect("limits out of order", "subsystems/manipulator/manipulator_setup.cpp", "if (!(warning_c < critical_c && critical_c < maximum_c)) return",
           "if (!(warning_c < critical_c && critical_c < maximum_c) && false) return",
           MANIPULATOR_TEST, "ManipulatorTest.TemperatureLimitsAscend"),
    # A limit below the load was taken, and the next Operational lasted 0.2 s.
    Defect("limit below the load", MANIPULATOR, "< limit_n_m)) return refused(", "< limit_n_m) && false) return refused(",
           MANIPULATOR_TEST, "ManipulatorTest.ATorqueLimitBelowThePresentLoadIsRefused"),
    # A motion that the limit ended said "aborted".
    Defect("tripped, told as aborted", MANIPULATOR,
           "  if (torque_guard_.tripped()) return static_cast<pus::FailureCode>(Trouble::torque_tripped);\n", "",
           MANIPULATOR_TEST, "ManipulatorTest.AMotionThatTheTorqueLimitEndsSaysSo"),

    # --- devices ---------------------------------------------------------------------------------------------------------
    # Whoever knew the epoch moved the actuator: there was no second inhibit.
    Defect("SF16 one inhibit", DEVICE, "if (!settings_.enable) return true;", "if (!settings_.enable || true) return true;",
           "robot_device_test", "Enable.*"),
    # Every stop was zero torque.
    Defect("SF17 every stop drops", DEVICE, "output_ = stop_left_ > Duration{0} ? DeviceOutput::Stopping : DeviceOutput::Holding; return;",
           "output_ = DeviceOutput::Off; return;", "robot_device_test", "DeclaredStop.*"),
    # A device spoke its own byte order, whatever its endnode's was.
    Defect("byte order of a device", DEVICE, "OctetWriter writer{payload, settings_.byte_order};", "OctetWriter writer{payload, std::endian::little};",
           "robot_device_test", "RobotDevice.SpeaksTheByteOrderOfItsEndnode"),

    # --- ground link, log, descriptors -----------------------------------------------------------------------------------
    # A packet cut off by the end of its stream was in no counter.
    Defect("cut off and not counted", GROUND_LINK, "    if (ended_) spoil(CloseReason::Incomplete);\n", "",
           "ground_link_test", "Deframer.SaysOfAPacketThatTheEndOfTheStreamCutsOffThatItIsIncomplete"),
    # What nobody could take was gone.
    Defect("SF3 excess is dropped", GROUND_LINK, "      ++counters_.held_back;\n      return false;\n", "      ++counters_.held_back;\n",
           "ground_link_test", "GroundClients.KeepWhatNobodyTakesAndReadNoMoreOfWhoSentIt"),
    # The first epoch of every flight was 1.
    Defect("SF11 epoch of every flight", "supervisor/platform/storage/epoch_file.cpp", "static_cast<std::uint32_t>(first);",
           "static_cast<std::uint32_t>(first > 0 ? 1 : 0);", "platform_test", "EpochFileTest.*"),
    # Telecommands went on as if durable after somebody had deleted the log.
    Defect("deleted log", LOG_STORE, "if (!store_ || file_ == Identity{}) return false;", "if (!store_ || file_ == Identity{} || true) return false;",
           "platform_test", "*NoticesThatItsFileWasDeletedBeginsAnewAndCountsWhatWentWithIt*"),
    # One failed fsync was the end of the log.
    Defect("failed fsync", LOG_STORE, "  leave_segment();\n  note(fault, error,", "  note(fault, error,",
           "platform_test", "LogStore.LeavesASegmentAfterAFailedFsyncAndWritesWhatWasNotAcknowledgedToTheNext"),
    # After a full disk storing did not resume by itself.
    Defect("full disk for ever", LOG_STORE, "  trouble_.present = false;\n  return ok();", "  return ok();",
           "platform_test", "LogStore.StaysInItsSegmentWhenTheDiskIsFullAndResumesByItself"),
    # One talkative subsystem filled the console.
    Defect("talkative without limit", ERROR_LINES, "return ++found->second <= most_;", "return ++found->second <= most_ || true;",
           "platform_test", "ErrorLines.OfATalkativeSpeakerAreLimitedAndCountedExactlyAndNobodyElsesAre"),
    # ... and sent escape codes to the terminal.
    Defect("escape codes", ERROR_LINES, r'else clean += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(letter)));',
           "else clean += letter;", "platform_test", "ErrorLines.ShowControlCharactersAsText"),
    # The search of the log minded case and did not look at what is shown.
    Defect("search minds case", "supervisor/platform/storage/database.cpp", "return lower_case(words).find(lower_case(query.text)) != std::string::npos;",
           "return words.find(query.text) != std::string::npos;",
           "platform_test", "LogSearch.FindsWhatIsShownWhateverItsCase"),
    # SHUTDOWN waited for a stalled log and was then refused.
    Defect("SF12 SHUTDOWN waits for the disk", "supervisor/supervisor.xml",
           '<Function name="SHUTDOWN" states="PreOperational SafeOperational Operational ErrorOperational" essential="yes">',
           '<Function name="SHUTDOWN" states="PreOperational SafeOperational Operational ErrorOperational">',
           "descriptor_test", "ShippedMissions.WhatStopsOrEndsTheFlightOrReplacesTheLogWaitsForNoDisk"),
    # Numbers of a programme had no range: 1e300 was accepted.
    Defect("SF24 number without a range", "subsystems/manipulator/manipulator.xml",
           '<ParamRef name="SPEED" id="130" type="DOUBLE" unit="m/s" minimum="0.002" maximum="0.040"/>',
           '<ParamRef name="SPEED" id="130" type="DOUBLE" unit="m/s"/>',
           "descriptor_test", "ShippedMissions.EveryNumberFromOutsideHasARange"),
    # What was declared in one configuration held in all, without a word.
    Defect("function of one configuration", "hirosco/descriptor/read/read_services.cpp",
           "if (!services.of_configuration || configurations_ < 2) return;", "if (!services.of_configuration || configurations_ < 2 || true) return;",
           "descriptor_test", "SubsystemErrors.*"),
    # A function passed `check` that no telecommand can call.
    Defect("more than a call holds", "hirosco/descriptor/read/read_services.cpp", "if (octets > max_argument_octets)",
           "if (octets > max_argument_octets && false)", "descriptor_test", "SubsystemErrors.*"),
    # `check` took a period of which somebody else is declared hung.
    Defect("period of a microsecond", "hirosco/descriptor/read/read_configuration.cpp",
           '"sampling_us", least_sampling_us, max_sampling_us)', '"sampling_us", 1, max_sampling_us)',
           "descriptor_test", "SubsystemErrors.*"),
    # ... and names that differ in case only.
    Defect("names that differ in case", "hirosco/descriptor/read/detail/element_reader.cpp",
           "  std::ranges::transform(folded, folded.begin(), lower);\n", "", "descriptor_test", "SubsystemErrors.*"),
]


def misfits(root=ROOT):
    """Defects whose place in the code is gone, or whose test: [text]. What fits nowhere finds nothing."""
    found = [f"{defect.name}: the name is taken" for at, defect in enumerate(DEFECTS)
             if any(other.name == defect.name for other in DEFECTS[:at])]
    for defect in DEFECTS:
        number = (root / defect.file).read_text().count(defect.now)
        if number != 1:
            found.append(f"{defect.name}: {defect.file} has {number} times '{defect.now}'")
    return found


def sources():
    """Files of the tree as they stand, without what git ignores."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            check=True, capture_output=True, text=True).stdout
    return [name for name in listed.split("\0") if name and (ROOT / name).is_file()]


class Copy:
    """The sources in a folder of their own, which stays: what did not change since is not built again."""

    def __init__(self):
        wanted = sources()
        for name in wanted:
            target = COPY / name
            if target.exists() and target.read_bytes() == (ROOT / name).read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, target)  # with the time of now, so that it is built
        for path in [path for path in COPY.rglob("*") if path.is_file() and BUILD.parent not in path.parents]:
            if str(path.relative_to(COPY)) not in wanted:
                path.unlink()
        self.run("cmake", "--preset", "release")

    def run(self, *words):
        done = subprocess.run(words, cwd=COPY, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {(done.stdout + done.stderr)[-2000:]}")

    def build(self, test, jobs):
        self.run("ninja", "-C", str(BUILD), f"-j{jobs}", test)

    def failed(self, defect):
        """The tests of the filter that failed; one that took the whole program with it is among them."""
        words = [BUILD / "bin" / defect.test, f"--gtest_filter={defect.filter}"]
        try:
            done = subprocess.run(words, cwd=BUILD, capture_output=True, text=True, errors="replace", timeout=TEST_LIMIT_S)
        except subprocess.TimeoutExpired:
            return ["without end"]
        ran = re.findall(r"^\[ RUN      \] (\S+)", done.stdout, re.M)
        if not ran:
            raise RuntimeError(f"{defect.test} has no test {defect.filter}: {done.stderr[-500:]}")
        failed = re.findall(r"^\[  FAILED  \] (\S+) \(", done.stdout, re.M)
        return failed or ([f"{ran[-1]} (ended by signal {-done.returncode})"] if done.returncode < 0 else [])

    def write(self, defect, text):
        (COPY / defect.file).write_text(text)


def find(copy, defect, jobs):
    """(the tests that failed with the defect, why the row is no proof or "")"""
    text = (COPY / defect.file).read_text()
    if text.count(defect.now) != 1:
        return [], f"{defect.file} has {text.count(defect.now)} times '{defect.now}'"
    try:
        copy.write(defect, text.replace(defect.now, defect.was))
        copy.build(defect.test, jobs)
        seen = copy.failed(defect)
    except RuntimeError as error:
        return [], str(error)
    finally:
        copy.write(defect, text)
    return seen, ""


def controls(copy, defects, jobs):
    """Of tests that fail without any defect: {(program, filter)}. They would prove nothing."""
    bad = set()
    for test in dict.fromkeys(defect.test for defect in defects):
        copy.build(test, jobs)
    for defect in defects:
        if copy.failed(defect):
            bad.add((defect.test, defect.filter))
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="NAME", help="rows whose name begins so; may be given again")
    parser.add_argument("--test", help="rows that this program sees")
    parser.add_argument("--list", action="store_true", help="the rows, without building anything")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the compiler at a time")
    arguments = parser.parse_args()
    chosen = [defect for defect in DEFECTS if (not arguments.only or any(defect.name.startswith(name) for name in arguments.only))
              and arguments.test in (None, defect.test)]
    if not chosen:
        parser.error("no row of that name")
    if arguments.list:
        for defect in chosen:
            print(f"{defect.name:<30} {defect.file}: {defect.test} {defect.filter}")
        return 0
    if gone := misfits():
        sys.exit("\n".join(gone))
    copy = Copy()
    bad = controls(copy, chosen, arguments.jobs)
    missed = 0
    for defect in chosen:
        begun = time.monotonic()
        seen, error = find(copy, defect, arguments.jobs)
        if (defect.test, defect.filter) in bad:
            error = "the test fails without the defect"
        missed += bool(error) or not seen
        verdict = f"ERROR {error}" if error else f"found by {', '.join(seen)}" if seen else f"NOT FOUND by {defect.filter}"
        print(f"{defect.name:<30} {defect.test:<22} {verdict} ({time.monotonic() - begun:.0f} s)", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} defects found again")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
