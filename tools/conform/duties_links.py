# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Real-time links: the handshake in both roles, samples, ends."""
import dataclasses
import os
import struct

import wire
from craft import POST, SAFE, SEAL_FUTURE_WRITE, SEAL_SEAL, Passed, checked, expect, sealed_memory
from duties import LATE_S, STANDS_IN_MEMORY, Flown, duty
from partners import FAULT, STOPPING, VALID, PlayedConsumer, PlayedProducer, Sleeper

REFUSED = (4, 0x0107, b"\0")
JUDGED = 4716  # of the vital page: what is made of each set


def required(judged):
    found = judged.configuration().requires
    if not found:
        raise Passed("the configuration requires no set")
    return found


def provided(judged):
    found = judged.configuration().provides
    if not found:
        raise Passed("the configuration provides no set")
    return found


def must(each):
    return each.get("required", "yes") == "yes"


def refusal(outcome, link, item, words):
    outcome.expect([1, 4], words, [REFUSED])
    told = [r.data for r in outcome.others if r.kind == (128, 131)]
    expect(len(told) == 1 and told[0][0] == link, f"{words}: TM[128,131] {[d.hex() for d in told]}")
    expect(item is None or told[0][1] == item, f"{words}: refused for item {told[0][1]}, not {item}")
    expect(told[0][2] == len(told[0]) - 3, f"{words}: its words are not a string")


