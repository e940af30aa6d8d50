# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How a process begins, the channel, packets."""
import os
import struct
import subprocess

import wire
from craft import MAGIC, PRE, VERSION, Failed, checked, expect, sealed_memory
from duties import duty


@duty("begin.usage")
def usage(judged):
    ended = subprocess.run([*judged.executable, "--descriptor", str(judged.described.file)], stdin=subprocess.DEVNULL,
                           capture_output=True, timeout=20, check=False)
    expect(ended.returncode == 2, f"without a channel it ended with {ended.returncode}")
    expect(ended.stderr, "without a channel it said nothing")


def begin_with(judged, words, **pages):
    with judged.craft(**pages) as craft:
        code = craft.wait_end(10)
        expect(code == 3, f"{words}: " + (f"it ended with {code}" if code is not None else "it goes on"))
        expect(craft.vital.u64(48) == 0, f"{words}: it counted steps all the same")
        return craft.said()


@duty("begin.version")
def version(judged):
    said = begin_with(judged, "pages of another version", version=VERSION + 6)
    expect(str(VERSION) in said and str(VERSION + 6) in said, f"it does not name both versions: {said!r}")


@duty("begin.magic")
def magic(judged):
    expect(begin_with(judged, "pages without their magic", magic=MAGIC ^ 1), "it says nothing of pages that are none")


@duty("begin.quiet")
def quiet(judged):
    with judged.craft() as craft:
        craft.wait_alive().wait(0.3)
        expect(not craft.reports and not craft.events and not craft.problems,
               f"it speaks unasked: {[r.words() for r in craft.reports]} {craft.events} {craft.problems}")
        expect((craft.vital.u32(0), craft.vital.u32(4)) == (MAGIC, VERSION), "it wrote over magic or version")
        expect(craft.state() == 0, f"state is {craft.state()}, not Offline")
        expect(checked(craft.vital.u32(24)) <= 1, f"realtime is 0x{craft.vital.u32(24):08X}")
        expect(checked(craft.vital.u32(12)) == 0 and checked(craft.vital.u32(28)) == 0, "configuration or cycling is not 0")


@duty("begin.alive")
def alive(judged):
    from duties import Flown
    with judged.craft() as craft:
        steps_go_on(craft.wait_alive(), "in Offline")
        if judged.number is not None:
            Flown(judged, craft).configure()
            steps_go_on(craft, "with a configuration")


def steps_go_on(craft, where):
    for _ in range(3):
        before = craft.vital.u64(48)
        expect(craft.until(lambda: craft.vital.u64(48) != before, 1), f"{where}: service_steps stood still for 1 s")


@duty("packet.ping")
def ping(judged):
    with judged.craft() as craft:
        for _ in range(3):
            outcome = craft.wait_alive().ask(17, 1)
            outcome.expect_done("PING")
            kinds = [r.kind for r in outcome.reports]
            expect(kinds == [(1, 1), (1, 3), (17, 2), (1, 7)], f"PING: reports in the order {kinds}")
            expect(outcome.others[0].data == b"", "TM[17,2] has data")


