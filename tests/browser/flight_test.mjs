// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The paper's story by mouse, on a real flight with its gateway: see it move, be refused, take the network down and bring another one up,
// move the arm, unplug the joystick, read why, replay.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';
import {go, open_browser, open_page} from './browser.mjs';
import {fly} from './flight.mjs';

const wait = {timeout: 20000};

describe('the page on a real flight', () => {
  let flight, browser, page, faults;
  before(async () => {
    flight = await fly();
    browser = await open_browser();
    ({page, faults} = await open_page(browser.context, flight.url));
  });
  after(async () => {
    await browser?.close();
    await flight?.end();
  });

  const state_is = (name, state) => page.waitForFunction(([one, wanted]) =>
    document.querySelector(`[data-test=subsystem-${one}] .state`)?.textContent === wanted, [name, state], wait);

  it('shows the coupled robot in motion', async () => {
    await page.waitForFunction(() => Number(document.querySelector('[data-test=robot]')?.dataset.frames) > 5, null, wait);
    const paint_ms = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
    console.log(`measured: first contentful paint ${paint_ms?.toFixed(0)} ms`);
    await state_is('MANIPULATOR', 'Operational');
    await page.waitForFunction(() => document.querySelector('[data-test=mode] b').textContent === 'telepresence', null, wait);
    await page.waitForSelector('[data-test=link].good', wait);
  });

  it('draws 3D and two plots while the robot moves', async () => {
    const frames = () => page.evaluate(() => Number(document.querySelector('[data-test=robot]').dataset.frames));
    // A hand that never rests: where no joint moves, nothing is drawn.
    await page.evaluate(() => fetch('/api/faults', {method: 'POST', body: '{"device":"joystick","line":"hand sine 1 0.1 0.5"}',
      headers: {'Content-Type': 'application/json', Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}}));
    const first = await frames();
    const began = performance.now();
    await page.waitForTimeout(3000);
    const rate_hz = (await frames() - first) / ((performance.now() - began) / 1000);
    console.log(`measured: ${rate_hz.toFixed(1)} frames a second`);
    // The figure to hold is 15 on an idle computer (design notes); this limit only tells drawing from standing still.
    assert.ok(rate_hz >= 5);
  });

  it('says before sending that a coupled robot takes no MOVE_TO, and shows the refusal', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    await page.fill('[data-test=field-Q1]', '-1');
    await page.fill('[data-test=field-Q2]', '1.9');
    await page.fill('[data-test=field-DURATION]', '1');
    await page.waitForSelector('[data-test=permission].no', wait);
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].failed', wait);
  });

  it('brings the standalone network up by one button, step by step', async () => {
    await go(page, 'subsystems/MANIPULATOR');
    await page.selectOption('[data-test=commission-mode]', 'standalone');
    await page.click('[data-test=commission]');
    await page.waitForSelector('[data-test=commissioned]', {timeout: 60000});
    await state_is('MANIPULATOR', 'Operational');
    assert.equal(await page.textContent('[data-test=mode] b'), 'standalone');
  });

  it('moves the arm by telecommand and shows the whole chain of verdicts', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    await page.fill('[data-test=field-Q1]', '-1');
    await page.fill('[data-test=field-Q2]', '1.9');
    await page.fill('[data-test=field-DURATION]', '1');
    await page.waitForSelector('[data-test=permission].yes', wait);
    const began = performance.now();
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict] .accepted', wait);
    console.log(`measured: click to acceptance on the screen ${(performance.now() - began).toFixed(0)} ms`);
    await page.waitForSelector('[data-test=verdict].completed', wait);
    await go(page, 'overview');
    await page.waitForFunction(() => /q1 −1\.00/.test(document.querySelector('.readout')?.textContent), null, wait);
  });

  it('brings telepresence back', async () => {
    await go(page, 'subsystems/JOYSTICK');
    await page.selectOption('[data-test=commission-mode]', 'telepresence');
    await page.click('[data-test=commission]');
    await page.waitForSelector('[data-test=commissioned]', {timeout: 60000});
    await state_is('JOYSTICK', 'Operational');
  });

  it('shows both machines down after the joystick is unplugged, and why', async () => {
    await go(page, 'events');
    await page.click('[data-test=faults]');
    await page.click('[data-test=fault-joystick-unplug]');
    await page.waitForFunction(() => document.querySelector('[data-test=events]').textContent.includes('JOYSTICK_LOST'), null, wait);
    await page.waitForSelector('[data-test=why] li', wait);
    await page.fill('[data-test=log-text]', 'tm[5 joystick_lost');
    await page.press('[data-test=log-text]', 'Enter');
    await page.waitForFunction(() => /TM\[5,4\] JOYSTICK high JOYSTICK_LOST/.test(document.querySelector('[data-test=log]')?.textContent), null, wait);
    await page.keyboard.press('Escape');
    await go(page, 'overview');
    await state_is('JOYSTICK', 'Offline');
    await state_is('MANIPULATOR', 'Offline');
  });

  it('replays the moment before, where the network still stands', async () => {
    await go(page, 'timeline');
    await page.click('[data-test=replay-10]');
    await page.waitForSelector('[data-test=replay-bar]', wait);
    await go(page, 'overview');
    await state_is('JOYSTICK', 'Operational');
    await page.click('[data-test=live]');
    await state_is('JOYSTICK', 'Offline');
  });

  it('asked nobody else, and had no error', () => assert.deepEqual(faults.filter((one) => !/409|503/.test(one)), []));
});
