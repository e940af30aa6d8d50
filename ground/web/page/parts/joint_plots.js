// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a part of the robot has to show in plots: the joint that moves it, by its angle, and what of the subsystem belongs to the same joint.

import {size_of} from './size_of.js';

const most = 4;
const base_of = (name) => name.replace(/\[\d+\]$/, '');
const place_of = (name) => name.match(/\[\d+\]$/)?.[0] ?? '';
const structure_of = (name) => base_of(name).replace(/\.[^.]*$/, '');
const torques = new Set(['N m', 'Nm', 'N m|N']);

/// [[angle, others of its kind], [torques]] for the parameter of an angle; `columns`: name -> {name, subsystem, unit}. Elements of other arrays belong to the joint
/// when those are as long; a force does when it stands in the angle's own structure. Empty where the angle is not known.
export function plots_of_angle(angle, columns) {
  const own = columns.get(angle);
  if (!own) return [];
  const lengths = new Map();
  for (const {name} of columns.values()) lengths.set(base_of(name), (lengths.get(base_of(name)) ?? 0) + 1);
  const place = place_of(angle), long = lengths.get(base_of(angle));
  const mates = [...columns.values()].filter(({name, subsystem}) => subsystem === own.subsystem && name !== angle && place_of(name) === place && lengths.get(base_of(name)) === long &&
    (place || structure_of(name) === structure_of(angle)));
  const near = (one, other) => (structure_of(other.name) === structure_of(angle)) - (structure_of(one.name) === structure_of(angle));
  const kind = mates.filter(({unit}) => unit && unit === own.unit).sort(near);
  const turned = mates.filter(({name, unit}) => torques.has(unit) || unit === 'N' && structure_of(name) === structure_of(angle)).sort(near);
  return [[own, ...kind], turned].map((group) => group.slice(0, most).map(({name}) => name)).filter((group) => group.length);
}

/// The joint of `joints` (names) that moves a link of a URDF: the next one above it; null for what stands still.
export function joint_above(link, joints) {
  for (let part = link?.parent; part; part = part.parent) if (part.isURDFJoint && joints.includes(part.urdfName ?? part.name)) return part.urdfName ?? part.name;
  return null;
}

/// What a click on `link` shows: the forces of a tip, all joints of a handle, the joint that moves it. [[names of one plot]].
export function plots_of_link(link, {about, links}, columns) {
  const angles = Object.values(about.joints);
  if (about.tip && link === links[about.tip] && about.force) {
    const known = about.force.filter((name) => columns.has(name));
    // First the one number that the picture has, then what it is of.
    return known.length ? [[...known.length === about.force.length ? [size_of(known)] : [], ...known]] : [];
  }
  if (about.handle && link === links[about.handle]) {
    const all = angles.map((angle) => plots_of_angle(angle, columns));
    return [0, 1].map((i) => all.flatMap((groups) => (groups[i] ?? []).slice(0, 1))).filter((group) => group.length);
  }
  const joint = joint_above(link, Object.keys(about.joints));
  return joint ? plots_of_angle(about.joints[joint], columns) : [];
}

export const plots_address = (groups) => `#/plots?p=${groups.map((group) => group.map(encodeURIComponent).join('+')).join('|')}`;
