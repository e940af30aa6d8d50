// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import uPlot from 'uplot';
import {brief_text, clock_text, number_text, unit_text} from '../format.js';
import {html} from '../html.js';
import {aligned, drop_series, extend, use_series} from '../series.js';
import {columns, freshness, gaps, now_s, replay, slow, values} from '../store.js';

export const colours = ['#5aa9ff', '#ffb454', '#4fd69c', '#ff7eb6', '#b69cff', '#5fd7e8', '#ffe066', '#ff8f70'];
const axis_colour = '#8e9ab3', grid_colour = '#1c2438';
const font = '11px system-ui, "DejaVu Sans", sans-serif';

const short_name = (name) => name.split('.').slice(1).join('.') || name;

const axis_of_time = {
  stroke: axis_colour, grid: {stroke: grid_colour, width: 1}, ticks: {stroke: grid_colour, width: 1, size: 4}, font,
  space: 80, size: 26,
  values: (_, splits) => splits.map((t) => clock_text(t, splits[1] - splits[0] < 1 ? 1 : 0)),
};

function axis_of(unit, index) {
  return {scale: unit, side: index % 2 ? 1 : 3, stroke: axis_colour, font, size: 52, label: unit_text(unit) || 'value',
    labelSize: 14, labelFont: font, labelGap: 0, ticks: {stroke: grid_colour, width: 1, size: 4},
    grid: {show: index === 0, stroke: grid_colour, width: 1},
    values: (_, splits) => splits.map((value) => brief_text(+value.toPrecision(6)))};
}

/// Gaps of the archive stand grey behind the curves: a line through them would be a lie.
const gap_shade = {hooks: {drawClear: (plot) => {
  const {ctx, bbox} = plot;
  ctx.save();
  ctx.fillStyle = 'rgba(142, 154, 179, 0.12)';
  for (const gap of gaps.peek()) {
    const left = Math.max(bbox.left, plot.valToPos(gap.from, 'x', true));
    const right = Math.min(bbox.left + bbox.width, plot.valToPos(gap.to, 'x', true));
    if (right > left) ctx.fillRect(left, bbox.top, right - left, bbox.height);
  }
  ctx.restore();
}}};

const sync = uPlot.sync('hirosco');

function options_of(names, size, on_zoom) {
  const units = [...new Set(names.map((name) => columns.peek().get(name)?.unit ?? ''))];
  const series = [{}];
  const bands = [];
  names.forEach((name, i) => {
    const scale = columns.peek().get(name)?.unit ?? '';
    const stepped = Boolean(columns.peek().get(name)?.enumeration?.length) || columns.peek().get(name)?.type === 'BOOL';
    const stroke = colours[i % colours.length];
    series.push({label: name, scale, stroke, width: 1.4, points: {show: false}, spanGaps: false,
      paths: stepped ? uPlot.paths.stepped({align: 1}) : undefined},
    {scale, stroke: 'transparent', points: {show: false}}, {scale, stroke: 'transparent', points: {show: false}});
    bands.push({series: [3 * i + 3, 3 * i + 2], fill: `${stroke}33`});
  });
  return {...size, series, bands, legend: {show: false}, padding: [8, units.length > 1 ? 0 : 30, 0, 0],
    scales: {x: {time: false}}, plugins: [gap_shade],
    axes: [axis_of_time, ...units.map(axis_of)],
    cursor: {sync: {key: sync.key, scales: ['x', null]}, drag: {x: true, y: false, setScale: false}, points: {size: 6}},
    hooks: {setSelect: [(plot) => {
      if (plot.select.width < 4) return;
      on_zoom([plot.posToVal(plot.select.left, 'x'), plot.posToVal(plot.select.left + plot.select.width, 'x')]);
      plot.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
    }]}};
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
export function TimePlot({names, window_s = 60, range = null, on_zoom = () => {}, plot_ref}) {
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
    [window_s, range?.[0], Number.isFinite(now_s())]);

  useEffect(() => {
    if (!size || !columns.value.size) return;
    const plot = new uPlot(options_of(names, size, (span) => drawn.current.on_zoom(span)),
      Array.from({length: 1 + 3 * names.length}, () => []), node.current);
    drawn.current.plot = plot;
    if (plot_ref) plot_ref.current = {plot, list: drawn.current.list};
    draw();
    return () => {
      plot.destroy();
      drawn.current.plot = null;
    };
  }, [key, Boolean(size), columns.value.size, live]);
  useEffect(() => { if (size) drawn.current.plot?.setSize(size); }, [size?.width, size?.height]);

  const draw = () => {
    const {plot, list} = drawn.current;
    if (!plot || !list) return;
    const to = range ? range[1] : now_s(), from = range ? range[0] : to - window_s;
    if (!Number.isFinite(to)) return;
    plot.setData(aligned(list, from, to), false);
    plot.setScale('x', {min: from, max: to});
  };
  drawn.current.on_zoom = on_zoom;
  slow.value;
  useEffect(draw);
  return html`<div class="plot" ref=${node} data-test="plot" />`;
}

