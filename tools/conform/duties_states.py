# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""States, configurations, the cycle, and how a process ends."""
import struct

import wire
from craft import ERROR, OFFLINE, OPERATIONAL, POST, PRE, SAFE, checked, expect
from described import STATES
from duties import Flown, duty

WAYS = {(0, 3): [1, 2, 3], (3, 0): [7, 8, 9, 0], (3, 4): [4], (3, 6): [6], (3, 7): [7], (4, 0): [7, 8, 9, 0], (4, 3): [7, 3], (4, 5): [5],
        (4, 6): [6], (4, 7): [7], (5, 4): [4], (5, 6): [6], (6, 0): [7, 8, 9, 0], (6, 3): [7, 3], (6, 7): [7], (7, 0): [8, 9, 0], (7, 3): [3]}
STATE_CHANGED = 0xF000


def bring(judged, craft, state):
    """Into a steady state, with the configuration in force where it can be."""
    flown = Flown(judged, craft)
    if state == OFFLINE:
        craft.wait_alive()
    elif state == PRE:
        flown.configure().feed_all()
    elif state == OPERATIONAL:
        flown.operational()
    else:
        flown.safe()
        if state != SAFE:
            craft.go(state)
    expect(craft.state() == state, f"the page says state {craft.state()}, not {state}")
    return flown


@duty("state.table")
def table(judged):
    judged.configuration()
    for origin in (OFFLINE, PRE, SAFE, OPERATIONAL, ERROR, POST):
        with judged.craft() as craft:
            bring(judged, craft, origin)
            for target in range(10):
                if (origin, target) not in WAYS:
                    craft.set_state(target).expect_refused(4, 10, bytes([origin]), f"{STATES[origin]} to {STATES[target]}")
                    expect(craft.state() == origin, f"a refused change moved it to {craft.state()}")
        for target in [t for o, t in WAYS if o == origin]:
            legal(judged, origin, target)


def legal(judged, origin, target):
    with judged.craft() as craft:
        bring(judged, craft, origin)
        words = f"{STATES[origin]} to {STATES[target]}"
        if target == OPERATIONAL:
            craft.permit_move()
            craft.wait(0.02)
        seen, first = len(craft.events), len(craft.reports)
        outcome = craft.set_state(target).expect_done(words)
        expect(craft.state() == target, f"{words}: the page says {craft.state()}")
        way = [data[0] for _, _, number, data, _ in craft.events[seen:] if number == STATE_CHANGED]
        expect(way == WAYS[origin, target], f"{words}: STATE_CHANGED tells {way}, the way is {WAYS[origin, target]}")
        told = [r.data for r in craft.reports[first:] if r.kind == (5, 1) and r.data[:2] == b"\xF0\0"]
        expect(told == [struct.pack(">HB", STATE_CHANGED, state) for state in way], f"{words}: TM[5,1] tell {[d.hex() for d in told]}")
        ends = [r for r in outcome.stages if r.kind == (1, 7)]
        expect(ends[0].after_event >= seen + len(way), f"{words}: completed before its last STATE_CHANGED")


@duty("state.conditions")
def conditions(judged):
    with judged.craft() as craft:
        craft.wait_alive().go(PRE)
        craft.set_state(SAFE).expect_refused(4, 10, bytes([PRE]), "Safe-Operational without a configuration")
        craft.set_state(ERROR).expect_refused(4, 10, bytes([PRE]), "Error-Operational without a configuration")
        for number in (10, 200):
            craft.set_state(number).expect([1, 4], f"state {number}")
    if judged.number is None:
        return
    with judged.craft() as craft:
        Flown(judged, craft).safe()
        refusal = (4, 0x0107, b"\0")
        craft.set_state(OPERATIONAL).expect([1, 4], "Operational without permission", [refusal])
        craft.permit.set64(16, wire.permission_word(craft.epoch() + 1))
        craft.set_state(OPERATIONAL).expect([1, 4], "Operational with the permission word of another epoch", [refusal])
        craft.permit.set64(16, 1)
        craft.set_state(OPERATIONAL).expect([1, 4], "Operational with a 1 for permission", [refusal])
        expect(craft.state() == SAFE, "it left Safe-Operational")


