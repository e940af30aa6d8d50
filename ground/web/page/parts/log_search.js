// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The log: every packet that the archive has, in words, searched by words.
import {useEffect, useRef, useState} from 'preact/hooks';
import {get} from '../api.js';
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {replay} from '../store.js';
import {Panel} from './panel.js';

export function LogSearch() {
  const [text, set_text] = useState('');
  const [housekeeping, set_housekeeping] = useState(false);
  const [found, set_found] = useState(null);
  const [problem, set_problem] = useState('');
  const asked = useRef(0);
  /// The newest that fit, or what comes before those that are shown.
  async function search({with_housekeeping = housekeeping, older = false} = {}) {
    const number = ++asked.current;
    try {
      const answer = await get('/api/log', {text, housekeeping: with_housekeeping ? 1 : undefined, limit: 200,
        before: older ? found.before : undefined, to: older || !replay.value ? undefined : replay.value.at});
      if (number !== asked.current) return;  // somebody has typed on
      set_found(older ? {packets: [...found.packets, ...answer.packets], before: answer.before} : answer);
      set_problem('');
    } catch (error) {
      set_problem(error.message);
    }
  }
  useEffect(() => { search(); }, []);
  const submit = (event) => {
    event.preventDefault();
    search();
  };
  const toggle = () => {
    set_housekeeping(!housekeeping);
    if (found) search({with_housekeeping: !housekeeping});
  };
  return html`<${Panel} title="Log" area="log" hint=${found ? `${found.packets.length} lines${found.before === null ? ', no older ones' : ''}` : 'every packet in words'}>
    <form class="toolbar" onSubmit=${submit}>
      <input class="search" type="search" placeholder="words, then Enter" aria-label="search the log" data-test="log-text" value=${text} onInput=${(event) => set_text(event.currentTarget.value)} />
      <button class="chip" data-test="log-search">search</button>
      <button type="button" class=${`chip ${housekeeping ? 'on' : ''}`} aria-pressed=${housekeeping} onClick=${toggle}>housekeeping</button>
    </form>
    ${problem ? html`<p class="empty">${problem}</p>` : null}
    ${found?.packets.length ? html`<table class="events wide log" data-test="log"><tbody>${found.packets.map((packet) =>
      html`<tr key=${packet.number}><td class="time">${clock_text(packet.t, 3)}</td><td class="words">${packet.text}</td></tr>`)}</tbody></table>` : null}
    ${found && !found.packets.length ? html`<p class="empty">${found.before === null ? 'No packet has these words.' : 'Not among the newest packets.'}</p>` : null}
    ${found?.before != null ? html`<button class="chip" data-test="log-older" onClick=${() => search({older: true})}>older</button>` : null}
  </${Panel}>`;
}
