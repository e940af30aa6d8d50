// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A headless Chromium with a page that is open at the gateway's URL, and what went wrong in it.
import assert from 'node:assert/strict';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';
import {chromium} from 'playwright-core';

export const executable = process.env.HIROSCO_CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);

export const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];

/// `calm`: its user asked for less motion, so the page draws four pictures a second, which leaves the processors to what is tested.
export async function open_browser({calm = false} = {}) {
  const folder = mkdtempSync(join(tmpdir(), 'hirosco-browser-'));
  const context = await chromium.launchPersistentContext(folder, {executablePath: executable, headless: true, args: flags,
    viewport: {width: 1600, height: 900}, acceptDownloads: true, reducedMotion: calm ? 'reduce' : 'no-preference'});
  return {context, async close() {
    await context.close();
    // A helper of the browser may still write for a moment.
    rmSync(folder, {recursive: true, force: true, maxRetries: 20, retryDelay: 100});
  }};
}

/// A wait is for a condition, and ends when that holds. This much without it says that it never will, also where a browser that draws
/// in software shares two processors with a flight and a compiler.
export const patience_ms = 120000;

/// The smallest window that the page is made for: the cheapest to draw.
export const small = {width: 1280, height: 720};

/// Waits until `condition(value)` in the page is true, and hands out what it answered. Looked at ten times a second: at every frame, as
/// is usual, would make a browser without a graphics card draw sixty of them a second for nothing else.
export const holds = (page, condition, value) => page.waitForFunction(condition, value, {polling: 100});

/// The address of a view at a printed URL. The robot is drawn in the overview and beside the timeline only: who has no need of it opens another.
export const at_view = (url, view) => url.replace('#', `#/${view}?`);

/// Opens `url`; `faults` fills with console errors, exceptions and requests to anybody else.
export async function open_page(context, url, size = {width: 1600, height: 900}) {
  const page = await context.newPage();
  page.setDefaultTimeout(patience_ms);
  await page.setViewportSize(size);
  const faults = [];
  const own = new URL(url).host;
  page.on('console', (message) => message.type() === 'error' && faults.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => faults.push(`exception: ${error.message}`));
  page.on('request', (request) => {
    const target = new URL(request.url());
    if (!['blob:', 'data:'].includes(target.protocol) && target.host !== own) faults.push(`request to ${target.host}`);
  });
  await page.goto(url);
  return {page, faults};
}

/// Every view of the page on rokviss, by its address.
export const views = ['overview', 'subsystems/MANIPULATOR', 'plots', 'commands/MANIPULATOR/MOVE_TO', 'links', 'events', 'timeline', 'help'];

/// To a view, as following its address does.
export async function go(page, view) {
  await page.evaluate((to) => { location.hash = `#/${to}`; }, view);
  await holds(page, (to) => document.querySelector('nav a.on')?.getAttribute('href') === `#/${to}`, view.split(/[/?]/)[0]);
}

/// Counts what somebody has to click: real ones only, of whatever is in the page. Hands out what tells how many there were since.
export async function count_clicks(page) {
  await page.evaluate(() => {
    window.clicked = 0;
    window.count_click ??= (event) => { if (event.isTrusted && event.detail > 0) ++window.clicked; };
    document.addEventListener('click', window.count_click, {capture: true});
  });
  return () => page.evaluate(() => window.clicked);
}

/// Clicks where `selector` is seen, as a hand does: nothing is scrolled for it, and what lies under something else or outside its panel is
/// not clicked.
export async function click_where_seen(page, selector, options) {
  const place = await holds(page, (what) => {
    const box = document.querySelector(what).getBoundingClientRect(), [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const [before, seen] = [window.place, document.elementFromPoint(x, y)?.closest(what)];
    window.place = `${what} ${x} ${y}`;
    return seen && before === window.place && [x, y];
  }, selector);
  await page.mouse.click(...await place.jsonValue(), options);
}

/// A line to the socket of a simulated device, by the gateway.
export const inject = (page, device, line) => page.evaluate(async ([one, words]) => {
  const answer = await fetch('/api/faults', {method: 'POST', body: JSON.stringify({device: one, line: words}),
    headers: {'Content-Type': 'application/json', Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}});
  if (!answer.ok) throw new Error(`${one} ${words}: ${await answer.text()}`);
}, [device, line]);

/// In the page: both machines of rokviss are told to be coupled and nothing to be stopped.
export const is_coupled = () => document.querySelector('[data-test=mode] b')?.textContent === 'telepresence' &&
  !document.querySelector('[data-test=mode-stopped]') && ['MANIPULATOR', 'JOYSTICK'].every((name) =>
    document.querySelector(`[data-test=subsystem-${name}] .state`)?.textContent === 'Operational');
export const coupled = (page) => holds(page, is_coupled);

/// The whole network by one button of the subsystems' view; a bring-up that fails says at which step and why.
export async function bring_up(page, mode) {
  await go(page, 'subsystems/MANIPULATOR');
  await page.selectOption('[data-test=commission-mode]', mode);
  await page.click('[data-test=commission]');
  const end = page.locator('[data-test=commissioned], [data-test=commission-failed]');
  await end.waitFor();
  assert.match(await end.textContent(), /is up$/);
}

/// Every place in a part of the robot's picture where the cursor says "grab", from above to below: asked without moving the mouse.
export async function grips(page, from, to) {
  const found = await page.evaluate(([left, right]) => {
    const canvas = document.querySelector('[data-test=robot] canvas');
    const box = canvas.getBoundingClientRect();
    const places = [];
    const step = 8;  // a handle is wider
    for (let y = box.y + 50; y < box.bottom - 40; y += step) {
      for (let x = box.x + box.width * left; x < box.x + box.width * right; x += step) {
        canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: x, clientY: y, buttons: 0}));
        if (canvas.style.cursor === 'grab') places.push([x, y]);
      }
    }
    return places;
  }, [from, to]);
  assert.ok(found.length > 0, 'there is something to take');
  return found;
}

/// Takes hold of something there; the arm moves meanwhile: a hand that closes on nothing reaches again.
export async function take_hold(page, from, to, choose) {
  for (let reaches = 0; reaches < 20; ++reaches) {
    const place = choose(await grips(page, from, to));
    await page.mouse.move(...place);
    await page.mouse.down();
    if (await page.evaluate(() => document.querySelector('[data-test=robot] canvas').style.cursor) === 'grabbing') return place;
    await page.mouse.up();
  }
  return assert.fail('took hold of nothing in 20 reaches');
}

/// Waits until `is_so` answers true; a wait that leads nowhere says what for.
export async function until(what, is_so, limit_s = patience_ms / 1000) {
  for (const end = performance.now() + limit_s * 1000; !await is_so(); await sleep(50)) {
    if (performance.now() > end) throw new Error(`${what}: not within ${limit_s} s`);
  }
}

/// What axe-core finds serious or critical in any view. Its contrast takes most of the time; looks_test.mjs judges that itself, in every
/// view, state and theme.
export async function serious_findings(page, {contrast = true} = {}) {
  const source = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
  const found = [];
  for (const view of views) {
    await go(page, view);
    await page.waitForSelector('main .panel');
    await page.evaluate(source);
    const {violations} = await page.evaluate((enabled) => window.axe.run(document, {resultTypes: ['violations'], rules: {'color-contrast': {enabled}}}), contrast);
    for (const one of violations.filter(({impact}) => ['serious', 'critical'].includes(impact))) {
      found.push(`${view}: ${one.id}: ${one.nodes.slice(0, 3).map((node) => node.html.slice(0, 120)).join(' | ')}`);
    }
  }
  return found;
}
