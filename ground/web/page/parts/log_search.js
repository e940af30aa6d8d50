// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The log: every packet that the archive has, in words, searched by words. While its top is in sight, what is newer comes by itself.
import {useEffect, useRef, useState} from 'preact/hooks';
import {get} from '../api.js';
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {flight, now_s, replay} from '../store.js';
import {with_newest} from './log_lines.js';
import {Panel} from './panel.js';

const page_lines = 200;
/// A station that takes long for an answer, as a long search does, is not asked all the time.
const refresh_ms = 2000, rests_per_answer = 9;

export function LogSearch() {
  const [text, set_text] = useState('');
  const [housekeeping, set_housekeeping] = useState(false);
  const [found, set_found] = useState(null);
  const [problem, set_problem] = useState('');
  const [at_top, set_at_top] = useState(true);
  const asked = useRef(0), under_way = useRef(false), sought = useRef({text: '', housekeeping: false}), shown = useRef(null), top = useRef(null);
  shown.current = found;
  const ask = (more) => get('/api/log', {text: sought.current.text, housekeeping: sought.current.housekeeping ? 1 : undefined, limit: page_lines, ...more});
  const until = () => replay.peek() ? now_s() : undefined;
  /// The newest that fit what is sought, or what comes before those that are shown.
  async function search({older = false} = {}) {
    const number = ++asked.current;
    under_way.current = true;
    try {
      const answer = await ask(older ? {before: found.before} : {to: until()});
      if (number !== asked.current) return;  // somebody has typed on
      set_found(older ? {packets: [...shown.current.packets, ...answer.packets], before: answer.before} : answer);
      set_problem('');
    } catch (error) {
      if (number === asked.current) set_problem(error.message);
    } finally {
      if (number === asked.current) under_way.current = false;
    }
  }
  async function catch_up() {
    if (under_way.current || document.hidden) return;
    const number = asked.current;
    try {
      const answer = await ask({to: until()});
      if (number !== asked.current) return;
      const before = shown.current;
      if (!before || answer.packets[0]?.number !== before.packets[0]?.number) set_found(before ? with_newest(before, answer) : answer);
      set_problem('');
    } catch (error) {
      if (number === asked.current) set_problem(error.message);
    }
  }
  const in_replay = replay.value !== null, flown = flight.value?.id;
  useEffect(() => { search(); }, [in_replay, flown]);
  useEffect(() => {
    const observer = new IntersectionObserver((seen) => set_at_top(seen.at(-1).isIntersecting));
    observer.observe(top.current);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    if (!at_top) return;
    let timer = 0, over = false;
    const again = async () => {
      const began_ms = performance.now();
      await catch_up();
      if (!over) timer = setTimeout(again, Math.max(refresh_ms, rests_per_answer * (performance.now() - began_ms)));
    };
    again();
    return () => {
      over = true;
      clearTimeout(timer);
    };
  }, [at_top]);
  const submit = (event) => {
    event.preventDefault();
    sought.current = {text, housekeeping};
    search();
  };
  const toggle = () => {
    set_housekeeping(!housekeeping);
    sought.current = {...sought.current, housekeeping: !housekeeping};
    search();
  };
  const going = problem ? 'does not go on' : at_top ? 'goes on' : 'stands still';
  const lines = found ? `${found.packets.length} lines${found.before === null ? ', no older ones' : ''}` : 'every packet in words';
  return html`<${Panel} title="Log" area="log" hint=${found ? `${going}, ${lines}` : lines}
    tools=${at_top ? null : html`<button class="chip" data-test="log-newest" title="what came since: the log goes on while its top is in sight" onClick=${() => top.current.scrollIntoView({block: 'nearest'})}>to the newest</button>`}>
    <i ref=${top} class="log_top" aria-hidden="true" />
    <form class="toolbar" onSubmit=${submit}>
      <input class="search" type="search" placeholder="words, then Enter" aria-label="search the log" data-test="log-text" value=${text} onInput=${(event) => set_text(event.currentTarget.value)} />
      <button class="chip" data-test="log-search">search</button>
      <button type="button" class=${`chip ${housekeeping ? 'on' : ''}`} aria-pressed=${housekeeping} onClick=${toggle}>housekeeping</button>
    </form>
    ${problem ? html`<p class="empty" role="alert" data-test="log-problem">${found ? 'The log does not go on: ' : ''}${problem}</p>` : null}
    ${found?.packets.length ? html`<table class="events wide log" data-test="log"><tbody>${found.packets.map((packet) =>
      html`<tr key=${packet.number}><td class="time">${clock_text(packet.t, 3)}</td><td class="words">${packet.text}</td></tr>`)}</tbody></table>` : null}
    ${found && !found.packets.length ? html`<p class="empty">${found.before === null ? 'No packet has these words.' : 'Not among the newest packets.'}</p>` : null}
    ${found?.before != null ? html`<button class="chip" data-test="log-older" onClick=${() => search({older: true})}>older</button>` : null}
  </${Panel}>`;
}
