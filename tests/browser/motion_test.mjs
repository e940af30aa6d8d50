// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Motion between samples (ground/web/page/scene/motion.js) by a stepped clock: between what was measured, never ahead of it, and no picture
// repeats the one before while the robot moves. And curves: none where there was nothing.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {describe, it} from 'node:test';
import {pathToFileURL} from 'node:url';

const of_page = (file) => import(pathToFileURL(join(process.env.HIROSCO_SOURCES, 'ground/web/page', file)));
const {Motion} = await of_page('scene/motion.js');
const {alone, silences} = await of_page('parts/silences.js');
const {aligned} = await of_page('parts/rows.js');

/// Samples of `path(t_s)` each `period_ms`, drawn each `frame_ms`: [{now_ms, shown, newest, oldest}].
function play(path, {period_ms, frame_ms, seconds = 4, jitter = () => 0}) {
  const motion = new Motion(), drawn = [];
  let next_ms = 0, count = 0, newest = NaN, before = NaN;
  for (let now_ms = 0; now_ms < seconds * 1000; now_ms += frame_ms) {
    while (next_ms <= now_ms) {
      before = newest;
      newest = path(count * period_ms / 1000);
      motion.take([newest], next_ms);
      next_ms = ++count * period_ms + jitter(count);
    }
    drawn.push({now_ms, shown: motion.at(now_ms)[0], newest, before, moving: motion.moving()});
  }
  return drawn;
}
/// Pseudo-random in -1 … 1, the same each time.
function noise(seed) {
  let state = seed;
  return () => (state = state * 16807 % 2147483647) / 1073741823.5 - 1;
}

describe('motion between samples', () => {
  for (const [rate, period_ms] of [['10 Hz', 100], ['20 Hz', 50]]) {
    it(`of ${rate} gives a new pose at each of 60 frames a second, while the robot moves`, () => {
      const drawn = play((t) => 0.3 * t, {period_ms, frame_ms: 1000 / 60}).filter((one) => one.now_ms > 1000);
      const repeated = drawn.filter((one, i) => i > 0 && one.shown === drawn[i - 1].shown);
      assert.ok(drawn.length > 150);
      assert.equal(repeated.length, 0);
    });
  }

  it('is never ahead of the newest sample, nor behind the one before it, whenever they come', () => {
    for (let seed = 1; seed < 40; ++seed) {
      const next = noise(seed);
      const drawn = play((t) => 0.3 * t, {period_ms: 50, frame_ms: 7 + seed % 11, jitter: () => 20 * next()}).filter((one) => one.now_ms > 1000);
      for (const {shown, newest} of drawn) assert.ok(shown <= newest + 1e-12, `seed ${seed}: ${shown} after ${newest}`);
      // A rise stays a rise: nothing goes back and forth between samples.
      for (let i = 1; i < drawn.length; ++i) assert.ok(drawn[i].shown >= drawn[i - 1].shown - 1e-12, `seed ${seed}`);
    }
  });

  it('stops at the last sample when no other comes', () => {
    const motion = new Motion();
    motion.take([0], 0);
    motion.take([1], 100);
    assert.equal(motion.at(10000)[0], 1);
    assert.equal(motion.moving(), false);
  });

  it('begins where the robot stands, and where a replay has it', () => {
    const motion = new Motion();
    motion.take([0.7], 0);
    assert.equal(motion.at(0)[0], 0.7);
    motion.forget();
    motion.take([-1.2], 500);
    assert.equal(motion.at(500)[0], -1.2);
  });

  it('takes a joint that nobody knows for unknown, and shows the others', () => {
    const motion = new Motion();
    motion.take([undefined, 0.5], 0);
    motion.take([0.2, 0.6], 100);
    assert.ok(Math.abs(motion.at(1000)[0] - 0.2) < 1e-12);
    assert.ok(Math.abs(motion.at(1000)[1] - 0.6) < 1e-12);
  });
});

describe('a curve', () => {
  const every = (period_s, from, to) => Array.from({length: Math.round((to - from) / period_s)}, (_, i) => from + i * period_s);
  const of = (t, held_s = 2) => silences(t, 0, t.length, held_s);

  it('ends where its parameter fell silent, and nowhere else', () => {
    const t = [...every(0.5, 0, 10), ...every(0.5, 30, 40)];
    assert.deepEqual(of(t), [[9.5, 30]]);
    assert.deepEqual(of(every(0.5, 0, 40)), []);
    assert.deepEqual(silences(t, 0, 20, 2), [], 'what is not shown is not looked at');
  });

  it('goes through ranges of an archive, however far apart they all are, and through what was made coarser', () => {
    assert.deepEqual(of(every(8, 0, 800)), []);
    assert.deepEqual(of([...every(6, 0, 600), ...every(3, 600, 700), ...every(0.5, 700, 720)]), []);
    assert.deepEqual(of([...every(3, 0, 60), ...every(3, 200, 260)]), [[57, 200]]);
  });

  it('ends behind a sample that stands alone', () => assert.deepEqual(of([...every(0.5, 0, 5), 60, ...every(0.5, 120, 125)]), [[4.5, 60], [60, 120]]));
  it('of two samples far apart is none', () => assert.deepEqual(of([0, 50]), [[0, 50]]));
  it('is nothing at any time of a silence, whoever else has samples then', () => {
    const none = (t) => t.map(() => null);
    const [one, other] = [[...every(0.5, 0, 5), ...every(0.5, 20, 25)], every(1, 0, 25)].map((t) => ({t, v: t.map(() => 7), low: none(t), high: none(t)}));
    const [t, values, , , others] = aligned([one, other], 0, 25, () => 2);
    t.forEach((at, i) => assert.equal(values[i], at > 4.5 && at < 20 ? null : one.t.includes(at) ? 7 : undefined, `at ${at}`));
    assert.ok(t.includes(6.5), 'where there would be no time at all, one is put in');
    assert.ok(others.every((value) => value !== null), 'the other one was never silent');
    assert.deepEqual(aligned([one, other], 0, 25)[1].filter((value) => value === null), [], 'in a table of samples there is no more than samples');
  });
  it('shows a sample that no line reaches as a point', () => {
    assert.deepEqual(alone([1, undefined, 2, null, 3, undefined, null, undefined, 4, 5]), [4]);
    assert.deepEqual(alone([undefined, 7, undefined]), [1]);
    assert.deepEqual([alone([1, 2, 3]), alone([null, undefined]), alone([])], [[], [], []]);
    assert.deepEqual(alone([1, null, 2]), [0, 2]);
  });
  it('of one sample, or of none, has no end', () => assert.deepEqual([of([3]), of([])], [[], []]));
});
