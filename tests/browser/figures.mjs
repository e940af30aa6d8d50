// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// figures.mjs [--minutes N]: what the ground station's page must hold, expected beside measured, on a real flight with a real gateway.
// Exits 1 when a figure is short. Started by bench/ground, on a machine that does nothing else.
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, readdirSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';
import {gzipSync} from 'node:zlib';
import {chromium} from 'playwright-core';
import {at_view, executable, flags, go, open_browser, open_page, serious_findings, until, views} from './browser.mjs';
import {fly, free_port, ground, missions} from './flight.mjs';
import {judge_forms, judge_gateway} from './forms.mjs';

const minutes = Number(process.argv[process.argv.indexOf('--minutes') + 1]) || 1;
const token = 'figures';
const wait = {timeout: 30000};
const openings = 5, frame_windows = 5;
const rate_window_s = 40;  // one message more or less at an end must stay far below the 1 % that is judged
const fast_parameter = 'MANIPULATOR.CUR_VALUES.POSITION[0]';

let short = 0;
const rows = [];
/// `limit` as [comparison, number, unit]; `note` says what else was seen.
function row(what, [comparison, limit, unit], measured, note = '') {
  const good = comparison === '<' ? measured < limit : comparison === '≥' ? measured >= limit : measured === limit;
  if (!good) ++short;
  const number = (value) => Number.isFinite(value) ? +value.toPrecision(4) : 'nothing';
  rows.push([what, `${comparison} ${limit} ${unit}`.trim(), `${number(measured)} ${unit}`.trim(), good ? 'ok' : 'SHORT', note]);
  console.error(`${rows.length}. ${rows.at(-1).join(' | ')}`);
}

function print_table() {
  const head = ['figure', 'expected', 'measured', 'verdict', ''];
  const widths = head.map((title, i) => Math.max(title.length, ...rows.map((one) => one[i].length)));
  for (const one of [head, ...rows]) console.log(one.map((text, i) => text.padEnd(widths[i])).join('  ').trimEnd());
}

const api = (station, path, body) => fetch(`${station.origin}${path}`, {headers: {Authorization: `Bearer ${station.token}`,
  ...(body ? {'Content-Type': 'application/json'} : {})}, ...(body ? {method: 'POST', body: JSON.stringify(body)} : {})});
async function is_coupled(station) {
  const {mode, links, subsystems} = await (await api(station, '/api/status')).json();
  return mode === 'telepresence' && links.filter((one) => one.up).length === 2 && subsystems.every((one) => one.state === 'Operational');
}
/// Why it is not, when it is not: then the figures are of something else.
async function causes(station) {
  if (await is_coupled(station)) return '';
  return (await (await api(station, '/api/why')).json()).causes.map((one) => one.text).join('; ');
}
const stops = [];
/// A browser that draws by the processor may take a small computer from the craft, which then stops itself, as it shall. What is measured
/// next is of a craft that moves; how often it was coupled again is told.
async function couple_again(page, station) {
  if (await is_coupled(station)) return;
  stops.push((await causes(station)).split(';')[0]);
  for (let tries = 0; tries < 3; ++tries) {
    // What goes down ends in Offline first: a step sent meanwhile would be refused.
    await sleep(3000);
    await go(page, 'overview');
    await go(page, 'subsystems/MANIPULATOR');
    await page.selectOption('[data-test=commission-mode]', 'telepresence');
    await page.click('[data-test=commission]');
    await page.waitForSelector('[data-test=commissioned], .commissioning ~ .permission.no', {timeout: 60000});
    if (await page.locator('[data-test=commissioned]').count()) break;
    stops.push(await page.textContent('.commissioning ~ .permission.no'));
  }
  await hand(station, 'hand sine 1 0.1 0.5');
}

const hand = (station, line) => api(station, '/api/faults', {device: 'joystick', line});

// --- one figure each ---------------------------------------------------------------------------------------------------

