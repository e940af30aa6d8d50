// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A visitor's first five minutes on a real flight: takes the handle by its shaft, shakes it, pushes the rail by the fingertip and by the
// handle, pulls the plug, reads what happened, puts the plug in and brings it up by one button; then the gateway stands still. HIROSCO_PICTURES: a folder for pictures of it.
import assert from 'node:assert/strict';
import {rmSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {bring_up, coupled, go, holds, inject, open_browser, open_page, small, take_hold} from './browser.mjs';
import {fly, free_port, ground} from './flight.mjs';

describe('a visitor', () => {
  let flight, station, browser, page, faults;
  before(async () => {
    flight = await fly({more: ['--no-ground'], wait_for: /commissioned/});
    station = await ground(flight.folder, 'rokviss', await free_port());
    browser = await open_browser({calm: true});
    ({page, faults} = await open_page(browser.context, station.url, small));
    await page.waitForSelector('[data-test=robot][data-loaded]');
    await coupled(page);
    await inject(page, 'joystick', 'hand target 0 0');
  });
  after(async () => {
    await browser?.close();
    await station?.end('SIGKILL');
    await flight?.end();
    if (station) rmSync(flight.folder, {recursive: true, force: true});
  });

  const picture = (name) => process.env.HIROSCO_PICTURES ? page.screenshot({path: join(process.env.HIROSCO_PICTURES, `${name}.png`)}) : null;
  const force_n = () => page.evaluate(() => Number(/force\s*([\d.]+)/.exec(document.querySelector('.readout')?.textContent ?? '')?.[1] ?? NaN));
  async function nothing_tripped(doing) {
    await sleep(500);
    const text = await page.evaluate(() => [...document.querySelectorAll('[data-test=events] tr')].map((row) => row.textContent).join('\n'));
    assert.doesNotMatch(text, /TORQUE_LIMIT_EXCEEDED|TORQUE_HARD/, doing);
    assert.equal(await page.locator('[data-test=stop-banner]').count(), 0, doing);
    await coupled(page);
  }

  const take = (from, to, choose) => take_hold(page, from, to, choose);
  /// The arm rests and touches nothing: the readout, told five times a second, has said the same for a second.
  const at_rest = () => holds(page, () => {
    const told = [...document.querySelectorAll('.readout b')].map((one) => Number(one.textContent.replace('−', '-')).toFixed(2)).join(' ');
    window.rests_for = told === window.told_before && told.endsWith(' 0.00') ? (window.rests_for ?? 0) + 1 : 0;
    window.told_before = told;
    return window.rests_for >= 10;
  });
  async function shake([x, y], reach_px, times) {
    for (let k = 0; k < times; ++k) {
      await page.mouse.move(x + (k % 2 ? -1 : 1) * reach_px, y + (k % 3 - 1) * reach_px / 2, {steps: 2});
      await sleep(40);
    }
  }

  for (const [where, choose] of [['at its foot', (places) => places.at(-1)], ['at its ball', (places) => places[0]],
    ['halfway', (places) => places[Math.floor(places.length / 2)]]]) {
    it(`takes the handle ${where}, drags it a little and shakes it, and nothing trips`, async () => {
      const place = await take(0.02, 0.45, choose);
      await page.mouse.move(place[0] + 24, place[1], {steps: 6});
      await sleep(300);
      await shake(place, 60, 16);
      await page.mouse.up();
      await nothing_tripped(`taken at ${place}`);
    });
  }

  it('pushes the rail by the handle, feels it, and nothing trips', async () => {
    const place = await take(0.02, 0.45, (places) => places[0]);
    let most_n = 0;
    // Down in the picture is the direction of the second axis, that bends the elbow open.
    for (const reach of [160, -160]) {
      await page.mouse.move(place[0], place[1] + reach, {steps: 6});
      for (const end_ms = performance.now() + 2500; performance.now() < end_ms; await sleep(100)) most_n = Math.max(most_n, await force_n());
    }
    await page.mouse.up();
    assert.ok(most_n > 5, `felt ${most_n} N`);
    await nothing_tripped('pushed by the handle');
  });

  it('pushes the rail by the fingertip as far as the mouse goes, and nothing trips', async () => {
    await at_rest();
    const place = await take(0.5, 0.85, (places) => places[Math.floor(places.length / 2)]);
    for (const reach of [28, 80, 200]) {
      await page.mouse.move(place[0] + reach, place[1], {steps: 6});
      await sleep(1000);
    }
    // To the right in the picture is along the rail as much as into it: as deep behind its surface at its end as where it was taken.
    await holds(page, () => Number(/force\s*([\d.]+)/.exec(document.querySelector('.readout')?.textContent ?? '')?.[1]) > 30);
    await picture('pushing');
    await shake([place[0] + 60, place[1]], 50, 16);
    await page.mouse.up();
    await nothing_tripped('pushed by the fingertip');
  });

  it('pulls the plug and is told where he looks: who, why, when, by which plan, and what is still well', async () => {
    await page.click('[data-test=faults]');
    await page.click('[data-test=fault-joystick-unplug]');
    await page.keyboard.press('Escape');
    await page.waitForSelector('[data-test=stop-banner]');
    await holds(page, () => /were stopped/.test(document.querySelector('[data-test=stop-title]')?.textContent));
    await holds(page, () => /plan network-down/.test(document.querySelector('[data-test=stop-banner]')?.textContent));
    const banner = await page.textContent('[data-test=stop-banner]');
    assert.match(banner, /JOYSTICK lost its device/);
    assert.match(banner, /MANIPULATOR/);
    assert.match(banner, /within [\d.]+ ms/);
    assert.match(banner, /COMMUNICATION/);
    await page.waitForSelector('[data-test=mode-stopped]');
    await page.waitForSelector('[data-test=link].good');
    await page.waitForSelector('[data-test=stopped-MANIPULATOR]:has-text("plan network-down")');
    await page.waitForSelector('[data-test=robot-verdict]:has-text("ACTUATORS INHIBITED")');
    await picture('stopped');
    await page.click('[data-test=stop-why]');
    await page.waitForSelector('[data-test=why] li');
    const causes = await page.locator('[data-test=why] li').allTextContents();
    assert.match(causes[0], /Fault injected: joystick unplug/);
    assert.match(causes[1], /JOYSTICK lost its device/);
    assert.ok(causes.every((text) => !/hand/.test(text)), causes.join('\n'));
    await picture('why');
  });

  it('replays the five seconds before, comes back, and the stop is still latched until it is acknowledged', async () => {
    await page.click('[data-test=stop-replay]');
    await page.waitForSelector('[data-test=replay-bar]');
    await holds(page, () => document.querySelector('[data-test=subsystem-JOYSTICK] .state')?.textContent === 'Operational');
    await page.click('[data-test=live]');
    await page.waitForSelector('[data-test=stop-banner]');
    await page.click('[data-test=stop-acknowledge]');
    await page.waitForSelector('[data-test=stop-banner]', {state: 'detached'});
    await page.waitForSelector('[data-test=mode-stopped]');
  });

  it('is told the true reason when it cannot be brought up', async () => {
    // The plug is still out.
    await go(page, 'subsystems/MANIPULATOR');
    await page.selectOption('[data-test=commission-mode]', 'telepresence');
    await page.click('[data-test=commission]');
    await page.waitForSelector('[data-test=commission-failed]');
    const told = await page.textContent('[data-test=commission-failed]');
    await picture('refused');
    assert.match(told, /JOYSTICK/, told);
    assert.doesNotMatch(told, /not permitted in this state$|code \d+$/, told);
    console.log(`told: ${told}`);
  });

  it('plugs in and brings it up by one button', async () => {
    await inject(page, 'joystick', 'plug');
    await bring_up(page, 'telepresence');
    await go(page, 'overview');
    await coupled(page);
  });

  it('is told that the link is silent while the gateway stands still, and that the picture is old', async () => {
    station.child.kill('SIGSTOP');
    await page.waitForSelector('[data-test=link].bad:has-text("LINK SILENT")');
    // The browser counts itself: who stands still says nothing of how old its last word is.
    for (const least_s of [3, 5]) {
      await holds(page, (least) => Number(/for (\d+) s/.exec(document.querySelector('[data-test=link]').textContent)?.[1]) >= least, least_s);
    }
    await page.waitForSelector('[data-test=robot-verdict]:has-text("old")');
    await picture('silent');
    station.child.kill('SIGCONT');
    await page.waitForSelector('[data-test=link].good');
    await coupled(page);
  });

  it('saw no error of the page', () => assert.deepEqual(faults.filter((one) => !/409|503/.test(one)), []));
});
