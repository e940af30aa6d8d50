// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// scene.json of the mission's page folder: what there is to be seen, and which parameters move it (docs/guide/ground_station.md).
import {signal} from '@preact/signals';
import {pictured} from './curves.js';
import {size_of} from './size_of.js';
import {mission_code, mission_json, mission_text} from '../mission_files.js';

/// scene.json of the mission; null when there is none, undefined while it is not known.
export const scene_of_mission = signal(undefined);

/// A force that is drawn is an arrow with one number, and so is what a hand feels: both can be plotted as that.
scene_of_mission.subscribe((scene) => {
  pictured.value = new Map((scene?.robots ?? []).flatMap(({subsystem, force, torque}) => [[force, 'force at the tip'], [torque, 'torque felt by the hand']]
      .filter(([names]) => names?.length).map(([names, words]) => [size_of(names), {subsystem, words}])));
});

/// The parameters of a plot of scene.json, which has them alone or among its curves.
export const plot_names = (plot) => Array.isArray(plot) ? plot : (plot?.curves ?? []).map((one) => one.name);
let code = null;
/// Asked for once: a promise that was kept is not waited for again.
export function drawing_code() {
  code ??= import('../scene/view.js').catch((error) => {
    code = null;
    throw error;
  });
  return code;
}
// A page that opens with the robot in it asks for the code before it knows what to draw.
export const opens_with_robot = !/^#\/(?!overview)/.test(location.hash);
if (opens_with_robot) drawing_code().catch(() => {});
mission_json('scene.json')
    .then((description) => {
      // What it names is on its way while the page is put together.
      if (description && opens_with_robot) {
        for (const ahead of [...description.robots.map(({urdf}) => mission_text(urdf)), description.parts ? mission_code(description.parts) : null]) ahead?.catch(() => {});
      }
      scene_of_mission.value = description;
    })
    .catch(() => { scene_of_mission.value = null; });
