# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The 69 URDF files of example-robot-data, what is in them by Python's own XML reader, and what Pinocchio (over urdfdom) and MuJoCo
make of them."""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

MOST_JOINTS = 16
MOVING = ("revolute", "continuous", "prismatic")


def folder():
    for place in sys.path:
        for path in pathlib.Path(place).glob("cmeel.prefix/share/example-robot-data/robots"):
            return path
    sys.exit("example-robot-data is not here")


def files():
    return sorted(folder().rglob("*.urdf"))


class Described:
    """Joints that move, in file order; those that mimic with whom, by how much."""

    def __init__(self, path):
        root = ElementTree.parse(path).getroot()
        self.moving, self.mimic, self.children = [], {}, {}
        parents = set()
        for joint in root.findall("joint"):
            parents.add(joint.find("parent").get("link"))
            self.children[joint.find("child").get("link")] = joint.get("name")
            if joint.get("type") not in MOVING:
                continue
            name = joint.get("name")
            self.moving.append(name)
            if (mimic := joint.find("mimic")) is not None:
                self.mimic[name] = (mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0)))
        self.own = [name for name in self.moving if name not in self.mimic]
        self.ends = [link.get("name") for link in root.findall("link") if link.get("name") not in parents]
        self.links = [link.get("name") for link in root.findall("link")]
        self.root = next((link for link in self.links if link not in self.children), None)


def without_shapes(path):
    """Of the same robot, for readers that want to open meshes; everything else stays."""
    text = path.read_text(errors="replace")
    for name in ("visual", "collision"):
        text = re.sub(rf"<{name}\b[^>]*/>", "", text)
        text = re.sub(rf"<{name}\b.*?</{name}>", "", text, flags=re.S)
    return text
