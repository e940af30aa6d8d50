// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node development/record.mjs URL SECONDS FILE: listens to a real gateway (URL with its #token=) and writes what
// development/server.mjs plays.
import {writeFileSync} from 'node:fs';
import {WebSocket} from 'ws';

const [url, seconds, file] = process.argv.slice(2);
if (!file) {
  console.error('usage: node development/record.mjs URL SECONDS FILE');
  process.exit(2);
}
const origin = new URL(url).origin, token = new URL(url).hash.replace('#token=', '');
const mission = await (await fetch(`${origin}/api/mission`, {headers: {Authorization: `Bearer ${token}`}})).json();
const messages = [];
const socket = new WebSocket(`${origin.replace('http', 'ws')}/ws?token=${token}`);
socket.on('message', (data) => {
  const message = JSON.parse(data);
  if (['values', 'event', 'status'].includes(message.type)) messages.push(message);
});
setTimeout(() => {
  socket.close();
  messages.sort((one, other) => one.t - other.t);
  writeFileSync(file, JSON.stringify({mission, messages}));
  console.log(`${messages.length} messages in ${file}`);
}, 1000 * Number(seconds));
