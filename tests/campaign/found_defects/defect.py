# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a finding of review is, and the files in which there are several."""
from dataclasses import dataclass

SUPERVISION, CYCLE = "supervisor/supervision", "hirosco/subsystem/cycle/cycle.cpp"
PERMIT, SAYS = "hirosco/subsystem/cycle/permit_watch.cpp", "hirosco/subsystem/cycle/report_writer.cpp"
GUARD, LOOP_WATCH = "supervisor/guard/guard.cpp", "supervisor/guard/loop_watch.cpp"
MANIPULATOR = "subsystems/manipulator/manipulator.cpp"
PERMISSION, LINK_ENDS = f"{SUPERVISION}/data_handling/permission.cpp", "hirosco/subsystem/service_loop/link_ends.cpp"
RECEPTION, GROUND_LINK = f"{SUPERVISION}/data_handling/reception.cpp", "subsystems/communication/ground_clients.cpp"
MODES = f"{SUPERVISION}/modes/modes.cpp"
TELECOMMANDS, RETRIEVAL = f"{SUPERVISION}/data_handling/telecommands.cpp", f"{SUPERVISION}/data_handling/retrieval.cpp"
DEVICE, LOG_STORE = "simulation/devices/simulated_device.cpp", "supervisor/platform/storage/log_store.cpp"
STANDARD_ERROR, MANIPULATOR_TEST = "supervisor/platform/launch/standard_error.cpp", "manipulator_subsystem_test"


@dataclass(frozen=True)
class Defect:
    """Text `now` of a file was `was` where PLANTED, which is true in the run that has this defect; the tests of `filter` in the
    program `test` must see it. A descriptor is read by each run: there `was` is all that stands."""
    name: str
    file: str
    now: str
    was: str
    test: str
    filter: str

    @property
    def is_read(self):
        return self.file.endswith(".xml")

    @property
    def planted(self):
        return self.was.replace("PLANTED", f'::planted("{self.name}")')
