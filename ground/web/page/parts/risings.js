// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// When a mode was up with all its members, out of what the archive tells of modes and states. Without browser and archive.

/// [{t, name}], the oldest first. `changes`: [{t, mode} or {t, subsystem, state}], states by name; `modes` as the mission has them. Of what held at the
/// first change nobody knows since when.
export function risings(changes, modes) {
  const sorted = changes.toSorted((a, b) => a.t - b.t), states = new Map(), found = [];
  let mode, was;
  for (const [i, one] of sorted.entries()) {
    if (one.subsystem === undefined) mode = modes.find(({id, name}) => id === one.mode || name === one.mode);
    else states.set(one.subsystem, one.state);
    // What changes at one instant is one change.
    if (sorted[i + 1]?.t === one.t) continue;
    const members = mode?.commission ?? [], known = members.every(({subsystem}) => states.has(subsystem));
    const now = !mode || !known ? undefined : members.length && members.every(({subsystem, state}) => states.get(subsystem) === state) ? mode.name : '';
    if (now && was !== undefined && was !== now) found.push({t: one.t, name: now});
    was = now;
  }
  return found;
}
