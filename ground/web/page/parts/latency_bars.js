// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// How long the samples of a link took until they were used, beside what they may take: bars as its consumer counts them on board (docs/adr/0141). Their bounds are parts of
// the period of the producer, so that fast and slow links read alike.
import {duration_text} from '../format.js';
import {html} from '../html.js';
import {mission, status_of, subsystem_of} from '../store.js';
import {bounds, height_of, is_kept, late_count, place_of, quantile_ns} from './latency.js';
import {live_link} from './link_graph.js';

const of_bound = ['1/64', '1/32', '1/16', '1/8', '1/4', '1/2', '1', '2'];
const width = 270, foot = 44, step = width / (bounds.length + 1);

/// Of who uses the link, in ns; NaN while its configuration is not known.
function cycle_ns(link) {
  const now = status_of(link.to), configuration = subsystem_of(link.to)?.configurations?.find((one) => one.name === now?.configuration);
  return 1e9 / (configuration?.sampling_hz || NaN);
}

function Bars({link}) {
  const now = live_link(link.id), told = now.up === true ? now.latencies : null;
  if (!told) return null;
  const all = told.counts.reduce((sum, count) => sum + count, 0), most = Math.max(...told.counts), cycle = cycle_ns(link);
  // Who looks more seldom than samples come finds them as old as his own cycles. Two machines that cycle at the same instants find each other's sample a cycle old, and
  // as much more as their start was late: only what takes two has missed one.
  const one = Math.max(told.period_ns, cycle || 0), budget = 2 * one, limit = link.age_limit_cycles * cycle, late = late_count(told, budget);
  // A sample that came late is not one that was lacking: the limit says.
  const kept = is_kept(now.latency_max_ns, limit, budget);
  const quantiles = [0.5, 0.99].map((part) => quantile_ns(told, part, now.latency_max_ns ?? Infinity));
  const words = `${all} samples, half of them within ${duration_text(quantiles[0])}, 99 % within ${duration_text(quantiles[1])}, longest ${duration_text(now.latency_max_ns ?? NaN)}, ${late} later than ${duration_text(budget)}`;
  return html`<figure class="latency" data-test=${`bars-${link.id}`}>
    <figcaption class="row"><b title=${link.provides}>${link.provides ?? `link ${link.id}`}</b><small>${link.from} → ${link.to}</small></figcaption>
    <svg viewBox=${`0 0 ${width} 64`} role="img" aria-label=${words}>
      ${told.counts.map((count, i) => html`<rect class=${!kept && i > 0 && bounds[i - 1] * told.period_ns >= budget ? 'late' : ''} x=${i * step + 1.5} y=${foot - 40 * height_of(count, most)} width=${step - 3} height=${40 * height_of(count, most)}>
        <title>${`${count} ${i < bounds.length ? `within ${duration_text(bounds[i] * told.period_ns)} (${of_bound[i]} of a period)` : `longer than ${duration_text(2 * told.period_ns)}`}`}</title></rect>`)}
      <path class="foot" d=${`M0 ${foot + 0.5}H${width}`} />
      <path class="budget" d=${`M${place_of(one, told.period_ns) * step} 0V${foot + 4}`} />
      ${Number.isFinite(limit) && limit > budget ? html`<path class="limit" d=${`M${place_of(limit, told.period_ns) * step} 0V${foot + 4}`}><title>${`limit: ${duration_text(limit)}`}</title></path>` : null}
      ${[0, 2, 4, 6].map((i) => html`<text class=${i === 6 ? 'here' : ''} x=${(i + 1) * step} y="59">${duration_text(bounds[i] * told.period_ns)}</text>`)}
    </svg>
    <p class="row"><span>half ≤ <b>${duration_text(quantiles[0])}</b></span><span>99 % ≤ <b data-test=${`p99-${link.id}`}>${duration_text(quantiles[1])}</b></span><span>max <b>${duration_text(now.latency_max_ns ?? NaN)}</b></span><small>${all.toLocaleString('en')}</small></p>
    ${late ? html`<p class=${kept ? '' : 'late'}>${late.toLocaleString('en')} later than two cycles, ${duration_text(budget)}${kept ? '; none beyond the limit' : ''}</p>` : null}
  </figure>`;
}

export function LatencyBars() {
  const links = mission.value?.links ?? [], told = links.filter((link) => live_link(link.id).up === true && live_link(link.id).latencies);
  const silent = links.filter((link) => live_link(link.id).up === true && !live_link(link.id).latencies);
  return html`${told.map((link) => html`<${Bars} key=${link.id} link=${link} />`)}
    ${told.length ? html`<p class="about">Counted on board since the link was made; ten times as many samples are one step higher. Line: one cycle of who sends, or of who uses it where that is longer. Dashed: the limit, older the newest sample must not be. Amber: later than two cycles, where it was not kept.</p>` : html`<p class="empty">No link that is up tells how long its samples take.</p>`}
    ${told.length && silent.length ? html`<p class="about">Not told: ${silent.map((link) => link.provides ?? `link ${link.id}`).join(', ')}</p>` : null}`;
}
