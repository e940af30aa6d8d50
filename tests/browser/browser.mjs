// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A headless Chromium with a page that is open at the gateway's URL, and what went wrong in it.
import {existsSync} from 'node:fs';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
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
    rmSync(folder, {recursive: true, force: true});
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