@duty("link.offer")
def offer(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        refusal(craft.ask(128, 1, bytes([5]) + wire.string("NOBODY")), 5, 4, "TC[128,1] in Offline")
        craft.ask(128, 1, b"\5").expect_refused(2, 8, b"", "TC[128,1] without a set")
        if judged.number is None:
            raise Passed("no configuration is declared")
        flown = Flown(judged, craft).configure()
        refusal(craft.ask(128, 1, bytes([5]) + wire.string("NOBODY")), 5, 4, "TC[128,1] of a set that is not required")
        for each in required(judged):
            name = each.get("name")
            outcome = craft.ask(128, 1, bytes([7]) + wire.string(name)).expect_done(f"TC[128,1] of {name}")
            told = [r.data for r in outcome.others if r.kind == (128, 129)]
            methods, orders, kinds = flown.configuration.terms(each)
            depth = int(each.get("depth", 64)) if 2 in kinds else 0
            wanted = b"\7" + wire.Offer(name, flown.configuration.period_ns, methods, orders, kinds, depth,
                                        flown.configuration.fields(each), int(flown.configuration.started_by == name)).octets()
            expect(told == [wanted], f"the offer of {name} is {[d.hex() for d in told]}, declared is {wanted.hex()}")


def consumer_offer(flown, each, **changes):
    methods, orders, kinds = flown.configuration.terms(each)
    given = {"set": "WANTED", "period_ns": flown.configuration.period_ns, "methods": methods, "orders": orders, "kinds": kinds[:1],
             "depth": 8 if kinds[0] == 2 else 0, "fields": flown.configuration.fields(each)} | changes
    return wire.Offer(**given)


def negotiate(craft, link, name, offered):
    return craft.ask(128, 2, bytes([link]) + wire.string(name) + bytes([link]) + offered.octets())


def agreed(flown, each, link, **changes):
    """The agreement that it makes."""
    name = each.get("name")
    outcome = negotiate(flown.craft, link, name, consumer_offer(flown, each, **changes)).expect_done(f"TC[128,2] of {name}")
    told = [r.data for r in outcome.others if r.kind == (128, 130)]
    expect(len(told) == 1 and told[0][0] == link, f"TC[128,2] of {name}: came {outcome.words()}")
    reader = wire.Reader(told[0][1:])
    agreement = reader.agreement()
    reader.end()
    return agreement


@duty("link.agree")
def agree(judged):
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        configuration = flown.configuration
        for each in provided(judged):
            name, fields = each.get("name"), configuration.fields(each)
            methods, orders, kinds = configuration.terms(each)
            found = agreed(flown, each, 9)
            wanted = wire.Agreement(methods[0], orders[0], kinds[0], 8 if kinds[0] == 2 else 0, configuration.period_ns,
                                    configuration.period_ns, fields)
            expect(found == wanted, f"agreement of {name} is {found}, expected {wanted}")
            for factor in (10, 3):
                expect(agreed(flown, each, 9, period_ns=configuration.period_ns * factor).consumer_ns == configuration.period_ns * factor,
                       "the consumer's period is not in the agreement")
            if kinds[0] != 3:
                expect(agreed(flown, each, 9, fields=fields[-1:]).fields == fields, "a consumer of one field: the agreement has not all of the producer's")
            ask = lambda words, item, **changes: refusal(negotiate(craft, 9, name, consumer_offer(flown, each, **changes)), 9, item, f"{name}: {words}")
            ask("a method that it has not", 0, methods=[6])
            ask("a byte order that it has not", 1, orders=[3 - orders[0]]) if len(orders) == 1 else None
            ask("a kind that it has not", 2, kinds=[kind for kind in (1, 3) if kind not in kinds][:1], depth=0)
            ask("periods of 3 to 2", 3, period_ns=configuration.period_ns * 3 // 2)
            told = negotiate(craft, 9, name, consumer_offer(flown, each, wakes=1, period_ns=configuration.period_ns * 3 // 2))
            if any(r.kind == (128, 130) for r in told.others):
                expect(agreed(flown, each, 9, wakes=1).wakes == 1, "who asked to be woken has an agreement that does not say so")
            else:
                refusal(told, 9, 6, f"{name}: a consumer that is to be woken")
            ask("a field that it has not", 4, fields=[wire.LinkField("NOBODY_HAS_IT", 10)])
            ask("a field of another type", 4, fields=[dataclasses.replace(fields[0], type=2 if fields[0].type != 2 else 1)])
            ask("a field of another count", 4, fields=[dataclasses.replace(fields[0], count=fields[0].count + 1)])
        refusal(negotiate(craft, 9, "NOBODY", consumer_offer(flown, provided(judged)[0])), 9, 4, "a set that is not provided")
        good = bytes([9]) + wire.string(provided(judged)[0].get("name")) + bytes([9]) + consumer_offer(flown, provided(judged)[0]).octets()
        for words, data in (("cut off", good[:-1]), ("an octet more", good + b"x"), ("another link id inside", good.replace(b"\x09", b"\x08", 1))):
            craft.ask(128, 2, data).expect_refused(2, 8, b"", f"TC[128,2] {words}")


def produce(flown, each, link, **changes):
    """Attached as producer; the consumer is ours."""
    agreement = agreed(flown, each, link, **changes)
    flown.link_epoch += 1
    consumer = PlayedConsumer(agreement, flown.link_epoch)
    flown.craft.partners.append(consumer)
    name = each.get("name")
    outcome = flown.craft.ask(128, 3, flown.attach_data(link, 1, consumer.epoch, name, agreement), descriptors=[consumer.memory])
    outcome.expect_done(f"TC[128,3] as producer of {name}")
    expect([r.data for r in outcome.others if r.kind == (128, 132)] == [bytes([link, 1]) + STANDS_IN_MEMORY], f"TM[128,132] of {name}: came {outcome.words()}")
    return consumer


@duty("link.produce")
def producing(judged):
    for each in provided(judged):
        with judged.craft() as craft:
            flown = Flown(judged, craft).configure()
            period = flown.configuration.period_s
            consumer = produce(flown, each, 9)
            expect(not consumer.header(), f"header: {', '.join(consumer.header())}")
            wanted = SEAL_FUTURE_WRITE | SEAL_SEAL
            expect(consumer.seals() & wanted == wanted, f"seals are 0x{consumer.seals():X}: others could still write")
            flown.feed_all()
            craft.go(SAFE)              # there its values change, and a lent set is made
            expect(craft.until(lambda: consumer.samples, 20 * period + 1), "no sample comes")
            craft.wait(0.1)
            begin = len(consumer.samples)
            craft.wait(max(1.5, 20 * period))
            samples = consumer.samples[begin:]
            expect(not consumer.problems, consumer.problems[0] if consumer.problems else "")
            passed = (samples[-1][2] - samples[0][2]) / 1e9 / period
            made = samples[-1][0] - samples[0][0]
            expect(consumer.agreement.kind == 3 or abs(made - passed) <= 0.1 * passed + 2, f"{made} samples in {passed:.0f} periods")
            expect(period < 0.005 or len(samples) > 0.7 * made, f"{len(samples)} of {made} samples could be had whole")
            expect(consumer.odd <= 0.3 * consumer.looks, f"the sequence is odd in {consumer.odd} of {consumer.looks} looks: it stays so")
            late = [now - stamp for _, _, stamp, _, now in samples]
            expect(min(late) >= 0, "stamps lie in the future")
            expect(sorted(late)[len(late) // 2] < (period + LATE_S) * 1e9, f"stamps are {sorted(late)[len(late) // 2] / 1e9:.3f} s old at the median")
            expect(all(status == VALID for _, status, _, _, _ in samples), f"status {sorted({s[1] for s in samples})} of a well producer")


@duty("link.wakes")
def wakes(judged):
    asked = 0
    for each in provided(judged):
        with judged.craft() as craft:
            flown = Flown(judged, craft).configure()
            told = negotiate(craft, 9, each.get("name"), consumer_offer(flown, each, wakes=1))
            if not any(r.kind == (128, 130) for r in told.others):
                continue                # refused as link.agree wants it
            asked += 1
            consumer = produce(flown, each, 9, wakes=1)
            flown.feed_all()
            craft.go(SAFE)
            period = flown.configuration.period_s
            expect(craft.until(lambda: consumer.samples, 20 * period + 1), "no sample comes")
            sleeper = Sleeper(consumer, 5 + 20 * period)
            craft.until(lambda: not sleeper.is_alive(), 60 + 300 * period)
            expect(sleeper.woken == Sleeper.times, f"{each.get('name')}: slept through a sample after {sleeper.woken} that woke")
    if asked == 0:
        raise Passed("it wakes nobody, and says so")


@duty("link.consume")
def consume(judged):
    needed = required(judged)
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        if any(must(each) for each in needed):
            craft.set_state(SAFE).expect([1, 4], "Safe-Operational without its links", [(4, 14, b"")])
        flown.feed_all()
        craft.wait(0.1)
        told = [craft.vital.u32(96 + 24 * i) for i in range(min(64, len(needed)))]
        expect(told == [flown.links[each.get("name")].link for each in needed][:8], f"links in the page: {told}")
        craft.go(SAFE)
        craft.wait(0.3)
        expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} with fresh samples")
        for i, each in enumerate(needed[:64]):
            period, counts = craft.vital.u32(2156 + 40 * i), [craft.vital.u32(2160 + 40 * i + 4 * bin) for bin in range(9)]
            agreed = min(flown.links[each.get("name")].agreement.producer_ns, 0xFFFFFFFF)
            expect(period in (0, agreed), f"latencies in the page are of a period of {period} ns, agreed are {agreed}")
            expect(not period or sum(counts), "latencies in the page have a period and no counts after 0.3 s of samples")
            expect(craft.vital.u32(JUDGED + 4 * i) in (0, 1), f"{each.get('name')} is judged {craft.vital.u32(JUDGED + 4 * i)} in the page, with fresh samples")


def age_s(judged, each):
    """Its samples count as old after this, in the worse case."""
    return max(int(each.get("age", 3)), int(each.get("age_reduced", 40))) * judged.configuration().period_s


@duty("link.stale")
def stale(judged):
    names = judged.described.required_sets()
    for place, each in enumerate(required(judged)[:64]):
        name, event = each.get("name"), 0xF200 + names.index(each.get("name"))
        for words, harm, alarm in (("samples stop", lambda p: setattr(p, "running", False), True), ("the producer tells a fault", lambda p: p.tell(FAULT), True),
                                   ("a status word that is none", lambda p: p.page.set64(72 if p.agreement.kind < 3 else 136, 1), True),
                                   ("the producer announces its end", lambda p: (setattr(p, "running", False), p.tell(STOPPING)), False)):
            if words.startswith("a status word") and each.get("kind", "latest") != "latest":
                continue
            with judged.craft() as craft:
                flown = Flown(judged, craft).operational()
                expect(craft.inhibited() == 0, f"inhibited is {craft.inhibited()} at first")
                seen, producer = len(craft.events), flown.links[name]
                if words.startswith("a status word"):
                    producer.running = False
                    producer.page.set64(64, producer.sequence + 1)
                    producer.page.set64(72, 1)
                    producer.page.set64(64, producer.sequence + 2)
                else:
                    harm(producer)
                limit = age_s(judged, each) + 2 * flown.configuration.period_s + 0.3
                holds = each.get("missing") == "hold"
                found = craft.until(lambda: craft.inhibited() & 2, limit)
                expect(found != holds, f"{name}, {words}: {'inhibited although it holds' if holds else f'not inhibited by link within {limit:.2f} s'}")
                craft.wait(0.2)
                told = craft.vital.u32(JUDGED + 4 * place)
                expect(told in (0, 2), f"{name}, {words}: judged {told} in the page")
                if found:
                    producer.running = True
                    producer.tell(VALID)
                    craft.wait(0.2 + 5 * flown.configuration.period_s)
                    expect(craft.inhibited() & 2, f"{name}, {words}: samples that come again lift the inhibition, which is to last")
                told = [number for _, _, number, _, _ in craft.events[seen:] if number == event]
                expect(len(told) == alarm, f"{name}, {words}: {len(told)} events NAME_STALE")


@duty("link.refused")
def refused(judged):
    configuration = judged.configuration()
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        craft.ask(128, 3, b"\1\1").expect_refused(2, 8, b"", "TC[128,3] cut off")
        for role, each in [(2, each) for each in configuration.requires[:1]] + [(1, each) for each in configuration.provides[:1]]:
            name = each.get("name")
            agreement = flown.agreement_for(each) if role == 2 else agreed(flown, each, 9)
            data = lambda **changes: flown.attach_data(changes.get("link", 9), role, changes.get("epoch", 77), changes.get("name", name), agreement)
            attach = lambda memory, **changes: craft.ask(128, 3, data(**changes), descriptors=[memory] if memory is not None else [])
            words = "consumer" if role == 2 else "producer"
            refusal(attach(None), 9, None, f"{words} without memory")
            size = PlayedConsumer(agreement, 77).size
            for what, octets, seals in (("64 octets more", size + 64, 6), ("64 octets less", max(64, size - 64), 6), ("no seals", size, 0),
                                        ("a seal against growing alone", size, 4)):
                memory = sealed_memory("conform-wrong", octets, seals)
                refusal(attach(memory), 9, None, f"{words}, memory with {what}")
                os.close(memory)
            with open("/dev/null", "rb") as file:
                refusal(attach(file.fileno()), 9, None, f"{words}, /dev/null for memory")
            memory = sealed_memory("conform-wrong", size)
            refusal(attach(memory, name="NOBODY"), 9, None, f"{words} of an unknown set")
            if role == 2:
                writable = PlayedProducer(agreement, 77)
                refusal(attach(writable.memory), 9, None, "consumer, memory that others could still write")
                writable.close()
                for what, at, value in (("magic", 0, 1), ("version", 8, 9 << 32 | 77), ("epoch", 8, 2 << 32 | 76), ("size", 16, 1), ("layout", 24, 1)):
                    producer = PlayedProducer(agreement, 77)
                    producer.page.set64(at, value)
                    refusal(attach(producer.seal().memory), 9, None, f"consumer, header with another {what}")
                    producer.close()
                if must(each):
                    craft.set_state(SAFE).expect([1, 4], "Safe-Operational after refused links", [(4, 14, b"")])
            os.close(memory)
        craft.ask(17, 1).expect_done("PING afterwards")


@duty("link.detached")
def detached(judged):
    configuration = judged.configuration()
    if not configuration.requires and not configuration.provides:
        raise Passed("the configuration has no set")
    with judged.craft() as craft:
        flown = Flown(judged, craft).configure()
        craft.ask(128, 4, b"\x63").expect_refused(4, 0x0101, struct.pack(">BI", 0, 0x63), "TC[128,4] of a link that is none")
        craft.ask(128, 4).expect_refused(2, 8, b"", "TC[128,4] without data")
        craft.wait(0.05)
        before = craft.holdings()
        ends = []
        for each in configuration.requires[:1]:
            ends.append((flown.feed(each).link, 2))
        for each in configuration.provides[:1]:
            consumer = produce(flown, each, 50)
            ends.append((50, 1))
        craft.wait(0.1)
        for link, role in ends:
            outcome = craft.ask(128, 4, bytes([link])).expect_done(f"TC[128,4] of link {link}")
            told = [(r.data, r.destination) for r in outcome.others if r.kind == (128, 133)]
            expect(told == [(bytes([link, role]), 0)], f"TM[128,133] of link {link}: {outcome.words()}")
        craft.wait(0.2 + 3 * configuration.period_s)
        expect(craft.holdings() == before, f"descriptors and mappings: {before} before the links, {craft.holdings()} after them")
        first = len(craft.reports)
        ends = [(flown.feed(each).link, 2) for each in configuration.requires]
        consumers = [produce(flown, each, 60 + i) for i, each in enumerate(configuration.provides)]
        ends += [(60 + i, 1) for i in range(len(consumers))]
        craft.wait(0.1)
        craft.go(POST)
        told = sorted(r.data for r in craft.reports[first:] if r.kind == (128, 133))
        expect(told == sorted(bytes(end) for end in ends), f"TM[128,133] at the configuration's end: {[d.hex() for d in told]}")
        for consumer in consumers:
            expect(consumer.status() == STOPPING, f"status {consumer.status()} at the configuration's end, not Stopping")
        expect(checked(craft.vital.u32(12)) == 0, "the configuration is still in the page")
