// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The flights of the archive: when each was, what it is called, what went wrong in it, what people wrote of it. A click shows it on the timeline.
import {useState} from 'preact/hooks';
import {clock_text, date_text} from '../format.js';
import {html} from '../html.js';
import {name_flight, note_flight} from '../people.js';
import {flight, flights, newest_s, operator, replay, replay_from, slow} from '../store.js';
import {Severity} from './icons.js';
import {Panel} from './panel.js';

const long_text = (s) => s < 100 ? `${s.toFixed(0)} s` : s < 6000 ? `${(s / 60).toFixed(0)} min` : `${(s / 3600).toFixed(1)} h`;

function Name({one, on_done}) {
  const [text, set_text] = useState(one.name);
  return html`<form onSubmit=${(event) => { event.preventDefault(); name_flight(one.id, text).then(on_done); }}><input maxlength="80" aria-label=${`name of flight ${one.id}`} data-test="flight-name"
    placeholder="a name" value=${text} onInput=${(event) => set_text(event.currentTarget.value)} autofocus /><button class="chip">keep</button></form>`;
}

/// So many are shown at once, the newest.
const notes_shown = 2;

function Note({one, on_done}) {
  const [text, set_text] = useState('');
  return html`<form onSubmit=${(event) => { event.preventDefault(); if (text.trim()) note_flight(one.id, text.trim()).then((done) => done && on_done()); }}><input maxlength="1000" aria-label=${`note of flight ${one.id}`}
    data-test="flight-note" placeholder="what is to be known of it" value=${text} onInput=${(event) => set_text(event.currentTarget.value)} autofocus /><button class="chip" disabled=${!text.trim()}>keep</button></form>`;
}

function Notes({one}) {
  const [all, set_all] = useState(false);
  const notes = one.notes ?? [], hidden = notes.length - notes_shown;
  if (!notes.length) return null;
  return html`<ul class="notes" data-test=${`notes-${one.id}`}>${hidden > 0 ? html`<li><button class="link" aria-expanded=${all} onClick=${() => set_all(!all)}>${all ? 'only the newest' : `${hidden} earlier`}</button></li>` : null}
    ${(all ? notes : notes.slice(-notes_shown)).map((note) => html`<li><small>${note.who}, ${clock_text(note.t, 0)}</small> ${note.text}</li>`)}</ul>`;
}

export function Flights({on_look}) {
  const [naming, set_naming] = useState(null), [noting, set_noting] = useState(null);
  slow.value;
  const is_present = (one) => one.id === flight.value?.id;
  const end_of = (one) => is_present(one) && !replay.value ? Math.max(one.to, newest_s() || 0) : one.to;
  return html`<${Panel} title="Flights" area="flights" hint=${flights.value.length ? `${flights.value.length} in the archive` : ''}>
    <ol class="flights" data-test="flights">${flights.value.map((one) => html`<li key=${one.id} class=${is_present(one) ? 'now' : ''}>
      <div class="row"><button class="name" data-test=${`flight-${one.id}`} title="on the timeline" onClick=${() => on_look(is_present(one) && !replay.value ? {span_s: 300, end: null} : {span_s: Math.max(1, 1.05 * (one.to - one.from)), end: one.to + 0.02 * (one.to - one.from)})}>
        <b>${one.name || `Flight ${one.id}`}</b>${is_present(one) ? html` <small>now</small>` : null}</button><small>${date_text(one.from)} ${clock_text(one.from, 0)}, ${long_text(end_of(one) - one.from)}</small></div>
      <div class="row"><small>${one.high ? html`<${Severity} severity="high" /> ${one.high} ` : null}${one.medium ? html`<${Severity} severity="medium" /> ${one.medium} ` : null}${one.commands} ${one.commands === 1 ? 'telecommand' : 'telecommands'}</small>
        <span>${operator.value && !replay.value ? html`<button class="link" onClick=${() => set_naming(naming === one.id ? null : one.id)}>name</button>
          <button class="link" data-test=${`note-flight-${one.id}`} onClick=${() => set_noting(noting === one.id ? null : one.id)}>note</button>` : null}
          <button class="link" data-test=${`replay-flight-${one.id}`} onClick=${() => replay_from(one.from, 1)}>replay</button></span></div>
      ${naming === one.id ? html`<${Name} one=${one} on_done=${() => set_naming(null)} />` : null}
      <${Notes} one=${one} />${noting === one.id ? html`<${Note} one=${one} on_done=${() => set_noting(null)} />` : null}</li>`)}</ol>
    ${flights.value.length ? null : html`<p class="empty">No flight is known yet.</p>`}</${Panel}>`;
}
