// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The numbers that stand in the robot's picture: angles at their joints, the tip's place, the force at its arrow, what there is to be said of
// a goal. Told five times a second, laid to their points with every picture.
import {Vector3} from 'three';
import {fixed_text} from '../format.js';
import {leads_above, leads_within} from './leads.js';
import {Tags} from './tags.js';

const words_ms = 200;
const most_angles = 3;
export const least_force_n = 0.5;

export class Readout {
  #told_ms = -Infinity;
  #timer;

  /// `view`: {nodes, software, description, camera, size, show, stale, taken, modules, robots}; `again()` is asked for the last words when all is at rest.
  constructor(view, again) {
    Object.assign(this, {view, again, leads: view.software ? leads_within() : leads_above(view.nodes.leads)});
    this.tags = new Tags(view.nodes.tags, this.leads);
  }

  add_robot(robot) {
    const {about} = robot, {tags} = this;
    robot.angle_tags = about.inset ? [] : robot.names.map((name) => tags.add('', `${about.names?.[name] ?? name} `, robot.body.joints[name].jointType === 'prismatic' ? 'm' : 'rad'));
    if (robot.tip) robot.tip_tag = tags.add('', 'tip ', 'mm');
    if (about.goal) robot.goal_tag = tags.add('goal', 'goal ', '');
    if (about.force) robot.force_tag = tags.add('touched', Object.assign(document.createElement('span'), {className: 'unseen', textContent: 'force '}), 'N');
  }

  lay(now_ms) {
    const {view} = this, {size} = view, telling = now_ms - this.#told_ms > words_ms;
    if (telling) this.#told_ms = now_ms;
    for (const robot of view.robots) this.#lay_robot(robot, telling);
    for (const module of view.modules?.list ?? []) module.tag.at = this.#at_px(module.at);
    this.tags.lay(size.x, size.y, view.taken ?? [], telling);
    clearTimeout(this.#timer);
    // The last words are told also when nothing moves any more.
    if (!telling) this.#timer = setTimeout(this.again, words_ms);
  }

  close() { clearTimeout(this.#timer); }

  #lay_robot(robot, telling) {
    const {view, tags} = this, {body} = robot, shown = body.visible, stale = view.stale ?? false;
    robot.angle_tags.forEach((tag, i) => {
      tag.at = this.#at_px(body.joints[robot.names[i]].getWorldPosition(new Vector3()));
      if (telling) tags.tell(tag, fixed_text(robot.last[i], 3), {shown, stale});
    });
    if (robot.tip_tag) {
      robot.tip_tag.at = this.#at_px(robot.tip);
      // A robot that works in a plane says where in it.
      const {x, y, z} = robot.tip, place = view.description.plane_z_m === undefined ? [x, y, z] : [x, y];
      if (telling) tags.tell(robot.tip_tag, place.map((metres) => fixed_text(metres * 1000, 1)).join(', '), {shown, stale});
    }
    if (robot.goal_tag) this.#lay_goal(robot, telling);
    if (robot.force_tag) {
      const pressing = (robot.force_n ?? 0) > least_force_n && view.show.force;
      robot.force_tag.at = pressing && robot.force_end ? this.#at_px(robot.force_end) : null;
      if (telling) tags.tell(robot.force_tag, fixed_text(robot.force_n ?? 0, 1), {shown: pressing && shown, stale});
    }
  }

  #lay_goal(robot, telling) {
    const told = robot.goal_wanted ? robot.goal_told : null;
    robot.goal_tag.at = told?.tip ? this.#at_px(told.tip) : null;
    if (!telling && told) return;
    const angles = told ? Object.values(robot.goal_wanted.angles) : [];
    // More of them would be wider than the picture; the form has them.
    const words = angles.length > most_angles ? `${angles.length} joints` : angles.map((angle) => fixed_text(angle, 3)).join(', ');
    this.tags.tell(robot.goal_tag, words, {shown: Boolean(told), look: told?.wrong ? 'wrong' : 'goal', unit: told ? told.wrong || told.pace : ''});
  }

  #at_px(point) {
    const {camera, size} = this.view, seen = point.clone().project(camera);
    return seen.z > 1 ? null : [(seen.x + 1) / 2 * size.x, (1 - seen.y) / 2 * size.y];
  }
}
