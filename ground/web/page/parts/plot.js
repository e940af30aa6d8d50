// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import uPlot from 'uplot';
import {brief_text, clock_text, fixed_text, quantity_text, ticks_text, unit_text, value_text} from '../format.js';
import {html} from '../html.js';
import {began_s, drawn_rows, drop_series, extend, has_samples, newest_of, shown_span, statistics, use_series, value_at} from '../series.js';
import {columns, now_s, replay, slow} from '../store.js';
import {colour, theme} from '../theme.js';
import {column_of, curve_words, is_reckoned, of_flight, reckoned} from './curves.js';
import {cursor_t, look_at, pin, pins, put, show_all, unpin, whole} from './plot_cursor.js';
import {bare, event_marks, gap_shade, gauge, limit_bands, marks_in, pinned_cursors, stop_mark} from './plot_layers.js';
import {alone} from './silences.js';
import {is_named, StateLanes} from './state_lanes.js';

/// Of curves that have no meaning of their own; what is measured, set, touched or felt has the colour of that everywhere.
const palette = {dark: ['#6cb0ff', '#ffc06a', '#46d6c8', '#ff8fb8', '#b9a2ff', '#8bd17c', '#ffe27a', '#ff9a7a'],
  light: ['#1560b3', '#9a5a00', '#0b766c', '#b3225f', '#6a48c7', '#2f6b22', '#7a6200', '#b23c12']};
export const curve_colour = (i, look) => look ? colour(looks[look].colour) : palette[theme.value][i % palette.dark.length];
const looks = {is: {colour: 'measured', width: 1.7}, set: {colour: 'blue', width: 1.5, dash: [4, 3]}, touched: {colour: 'teal', width: 3.2},
  felt: {colour: 'violet', width: 1.5, dash: [5, 3]}};
const font = '11px Inter', narrow_px = 200;

const short_name = (name) => curve_words(name)[1];
/// What was is thin and dotted beside what is.
const past_look = {width: 1.2, dash: [2, 3]};
const look_of = (name, look) => looks[look] ?? (of_flight(name)[1] !== null ? past_look : undefined);

const line_stroke = () => colour('line'), word_stroke = () => colour('faint');
const axis_of_time = (relative) => ({
  stroke: word_stroke, grid: {stroke: line_stroke, width: 1}, ticks: {stroke: line_stroke, width: 1, size: 4}, font,
  space: relative ? 60 : 80, size: relative ? 22 : 26,
  // The label of a tick has as many digits as its step: 2.5 s are not cut to whole seconds.
  splits: relative ? (plot, _, from, to) => {
    const parts = plot.width < narrow_px ? 1 : 3;
    return Array.from({length: parts + 1}, (_, i) => from + i * (to - from) / parts);
  } : undefined,
  values: relative ? (_, splits) => splits.map((t, i) => i === splits.length - 1 ? 'now' : `−${+(splits.at(-1) - t).toFixed(1)} s`) :
    (_, splits) => splits.map((t) => clock_text(t, splits.length > 1 && (splits[1] - splits[0]) % 1 > 1e-6 ? 1 : 0)),
});

function axis_of(unit, index, relative) {
  return {scale: unit, side: index % 2 ? 1 : 3, stroke: word_stroke, font, size: relative ? 40 : 52, label: relative ? undefined : unit_text(unit) || 'value',
    labelSize: 14, labelFont: font, labelGap: 0, gap: 3, space: 34, ticks: {stroke: line_stroke, width: 1, size: relative ? 0 : 4},
    grid: {show: index === 0, stroke: line_stroke, width: 1},
    values: (plot, splits) => plot.bare ? splits.map(() => '') : ticks_text(splits)};
}

const sync = uPlot.sync('hirosco');

/// A curve that is to be `times` as large has the same axis, divided: curves that lie on each other are as they should be. Never narrower
/// than `least`, so that noise does not fill the plot.
function scales_of(units, about) {
  const first = units.find((unit) => !unit.startsWith('times '));
  const range = (_, low, high) => {
    if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
    const middle = (low + high) / 2, half = Math.max((high - low) * 0.6, (about.least ?? 0) / 2, 1e-9);
    // What is never below zero, as the size of a force, has no axis of it.
    return low >= 0 && middle < half ? [-0.08 * half, 2 * half] : [middle - half, middle + half];
  };
  return Object.fromEntries(units.map((unit) => [unit, unit.startsWith('times ') ?
    {from: first, dir: Math.sign(Number(unit.slice(6))), range: (_, low, high) => [low, high].map((value) => value / Number(unit.slice(6))).sort((a, b) => a - b)} : about.least || about.range ? {range} : {}]));
}

