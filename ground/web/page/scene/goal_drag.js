// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The ghost of a goal that is not sent, led by the mouse: by the ball at its tip, which all joints follow, or by a link, which turns with its
// own joint alone. What comes of it stands in the form, whose ranges say what cannot be.
import {Plane, Vector3} from 'three';
import {fill_goal} from '../parts/goal_form.js';

/// A finger's width about the ball.
const ball_px = 16;

export class GoalDrag {
  /// `view`: {robots, camera, size, description, may_set_goal(), draw_soon()}
  constructor(view) { this.view = view; }

  /// What of a goal is under the ray that `pointer` ([x, y] from -1 to 1) sends out, or null.
  grip_at(ray, [x, y]) {
    if (!this.view.may_set_goal?.()) return null;
    for (const robot of this.view.robots) {
      const goal = robot.goal_wanted && !robot.goal_wanted.sent ? robot.goal : null;
      if (!goal?.group.visible || !goal.tip) continue;
      const seen = goal.tip.clone().project(this.view.camera), {size} = this.view;
      if (Math.hypot((seen.x - x) * size.x, (seen.y - y) * size.y) / 2 < ball_px) return this.#held(robot, goal.phantom.tip_link, goal.tip.clone(), robot.names);
      const [hit] = ray.intersectObject(goal.phantom.body, true);
      const link = hit && above(hit.object, (node) => node.isURDFLink);
      const joint = link && above(link, (node) => node.isURDFJoint && robot.names.includes(node.urdfName || node.name));
      if (joint) return this.#held(robot, link, hit.point, [joint.urdfName || joint.name]);
    }
    return null;
  }

  #held(robot, link, from, names) {
    const {plane_z_m} = this.view.description;
    // A robot that works in a plane stays in it; others are led in the plane that faces the eye.
    const normal = plane_z_m === undefined ? this.view.camera.getWorldDirection(new Vector3()) : new Vector3(0, 0, 1);
    robot.goal.phantom.stand(robot.goal_wanted.angles);
    return {goal: true, robot, link, local: link.worldToLocal(from.clone()), plane: new Plane().setFromNormalAndCoplanarPoint(normal, from), names, angles: {...robot.goal_wanted.angles}};
  }

  drag(grip, ray) {
    const at = ray.ray.intersectPlane(grip.plane, new Vector3());
    if (!at) return;
    grip.at = at;
    // Once for each picture, not for each move of a mouse.
    grip.waiting ||= requestAnimationFrame(() => {
      grip.waiting = 0;
      this.#reach(grip);
    });
  }

  #reach(grip) {
    const {robot, names, at} = grip;
    grip.angles = robot.goal.phantom.reached(grip, at, grip.angles, robot, names);
    fill_goal(robot.about, grip.angles);
    this.view.draw_soon();
  }
}

function above(node, is_it) {
  for (let one = node; one; one = one.parent) if (is_it(one)) return one;
  return null;
}
