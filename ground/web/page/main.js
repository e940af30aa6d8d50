// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The page: header, rail, one view by the address, and what lies over it.
import {signal} from '@preact/signals';
import {render} from 'preact';
import {take_token} from './api.js';
import {toasts} from './commanding.js';
import {html} from './html.js';
import {FaultsDrawer} from './parts/faults.js';
import {Header} from './parts/header.js';
import {Icon} from './parts/icons.js';
import {ReplayBar} from './parts/replay_bar.js';
import {StateLine} from './parts/state_line.js';
import {StopBanner} from './parts/stop_banner.js';
import {calling, live, mission, now_s, problem, replay_from, start} from './store.js';
import {switch_theme, theme} from './theme.js';
import {Tour, tour_from_url} from './tour.js';
import {Events} from './views/events.js';
import {Overview} from './views/overview.js';

/// What is in views/later.js, once it is here: by itself when the page has had time to start, or when somebody asks for it.
const others = signal(null);
let coming = null;
const fetch_others = () => {
  coming ??= import('./views/later.js').then((found) => { others.value = found; }, () => {
    coming = null;
    setTimeout(fetch_others, retry_ms);
  });
};
const retry_ms = 1000, started_ms = 8000;
setTimeout(fetch_others, started_ms);
function later(name) {
  return (props) => {
    if (others.value) return html`<${others.value[name]} ...${props} />`;
    fetch_others();
    return html`<main class="starting">Waiting for the gateway …</main>`;
  };
}
const [Commands, Help, Links, Plots, Subsystems, Timeline] = ['Commands', 'Help', 'Links', 'Plots', 'Subsystems', 'Timeline'].map(later);

const views = {
  overview: ['Overview', Overview, 'o'], subsystems: ['Subsystems', Subsystems, 's'], plots: ['Plots', Plots, 'p'],
  commands: ['Commands', Commands, 'c'], links: ['Links', Links, 'l'], events: ['Events', Events, 'e'],
  timeline: ['Timeline', Timeline, 't'], help: ['Help', Help, 'h'],
};

/// #/view/rest?query; names keep their + and | undecoded, each view decodes its own parts.
function parsed_route() {
  const [path, query = ''] = location.hash.replace(/^#\/?/, '').split('?');
  const [view, ...rest] = path.split('/').map((part) => { try { return decodeURIComponent(part); } catch { return part; } });
  const entries = new Map(query.split('&').filter(Boolean).map((pair) => pair.split(/=(.*)/s).slice(0, 2)));
  return {view: view in views ? view : 'overview', rest: rest.filter(Boolean), query: {get_raw: (name) => entries.get(name)}};
}

const tour_asked = /[#&?]tour\b/.test(location.hash);
const token_first = take_token();
const route = signal(parsed_route());
addEventListener('hashchange', () => {
  route.value = parsed_route();
  to_moment();
});
/// An address with a moment in it is a replay from there.
function to_moment() {
  const at = Number(route.value.query.get_raw('at'));
  if (at > 0 && Number.isFinite(at)) replay_from(at, 1);
}
const faults_open = signal(false);
const paused = signal(null);

let after_g = 0;
addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === 'Escape') {
    faults_open.value = false;
    document.activeElement?.blur();
    return;
  }
  if (event.target.closest('input, select, textarea, [contenteditable]')) return;
  const wanted = after_g && performance.now() - after_g < 1500 && Object.entries(views).find(([, [, , key]]) => key === event.key);
  after_g = event.key === 'g' ? performance.now() : 0;
  if (wanted) location.hash = `#/${wanted[0]}`;
  else if (event.key === 'c') location.hash = '#/commands';
  else if (event.key === '?') location.hash = '#/help';
  else if (event.key === 'f') faults_open.value = !faults_open.value;
  else if (event.key === 'l') live();
  else if (event.key === ' ' && !event.target.closest('button, a, [role=button]')) {
    paused.value = paused.value === null ? now_s() : null;
    event.preventDefault();
  } else if (event.key === '/') {
    const search = document.querySelector('[data-search]');
    if (search) search.focus();
    else location.hash = '#/events';
    event.preventDefault();
  }
});

function Page() {
  const {view, rest, query} = route.value;
  const View = views[view][1];
  return html`
    <${Header} on_faults=${() => { faults_open.value = !faults_open.value; }} faults_open=${faults_open.value} />
    <${ReplayBar} />
    <${StopBanner} />
    <${StateLine} />
    <nav aria-label="views">${Object.entries(views).map(([name, [title]]) => html`<a href=${`#/${name}`} class=${name === view ? 'on' : ''}
      aria-current=${name === view ? 'page' : undefined} title=${title}><${Icon} name=${name} /><span>${title}</span>${
      name === 'events' && calling.value.high + calling.value.medium ? html`<i class="news">${calling.value.high + calling.value.medium}</i>` : null}</a>${
      name === 'timeline' ? html`<button class="theme" data-test="theme" onClick=${switch_theme}><${Icon} name="theme" /><span>${theme.value === 'light' ? 'Dark' : 'Light'}</span></button>` : null}`)}</nav>
    ${problem.value ? html`<p class="problem" role="alert">${problem.value}</p>` : null}
    ${mission.value ? html`<${View} key=${view} rest=${rest} query=${query} paused=${paused.value} set_paused=${(t) => { paused.value = t; }} />` :
      html`<main class="starting">${problem.value ? '' : 'Waiting for the gateway …'}</main>`}
    ${faults_open.value && mission.value ? html`<${FaultsDrawer} on_close=${() => { faults_open.value = false; }} />` : null}
    <${Tour} />
    <div class="toasts" role="status">${toasts.value.map((one) => html`<p key=${one.number} class=${one.kind}>${one.text}</p>`)}</div>`;
}

const root = document.getElementById('page');
root.textContent = '';
render(html`<${Page} />`, root);
if (!token_first) problem.value = 'Open the URL that `hirosco run` printed: it carries the token.';
start();
to_moment();
if (tour_asked) tour_from_url();
