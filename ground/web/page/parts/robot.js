// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useRef, useState} from 'preact/hooks';
import {fault} from '../commanding.js';
import {age_text, fixed_text} from '../format.js';
import {html} from '../html.js';
import {target_line} from './hand.js';
import {usual_description} from '../scene/usual.js';
import {goal_where_it_stands} from './goal_form.js';
import {open} from './opening.js';
import {drawing_code, opens_with_robot, scene_of_mission} from './scene_file.js';
import {typed} from './typed.js';
import {fallen, fallen_text, inhibited_text} from '../stop_story.js';
import {columns, commands, fast, freshness, mission, operator, outcome_of, replay, slow, status_of, values} from '../store.js';

const gamepad_period_ms = 60;
const dead_zone = 0.08;

/// A gamepad's left stick is the hand while the switch is on.
function useGamepad(on, hand) {
  useEffect(() => {
    if (!on || !hand) return;
    let last = '';
    const timer = setInterval(() => {
      const pad = [...navigator.getGamepads()].find(Boolean);
      if (!pad) return;
      const [x, y] = pad.axes.map((axis) => Math.abs(axis) < dead_zone ? 0 : axis * hand.handle_range_rad);
      const stick = `${x.toFixed(3)} ${y.toFixed(3)}`;
      if (stick === last) return;
      last = stick;
      fault(hand.device, target_line([x, -y]), {quiet: true}).catch(() => {});
    }, gamepad_period_ms);
    return () => clearInterval(timer);
  }, [on, hand]);
}

/// The operator's hand, in a picture of its own: it is on the ground, or beside the cabin, not next to the arm.
function Hand({description, window_ref}) {
  slow.value;
  const robot = description.robots.find((one) => one.inset);
  const down = fallen.value.some((one) => one.subsystem === robot?.subsystem);
  // Its own, not that of whom it was stopped with.
  const lost = down && fallen_text(robot.subsystem).includes(`: ${robot.subsystem} lost its device`);
  const known = (robot?.torque ?? []).filter((name) => values.has(name)), felt = Math.hypot(...known.map((name) => values.get(name).v));
  const first = robot && Object.values(robot.joints)[0];
  return html`<div class=${`hand ${down ? 'bad' : ''}`}><h3>${description.inset.title}</h3><div class="window" ref=${window_ref} />
    <p>${down ? html`<b>${lost ? 'Device lost' : 'Stopped'}</b><span>${age_text(freshness(first).age_s)} ago</span>` : html`felt<span><b>${known.length ? fixed_text(felt, 3) : '–'}</b> N·m</span>`}</p></div>`;
}

/// What the picture alone would not say: that it is old, and that nothing there can move.
function Verdict({description}) {
  slow.value;
  const parameter = Object.values(description.robots[0]?.joints ?? {})[0];
  if (!parameter) return null;
  const {age_s, stale} = freshness(parameter);
  const name = columns.value.get(parameter)?.subsystem;
  const inhibited = inhibited_text(status_of(name));
  const why = fallen_text(name) || inhibited;
  const silent = !replay.value && stale && Number.isFinite(age_s);
  if (!why && !silent) return null;
  return html`<div class=${`inhibited ${why ? '' : 'old'}`} data-test="robot-verdict"><b>${silent && !why ? 'OLD DATA' : 'ACTUATORS INHIBITED'}</b>
    <span>${why ? html`<span class="why">${why}${silent ? ' · ' : ''}</span>` : null}${silent ? `last pose, ${age_text(age_s)} old` : ''}</span></div>`;
}

const feels = (description) => description.robots.some((one) => one.force);
const toggles = [['goal', 'Goal'], ['limits', 'Limits'], ['force', 'Force'], ['trail', 'Trail'], ['frames', 'Frames']];

function node(name, words, space = 'http://www.w3.org/1999/xhtml') {
  const made = document.createElementNS(space, name);
  for (const [word, value] of Object.entries(words)) made.setAttribute(word, value);
  return made;
}

/// The picture of a description, with what it is drawn in: made once, for it takes a second without a graphics card, and moved from view to view.
let kept = null;
function picture_of(description) {
  if (kept?.description === description) return kept;
  kept?.view?.close();
  const nodes = {still: node('canvas', {class: 'still', 'aria-hidden': 'true'}), stage: node('div', {class: 'stage', 'data-test': 'robot'}), shade: node('div', {class: 'shade'}),
    leads: node('svg', {class: 'leads', 'aria-hidden': 'true'}, 'http://www.w3.org/2000/svg'), tags: node('div', {class: 'readout'}), cube: node('svg', {class: 'cube', 'data-test': 'view-cube'}, 'http://www.w3.org/2000/svg')};
  const picture = kept = {description, nodes, view: null, ready: null, entered: null, leave: null};
  picture.ready = drawing_code().then(async ({RobotView}) => {
    picture.view = new RobotView(nodes, description);
    picture.entered?.();
    await picture.view.load();
    nodes.stage.dataset.loaded = 'yes';
  }).catch((error) => {
    open();
    picture.view?.close();
    if (kept === picture) kept = null;
    throw error;
  });
  return picture;
}

// A page that opens with the robot in it makes its picture while the rest of the page is made.
if (opens_with_robot) scene_of_mission.subscribe((description) => { if (description) picture_of(description).ready.catch(() => {}); });

