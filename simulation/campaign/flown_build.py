# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Which build flies: one digest of the programs of a mission and of its descriptors, so that what another build has flown is not counted with it."""
import hashlib, pathlib
import xml.etree.ElementTree as xml


def executables_of(mission):
    """Names of the programs that the mission flies."""
    return sorted({element.get("executable") for element in xml.parse(mission).iter() if element.get("executable")})


def descriptors_of(mission):
    return sorted({mission.parent / element.get("descriptor") for element in xml.parse(mission).iter() if element.get("descriptor")})


def build_of(mission, programs):
    """`mission`: its folder or file. `programs`: files; those that are not there count as such."""
    mission = pathlib.Path(mission)
    mission = mission / "mission.xml" if mission.is_dir() else mission
    digest = hashlib.sha256()
    for file in (mission, *descriptors_of(mission), *map(pathlib.Path, programs)):
        of_file = hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else "not there"
        digest.update(f"{of_file}  {file.name}\n".encode())
    return digest.hexdigest()[:16]


def modules_of(mission, program):
    """Of the subsystems and devices that this program flies on virtual time, beside it or where it is installed."""
    mission, folder = pathlib.Path(mission), pathlib.Path(program).resolve().parent
    mission = mission / "mission.xml" if mission.is_dir() else mission
    found = (next((file for file in (folder / f"{name}.so", folder.parent / "lib/hirosco" / f"{name}.so") if file.is_file()), None)
             for name in executables_of(mission))
    return [file for file in found if file is not None]
