#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A log of 0.1.0 stays readable: two that its programs wrote lie in log_of_0_1_0/, and `hirosco log` says of them what Python's own sqlite3, and
the columns of the text, say."""
import datetime, json, os, pathlib, shutil, sqlite3, subprocess, tempfile, unittest

HERE = pathlib.Path(__file__).resolve().parent
HIROSCO = pathlib.Path(os.environ["HIROSCO_BIN"]) / "hirosco"
MISSION = HERE.parents[1] / "missions" / "hello" / "mission.xml"
TAI_BEGIN = datetime.datetime(1958, 1, 1)
TAI_MINUS_UTC = datetime.timedelta(seconds=37)  # since 2017; the time of a log is TAI (supervisor/platform/README.md)


def utc(tai, nanoseconds):
    return f"{tai - TAI_MINUS_UTC:%Y-%m-%dT%H:%M:%S}.{nanoseconds:09d}Z"


def of_database(path):
    """(number, stored, kind, source, peer, octets of the packet, note) of each record."""
    with sqlite3.connect(f"file:{path}?immutable=1", uri=True) as database:
        rows = database.execute("SELECT number, stored, kind, source, peer, packet, note FROM log ORDER BY number").fetchall()
    return [(number, utc(TAI_BEGIN + datetime.timedelta(seconds=stored // 10**9), stored % 10**9), kind, source, peer, bytes(packet), note)
            for number, stored, kind, source, peer, packet, note in rows]


def of_text(path):
    records = []
    for line in path.read_text().splitlines():
        number, _, stored, _, kind, source, peer, _, packet, note = line.rsplit(" #", 1)[0].split(" ", 9)
        whole, nanoseconds = stored.split(".")
        records.append((int(number), utc(datetime.datetime.fromisoformat(whole), int(nanoseconds)), kind, int(source), int(peer),
                        b"" if packet == "-" else bytes.fromhex(packet), note))
    return records


def label(packet):
    """Whether it is a telecommand, service and subtype: by the octets of PUS-C, 7.4.3.1 and 7.4.4.1."""
    telecommand = bool(packet[0] & 0x10)
    return f"{'TC' if telecommand else 'TM'}[{packet[7]},{packet[8]}]"


class LogOf010(unittest.TestCase):
    def read(self, name, kept_as, *more):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / name
            shutil.copy(HERE / "log_of_0_1_0" / kept_as, path)
            done = subprocess.run([HIROSCO, "log", "--mission", MISSION, "--path", path, "--last", "1000", "--json", *more], capture_output=True,
                                  text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [json.loads(line) for line in done.stdout.splitlines()]

    def judge(self, name, kept_as, records, count):
        self.assertEqual(len(records), count)
        lines = self.read(name, kept_as)
        self.assertEqual([(line["number"], line["stored"], line["kind"], line["source"], line["peer"]) for line in lines],
                         [record[:5] for record in records])
        for line, (*_, packet, note) in zip(lines, records):
            self.assertIn(label(packet) if packet else note, line["text"])
        words = "\n".join(line["text"] for line in lines)
        for said in ("action 1>2: started COMMUNICATION", "SET_STATE STATE=PreOperational", "COMMUNICATION info GROUND_LINK_RESTORED",
                     "TM[1,7] HELLO completed", "TC[17,1] HELLO", "TM[17,2] HELLO", "TM[3,25] HELLO housekeeping 4711",
                     "commissioned: mode operation"):
            self.assertTrue(said in words, said)
        # STATE_CHANGED was an event of each descriptor; now the framework has it. No other event is called by its old number.
        self.assertIn("TM[5,1] COMMUNICATION info 204", words)

    def test_the_database_is_read_record_by_record(self):
        self.judge("hello.db", "database.sqlite", of_database(HERE / "log_of_0_1_0" / "database.sqlite"), 112)

    def test_the_text_is_read_record_by_record(self):
        self.judge("hello.log", "lines.txt", of_text(HERE / "log_of_0_1_0" / "lines.txt"), 114)

    def test_what_is_asked_for_is_found(self):
        pings = self.read("hello.db", "database.sqlite", "--apid", "7", "--service", "17")
        self.assertEqual([line["kind"] for line in pings], ["telecommand-forwarded", "telecommand-received", "telemetry"])


if __name__ == "__main__":
    unittest.main()
