# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What stops actuators: the permit page, the heartbeat, devices."""
import struct
import time

import wire
from craft import ERROR, OFFLINE, OPERATIONAL, PRE, SAFE, Passed, expect
from described import number
from duties import OUTPUT_LIMIT_S, Flown, duty

STOP, LINK, DEVICE, SUPERVISOR = 1, 2, 4, 32
OFF, ACTIVE, STOPPED = 0, 1, 2


def actuators(judged, flown):
    return {name: device for name, device in flown.devices.items() if judged.described.devices[name].get("actuator") == "yes"}


def safe_payload(judged, flown, name):
    use = next(each for each in flown.configuration.devices if each.get("name") == name)
    order = ">" if use.find("Endnode").get("byte_order") == "big" else "<"
    payload = b""
    for field in judged.described.devices[name].findall("Output/Field"):
        kind, count = wire.TYPES[field.get("type")], int(field.get("count", 1))
        values = [number(word) for word in field.get("safe", "").split()]
        values = (values + [0] * count)[:count]
        payload += wire.put(kind, [v if kind in (9, 10) else int(v) for v in values], order)
    return payload


def limit_s(flown):
    return 2 * flown.configuration.period_s + OUTPUT_LIMIT_S


def expect_safe(judged, flown, since, words):
    """Nothing was put out to an actuator later than the limit; what came then is safe."""
    flown.craft.wait(limit_s(flown) + 0.1 + 5 * flown.configuration.period_s)
    for name, device in actuators(judged, flown).items():
        later = [command for command in device.commands if command[5] - since > limit_s(flown)]
        expect(later, f"{words}: {name} is not commanded any more")
        active = [command for command in later if command[0] == ACTIVE]
        expect(not active, f"{words}: {name} is Active {active[-1][5] - since if active else 0:.3f} s later")
        wrong = [command for command in later if command[4] != safe_payload(judged, flown, name)]
        expect(not wrong, f"{words}: {name} has the output {wrong[-1][4].hex() if wrong else ''}, not the safe one")


@duty("permit.moves")
def moves(judged):
    with judged.craft() as craft:
        flown = Flown(judged, craft).operational()
        craft.wait(0.2)
        expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()}")
        expect(craft.vital.u32(20) == craft.epoch(), "seen_epoch is not the present one")
        for name, device in actuators(judged, flown).items():
            mode, epoch, *_ = device.commands[-1]
            expect((mode, epoch) == (ACTIVE, craft.epoch()), f"{name} is commanded mode {mode}, epoch {epoch}")


def harms(craft):
    """[(words, what to do)]: each takes the permission away."""
    yield "a fence", craft.forbid
    yield "go is 0", lambda: craft.permit.set64(16, 0)
    yield "stop is 1", lambda: craft.permit.set32(12, 1)
    yield "another epoch with its own permission", craft.permit_move
    for bit in (0, 31, 32, 63):
        yield f"bit {bit} of go turned over", lambda bit=bit: craft.permit.set64(16, craft.permit.u64(16) ^ 1 << bit)
    for bit in (0, 31):
        yield f"bit {bit} of epoch turned over", lambda bit=bit: craft.permit.set32(8, craft.epoch() ^ 1 << bit)


@duty("permit.withdrawn")
def withdrawn(judged):
    judged.configuration()
    with judged.craft() as craft:
        count = len(list(harms(craft)))
    for which in range(count):
        with judged.craft() as craft:
            flown = Flown(judged, craft).operational()
            expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} at first")
            words, harm = list(harms(craft))[which]
            begin, cycles = time.monotonic(), craft.vital.u64(40)
            harm()
            found = craft.until(lambda: craft.inhibited() & STOP, limit_s(flown) + 0.2)
            late = time.monotonic() - begin
            made = craft.vital.u64(40) - cycles
            expect(found and late <= limit_s(flown) + 0.02, f"{words}: not inhibited by stop after {late:.3f} s ({made} cycles), inhibited is {craft.inhibited()}")
            at = craft.vital.u64(88)
            expect(cycles < at <= cycles + 2 + int(0.02 / flown.configuration.period_s), f"{words}: inhibited_at_cycle is {at}, it was about {cycles + 1}")
            expect_safe(judged, flown, begin, words)


