// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a robot's URDF file says of its joints, for views without 3D; and which of them a telecommand leads.
import {signal} from '@preact/signals';
import {asset} from '../api.js';
import {mission_folder} from '../mission_files.js';
import {led} from './numbers.js';
import {scene_of_mission} from './scene_file.js';

const turns_rad = 2 * Math.PI;
const number = (node, name) => Number.parseFloat(node?.getAttribute(name) ?? '');

/// {joint: {lower, upper, velocity}}; one that turns on and on has a turn to each side.
export function limits_of(text) {
  const file = new DOMParser().parseFromString(text, 'text/xml');
  return Object.fromEntries([...file.querySelectorAll('robot > joint')].map((joint) => {
    const limit = joint.querySelector('limit'), on = joint.getAttribute('type') === 'continuous';
    return [joint.getAttribute('name'), {lower: on ? -turns_rad : number(limit, 'lower') || 0, upper: on ? turns_rad : number(limit, 'upper') || 0, velocity: number(limit, 'velocity')}];
  }));
}

/// URDF of scene.json -> its limits; nothing while they are on their way.
const known = signal({});
const asked = new Set();
function limits_in(urdf) {
  if (!asked.has(urdf)) {
    asked.add(urdf);
    asset(`${mission_folder}/${urdf}`).then((answer) => answer.text()).then((text) => { known.value = {...known.value, [urdf]: limits_of(text)}; }).catch(() => {});
  }
  return known.value[urdf];
}

/// The joints that an array of numbers leads, by its elements: [{name, parameter, lower, upper}], of a `jog` the range of their velocities and no
/// parameter; null where there is an element without one.
export function joints_of(subsystem, action, argument) {
  if ((argument.count ?? 1) <= 1) return null;
  const leads = (one) => ['goal', 'jog'].find((way) => one.subsystem === subsystem && one[way]?.function === action);
  const robot = scene_of_mission.value?.robots?.find(leads), limits = robot && limits_in(robot.urdf);
  if (!limits) return null;
  const way = leads(robot), joints = new Array(argument.count).fill(null);
  for (const [joint, words] of Object.entries(robot[way].joints)) {
    const to = led(words), name = robot.names?.[joint] ?? joint;
    if (to.argument !== argument.name || !(to.element < joints.length) || !limits[joint]) continue;
    const {velocity} = limits[joint];
    joints[to.element] = way === 'goal' ? {name, parameter: robot.joints[joint], ...limits[joint]} : {name, lower: -velocity, upper: velocity};
  }
  return joints.every(Boolean) ? joints : null;
}

/// The joint whose angle this parameter is, where an array leads it: a number of an array says of no joint by itself.
export function joint_of(parameter) {
  for (const robot of scene_of_mission.value?.robots ?? []) {
    const [joint] = Object.entries(robot.joints).find(([, name]) => name === parameter) ?? [];
    if (!joint || led(robot.goal?.joints[joint] ?? '').element === null) continue;
    const limits = limits_in(robot.urdf)?.[joint];
    return limits ? {name: robot.names?.[joint] ?? joint, ...limits} : null;
  }
  return null;
}
