// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Real flights and real gateways for tests of the page, each in a folder of its own.
import {spawn} from 'node:child_process';
import {mkdtempSync, readdirSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

export const missions = join(process.env.HIROSCO_SOURCES ?? '.', 'missions');
const program = join(process.env.HIROSCO_BIN ?? '.', 'hirosco');
const url_pattern = /http:\/\/127\.0\.0\.1:\d+\/#\S+/;

export const new_folder = () => mkdtempSync(join(tmpdir(), 'hirosco-flight-'));

/// A port of the loopback address that nobody has now.
export const free_port = () => new Promise((resolve, reject) => {
  const server = createServer().once('error', reject).listen(0, '127.0.0.1', () => {
    const {port} = server.address();
    server.close(() => resolve(port));
  });
});

/// A `hirosco` command in `folder` that goes on until it is ended. told() is all that it printed.
export function start(folder, words, environment = {}) {
  const child = spawn(program, words, {cwd: folder, stdio: ['ignore', 'pipe', 'pipe'],
    env: {...process.env, XDG_RUNTIME_DIR: folder, NO_COLOR: '1', ...environment}});
  let told = '';
  const waiting = new Set();
  const look = (data) => {
    told += data;
    for (const one of waiting) one();
  };
  child.stdout.on('data', look);
  child.stderr.on('data', look);
  const gone = new Promise((resolve) => child.once('exit', (code) => resolve(code)));
  return {
    child, gone, told: () => told,
    /// The first match in what is printed, before or after this call.
    says: (pattern) => new Promise((resolve, reject) => {
      const check = () => {
        const found = pattern.exec(told);
        if (!found) return;
        waiting.delete(check);
        resolve(found);
      };
      waiting.add(check);
      check();
      gone.then((code) => reject(new Error(`hirosco ${words.join(' ')} ended with ${code}: ${told.slice(-2000)}`)));
    }),
    async end(signal = 'SIGTERM') {
      child.kill(signal);
      return gone;
    },
  };
}

/// `hirosco run` or another command that flies: with the URL of its page, or without one once it says `wait_for`.
export async function fly({mission = join(missions, 'rokviss'), command = 'run', more = [], wait_for = url_pattern} = {}) {
  const folder = new_folder();
  const flight = start(folder, [command, join(mission, 'mission.xml'), ...more]);
  const [url] = await flight.says(wait_for);
  return {url, folder, pid: flight.child.pid, told: flight.told, gone: flight.gone, async end() {
    await flight.end();
    rmSync(folder, {recursive: true, force: true});
  }};
}

/// The id of the process of `flight` that runs this program: of any flight's there may be several.
export function process_of(flight, name) {
  const found = new Map();
  for (const entry of readdirSync('/proc').filter((one) => /^\d+$/.test(one))) {
    try {
      const [, words, rest] = /^\d+ \((.*)\) (.*)$/s.exec(readFileSync(`/proc/${entry}/stat`, 'utf8'));
      found.set(Number(entry), {name: words, parent: Number(rest.split(' ')[1])});
    } catch { /* gone meanwhile */ }
  }
  const is_of_flight = (pid) => pid === flight.pid || (found.has(pid) && is_of_flight(found.get(pid).parent));
  // The system keeps 15 letters of a name.
  const [pid] = [...found.keys()].filter((one) => found.get(one).name === name.slice(0, 15) && is_of_flight(one));
  return pid;
}

/// `hirosco ground` beside a flight or without one.
export async function ground(folder, mission, port, token = '') {
  const words = ['ground', join(missions, mission, 'mission.xml'), '--port', String(port), '--archive', join(folder, `${mission}-ground.db`)];
  const station = start(folder, token ? [...words, '--token', token] : words);
  const [url] = await station.says(url_pattern);
  return {...station, url, token: /token=(\S+)/.exec(url)[1], origin: new URL(url).origin};
}
