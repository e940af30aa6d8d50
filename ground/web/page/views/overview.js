// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {CommandForm} from '../parts/command_form.js';
import {EventTable} from '../parts/event_list.js';
import {Lanes} from '../parts/lanes.js';
import {LinkGraph} from '../parts/link_graph.js';
import {Panel} from '../parts/panel.js';
import {Legend, TimePlot} from '../parts/plot.js';
import {Robot, scene_of_mission} from '../parts/robot.js';
import {SubsystemCard} from '../parts/subsystem_card.js';
import {html} from '../html.js';
import {stop} from '../stop.js';
import {Why} from './events.js';
import {Values} from './subsystems.js';
import {columns, events, mission} from '../store.js';

/// Measured numbers before counters, those of the mission's own subsystems before those of every mission, fast ones before slow ones.
function worth(name) {
  const {type, subsystem, period_s} = columns.value.get(name);
  const own = mission.value.subsystems.findIndex((one) => one.name === subsystem);
  return (/DOUBLE|FLOAT/.test(type) ? 1000 : 0) + own - Math.min(0.9, period_s / 100);
}

/// What a mission without a scene shows first: the first arrays and numbers of its housekeeping.
export function first_plots() {
  // Not known yet: plots that go again at once would ask the archive in vain.
  if (scene_of_mission.value === undefined) return [];
  const described = scene_of_mission.value?.plots;
  if (described) return described.map((names) => names.filter((name) => columns.value.has(name))).filter((names) => names.length);
  const by_parameter = new Map();
  for (const column of columns.value.values()) {
    if (column.type === 'TEXT' || column.enumeration?.length || /CYCLE_STATS|COUNTS|REJECTIONS/.test(column.name)) continue;
    if (scene_of_mission.value === null && column.subsystem === 'SUPERVISOR') continue;
    const base = column.name.replace(/\[\d+\]$/, '');
    by_parameter.set(base, [...(by_parameter.get(base) ?? []), column.name]);
  }
  return [...by_parameter.entries()].sort(([, a], [, b]) => worth(b[0]) - worth(a[0]))
      .map(([, names]) => names.slice(0, 4)).slice(0, 2);
}

export const plot_title = (names) => {
  const base = (names.at(-1) ?? '').replace(/\[\d+\]$/, '').split('.');
  return base.slice(base.length > 2 ? 2 : 1).join('.').replaceAll('_', ' ').toLowerCase();
};

function QuickCommand() {
  const list = mission.value?.subsystems ?? [];
  const of_its_own = (action) => (action.service === 8 ? !['SET_STATE', 'CONFIGURE'].includes(action.name) : action.service >= 192);
  const own = (one) => (one.functions ?? []).filter(of_its_own).length;
  const first = list.filter((one) => one.id !== 1).sort((one, other) => own(other) - own(one) || other.id - one.id)[0] ?? list[0];
  const [subsystem, set_subsystem] = useState(null);
  const [action, set_action] = useState(null);
  const chosen = list.find((one) => one.name === subsystem) ?? first;
  if (!chosen) return null;
  const actions = chosen.functions ?? [];
  const command = actions.find((one) => one.name === action) ?? actions.find(of_its_own) ?? actions[0];
  return html`<div class="quick">
    <label class="field"><span>Subsystem</span><select data-test="quick-subsystem" value=${chosen.name}
      onChange=${(event) => { set_subsystem(event.currentTarget.value); set_action(null); }}>
      ${list.map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select></label>
    <label class="field"><span>Command</span><select data-test="quick-command" value=${command?.name}
      onChange=${(event) => set_action(event.currentTarget.value)}>
      ${actions.map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select></label>
    ${command ? html`<${CommandForm} key=${`${chosen.name}.${command.name}`} subsystem=${chosen.name} action=${command} />` : null}</div>`;
}

export function Overview() {
  const plots = first_plots();
  const none = scene_of_mission.value === undefined ? '' : 'No housekeeping to plot.';
  const last = mission.value?.subsystems.at(-1);
  return html`<main class="overview">
    <${Panel} title="Subsystems" area="subsystems" href="#/subsystems">
      ${(mission.value?.subsystems ?? []).map((one) => html`<${SubsystemCard} key=${one.name} name=${one.name} />`)}</${Panel}>
    ${scene_of_mission.value === null ? html`<${Panel} title=${`${last?.name ?? ''} housekeeping`} area="robot" href=${`#/subsystems/${last?.name}`}>
      ${last ? html`<${Values} name=${last.name} />` : null}</${Panel}>` :
    html`<${Panel} title="3D" area="robot" bare><${Robot} /></${Panel}>`}
    <${Panel} title="Telecommand" area="command" href="#/commands"><${QuickCommand} /></${Panel}>
    <${Panel} title="Real-time links" area="links" href="#/links"><${LinkGraph} width=${320} height=${190} box=${142} /></${Panel}>
    ${[0, 1].map((i) => plots[i] ? html`<${Panel} title=${plot_title(plots[i])} area=${`plot_${i}`} bare
      href=${`#/plots?p=${plots[i].map(encodeURIComponent).join('+')}`}>
      <${Legend} names=${plots[i]} brief /><${TimePlot} names=${plots[i]} window_s=${30} /></${Panel}>` :
      html`<${Panel} title="plot" area=${`plot_${i}`} href="#/plots"><p class="empty">${none}</p></${Panel}>`)}
    ${stop.value ? html`<${Why} area="events" brief tools=${html`<a class="chip" href="#/events">All events</a>`} />` :
      html`<${Panel} title="Events" area="events" href="#/events"><${EventTable} list=${events.value} most=${40} /></${Panel}>`}
    <${Panel} title="Timeline" hint="click to replay from there" area="timeline" href="#/timeline"><${Lanes} window_s=${120} /></${Panel}>
  </main>`;
}
