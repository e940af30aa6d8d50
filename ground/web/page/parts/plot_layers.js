// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What stands behind and above the curves of a plot: gaps, limits, what was commanded and what happened, the stop, the pinned cursors, the
// whole range of a joint. Each is a plugin of uPlot.
import {fixed_text} from '../format.js';
import {stop} from '../stop_story.js';
import {columns, commands, events, gaps, outcome_of, values} from '../store.js';
import {colour} from '../theme.js';
import {pins} from './plot_cursor.js';

const inside = (plot, draw) => {
  const {ctx, bbox} = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw(ctx, bbox, (t) => plot.valToPos(t, 'x', true));
  ctx.restore();
};

/// Gaps of the archive stand grey behind the curves: a line through them would be a lie.
export const gap_shade = {hooks: {drawClear: (plot) => inside(plot, (ctx, bbox, x) => {
  ctx.fillStyle = 'rgba(142, 154, 179, 0.12)';
  for (const gap of gaps.peek()) ctx.fillRect(x(gap.from), bbox.top, x(gap.to) - x(gap.from), bbox.height);
})}};

/// A line and a red field from the moment on at which something stopped.
export const stop_mark = {hooks: {draw: (plot) => inside(plot, (ctx, bbox, x) => {
  const told = stop.peek();
  if (!told || x(told.t) < bbox.left) return;
  ctx.fillStyle = 'rgba(255, 90, 80, .10)';
  ctx.fillRect(x(told.t), bbox.top, bbox.width, bbox.height);
  ctx.fillStyle = colour('red');
  ctx.fillRect(x(told.t) - 1, bbox.top, 2, bbox.height);
})}};

/// Beyond the limits that the descriptor gives a parameter, where they are in sight.
export const limit_bands = (names) => ({hooks: {drawClear: (plot) => inside(plot, (ctx, bbox) => {
  const drawn = new Set();
  names.forEach((name, i) => {
    const column = columns.peek().get(name), scale = plot.series[3 * i + 1]?.scale;
    if (!column || column.enumeration?.length || column.type === 'BOOL') return;
    for (const [limit, below] of [[column.min, true], [column.max, false]]) {
      const key = `${scale} ${limit} ${below}`;
      if (!Number.isFinite(limit) || drawn.has(key)) continue;
      drawn.add(key);
      const y = plot.valToPos(limit, scale, true);
      if (y < bbox.top || y > bbox.top + bbox.height) continue;
      ctx.fillStyle = colour('ochre');
      ctx.globalAlpha = 0.16;
      if (below) ctx.fillRect(bbox.left, y, bbox.width, bbox.top + bbox.height - y);
      else ctx.fillRect(bbox.left, bbox.top, bbox.width, y - bbox.top);
      ctx.globalAlpha = 1;
      ctx.fillRect(bbox.left, y - 0.5, bbox.width, 1);
    }
  });
})}});

const most_marks = 200;
/// What was commanded and what happened in what is shown: {t, words, look}.
export function marks_in(from, to) {
  const told = events.peek().filter((one) => one.severity !== 'info' && one.t >= from && one.t <= to).slice(0, most_marks)
      .map((one) => ({t: one.t, look: one.severity, words: `${one.subsystem} ${one.name}`}));
  const sent = commands.peek().filter((one) => one.t >= from && one.t <= to).slice(0, most_marks)
      .map((one) => ({t: one.t, look: 'command', words: `${one.subsystem} ${one.function} ${outcome_of(one).stage}`}));
  return [...told, ...sent];
}

const mark_colours = {high: 'red', medium: 'amber', low: 'low', command: 'blue'};
/// They stand at the upper edge, with a thin line down to the curves.
export const event_marks = {hooks: {draw: (plot) => inside(plot, (ctx, bbox, x) => {
  const ratio = devicePixelRatio || 1;
  for (const {t, look} of marks_in(plot.scales.x.min, plot.scales.x.max)) {
    ctx.fillStyle = colour(mark_colours[look]);
    ctx.globalAlpha = 0.35;
    ctx.fillRect(x(t) - 0.5, bbox.top, 1, bbox.height);
    ctx.globalAlpha = 1;
    ctx.beginPath();
    ctx.moveTo(x(t) - 4 * ratio, bbox.top);
    ctx.lineTo(x(t) + 4 * ratio, bbox.top);
    ctx.lineTo(x(t), bbox.top + 6 * ratio);
    ctx.fill();
  }
})}};

export const pinned_cursors = {hooks: {draw: (plot) => inside(plot, (ctx, bbox, x) => {
  const [first, last] = pins.peek();
  if (first === undefined) return;
  ctx.fillStyle = colour('blue');
  if (last !== undefined) {
    ctx.globalAlpha = 0.1;
    ctx.fillRect(x(first), bbox.top, x(last) - x(first), bbox.height);
    ctx.globalAlpha = 1;
  }
  for (const t of [first, last]) if (t !== undefined) ctx.fillRect(x(t) - 0.5, bbox.top, 1, bbox.height);
})}};

/// Where there is nothing to be drawn it says so, and no axis is made up.
export const bare = {hooks: {draw: ({bare: is_bare, ctx, bbox}) => {
  if (!is_bare) return;
  ctx.save();
  ctx.fillStyle = colour('faint');
  ctx.font = `${12 * (devicePixelRatio || 1)}px Inter`;
  ctx.textAlign = 'center';
  ctx.fillText('no samples here', bbox.left + bbox.width / 2, bbox.top + bbox.height / 2);
  ctx.restore();
}}};

/// The whole range of a parameter beside its curve: where its ends are, what part the plot shows, where it stands now.
export const gauge = ([low, high], name) => ({hooks: {draw: (plot) => {
  const {ctx, bbox} = plot, ratio = devicePixelRatio || 1;
  const scale = plot.scales[plot.series[1].scale];
  const x = bbox.left + bbox.width + 30 * ratio, wide = 6 * ratio, tall = bbox.height;
  const y = (value) => bbox.top + tall * (1 - Math.max(0, Math.min(1, (value - low) / (high - low))));
  const now = values.get(name)?.v, end = (high - low) * 0.05;
  const near = Number.isFinite(now) && (now - low < end || high - now < end);
  ctx.save();
  ctx.fillStyle = colour('come');
  ctx.fillRect(x - wide / 2, bbox.top, wide, tall);
  ctx.fillStyle = colour(near ? 'amber' : 'ochre');
  ctx.fillRect(x - wide / 2, bbox.top, wide, tall * 0.05);
  ctx.fillRect(x - wide / 2, bbox.top + tall * 0.95, wide, tall * 0.05);
  ctx.fillStyle = colour('edge');
  if (!plot.bare) ctx.fillRect(x - wide / 2, y(scale.max), wide, Math.max(2, y(scale.min) - y(scale.max)));
  if (Number.isFinite(now)) {
    ctx.fillStyle = colour(near ? 'amber' : 'measured');
    ctx.beginPath();
    ctx.moveTo(x - 4 * ratio, y(now));
    ctx.lineTo(x - 10 * ratio, y(now) - 4 * ratio);
    ctx.lineTo(x - 10 * ratio, y(now) + 4 * ratio);
    ctx.fill();
  }
  ctx.fillStyle = colour('faint');
  ctx.font = `${11 * ratio}px Inter`;
  ctx.textAlign = 'center';
  const digits = high - low < 20 ? 1 : 0;
  ctx.fillText(fixed_text(high, digits), x, bbox.top - 4 * ratio);
  ctx.fillText(fixed_text(low, digits), x, bbox.top + tall + 13 * ratio);
  ctx.restore();
}}});
