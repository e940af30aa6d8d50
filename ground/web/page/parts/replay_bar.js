// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {copy} from '../commanding.js';
import {live, moment_link, now_s, replay, replay_from, slow} from '../store.js';

export const speeds = [0.1, 0.5, 1, 2, 5, 10, 100];

export function ReplayBar() {
  if (!replay.value) return null;
  slow.value;
  const {speed, state} = replay.value;
  const paused = speed === 0 || state === 'paused';
  return html`<div class="replay_bar" role="status" data-test="replay-bar"><b>Replay, not live</b>
    <span class="at">${clock_text(now_s())}</span><span class="words">${state === 'ended' ? 'end of the archive' : ''}</span>
    <button onClick=${() => replay_from(now_s() - 10)}>−10 s</button>
    <button onClick=${() => replay_from(now_s(), paused ? 1 : 0)}>${paused ? 'play' : 'pause'}</button>
    <button onClick=${() => replay_from(now_s() + 10)}>+10 s</button>
    <span class="speeds">${speeds.map((one) => html`<button class=${one === speed ? 'on' : ''} onClick=${() => replay_from(now_s(), one)}>${one}×</button>`)}</span>
    <span class="words">telecommands are locked</span>
    <button data-test="copy-moment" title="who opens it in a page of this station sees this moment" onClick=${() => copy(moment_link(), 'link to this moment copied; no token is in it')}>copy link</button>
    <button class="back" onClick=${live} data-test="live">back to LIVE</button></div>`;
}
