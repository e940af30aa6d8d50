// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where a motion that is typed, or sent and not ended, would lead: the robot's ghost at its goal, the path of its tip, red where it cannot be.
import {Group, Mesh, MeshBasicMaterial, SphereGeometry} from 'three';
import {fixed_text} from '../format.js';
import {commands, outcome_of} from '../store.js';
import {surface_x_m} from '../parts/hand.js';
import {led_value} from '../parts/numbers.js';
import {colours, GoalPath} from './instruments.js';
import {Phantom} from './robot_model.js';
import {ghost_skin, make_ghost} from './skins.js';
import {goal_says, typed} from '../parts/typed.js';

const points = 48;
/// The smooth path of on-board motions: a polynomial of the fifth degree.
const smooth = (s) => s * s * s * (10 - 15 * s + 6 * s * s);
const most_smooth_rate = 1.875;
/// What is nearer is where the robot stands already.
const there_s = 0.02;

/// The goal that is to be shown: {angles: {joint: angle}, duration_s, speed, by_speed, sent}; null when none is. Where a speed is said, a share of
/// what each joint may, nobody has said how long it takes: `by_speed`.
function goal_of(about, typed, commands) {
  if (!about.goal) return null;
  const read = (values, sent) => {
    const angles = Object.fromEntries(Object.entries(about.goal.joints).map(([joint, argument]) => [joint, led_value(values, argument)]));
    if (!Object.values(angles).every(Number.isFinite)) return null;
    const speed = Number(values[about.goal.speed]);
    return {angles, duration_s: Number(values[about.goal.duration]) || 3, speed: speed > 0 ? speed : null, by_speed: Boolean(about.goal.speed), sent};
  };
  const under_way = commands.find((one) => one.subsystem === about.subsystem && one.function === about.goal.function && !['completed', 'failed'].includes(outcome_of(one).stage));
  if (under_way) return read(under_way.arguments, true);
  // Also what cannot be is shown, in red: the form says why.
  // What was sent so and done is no goal any more: `numbers` are null then.
  if (typed?.subsystem !== about.subsystem || typed.action !== about.goal.function || !typed.numbers) return null;
  return read(typed.numbers, false);
}

export class Goal {
  may_be_led = false;

  constructor(robot, text, parts, {scale, contour, wrong_at}) {
    this.robot = robot;
    this.phantom = new Phantom(robot.about, text, parts);
    this.skin = ghost_skin(colours.goal);
    make_ghost(this.phantom.body, this.skin);
    this.path = new GoalPath(scale);
    this.ball = new Mesh(new SphereGeometry(0.011 * scale, 20, 14), new MeshBasicMaterial({color: colours.goal, toneMapped: false, depthTest: false, transparent: true, opacity: 0.9}));
    this.ball.renderOrder = 11;
    this.tip = null;
    this.group = new Group();
    this.group.add(this.phantom.body, this.path.group, this.ball);
    this.group.visible = false;
    this.contour = contour;
    this.wrong_at = wrong_at;
    this.told = '';
  }

  /// How long it takes at least, and the speed of the fastest joint: {duration_s, words}.
  #pace(goal, from) {
    const ways = this.robot.names.map((name) => Math.abs((goal.angles[name] ?? from[name]) - from[name]));
    if (goal.by_speed && !goal.speed) return {duration_s: 3, words: ''};
    if (!goal.by_speed) return {duration_s: goal.duration_s, words: `in ${fixed_text(goal.duration_s, 1)} s, ${fixed_text(Math.max(...ways) * most_smooth_rate / goal.duration_s, 2)} rad/s`};
    const longest_s = Math.max(...ways.map((way, i) => way / (goal.speed * (this.robot.velocities[i] || 1))));
    if (longest_s < there_s) return {duration_s: 0.1, words: 'reached'};
    return {duration_s: Math.max(longest_s, 0.1), words: `at ${fixed_text(100 * goal.speed, 0)} %, at least ${fixed_text(longest_s, 1)} s`};
  }

  /// Shows `goal`, {angles, duration_s, speed, by_speed, sent}, from where the robot stands; what there is to be said of it: {wrong, pace, tip}.
  show(goal, camera) {
    this.group.visible = Boolean(goal);
    if (!goal) return null;
    const from = Object.fromEntries(this.robot.names.map((name, i) => [name, this.robot.last[i] ?? 0]));
    const path = [];
    let wrong = '';
    for (let i = 0; i <= points; ++i) {
      const part = smooth(i / points);
      const angles = Object.fromEntries(this.robot.names.map((name) => [name, from[name] + part * ((goal.angles[name] ?? from[name]) - from[name])]));
      const at = this.phantom.stand(angles), why = this.#wrong(angles, at);
      wrong ||= why;
      if (at) path.push({at, wrong: Boolean(why)});
    }
    this.skin.uniforms.colour.value.set(wrong ? colours.wrong : colours.goal);
    this.path.group.visible = path.length > 0;
    const {duration_s, words} = this.#pace(goal, from);
    this.path.lay(path, duration_s, camera);
    this.tip = path.at(-1)?.at ?? null;
    // The ball is what the mouse takes; what is sent is not led any more.
    this.ball.visible = Boolean(this.tip) && !goal.sent && this.may_be_led;
    if (this.ball.visible) this.ball.position.copy(this.tip);
    this.ball.material.color.set(wrong ? colours.wrong : colours.goal);
    return {wrong, pace: words, tip: this.tip};
  }

  #wrong(angles, tip) {
    for (const [name, angle] of Object.entries(angles)) {
      const {lower, upper} = this.robot.body.joints[name].limit;
      if (upper > lower && (angle < lower - 1e-9 || angle > upper + 1e-9)) return `${this.robot.about.names?.[name] ?? name} beyond its limit`;
    }
    if (!tip) return '';
    if (this.contour && tip.y > this.contour.from_y_m && tip.y < this.contour.to_y_m && tip.x > surface_x_m(this.contour, tip.y) - this.contour.finger_radius_m + 1e-3) return 'meets the rail';
    return this.wrong_at?.(tip) ?? '';
  }
}

/// The goal of a robot as it is typed or sent now, in the scene of `view`; what is wrong with it is told to its form.
export function show_goal(robot, view) {
  const wanted = view.show.goal ? goal_of(robot.about, typed.value, commands.value) : null;
  if (!wanted && !robot.goal) return;
  if (!robot.goal) {
    robot.goal = robot.make_goal();
    view.scene.add(robot.goal.group);
  }
  robot.goal.may_be_led = view.may_set_goal();
  robot.goal_told = robot.goal.show(wanted, view.camera);
  robot.goal_wanted = wanted;
  const wrong = wanted && !wanted.sent ? robot.goal_told?.wrong ?? '' : '';
  const {subsystem, goal} = robot.about, before = goal_says.peek();
  if (before?.subsystem !== subsystem || before.action !== goal.function || before.wrong !== wrong) goal_says.value = {subsystem, action: goal.function, wrong};
}
