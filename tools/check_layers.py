#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Who may include whom (CONTRIBUTING.md). Prints what breaks the rules; `planted` breaks each rule once, to be caught."""
import pathlib, re, sys
libraries = ["utilities", "resource", "xml", "parameter", "data_transfer", "descriptor", "pus", "subsystem"]  # lowest first
may = {"hirosco": ["hirosco"], "robotics": ["hirosco", "robotics"], "subsystems": ["hirosco", "robotics"], "supervisor": ["hirosco", "supervisor"],
       "simulation": ["hirosco", "simulation"], "ground": ["hirosco", "ground"]}  # the other folders: everything; nobody but missions and tests a mission
shells = ("hirosco/utilities/os/", "hirosco/data_transfer/device/device_socket", "hirosco/data_transfer/device/exchanged_folder", "hirosco/data_transfer/device/framed_stream", "hirosco/data_transfer/device/private_folder", "hirosco/data_transfer/device/private_memory_folder", "hirosco/data_transfer/device/side_lock",
          "hirosco/data_transfer/channel/socket_channel", "hirosco/data_transfer/channel/stream_channel", "hirosco/data_transfer/address/",
          "hirosco/data_transfer/link/udp_link",
          "hirosco/data_transfer/memory/sealed_memory", "supervisor/guard/guard_shell", "supervisor/flight_shell.cpp", "supervisor/keeper/", "supervisor/platform/", "tools/",
          "tests/", "bench/", "simulation/devices/")
means = re.compile(r"hirosco/data_transfer/device/\w+_flow\.[ch]pp$")  # one each
# These, means of transfer, and tests, their rigs, main.cpp, run.cpp and a TCP server anywhere, may ask the operating system.
system = re.compile(r"(sys|net|netinet|arpa|linux)/|(unistd|fcntl|pthread|poll|sched|spawn|signal|semaphore|mqueue|"
                    r"termios|dirent|netdb|dlfcn|ifaddrs)\.h$|csignal$")
include = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.M)
own_tests = re.compile(r"^(?:missions|subsystems|simulation/devices)/[^/]+/tests/")  # as those of tests/ (docs/adr/0198)
def rank(path):
    return libraries.index(name) if (name := pathlib.Path(path).parts[1].split(".")[0]) in libraries else -1
station = ["archive", "model", "downlink", "commands", "replay", "people", "api", "shell"]  # of ground/, lowest first
generic = ["author", "pages", "cycle", "service_loop", "process"]  # of hirosco/subsystem/, lowest first; example and testing/ know all
def height(path):
    name = pathlib.Path(path).parts[2]
    return generic.index(name) if name in generic else len(generic)
def level(path):
    name = pathlib.Path(path).parts[1]
    return station.index(name) if name in station else len(station)
def wrong(path, to):
    path, to = own_tests.sub("tests/", path), own_tests.sub("tests/", to)
    top, target = path.split("/")[0], to.split("/")[0]
    if system.match(to):
        asks = path.startswith(shells) or means.match(path) or path.endswith(("_test.cpp", "main.cpp", "run.cpp")) or "/testing/" in path or "/tcp_server." in path
        return not asks and "the operating system"
    if to.startswith("boost/"): return not path.startswith("ground/shell/") and "Boost, which ground/shell/ alone knows"
    if top == target == "ground" and not path.endswith("_test.cpp"):
        if path.startswith("ground/clients/"): return not to.startswith(("ground/clients/", "ground/model/")) and "more than the model"
        if level(to) > level(path): return "a higher folder of the ground station"
    if "/" not in to or target not in [*may, "tools", "tests", "bench", "missions"]: return False  # not ours
    if target == "missions" and top not in ("missions", "tests"): return "a mission"
    if path.startswith(("simulation/spacecraft/", "simulation/figures/", "simulation/campaign/")): return target == "robotics" and "the on-board model of a robot"  # assemble and fly all parts
    same = path.split("/")[:2] == to.split("/")[:2]
    if top in may and target not in may[top] and not same: return "another part"
    if top == "robotics" and path.startswith("robotics/dynamics/") and to.startswith(("robotics/urdf/", "robotics/motion/", "robotics/shapes/")): return "a higher folder of robotics"
    if top == "simulation" and target == "robotics": return "the on-board model of a robot"
    if top == target == "hirosco" and rank(to) > rank(path): return "a higher rank"
    if path.startswith("hirosco/subsystem/") and to.startswith("hirosco/subsystem/") and not path.endswith("_test.cpp"):
        if height(to) > height(path): return "a higher folder of the generic subsystem"
    if top == "ground" and to.startswith("hirosco/subsystem"): return "the generic subsystem"
    if top in may and to.startswith(("simulation/spacecraft", "simulation/figures")) and not same: return "the simulated spacecraft"
    return "/detail/" in to and not path.startswith(to.split("/detail/")[0] + "/") and "a private header"
planted = ["hirosco/xml/a.hpp hirosco/pus/b.hpp", "simulation/devices/a/a.cpp robotics/dynamics/b.hpp", "simulation/spacecraft/a.cpp robotics/urdf/b.hpp",
           "robotics/dynamics/a.cpp robotics/urdf/b.hpp", "hirosco/pus/a.cpp robotics/urdf/b.hpp", "robotics/urdf/a.cpp subsystems/b/b.hpp", "subsystems/a/a.cpp subsystems/b/b.hpp", "ground/a.cpp supervisor/b.hpp",
           "ground/a.cpp hirosco/subsystem/b.hpp", "hirosco/pus/a.cpp sys/mman.h", "supervisor/a.cpp unistd.h",
           "hirosco/pus/a.cpp hirosco/parameter/detail/b.hpp", "simulation/world/a.cpp simulation/spacecraft/b.hpp",
           "subsystems/a/a.cpp supervisor/b.hpp", "hirosco/pus/a.cpp supervisor/b.hpp",
           "simulation/figures/a.cpp missions/b/b.hpp", "tools/hirosco/a.cpp missions/b/b.hpp",
           "ground/api/a.cpp boost/asio.hpp", "tools/ground/a.cpp boost/asio.hpp", "ground/model/a.cpp ground/api/b.hpp",
           "subsystems/a/a.cpp subsystems/a/tests/b.hpp", "subsystems/a/testing/a.hpp simulation/world/b.hpp", "ground/api/a.cpp ground/shell/b.hpp", "hirosco/subsystem/author/a.hpp hirosco/subsystem/service_loop/b.hpp", "ground/clients/python/a.cpp ground/replay/b.hpp"]
missed = [case for case in planted if not wrong(*case.split())]
root = pathlib.Path(__file__).resolve().parent.parent
files = [file for top in [*may, "missions", "tools", "tests", "bench"] for file in sorted((root / top).rglob("*.[hc]pp"))]
found = [f"{path}: includes {to}, {reason}" for path, text in ((f.relative_to(root).as_posix(), f.read_text()) for f in files)
         for to in include.findall(text) if (reason := wrong(path, to))]
sys.exit("\n".join(found + [f"planted and not seen: {case}" for case in missed]) or ("no files" if not files else None))
