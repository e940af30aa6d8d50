// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A headless Chromium with a page that is open at the gateway's URL, and what went wrong in it.
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';
import {chromium} from 'playwright-core';

export const executable = process.env.HIROSCO_CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);

export const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];

export async function open_browser() {
  const folder = mkdtempSync(join(tmpdir(), 'hirosco-browser-'));
  const context = await chromium.launchPersistentContext(folder, {executablePath: executable, headless: true, args: flags,
    viewport: {width: 1600, height: 900}, acceptDownloads: true});
  return {context, async close() {
    await context.close();
    // A helper of the browser may still write for a moment.
    rmSync(folder, {recursive: true, force: true, maxRetries: 20, retryDelay: 100});
  }};
}

/// Opens `url`; `faults` fills with console errors, exceptions and requests to anybody else.
export async function open_page(context, url, size = {width: 1600, height: 900}) {
  const page = await context.newPage();
  await page.setViewportSize(size);
  const faults = [];
  const own = new URL(url).origin;
  page.on('console', (message) => message.type() === 'error' && faults.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => faults.push(`exception: ${error.message}`));
  page.on('request', (request) => {
    const target = new URL(request.url());
    if (!['blob:', 'data:'].includes(target.protocol) && target.host !== new URL(own).host) faults.push(`request to ${target.host}`);
  });
  await page.goto(url);
  return {page, faults};
}

/// Every view of the page on rokviss, by its address.
export const views = ['overview', 'subsystems/MANIPULATOR', 'plots', 'commands/MANIPULATOR/MOVE_TO', 'links', 'events', 'timeline', 'help'];

/// To a view, as following its address does.
export async function go(page, view) {
  await page.evaluate((to) => { location.hash = `#/${to}`; }, view);
  await page.waitForFunction((to) => document.querySelector('nav a.on')?.getAttribute('href') === `#/${to}`, view.split(/[/?]/)[0]);
}

/// Waits until `holds` answers true; a wait that leads nowhere says what for.
export async function until(what, holds, limit_s = 30) {
  for (const end = performance.now() + limit_s * 1000; !await holds(); await sleep(20)) {
    if (performance.now() > end) throw new Error(`${what}: not within ${limit_s} s`);
  }
}

/// What axe-core finds serious or critical in any view.
export async function serious_findings(page) {
  const source = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
  const found = [];
  for (const view of views) {
    await go(page, view);
    await page.waitForSelector('main .panel');
    await page.evaluate(source);
    const {violations} = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
    for (const one of violations.filter(({impact}) => ['serious', 'critical'].includes(impact))) {
      found.push(`${view}: ${one.id}: ${one.nodes.slice(0, 3).map((node) => node.html.slice(0, 120)).join(' | ')}`);
    }
  }
  return found;
}
