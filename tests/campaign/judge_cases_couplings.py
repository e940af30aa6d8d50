# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of I18 and I19 (judge/coupling_rules.py), of a craft with each word for the loss of a link (tests/couplings), and of what other rules say of it."""
import pathlib, struct

from judge_cases import case
from judge_flight import MS, S
from descriptors import OFFLINE, OPERATIONAL, PRE, SAFE, read_mission

COUPLINGS = read_mission(pathlib.Path(__file__).resolve().parents[1] / "couplings")
LOSSES, QUEUES, DOWN = "i18_who_loses_a_set_does_what_the_mission_says", "i19_a_queue_counts_what_it_loses", "i4_a_network_goes_down_with_its_member"
OFF = "i4_actuators_are_off_outside_operational"
COUNTER, ALONE = 23, 2
KILLED = 1 * S


def lost(w, falls=True, counter_down=2600 * MS, links="links"):
    """ENCODER dies, and all do what the mission says of their links."""
    for name in ("led", "falling", "counter", "woken"):
        w.at(60 * MS, f"active {name}-axis 1")
    w.at(KILLED, "did kill ENCODER", "alive ENCODER 0", links)
    w.at(1005 * MS, f"state LED {OFFLINE}", "active led-axis 0", "inhibited FALLING 1", "active falling-axis 0")
    if falls:
        w.at(1010 * MS, f"state FALLING {PRE}", f"configuration FALLING {ALONE}", f"state FALLING {SAFE}")
        w.at(1100 * MS, f"state FALLING {OPERATIONAL}", "inhibited FALLING 0", "active falling-axis 1")
    if counter_down:
        w.at(counter_down, f"state COUNTER {OFFLINE}", "active counter-axis 0")


def coupling(rule, found=""):
    return case(rule, found, COUPLINGS)


# --- I18 -------------------------------------------------------------------------------------------------------------------
@coupling(LOSSES)
def each_does_what_its_link_says(w):
    lost(w)


@coupling(LOSSES, found="FALLING has lost TICKS of ENCODER (fallback), and is not Operational in ALONE")
def one_does_not_fall_back(w):
    lost(w, falls=False)


@coupling(LOSSES, found="FALLING has lost TICKS of ENCODER (fallback), and is not Operational in ALONE")
def one_falls_back_and_leaves_operational(w):
    lost(w)
    w.at(2 * S, f"state FALLING {SAFE}")


@coupling(LOSSES, found="falling-axis acts on in the configuration that waits for it")
def one_acts_with_what_it_has_lost(w):
    lost(w, falls=False)
    w.without("active falling-axis 0").at(1100 * MS, "active falling-axis 0")


@coupling(LOSSES, found="COUNTER has lost TICKS of ENCODER (hold), and does not hold on for its time")
def one_does_not_hold_on(w):
    lost(w, counter_down=2 * S)


@coupling(LOSSES, found="COUNTER has lost TICKS of ENCODER (hold), and holds on for longer")
def one_holds_on_for_longer(w):
    lost(w, counter_down=None)


@coupling(LOSSES)
def one_holds_on_until_the_set_is_back(w):
    lost(w, counter_down=None)
    w.at(2 * S, "links 3")


@coupling(LOSSES, found="COUNTER has lost TICKS of ENCODER (hold), and goes down though the set is back")
def one_goes_down_though_the_set_is_back(w):
    lost(w, counter_down=3 * S)
    w.at(2 * S, "links 3")


@coupling(LOSSES)
def a_set_that_was_back_and_is_gone_again_is_another_loss(w):
    lost(w, counter_down=None)
    w.at(2 * S, "links 3").at(2100 * MS, "links")


@coupling(LOSSES, found="WOKEN has lost TICKS of ENCODER (ignore), and does not go on")
def one_that_ignores_it_is_inhibited(w):
    lost(w)
    w.at(1100 * MS, "inhibited WOKEN 1")


@coupling(LOSSES)
def whoever_is_told_something_meanwhile_may_do_that(w):
    lost(w, falls=False, counter_down=None)
    w.sent(1500 * MS, 1, 8, 1, "SET_MODE")


@coupling(LOSSES)
def whoever_is_struck_itself_may_go_down(w):
    lost(w, falls=False, counter_down=None)
    w.at(900 * MS, "did stop FALLING", "did stop COUNTER").at(4 * S, "calm")


