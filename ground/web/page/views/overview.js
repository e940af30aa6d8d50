// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {CommandForm} from '../parts/command_form.js';
import {EventTable} from '../parts/event_list.js';
import {wanted_form} from '../parts/goal_form.js';
import {Lanes} from '../parts/lanes.js';
import {LinkRows, links_hint} from '../parts/link_rows.js';
import {column_of, is_reckoned, of_flight, reckoned} from '../parts/curves.js';
import {Later} from '../parts/opening.js';
import {Panel} from '../parts/panel.js';
import {Legend, TimePlot} from '../parts/plot.js';
import {Robot} from '../parts/robot.js';
import {plot_names, scene_of_mission} from '../parts/scene_file.js';
import {Splits} from '../parts/splits.js';
import {SubsystemCard} from '../parts/subsystem_card.js';
import {html} from '../html.js';
import {stop} from '../stop_story.js';
import {Why} from './events.js';
import {state_name} from '../commanding.js';
import {unit_text} from '../format.js';
import {columns, commands, events, mission, status} from '../store.js';

/// Measured numbers before counters, those of the mission's own subsystems before those of every mission, fast ones before slow ones.
function worth(name) {
  const {type, subsystem, period_s} = columns.value.get(name);
  const own = mission.value.subsystems.findIndex((one) => one.name === subsystem);
  return (/DOUBLE|FLOAT/.test(type) ? 1000 : 0) + own - Math.min(0.9, period_s / 100);
}

/// What a mission without a scene shows first: the first arrays and numbers of its housekeeping.
const is_plotted = (column) => column.type !== 'TEXT' && !column.enumeration?.length && !/CYCLE_STATS|COUNTS|REJECTIONS/.test(column.name);
export function first_plots() {
  // Not known yet: plots that go again at once would ask the archive in vain.
  if (scene_of_mission.value === undefined) return [];
  const described = scene_of_mission.value?.plots;
  if (described) return described.map((plot) => told_by(plot)).filter((plot) => plot.names.length);
  const by_parameter = new Map(), own = (column) => (mission.value?.subsystems.find((one) => one.name === column.subsystem)?.id ?? 0) >= 10;
  // What the mission is about, where it has numbers; what every mission has, else.
  const all = [...columns.value.values()], of_mission = all.filter(own);
  for (const column of of_mission.some(is_plotted) ? of_mission : all) {
    if (!is_plotted(column)) continue;
    if (scene_of_mission.value === null && column.subsystem === 'SUPERVISOR') continue;
    const base = column.name.replace(/\[\d+\]$/, '');
    by_parameter.set(base, [...(by_parameter.get(base) ?? []), column.name]);
  }
  const found = [...by_parameter.entries()].sort(([, a], [, b]) => worth(b[0]) - worth(a[0])).map(([, names]) => ({names: names.slice(0, 4), title: plot_title(names.slice(0, 4)), about: {}})).slice(0, 3);
  // Two of one name are told apart by whose they are.
  return found.map((one) => found.some((other) => other !== one && other.title === one.title) ? {...one, title: `${one.names[0].split('.')[0]} ${one.title}`} : one);
}

/// A plot of scene.json: names alone, or {title, hint, curves: [{name, label, look, times}], range, least}.
function told_by(plot) {
  const known = (name) => is_reckoned(name) ? columns.value.size > 0 && !reckoned(name).problem : columns.value.has(name);
  const curves = (Array.isArray(plot) ? plot.map((name) => ({name})) : plot.curves).filter(({name}) => known(name));
  const names = curves.map((one) => one.name);
  return {names, title: plot.title ?? plot_title(names), hint: plot.hint,
    about: {looks: curves.map((one) => one.look), labels: curves.map((one) => one.label), digits: curves.map((one) => one.digits), times: curves.map((one) => one.times), range: plot.range, least: plot.least}};
}

export const plot_title = (names) => {
  const known = (scene_of_mission.value?.plots ?? []).find((plot) => plot.title && plot_names(plot).join() === names.join());
  if (known) return known.title;
  if (names.some(is_reckoned)) return names.find(is_reckoned).slice(1);
  const base = of_flight(names.at(-1) ?? '')[0].replace(/\[\d+\]$/, '').split('.');
  const words = base.slice(base.length > 2 ? 2 : 1).join('.').replaceAll('_', ' ').toLowerCase();
  // Of several elements of arrays what they have in common is which one.
  const [place, ...others] = new Set(names.map((name) => /\[\d+\]$/.exec(name)?.[0] ?? ''));
  return place && !others.length ? `${words} ${place}` : words;
};