function measure_sizes() {
  const folder = process.env.HIROSCO_PAGE;
  const sizes = readdirSync(folder).filter((name) => /\.(js|css|html)$/.test(name)).map((name) => [name, gzipSync(readFileSync(join(folder, name))).length / 1000]);
  const sum = (list) => list.reduce((total, [, size]) => total + size, 0);
  row('code of the page without 3D, gzip', ['<', 120, 'kB'], sum(sizes.filter(([name]) => !/^(robot_|card)/.test(name))));
  row('code of the page in all, gzip', ['<', 350, 'kB'], sum(sizes));
}

/// Processor time that all processes of our browsers have taken.
function cpu_of_browser_s() {
  const ticks = family_of(process.pid).slice(1).map((pid) => {
    try {
      const stat = readFileSync(`/proc/${pid}/stat`, 'utf8'), words = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
      return /chrom/.test(readFileSync(`/proc/${pid}/cmdline`, 'utf8')) ? Number(words[11]) + Number(words[12]) : 0;
    } catch {
      return 0;
    }
  });
  return ticks.reduce((sum, one) => sum + one, 0) / 100;
}

/// A browser that was just started makes a page of its own, of half a second: who types an address waits for that, and it is not ours.
async function browser_rests() {
  for (let before_s = cpu_of_browser_s(), tries = 0; tries < 40; ++tries) {
    await sleep(500);
    const now_s = cpu_of_browser_s();
    if (now_s - before_s < 0.03) return;
    before_s = now_s;
  }
  throw new Error('the browser does not come to rest');
}

/// {paint_ms, moving_ms, transferred_kb} of a browser that has never seen the page.
async function open_once(station) {
  const browser = await open_browser();
  const {page} = await open_page(browser.context, 'about:blank', {width: 1440, height: 900});
  const network = await page.context().newCDPSession(page);
  let transferred = 0;
  await network.send('Network.enable');
  network.on('Network.loadingFinished', ({encodedDataLength}) => { transferred += encodedDataLength; });
  await browser_rests();
  await page.goto(station.url);
  const moving_ms = await (await page.waitForFunction(() => {
    // Three poses that were drawn: a picture alone is no motion.
    const robot = document.querySelector('[data-test=robot]'), pose = robot?.dataset.loaded && robot.dataset.pose;
    if (!pose || pose.startsWith(',')) return 0;
    return (window.poses ??= new Set()).add(pose).size >= 3 ? performance.now() : 0;
  }, null, {...wait, polling: 'raf'})).jsonValue();
  const paint_ms = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
  await browser.close();
  return {paint_ms, moving_ms, transferred_kb: transferred / 1000};
}

async function measure_opening(station) {
  const opened = [];
  while (opened.length < openings) opened.push(await open_once(station));
  const of = (name) => opened.map((one) => one[name]).sort((a, b) => a - b);
  const told = (name, what, limit, note) => row(what, limit, of(name)[openings >> 1], `median of ${openings}, worst ${of(name).at(-1).toFixed(0)} ${limit[2]}${note}`);
  told('paint_ms', 'first contentful paint, cold', ['<', 1000, 'ms'], '');
  told('moving_ms', 'the robot moves after opening', ['<', 1500, 'ms'], '');
  told('transferred_kb', 'transferred until the robot moves, cold', ['<', 350, 'kB'], ': typefaces, code, mission and past, as sent');
}

