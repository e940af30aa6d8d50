# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A subsystem does not fly with the pages of a supervisor of another version, and names both versions."""

import fcntl
import os
import pathlib
import re
import socket
import struct
import subprocess
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ["HIROSCO_BIN"])
PAGES = (REPOSITORY / "hirosco/subsystem/pages/pages.hpp").read_text()
MAGIC = int(re.search(r"page_magic = (0x[0-9A-F]+)", PAGES)[1], 16)
VERSION = int(re.search(r"page_version = (\d+)", PAGES)[1])


def page(magic, version):
    """Memory as the supervisor's launcher hands it over."""
    memory = os.memfd_create("page", os.MFD_ALLOW_SEALING)
    os.ftruncate(memory, 8192)
    os.pwrite(memory, struct.pack("=II", magic, version), 0)
    fcntl.fcntl(memory, fcntl.F_ADD_SEALS, fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW)
    return memory


class Pages(unittest.TestCase):
    def refused(self, magic, version):
        ours, channel = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        given = (channel.fileno(), page(MAGIC, VERSION), page(magic, version))
        started = subprocess.run(
            [BINARIES / "hirosco-hello", "--descriptor", REPOSITORY / "subsystems/hello/hello.xml",
             *(word for name, number in zip(("channel", "vital", "permit"), given) for word in (f"--{name}", str(number)))],
            pass_fds=given, capture_output=True, text=True, check=False)
        for end in (ours, channel):
            end.close()
        for memory in given[1:]:
            os.close(memory)
        self.assertEqual(started.returncode, 3, started.stderr)
        return started.stderr

    def test_another_version_is_refused_by_name(self):
        self.assertIn(f"the supervisor's pages are of version {VERSION + 1}, this program's of version {VERSION}",
                      self.refused(MAGIC, VERSION + 1))

    def test_what_is_no_page_is_refused(self):
        self.assertIn("what should be the permit page is none", self.refused(MAGIC + 1, VERSION))

    def test_the_document_names_the_version_that_is_built(self):
        rows = [row for row in (REPOSITORY / "docs/interfaces.md").read_text().splitlines() if "`page_version`" in row]
        self.assertEqual(len(rows), 1)
        self.assertEqual(re.findall(r"`page_version` (\d+)|this program's of version (\d+)", rows[0]),
                         [(str(VERSION), ""), ("", str(VERSION))])


if __name__ == "__main__":
    unittest.main()