@duty("permit.latched")
def latched(judged):
    with judged.craft() as craft:
        flown = Flown(judged, craft).operational()
        begin = time.monotonic()
        craft.forbid()
        craft.wait(limit_s(flown))
        craft.permit_move()
        expect_safe(judged, flown, begin, "a new permission alone")
        expect(craft.inhibited() & STOP, "a new permission alone lifts the inhibition")
        craft.go(SAFE, OPERATIONAL)
        craft.wait(limit_s(flown) + 0.05)
        expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} after Operational was entered anew")


@duty("permit.another")
def another(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        expect(craft.another_permit_page(craft.epoch(), False), "another permit page is not said to be in force in Offline")
        flown = Flown(judged, craft).operational()
        before = craft.permit
        expect(not craft.another_permit_page(craft.epoch() + 1, True, seals=6), "a page that others may write is taken")
        expect(not craft.another_permit_page(craft.epoch() + 1, True, version=9), "a page of another version is taken")
        expect(craft.inhibited() == 0, "what is no permit page changed something")
        expect(craft.another_permit_page(craft.epoch(), True), "another permit page is not said to be in force")
        before.set64(16, 0)
        craft.wait(limit_s(flown) + 0.1)
        expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()}: what was permitted goes on under the same epoch, whatever the page before says")
        begin = time.monotonic()
        craft.forbid()
        expect(craft.until(lambda: craft.inhibited() & STOP, limit_s(flown) + 0.2), "the new page is not looked at")
        expect_safe(judged, flown, begin, "a fence on another permit page")
    for words, raised, permitted in (("that permits nothing", 0, False), ("of another epoch", 1, True)):
        with judged.craft() as craft:
            flown = Flown(judged, craft).operational()
            begin = time.monotonic()
            expect(craft.another_permit_page(craft.epoch() + raised, permitted), "another permit page is not said to be in force")
            expect(craft.until(lambda: craft.inhibited() & STOP, limit_s(flown) + 0.2), f"not inhibited by a page {words}")
            expect_safe(judged, flown, begin, f"a page {words}")


@duty("permit.heartbeat")
def heartbeat(judged):
    with judged.craft() as craft:
        flown = Flown(judged, craft).operational()
        begin, seen = time.monotonic(), len(craft.events)
        craft.beating = False
        limit = 2 + 4 * flown.configuration.period_s + 0.3
        craft.wait(1)
        expect(craft.inhibited() == 0, "inhibited after 1 s without a heartbeat already")
        expect(craft.until(lambda: craft.inhibited() & SUPERVISOR, limit - 1), f"not inhibited by supervisor within {limit:.2f} s, inhibited is {craft.inhibited()}")
        for name, device in actuators(judged, flown).items():
            craft.wait(limit_s(flown))
            expect(device.commands[-1][0] != ACTIVE, f"{name} is still Active")
        expect(craft.until(lambda: craft.state() == ERROR, 3), f"it stays in state {craft.state()}")
        # The state stands in a page, the event comes by the channel: it may be heard a little later.
        craft.until(lambda: any(n == 0xF005 for _, _, n, _, _ in craft.events[seen:]), 1)
        told = [n for _, _, n, _, _ in craft.events[seen:] if n == 0xF005]
        expect(len(told) == 1, f"{len(told)} events SUPERVISOR_SILENT")
        expect(time.monotonic() - begin < 8, "it took longer than 8 s")
        craft.beating = True
        craft.ask(17, 1).expect_done("PING after the supervisor came back")
        expect(craft.ended() is None and craft.state() == ERROR, "it did not stay in Error-Operational")


def with_devices(judged):
    if not judged.configuration().devices:
        raise Passed("the configuration has no device")


def watchdogs(use):
    return {int(float(use.get("watchdog_ms", 10)) * 1000), int(float(use.get("watchdog_reduced_ms", 50)) * 1000)}