export function Robot() {
  const home = useRef(null), stage = useRef(null), window_ref = useRef(null);
  const view = useRef(null);
  const [problem, set_problem] = useState('');
  const [show, set_show] = useState({goal: true, limits: true, force: true, trail: true, frames: false});
  const [gamepad, set_gamepad] = useState(false);
  const [loaded, set_loaded] = useState(false);
  const description = scene_of_mission.value === null ? usual_description : scene_of_mission.value;
  const hand = description?.hand && mission.value?.devices?.some((one) => one.name === description.hand.device) ? description.hand : null;
  useGamepad(gamepad && !replay.value, hand);

  useEffect(() => {
    if (!description) return;
    let over = false;
    const picture = picture_of(description), {nodes} = picture;
    // A view of before may be told that it is over only after this one has begun.
    picture.leave?.();
    home.current.append(nodes.still, nodes.stage, nodes.shade, nodes.leads, nodes.tags, nodes.cube);
    stage.current = nodes.stage;
    picture.entered = () => {
      view.current = picture.view;
      picture.view.enter(window_ref.current);
    };
    if (picture.view) picture.entered();
    picture.ready.then(() => over || set_loaded(true), (error) => over || set_problem(`No 3D here: ${error.message}`));
    const leave = () => {
      over = true;
      view.current = null;
      if (picture.leave !== leave) return;
      picture.leave = picture.entered = null;
      picture.view?.leave();
      home.current?.replaceChildren();
    };
    return picture.leave = leave;
  }, [description]);
  useEffect(() => fast.subscribe(() => view.current?.update()), []);
  useEffect(() => replay.subscribe(() => view.current?.forget()), []);
  useEffect(() => typed.subscribe(() => view.current?.draw_soon()), []);
  useEffect(() => commands.subscribe(() => view.current?.draw_soon()), []);
  const stopped = (description?.robots ?? []).map((one) => one.subsystem).filter((name) => fallen.value.some((one) => one.subsystem === name) || status_of(name)?.inhibited?.length);
  const {age_s, stale} = freshness(Object.values(description?.robots[0]?.joints ?? {})[0]), old = Boolean(description?.robots.length) && stale;
  useEffect(() => {
    if (!view.current) return;
    view.current.show = show;
    view.current.stale = old;
    view.current.look_again(stopped);
  }, [show, old, stopped.join(), loaded]);
  slow.value;
  if (description?.modules) view.current?.modules?.look();
  if (view.current) {
    view.current.hand_allowed = Boolean(hand) && operator.value;
    view.current.goal_allowed = operator.value;
  }
  const from = description?.camera, movable = description?.robots.find((one) => one.goal);
  const goal_typed = Boolean(typed.value?.numbers) && description?.robots.some((one) => one.goal?.function === typed.value.action && one.subsystem === typed.value.subsystem);
  const goal_sent = commands.value.some((one) => description?.robots.some((robot) => robot.goal?.function === one.function && robot.subsystem === one.subsystem) && !['completed', 'failed'].includes(outcome_of(one).stage));
  return html`<div class=${`robot ${old && age_s < Infinity && !stopped.length ? 'old' : ''}`}>
    <div class="home" ref=${home} />
    ${description ? html`<div class="tools">
      ${description.robots.length ? toggles.filter(([name]) => name !== 'force' || feels(description)).map(([name, title]) => html`<button class=${`chip ${show[name] ? 'on' : ''}`} aria-pressed=${show[name]} onClick=${() => set_show({...show, [name]: !show[name]})}>${title}</button>`) : null}
      <span class="space" />
      ${movable && operator.value && !replay.value && typed.value ? html`<button class="chip" data-test="set-goal" title=${`a goal where it stands, to be dragged: by its tip, or a link by itself; it fills the form of ${movable.goal.function}`} disabled=${old}
        onClick=${() => goal_where_it_stands(movable)}>Set goal</button>` : null}
      ${hand && operator.value && !replay.value ? html`<button class="chip" title="the simulated hand wanders by itself" onClick=${() => fault(hand.device, 'hand wander').catch(() => {})}>Hand wanders</button>
        <button class=${`chip ${gamepad ? 'on' : ''}`} title="the left stick of a gamepad is the hand" aria-pressed=${gamepad} onClick=${() => set_gamepad(!gamepad)}>Gamepad</button>` : null}
      <button class="chip" title="as at first" onClick=${() => view.current?.view_from(from.from_m)}>Scene</button>
      <button class="chip" title="from above" onClick=${() => view.current?.view_from(from.above_m)}>Top</button>
      ${from?.tip_from_m ? html`<button class="chip" title="the tip from near" onClick=${() => view.current?.view_tip()}>Tip</button>` : null}
      <button class="chip" title="the scene alone, as a PNG file" data-test="scene-picture" disabled=${!loaded} onClick=${() => view.current?.save_picture()}>PNG</button>
    </div>` : null}
    ${problem ? html`<p class="empty">${problem}</p>` : null}
    ${description?.inset ? html`<${Hand} description=${description} window_ref=${window_ref} />` : null}
    ${description ? html`<${Verdict} description=${description} />
      <div class="key">${stopped.length ? html`<span><i />last known pose</span><span><i class="fallen" />inhibited</span>` : html`${description.robots.length ? html`<span><i />measured</span>` : html`<span><i />Operational</span><span><i class="fallen" />inhibited or failed</span>`}${
        goal_typed || goal_sent ? html`<span><i class="goal" />${goal_sent ? 'goal, sent' : typed.value?.refused ? 'goal, refused' : 'goal, not sent'}</span>` : null}${feels(description) ? html`<span><i class="touched" />touched</span>` : null}${
        description.inset ? html`<span><i class="felt" />felt</span>` : null}`}${hand && operator.value && !replay.value && !stopped.length ? html`<span class="hint">${goal_typed && !goal_sent ? 'drag the goal by its ball or a link' : 'drag the handle or the fingertip'}</span>` : null}</div>` : null}
  </div>`;
}
