// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Parameters whose values have names, as lanes of words under the curves of a plot: a state is no height.
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {clock_text, state_text, value_text} from '../format.js';
import {html} from '../html.js';
import {began_s, drop_series, extend, shown_span, use_series} from '../series.js';
import {now_s, replay, slow} from '../store.js';
import {column_of} from './curves.js';
import {show_all} from './plot_cursor.js';

export const is_named = (name) => {
  const column = column_of(name);
  return Boolean(column?.enumeration?.length) || column?.type === 'BOOL';
};

const lane_height = 20, most_spans = 400;

/// [{from, to, value}] of what held in [from, to].
export function spans_of(series, from, to) {
  const spans = [];
  for (let i = 0; i < series.t.length; ++i) {
    const value = series.v[i], last = spans.at(-1);
    if (value === null || series.t[i] > to) continue;
    if (last && last.value === value) { last.to = series.t[i]; continue; }
    if (last) last.to = series.t[i];
    spans.push({from: series.t[i], to: series.t[i], value});
  }
  return spans.filter((one) => one.to >= from).map((one) => ({...one, from: Math.max(one.from, from)})).slice(-most_spans);
}

export function StateLanes({names, window_s, range, left, right}) {
  const used = useRef([]), node = useRef(null);
  const [width, set_width] = useState(600);
  useLayoutEffect(() => {
    const observer = new ResizeObserver(() => set_width(Math.max(120, node.current.clientWidth)));
    observer.observe(node.current);
    return () => observer.disconnect();
  }, []);
  const live = replay.value ? 'replay' : 'live';
  useEffect(() => {
    used.current = names.map((name) => use_series(name, window_s));
    return () => used.current.forEach(drop_series);
  }, [names.join('|'), live]);
  useEffect(() => used.current.forEach((series) => extend(series, range ? now_s() - range[0] : window_s)), [window_s, range?.[0], Number.isFinite(now_s()), began_s()]);
  slow.value;
  const [from, to] = shown_span(window_s, range);
  const x = (t) => left + (t - from) / (to - from) * Math.max(10, width - left - right);
  return html`<svg class="lanes_of_states" ref=${node} height=${names.length * lane_height + 2} data-test="state-lanes" onDblClick=${show_all}>${names.map((name, i) => {
    const column = column_of(name);
    const spans = used.current[i] ? spans_of(used.current[i], from, to) : [];
    return html`<g transform=${`translate(0 ${i * lane_height})`}><text class="label" x="4" y="14">${name.split('.').at(-1).slice(0, Math.max(3, Math.floor(left / 7) - 1))}</text>${spans.map((span, k) => {
      const words = state_text(value_text(column?.type === 'BOOL' ? span.value === 1 : span.value, column)), wide = Math.max(1, x(span.to) - x(span.from));
      return html`<rect class=${k % 2 ? 'odd' : ''} x=${x(span.from)} y="2" width=${wide} height=${lane_height - 4} rx="3"><title>${words} from ${clock_text(span.from, 3)}</title></rect>
        ${wide > words.length * 6.5 + 8 ? html`<text x=${x(span.from) + 5} y="14">${words}</text>` : null}`;
    })}</g>`;
  })}</svg>`;
}