/// Heights that somebody has zoomed into stay, whatever the samples do.
function zoomable(scales) {
  return Object.fromEntries(Object.entries(scales).map(([unit, scale]) => [unit, {...scale, range: (plot, low, high, key) => {
    if (plot.zoomed?.[unit]) return plot.zoomed[unit];
    if (scale.range) return scale.range(plot, low, high, key);
    if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
    return uPlot.rangeNum(low, high, 0.1, true);
  }}]));
}

function options_of(names, size, on_zoom, about) {
  const scale_of = (name, i) => about.times?.[i] ? `times ${about.times[i]}` : column_of(name)?.unit ?? '';
  const units = [...new Set(names.map(scale_of))];
  const series = [{}];
  const bands = [];
  names.forEach((name, i) => {
    const scale = scale_of(name, i), look = look_of(name, about.looks?.[i]);
    const stepped = Boolean(column_of(name)?.enumeration?.length) || column_of(name)?.type === 'BOOL';
    const stroke = () => curve_colour(i, about.looks?.[i]);
    series.push({label: name, scale, stroke, width: look?.width ?? 1.4, dash: look?.dash, points: {show: false, size: 4, fill: stroke, filter: (plot, place) => alone(plot.data[place])}, spanGaps: false,
      paths: stepped ? uPlot.paths.stepped({align: 1}) : undefined},
    {scale, stroke: 'transparent', points: {show: false}}, {scale, stroke: 'transparent', points: {show: false}});
    bands.push({series: [3 * i + 3, 3 * i + 2], fill: () => `${stroke()}33`});
  });
  return {...size, series, bands, legend: {show: false}, padding: [about.range || about.relative ? 18 : 8, about.range ? 48 : units.length > 1 ? 0 : 30, 0, 0],
    scales: {x: {time: false}, ...zoomable(scales_of(units, about))}, plugins: [gap_shade, limit_bands(names), event_marks, stop_mark, pinned_cursors, bare, ...(about.range ? [gauge(about.range, names[0])] : [])],
    axes: [axis_of_time(about.relative), ...units.map((unit, i) => axis_of(unit, i, about.relative))],
    // Where the mouse is, all plots know; what it drags, and a double click, are of the page.
    cursor: {sync: {key: sync.key, scales: ['x', null], filters: {pub: (type) => type === 'mousemove', sub: () => true}}, bind: {dblclick: () => null}, drag: {x: true, y: true, uni: 24, setScale: false}, points: {size: 6}},
    hooks: {
      setCursor: [(plot) => { if (plot.over.matches(':hover')) look_at(plot.cursor.left >= 0 ? plot.posToVal(plot.cursor.left, 'x') : null); }],
      ready: [(plot) => watch_mouse(plot)],
      // Along the time a span of it, upwards a part of the heights.
      setSelect: [(plot) => {
        const {left, top, width, height} = plot.select, tall = plot.over.clientHeight;
        if (width < 4 && height < 4) return;
        if (height > 4 && height < tall - 1) units.forEach((unit) => { plot.zoomed[unit] = [plot.posToVal(top + height, unit), plot.posToVal(top, unit)]; });
        if (width > 4 && width < plot.over.clientWidth - 1) on_zoom([plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x')]);
        plot.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
        plot.redraw();
      }]}};
}

const click_px = 3;
/// A click pins the cursor; the wheel zooms the heights about the mouse; a double click shows all again. While the button is down nothing moves.
function watch_mouse(plot) {
  const {over} = plot;
  let down = null;
  over.addEventListener('pointerdown', (event) => {
    down = [event.clientX, event.clientY];
    if (event.button !== 0) return;
    plot.held = true;
    // After uPlot, which hears of it at the document, has taken what was selected.
    const ended = new AbortController();
    for (const name of ['mouseup', 'pointercancel', 'blur']) addEventListener(name, () => { plot.held = false; ended.abort(); }, {signal: ended.signal});
  });
  over.addEventListener('pointerup', (event) => {
    if (down && event.button === 0 && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < click_px) {
      pin(plot.posToVal(event.clientX - over.getBoundingClientRect().left, 'x'));
    }
    down = null;
  });
  over.addEventListener('pointerleave', () => look_at(null));
  over.addEventListener('dblclick', show_all);
  over.addEventListener('wheel', (event) => {
    event.preventDefault();
    const at = event.clientY - over.getBoundingClientRect().top, times = event.deltaY > 0 ? 1.25 : 0.8;
    for (const unit of new Set(plot.series.slice(1).map((one) => one.scale))) {
      const {min, max} = plot.scales[unit], middle = plot.posToVal(at, unit);
      if (!Number.isFinite(min)) continue;
      plot.zoomed[unit] = [middle + (min - middle) * times, middle + (max - middle) * times];
    }
    plot.redraw();
  }, {passive: false});
}

function useSize(node) {
  const [size, set_size] = useState(null);
  useLayoutEffect(() => {
    const measure = () => set_size({width: Math.max(120, Math.floor(node.current.clientWidth)),
      height: Math.max(60, Math.floor(node.current.clientHeight))});
    const observer = new ResizeObserver(measure);
    observer.observe(node.current);
    measure();
    return () => observer.disconnect();
  }, []);
  return size;
}

/// Curves of parameters over time. `range` null follows the newest sample; else it shows [from, to].
const nothing = {};
export function TimePlot({names: all_names, window_s = 60, range = null, on_zoom = () => {}, plot_ref, about = nothing}) {
  const names = all_names.filter((name) => !is_named(name)), named = all_names.filter(is_named);
  const node = useRef(null);
  const drawn = useRef({});
  const size = useSize(node);
  const key = names.join('|');
  const live = replay.value ? 'replay' : 'live';

  useEffect(() => {
    const list = names.map((name) => use_series(name, window_s));
    drawn.current.list = list;
    return () => list.forEach(drop_series);
  }, [key, live]);
  useEffect(() => drawn.current.list?.forEach((series) => extend(series, range ? now_s() - range[0] : window_s)),
    [window_s, range?.[0], Number.isFinite(now_s()), began_s()]);

  useEffect(() => {
    if (!size || !columns.value.size || !names.length) return;
    const plot = new uPlot(options_of(names, size, (span) => drawn.current.on_zoom(span), about),
      Array.from({length: 1 + 3 * names.length}, () => []), node.current);
    plot.zoomed = {};
    drawn.current.plot = plot;
    if (plot_ref) plot_ref.current = {plot, list: drawn.current.list};
    draw();
    return () => {
      plot.destroy();
      drawn.current.plot = null;
    };
  }, [key, Boolean(size), columns.value.size, live, theme.value]);
  useEffect(() => { if (size) drawn.current.plot?.setSize(size); }, [size?.width, size?.height]);

  const draw = () => {
    const {plot, list} = drawn.current;
    if (!plot || !list || plot.held) return;
    const [from, to] = shown_span(window_s, range);
    if (!Number.isFinite(to)) return;
    plot.setData(drawn_rows(list, from, to), false);
    plot.bare = !list.some((series) => has_samples(series, from, to));
    plot.setScale('x', {min: from, max: to});
  };
  drawn.current.on_zoom = on_zoom;
  slow.value;
  // At once: what came after the page's next picture would be put together by itself.
  useLayoutEffect(draw);
  useEffect(() => pins.subscribe(() => drawn.current.plot?.redraw(false)), []);
  useEffect(() => whole.subscribe(() => {
    if (!drawn.current.plot) return;
    drawn.current.plot.zoomed = {};
    drawn.current.plot.redraw();
  }), []);
  const edges = drawn.current.plot?.bbox, ratio = devicePixelRatio || 1;
  return html`<div class="plot" ref=${node} data-test="plot" style=${names.length ? undefined : {display: 'none'}} />
    ${named.length ? html`<${StateLanes} names=${named} window_s=${window_s} range=${range} left=${edges ? edges.left / ratio : 110}
      right=${edges ? (size?.width ?? 0) - (edges.left + edges.width) / ratio : 12} />` : null}`;
}

/// The least or the most of the statistics, and when that was.
const Extreme = ({what, value, t}) => html`<button class="extreme" data-test=${what} title=${`the ${what}, at ${clock_text(t, 3)}: a click puts the cursor there`}
  onClick=${() => put(t)}>${value} <small>at ${clock_text(t, 1)}</small></button>`;

/// What the curves are, with their newest values, or those at the cursor; stale ones are grey. With `window` ([from, to]) also what the
/// samples in it, or between two pinned cursors, have in common. Where that is `frozen`, nothing is told of what came after it.
export function Legend({names, brief, on_remove, about = nothing, window = null, frozen = false}) {
  slow.value;
  const [first, last] = pins.value;
  const pinned = window && last === undefined && first >= window[0] && first <= window[1] ? first : null;
  const at = cursor_t.value ?? pinned, when = at ?? (frozen ? window[1] : null);
  const span = last !== undefined ? [first, last] : window;
  const curves = names.filter((name) => !is_named(name));
  // The title of a small plot says the unit, unless its curves have several.
  const units = !brief || new Set(names.map((name) => column_of(name)?.unit)).size > 1;
  return html`<div class=${`legend ${brief ? 'brief' : ''}`} data-test="legend">${names.map((name, place) => {
    const i = is_named(name) ? place : curves.indexOf(name);
    const column = column_of(name), newest = newest_of(name), [before, own] = curve_words(name);
    const look = look_of(name, about.looks?.[i]), problem = is_reckoned(name) ? reckoned(name).problem : null;
    const words = (value) => value === undefined ? '–' : is_named(name) ? value_text(column?.type === 'BOOL' ? value === 1 || value === true : value, column) : about.digits?.[i] >= 0 ? fixed_text(value, about.digits[i]) : quantity_text(value, column?.unit);
    const value = when === null ? newest.v : value_at(name, when);
    const told = span && !brief && !is_named(name) ? statistics(name, ...span) : null;
    const apart = last !== undefined && !is_named(name) ? value_at(name, last) - value_at(name, first) : NaN;
    return html`<span class=${at !== null ? 'at' : newest.stale && !frozen ? 'stale' : ''} title=${name}><svg viewBox="0 0 12 6" aria-hidden="true"><path d="M0 3h12" stroke=${curve_colour(i, about.looks?.[i])}
      stroke-width="2" stroke-dasharray=${look?.dash ? '3 2' : undefined} /></svg>${about.labels?.[i] ?? (brief ? name.split('.').at(-1) : html`<small>${before}</small> ${own}`)} <b title=${when === null ? undefined : `at ${clock_text(when, 3)}`}>${
      problem ?? words(value)}</b>${!units ? null : html` <small>${unit_text(column?.unit)}</small>`}
      ${Number.isFinite(apart) ? html` <span data-test="delta">Δ ${quantity_text(apart, column?.unit)}</span>` : null}
      ${told ? html` <span class="statistics"><${Extreme} what="least" value=${quantity_text(told.min, column?.unit)} t=${told.min_t} /> … <${Extreme} what="most" value=${quantity_text(told.max, column?.unit)} t=${told.max_t} />, mean ${quantity_text(told.mean, column?.unit)}</span>` : null}
      ${on_remove ? html`<button class="tiny" title=${`take ${name} out`} onClick=${() => on_remove(name)}>×</button>` : null}</span>`;
  })}</div>`;
}

/// When, how far apart, and what happened there: for all plots of a view.
export function Cursors() {
  const at = cursor_t.value, [first, last] = pins.value;
  if (at === null && first === undefined) return html`<span class="cursors">click: cursor, drag: zoom, wheel: heights, double click: all</span>`;
  const near = at === null ? null : marks_in(at - 0.15, at + 0.15).sort((a, b) => Math.abs(a.t - at) - Math.abs(b.t - at))[0];
  return html`<span class="cursors" data-test="cursors">${at !== null ? clock_text(at, 3) : ''}${first !== undefined ? html` from <b>${clock_text(first, 3)}</b>` : null}${
    last !== undefined ? html` to <b>${clock_text(last, 3)}</b>, ${(last - first).toFixed(3)} s` : null}${near ? html` · ${near.words}` : null}
    ${first !== undefined ? html`<button class="tiny" aria-label="take the cursors away" onClick=${unpin}>×</button>` : null}</span>`;
}

/// One parameter over another, newest samples brightest.
export function XyPlot({names, window_s = 60, range = null}) {
  const node = useRef(null);
  const canvas = useRef(null);
  const used = useRef([]);
  const size = useSize(node);
  useEffect(() => {
    used.current = names.slice(0, 2).map((name) => use_series(name, window_s));
    return () => used.current.forEach(drop_series);
  }, [names.join('|'), window_s, began_s()]);
  slow.value;
  useEffect(() => {
    if (size && used.current.length === 2) draw_xy(canvas.current, size, used.current, names, shown_span(window_s, range));
  });
  return html`<div class="plot" ref=${node} onDblClick=${show_all}>${names.length < 2 ? html`<p class="empty">x-y needs two parameters.</p>` : null}
    <canvas ref=${canvas} /></div>`;
}

function xy_points([a, b], [from, to]) {
  const points = [];
  let j = 0;
  for (let i = 0; i < a.t.length; ++i) {
    if (a.t[i] < from || a.t[i] > to || a.v[i] === null) continue;
    while (j + 1 < b.t.length && b.t[j + 1] <= a.t[i]) ++j;
    if (b.v[j] !== null && b.v[j] !== undefined && Math.abs(b.t[j] - a.t[i]) < 1) points.push([a.v[i], b.v[j]]);
  }
  return points;
}

function nice_ticks(low, high, count) {
  const raw = (high - low) / count, unit = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * unit).find((s) => s >= raw);
  const ticks = [];
  for (let at = Math.ceil(low / step) * step; at <= high + step * 1e-9; at += step) ticks.push(at);
  return ticks;
}

function draw_xy(canvas, size, list, names, range) {
  const ratio = devicePixelRatio || 1;
  canvas.width = size.width * ratio;
  canvas.height = size.height * ratio;
  canvas.style.width = `${size.width}px`;
  canvas.style.height = `${size.height}px`;
  const ctx = canvas.getContext('2d');
  ctx.scale(ratio, ratio);
  const points = xy_points(list, range);
  ctx.font = font;
  ctx.fillStyle = colour('faint');
  if (points.length < 2) return ctx.fillText('no samples yet', 20, 24);
  const box = {left: 62, top: 10, width: size.width - 76, height: size.height - 50};
  const bounds = [0, 1].map((k) => {
    let low = Infinity, high = -Infinity;
    for (const point of points) { low = Math.min(low, point[k]); high = Math.max(high, point[k]); }
    const pad = (high - low || Math.abs(high) || 1) * 0.06;
    return [low - pad, high + pad];
  });
  const x = (value) => box.left + (value - bounds[0][0]) / (bounds[0][1] - bounds[0][0]) * box.width;
  const y = (value) => box.top + box.height - (value - bounds[1][0]) / (bounds[1][1] - bounds[1][0]) * box.height;
  ctx.strokeStyle = colour('line');
  ctx.textAlign = 'center';
  for (const tick of nice_ticks(...bounds[0], box.width / 90)) {
    ctx.beginPath(); ctx.moveTo(x(tick), box.top); ctx.lineTo(x(tick), box.top + box.height); ctx.stroke();
    ctx.fillText(brief_text(+tick.toPrecision(5)), x(tick), box.top + box.height + 15);
  }
  ctx.textAlign = 'right';
  for (const tick of nice_ticks(...bounds[1], box.height / 40)) {
    ctx.beginPath(); ctx.moveTo(box.left, y(tick)); ctx.lineTo(box.left + box.width, y(tick)); ctx.stroke();
    ctx.fillText(brief_text(+tick.toPrecision(5)), box.left - 6, y(tick) + 4);
  }
  ctx.textAlign = 'center';
  const labels = names.map((name) => `${short_name(name)} ${unit_text(column_of(name)?.unit) && `[${unit_text(column_of(name)?.unit)}]`}`);
  ctx.fillText(labels[0], box.left + box.width / 2, size.height - 6);
  ctx.save(); ctx.translate(12, box.top + box.height / 2); ctx.rotate(-Math.PI / 2); ctx.fillText(labels[1], 0, 0); ctx.restore();
  const parts = 8;
  ctx.strokeStyle = curve_colour(0);
  ctx.lineWidth = 1.4;
  for (let part = 0; part < parts; ++part) {
    const first = Math.floor(points.length * part / parts), end = Math.floor(points.length * (part + 1) / parts);
    ctx.globalAlpha = 0.15 + 0.85 * (part + 1) / parts;
    ctx.beginPath();
    for (let i = Math.max(0, first - 1); i < end; ++i) ctx.lineTo(x(points[i][0]), y(points[i][1]));
    ctx.stroke();
  }
  ctx.fillStyle = colour('text');
  const last = points[points.length - 1];
  ctx.beginPath(); ctx.arc(x(last[0]), y(last[1]), 3.5, 0, 7); ctx.fill();
}