def overslept(commands, at, period):
    """A socket holds some ten frames: what comes while the judge does not look for so long is lost by the judge."""
    times = [command[5] for command in commands[max(0, at - 16):at + 2]]
    return any(b - a >= 5 * period for a, b in zip(times, times[1:]))


@duty("device.frames")
def frames(judged):
    with_devices(judged)
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        period = flown.configuration.period_s
        flown.feed_all()
        craft.wait(0.3)
        for state in (PRE, SAFE):
            if state == SAFE:
                craft.go(SAFE)
            begin = time.monotonic()
            craft.wait(max(1, 10 * period))
            passed = (time.monotonic() - begin) / period
            for use in flown.configuration.devices:
                name = use.get("name")
                device, is_actuator = flown.devices[name], name in actuators(judged, flown)
                expect(not device.problems, f"{name}: {device.problems[:1]}")
                commands = [command for command in device.commands if command[5] >= begin]
                expect(abs(len(commands) - passed) <= 0.1 * passed + 3, f"{name}: {len(commands)} frames in {passed:.0f} cycles")
                expect(all(b[2] == a[2] + 1 or (b[2] > a[2] and overslept(commands, i, period))
                           for i, (a, b) in enumerate(zip(commands, commands[1:]))), f"{name}: sequences do not count on")
                expect({command[3] for command in commands} <= watchdogs(use), f"{name}: watchdog {commands[-1][3]} us, declared are {watchdogs(use)}")
                size = len(safe_payload(judged, flown, name))
                expect(all(len(command[4]) == size for command in commands), f"{name}: payload of {len(commands[-1][4])} octets, declared are {size}")
                expect(all(command[1] == craft.epoch() for command in commands), f"{name}: epoch {commands[-1][1]}, the page has {craft.epoch()}")
                if is_actuator:
                    expect(device.commands[0][0] == OFF, f"{name}: its first command of all has mode {device.commands[0][0]}, not Off")
                    expect({command[0] for command in commands} == {OFF}, f"{name}: modes {({c[0] for c in commands})} in state {state}")
                    wrong = [c for c in commands if c[4] != safe_payload(judged, flown, name)]
                    expect(not wrong, f"{name}: output {wrong[-1][4].hex() if wrong else ''} in state {state}, not the safe one")
                else:
                    expect({command[0] for command in commands} == {ACTIVE}, f"{name} is no actuator: mode {commands[-1][0]}")


@duty("device.stop")
def stop(judged):
    with_devices(judged)
    with judged.craft() as craft:
        flown = Flown(judged, craft).operational()
        if not actuators(judged, flown):
            raise Passed("no device is an actuator")
        craft.go(ERROR)
        craft.wait(limit_s(flown))
        for name, device in actuators(judged, flown).items():
            expect(device.commands[-1][0] == STOPPED, f"{name}: mode {device.commands[-1][0]} in Error-Operational, not Stop")
            expect(device.commands[-1][4] == safe_payload(judged, flown, name), f"{name}: not its safe output")


@duty("device.silent")
def silent(judged):
    with_devices(judged)
    names = list(judged.described.devices)
    for answer, reason in (("silent", 1), ("damaged", 3), ("repeated", 5), ("of another version", 10)):
        for use in judged.configuration().devices:
            with judged.craft() as craft:
                flown = Flown(judged, craft).operational()
                expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} at first")
                seen, begin, name = len(craft.events), time.monotonic(), use.get("name")
                flown.devices[name].answer = answer
                limit = max(int(use.get("silence", 3)), int(use.get("silence_reduced", 40))) * flown.configuration.period_s + limit_s(flown) + 0.1
                expect(craft.until(lambda: craft.inhibited() & DEVICE, limit), f"{name} {answer}: not inhibited by device within {limit:.2f} s")
                late = time.monotonic()
                expect_safe(judged, flown, late, f"{name} {answer}")
                told = [data for _, _, n, data, _ in craft.events[seen:] if n == 0xF100 + names.index(name)]
                expect(len(told) == 1, f"{name} {answer}: {len(told)} events NAME_LOST")
                expect(told[0][0] == reason, f"{name} {answer}: the reason is {told[0][0]}, not {reason}")
                del begin
