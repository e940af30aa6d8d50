// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useRef, useState} from 'preact/hooks';
import {token} from '../api.js';
import {copy, say} from '../commanding.js';
import {clock_text, iso_text, unit_text} from '../format.js';
import {html} from '../html.js';
import {column_of, curve_words, flight_title, in_flight, is_reckoned, of_flight, parameters_of, pictured, program_of} from '../parts/curves.js';
import {longest_text} from '../parts/expression.js';
import {Panel} from '../parts/panel.js';
import {save} from '../parts/save.js';
import {Cursors, curve_colour, Legend, TimePlot, XyPlot} from '../parts/plot.js';
import {whole} from '../parts/plot_cursor.js';
import {Splits} from '../parts/splits.js';
import {is_named} from '../parts/state_lanes.js';
import {aligned} from '../parts/rows.js';
import {shown_span, whole_flight} from '../series.js';
import {columns, flight, flights, mission, now_s, replay, slow} from '../store.js';
import {colour} from '../theme.js';
import {first_plots, plot_title} from './overview.js';

const windows = [[10, '10 s'], [30, '30 s'], [60, '1 min'], [300, '5 min'], [900, '15 min'], [3600, '1 h'], [whole_flight, 'whole flight']];
const flight_word = 'flight';

const decoded = (text) => { try { return decodeURIComponent(text); } catch { return text; } };
/// #/plots?p=A+B|C&w=60&xy=1: groups divided by |, names of curves (parts/curves.js) by +; w in seconds, or `flight`.
export function parsed(query) {
  const groups = (query.get_raw('p') ?? '').split('|').map((group) => group.split('+').filter(Boolean).map(decoded)).filter((group) => group.length);
  return {groups, window_s: query.get_raw('w') === flight_word ? whole_flight : Number(query.get_raw('w')) || 60, xy: new Set((query.get_raw('xy') ?? '').split(',').filter(Boolean).map(Number))};
}

function address({groups, window_s, xy}) {
  const p = groups.map((group) => group.map(encodeURIComponent).join('+')).join('|');
  return `#/plots?p=${p}&w=${window_s === whole_flight ? flight_word : window_s}${xy.size ? `&xy=${[...xy].join(',')}` : ''}`;
}

/// The picture with what it is of: mission, day, the names of the curves in their colours.
function save_png(plot, names, [from, to]) {
  const source = plot.ctx.canvas, ratio = devicePixelRatio || 1, line = 18 * ratio;
  const canvas = document.createElement('canvas');
  canvas.width = source.width;
  canvas.height = source.height + (2.5 + names.length) * line;
  const ctx = canvas.getContext('2d');
  ctx.fillStyle = colour('panel');
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.font = `${12 * ratio}px Inter`;
  ctx.fillStyle = colour('text');
  ctx.fillText(`${mission.peek().name}, ${iso_text(from) || clock_text(from, 3)} to ${iso_text(to) || clock_text(to, 3)}`, 10 * ratio, line);
  ctx.drawImage(source, 0, 1.5 * line);
  names.forEach((name, i) => {
    const y = source.height + (2 + i) * line + 0.5 * line;
    ctx.fillStyle = curve_colour(i);
    ctx.fillRect(10 * ratio, y - 4 * ratio, 16 * ratio, 2 * ratio);
    ctx.fillStyle = colour('text');
    ctx.fillText(`${curve_words(name).join(' ')} ${unit_text(column_of(name)?.unit)}`, 34 * ratio, y);
  });
  canvas.toBlob((blob) => save(`${names[0]}.png`, blob));
}

function save_csv(list, names, range) {
  const rows = aligned(list, ...range);
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const lines = [['t', 'utc', ...names].map(quoted).join(',')];
  for (let i = 0; i < rows[0].length; ++i) {
    lines.push([rows[0][i].toFixed(6), iso_text(rows[0][i]), ...names.map((_, k) => rows[1 + 3 * k][i] ?? '')].join(','));
  }
  save(`${names[0]}.csv`, new Blob([lines.join('\n'), '\n'], {type: 'text/csv'}));
}

