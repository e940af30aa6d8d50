// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Faults of simulated devices as buttons: what the paper does with a screwdriver.
import {useState} from 'preact/hooks';
import {fault} from '../commanding.js';
import {html} from '../html.js';
import {mission, operator, replay} from '../store.js';

function Device({device}) {
  const [line, set_line] = useState('');
  const [answer, set_answer] = useState('');
  const inject = (words) => fault(device.name, words).then((text) => set_answer(`${words}: ${text ?? 'done'}`),
    (error) => set_answer(`${words}: ${error.message}`));
  const locked = Boolean(replay.value) || !operator.value;
  return html`<section><h3>${device.name} <small>${device.subsystem}</small></h3>
    <div class="fault_buttons">${(device.faults ?? []).map((one) => html`<button class="fault" disabled=${locked} title=${one.line}
      data-test=${`fault-${device.name}-${one.line.replaceAll(' ', '-')}`} onClick=${() => inject(one.line)}>
      <b>${one.line}</b><small>${one.text}</small></button>`)}</div>
    <form class="one_line" onSubmit=${(event) => { event.preventDefault(); if (line.trim()) inject(line.trim()); }}>
      <input aria-label=${`a fault line for ${device.name}`} placeholder="a line of its own" value=${line} disabled=${locked}
        onInput=${(event) => set_line(event.currentTarget.value)} /><button class="quiet" disabled=${locked}>inject</button></form>
    ${answer ? html`<p class="answer">${answer}</p>` : null}</section>`;
}

export const FaultsDrawer = ({on_close}) => html`<aside class="drawer" data-test="faults-drawer">
  <h2>Inject faults <small>simulated devices only</small><button class="tiny" aria-label="close" onClick=${on_close}>×</button></h2>
  <p class="about">These go to the simulated devices by a door of their own. The spacecraft is told nothing: it has to find out.</p>
  ${(mission.value?.devices ?? []).map((device) => html`<${Device} key=${device.name} device=${device} />`)}
</aside>`;
