// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useRef, useState} from 'preact/hooks';
import {fault} from '../commanding.js';
import {age_text, number_text} from '../format.js';
import {html} from '../html.js';
import {mission_folder} from '../mission_files.js';
import {target_line} from './hand.js';
import {drawing_code, scene_of_mission} from './scene_file.js';
import {fallen_text, inhibited_text} from '../stop.js';
import {columns, fast, freshness, mission, operator, replay, slow, status_of, values} from '../store.js';

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

function Readout({description}) {
  slow.value;
  const robot = description.robots.find((one) => one.force);
  if (!robot) return null;
  const [fx, fy] = robot.force.map((name) => values.get(name)?.v);
  const stale = freshness(robot.force[0]).stale || freshness(Object.values(robot.joints)[0]).stale;
  const joints = Object.values(robot.joints).map((name) => values.get(name)?.v);
  return html`<div class=${`readout ${stale ? 'stale' : ''}`}>
    ${joints.map((angle, i) => html`<span>q${i + 1} <b>${number_text(angle)}</b> rad</span>`)}
    <span class=${Math.hypot(fx, fy) > 0.5 ? 'touching' : ''}>force <b>${Number.isFinite(fx) ? Math.hypot(fx, fy).toFixed(1) : '–'}</b> N</span>
  </div>`;
}

/// What the picture alone would not say: that it is old, and that nothing there can move.
function Verdict({description}) {
  slow.value;
  const parameter = Object.values(description.robots[0]?.joints ?? {})[0];
  const {age_s, stale} = freshness(parameter);
  const name = columns.value.get(parameter)?.subsystem;
  const inhibited = inhibited_text(status_of(name));
  const why = fallen_text(name) || inhibited;
  const silent = !replay.value && stale && Number.isFinite(age_s);
  if (!why && !silent) return null;
  return html`<div class=${`inhibited ${why ? '' : 'old'}`} data-test="robot-verdict"><b>${silent && !why ? 'OLD DATA' : 'ACTUATORS INHIBITED'}</b>
    <span>${why}${why && silent ? ' · ' : ''}${silent ? `last pose, ${age_text(age_s)} old` : ''}</span></div>`;
}

export function Robot() {
  const node = useRef(null);
  const view = useRef(null);
  const [problem, set_problem] = useState('');
  const [show, set_show] = useState({ghost: true, trail: true, force: true});
  const [gamepad, set_gamepad] = useState(false);
  const description = scene_of_mission.value;
  const hand = description?.hand && mission.value?.devices?.some((one) => one.name === description.hand.device) ? description.hand : null;
  useGamepad(gamepad && !replay.value, hand);

  useEffect(() => {
    if (!description) return;
    let over = false;
    drawing_code().then(async ({RobotView}) => {
      if (over) return;
      view.current = new RobotView(node.current, mission_folder, description);
      await view.current.load();
      if (!over) node.current.dataset.loaded = 'yes';
    }).catch((error) => over || set_problem(`No 3D here: ${error.message}`));
    return () => {
      over = true;
      view.current?.close();
      view.current = null;
    };
  }, [description]);
  useEffect(() => fast.subscribe(() => view.current?.update()), []);
  useEffect(() => replay.subscribe(() => view.current?.forget()), []);
  useEffect(() => {
    if (!view.current) return;
    view.current.show = show;
    view.current.robots.forEach((robot) => { robot.last = {}; });
    view.current.update();
  }, [show]);
  if (view.current) view.current.hand_allowed = Boolean(hand) && operator.value;
  slow.value;

  const toggle = (name) => html`<button class=${`chip ${show[name] ? 'on' : ''}`} aria-pressed=${show[name]}
    onClick=${() => set_show({...show, [name]: !show[name]})}>${name}</button>`;
  const from = description?.camera?.from_m;
  return html`<div class="robot">
    ${description ? html`<div class="tools">
      ${toggle('ghost')}${toggle('trail')}${toggle('force')}
      <span class="space" />
      ${hand && !replay.value ? html`<button class="chip" title="the simulated hand wanders by itself"
          onClick=${() => fault(hand.device, 'hand wander').catch(() => {})}>hand wanders</button>
        <button class=${`chip ${gamepad ? 'on' : ''}`} title="the left stick of a gamepad is the hand"
          onClick=${() => set_gamepad(!gamepad)}>gamepad</button>` : null}
      <button class="chip" onClick=${() => view.current?.view_from(from)}>orbit</button>
      <button class="chip" onClick=${() => view.current?.view_from(description.camera.above_m)}>top</button>
    </div>` : null}
    <div class=${`stage ${description && freshness(Object.values(description.robots[0]?.joints ?? {})[0]).stale ? 'old' : ''}`} ref=${node} data-test="robot">
      ${description === null ? html`<p class="empty">This mission has no 3D model.<br />
        <small>page/scene.json of its folder would be shown here.</small></p>` : null}
      ${problem ? html`<p class="empty">${problem}</p>` : null}
    </div>
    ${description ? html`<${Verdict} description=${description} />` : null}
    ${description ? html`<${Readout} description=${description} />
      <div class="key"><span><i class="solid" />measured</span><span><i class="ghost" />commanded</span>${
        hand && operator.value && !replay.value ? html`<span>drag the blue handle or the fingertip</span>` : null}</div>` : null}
  </div>`;
}
