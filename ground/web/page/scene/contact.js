// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What follows a robot's tip: the arrow of the force that it feels, the trail of where it was, the spring that hangs on it.
import {Vector3} from 'three';
import {values} from '../store.js';
import {Arrow, colours, contact_ring, Ribbon} from './instruments.js';
import {affordable} from './plain.js';
import {least_force_n} from './readout.js';

const trail_points = 300, trail_step_m2 = 4e-6;
const force_m = [0.03, 0.35];

export class Contact {
  #springs = [];
  #turned = false;
  #hooked = null;
  #changed = () => {};

  constructor(scene, description, thick) {
    Object.assign(this, {scene, description});
    this.force = new Arrow(colours.touched, 0.0046);
    this.ring = contact_ring(1);
    this.trail = new Ribbon(trail_points, 0.0022 * thick);
    scene.add(this.force.group, this.ring, this.trail.mesh);
  }

  add_spring(kit, {from_m, to_m}, software) {
    const coil = kit.coil(9, 0.0048, 0.0009, affordable(kit.material.steel, software));
    coil.position.set(from_m[0], from_m[1], this.description.plane_z_m);
    const reach = (x, y) => {
      coil.rotation.z = Math.atan2(y - from_m[1], x - from_m[0]);
      coil.scale.x = Math.hypot(x - from_m[0], y - from_m[1]);
    };
    const spring = {coil, reach, rest: () => reach(to_m[0], to_m[1])};
    spring.rest();
    this.#springs.push(spring);
    this.scene.add(coil);
  }

  /// Where what stands still is a picture: springs that nothing hangs on are in `far`, which is `changed()` when one is taken or laid down.
  stand_still(far, changed) {
    for (const spring of this.#springs) {
      spring.still = spring.coil.clone();
      far.add(spring.still);
    }
    this.#changed = changed;
    this.#hooked = null;
  }

  /// The camera turned: a ribbon faces it.
  turned() { this.#turned = true; }
  forget() { this.trail.clear(); }

  /// To where `robot` stands; `moved` since the picture before.
  follow(robot, moved, camera, show) {
    this.#follow_force(robot, show);
    const last = this.trail.points.at(-1);
    if (moved && (!last || last.at.distanceToSquared(robot.tip) > trail_step_m2)) {
      this.trail.add(robot.tip, robot.force_n > least_force_n ? colours.touched : 0xdfe5ee);
      this.#turned = true;
    }
    if (this.#turned) this.trail.lay(camera, (i, count) => 0.85 * (i / count) ** 1.6);
    this.#turned = false;
    this.trail.mesh.visible = show.trail;
    const hooked = values.get(this.description.hooked)?.v ?? 0;
    if (hooked) this.#springs[hooked - 1]?.reach(robot.tip.x, robot.tip.y);
    if (hooked !== this.#hooked) this.#take(hooked);
  }

  #take(hooked) {
    const before = this.#hooked;
    this.#hooked = hooked;
    this.#springs.forEach((spring, i) => {
      const taken = hooked === i + 1;
      if (!taken) spring.rest();
      if (!spring.still) return;
      spring.still.visible = !taken;
      spring.coil.visible = taken;
    });
    if (before !== null) this.#changed();
  }

  #follow_force(robot, show) {
    const [x, y, z = 0] = (robot.about.force ?? []).map((name) => values.get(name)?.v ?? 0), size = Math.hypot(x, y, z);
    robot.force_n = size;
    const shown = show.force && size > least_force_n && robot.body.visible;
    this.force.group.visible = this.ring.visible = shown;
    if (!shown) return;
    const along = new Vector3(x, y, z).divideScalar(size), length = Math.min(force_m[1], Math.max(force_m[0], size * robot.about.metres_per_newton));
    const from = robot.tip.clone().addScaledVector(along, 0.006);
    this.force.point(from, along, length);
    robot.force_end = from.addScaledVector(along, length);
    this.ring.position.copy(robot.tip).addScaledVector(along, -0.0095);
    this.ring.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), along);
  }
}
