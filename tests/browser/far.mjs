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

/// From `from` to `to`, each piece `delay_ms` later; of a part of them, `loss`, what was lost comes again after `again_ms`.
function carry(from, to, {delay_ms, loss, again_ms, random}) {
  let free_ms = 0;
  from.on('data', (piece) => {
    free_ms = Math.max(free_ms, performance.now() + delay_ms + (random() < loss ? again_ms : 0));
    setTimeout(() => to.writable && to.write(piece), free_ms - performance.now());
  });
  from.on('close', () => setTimeout(() => to.destroy(), Math.max(0, free_ms - performance.now()) + delay_ms));
  from.on('error', () => {});
}

/// `url` as it is reached from far away: {url, lost, close}; `lost()` pieces were sent twice.
export async function far_from(url, {delay_ms, loss, again_ms = 900, seed = 1}) {
  const there = new URL(url), sockets = new Set(), all = random_of(seed);
  let lost = 0;
  const random = () => {
    const drawn = all();
    if (drawn < loss) ++lost;
    return drawn;
  };
  const server = createServer((near) => {
    const far = connect(Number(there.port), there.hostname);
    for (const socket of [near, far]) {
      sockets.add(socket.setNoDelay(true));
      socket.once('close', () => sockets.delete(socket));
    }
    carry(near, far, {delay_ms, loss, again_ms, random});
    carry(far, near, {delay_ms, loss, again_ms, random});
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  there.port = String(server.address().port);
  return {url: there.href, lost: () => lost, close: () => {
    for (const socket of sockets) socket.destroy();
    server.close();
  }};
}
