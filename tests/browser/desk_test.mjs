// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// HIROSCO_PAGE_SERVER=… HIROSCO_PAGE=… node --test desk_test.mjs: what somebody at a desk with this page looks up, writes down and shares, against a made-up flight.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {after, before, describe, it} from 'node:test';
import {at_view, go, holds, open_browser, open_page, small} from './browser.mjs';

const [server_file, page_folder] = [process.env.HIROSCO_PAGE_SERVER, process.env.HIROSCO_PAGE];

async function serve(recording) {
  const process_of = spawn('node', [server_file, recording, page_folder, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

let browser, served;
before(async () => {
  browser = await open_browser({calm: true});
  served = await serve('synthetic:well');
});
after(async () => {
  served.end();
  await browser.close();
});

describe('links', () => {
  it('show how long samples take beside their cycle, and how many came late', async () => {
    const {page, faults} = await open_page(browser.context, at_view(served.url, 'links'), small);
    await page.waitForSelector('[data-test=bars-1] svg');
    const bars = await page.locator('[data-test=bars-1] rect').evaluateAll((all) => all.map((one) => ({height: Number(one.getAttribute('height')), late: one.classList.contains('late'), words: one.textContent})));
    assert.equal(bars.length, 9);
    assert.deepEqual(bars.map((one) => one.late), [false, false, false, false, false, false, false, true, true]);
    assert.ok(bars[5].height > bars[4].height && bars[4].height > bars[2].height && bars[2].height > 0, JSON.stringify(bars));
    assert.equal(bars[0].height, 0);
    assert.match(bars[6].words, /within 500 µs \(1 of a period\)/);
    assert.equal(await page.textContent('[data-test=p99-1]'), '500 µs');
    assert.match(await page.textContent('[data-test=bars-1]'), /half ≤ 250 µs.*max 620 µs.*later than a cycle, 500 µs/s);
    assert.match(await page.getAttribute('[data-test=bars-1] svg', 'aria-label'), /^\d+ samples, half of them within 250 µs, 99 % within 500 µs, longest 620 µs, \d+ later than 500 µs$/);
    assert.deepEqual(faults, []);
    await page.close();
  });
});