async function measure_frames(page, seconds) {
  await go(page, 'overview');
  await page.waitForSelector('[data-test=robot][data-loaded]', wait);
  // What stands still is a picture by then: it is drawn once, beside the robot.
  await page.waitForFunction(() => {
    const {still, surroundings, tier} = document.querySelector('[data-test=robot]').dataset;
    return surroundings === 'yes' && (still === 'whole' || tier !== 'software');
  }, null, wait);
  await page.evaluate(() => {
    const robot = document.querySelector('[data-test=robot]');
    window.repeated = 0;
    let before = robot.dataset.pose;
    new MutationObserver(() => {
      if (robot.dataset.pose === before && robot.dataset.moving === 'yes') ++window.repeated;
      before = robot.dataset.pose;
    }).observe(robot, {attributeFilter: ['data-frames']});
  });
  const look = async () => {
    const [pictures, now_ms] = await page.evaluate(() => [Number(document.querySelector('[data-test=robot]').dataset.frames), performance.now()]);
    return {pictures, now_ms, cpu_s: cpu_of_browser_s()};
  };
  const seen = [await look()];
  while (seen.length <= frame_windows) {
    await sleep(seconds * 1000);
    seen.push(await look());
  }
  const between = seen.slice(1).map((one, i) => {
    const taken_s = (one.now_ms - seen[i].now_ms) / 1000;
    return {rate_hz: (one.pictures - seen[i].pictures) / taken_s, share: 100 * (one.cpu_s - seen[i].cpu_s) / taken_s};
  });
  const of = (name) => between.map((one) => one[name]).sort((a, b) => a - b);
  const renderer = await page.evaluate(() => {
    const gl = document.createElement('canvas').getContext('webgl2');
    const known = gl?.getExtension('WEBGL_debug_renderer_info');
    return known ? gl.getParameter(known.UNMASKED_RENDERER_WEBGL) : '';
  });
  const plots = await page.locator('[data-test=plot]').count();
  const windows = `median of ${frame_windows} times ${seconds} s`;
  row('pictures that repeat the pose of the one before', ['=', 0, ''], await page.evaluate(() => window.repeated), `of ${seen.at(-1).pictures - seen[0].pictures}, while the robot moves`);
  row('processor of the whole browser meanwhile', ['<', 60, '%'], of('share')[frame_windows >> 1], `of one core, ${windows}, worst ${of('share').at(-1).toFixed(1)} %`);
  row('3D with three plots at 20 Hz', ['≥', 20, 'frames/s'], of('rate_hz')[frame_windows >> 1],
    `${windows}, worst ${of('rate_hz')[0].toFixed(1)}; ${plots} plots, ${/SwiftShader/.test(renderer) ? 'SwiftShader' : renderer}`);
}

async function measure_accessibility(page) {
  const found = await serious_findings(page);
  row('serious findings of axe-core', ['=', 0, ''], found.length, found.slice(0, 3).join('; ') || `${views.length} views`);
}

/// From the click to the acceptance report in the page's text, by the page's own clock.
async function measure_verdicts(page, times) {
  await go(page, 'commands/MANIPULATOR/PING');
  await page.waitForSelector('[data-test=send]:enabled', wait);
  const all_ms = [];
  for (let i = 0; i < times; ++i) {
    all_ms.push(await page.evaluate(() => new Promise((resolve) => {
      const count = () => document.querySelectorAll('[data-test=history] > li .accepted').length;
      const before = count(), began_ms = performance.now();
      const observer = new MutationObserver(() => {
        if (count() <= before) return;
        observer.disconnect();
        requestAnimationFrame(() => resolve(performance.now() - began_ms));
      });
      observer.observe(document.body, {subtree: true, childList: true, attributes: true});
      document.querySelector('[data-test=send]').click();
    })));
    await sleep(200);
  }
  all_ms.sort((a, b) => a - b);
  row('click to its ST[1] report on the screen', ['<', 50, 'ms'], all_ms[times >> 1], `median of ${times}, worst ${all_ms.at(-1).toFixed(0)} ms`);
}

/// Values messages a second at a WebSocket of its own.
async function rate_of_feed(page, station, seconds) {
  return page.evaluate(([url, wanted_ms]) => new Promise((resolve, reject) => {
    const socket = new WebSocket(url);
    let first = 0, count = 0;
    socket.onerror = () => reject(new Error('no feed'));
    socket.onmessage = ({data}) => {
      if (!data.startsWith('{"set"') && !data.includes('"type":"values"')) return;
      const now = performance.now();
      if (!first) first = now;
      else ++count;
      if (now - first < wanted_ms) return;
      socket.close();
      resolve(count / ((now - first) / 1000));
    };
  }), [`${station.origin.replace('http', 'ws')}/ws?token=${station.token}`, seconds * 1000]);
}

