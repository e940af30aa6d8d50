// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The looks of the page in every view, at three sizes, dark and light, without anybody looking: nothing cut, nothing on something else,
// nothing too faint, no letter of a foreign typeface; and by grey that all is well. At the smallest size, where there is least room; with
// HIROSCO_SLICE=whole at all three.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {go, holds, open_browser, open_page, until, views} from './browser.mjs';
import {cut_texts, faint_texts, loud_texts, overlapping_texts, typefaces} from './looks.mjs';

const [server_file, page_folder] = [process.env.HIROSCO_PAGE_SERVER, process.env.HIROSCO_PAGE];
const sizes = [[1280, 720], [1440, 900], [1920, 1080]].slice(0, process.env.HIROSCO_SLICE === 'whole' ? 3 : 1);

async function serve(recording) {
  const process_of = spawn('node', [server_file, recording, page_folder, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

/// Until what was asked for is there and drawn: nothing is under way, the letters are there, and a few pictures have passed.
function watch(page) {
  const under_way = new Set();
  page.on('request', (request) => { if (request.url().includes('/api/')) under_way.add(request); });
  for (const end of ['requestfinished', 'requestfailed']) page.on(end, (request) => under_way.delete(request));
  return async () => {
    await until('answers', () => under_way.size === 0);
    await page.evaluate(async () => {
      await document.fonts.ready;
      for (let i = 0; i < 3; ++i) await new Promise((resolve) => requestAnimationFrame(resolve));
    });
  };
}

/// After another size: tags of the robot find their places with its next pictures, which one who does not move draws two of and no more.
const placed = (page) => page.evaluate(async (longest_ms) => {
  const robot = document.querySelector('[data-test=robot]'), first = Number(robot?.dataset.frames), began = performance.now();
  while (robot && Number(robot.dataset.frames) < first + 3 && performance.now() - began < longest_ms) await new Promise((resolve) => setTimeout(resolve, 50));
}, 1000);

/// What opens above a view: [what is clicked, what is there then].
const popups = [['[data-test=mode]', '[data-test=mode-menu]'], ['[data-test=commander]', '[data-test=commander-menu]'], ['[data-test=faults]', '[data-test=faults-drawer]']];

let browser;
before(async () => { browser = await open_browser({calm: true}); });
after(() => browser.close());

for (const state of ['synthetic:well', 'synthetic:stopped']) {
  describe(`the page of a flight that is ${state === 'synthetic:well' ? 'well' : 'stopped'}`, () => {
    let served;
    const found = {cut: [], overlapping: [], faint: [], colourless: [], strangers: new Set(), loud: [], tops: new Set()};
    // One way through all views for all that is judged: entering one costs most where the processor draws, another size of it little.
    before(async () => {
      served = await serve(state);
      const {page} = await open_page(browser.context, served.url, {width: sizes[0][0], height: sizes[0][1]});
      const settled = watch(page);
      await page.waitForSelector('[data-test=subsystem-MANIPULATOR]');
      if (state !== 'synthetic:well') await page.waitForSelector('[data-test=stop-banner]');
      else await holds(page, () => [...document.querySelectorAll('[data-test^=subsystem-] .state')].every((one) => one.textContent === 'Operational'));
      const judge_layout = async (where) => {
        found.cut.push(...(await page.evaluate(cut_texts)).map((one) => `${where}: ${one}`));
        found.overlapping.push(...(await page.evaluate(overlapping_texts)).map((one) => `${where}: ${one}`));
      };
      /// A colour that no token has by its name is empty, and what is drawn with it is not there.
      const judge_colours = async (where) => found.colourless.push(...await page.evaluate((at) => [...document.querySelectorAll('main [stroke=""], main [fill=""]')].map((one) => `${at}: ${one.closest('[title]')?.title ?? one.tagName}`), where));
      const judge_contrast = async (where) => found.faint.push(...(await page.evaluate(faint_texts)).map((one) => `${where}: ${one}`));
      for (const view of views) {
        await go(page, view);
        await page.waitForSelector('main .panel');
        if (/overview|timeline/.test(view)) await page.waitForSelector('[data-test=robot][data-loaded]');
        for (const [width, height] of sizes) {
          await page.setViewportSize({width, height});
          await settled();
          found.tops.add(await page.evaluate(() => document.querySelector('main').getBoundingClientRect().top - (innerHeight > 800 ? 40 : 36)));
          if (sizes.length > 1) await placed(page);
          await judge_layout(`${view} ${width}x${height}`);
        }
        // Colours and letters are the same at every size.
        await judge_contrast(view);
        await judge_colours(view);
        for (const [name, {letters, own}] of await typefaces(page)) if (!own) found.strangers.add(`${letters} letters of ${name}`);
        await page.click('[data-test=theme]');
        await settled();
        await judge_contrast(`light: ${view}`);
        await judge_colours(`light: ${view}`);
        await page.click('[data-test=theme]');
        if (view === 'overview') found.loud = await page.evaluate(loud_texts);
      }
      await page.setViewportSize({width: sizes[0][0], height: sizes[0][1]});
      for (const [button, popup] of popups) {
        await page.click(button);
        await page.waitForSelector(popup);
        await settled();
        await judge_layout(popup);
        await judge_contrast(popup);
        await page.keyboard.press('Escape');
        await page.waitForSelector(popup, {state: 'detached'});
      }
      await page.close();
    });
    after(() => served.end());

    // Whether something stopped or not: what comes moves nothing below it.
    it('begins each view at the same height', () => assert.deepEqual([...found.tops], [48]));
    it('cuts no text', () => assert.deepEqual(found.cut, []));
    it('has no text on another', () => assert.deepEqual(found.overlapping, []));
    it('has no word with a contrast below 4.5, dark or light', () => assert.deepEqual(found.faint, []));
    it('draws nothing in a colour that no token has', () => assert.deepEqual(found.colourless, []));
    it('draws every letter with its own typefaces', () => assert.deepEqual([...found.strangers], []));
    if (state === 'synthetic:well') it('is grey where all is well', () => assert.deepEqual(found.loud, []));
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
