// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The looks of the page in every view, at three sizes, dark and light, without anybody looking: nothing cut, nothing on something else,
// nothing too faint, no letter of a foreign typeface; and by grey that all is well.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {go, holds, open_browser, open_page, views} from './browser.mjs';
import {cut_texts, faint_texts, overlapping_texts, typefaces} from './looks.mjs';

const [server_file, page_folder] = [process.env.HIROSCO_PAGE_SERVER, process.env.HIROSCO_PAGE];
export const sizes = [[1280, 720], [1440, 900], [1920, 1080]];

async function serve(recording) {
  const process_of = spawn('node', [server_file, recording, page_folder, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

let browser;
before(async () => { browser = await open_browser(); });
after(() => browser.close());

for (const state of ['synthetic:well', 'synthetic:stopped']) {
  describe(`the page of a flight that is ${state === 'synthetic:well' ? 'well' : 'stopped'}`, () => {
    let served, page;
    before(async () => {
      served = await serve(state);
      ({page} = await open_page(browser.context, served.url));
      await page.waitForSelector('[data-test=subsystem-MANIPULATOR]');
      if (state !== 'synthetic:well') await page.waitForSelector('[data-test=stop-banner]');
    });
    after(() => served.end());

    async function in_every_view(judge) {
      for (const [width, height] of sizes) {
        await page.setViewportSize({width, height});
        for (const view of views) {
          await go(page, view);
          await page.waitForSelector('main .panel');
          await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 300)));
          await judge(`${view} ${width}x${height}`);
        }
      }
    }

    // Entering a view costs more than all that is judged there: once dark, once light.
    const found = {cut: [], overlapping: [], faint: [], strangers: new Set()};
    before(async () => {
      const note = (list, where, wrong) => list.push(...wrong.map((one) => `${where}: ${one}`));
      await in_every_view(async (where) => {
        note(found.cut, where, await page.evaluate(cut_texts));
        note(found.overlapping, where, await page.evaluate(overlapping_texts));
        note(found.faint, where, await page.evaluate(faint_texts));
        for (const [name, {letters, own}] of await typefaces(page)) if (!own) found.strangers.add(`${letters} letters of ${name}`);
      });
      await page.click('[data-test=theme]');
      await in_every_view(async (where) => note(found.faint, `light: ${where}`, await page.evaluate(faint_texts)));
      await page.click('[data-test=theme]');
    });

    it('cuts no text', () => assert.deepEqual(found.cut, []));
    it('has no text on another', () => assert.deepEqual(found.overlapping, []));
    it('has no word with a contrast below 4.5, dark or light', () => assert.deepEqual(found.faint, []));
    it('draws every letter with its own typefaces', () => assert.deepEqual([...found.strangers], []));
    if (state === 'synthetic:well') {
      it('is grey where all is well', async () => {
        await go(page, 'overview');
        await holds(page, () => document.querySelectorAll('.card').length > 0);
        const loud = await page.evaluate(() => [...document.querySelectorAll('main *, header *')].filter((node) => !node.closest('.robot, .safe_all, .count, [data-test=events]')).flatMap((node) => {
          const style = getComputedStyle(node);
          const [r, g, b] = style.color.match(/[\d.]+/g).map(Number);
          const own = [...node.childNodes].some((one) => one.nodeType === Node.TEXT_NODE && one.textContent.trim());
          return own && r > 200 && Math.max(g, b) < 190 && r - Math.min(g, b) > 70 ? [`${node.className}: ${node.textContent.slice(0, 30)}`] : [];
        }));
        assert.deepEqual(loud, []);
      });
    }
  });
}

describe('the colours of the page', () => {
  it('are those of the tokens: no other stands in a rule of its own', () => {
    const folder = join(process.env.HIROSCO_SOURCES, 'ground/web/page/styles');
    const tokens = readFileSync(join(folder, 'tokens.css'), 'utf8');
    const known = new Set(tokens.match(/#[0-9a-f]{6}\b/g));
    // White on what is red or blue in every theme, the stop banner, and the scene, where it is dark always.
    const allowed = new Set(['#ffffff', '#a31d24', '#8c161d', '#ff8078', '#ffe3e1', '#6f1017', '#560b11', '#f0c9c9', '#6d0d14', '#14060a']);
    const strangers = readdirSync(folder).filter((name) => !['tokens.css', 'scene.css'].includes(name)).flatMap((name) =>
      (readFileSync(join(folder, name), 'utf8').match(/#[0-9a-f]{6}\b/g) ?? []).filter((one) => !known.has(one) && !allowed.has(one)).map((one) => `${name}: ${one}`));
    assert.deepEqual(strangers, []);
  });
});
