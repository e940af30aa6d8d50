// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {html} from '../html.js';
import {Severity} from '../parts/icons.js';
import {Panel} from '../parts/panel.js';
import {tour_steps, tour_to} from '../tour.js';

const keys = [
  ['/', 'search in this view'], ['c', 'telecommands'], ['Space', 'pause and follow the plots'], ['g o', 'overview'],
  ['g s', 'subsystems'], ['g p', 'plots'], ['g l', 'real-time links'], ['g e', 'events'], ['g t', 'timeline'], ['f', 'faults'],
  ['l', 'back to live from a replay'], ['Esc', 'close what is open'], ['?', 'this page'],
];

export const Help = () => html`<main class="help">
  <${Panel} title="Tour" hint="a quarter of an hour at most"><ol class="tour_list">${tour_steps.value.map((step, i) => html`<li><b>${step.title}</b><p>${step.text}</p>
    <button class="chip" onClick=${() => tour_to(i)}>${i === 0 ? 'start here' : 'from here'}</button></li>`)}</ol></${Panel}>
  <${Panel} title="Keys"><dl class="keys">${keys.map(([key, what]) => html`<dt>${key.split(' ').map((one) => html`<kbd>${one}</kbd>`)}</dt><dd>${what}</dd>`)}</dl></${Panel}>
  <${Panel} title="What the signs mean"><dl class="signs">
    <dt><${Severity} severity="high" word /></dt><dd>the network of whoever reported it is shut down</dd>
    <dt><${Severity} severity="medium" word /></dt><dd>it goes to Safe-Operational</dd>
    <dt><${Severity} severity="low" word /></dt><dd>noted; something was not as it should be</dd>
    <dt><${Severity} severity="info" word /></dt><dd>noted</dd>
    <dt class="stale">grey</dt><dd>older than three of its periods: the last thing known, not the present</dd>
    <dt class="amber_text">amber frame</dt><dd>a replay from the archive; telecommands are locked</dd>
    <dt><b>SAFE ALL</b></dt><dd>held for 0.8 s, inhibits the actuators of every subsystem, in every mode</dd></dl>
    <p class="about">Times are on-board times. Every view has its own address: send it to a colleague on the same tunnel.</p>
    <p class="about">The page asks no other host for anything. Licences of what is in it: <a href="notices.txt">notices.txt</a>.</p></${Panel}>
</main>`;