function PlotPanel({names, window_s, range, xy, on_zoom, on_remove, on_xy, on_drop}) {
  const plot_ref = useRef(null);
  const curves = names.filter((name) => !is_named(name));
  if (!range) slow.value;
  const shown = shown_span(window_s, range);
  const whole = `/api/export.csv?${[...new Set(names.flatMap(parameters_of))].map((name) => `parameter=${encodeURIComponent(name)}`).join('&')}&from=${shown[0]}&to=${shown[1]}`;
  const fetch_whole = async () => {
    try {
      const answer = await fetch(whole, {headers: {Authorization: `Bearer ${token()}`}});
      if (!answer.ok) throw new Error((await answer.json().catch(() => ({}))).error ?? `HTTP ${answer.status}`);
      save(`${names[0]}-archive.csv`, await answer.blob());
    } catch (error) {
      say(`archive: ${error.message}`, 'bad');
    }
  };
  const tools = html`
    <button class=${`chip ${xy ? 'on' : ''}`} disabled=${names.length < 2} title="the second parameter over the first" onClick=${on_xy}>x-y</button>
    <button class="chip" disabled=${xy} onClick=${() => plot_ref.current && save_png(plot_ref.current.plot, curves, shown)}>PNG</button>
    <button class="chip" disabled=${xy} title="the samples shown" onClick=${() => plot_ref.current && save_csv(plot_ref.current.list, curves, shown)}>CSV</button>
    <button class="chip" title="every sample of the archive, of the parameters themselves" onClick=${fetch_whole}>archive CSV</button>
    <button class="tiny" title="close this plot" aria-label="close this plot" onClick=${on_drop}>×</button>`;
  return html`<${Panel} title=${plot_title(names)} bare tools=${tools}>
    <${Legend} names=${names} on_remove=${on_remove} window=${shown} frozen=${Boolean(range)} />
    ${xy ? html`<${XyPlot} names=${names} window_s=${window_s} range=${range} />` :
      html`<${TimePlot} names=${names} window_s=${window_s} range=${range} on_zoom=${on_zoom} plot_ref=${plot_ref} />`}</${Panel}>`;
}

const most_others = 30;
/// The number of the flight that is shown: that of now, or the one that is replayed.
const shown_flight = () => replay.value ? flights.value.find((one) => one.from <= now_s())?.id : flight.value?.id;

const long_array = 8;

/// [[NAME, its elements]]: a number is an array of one.
function by_base(list) {
  const found = new Map();
  for (const column of list) {
    const base = column.name.replace(/\[\d+\]$/, '');
    found.set(base, [...(found.get(base) ?? []), column]);
  }
  return [...found.entries()];
}

/// An expression is written here, with names that are clicked beside; what is wrong stands below.
function Writer({text, set_text, node, on_pick}) {
  const [wrong, set_wrong] = useState('');
  const take = (event) => {
    event.preventDefault();
    try {
      program_of(text);
    } catch (error) {
      node.current.focus();
      if (Number.isFinite(error.at)) node.current.setSelectionRange(error.at, error.at);
      return set_wrong(error.message);
    }
    on_pick(`=${text.trim()}`, event.submitter?.value === 'alone');
    set_text(null);
  };
  return html`<form class="writer" onSubmit=${take}>
    <textarea ref=${node} rows="3" maxlength=${longest_text} data-test="expression" aria-label="expression" aria-invalid=${Boolean(wrong)} placeholder="click parameters; numbers and + − * / ^ ( ), abs, min, max, hypot, deg …" value=${text}
      onInput=${(event) => { set_text(event.currentTarget.value); set_wrong(''); }} onKeyDown=${(event) => { if (event.key === 'Enter') { event.preventDefault(); event.currentTarget.form.requestSubmit(); } }} />
    ${wrong ? html`<p class="wrong" role="alert" data-test="expression-wrong">${wrong}</p>` : null}
    <div class="row"><button class="chip" data-test="expression-plot">plot</button><button class="chip" value="alone">as a new plot</button>
      <span class="space" /><button type="button" class="chip" onClick=${() => set_text(null)}>cancel</button></div></form>`;
}

function Picker({on_pick: pick}) {
  const [search, set_search] = useState('');
  const [text, set_text] = useState(null), node = useRef(null);
  const on_pick = (name, alone) => {
    if (text === null || !node.current) return pick(name, alone);
    const {selectionStart: from, selectionEnd: to} = node.current, before = text.slice(0, from);
    const word = `${/[\w\])]$/.test(before) ? ' ' : ''}${name}`;
    set_text(before + word + text.slice(to));
    requestAnimationFrame(() => { node.current?.focus(); node.current?.setSelectionRange(from + word.length, from + word.length); });
  };
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  const found = [...columns.value.values()].filter((column) => column.type !== 'TEXT' && words.every((word) => column.name.toLowerCase().includes(word)));
  // The mission's own subsystems before those that every mission has.
  const own = mission.value?.subsystems.filter((one) => one.id >= 10) ?? [], common = mission.value?.subsystems.filter((one) => one.id < 10) ?? [];
  const groups = [...own, ...common].map(({name}) => [name, by_base(found.filter((column) => column.subsystem === name))]).filter(([, list]) => list.length);
  // What the robot's picture shows as one number stands first.
  const numbers = text !== null ? [] : [...pictured.value].filter(([name, one]) => !parameters_of(name).some((known) => !columns.value.has(known)) && words.every((word) => `${one.subsystem} ${one.words}`.toLowerCase().includes(word)));
  const button = (column, name) => html`<button class="action" title=${`${column.name}: a click adds it, with Shift in a plot of its own`} onClick=${(event) => on_pick(column.name, event.shiftKey)}><span>${
    column.name.slice(name.length + 1)}</span><small>${unit_text(column.unit)}</small></button>`;
  return html`<${Panel} title="Parameters" hint=${text === null ? null : 'click: its name'}
    tools=${text === null ? html`<button class="chip" title="plot what is reckoned of parameters" data-test="expression-open" onClick=${() => set_text('')}>f(x)</button>` : null}>
    ${text === null ? null : html`<${Writer} text=${text} set_text=${set_text} node=${node} on_pick=${pick} />`}
    <input class="search" type="search" placeholder="search  /" aria-label="search parameters" data-search value=${search} onInput=${(event) => set_search(event.currentTarget.value)} />
    ${numbers.length ? html`<div class="group" data-test="pictured"><h3>in the picture</h3>${numbers.map(([name, one]) => html`<button class="action" key=${name} title=${`${name.slice(1)}: a click adds it, with Shift in a plot of its own`}
      onClick=${(event) => on_pick(name, event.shiftKey)}><span>${one.words}</span><small>${unit_text(column_of(name)?.unit)}</small></button>`)}</div>` : null}
    ${groups.map(([name, list]) => html`<div class="group" key=${name}><h3>${name}</h3>${list.map(([base, elements]) =>
      elements.length < long_array || words.length ? elements.map((column) => button(column, name)) :
      html`<details><summary class="action" title=${base}><span>${base.slice(name.length + 1)}</span><small>${elements.length}×</small></summary>${elements.map((column) => button(column, name))}</details>`)}</div>`)}
  </${Panel}>`;
}

