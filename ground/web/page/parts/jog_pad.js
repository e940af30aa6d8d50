// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Buttons that push a tool along and about the axes of its base: each push is one telecommand, and while a button is held the next follows
// in the middle of the one before, which it renews. Who lets go sends no other, nor does a page that is lost; the arm brakes by itself.
import {useEffect, useRef, useState} from 'preact/hooks';
import {finished, say, send} from '../commanding.js';
import {html} from '../html.js';
import {may_send} from '../people.js';
import {operator, replay} from '../store.js';
import {axes, paces, push_of, renewed_after_ms} from './jog_steps.js';

const pace_words = (pace) => `${pace.m_s * 1000} mm/s, ${pace.rad_s} rad/s for ${pace.s} s`;

export function JogPad({subsystem, action, jog}) {
  const [pace, set_pace] = useState(paces[0]);
  const [pushing, set_pushing] = useState(null);
  const held = useRef(null);
  useEffect(() => () => { held.current = null; }, []);
  if (!operator.value) return null;
  const locked = Boolean(replay.value) || !may_send(action);
  const push = async (way) => {
    // One after the other: what is under way is done first.
    if (held.current?.busy || locked) return;
    const mine = held.current = {busy: true, down: true};
    set_pushing(way);
    // Whichever of them fails, no other follows, and it is said once.
    const fail = (words) => {
      if (!mine.failed) say(`${subsystem} ${action.name}: ${words}`, 'bad');
      mine.failed = true;
      mine.down = false;
    };
    const judge = (outcome) => { if (outcome.stage === 'failed') fail(outcome.reason ?? `code ${outcome.code}`); };
    try {
      let last;
      do {
        last = finished(await send(subsystem, action.name, push_of(jog, way, pace))).then(judge);
        await Promise.race([last, new Promise((resolve) => setTimeout(resolve, renewed_after_ms(pace)))]);
      } while (mine.down && held.current === mine);
      await last;
    } catch (error) {
      fail(error.message);
    }
    mine.busy = false;
    set_pushing(null);
  };
  const release = () => { if (held.current) held.current.down = false; };
  const button = (turning, axis, side) => {
    const name = `${turning ? 'about' : 'along'} ${axes[axis]} ${side > 0 ? '+' : '−'}`;
    return html`<button type="button" class=${`chip ${pushing && pushing.turning === turning && pushing.axis === axis && pushing.side === side ? 'on' : ''}`} disabled=${locked} title=${`the tool ${name}, ${pace_words(pace)}`}
      data-test=${`jog-${turning ? 'turn' : 'move'}-${axes[axis]}${side > 0 ? '+' : '-'}`} onPointerDown=${(event) => { if (event.button === 0) push({turning, axis, side}); }} onPointerUp=${release} onPointerLeave=${release} onPointerCancel=${release}
      onKeyDown=${(event) => { if ([' ', 'Enter'].includes(event.key)) { event.preventDefault(); if (!event.repeat) push({turning, axis, side}); } }} onKeyUp=${release}
      onClick=${(event) => { if (event.detail === 0) { push({turning, axis, side}); release(); } }}>${axes[axis]} ${side > 0 ? '+' : '−'}</button>`;
  };
  const row = (turning, words) => html`<span>${words}</span>${axes.map((_, axis) => html`${button(turning, axis, -1)}${button(turning, axis, 1)}`)}`;
  return html`<div class="jog" role="group" aria-label="push the tool" data-test="jog">
    <div class="pads">${row(false, 'move')}${row(true, 'turn')}</div>
    <div class="paces">${paces.map((one) => html`<button type="button" class=${`chip ${one === pace ? 'on' : ''}`} aria-pressed=${one === pace} title=${pace_words(one)} onClick=${() => set_pace(one)}>${one.name}</button>`)}
      <small>${pace_words(pace)}</small></div></div>`;
}