@coupling(LOSSES)
def what_was_not_operational_or_free_or_had_no_such_set_loses_nothing(w):
    lost(w, falls=False, counter_down=None)
    w.at(500 * MS, f"state COUNTER {SAFE}", "inhibited WOKEN 1", "inhibited FALLING 1").at(700 * MS, "inhibited FALLING 0")


@coupling(LOSSES)
def a_configuration_that_waits_for_nobody_loses_nothing(w):
    w.at(60 * MS, f"configuration FALLING {ALONE}", f"configuration WOKEN {ALONE}", "configuration COUNTER 9")
    lost(w, falls=False, counter_down=None)


@coupling(LOSSES)
def a_death_of_one_whom_nobody_follows_is_no_loss(w):
    w.at(KILLED, "did kill LED", "alive LED 0", "did kill SUPERVISOR 300")


@coupling(DOWN)
def whoever_goes_on_need_not_be_offline(w):
    w.at(6 * S, "end")
    lost(w, counter_down=None)


@coupling(DOWN, found="LED is not Offline 2 s after kill ENCODER")
def whoever_goes_down_with_it_has_to_be(w):
    lost(w)
    w.without(f"state LED {OFFLINE}")


@coupling(DOWN, found="ENCODER is not Offline 2 s after kill LED")
def whoever_only_gives_goes_down_with_who_took_it(w):
    w.at(KILLED, "did kill LED", "alive LED 0")


@coupling(DOWN)
def a_device_that_is_plugged_again_before_it_is_missed_takes_nobody_down(w):
    w.at(KILLED, "did fault counter-axis unplug").at(KILLED + 40 * MS, "did fault counter-axis plug")


@coupling(DOWN, found="ENCODER is not Offline 2 s after fault counter-axis unplug")
def a_device_that_is_plugged_again_too_late_takes_its_network_down(w):
    w.at(KILLED, "did fault counter-axis unplug").at(KILLED + 60 * MS, "did fault counter-axis plug")


@coupling(OFF)
def a_device_whose_member_is_gone_acts_until_the_watchdog_that_is_declared(w):
    w.at(60 * MS, "active counter-axis 1").at(KILLED, "did kill COUNTER", "alive COUNTER 0").at(KILLED + 60 * MS, "active counter-axis 0")


@coupling(OFF, found="counter-axis acts 100 ms after the death of COUNTER")
def a_device_whose_member_is_gone_acts_for_longer(w):
    w.at(60 * MS, "active counter-axis 1").at(KILLED, "did kill COUNTER", "alive COUNTER 0").at(KILLED + 100 * MS, "active counter-axis 0")


@coupling("i13_cycles_keep_time")
def a_cycle_that_a_sample_starts_keeps_the_time_of_its_samples(w):
    names = ("ENCODER", "WOKEN")
    for step in range(20):
        w.at(100 * MS + step * 20 * MS, "cycles " + " ".join(f"{member.name}={step * (20 if member.name in names else 20_000 // period(member))}"
                                                         for member in COUPLINGS.members)
             + "".join(f" {device}={step * 40}" for device in COUPLINGS.devices))


def period(member):
    return next(c.sampling_us for c in member.configurations.values() if c.name in COUPLINGS.commissions["quick"].values())


# --- I19 -------------------------------------------------------------------------------------------------------------------
def seen(w, taken, uncounted, torn, structure=4744, apid=COUNTER, octets=None):
    data = struct.pack(">HQQQd", structure, taken, uncounted, torn, 0.5)
    w.report(2 * S, apid, 3, 25, data[:octets])


@coupling(QUEUES)
def a_queue_of_which_nothing_lacks(w):
    seen(w, 1000, 0, 0)


@coupling(QUEUES, found="COUNTER tells of 3 UNCOUNTED")
def a_queue_that_lost_what_nobody_counted(w):
    seen(w, 1000, 3, 0)


@coupling(QUEUES, found="COUNTER tells of 1 TORN")
def a_sample_that_is_of_two(w):
    seen(w, 1000, 0, 1)


@coupling(QUEUES)
def a_report_of_another_structure_or_none(w):
    seen(w, 1000, 3, 1, structure=9000)
    seen(w, 1000, 3, 1, octets=10)
    seen(w, 1000, 3, 1, apid=1)
    w.told(2 * S, COUNTER, SAFE)