@duty("state.configure")
def configure(judged):
    number = judged.configuration().id
    unknown = next(n for n in range(1, 256) if n not in judged.described.configurations)
    with judged.craft() as craft:
        craft.wait_alive()
        craft.configure(number).expect_refused(4, 10, bytes([OFFLINE]), "CONFIGURE in Offline")
        craft.go(PRE)
        craft.configure(unknown).expect_refused(4, 0x0101, struct.pack(">BI", 0, unknown), f"CONFIGURE {unknown}")
        flown = Flown(judged, craft).configure()
        craft.configure(number).expect_done("CONFIGURE of what is in force")
        for other in [n for n in judged.described.configurations if n != number][:1]:
            craft.configure(other).expect_refused(4, 0x0103, struct.pack(">BI", 0, other), "CONFIGURE of another one")
        flown.feed_all()
        craft.go(SAFE)
        craft.configure(number).expect_refused(4, 10, bytes([SAFE]), "CONFIGURE in Safe-Operational")
        craft.go(POST)
        craft.configure(number).expect_refused(4, 10, bytes([POST]), "CONFIGURE in Post-Operational")
        expect(checked(craft.vital.u32(12)) == 0, "the configuration is still in the page in Post-Operational")


@duty("state.offline")
def offline(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        craft.fence()
        before = craft.holdings()
        for target in (SAFE, OPERATIONAL) if judged.number is not None else ():
            flown = Flown(judged, craft)
            flown.safe() if target == SAFE else flown.operational()
            if target == OPERATIONAL:
                craft.go(SAFE)
            craft.go(OFFLINE)
            for partner in craft.partners:
                partner.close()
            craft.partners.clear()
            craft.forbid()
            craft.wait(0.05)
            expect(craft.holdings() == before, f"descriptors and shared mappings: {before} at its begin, {craft.holdings()} in Offline again")
        craft.go(PRE, OFFLINE)
        expect(craft.holdings() == before, f"descriptors and shared mappings: {before} at its begin, {craft.holdings()} in Offline again")
        for wire_id, value in judged.described.readable()[:3]:
            craft.ask(20, 1, struct.pack(">BI", 1, wire_id)).expect_refused(4, 0x0101, struct.pack(">BI", 0, wire_id),
                                                                            f"{value.name} in Offline")


@duty("cycle.runs")
def runs(judged):
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        period = flown.configuration.period_s
        expect(checked(craft.vital.u32(28)) == 1, "cycling is not 1")
        expect(checked(craft.vital.u32(12)) == flown.configuration.id, "configuration is not in the page")
        expect(craft.vital.u64(32) == flown.configuration.period_ns, f"period_ns is {craft.vital.u64(32)}")
        craft.wait(0.1 + 3 * period)
        import time
        # A busy machine takes cycles from whoever has no right to real time, now and then.
        for left in (2, 1, 0):
            begin, cycles = time.monotonic(), craft.vital.u64(40)
            craft.wait(max(2, 20 * period))
            passed = (time.monotonic() - begin) / period
            made = craft.vital.u64(40) - cycles
            if abs(made - passed) <= 0.1 * passed + 2:
                break
            expect(left > 0, f"{made} cycles in {passed:.0f} periods, and not better twice before")
        craft.permit.set32(8, craft.epoch() + 1)
        expect(craft.until(lambda: craft.vital.u32(20) == craft.epoch(), 3 * period + 0.1),
               f"seen_epoch is {craft.vital.u32(20)}, the page has {craft.epoch()}")


@duty("cycle.rests")
def rests(judged):
    with judged.craft() as craft:
        Flown(judged, craft).safe()
        craft.go(POST)
        expect(checked(craft.vital.u32(28)) == 0, "cycling is not 0 in Post-Operational")
        cycles = craft.vital.u64(40)
        craft.wait(0.1 + 3 * judged.configuration().period_s)
        expect(craft.vital.u64(40) == cycles, "cycles goes on in Post-Operational")
        craft.go(PRE)
        craft.wait(0.1)
        expect(craft.vital.u64(40) == cycles, "cycles goes on in Pre-Operational without a configuration")


@duty("end.offline")
def end_offline(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        craft.fence()
        craft.hang_up()
        code = craft.wait_end(5)
        expect(code == 0, f"the channel closed in Offline: it {'goes on' if code is None else f'ended with {code}'}")


@duty("end.killed")
def end_killed(judged):
    from duties import OUTPUT_LIMIT_S
    import time
    with judged.craft() as craft:
        flown = Flown(judged, craft).operational()
        expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} in Operational")
        begin = time.monotonic()
        craft.hang_up()
        code = craft.wait_end(20)
        expect(code == 0, f"the channel closed in Operational: it {'goes on' if code is None else f'ended with {code}'}")
        expect(craft.state() == OFFLINE, f"it ended in state {craft.state()}")
        limit = 2 * flown.configuration.period_s + OUTPUT_LIMIT_S
        for name, device in flown.devices.items():
            if judged.described.devices[name].get("actuator") == "yes":
                late = [at - begin for mode, _, _, _, _, at in device.commands if mode == 1 and at - begin > limit]
                expect(not late, f"{name} was commanded Active {max(late, default=0):.3f} s after the supervisor was gone")