export function Plots({query, paused, set_paused}) {
  const asked = parsed(query);
  const state = asked.groups.length ? asked : {...asked, groups: first_plots().map((plot) => plot.names)};
  const [zoom, set_zoom] = useState(null);
  const go = (change) => { location.hash = address({...state, ...change}); };
  const range = zoom ?? (paused !== null ? shown_span(state.window_s, null, paused) : null);
  useEffect(() => whole.subscribe(() => set_zoom(null)), []);
  const pick = (name, alone) => {
    const groups = state.groups.map((group) => [...group]);
    if (alone || groups.length === 0) groups.push([name]);
    else if (!groups[groups.length - 1].includes(name)) groups[groups.length - 1].push(name);
    go({groups});
  };
  const others = flights.value.filter((one) => one.id !== shown_flight()).slice(0, most_others);
  const compared = others.find((one) => state.groups.some((group) => group.some((name) => name.endsWith(`@${one.id}`))))?.id;
  const compare = (id) => go({groups: state.groups.map((group) => {
    const own = group.filter((name) => is_reckoned(name) || of_flight(name)[1] === null);
    return id ? [...own, ...own.map((name) => in_flight(name, id)).filter(Boolean)] : own;
  })});
  return html`<main class="plots"><${Splits} name="plots" rows=${false} />
    <${Picker} on_pick=${pick} />
    <div class="column">
      <div class="toolbar">
        ${windows.map(([seconds, text]) => html`<button class=${`chip ${!zoom && state.window_s === seconds ? 'on' : ''}`}
          onClick=${() => { set_zoom(null); go({window_s: seconds}); }}>${text}</button>`)}
        <button class=${`chip ${paused !== null ? 'on' : ''}`} title="Space" data-test="pause" onClick=${() => set_paused(paused === null ? now_s() : null)}>
          ${paused !== null ? 'paused' : 'pause'}</button>
        ${zoom || paused !== null ? html`<button class="chip" onClick=${() => { set_zoom(null); set_paused(null); }}>follow</button>` : null}
        ${others.length ? html`<select aria-label="compare with another flight" title="the same curves of another flight, as if it had begun with this one" data-test="compare" value=${compared ?? ''} onChange=${(event) => compare(event.currentTarget.value)}>
          <option value="">no other flight</option>${others.map((one) => html`<option value=${one.id}>${`beside ${flight_title(one.id)}`}</option>`)}</select>` : null}
        <span class="space" />${zoom ? html`<small>${clock_text(zoom[0], 3)} … ${clock_text(zoom[1], 3)}</small>` : null}<${Cursors} />
        <button class="chip" onClick=${() => copy(location.href, 'address copied')}>copy address</button>
      </div>
      ${state.groups.map((names, i) => html`<${PlotPanel} key=${`${i}/${names.join()}`} names=${names} window_s=${state.window_s} range=${range}
        xy=${state.xy.has(i)} on_zoom=${set_zoom}
        on_xy=${() => { const xy = new Set(state.xy); xy.has(i) ? xy.delete(i) : xy.add(i); go({xy}); }}
        on_remove=${(name) => go({groups: state.groups.map((group, k) => k === i ? group.filter((one) => one !== name) : group).filter((group) => group.length)})}
        on_drop=${() => go({groups: state.groups.filter((_, k) => k !== i)})} />`)}
      ${state.groups.length ? null : html`<p class="empty">Pick a parameter on the left.</p>`}
    </div></main>`;
}
