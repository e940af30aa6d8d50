// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {clock_text, in_words, number_text, state_text, unit_text} from '../format.js';
import {html} from '../html.js';
import {mission, subsystem_of} from '../store.js';
import {Severity} from './icons.js';

/// A name of the flight software may go on in the next line after each of its words, and nowhere else.
const breakable = (name) => String(name).split('_').map((word, i) => i ? html`_<wbr />${word}` : word);

const name_of = (apid) => mission.value?.subsystems.find((one) => one.id === apid)?.name;

/// Text as the gateway tells it, else arguments by name.
export function event_text(event) {
  if (event.name === 'STATE_CHANGED' || event.name === 'STATE_FAILED') {
    const state = event.values?.STATE ?? /STATE=(\S+)/.exec(event.text ?? '')?.[1];
    const names = subsystem_of(event.subsystem)?.states;
    if (state !== undefined) {
      return `${event.name === 'STATE_FAILED' ? 'failed in' : '→'} ${state_text(typeof state === 'number' ? names?.[state] : state)}`;
    }
  }
  if (event.text && event.text !== event.name) return in_words(event.text.startsWith(event.name) ? event.text.slice(event.name.length).trim() : event.text, name_of);
  const known = subsystem_of(event.subsystem)?.events?.find((one) => one.id === event.id)?.arguments ?? [];
  return Object.entries(event.values ?? {}).map(([name, value]) =>
    `${name} ${number_text(value)}${unit_text(known.find((one) => one.name === name)?.unit) ? ` ${unit_text(known.find((one) => one.name === name).unit)}` : ''}`).join(', ');
}

export const EventRow = ({event, wide}) => html`<tr class=${event.severity}>
  <td class="time">${clock_text(event.t, wide ? 3 : 1)}</td>
  <td><${Severity} severity=${event.severity} word=${wide} /></td>
  ${wide ? html`<td class="who">${event.subsystem}</td><td class="name">${event.name}</td><td class="words">${event_text(event)}</td>` :
    html`<td class="words"><span class="who">${event.subsystem}</span> <b>${breakable(event.name)}</b> ${event_text(event)}</td>`}
</tr>`;

export const EventTable = ({list, wide = false, most = 200}) => html`
  <table class=${`events ${wide ? 'wide' : ''}`} data-test="events"><tbody>
    ${list.slice(0, most).map((event) => html`<${EventRow} key=${event.key} event=${event} wide=${wide} />`)}
  </tbody></table>
  ${list.length === 0 ? html`<p class="empty">No events.</p>` : null}
  ${list.length > most ? html`<p class="empty">${list.length - most} older ones: narrow the search.</p>` : null}`;