/// Every process below `pid`, itself first.
function family_of(pid) {
  const parents = new Map();
  for (const entry of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = readFileSync(`/proc/${entry}/stat`, 'utf8');
      parents.set(Number(entry), Number(stat.slice(stat.lastIndexOf(')') + 2).split(' ')[1]));
    } catch { /* gone meanwhile */ }
  }
  const family = [pid];
  for (const one of family) for (const [child, parent] of parents) if (parent === one) family.push(child);
  return family;
}

/// Another browser with the page open, as processes to be stopped and killed.
async function open_victim(station) {
  const folder = mkdtempSync(join(tmpdir(), 'hirosco-victim-'));
  const child = spawn(executable, ['--headless', ...flags, `--user-data-dir=${folder}`, '--remote-debugging-port=0', station.url],
    {stdio: ['ignore', 'ignore', 'pipe']});
  const [, inspector] = await new Promise((resolve) => {
    let told = '';
    child.stderr.on('data', (data) => {
      told += data;
      const found = /DevTools listening on (\S+)/.exec(told);
      if (found) resolve(found);
    });
  });
  const seen = await chromium.connectOverCDP(inspector);
  await seen.contexts()[0].pages()[0].waitForSelector('[data-test=link].good', wait);
  const signal = (name) => family_of(child.pid).forEach((pid) => { try { process.kill(pid, name); } catch { /* gone */ } });
  return {signal, forget: () => rmSync(folder, {recursive: true, force: true, maxRetries: 5})};
}

const resident_mb = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1000;

/// The heap over minutes beside a browser that has stopped, then without it.
async function measure_long_run(page, station) {
  await go(page, 'overview');
  const inspector = await page.context().newCDPSession(page);
  const heap_mb = async () => {
    await inspector.send('HeapProfiler.collectGarbage');
    return (await inspector.send('Runtime.getHeapUsage')).usedSize / 1e6;
  };
  const rate_before_hz = await rate_of_feed(page, station, rate_window_s);
  const victim = await open_victim(station);
  victim.signal('SIGSTOP');
  const gateway_mb = resident_mb(station.child.pid), first_mb = await heap_mb();
  await sleep(minutes * 60000);
  const grown_mb = await heap_mb() - first_mb;
  const rate_beside_hz = await rate_of_feed(page, station, rate_window_s);
  const gateway_grown_mb = resident_mb(station.child.pid) - gateway_mb;
  victim.signal('SIGKILL');
  const rate_after_hz = await rate_of_feed(page, station, rate_window_s);
  victim.forget();
  const cost = (rate_hz) => (1 - rate_hz / rate_before_hz) * 100;
  row(`heap of the page after ${minutes} min`, ['<', 5, 'MB'], grown_mb, `more than ${first_mb.toFixed(1)} MB`);
  row('loss of rate to others beside a stopped one', ['<', 1, '%'], cost(rate_beside_hz),
    `${rate_before_hz.toFixed(2)} Hz, then ${rate_beside_hz.toFixed(2)} Hz; gateway +${gateway_grown_mb.toFixed(1)} MB`);
  row('loss of rate to others after one is killed', ['<', 1, '%'], cost(rate_after_hz), `${rate_after_hz.toFixed(2)} Hz`);
}

const history = async (station, last_s) => (await (await api(station, `/api/history?parameter=${encodeURIComponent(fast_parameter)}&last=${last_s}&points=20000`)).json());

