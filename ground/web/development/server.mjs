// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node development/server.mjs RECORDING|synthetic|hostile[:STATE] [PAGE [PORT]]: the page without a spacecraft. Answers as ground/api/README.md says,
// from a recorded flight that it plays in a loop (development/record.mjs makes one) or from a made-up one; takes telecommands and completes
// them. For work on the page's looks and tests of the page alone, with the token "development"; nothing here is part of what flies.
// STATE is what is to be seen: well (nothing fails), stopped, stale (silent from 5 s on), observer, fresh (nothing yet), foreign (a mission without a page folder),
// renewed (the first connection ends, and then the station is of another version).
// Port 0 takes a free one; the URL is the first line of what it prints.
import {createReadStream, existsSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {createServer} from 'node:http';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';
import {WebSocketServer} from 'ws';

const [asked, page = join(dirname(fileURLToPath(import.meta.url)), '../dist'), port = '8090'] = process.argv.slice(2);
const [recording, state = 'normal'] = (asked ?? '').split(':');
if (!recording) {
  console.error('usage: node development/server.mjs RECORDING|synthetic|hostile[:well|stopped|stale|observer|fresh|foreign|renewed] [PAGE [PORT]]');
  process.exit(2);
}
const sources = process.env.HIROSCO_SOURCES ?? join(dirname(fileURLToPath(import.meta.url)), '../../..');
const token = 'development';
const made_up = ['synthetic', 'hostile'].includes(recording);
const flight = made_up ? (await import(join(sources, 'tests/browser/synthetic.mjs'))).synthetic_flight({hostile: recording === 'hostile'}) : JSON.parse(readFileSync(recording, 'utf8'));
if (state === 'foreign') flight.mission = {...flight.mission, name: 'outpost'};
// What the mission shows of itself, of those that are here.
const mission_page = join(sources, 'missions', String(flight.mission.name).toLowerCase().replaceAll(/[^a-z0-9_-]/g, ''), 'page');
const burst_events = 10000;
const step_ms = 50, past_s = 120, longest_value_s = 0.1;
// In the states that are looked at, what is not to be seen does not happen: the made-up end of the flight least of all.
const list = state === 'normal' ? flight.messages : flight.messages.filter((one) => state === 'stopped' || one.severity !== 'high');
// Between two laps nothing is said for a while, which is a silence that the page tells of, and goals cannot be set in: while all is well there is none.
const first_t = list[0].t, length_s = list[list.length - 1].t - first_t + (state === 'well' ? longest_value_s : 2);

let now = first_t;
let lap = 0;
let at = 0;
const archive = [];
const latest = new Map();
let mode = null;
const states = new Map();
let commands = [];
let injections = [];
let next_id = 1;
// What people at the station share, as the gateway has it: here only as far as one page needs.
const authority = {holder: null, asking: null};
const acts = new Map();
let seen_until = null, marks = [], stacks = [];
const earlier_t = first_t - 4000;
const flight_of_now = {id: 2, from: first_t};

function alarms() {
  const found = new Map();
  for (const one of archive.filter((message) => message.type === 'event' && ['high', 'medium'].includes(message.severity))) {
    const key = `${one.apid}/${one.id}`, before = found.get(key), act = acts.get(key) ?? {};
    const fresh = one.t > (act.acknowledged?.t ?? -Infinity);
    found.set(key, {...one, first: before?.first ?? one.t, count: (before?.count ?? 0) + 1, fresh: (before?.fresh ?? 0) + (fresh ? 1 : 0), calls: false,
      acknowledged: act.acknowledged ?? null, shelved: act.shelved?.until > now ? act.shelved : null});
  }
  return {alarms: [...found.values()].map((one) => ({...one, calls: one.fresh > 0 && !one.shelved})), seen_until};
}

function act_on_alarm({subsystem, event, action, note = '', for_s, sender = 'operator'}) {
  for (const one of alarms().alarms.filter((known) => subsystem === '*' || (known.subsystem === subsystem && known.name === event))) {
    const key = `${one.apid}/${one.id}`, act = {t: now, who: sender, note};
    acts.set(key, {...acts.get(key), ...(action === 'acknowledge' ? {acknowledged: act} : {shelved: action === 'shelve' ? {...act, until: now + for_s} : null})});
  }
  if (subsystem === '*') seen_until = now;
  marks = [{t: now, kind: 'alarm', name: '*', action, who: sender, note, until: null}, ...marks];
  tell({type: 'alarms', ...alarms()});
  return alarms();
}

function act_on_authority({action, seat, sender = 'operator'}) {
  authority.holder = action === 'hand_over' ? null : {seat, name: sender, since: now};
  tell({type: 'authority', ...authority});
  return authority;
}

const notes = {1: [{t: earlier_t + 40, who: 'anna', text: 'The rail was touched for the first time.'}], 2: []};
function tell_of_flight({flight: id, name, note, sender = 'operator'}) {
  if (!note) return {flight: id, name};
  notes[id].push({t: now, who: sender, text: note});
  tell({type: 'notes', flight: id, notes: notes[id]});
  return {flight: id, notes: notes[id]};
}

/// Who has a page open, as the gateway tells it.
function present() {
  const pages = [...sockets.clients].map((one) => ({client: one.id, seat: one.seat, name: one.name ?? '', operator: state !== 'observer', replay: Boolean(one.replay)}));
  return state === 'observer' ? {pages, operators: 0, observers: pages.length} : {pages, operators: pages.length, observers: 0};
}

function take(message) {
  archive.push(message);
  if (message.type === 'values') for (const [name, [v, t]] of Object.entries(message.set)) latest.set(name, {v, t});
  if (message.type === 'event' && message.name === 'STATE_CHANGED') states.set(message.subsystem, message.text.replace('STATE=', ''));
  if (message.type === 'status' && message.mode) mode = message.mode;
}

function shifted(message, by) {
  const moved = {...message, t: message.t + by};
  if (message.set) moved.set = Object.fromEntries(Object.entries(message.set).map(([name, [v, t]]) => [name, [v, t + by]]));
  return moved;
}

/// The recorded messages until `t`, lap after lap.
function* until(t) {
  for (;;) {
    const by = lap * length_s;
    if (at >= list.length) {
      if (first_t + by + length_s > t) return;
      at = 0;
      ++lap;
      if (state === 'normal') states.clear();
      continue;
    }
    if (list[at].t + by > t) return;
    const one = list[at++];
    // Who is looked at while all is well does not start anew with each lap.
    if (lap === 0 || state === 'normal' || one.name !== 'STATE_CHANGED') yield shifted(one, by);
  }
}

/// Most within half a period, one of a thousand later than two.
const latencies_of = (link, t) => {
  const all = Math.max(1000, Math.round((t - first_t) * link.rate_hz));
  return {period_ns: 1e9 / link.rate_hz, counts: [0, 0.001, 0.004, 0.02, 0.075, 0.62, 0.275, 0.004, 0.001].map((part) => Math.round(part * all))};
};

const state_of = (subsystem) => state === 'stopped' && flight.stop.stopped.includes(subsystem.name) ? 'Offline' : states.get(subsystem.name) ?? 'Offline';
function status(t = now) {
  if (state === 'fresh') return {t, link: {connected: false, age_s: 1e9, rx: 0, tx: 0, lost: 0}, mode: null, commandable: false, subsystems: [], links: []};
  const up = state !== 'stopped' && [...states.values()].filter((state) => state === 'Operational').length >= flight.mission.subsystems.length;
  return {t, link: {connected: true, age_s: longest_value_s / 2, rx: archive.length, tx: commands.length, lost: 0},
    mode: mode ?? (up || state === 'stopped' ? flight.mission.start_mode : 'commissioning'), commandable: true,
    subsystems: flight.mission.subsystems.map((one) => ({id: one.id, name: one.name, state: state_of(one),
      configuration: one.configurations[one.configurations.length - 1]?.name, cycles: Math.round((t - first_t) * 2000), overruns: 0, missed: 0,
      latency_max_ns: 61000, execution_mean_ns: 8400, inhibited: state_of(one) === 'ErrorOperational' ? ['failure'] : state === 'stopped' && flight.stop.stopped.includes(one.name) ? ['device'] : [], waits_for: '', age_s: 0.1})),
    links: flight.mission.links.map((link) => ({id: link.id, up, age_cycles: up ? 0 : 400, rate_hz: up ? link.rate_hz : 0, lost: 0, latency_mean_ns: 310000, latency_max_ns: 1240000, jitter_ns: 4100, age_at_use_us: 310,
      latencies: up ? latencies_of(link, t) : null}))};
}

if (state !== 'fresh') {
  for (const message of until(now + past_s)) take(message);
  now += past_s;
}
const stopped_t = now;
if (state === 'stopped') for (const name of flight.stop.stopped) states.set(name, 'Offline');

const types = {'.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.json': 'application/json',
  '.urdf': 'application/xml', '.woff2': 'font/woff2', '.txt': 'text/plain; charset=utf-8'};
const policy = "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' blob: data:; connect-src 'self'; " +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

function answer(response, code, body) {
  response.writeHead(code, {'Content-Type': 'application/json', 'Cache-Control': 'no-store'});
  response.end(JSON.stringify(body));
}

function history(query) {
  const name = query.get('parameter'), from = +query.get('from'), to = +query.get('to');
  // The flight of before was as this one, as far as it goes.
  const known = to < first_t ? [0, 1, 2, 3, 4, 5].flatMap((before) => list.map((one) => shifted(one, earlier_t - first_t + before * length_s))) : archive;
  const samples = known.filter((one) => one.type === 'values' && name in one.set && one.t >= from && one.t <= to).map((one) => one.set[name]);
  return {parameter: name, unit: '', t: samples.map(([, t]) => t), v: samples.map(([v]) => v), gaps: []};
}

function timeline(query) {
  const from = +query.get('from'), to = +query.get('to');
  const events = archive.filter((one) => one.type === 'event' && one.t <= to);
  return {modes: [{t: from, mode: status().mode}], links: flight.mission.links.map((link) => ({t: from, id: link.id, up: true})), gaps: [],
    states: events.filter((one) => one.name === 'STATE_CHANGED').map((one) => ({t: one.t, subsystem: one.subsystem, state: one.text.replace('STATE=', '')})),
    commands: commands.filter((one) => one.t >= from), events: events.filter((one) => one.t >= from), faults: injections};
}

function tell(message) {
  for (const client of sockets.clients) if (!client.replay) client.send(JSON.stringify(message));
}

function command(body) {
  if (body.seat && !authority.holder) act_on_authority({action: 'take', seat: body.seat, sender: body.sender});
  const one = {id: next_id++, t: now, sender: 'operator', subsystem: body.subsystem, function: body.function, arguments: body.arguments, reports: []};
  commands = [one, ...commands];
  const refused = body.function === 'MOVE_TO';
  ['sent', refused ? 'failed' : 'accepted', ...(refused ? [] : ['started', 'completed'])].forEach((stage, i) => setTimeout(() => {
    const report = {t: now, stage, code: stage === 'failed' ? 15 : null, reason: stage === 'failed' ? 'setpoint owned by a link' : null};
    one.reports.push(report);
    Object.assign(one, {stage, code: report.code, reason: report.reason});
    if (stage === 'completed' && body.function === 'SET_STATE') states.set(body.subsystem, flight.mission.subsystems[0].states[body.arguments.STATE]);
    if (stage === 'completed' && body.function === 'SET_MODE') mode = flight.mission.modes.find((known) => known.id === body.arguments.MODE)?.name ?? mode;
    tell({...report, type: 'command', ...Object.fromEntries(Object.entries(one).filter(([key]) => !['reports', 't'].includes(key))), t: now, stage});
  }, i * 60));
  return {id: one.id, apid: 10, count: one.id, octets: '180ae796001929080100014d4f56455f544f'};
}

const server = createServer(async (request, response) => {
  const url = new URL(request.url, `http://${request.headers.host}`);
  if (!url.pathname.startsWith('/api/')) {
    const of_mission = url.pathname.startsWith('/mission/');
    if (url.pathname === '/mission/index.json') return answer(response, 200, existsSync(mission_page) ? readdirSync(mission_page) : []);
    if (url.pathname === '/mission/scene.json' && !existsSync(join(mission_page, 'scene.json'))) return answer(response, 200, null);
    const folder = of_mission ? mission_page : page;
    const file = join(folder, normalize(url.pathname === '/' ? '/index.html' : of_mission ? url.pathname.slice('/mission'.length) : url.pathname));
    if (!file.startsWith(folder) || !existsSync(file) || !statSync(file).isFile()) return answer(response, 404, {error: 'no such file'});
    response.writeHead(200, {'Content-Type': types[extname(file)] ?? 'application/octet-stream', 'Content-Security-Policy': policy, 'Cache-Control': 'no-store'});
    return createReadStream(file).pipe(response);
  }
  if (request.headers.authorization !== `Bearer ${token}`) return answer(response, 401, {error: 'the token is missing'});
  let text = '';
  for await (const part of request) text += part;
  const body = text ? JSON.parse(text) : {};
  const query = url.searchParams;
  const routes = {
    '/api/mission': () => flight.mission,
    '/api/status': () => ({...status(), values: Object.fromEntries([...latest].map(([name, {v, t}]) => [name, {v, t, age_s: now - t}]))}),
    '/api/history': () => history(query),
    '/api/events': () => ({events: archive.filter((one) => one.type === 'event' && !(one.t > (+query.get('to') || Infinity))).reverse().slice(0, +(query.get('limit') ?? 200))}),
    '/api/commands': () => request.method === 'POST' ? command(body) : {commands},
    '/api/commands/preview': () => ({octets: '180ae796001929080100014d4f56455f544f0000000000000000',
      permitted: body.function !== 'MOVE_TO', code: body.function === 'MOVE_TO' ? 15 : null, reason: body.function === 'MOVE_TO' ? 'setpoint owned by a link' : null}),
    '/api/modes/preview': () => ({mode: body.mode, against: [], steps: (flight.mission.modes.find((one) => one.name === body.mode)?.commission ?? [])
        .flatMap((one, i) => [['configured as', one.configuration], ['to', one.state]].map(([word, what]) => ({stage: i + 1, subsystem: one.subsystem, what: `${word} ${what}`})))}),
    '/api/timeline': () => timeline(query),
    '/api/alarms': () => request.method === 'POST' ? act_on_alarm(body) : state === 'fresh' ? {alarms: [], seen_until: null} : alarms(),
    '/api/authority': () => request.method === 'POST' ? act_on_authority(body) : authority,
    '/api/marks': () => ({marks}),
    '/api/stacks': () => {
      if (request.method === 'POST') stacks = [...(body.text ? [{name: body.name, text: body.text, t: now, who: body.sender ?? 'operator'}] : []), ...stacks.filter((one) => one.name !== body.name)];
      if (request.method === 'POST') tell({type: 'stacks', stacks});
      return {stacks};
    },
    '/api/present': () => present(),
    '/api/flights': () => request.method === 'POST' ? tell_of_flight(body) : {flights: state === 'fresh' ? [] : [{id: 2, from: first_t, to: now, name: '', named_by: '', notes: notes[2], high: 0, medium: 0, commands: commands.length},
      {id: 1, from: earlier_t, to: first_t - 600, name: 'first light', named_by: 'anna', notes: notes[1], high: 2, medium: 1, commands: 14}]},
    '/api/log': () => {
      const lines = archive.filter((one) => one.type === 'event').map((one, i) => ({number: i + 1, t: one.t, apid: one.apid,
        subsystem: one.subsystem, service: 5, subtype: 1, text: `TM[5,1] ${one.subsystem} ${one.name} ${one.text}`})).reverse();
      const words = (query.get('text') ?? '').toLowerCase().split(/\s+/).filter(Boolean);
      return {packets: lines.filter((one) => words.every((word) => one.text.toLowerCase().includes(word))).slice(0, +(query.get('limit') ?? 200)), before: null};
    },
    // Told, and stopped nobody: no banner over the tests of everything else.
    '/api/why': () => state === 'stopped' ? {...flight.stop, t: stopped_t, causes: flight.stop.causes.map((one) => ({...one, t: stopped_t + one.after_ms / 1000}))} : ({t: now - 60, title: 'Something happened.', detail: '', advice: 'Look into it.', plan: 'note', mode: status().mode, mode_up: null, severity: 'medium', stopped: [],
      causes: archive.filter((one) => one.type === 'event' && one.severity === 'high').slice(-3).map((one, i) => ({t: one.t, after_ms: i, severity: 'high', text: `${one.subsystem} reports ${one.name}`}))}),
    '/api/faults': () => {
      if (body.line === 'burst') for (let i = 0; i < burst_events; ++i) tell({...list.find((one) => one.type === 'event'), t: now, id: 3, text: `burst ${i}`});
      if (body.line.startsWith('tell ')) {
        const one = {...list.findLast((message) => message.type === 'event'), t: now, id: 3, name: 'TOLD', text: body.line};
        take(one);
        tell(one);
      }
      injections = [...injections, {t: now, device: body.device, line: body.line, answer: 'ok'}];
      return {answer: 'ok'};
    },
  };
  const route = routes[url.pathname];
  if (!route) return answer(response, 404, {error: 'no such path'});
  return answer(response, request.method === 'POST' && url.pathname === '/api/commands' ? 202 : 200, route());
});

const sockets = new WebSocketServer({server, path: '/ws', verifyClient: ({req}) => new URL(req.url, 'http://x').searchParams.get('token') === token});
let clients = 0;
sockets.on('connection', (socket, request) => {
  socket.id = `c${++clients}`;
  socket.seat = new URL(request.url, 'http://x').searchParams.get('seat') ?? '';
  const renewed = state === 'renewed' && clients > 1;
  if (state === 'renewed' && !renewed) setTimeout(() => socket.close(), 1000);
  socket.send(JSON.stringify({type: 'hello', t: now, version: renewed ? 'renewed' : 'development', client: socket.id, operator: state !== 'observer', archive_from: first_t, authority, flight: flight_of_now}));
  tell({type: 'present', ...present()});
  socket.on('close', () => tell({type: 'present', ...present()}));
  socket.on('message', (data) => {
    const message = JSON.parse(data);
    if (message.type === 'name') {
      socket.name = message.name;
      return tell({type: 'present', ...present()});
    }
    socket.replay = message.type === 'replay' ? {at: message.at, speed: message.speed, next: archive.findIndex((one) => one.t >= message.at)} : null;
    socket.send(JSON.stringify({type: 'replay', at: message.at, speed: message.speed, state: message.type === 'live' ? 'live' : message.speed ? 'playing' : 'paused'}));
    tell({type: 'present', ...present()});
    if (socket.replay) socket.send(JSON.stringify({type: 'status', ...status(message.at), replay: true}));
  });
});

const silent_after = state === 'stale' ? Date.now() + 5000 : Infinity;
setInterval(() => {
  if (Date.now() > silent_after || state === 'fresh') return;
  now += step_ms / 1000;
  const news = state === 'stopped' ? [] : [...until(now)];
  const set = {};
  for (const message of news) {
    take(message);
    if (message.type === 'values') Object.assign(set, message.set);
    else tell(message);
  }
  if (Object.keys(set).length) tell({type: 'values', t: now, set});
  for (const socket of sockets.clients) {
    if (!socket.replay) continue;
    socket.replay.at += socket.replay.speed * step_ms / 1000;
    for (; socket.replay.next >= 0 && socket.replay.next < archive.length && archive[socket.replay.next].t <= socket.replay.at; ++socket.replay.next) {
      socket.send(JSON.stringify({...archive[socket.replay.next], replay: true}));
    }
  }
}, step_ms);
setInterval(() => { if (Date.now() < silent_after) tell({type: 'status', ...status()}); }, 500);

server.listen(+port, '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/#token=${token}`));
