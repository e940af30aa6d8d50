# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Findings of review in the manipulator, devices, ground link, log and descriptors."""
from .defect import DEVICE, GROUND_LINK, LOG_STORE, MANIPULATOR, MANIPULATOR_TEST, STANDARD_ERROR, Defect

DEFECTS = [
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
