# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What installed_robot.py judges by: rows of what was found beside what is required, the robot of a folder that `hirosco new robot` made, and places."""
import hashlib
import math
import re
import time
import xml.etree.ElementTree as ElementTree


def furthest(one, other):
    assert len(one) == len(other), (one, other)
    return max(abs(a - b) for a, b in zip(one, other))


def beside(place, begin, end):
    """How far a place is from the line between two others, m."""
    along = [b - a for a, b in zip(begin, end)]
    length = math.hypot(*along)
    gone = [p - a for a, p in zip(begin, place)]
    share = sum(a * b for a, b in zip(gone, along)) / length
    return math.sqrt(max(0.0, sum(part * part for part in gone) - share * share))


def between(one, other):
    """Angle between two unit quaternions, rad."""
    return 2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(one, other)))))


class Judge:
    def __init__(self):
        self.began, self.failed, self.worst = time.monotonic(), 0, {}

    def row(self, what, found, required, holds):
        self.failed += not holds
        print(f"  {what:<42} {found:>26}   {required}{'' if holds else '   NOT AS REQUIRED'}", flush=True)

    def at_most(self, what, found, most, unit, scale=1.0, digits=2, of=None):
        """`of`: of which kind of figure the worst is told at the end."""
        if of:
            self.worst[of] = max(found, self.worst.get(of, 0))
        self.row(what, f"{scale * found:.{digits}f} {unit}", f"<= {scale * most:g} {unit}", found <= most)

    def said(self, what, found, required=""):
        self.row(what, found, required, True)


class Robot:
    """What is needed of the folder that was made, by a reader of its own."""

    def __init__(self, name, folder, gripper):
        self.name, self.subsystem, self.folder, self.mission = name, name.upper(), folder, folder / "mission.xml"
        self.readme = (folder / "README.md").read_text()
        moving = [joint for joint in ElementTree.parse(folder / f"page/{name}.urdf").getroot().findall("joint")
                  if joint.get("type") in ("revolute", "continuous", "prismatic") and joint.find("mimic") is None]
        names = [joint.get("name") for joint in moving]
        arm = [joint for joint in moving if joint.get("name") not in gripper.split(",")]
        self.joints = [joint.get("name") for joint in arm]
        self.in_world = [names.index(joint) + 1 for joint in self.joints]
        self.ranges = [(float(joint.find("limit").get("lower", 0)), float(joint.find("limit").get("upper", 0)))
                       if joint.get("type") != "continuous" else None for joint in arm]
        self.speeds = [float(joint.find("limit").get("velocity")) for joint in arm]
        self.goal = [float(word) for word in re.search(rf"tc {name} MOVE_J (\S+)", self.readme)[1].split(",")]
        device = next(one for one in ElementTree.parse(self.mission).getroot().findall("SimulatedDevice") if one.get("name") == name)
        posture = next(one.get("value") for one in device.findall("Setting") if one.get("name") == "posture")
        whole = [float(word) for word in posture.split(",")]
        self.posture = [whole[place - 1] for place in self.in_world]
        line = next(one for one in ElementTree.parse(folder / f"{name}.xml").getroot().iter("Function") if one.get("name") == "MOVE_L")
        self.farthest = float(line.find("Argument").get("maximum"))

    def octets(self):
        """Of each file of the folder."""
        return {str(file.relative_to(self.folder)): hashlib.sha256(file.read_bytes()).hexdigest() for file in self.folder.rglob("*") if file.is_file()}
