// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Who commands, and who else looks, in the header of every page: taken, asked for, handed over. SAFE ALL and what else is essential asks nobody.
import {useState} from 'preact/hooks';
import {name_operator, operator_name} from '../commanding.js';
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {asked, command_is, commander, hand_over, i_ask, keep_command, others, take_command} from '../people.js';
import {authority, operator, slow} from '../store.js';
import {usePopup} from './popup.js';

const answer_left_s = (one) => Math.max(0, one.answer_s - (performance.now() - one.at_ms) / 1000);

const so_many = (count, one, several) => `${count} ${count === 1 ? one : several}`;

function Others() {
  const {pages, observers, count} = others.value;
  const unlisted = count - pages.length - observers;
  return html`<div class="others" data-test="others">${count ? html`<p>Also here:</p><ul>${pages.map((one) => html`<li key=${one.client}><b>${one.name || 'without a name'}</b>
      <small>${[one.seat && one.seat === authority.value.holder?.seat ? 'commands' : 'may command', one.replay ? 'looks at the past' : ''].filter(Boolean).join(', ')}</small></li>`)}
    ${unlisted > 0 ? html`<li>${so_many(unlisted, 'more page', 'more pages')}</li>` : null}
    ${observers ? html`<li>${so_many(observers, 'observer', 'observers')} <small>may look only</small></li>` : null}</ul>` : html`<p>Nobody else has a page open here.</p>`}</div>`;
}

export function Commander() {
  const [open, set_open] = useState(false);
  const node = usePopup(open, set_open);
  slow.value;
  if (!authority.value) return null;
  const is = command_is.value, who = commander.value, wanted = asked.value;
  const words = wanted ? `${wanted.name} asks` : {mine: 'you', other: who, free: 'nobody'}[is];
  return html`<div class="commander" ref=${node}>
    <button class=${`pill ${wanted ? 'asked' : ''} ${is}`} data-test="commander" aria-expanded=${open} title="who commands: one page at a time"
      onClick=${() => set_open(!open)}><span>Command</span><b>${words}</b>${others.value.count ? html`<small class="more" data-test="others-count" title=${`${so_many(others.value.count, 'other page', 'other pages')} open at this station`}>+${others.value.count}</small>` : null}${wanted ? html`<small>${answer_left_s(wanted).toFixed(0)} s</small>` : null}</button>
    ${open || wanted ? html`<div class="popup" role="dialog" aria-label="who commands" data-test="commander-menu">
      <p>${is === 'mine' ? html`You command since ${clock_text(authority.value.holder.since, 0)}.` : is === 'other' ? html`<b>${who}</b> commands since ${clock_text(authority.value.holder.since, 0)}.` : 'Nobody commands. Who sends first, does.'}</p>
      ${wanted ? html`<p><b>${wanted.name}</b> asks for it, and gets it in ${answer_left_s(wanted).toFixed(0)} s if you say nothing.</p>` : null}
      ${operator.value ? html`<label>you are <input aria-label="your name at this station" maxlength="32" placeholder="operator" value=${operator_name.value} onInput=${(event) => name_operator(event.currentTarget.value)} /></label>
        <div class="choice">${is === 'mine' ? html`${wanted ? html`<button class="quiet" data-test="command-keep" onClick=${keep_command}>Keep it</button>` : null}
            <button class=${wanted ? 'primary' : 'quiet'} data-test="command-hand-over" onClick=${() => { set_open(false); hand_over(); }}>${wanted ? `Hand over to ${wanted.name}` : 'Lay it down'}</button>` :
          html`<button class="primary" data-test="command-take" disabled=${i_ask.value} onClick=${() => { if (is === 'free') set_open(false); take_command(); }}>${i_ask.value ? `asked ${who}` : is === 'free' ? 'Take it' : `Ask ${who} for it`}</button>`}</div>
        <p class="about">It is laid down after 15 min without a telecommand, and 30 s after the page is closed. SAFE ALL asks nobody.</p>` : null}<${Others} /></div>` : null}</div>`;
}
