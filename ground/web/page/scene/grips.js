// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a mouse takes hold of in the robot's picture: a goal that is not sent (goal_drag.js), or the operator's hand, by the handle or by the
// fingertip. What counts of the hand is how far it went since the grab, wherever on the part that was.
import {Box3, BufferAttribute, BufferGeometry, Line, LineBasicMaterial, Plane, Raycaster, Vector2, Vector3} from 'three';
import {fault} from '../commanding.js';
import {GoalDrag} from './goal_drag.js';
import {before_wall, target_line, within_range} from '../parts/hand.js';

const hand_period_ms = 60;
const lever_m = 0.109;
const band_from_m = 0.006;
const named = (names, list) => Object.fromEntries(names.map((name, i) => [name, list[i]]));

export class Grips {
  /// `view`: {canvas, controls, robots, description, may(), eye_at(event), draw_soon(), frames, values, scene_of(robot)}
  constructor(view) {
    this.view = view;
    this.ray = new Raycaster();
    this.goals = new GoalDrag(view);
    this.band = new Line(new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3)), new LineBasicMaterial({color: 0xb9a2ff, depthTest: false, toneMapped: false}));
    this.band.frustumCulled = false;
    this.band.visible = false;
    this.band.renderOrder = 10;
    this.#listen();
  }

  #listen() {
    const {canvas, controls} = this.view;
    canvas.addEventListener('pointerdown', (event) => {
      const grip = this.#grip_at(event);
      if (!grip) return;
      event.stopImmediatePropagation();
      this.dragging = grip;
      if (!grip.goal) this.view.scene_of(grip.robot).add(this.band);
      controls.enabled = false;
      canvas.style.cursor = 'grabbing';
      canvas.setPointerCapture(event.pointerId);
    }, {capture: true});
    canvas.addEventListener('pointermove', (event) => {
      if (this.dragging) this.#drag(event);
      else canvas.style.cursor = event.buttons === 0 && this.#grip_at(event) ? 'grab' : '';
    });
    const end = () => {
      if (!this.dragging) return;
      const {goal} = this.dragging;
      this.dragging = null;
      this.band.visible = false;
      canvas.style.cursor = '';
      controls.enabled = true;
      if (!goal) this.#lead([0, 0], true);
      this.view.draw_soon();
    };
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
  }

  #aim(event, inset) {
    const [x, y, camera] = this.view.eye_at(event, inset);
    this.ray.setFromCamera(new Vector2(x, y), camera);
    return [x, y];
  }

  /// What is under the pointer and can be led: where it was touched, in its own and in the world's frame, and how the handle stood.
  #grip_at(event) {
    const {description, robots, frames} = this.view, inset = this.view.is_in_inset(event), pointer = this.#aim(event, inset);
    const goal = inset ? null : this.goals.grip_at(this.ray, pointer);
    if (goal || !description.hand || !this.view.may()) return goal;
    for (const robot of robots) {
      const what = robot.about.handle ? 'handle' : robot.about.tip ? 'tip' : null;
      if (!what || Boolean(robot.about.inset) !== inset || !robot.body.visible) continue;
      const link = robot.body.links[robot.about[what]];
      // Once for each picture, not for each move of a mouse.
      if (robot.grip_of !== frames) {
        robot.grip_of = frames;
        robot.grip = what === 'tip' ? new Box3().setFromCenterAndSize(robot.tip, new Vector3(0.045, 0.045, 0.045)) : new Box3().setFromObject(link).expandByScalar(0.004);
      }
      const touched = this.ray.ray.intersectBox(robot.grip, new Vector3());
      if (!touched) continue;
      return {what, robot, link, inset, held: link.worldToLocal(touched.clone()), from: touched, angles: this.#handle_angles()};
    }
    return null;
  }

  #drag(event) {
    const {what, robot, from, angles, inset = false} = this.dragging;
    this.#aim(event, inset);
    if (this.dragging.goal) return this.goals.drag(this.dragging, this.ray);
    const at = new Vector3();
    if (!this.ray.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -from.z), at)) return;
    const {hand, contour} = this.view.description;
    this.dragging.at = at;
    let turned;
    if (what === 'tip') {
      turned = this.#turned_to(this.dragging, at, contour);
    } else {
      const pivot = robot.body.position;
      const angle = (x) => Math.atan2(x, lever_m);
      turned = [angle(at.x - pivot.x) - angle(from.x - pivot.x), angle(at.y - pivot.y) - angle(from.y - pivot.y)];
    }
    this.#lead(within_range(hand, [angles[0] + turned[0], angles[1] + turned[1]]));
    this.view.draw_soon();
  }

  /// How far the joints must turn for the tip to go as the pointer did, by the robot's own lengths: each axis of the handle turns one of them.
  #turned_to(grip, at, contour) {
    const {robot, from} = grip, {names, reckoning} = robot;
    grip.start ??= {tip: robot.tip.clone(), angles: named(names, robot.last)};
    const {tip, angles} = grip.start, [x, y] = before_wall(contour, [tip.x + at.x - from.x, tip.y + at.y - from.y]);
    grip.reached = reckoning.reached({link: reckoning.tip_link, local: new Vector3()}, new Vector3(x, y, tip.z), grip.reached ?? angles, robot);
    return names.map((name) => grip.reached[name] - angles[name]);
  }

  /// The band from what is held to the pointer: the hand goes slower than a mouse, and gives way at the rail.
  stretch() {
    if (!this.dragging?.at || this.dragging.goal) return;
    const {link, held, at} = this.dragging;
    const from = link.localToWorld(held.clone());
    this.band.visible = from.distanceTo(at) > band_from_m;
    const {position} = this.band.geometry.attributes;
    position.setXYZ(0, from.x, from.y, from.z);
    position.setXYZ(1, at.x, at.y, at.z);
    position.needsUpdate = true;
  }

  /// At most one line in 60 ms, the last one always.
  #lead(angles, now = false) {
    this.wanted = angles;
    const send = () => {
      this.timer = 0;
      if (!this.wanted) return;
      fault(this.view.description.hand.device, target_line(this.wanted), {quiet: true}).catch(() => {});
      this.wanted = null;
    };
    if (now) {
      clearTimeout(this.timer);
      return send();
    }
    this.timer ||= setTimeout(send, hand_period_ms);
  }

  /// How the handle stands, as measured.
  #handle_angles() {
    const handle = this.view.robots.find((robot) => robot.about.handle);
    return Object.values(handle?.about.joints ?? {x: '', y: ''}).map((name) => this.view.values.get(name)?.v ?? 0);
  }
}
