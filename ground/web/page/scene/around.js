// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What stands around the robot: sky and spacecraft, made after the robot moves, for without a graphics card that takes a second; and the
// modules of a mission that shows no robot.
import {Vector3} from 'three';
import {state_name} from '../commanding.js';
import {state_text} from '../format.js';
import {mission, status_of} from '../store.js';
import {surface_x_m} from '../parts/hand.js';
import {colours} from './instruments.js';
import {Kit, merged} from './kit.js';
import {hider_of} from './plain.js';
import {lights, mirrored_cube, sky} from './sky.js';
import {module_of, module_places, usual_surroundings} from './usual.js';

/// It is made once so many of the robot's poses were drawn, or after as long.
const first_poses = 7, patience_ms = 1500;

/// The robot moves first; what is around it takes a second to make without a graphics card.
export class Surroundings {
  #timer = null;

  /// `card_code()`: what draws by a graphics card, and what stands still where there is none.
  constructor(view, card_code) {
    Object.assign(this, {view, card_code});
  }

  begin() {
    if (this.view.software) this.#timer = setTimeout(() => this.#make(), patience_ms);
    else this.#make();
  }

  /// So many poses of the robot, until now.
  drawn(poses) {
    if (this.#timer && poses >= first_poses) this.#make();
  }

  #make() {
    const {view} = this;
    clearTimeout(this.#timer);
    this.#timer = null;
    if (!view.still?.renderer && view.context) return this.card_code().then((card) => {
      if (view.closed) return;
      view.renderer = view.still.renderer = card.unseen_renderer(view.context);
      view.renderer.setSize(view.size.x, view.size.y, false);
      this.#make();
    });
    const later = globalThis.requestIdleCallback ?? ((then) => setTimeout(then, 50));
    const steps = in_steps(view);
    const next = () => {
      if (view.closed) return;
      steps.shift()();
      view.draw_soon();
      if (steps.length) later(next, {timeout: 300});
      else view.nodes.stage.dataset.surroundings = 'yes';
    };
    later(next, {timeout: 500});
  }
}

/// One for each moment that is free.
function in_steps(view) {
  const {software, far, scale, description, own} = view, light_at = new Vector3().fromArray(description.camera.to_m);
  return [
    ...(software ? [() => view.finish()] : []),
    () => far.add(...sky(scale), ...(software ? lights({target: light_at, reach_m: 0.62 * scale, shadow: false}) : [])),
    () => {
      const kit = new Kit(software ? mirrored_cube() : view.mirror, software ? 0.7 : 1), around = own.surroundings?.(kit) ?? usual_surroundings(kit, view.robots.length > 0);
      if (description.modules) view.modules = new Modules(view, kit, around);
      around.traverse((part) => { if (part.isMesh) part.castShadow = part.receiveShadow = !software; });
      far.add(around);
      if (!software) return;
      if (own.obstacles) {
        const about = {...description, surface_x_m}, hider = hider_of(own.obstacles(view.kit, about), scale);
        far.add(merged(own.obstacles(kit, about)));
        if (hider) view.scene.add(hider);
      }
      const standing = view.robots.filter((robot) => !robot.about.inset).flatMap((robot) => robot.stand_still(own.links?.[robot.about.urdf]?.(kit) ?? {}, scale));
      if (standing.length) far.add(...standing);    // three.js minds when there is nothing to add
      view.contact.stand_still(far, () => view.camera_moved(true));
    },
    () => {
      view.still?.grown();
      delete view.nodes.stage.dataset.still;
    },
  ];
}

/// A module for each subsystem: its name and state stand at it, its lamp tells whether it deviates.
class Modules {
  constructor(view, kit, around) {
    this.view = view;
    const names = (mission.value?.subsystems ?? []).map((one) => one.name);
    this.list = module_places(names.length).map(([x, y, wide], i) => {
      const {group, lamp, top} = module_of(kit, wide);
      group.position.set(x, y, -0.02);
      around.add(group);
      return {name: names[i], lamp, at: new Vector3(x, y, top + 0.02), tag: view.readout.tags.add('', '', ''), told: ''};
    });
    this.look();
  }

  look() {
    for (const module of this.list) {
      const now = status_of(module.name), state = state_name(now?.state), told = `${state} ${now?.inhibited?.length ?? 0}`;
      this.view.readout.tags.tell(module.tag, module.name.slice(0, 24), {unit: state_text(state)});
      if (told === module.told) continue;
      module.told = told;
      module.lamp.material.color.set(state === 'ErrorOperational' || now?.inhibited?.length ? colours.wrong : state === 'Operational' ? colours.measured : 0x4b535e);
      this.view.still?.ask();
      this.view.draw_soon();
    }
  }
}
