#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Each shipped subsystem says what it takes of its computer and tells how much it has taken (docs/adr/0176): a descriptor of subsystems/,
missions/ or templates/ has <Resources> with its limits, and each of its configurations reports RESOURCE_STATS, cycle and budgets, and
what is put out, or would be, to each actuator that it has. The supervisor, whom nobody would end, reports the same. Prints who does not and
what to do, and takes each away from a copy of them, to be caught."""
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHIPPED = ("subsystems", "missions", "templates")
SUPERVISOR = "supervisor/supervisor.xml"
LIMITS = ("memory_kB", "shared_memory_kB", "threads", "descriptors")
SECOND_US = 1_000_000


def shipped(root):
    for folder in SHIPPED:
        for path in sorted((root / folder).rglob("*.xml")):
            if not {"testdata", "tests"} & set(path.relative_to(root).parts) and xml.parse(path).getroot().tag == "Subsystem":
                yield path
    yield root / SUPERVISOR


def devices(element):
    """(name, element) of each device, or of each endnode where it has several."""
    for device in element.findall("Device"):
        several = [each for each in device.findall("Endnode") if each.get("name")]
        for each in several:
            yield f"{device.get('name')}.{each.get('name')}", each
        if not several:
            yield device.get("name"), device


def reported(subsystem, configuration):
    """{parameter: shortest time between two reports in us}; 0 where a template leaves the period open."""
    found = {}
    sampling = configuration.get("sampling_us")
    for place in (subsystem, configuration):
        for structure in place.findall("HKService"):
            if structure.get("enabled") != "no":
                period = int(structure.get("interval")) * (int(sampling) if sampling.isdigit() else 0)
                for reference in structure.iter("ParamRef"):
                    for name in (reference.get("name"), reference.get("name").split(".")[0]):
                        found[name] = min(period, found.get(name, period))
    return found


def lacks_in(subsystem, configuration, supervisor):
    told = reported(subsystem, configuration)
    actuators = {name for name, device in devices(subsystem) if device.get("actuator") == "yes"}
    wanted = ["RESOURCE_STATS", "CYCLE_STATS"] + ["CYCLE_BUDGET"] * (not supervisor)
    wanted += ["LOOP_STATS"] * (subsystem.find("ServiceLoop") is not None)
    wanted += [re.sub(r"[-.]", "_", name) + "_OUTPUT" for name, _ in devices(configuration) if name in actuators]
    for name in wanted:
        if name not in told:
            yield f"configuration {configuration.get('name')} reports no {name}: put it into an <HKService> of 1 s or slower"
    if 0 < told.get("RESOURCE_STATS", SECOND_US) < SECOND_US:
        yield f"configuration {configuration.get('name')} reports RESOURCE_STATS more than once a second: a longer interval"


def problems(root):
    for path in shipped(root):
        subsystem = xml.parse(path).getroot()
        supervisor = path == root / SUPERVISOR
        where = path.relative_to(root).as_posix()
        resources = subsystem.find("Resources")
        limits = resources.attrib if resources is not None else {}
        # Whoever acts and never rests takes the time of others that act.
        acts = any(device.get("actuator") == "yes" for _, device in devices(subsystem))
        for name in () if supervisor else LIMITS + ("processor_percent",) * acts:
            if name not in limits:
                yield f"{where}: <Resources> has no {name}: nobody is promised it, and nobody who takes more is ended"
        for configuration in subsystem.findall("Configuration"):
            for lack in lacks_in(subsystem, configuration, supervisor):
                yield f"{where}: {lack}"


def self_test():
    """Each of these, taken away from a good one, is found, and the good one is not."""
    good = """<Subsystem name="A" id="2"><Resources memory_kB="1" shared_memory_kB="1" threads="2" descriptors="24" processor_percent="9"/>
<ServiceLoop name="L" period_us="1000"/><Device name="X"><Endnode name="Y" actuator="yes"/></Device>
<HKService id="1" interval="1000"><SampledOnce><ParamRef name="RESOURCE_STATS"/><ParamRef name="CYCLE_BUDGET"/><ParamRef name="LOOP_STATS"/>
</SampledOnce></HKService><Configuration name="C" id="1" sampling_us="1000"><HKService id="2" interval="9"><SampledOnce>
<ParamRef name="CYCLE_STATS"/><ParamRef name="X_Y_OUTPUT.F"/></SampledOnce></HKService><Device name="X"><Endnode name="Y"/></Device></Configuration></Subsystem>"""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for place in (*SHIPPED, "supervisor"):
            (root / place).mkdir()
        (root / SUPERVISOR).write_text(re.sub(r"<Resources[^>]*>", "", good))
        subject = root / "subsystems/a.xml"
        subject.write_text(good)
        assert not list(problems(root)), list(problems(root))
        for what in [f' {name}="' for name in (*LIMITS, "processor_percent")] + [
                "RESOURCE_STATS", "CYCLE_BUDGET", "LOOP_STATS", "CYCLE_STATS", "X_Y_OUTPUT"]:
            subject.write_text(good.replace(what, what[0] + "x" + what[1:]))
            assert len(list(problems(root))) == 1, (what, list(problems(root)))
        subject.write_text(good.replace('interval="1000"', 'interval="999"'))
        assert len(list(problems(root))) == 1
        subject.write_text(good)
        (root / SUPERVISOR).write_text(good.replace("RESOURCE_STATS", "OTHER"))
        assert len(list(problems(root))) == 1


if __name__ == "__main__":
    self_test()
    found = list(problems(ROOT))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
