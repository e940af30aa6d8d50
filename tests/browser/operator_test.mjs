// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What an operator does on the command line, in the page: coupled from Offline by hand, moves alone, springs and contour, force scale and
// passivity, the store of the log, SAFE ALL, shutdown.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';
import {bring_up, go, holds, open_browser, open_page, small} from './browser.mjs';
import {fly} from './flight.mjs';

describe('an operator with nothing but the page', () => {
  let flight, browser, page;
  before(async () => {
    flight = await fly();
    browser = await open_browser({calm: true});
    ({page} = await open_page(browser.context, flight.url, small));
    await mode_is('telepresence');
  });
  after(async () => {
    await browser?.close();
    await flight?.end();
  });

  const mode_is = (name) => holds(page, (wanted) => document.querySelector('[data-test=mode] b')?.textContent === wanted, name);
  const state_is = (name, state) => holds(page, ([one, wanted]) =>
    document.querySelector(`[data-test=subsystem-${one}] .state`)?.textContent === wanted, [name, state]);

  /// Fills the form in, waits for "permitted", sends, waits for the verdict.
  async function command(subsystem, action, values = {}) {
    await go(page, 'help');
    await go(page, `commands/${subsystem}/${action}`);
    await page.waitForSelector(`[data-test=send]:has-text("${action}"), [data-test=send]:has-text("to fill in")`);
    for (const [name, value] of Object.entries(values)) {
      const field = page.locator(`[data-test=field-${name}]`);
      if (await field.evaluate((node) => node.tagName === 'SELECT')) {
        const texts = await field.locator('option').allTextContents();
        const named = texts.findIndex((text) => text.startsWith(`${value} (`));
        await field.selectOption(named >= 0 ? {index: named} : String(value));
      } else {
        await field.fill(String(value));
      }
    }
    await page.waitForSelector('[data-test=permission].yes');
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].completed');
  }

  async function to_state(name, state, told = state) {
    await go(page, `subsystems/${name}`);
    await page.click(`[data-test=go-${state}]`);
    await state_is(name, told);
  }

  it('sets force scale, passivity, torque limit and the hand while coupled', async () => {
    await command('JOYSTICK', 'SET_FORCE_SCALE', {SCALE: 0.03});
    await command('JOYSTICK', 'PASSIVITY', {ON: 1});
    await command('JOYSTICK', 'PASSIVITY', {ON: 0});
    await command('MANIPULATOR', 'SET_TORQUE_LIMIT', {LIMIT: 11});
    await command('JOYSTICK', 'SET_HAND', {KIND: 1});
    await command('JOYSTICK', 'HAND', {PHI1: 0.02, PHI2: 0});
    await command('JOYSTICK', 'SET_HAND', {KIND: 0});
  });

  it('takes both machines to Offline and couples them again by hand, link by link', async () => {
    const both = ['MANIPULATOR', 'JOYSTICK'];
    await command('SUPERVISOR', 'SET_MODE', {MODE: 'commissioning'});
    await mode_is('commissioning');
    for (const name of both) await to_state(name, 'SafeOperational', 'Safe-Operational');
    for (const name of both) await to_state(name, 'Offline');
    for (const name of both) await to_state(name, 'PreOperational', 'Pre-Operational');
    for (const name of both) {
      await go(page, `subsystems/${name}`);
      await page.click('[data-test=configure-COUPLED]');
      await holds(page, () => document.querySelector('[data-test=configure-COUPLED]').classList.contains('on'));
    }
    await go(page, 'links');
    for (const link of [1, 2]) {
      await page.click(`[data-test=link-${link}]:has-text("make")`);
      await page.waitForSelector(`[data-test=link-${link}]:has-text("cut")`);
    }
    for (const name of both) await to_state(name, 'SafeOperational', 'Safe-Operational');
    for (const name of both) await to_state(name, 'Operational');
    await command('SUPERVISOR', 'SET_MODE', {MODE: 'telepresence'});
    await mode_is('telepresence');
  });

  async function to_mode(mode) {
    await bring_up(page, mode);
    await mode_is(mode);
  }

  it('moves the arm alone, hooks a spring and lets it go, displays torques', async () => {
    await to_mode('standalone');
    await command('MANIPULATOR', 'SET_GAINS', {KP: 300, KD: 24});
    await command('MANIPULATOR', 'MOVE_TO', {Q1: -0.9, Q2: 1.7, DURATION: 1});
    await command('MANIPULATOR', 'HOLD');
    await command('MANIPULATOR', 'HOME');
    await command('MANIPULATOR', 'HOOK_SPRING', {SPRING: 2});
    await command('MANIPULATOR', 'RELEASE_SPRING');
    await command('JOYSTICK', 'DISPLAY_TORQUE', {T1: 0.1, T2: -0.1});
    await command('JOYSTICK', 'CENTRE');
  });

  it('runs the contour and the spring programme on board', async () => {
    await to_mode('automatic');
    await command('MANIPULATOR', 'RUN_SCRIPT', {SCRIPT: 1});
    await command('MANIPULATOR', 'RUN_SCRIPT', {SCRIPT: 2});
  });

  it('changes the store of the log, makes all safe and shuts down', async () => {
    await command('SUPERVISOR', 'SET_DATABASE', {STRATEGY: 1});
    await command('SUPERVISOR', 'SAFE_ALL');
    await go(page, 'subsystems/MANIPULATOR');
    await holds(page, () => /inhibited/.test(document.querySelector('[data-test=subsystem-MANIPULATOR]').textContent));
    await command('SUPERVISOR', 'SET_MODE', {MODE: 'safe'});
    await go(page, 'commands/SUPERVISOR/SHUTDOWN');
    await page.waitForSelector('[data-test=permission].yes');
    // It wants a second click.
    await page.click('[data-test=send]');
    await page.click('[data-test=send].sure');
    assert.equal(await flight.gone, 0);
  });
});
