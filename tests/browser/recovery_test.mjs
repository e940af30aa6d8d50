// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Whatever stopped the craft, the one button of the banner brings it up again: ten different stops in a row on one real flight, or as
// many of them as HIROSCO_STOPS says. In a view without the picture, which is cheap to draw: the banner stands in every one.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';
import {at_view, count_clicks, coupled, holds, inject, is_coupled, open_browser, open_page, small, until} from './browser.mjs';
import {fly, process_of} from './flight.mjs';

describe('whatever stopped the craft', () => {
  let flight, browser, page, faults;
  before(async () => {
    flight = await fly();
    browser = await open_browser({calm: true});
    ({page, faults} = await open_page(browser.context, at_view(flight.url, 'subsystems/MANIPULATOR'), small));
    await coupled(page);
    await inject(page, 'joystick', 'hand target 0 0');
  });
  after(async () => {
    await browser?.close();
    await flight?.end();
  });

  const fault = (device, line) => () => inject(page, device, line);
  const nothing = async () => {};
  const stops = [
    {what: 'the joystick unplugged', stop: fault('joystick', 'unplug'), mend: fault('joystick', 'plug'), told: /JOYSTICK lost its device/},
    {what: 'the robot unplugged', stop: fault('robot', 'unplug'), mend: fault('robot', 'plug'), told: /MANIPULATOR lost its device ROBOT/},
    {what: 'a joystick that says nothing', stop: fault('joystick', 'silent'), mend: fault('joystick', 'heal'), told: /JOYSTICK lost its device/},
    {what: 'SAFE ALL', stop: safe_all, mend: nothing, told: /SAFE ALL/},
    {what: 'a robot that says nothing', stop: fault('robot', 'silent'), mend: fault('robot', 'heal'), told: /MANIPULATOR lost its device ROBOT/},
    {what: 'a hand that presses beyond the torque limit', stop: fault('joystick', 'hand ramp 0.065 0 0.04'),
      mend: fault('joystick', 'hand target 0 0'), told: /torque limit exceeded/},
    {what: 'damaged frames of the joystick', stop: fault('joystick', 'corrupt 1000000'), mend: fault('joystick', 'heal'), told: /JOYSTICK lost its device/},
    {what: 'a robot that tells the same again and again', stop: fault('robot', 'freeze 3600000'), mend: fault('robot', 'heal'), told: /MANIPULATOR lost its device ROBOT/},
    {what: 'a joint that is too hot', stop: fault('robot', 'temperature 1 85'), mend: fault('robot', 'temperature 1 25'), told: /temperature/},
    {what: 'the process of the joystick killed', stop: async () => process.kill(process_of(flight, 'hirosco-joystick'), 'SIGKILL'), mend: nothing,
      told: /The process of JOYSTICK died/},
  ];

  async function safe_all() {
    const box = await page.locator('[data-test=safe-all]').boundingBox();
    await page.mouse.move(box.x + 20, box.y + 15);
    await page.mouse.down();
    await page.waitForSelector('[data-test=stop-banner]');
    await page.mouse.up();
  }

  for (const {what, stop, mend, told} of stops.slice(0, Number(process.env.HIROSCO_STOPS ?? stops.length))) {
    it(`is brought up again by one button: ${what}`, async () => {
      await stop();
      await page.waitForSelector('[data-test=stop-banner]');
      await holds(page, () => document.querySelector('[data-test=mode-stopped]'));
      await holds(page, (words) => new RegExp(words).test(document.querySelector('[data-test=stop-title]')?.textContent), told.source);
      await mend();
      const clicks = await count_clicks(page);
      await page.click('[data-test=stop-bring-up]');
      const failed = page.locator('[data-test=stop-failed]');
      await holds(page, () => !document.querySelector('[data-test=stop-banner]') || document.querySelector('[data-test=stop-failed]'));
      assert.equal(await failed.count() === 0 ? 'it is up' : await failed.textContent(), 'it is up');
      assert.equal(await clicks(), 1);
      // It stays up: another stop, of a host that is late, has a banner of its own.
      const another = page.locator('[data-test=stop-title]');
      await until('coupled', async () => await another.count() > 0 || page.evaluate(is_coupled));
      assert.equal(await another.count() === 0 ? 'it stays up' : await another.textContent(), 'it stays up');
    });
  }

  it('saw no error of the page', () => assert.deepEqual(faults.filter((one) => !/409|503/.test(one)), []));
});
