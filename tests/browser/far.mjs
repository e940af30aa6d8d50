// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A station that is far away: all that goes to it and comes from it takes as long as one is told, and now and then what was lost on the way is
// sent again, which holds up what is behind it, as TCP has it.
import {createServer, connect} from 'node:net';

/// The same losses each time.
function random_of(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/// From `from` to `to`, each piece `delay_ms` later, in order; of a part of them, `loss`, what was lost comes again after `again_ms`.
function carry(from, to, {delay_ms, loss, again_ms, random}, as_heard = (piece) => piece) {
  const under_way = [];
  let timer = null;
  const arrive = () => {
    timer = null;
    while (under_way.length && under_way[0].due_ms <= performance.now()) {
      const {piece} = under_way.shift();
      if (!piece) to.end();
      else if (to.writable) to.write(piece);
    }
    if (under_way.length) timer = setTimeout(arrive, Math.max(1, under_way[0].due_ms - performance.now()));
  };
  const send = (piece) => {
    const due_ms = performance.now() + delay_ms + (random() < loss ? again_ms : 0);
    under_way.push({piece, due_ms: Math.max(due_ms, under_way.at(-1)?.due_ms ?? 0)});
    timer ??= setTimeout(arrive, delay_ms);
  };
  from.on('data', (piece) => send(as_heard(piece)));
  from.on('end', () => send(null));
  from.on('error', () => to.destroy());
}

/// `url`, a station at a port of five digits, as it is reached from far away: {url, lost, close}; `lost()` pieces were sent twice.
export async function far_from(url, {delay_ms, loss, again_ms = 900, seed = 1}) {
  const {hostname, port} = new URL(url), sockets = new Set(), all = random_of(seed);
  let lost = 0;
  const random = () => {
    const drawn = all();
    if (drawn < loss) ++lost;
    return drawn;
  };
  // A station knows itself by its own port only, and both have five digits.
  const to_station = (piece) => Buffer.from(piece.toString('latin1').replaceAll(`127.0.0.1:${server.address().port}`, `127.0.0.1:${port}`), 'latin1');
  const server = createServer((near) => {
    const far = connect(Number(port), hostname);
    for (const socket of [near, far]) {
      sockets.add(socket.setNoDelay(true));
      socket.once('close', () => sockets.delete(socket));
    }
    carry(near, far, {delay_ms, loss, again_ms, random}, to_station);
    carry(far, near, {delay_ms, loss, again_ms, random});
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {url: url.replace(`:${port}/`, `:${server.address().port}/`), lost: () => lost, close: () => {
    for (const socket of sockets) socket.destroy();
    server.close();
  }};
}
