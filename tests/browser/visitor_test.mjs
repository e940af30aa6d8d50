// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A visitor's first five minutes on a real flight: takes the handle by its shaft, shakes it, pushes the rail by the fingertip and by the
// handle, pulls the plug, reads what happened, puts the plug in and brings it up by one button, again and again; then the gateway stands
// still. HIROSCO_RECOVERIES: how often (10). HIROSCO_PICTURES: a folder for pictures of it.
import assert from 'node:assert/strict';
import {rmSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {setTimeout as sleep} from 'node:timers/promises';
import {go, open_browser, open_page} from './browser.mjs';
import {fly, free_port, ground} from './flight.mjs';

const wait = {timeout: 90000};
const recoveries = Number(process.env.HIROSCO_RECOVERIES ?? 10);

describe('a visitor', () => {
  let flight, station, browser, page, faults;
  before(async () => {
    flight = await fly({more: ['--no-ground'], wait_for: /commissioned/});
    station = await ground(flight.folder, 'rokviss', await free_port());
    browser = await open_browser();
    ({page, faults} = await open_page(browser.context, station.url, {width: 1440, height: 900}));
    await page.waitForSelector('[data-test=robot][data-loaded]', wait);
    await mode_holds();
    await inject('joystick', 'hand target 0 0');
  });
  after(async () => {
    await browser?.close();
    await station?.end('SIGKILL');
    await flight?.end();
    if (station) rmSync(flight.folder, {recursive: true, force: true});
  });

  const inject = (device, line) => page.evaluate(([one, words]) => fetch('/api/faults', {method: 'POST', body: JSON.stringify({device: one, line: words}),
    headers: {'Content-Type': 'application/json', Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}}), [device, line]);
  const picture = (name) => process.env.HIROSCO_PICTURES ? page.screenshot({path: join(process.env.HIROSCO_PICTURES, `${name}.png`)}) : null;
  const mode_holds = () => page.waitForFunction(() => document.querySelector('[data-test=mode] b')?.textContent === 'telepresence' &&
    !document.querySelector('[data-test=mode-stopped]') && document.querySelector('[data-test=subsystem-MANIPULATOR] .state')?.textContent === 'Operational' &&
    document.querySelector('[data-test=subsystem-JOYSTICK] .state')?.textContent === 'Operational', null, wait);
  const force_n = () => page.evaluate(() => Number(/force\s*([\d.]+)/.exec(document.querySelector('.readout')?.textContent ?? '')?.[1] ?? NaN));
  async function nothing_tripped(doing) {
    await sleep(500);
    const text = await page.evaluate(() => [...document.querySelectorAll('[data-test=events] tr')].map((row) => row.textContent).join('\n'));
    assert.doesNotMatch(text, /TORQUE_LIMIT_EXCEEDED|TORQUE_HARD/, doing);
    assert.equal(await page.locator('[data-test=stop-banner]').count(), 0, doing);
    await mode_holds();
  }

  /// Every place in a part of the picture where the cursor says "grab", from above to below: asked without moving the mouse.
  async function grips(from, to) {
    const found = await page.evaluate(([left, right]) => {
      const canvas = document.querySelector('[data-test=robot] canvas');
      const box = canvas.getBoundingClientRect();
      const places = [];
      for (let y = box.y + 50; y < box.bottom - 40; y += 5) {
        for (let x = box.x + box.width * left; x < box.x + box.width * right; x += 5) {
          canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: x, clientY: y, buttons: 0}));
          if (canvas.style.cursor === 'grab') places.push([x, y]);
        }
      }
      return places;
    }, [from, to]);
    assert.ok(found.length > 0, 'there is something to take');
    return found;
  }
  async function shake([x, y], reach_px, times) {
    for (let k = 0; k < times; ++k) {
      await page.mouse.move(x + (k % 2 ? -1 : 1) * reach_px, y + (k % 3 - 1) * reach_px / 2, {steps: 4});
      await sleep(40);
    }
  }

  it('takes the handle at its shaft and at its ball, drags it a little and shakes it, and nothing trips', async () => {
    const places = await grips(0.02, 0.45);
    for (const place of [places.at(-1), places[0], places[Math.floor(places.length / 2)]]) {
      await page.mouse.move(...place);
      await page.mouse.down();
      await page.mouse.move(place[0] + 24, place[1], {steps: 12});
      await sleep(300);
      await shake(place, 60, 30);
      await page.mouse.up();
      await nothing_tripped(`taken at ${place}`);
    }
  });

  it('pushes the rail by the handle, feels it, and nothing trips', async () => {
    const [place] = await grips(0.02, 0.45);
    await page.mouse.move(...place);
    await page.mouse.down();
    // Down in the picture is the direction of the second axis, that bends the elbow open.
    await page.mouse.move(place[0], place[1] + 160, {steps: 10});
    await sleep(2500);
    await page.mouse.move(place[0], place[1] - 160, {steps: 10});
    await sleep(2500);
    await page.mouse.up();
    await nothing_tripped('pushed by the handle');
  });

  it('pushes the rail by the fingertip as far as the mouse goes, and nothing trips', async () => {
    await sleep(2000);
    const places = await grips(0.5, 0.85);
    const place = places[Math.floor(places.length / 2)];
    await page.mouse.move(...place);
    await page.mouse.down();
    let most_n = 0;
    for (const reach of [28, 80, 200]) {
      await page.mouse.move(place[0] + reach, place[1], {steps: 6});
      await sleep(1500);
      most_n = Math.max(most_n, await force_n());
      if (reach === 80) await picture('pushing');
    }
    await shake([place[0] + 60, place[1]], 50, 20);
    await page.mouse.up();
    assert.ok(most_n > 15, `felt ${most_n} N`);
    await nothing_tripped('pushed by the fingertip');
  });

  it('pulls the plug and is told where he looks: who, why, when, by which plan, and what is still well', async () => {
    await page.click('[data-test=faults]');
    await page.click('[data-test=fault-joystick-unplug]');
    await page.keyboard.press('Escape');
    await page.waitForSelector('[data-test=stop-banner]', wait);
    await page.waitForFunction(() => /were stopped/.test(document.querySelector('[data-test=stop-title]')?.textContent), null, wait);
    await page.waitForFunction(() => /plan network-down/.test(document.querySelector('[data-test=stop-banner]')?.textContent), null, wait);
    const banner = await page.textContent('[data-test=stop-banner]');
    assert.match(banner, /JOYSTICK lost its device/);
    assert.match(banner, /MANIPULATOR/);
    assert.match(banner, /within [\d.]+ ms/);
    assert.match(banner, /COMMUNICATION/);
    await page.waitForSelector('[data-test=mode-stopped]', wait);
    await page.waitForSelector('[data-test=link].good', wait);
    await page.waitForSelector('[data-test=stopped-MANIPULATOR]:has-text("plan network-down")', wait);
    await page.waitForSelector('[data-test=robot-verdict]:has-text("ACTUATORS INHIBITED")', wait);
    await picture('stopped');
    await page.click('[data-test=stop-why]');
    await page.waitForSelector('[data-test=why] li', wait);
    const causes = await page.locator('[data-test=why] li').allTextContents();
    assert.match(causes[0], /Fault injected: joystick unplug/);
    assert.match(causes[1], /JOYSTICK lost its device/);
    assert.ok(causes.every((text) => !/hand/.test(text)), causes.join('\n'));
    await picture('why');
  });

  it('replays the five seconds before, comes back, and the stop is still latched until it is acknowledged', async () => {
    await page.click('[data-test=stop-replay]');
    await page.waitForSelector('[data-test=replay-bar]', wait);
    await page.waitForFunction(() => document.querySelector('[data-test=subsystem-JOYSTICK] .state')?.textContent === 'Operational', null, wait);
    await page.click('[data-test=live]');
    await page.waitForSelector('[data-test=stop-banner]', wait);
    await page.click('[data-test=stop-acknowledge]');
    await page.waitForSelector('[data-test=stop-banner]', {state: 'detached', ...wait});
    await page.waitForSelector('[data-test=mode-stopped]', wait);
  });

  it('is told the true reason when it cannot be brought up', async () => {
    // The plug is still out.
    await go(page, 'subsystems/MANIPULATOR');
    await page.selectOption('[data-test=commission-mode]', 'telepresence');
    await page.click('[data-test=commission]');
    await page.waitForSelector('[data-test=commission-failed]', {timeout: 120000});
    const told = await page.textContent('[data-test=commission-failed]');
    await picture('refused');
    assert.doesNotMatch(told, /^Stopped at “[^”]*”: not permitted in this state$/, told);
    await go(page, 'overview');
  });

  it(`plugs in and brings it up by one button, ${recoveries} times in a row`, async () => {
    for (let k = 0; k < recoveries; ++k) {
      await inject('joystick', 'unplug');
      if (k > 0) await page.waitForSelector('[data-test=stop-banner]', wait);
      await page.waitForSelector('[data-test=mode-stopped]', wait);
      await inject('joystick', 'plug');
      if (await page.locator('[data-test=stop-bring-up]').count() === 0) {
        // Acknowledged before: the other button does the same.
        await go(page, 'subsystems/MANIPULATOR');
        await page.click('[data-test=commission]');
        await page.waitForSelector('[data-test=commissioned]', {timeout: 120000});
        await go(page, 'overview');
      } else {
        await page.click('[data-test=stop-bring-up]');
        await page.waitForSelector('[data-test=stop-banner]', {state: 'detached', timeout: 120000});
      }
      await mode_holds();
      await sleep(1000);
      await mode_holds();
      assert.equal(await page.locator('[data-test=stop-banner]').count(), 0, `recovery ${k + 1}`);
    }
  });

  it('is told that the link is silent while the gateway stands still, and that the picture is old', async () => {
    station.child.kill('SIGSTOP');
    await page.waitForSelector('[data-test=link].bad:has-text("LINK SILENT")', wait);
    await page.waitForSelector('[data-test=robot-verdict]:has-text("old")', wait);
    await picture('silent');
    station.child.kill('SIGCONT');
    await page.waitForSelector('[data-test=link].good', wait);
    await mode_holds();
  });

  it('saw no error of the page', () => assert.deepEqual(faults.filter((one) => !/409|503/.test(one)), []));
});
