#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""foreign_robot.py FOLDER: writes a robot as others write theirs, for `hirosco new robot`: a package with meshes in millimetres, binary and in
text, two links that turn, a pair of fingers that slide, words of simulators, and an encoding that nobody needs."""
import pathlib
import struct
import sys

MM = 'scale="0.001 0.001 0.001"'


def triangles(x, y, z):
    """Of a box about its centre, mm: two of each side, seen from outside."""
    def corner(axis, side, first, second):
        sizes, at = (x / 2, y / 2, z / 2), [0, 0, 0]
        for which, sign in zip((axis, (axis + 1) % 3, (axis + 2) % 3), (side, first, second)):
            at[which] = sign * sizes[which]
        return tuple(at)
    for axis in range(3):
        for side in (1, -1):
            a, b, c, d = (corner(axis, side, *signs) for signs in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
            normal = tuple(float(side * (each == axis)) for each in range(3))
            yield from ((normal, *corners[::side]) for corners in ((a, b, c), (a, c, d)))


def binary(*sizes):
    made = list(triangles(*sizes))
    return bytes(80) + struct.pack("<I", len(made)) + b"".join(struct.pack("<12fH", *(number for each in one for number in each), 0) for one in made)


def in_text(*sizes):
    def words(place):
        return " ".join(f"{number:g}" for number in place)
    facets = "".join(f"facet normal {words(normal)}\nouter loop\n" + "".join(f"vertex {words(corner)}\n" for corner in corners) + "endloop\nendfacet\n"
                     for normal, *corners in triangles(*sizes))
    return f"solid box\n{facets}endsolid box\n".encode()


def link(name, mass, sizes, centre_z, mesh):
    x, y, z = (size / 1000 for size in sizes)
    ixx, iyy, izz = (mass / 12 * moment for moment in (y * y + z * z, x * x + z * z, x * x + y * y))
    shape = f'<origin xyz="0 0 {centre_z}"/><geometry><mesh filename="package://arm_description/meshes/{mesh}" {MM}/></geometry>'
    return (f'  <link name="{name}">\n    <inertial><origin xyz="0 0 {centre_z}"/><mass value="{mass}"/>'
            f'<inertia ixx="{ixx:.3g}" ixy="0" ixz="0" iyy="{iyy:.3g}" iyz="0" izz="{izz:.3g}"/></inertial>\n'
            f"    <visual>{shape}</visual>\n    <collision>{shape}</collision>\n  </link>\n")


def joint(name, kind, parent, child, place, axis="0 0 1", more=""):
    return (f'  <joint name="{name}" type="{kind}">\n    <origin xyz="{place}"/><parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
            f"{more}\n  </joint>\n")


def urdf():
    turns = '<limit lower="-2" upper="2" velocity="2" effort="60" acceleration="3" jerk="30"/><dynamics damping="0.5" friction="0.5"/>'
    slides = '<limit lower="0" upper="0.05" velocity="0.1" effort="80"/>'
    return ('<?xml version="1.0" encoding="ISO-8859-1"?>\n<robot name="foreign">\n'
            + link("base_link", 3, (120, 120, 100), 0.05, "base.stl")
            + joint("shoulder", "revolute", "base_link", "upper_arm", "0 0 0.11", more=turns)
            + link("upper_arm", 1, (50, 50, 280), 0.15, "arm.stl")
            + joint("elbow", "revolute", "upper_arm", "forearm", "0 0 0.3", "0 1 0", turns)
            + link("forearm", 1, (50, 50, 280), 0.15, "arm.stl")
            + joint("hand_mount", "fixed", "forearm", "hand", "0 0 0.3")
            + link("hand", 0.5, (160, 50, 40), 0.02, "hand.stl")
            + joint("left_slide", "prismatic", "hand", "left_finger", "0.006 0 0.04", "1 0 0", slides + '<dynamics damping="5" friction="1"/>')
            + link("left_finger", 0.15, (10, 20, 80), 0.041, "finger.stl")
            + joint("right_slide", "prismatic", "hand", "right_finger", "-0.006 0 0.04", "-1 0 0", slides + '<mimic joint="left_slide"/>')
            + link("right_finger", 0.15, (10, 20, 80), 0.041, "finger.stl")
            + '  <transmission name="elbow_drive"><type>transmission_interface/SimpleTransmission</type></transmission>\n'
              '  <gazebo reference="forearm"><material>Gazebo/Grey</material></gazebo>\n</robot>\n')


def main(folder):
    package = pathlib.Path(folder) / "arm_description"
    for each in ("urdf", "meshes"):
        (package / each).mkdir(parents=True)
    for mesh, octets in {"base.stl": binary(120, 120, 100), "arm.stl": binary(50, 50, 280), "hand.stl": in_text(160, 50, 40), "finger.stl": in_text(10, 20, 80)}.items():
        (package / "meshes" / mesh).write_bytes(octets)
    (package / "urdf/arm.urdf").write_text(urdf())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