const three_digits = (value) => Number.isFinite(value) ? brief_text(Math.abs(value) < 1e-3 ? 0 : +value.toPrecision(3)) : number_text(value);

/// What the curves are, with their newest values; stale ones are grey.
export function Legend({names, brief, on_remove}) {
  slow.value;
  const mixed = new Set(names.map((name) => name.split('.')[0])).size > 1;
  return html`<div class=${`legend ${brief ? 'brief' : ''}`}>${names.map((name, i) => {
    const column = columns.value.get(name);
    const {stale} = freshness(name);
    return html`<span class=${stale ? 'stale' : ''} title=${name}><i style=${{background: colours[i % colours.length]}} />
      ${brief ? html`${mixed ? html`<small>${name.slice(0, 3)}</small> ` : null}${name.split('.').at(-1)}` : html`<small>${name.split('.')[0]}</small> ${short_name(name)}`} <b>${brief ? three_digits(values.get(name)?.v) :
        number_text(values.get(name)?.v)}</b>${brief ? null : html` <small>${unit_text(column?.unit)}</small>`}
      ${on_remove ? html`<button class="tiny" title=${`take ${name} out`} onClick=${() => on_remove(name)}>×</button>` : null}</span>`;
  })}</div>`;
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
  }, [names.join('|'), window_s]);
  slow.value;
  useEffect(() => {
    if (size && used.current.length === 2) draw_xy(canvas.current, size, used.current, names, range ?? [now_s() - window_s, now_s()]);
  });
  return html`<div class="plot" ref=${node}>${names.length < 2 ? html`<p class="empty">x-y needs two parameters.</p>` : null}
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
  ctx.fillStyle = axis_colour;
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
  ctx.strokeStyle = grid_colour;
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
  const labels = names.map((name) => `${short_name(name)} ${unit_text(columns.peek().get(name)?.unit) && `[${unit_text(columns.peek().get(name)?.unit)}]`}`);
  ctx.fillText(labels[0], box.left + box.width / 2, size.height - 6);
  ctx.save(); ctx.translate(12, box.top + box.height / 2); ctx.rotate(-Math.PI / 2); ctx.fillText(labels[1], 0, 0); ctx.restore();
  const parts = 8;
  ctx.strokeStyle = colours[0];
  ctx.lineWidth = 1.4;
  for (let part = 0; part < parts; ++part) {
    const first = Math.floor(points.length * part / parts), end = Math.floor(points.length * (part + 1) / parts);
    ctx.globalAlpha = 0.15 + 0.85 * (part + 1) / parts;
    ctx.beginPath();
    for (let i = Math.max(0, first - 1); i < end; ++i) ctx.lineTo(x(points[i][0]), y(points[i][1]));
    ctx.stroke();
  }
  ctx.fillStyle = '#fff';
  const last = points[points.length - 1];
  ctx.beginPath(); ctx.arc(x(last[0]), y(last[1]), 3.5, 0, 7); ctx.fill();
}
