// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node screenshots.mjs URL FOLDER [VIEW...]: pictures of every view at four sizes, to be looked at.
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {open_browser, open_page} from './browser.mjs';

const [url, folder, ...only] = process.argv.slice(2);
const views = {
  overview: '#/overview', subsystems: '#/subsystems/MANIPULATOR', plots: '#/plots', commands: '#/commands/MANIPULATOR/MOVE_TO', links: '#/links',
  events: '#/events', timeline: '#/timeline', help: '#/help',
};
const settle_ms = 2500;
mkdirSync(folder, {recursive: true});
const browser = await open_browser();
for (const size of [{width: 1440, height: 900}, {width: 1920, height: 1080}, {width: 1280, height: 720}, {width: 1024, height: 768}]) {
  const {page, faults} = await open_page(browser.context, url, size);
  await page.waitForSelector('[data-test^=subsystem-]');
  for (const [name, hash] of Object.entries(views)) {
    if (only.length && !only.includes(name)) continue;
    await page.evaluate((to) => { location.hash = to; }, hash);
    await page.waitForTimeout(settle_ms);
    await page.screenshot({path: join(folder, `${name}-${size.width}.png`)});
  }
  if (faults.length) console.log(faults.join('\n'));
  await page.close();
}
await browser.close();