const chips = 4;
function QuickCommand() {
  const list = mission.value?.subsystems ?? [];
  const of_its_own = (action) => (action.service === 8 ? !['SET_STATE', 'CONFIGURE'].includes(action.name) : action.service >= 192);
  const own = (one) => (one.functions ?? []).filter(of_its_own).length;
  const first = list.filter((one) => one.id !== 1).sort((one, other) => own(other) - own(one) || other.id - one.id)[0] ?? list[0];
  const [subsystem, set_subsystem] = useState(null);
  const [action, set_action] = useState(null);
  const asked = wanted_form.value;
  useEffect(() => {
    if (!asked) return;
    set_subsystem(asked.subsystem);
    set_action(asked.action);
    wanted_form.value = null;
  }, [asked]);
  const chosen = list.find((one) => one.name === subsystem) ?? first;
  if (!chosen) return null;
  const actions = chosen.functions ?? [];
  const command = actions.find((one) => one.name === action) ?? actions.find(of_its_own) ?? actions[0];
  // What is at hand: those of its own that need few words, first those that were sent last.
  const last = commands.value.filter((one) => one.subsystem === chosen.name).map((one) => one.function);
  const rank = (one) => { const at = last.indexOf(one.name); return at < 0 ? 1000 + (one.arguments ?? []).length : at; };
  const near = actions.filter((one) => of_its_own(one) && one !== command).sort((one, other) => rank(one) - rank(other)).slice(0, chips);
  return html`<div class="quick">
    <div class="pick"><select data-test="quick-subsystem" aria-label="subsystem" value=${chosen.name}
      onChange=${(event) => { set_subsystem(event.currentTarget.value); set_action(null); }}>
      ${list.map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select>
    <select data-test="quick-command" aria-label="telecommand" value=${command?.name} onChange=${(event) => set_action(event.currentTarget.value)}>
      ${actions.map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select></div>
    ${near.length ? html`<div class="chips">${near.map((one) => html`<button class="chip" key=${one.name} title=${one.description} onClick=${() => set_action(one.name)}>${one.name}</button>`)}</div>` : null}
    ${command ? html`<${CommandForm} key=${`${chosen.name}.${command.name}`} subsystem=${chosen.name} action=${command} recent />` : null}</div>`;
}

const operational = () => (status.value?.subsystems ?? []).filter((one) => state_name(one.state) === 'Operational').length;

export function Overview() {
  const plots = first_plots();
  const none = scene_of_mission.value === undefined ? '' : 'No housekeeping to plot.';
  const subsystems = mission.value?.subsystems ?? [];
  const wanted = plots.length ? plots : [{title: 'Plot', names: [], about: {}}];
  return html`<main class="overview"><${Splits} name="overview" />
    <${Panel} title="Subsystems" hint=${`${operational()} / ${subsystems.length} Operational`} area="subsystems" href="#/subsystems">
      ${subsystems.map((one) => html`<${SubsystemCard} key=${one.name} name=${one.name} />`)}</${Panel}>
    <${Panel} title="3D" area="robot" bare titleless><${Robot} /></${Panel}>
    <${Panel} title="Telecommand" area="command" href="#/commands"><${Later}><${QuickCommand} /></${Later}></${Panel}>
    <${Panel} title="Links" hint=${links_hint()} area="links" href="#/links"><${Later}><${LinkRows} /></${Later}></${Panel}>
    <div class="plots_row">${wanted.map(({names, title, hint, about}) => names.length ? html`<${Panel} key=${title} title=${title} hint=${hint ?? [...new Set(names.map((name) => unit_text(column_of(name)?.unit)))].join(', ')} bare
      href=${`#/plots?p=${names.map(encodeURIComponent).join('+')}`}>
      <${Later}><${Legend} names=${names} about=${about} brief /><${TimePlot} names=${names} window_s=${30} about=${{...about, relative: true}} /></${Later}></${Panel}>` :
      html`<${Panel} title="Plot" href="#/plots"><p class="empty">${none}</p></${Panel}>`)}</div>
    ${stop.value ? html`<${Why} area="events" brief tools=${html`<a class="chip" href="#/events">All events</a>`} />` : html`<${EventsAtAGlance} />`}
    <${Panel} title="Timeline" area="timeline" href="#/timeline"><${Later}><${Lanes} window_s=${600} small /></${Later}></${Panel}>
  </main>`;
}

/// What deviates, and what was done, one sentence each; the changes of state that every start has are counted.
function EventsAtAGlance() {
  const [all, set_all] = useState(false);
  const folded = (event) => !all && event.severity === 'info' && /^(STATE_CHANGED|CONFIGURED|LINK_ESTABLISHED|LINK_RELEASED)$/.test(event.name);
  const shown = events.value.filter((event) => !folded(event));
  const count = events.value.length - shown.length;
  return html`<${Panel} title="Events" area="events" href="#/events" tools=${html`<button class=${`chip ${all ? 'on' : ''}`} aria-pressed=${all} onClick=${() => set_all(!all)}>all</button>`}>
    <${Later}><${EventTable} list=${shown} most=${40} /></${Later}>${count ? html`<p class="folded">${count} ${count > 1 ? 'changes of state are' : 'change of state is'} folded</p>` : null}</${Panel}>`;
}
