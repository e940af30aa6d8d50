// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node pictures.mjs FOLDER [STATE...]: every view in every state at three sizes, dark, and the overview light as well, to be looked at.
// STATE: one of those below, or `URL=http://…` of a station that is up. Started by tools/ground/pictures.
import {spawn} from 'node:child_process';
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {go, holds, open_browser, open_page, views} from './browser.mjs';

const [folder, ...only] = process.argv.slice(2);
const states = {fresh: 'synthetic:fresh', normal: 'synthetic:well', stopped: 'synthetic:stopped', stale: 'synthetic:stale', replay: 'synthetic:well', observer: 'synthetic:observer', foreign: 'synthetic:foreign'};
const sizes = [[1280, 720], [1440, 900], [1920, 1080]];
const settle_ms = 700, silent_ms = 8500;
mkdirSync(folder, {recursive: true});

async function serve(recording) {
  const process_of = spawn('node', [process.env.HIROSCO_PAGE_SERVER, recording, process.env.HIROSCO_PAGE, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

/// Until the surroundings of the robot stand in the picture, where there is one.
const is_whole = () => {
  const robot = document.querySelector('[data-test=robot]');
  return !robot || robot.dataset.still === 'whole' || (robot.dataset.tier === 'graphics card' && robot.dataset.surroundings === 'yes');
};

async function enter(page, state) {
  if (state === 'stopped') await page.waitForSelector('[data-test=stop-banner]');
  if (state === 'stale') await page.waitForTimeout(silent_ms);
  if (state === 'replay') {
    await go(page, 'timeline');
    await page.click('[data-test=replay-30]');
    await page.waitForSelector('[data-test=replay-bar]');
  }
}

async function take(page, state, theme) {
  for (const [width, height] of sizes) {
    await page.setViewportSize({width, height});
    for (const view of theme === 'light' ? ['overview'] : views) {
      await go(page, view);
      if (state !== 'fresh' && /overview|timeline/.test(view)) await holds(page, is_whole).catch(() => {});
      await page.waitForTimeout(settle_ms);
      await page.screenshot({path: join(folder, [state, theme, view.replaceAll('/', '-').toLowerCase(), `${width}.png`].filter(Boolean).join('-'))});
    }
  }
}

const browser = await open_browser();
const wanted = only.length ? only : Object.keys(states);
for (const state of wanted) {
  const served = state.startsWith('URL=') ? {url: state.slice(4), end() {}} : await serve(states[state]);
  const name = state.startsWith('URL=') ? 'station' : state;
  const {page, faults} = await open_page(browser.context, served.url);
  if (state !== 'fresh') await page.waitForSelector('[data-test^=subsystem-]');
  await enter(page, name);
  await take(page, name, '');
  await page.click('[data-test=theme]');
  await take(page, name, 'light');
  await page.click('[data-test=theme]');
  console.log(`${name}: ${sizes.length * (views.length + 1)} pictures${faults.length ? `, ${faults.join('; ')}` : ''}`);
  await page.close();
  served.end();
}
await browser.close();
