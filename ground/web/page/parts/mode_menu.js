// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The mode, where it is changed: a click opens the modes and what the supervisor would do for the one that is pointed at (TC[129,4]), a second
// goes.
import {signal} from '@preact/signals';
import {useEffect, useRef, useState} from 'preact/hooks';
import {mode_preview} from '../api.js';
import {bringing, finished, say, send} from '../commanding.js';
import {state_text} from '../format.js';
import {html} from '../html.js';
import {commands, link, mission, mode_of, operator, outcome_of, replay} from '../store.js';
import {fallen} from '../stop_story.js';
import {usePopup} from './popup.js';

const meant_ms = 200;

/// What the supervisor is told to change to: {name, id (of the telecommand), stages, failed}; null when nothing is under way.
export const changing = signal(null);

/// The name of a mode that somebody elsewhere in the page would go to: the menu opens with it.
export const mode_wanted = signal('');

/// What a mode is for, in the words that its descriptor has: who works in it.
function about(mode, now) {
  if (mode.name === now) return 'now';
  if (mode.description) return mode.description;
  const members = (mode.commission ?? []).map((one) => one.subsystem);
  if (!members.length) return 'moves nobody';
  return members.length > 2 ? `${members.length} subsystems` : members.join(', ');
}

function usePreview(mode) {
  const [answer, set_answer] = useState(null);
  useEffect(() => {
    set_answer(null);
    if (!mode) return;
    let over = false;
    mode_preview(mode.name).then((found) => over || set_answer(found), (error) => over || set_answer({problem: error.message}));
    return () => { over = true; };
  }, [mode?.name]);
  return answer;
}

async function go(mode, {steps, stages}) {
  try {
    const name = mission.value.subsystems[0].functions.find((one) => one.name === 'SET_MODE').arguments[0].name;
    const id = await send(mission.value.subsystems[0].name, 'SET_MODE', {[name]: mode.id});
    changing.value = {name: mode.name, id, stages};
    const outcome = await finished(id, Math.max(20, 4 * steps.length));
    changing.value = outcome.stage === 'failed' ? {...changing.value, failed: outcome.reason ?? `code ${outcome.code}`} : null;
    if (outcome.stage !== 'failed' && !steps.length) say(`mode ${mode.name}`, 'good');
  } catch (error) {
    changing.value = {name: mode.name, id: 0, stages, failed: error.message};
  }
}

/// What is under way, by this page's own steps or by SET_MODE, of whose stages its progress reports tell: {name, done, all, text}; null
/// when nothing is.
export function under_way() {
  if (bringing.value) return {...bringing.value, name: bringing.value.mode};
  if (!changing.value || changing.value.failed) return null;
  const told = commands.value.find((one) => one.id === changing.value.id), {name, stages} = changing.value;
  return {name, done: Math.min(stages, (told?.stages ?? []).filter((one) => one.stage === 'progress').length), all: stages, text: ''};
}

function Steps({answer}) {
  if (!answer) return html`<p>asking the supervisor …</p>`;
  if (answer.problem) return html`<p>${answer.problem}</p>`;
  if (!answer.steps.length && !answer.reasons.length) return html`<p>Nobody moves; other telecommands are permitted.</p>`;
  return html`${answer.reasons.length ? html`<p data-test="mode-refused"><b>Not now:</b> ${answer.reasons.join('; ')}</p>` : null}
    <ol data-test="mode-steps">${answer.steps.map((step) => html`<li>${step}</li>`)}</ol>
    ${answer.steps.length ? html`<p>${answer.steps.length} ${answer.steps.length > 1 ? 'steps' : 'step'}. Until it is done their motors give no force.</p>` : null}`;
}

function Menu({on_close}) {
  const modes = mission.value?.modes ?? [];
  const [chosen, set_chosen] = useState(modes.find((one) => one.name === mode_wanted.value) ?? modes.find((one) => one.name !== mode_of.value.name && one.commission?.length) ?? modes[0]);
  const answer = usePreview(chosen);
  // What a mouse only passes on its way to "Go" is not meant.
  const pointed = useRef(0);
  const leave = () => clearTimeout(pointed.current);
  useEffect(() => leave, []);
  const point_at = (mode) => ({pointerType}) => {
    leave();
    if (pointerType === 'mouse') pointed.current = setTimeout(() => set_chosen(mode), meant_ms);
  };
  const refused = !answer || answer.problem || answer.reasons.length > 0;
  return html`<div class="menu" role="dialog" aria-label="change the mode" data-test="mode-menu">
    <div class="list">${modes.map((mode) => html`<button key=${mode.name} class=${mode === chosen ? 'on' : ''} aria-pressed=${mode === chosen}
      data-test=${`mode-${mode.name}`} onClick=${() => set_chosen(mode)} onPointerEnter=${point_at(mode)} onPointerLeave=${leave}><b>${mode.name}</b><span>${about(mode, mode_of.value.name)}</span></button>`)}</div>
    <div class="what"><h3>${mode_of.value.name} → ${chosen?.name}</h3><${Steps} answer=${answer} />
      <div class="choice"><button class="quiet" onClick=${on_close}>Cancel</button>
        ${operator.value ? html`<button class="primary" data-test="mode-go" disabled=${refused || !operator.value || replay.value !== null || link.value.state !== 'up'}
          onClick=${() => { on_close(); go(chosen, answer); }}>Go ${chosen?.name}</button>` : null}</div></div></div>`;
}

/// The mode, and whether it is true: what its members have fallen from is that mode no more.
export function Mode() {
  const [opened, set_opened] = useState(false);
  const open = opened || mode_wanted.value !== '';
  const set_open = (value) => {
    set_opened(value);
    if (!value) mode_wanted.value = '';
  };
  const node = usePopup(open, set_open);
  const down = fallen.value, refused = changing.value?.failed, on_its_way = under_way();
  const words = down.map((one) => `${one.subsystem} is ${state_text(one.state)}`).join(', ');
  return html`<div class="mode_pill" ref=${node}>
    <button class=${`pill mode ${down.length && !refused && !on_its_way ? 'bad' : ''}`} data-test="mode" aria-expanded=${open} title=${refused ?? (words || 'every member is where this mode has it')}
      onClick=${() => { if (refused) changing.value = null; set_open(!open); }}><span>Mode</span><b>${mode_of.value.name}</b>${
      refused ? html`<em data-test="mode-failed">${changing.value.name} refused</em>` :
        on_its_way ? html`<span data-test="mode-progress">→ ${on_its_way.name} ${on_its_way.all ? `${on_its_way.done} of ${on_its_way.all}` : ''}</span>` :
          down.length ? html`<em data-test="mode-stopped">stopped</em>` : null}
      <svg viewBox="0 0 10 6" aria-hidden="true"><path d="M1 1l4 4 4-4" fill="none" stroke="currentColor" stroke-width="1.6" /></svg></button>
    ${open ? html`<${Menu} key=${mode_wanted.value} on_close=${() => set_open(false)} />` : null}</div>`;
}