/// kill -9 of the gateway, a new one with the same archive: what the page had been shown must be there again.
async function measure_restart(page, station, folder, port) {
  await go(page, `plots?p=${encodeURIComponent(fast_parameter)}&w=30`);
  const seen = page.evaluate(([url, name, wanted_ms]) => new Promise((resolve) => {
    const times = [], socket = new WebSocket(url), began = performance.now();
    socket.onmessage = ({data}) => {
      const sample = JSON.parse(data).set?.[name];
      if (sample && performance.now() - began > 500) times.push(sample[1]);
    };
    socket.onclose = () => resolve(times);
    setTimeout(() => socket.close(), wanted_ms);
  }), [`${station.origin.replace('http', 'ws')}/ws?token=${station.token}`, fast_parameter, 60000]);
  await sleep(5000);
  const killed_ms = performance.now();
  await station.end('SIGKILL');
  await page.waitForSelector('[data-test=link].bad', wait);
  await sleep(2000);
  const restarted_ms = performance.now();
  const again = await ground(folder, 'rokviss', port, token);
  await page.waitForFunction(() => document.querySelector('[data-test=link].good'), null, {...wait, polling: 20});
  row('reconnect after kill -9 and restart', ['<', 2000, 'ms'], performance.now() - restarted_ms);
  const away_s = (performance.now() - killed_ms) / 1000;
  await sleep(2000);
  const kept = await history(again, 60), shown = await seen;
  const there = new Set(kept.t.map((t) => t.toFixed(4)));
  row('samples shown before the kill and lost', ['=', 0, ''], shown.filter((t) => !there.has(t.toFixed(4))).length, `of ${shown.length}`);
  const holes_s = kept.t.slice(1).map((t, i) => t - kept.t[i]);
  row('hole in the plot beyond the absence', ['<', 0.5, 's'], Math.max(...holes_s) - away_s, `absent ${away_s.toFixed(1)} s`);
  return again;
}

async function measure_forms(context) {
  let fields = 0, cases = 0;
  const wrong = [];
  const folder = mkdtempSync(join(tmpdir(), 'hirosco-forms-'));
  for (const name of readdirSync(missions, {withFileTypes: true}).filter((one) => one.isDirectory()).map((one) => one.name)) {
    const station = await ground(folder, name, await free_port());
    const mission = await (await api(station, '/api/mission')).json();
    const {page} = await open_page(context, at_view(station.url, 'commands'));
    const judged = await judge_forms(page, mission);
    const agreed = await judge_gateway(mission, async (body) => (await api(station, '/api/commands/preview', body)).status);
    fields += judged.fields;
    cases += judged.cases + agreed.cases;
    wrong.push(...judged.wrong, ...agreed.wrong);
    await page.close();
    await station.end();
  }
  rmSync(folder, {recursive: true, force: true});
  row('form fields judged amiss', ['=', 0, ''], wrong.length, wrong.slice(0, 4).join('; ') || `${fields} fields, ${cases} cases`);
}

// --- all of them -------------------------------------------------------------------------------------------------------

async function measure() {
  measure_sizes();
  const flight = await fly({more: ['--no-ground'], wait_for: /./});
  const port = await free_port();
  let station = await ground(flight.folder, 'rokviss', port, token);
  const browser = await open_browser();
  try {
    await until('coupled', () => is_coupled(station), 60);
    await hand(station, 'hand sine 1 0.1 0.5');
    await sleep(2000);
    await measure_opening(station);
    const {page, faults} = await open_page(browser.context, station.url, {width: 1440, height: 900});
    await couple_again(page, station);
    await measure_frames(page, 10);
    await measure_accessibility(page);
    await measure_verdicts(page, 20);
    await couple_again(page, station);
    await measure_long_run(page, station);
    row('console errors and exceptions', ['=', 0, ''], faults.filter((one) => !one.startsWith('request')).length, faults.slice(0, 2).join('; '));
    await couple_again(page, station);
    station = await measure_restart(page, station, flight.folder, port);
    if (!await is_coupled(station)) stops.push((await causes(station)).split(';')[0]);
    row('stops of the craft meanwhile', ['=', 0, ''], stops.length, stops.join('; '));
    row('requests to other hosts', ['=', 0, ''], faults.filter((one) => one.startsWith('request')).length);
    await page.close();
    await measure_forms(browser.context);
  } finally {
    await browser.close();
    await station.end();
    await flight.end();
  }
}

await measure();
print_table();
process.exitCode = short ? 1 : 0;
