// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {get} from '../api.js';
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {Alarms} from '../parts/alarms.js';
import {EventTable, event_text} from '../parts/event_list.js';
import {Severity} from '../parts/icons.js';
import {LogSearch} from '../parts/log_search.js';
import {Panel} from '../parts/panel.js';
import {Splits} from '../parts/splits.js';
import {Chain} from '../parts/stop_banner.js';
import {story} from '../stop_story.js';
import {counts, events, mission, replay} from '../store.js';

const severities = ['high', 'medium', 'low', 'info'];

export function Why({area = 'why', tools, brief = false}) {
  const told = story.value;
  return html`<${Panel} title="Why did it stop?" area=${area} hint=${brief ? null : 'hirosco why'} tools=${tools}>
    ${told ? html`${brief ? null : html`<p class="why_title">${told.title}</p><p class="about">${clock_text(told.t, 3)} ${told.detail ?? ''}</p>`}
      <${Chain} causes=${told.causes} />
      <p class="why_advice"><b>What to do</b> ${told.advice}</p>` : html`<p class="empty">Nothing has stopped.</p>`}</${Panel}>`;
}

export function Events({query}) {
  const [text, set_text] = useState(query.get_raw('text') ?? '');
  const [who, set_who] = useState('');
  const asked = query.get_raw('severity');
  const [shown, set_shown] = useState(null);
  const [archive, set_archive] = useState(null);
  const wanted = shown ?? (asked ? severities.slice(0, severities.indexOf(asked) + 1) : severities);
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const fits = (event) => wanted.includes(event.severity) && (!who || event.subsystem === who) &&
    words.every((word) => `${event.subsystem} ${event.name} ${event.text ?? ''} ${event_text(event)}`.toLowerCase().includes(word));
  const list = (archive ?? events.value).filter(fits);
  const search_archive = async () => {
    if (archive) return set_archive(null);
    const found = await get('/api/events', {text, limit: 2000, to: replay.value ? replay.value.at : undefined}).catch(() => ({events: []}));
    set_archive((found.events ?? found).map((event, i) => ({...event, key: i})));
  };
  return html`<main class="event_view"><${Splits} name="events" />
    <${Alarms} />
    <${Panel} title="Events" area="events" hint=${archive ? `archive, ${list.length} found` : `${list.length} of ${events.value.length}`}>
      <div class="toolbar">
        ${severities.map((one) => html`<button class=${`chip ${wanted.includes(one) ? 'on' : ''}`} aria-pressed=${wanted.includes(one)}
          onClick=${() => set_shown(wanted.includes(one) ? wanted.filter((other) => other !== one) : [...wanted, one])}>
          <${Severity} severity=${one} word /> ${counts.value[one]}</button>`)}
        <select aria-label="subsystem" value=${who} onChange=${(event) => set_who(event.currentTarget.value)}><option value="">all subsystems</option>
          ${(mission.value?.subsystems ?? []).map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select>
        <input class="search" type="search" placeholder="search  /" aria-label="search events" data-search value=${text} onInput=${(event) => { set_text(event.currentTarget.value); set_archive(null); }} />
        <button class=${`chip ${archive ? 'on' : ''}`} onClick=${search_archive}>whole archive</button>
      </div>
      <${EventTable} list=${list} wide most=${400} /></${Panel}>
    <${Why} />
    <${LogSearch} />
  </main>`;
}