@duty("packet.stamp")
def stamp(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        for source in (1, 0, 0x1234, 0xFFFF, 1, 0x1234):
            craft.ask(17, 1, source=source)
        craft.go(PRE)
        craft.ask(8, 1, wire.call("NOBODY"))
        expect(not craft.problems, f"reports are damaged: {craft.problems[:2]}")
        counted, now = {}, wire.calendar_s()
        for i, report in enumerate(craft.reports):
            expect(report.apid == judged.described.apid, f"APID {report.apid}")
            expect(report.count == i & 0x3FFF, f"sequence count {report.count} of report {i}")
            key = (report.destination, *report.kind)
            expect(report.message_count == counted.get(key, 0),
                   f"message count {report.message_count} of {report.words()} to {report.destination}, expected {counted.get(key, 0)}")
            counted[key] = report.message_count + 1
            expect(abs(report.time_s - now) < 30, f"on-board time is {report.time_s - now:+.1f} s off")
        for source in (0, 0x1234, 0xFFFF):
            expect((source, 17, 2) in counted, f"no TM[17,2] with destination {source}")
        times = [report.time_s for report in craft.reports]
        expect(times == sorted(times), "times go back")


@duty("packet.counters")
def counters(judged):
    entry = lambda destination, service, subtype, count: struct.pack("=HBBHH", destination, service, subtype, count, 0)
    block = struct.pack("=IHH", 2, 16383, 0) + entry(1, 17, 2, 65535) + entry(7, 17, 2, 41)
    with judged.craft(counters=block.ljust(520, b"\0")) as craft:
        craft.wait_alive()
        first, second, third = craft.ask(17, 1), craft.ask(17, 1), craft.ask(17, 1, source=7)
        for outcome in (first, second, third):
            outcome.expect_done("PING")
        expect(first.reports[0].count == 16383, f"the first report has the count {first.reports[0].count}, not that of the block, 16383")
        expect(first.reports[1].count == 0, f"behind 16383 comes {first.reports[1].count}")
        found = [outcome.others[0].message_count for outcome in (first, second, third)]
        expect(found == [65535, 0, 41], f"message counts go {found}, the block said 65535, then 0, and 41")
        used, sequence = struct.unpack_from("=IH", craft.vital.mapping, 1632)
        expect(sequence == craft.reports[-1].count + 1, f"the block says {sequence} for the next packet, the last one had {craft.reports[-1].count}")
        expect(used >= 4, "new message types are not in the block")


@duty("packet.acknowledged")
def acknowledged(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        for ack in range(16):
            first = len(craft.reports)
            request = craft.send(17, 1, ack=ack)
            craft.fence()
            found = [r.kind[1] for r in craft.reports[first:] if r.kind[0] == 1 and r.data[:4] == request]
            wanted = [subtype for flag, subtype in ((1, 1), (2, 3), (8, 7)) if ack & flag]
            expect(found == wanted, f"flags {ack}: reported {found}, not {wanted}")
            first = len(craft.reports)
            request = craft.send(17, 99, ack=ack)
            craft.fence()
            found = [r.kind[1] for r in craft.reports[first:] if r.kind[0] == 1 and r.data[:4] == request]
            expect(found == [2], f"a refusal with flags {ack}: {found}, failures are always reported")


@duty("packet.refused")
def refused(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        used = judged.described.services | {1, 3, 5, 8, 17, 20, 128}
        for service in [s for s in (0, 2, 9, 11, 129, 255) if s not in used]:
            craft.ask(service, 1).expect_refused(2, 6, bytes([service]), f"service {service}")
        for service, subtype in ((17, 2), (17, 0), (8, 2), (20, 7), (5, 1), (128, 9), (128, 129)):
            craft.ask(service, subtype).expect_refused(2, 7, bytes([service, subtype]), f"TC[{service},{subtype}]")
        for subtype in (5, 25):
            craft.ask(3, subtype, b"\1\0\1").expect_refused(2, 10, b"\0", f"TC[3,{subtype}] without a configuration")
        craft.ask(17, 1, b"x").expect_refused(2, 8, b"", "PING with data")
        other = judged.described.apid ^ 1
        craft.ask(17, 1, apid=other).expect_refused(10, 1, b"", "another APID")
        craft.ask(17, 1, mode_epoch=7).expect_refused(2, 13, b"", "another mode epoch")
        craft.ask(17, 1, mode_epoch=1).expect_done("the present mode epoch")
        good = craft.packet(17, 1)
        u16 = lambda at, value: wire.with_crc(good[:at] + struct.pack(">H", value) + good[at + 2:-2])
        for words, packet, code, data in (
                ("a length field that is too large", u16(4, 7), 2, struct.pack(">H", 7)),
                ("a length field that is too small", u16(4, 5), 2, struct.pack(">H", 5)),
                ("a packet of 12 octets", wire.with_crc(good[:4] + struct.pack(">H", 5) + good[6:10]), 2, struct.pack(">H", 5)),
                ("no secondary header", u16(0, struct.unpack_from(">H", good)[0] & ~0x800), 3, b""),
                ("sequence flags 01", u16(2, struct.unpack_from(">H", good, 2)[0] & 0x7FFF), 12, b""),
                ("error control", good[:-1] + bytes([good[-1] ^ 1]), 5, b""),
                ("a damaged source", good[:10] + bytes([good[10] ^ 0x40]) + good[11:], 5, b""),
                ("PUS version 1", wire.with_crc(good[:6] + bytes([0x1F]) + good[7:-2]), 4, b"")):
            answers = craft.quiet_answers(packet)
            found = [(r.kind, r.data, r.destination) for r in answers]
            wanted = [((1, 2), packet[:4] + struct.pack(">H", code) + data, 0)]
            expect(found == wanted, f"{words}: expected TM[1,2] code {code} {data.hex()} to destination 0, came {[r.words() for r in answers]}")


@duty("packet.discarded")
def discarded(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        good = craft.packet(17, 1)
        head = struct.unpack_from(">H", good)[0]
        u16 = lambda at, value: wire.with_crc(good[:at] + struct.pack(">H", value) + good[at + 2:-2])
        for words, packet in (("5 octets", good[:5]), ("packet version 1", u16(0, head | 0x2000)), ("an idle packet", u16(0, head | 0x7FF)),
                              ("telemetry", wire.with_crc(struct.pack(">HHHBBBHH", 0x0800 | judged.described.apid, 0xC000, 15, 0x20, 17, 2, 0,
                                                                      0x777) + bytes(7)))):
            expect(not craft.quiet_answers(packet), f"{words}: answered")


@duty("channel.garbage")
def garbage(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        craft.fence()
        before, good = craft.holdings(), craft.packet(17, 1)
        memories = [sealed_memory("conform-garbage", 64) for _ in range(3)]
        for words, octets, options in (
                ("an empty datagram", b"", {"envelope": False}), ("7 octets", b"\1\1\0\0\0\0\0", {"envelope": False}),
                ("kind 0", good, {"kind": 0}), ("kind 4", good, {"kind": 4}), ("kind 255", good, {"kind": 255}),
                ("kind 2", good, {"kind": 2}), ("kind 3", good, {"kind": 3}), ("another version", good, {"version": 2}),
                ("version 0", good, {"version": 0}), ("two descriptors", good, {"descriptors": memories[:2]}),
                ("three descriptors of another version", good, {"descriptors": memories, "version": 9}),
                ("an envelope alone", b"", {}), ("noise", os.urandom(300), {"kind": 77}), ("too long", bytes(5000), {}),
                ("ten descriptors", b"", {"descriptors": memories[:1] * 10})):
            for _ in range(5):
                expect(not craft.quiet_answers(octets, **options), f"{words}: answered")
        craft.quiet_answers(os.urandom(40))
        craft.ask(17, 1, descriptors=memories[:1]).expect_done("a PING with a descriptor beside it")
        for memory in memories:
            os.close(memory)
        craft.wait(0.05)
        expect(craft.holdings() == before, f"descriptors and mappings went from {before} to {craft.holdings()}")


@duty("channel.flood")
def flood(judged):
    with judged.craft() as craft:
        craft.wait_alive()
        asked = [craft.send(17, 1) for _ in range(500)]
        ended = lambda: {r.data[:4] for r in craft.reports if r.kind == (1, 7)}
        if not craft.until(lambda: ended() >= set(asked), 30):
            raise Failed(f"{len(set(asked) - ended())} of 500 were not answered within 30 s")
        found = [r.data[:4] for r in craft.reports if r.kind == (1, 7)]
        expect(found == asked, "answers are not in the order of the telecommands, or doubled")
