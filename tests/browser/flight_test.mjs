// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The paper's story by mouse, on a real flight with its gateway: see it move, be refused, take the network down and bring another one up,
// move the arm, unplug the joystick, read why, replay.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';
import {at_view, bring_up, click_where_seen, count_clicks, go, holds, open_browser, open_page, small, until} from './browser.mjs';
import {fly} from './flight.mjs';

describe('the page on a real flight', () => {
  let flight, browser, page, faults;
  before(async () => {
    flight = await fly();
    browser = await open_browser({calm: true});
    ({page, faults} = await open_page(browser.context, flight.url, small));
  });
  after(async () => {
    await browser?.close();
    await flight?.end();
  });

  const state_is = (name, state) => holds(page, ([one, wanted]) =>
    document.querySelector(`[data-test=subsystem-${one}] .state`)?.textContent === wanted, [name, state]);

  it('shows the coupled robot in motion', async () => {
    await holds(page, () => Number(document.querySelector('[data-test=robot]')?.dataset.frames) > 5);
    const paint_ms = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
    console.log(`measured: first contentful paint ${paint_ms?.toFixed(0)} ms`);
    await state_is('MANIPULATOR', 'Operational');
    await holds(page, () => document.querySelector('[data-test=mode] b').textContent === 'telepresence');
    await page.waitForSelector('[data-test=link].good');
  });

  it('draws 3D and two plots while the robot moves', async () => {
    const frames = () => page.evaluate(() => Number(document.querySelector('[data-test=robot]').dataset.frames));
    // At its own pace, this once; all else is about words.
    await page.emulateMedia({reducedMotion: 'no-preference'});
    // A hand that never rests: where no joint moves, nothing is drawn.
    await page.evaluate(() => fetch('/api/faults', {method: 'POST', body: '{"device":"joystick","line":"hand sine 1 0.1 0.5"}',
      headers: {'Content-Type': 'application/json', Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}}));
    const first = await frames();
    const began = performance.now();
    await holds(page, (wanted) => Number(document.querySelector('[data-test=robot]').dataset.frames) >= wanted, first + 30);
    console.log(`measured: ${((await frames() - first) / ((performance.now() - began) / 1000)).toFixed(1)} frames a second`);
    await page.emulateMedia({reducedMotion: 'reduce'});
  });

  it('says before sending that a coupled robot takes no MOVE_TO, and shows the refusal', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    await page.fill('[data-test=field-Q1]', '-1');
    await page.fill('[data-test=field-Q2]', '1.9');
    await page.fill('[data-test=field-DURATION]', '1');
    await page.waitForSelector('[data-test=permission].no');
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].failed');
  });

  it('lets one page command at a time: the other is refused by the station, asks, and is handed it', async () => {
    const {page: other} = await open_page(browser.context, at_view(flight.url, 'commands/MANIPULATOR/MOVE_TO'), small);
    const word = (where) => where.textContent('[data-test=commander] b');
    for (const one of [page, other]) await holds(one, () => document.querySelector('[data-test=others-count]')?.textContent === '+1');
    await until('who sent first commands', async () => await word(page) === 'you' && await word(other) === 'operator');
    await other.waitForSelector('[data-test=not-commanding]');
    assert.ok(await other.locator('[data-test=send]').isDisabled());
    const refused = await other.evaluate(async () => {
      const answer = await fetch('/api/commands', {method: 'POST', headers: {'Content-Type': 'application/json', Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`},
        body: JSON.stringify({subsystem: 'JOYSTICK', function: 'SET_FORCE_SCALE', arguments: {SCALE: 0.02}, seat: sessionStorage.getItem('hirosco-seat')})});
      return [answer.status, (await answer.json()).error];
    });
    assert.deepEqual(refused, [409, 'operator commands: ask for the command, or wait until it is handed over']);
    await other.click('[data-test=ask-command]');
    await page.click('[data-test=command-hand-over]');
    await until('it is handed over', async () => await word(other) === 'you' && await word(page) === 'operator');
    await other.click('[data-test=commander]');
    await other.click('[data-test=command-hand-over]');
    await until('nobody commands', async () => await word(page) === 'nobody');
    await other.close();
    await page.waitForSelector('[data-test=others-count]', {state: 'detached'});
  });

  it('shows how long the samples of both links took, as they were counted on board', async () => {
    await go(page, 'links');
    for (const link of [1, 2]) {
      await page.waitForSelector(`[data-test=bars-${link}] svg`);
      const words = await page.getAttribute(`[data-test=bars-${link}] svg`, 'aria-label');
      const [, samples, late] = words.match(/^(\d+) samples, half of them within .*, (\d+) later than 1\.0 ms$/).map(Number);
      assert.ok(samples > 2000 && late < samples / 10, words);
    }
  });

  it('changes the mode by two clicks, in whichever view, and says beforehand what that does', async () => {
    const clicks = await count_clicks(page);
    await page.click('[data-test=mode]');
    await page.hover('[data-test=mode-standalone]');
    await page.waitForSelector('[data-test=mode-go]:has-text("Go standalone"):enabled');
    assert.ok(await page.locator('[data-test=mode-steps] li').count() > 3);
    await page.click('[data-test=mode-go]');
    assert.equal(await clicks(), 2);
    await go(page, 'overview');
    await page.waitForSelector('[data-test=mode-progress]', {state: 'detached'});
    await state_is('MANIPULATOR', 'Operational');
    await holds(page, () => document.querySelector('[data-test=mode] b').textContent === 'standalone');
  });

  it('calls an author\'s own refusal by the name that the descriptor gives it', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    await page.fill('[data-test=field-Q1]', '1');
    await page.fill('[data-test=field-Q2]', '2.6');
    await page.fill('[data-test=field-DURATION]', '0.2');
    await page.waitForSelector('[data-test=permission].yes');
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].failed');
    assert.match(await page.textContent('[data-test=verdict]'), /TOO_FAST/);
  });

  it('minds a goal that lies in the rail beside Send, though it is permitted, and asks once more', async () => {
    await go(page, 'overview');
    await page.waitForSelector('.quick [data-test=field-Q1]');
    for (const [name, text] of Object.entries({Q1: '-0.5', Q2: '1.4', DURATION: '5'})) {
      await page.click(`.quick [data-test=field-${name}]`, {clickCount: 3});
      await page.keyboard.type(text);
    }
    await page.waitForSelector('[data-test=permission].yes');
    await page.waitForSelector('[data-test=goal-in-the-way]');
    assert.match(await page.textContent('[data-test=goal-in-the-way]'), /meets the rail/);
    await page.click('[data-test=send]');
    await holds(page, () => /Once more/.test(document.querySelector('[data-test=send]').textContent));
    assert.equal(await page.locator('[data-test=verdict]').count(), 0, 'nothing was sent');
    await page.click('.quick [data-test=field-Q1]', {clickCount: 3});
    await page.keyboard.type('-1.5');
    await page.waitForSelector('[data-test=goal-in-the-way]', {state: 'detached'});
    await go(page, 'links');  // the form that comes next is one that nobody has scrolled
  });

  it('moves the arm by its fields and one click beside its picture, without scrolling, and shows the whole chain of verdicts', async () => {
    await go(page, 'overview');
    await page.waitForSelector('.quick [data-test=field-Q1]');
    const clicks = await count_clicks(page), fields = {Q1: '-1', Q2: '1.9', DURATION: '1'};
    for (const [name, text] of Object.entries(fields)) {
      await click_where_seen(page, `.quick [data-test=field-${name}]`, {clickCount: 3});
      await page.keyboard.type(text);
    }
    await page.waitForSelector('[data-test=permission].yes');
    const typed = await clicks(), began = performance.now();
    await click_where_seen(page, '[data-test=send]');
    assert.equal(await clicks(), typed + 1);
    await page.waitForSelector('[data-test=verdict] .accepted');
    console.log(`measured: click to acceptance on the screen ${(performance.now() - began).toFixed(0)} ms`);
    await page.waitForSelector('[data-test=verdict].completed');
    await holds(page, () => /q1 −1\.00/.test(document.querySelector('.readout')?.textContent));
  });

  it('brings telepresence back', async () => {
    // What the page says meanwhile, and at the end.
    await page.evaluate(() => {
      window.said = new Set();
      new MutationObserver(() => document.querySelectorAll('[data-test=state-head], [data-test=mode-progress], .toasts p').forEach((node) => window.said.add(node.textContent)))
          .observe(document.body, {subtree: true, childList: true, characterData: true});
    });
    await bring_up(page, 'telepresence');
    await state_is('JOYSTICK', 'Operational');
    await holds(page, () => [...window.said].some((text) => /^telepresence is up since \d/.test(text)));
    const said = await page.evaluate(() => [...window.said]);
    for (const words of [/^telepresence is being brought up: \d+ of \d+$/, /^→ telepresence \d+ of \d+$/, /^telepresence is up$/]) assert.ok(said.some((text) => words.test(text)), `${words} in ${said.join(' | ')}`);
  });

  it('shows both machines down after the joystick is unplugged, and why', async () => {
    await go(page, 'events');
    await page.click('[data-test=faults]');
    await page.click('[data-test=fault-joystick-unplug]');
    await holds(page, () => document.querySelector('[data-test=events]').textContent.includes('JOYSTICK_LOST'));
    await page.waitForSelector('[data-test=why] li');
    await page.fill('[data-test=log-text]', 'tm[5 joystick_lost');
    await page.press('[data-test=log-text]', 'Enter');
    await holds(page, () => /TM\[5,4\] JOYSTICK high JOYSTICK_LOST/.test(document.querySelector('[data-test=log]')?.textContent));
    await page.keyboard.press('Escape');
    await go(page, 'overview');
    await state_is('JOYSTICK', 'Offline');
    await state_is('MANIPULATOR', 'Offline');
  });

  it('replays the moment before, where the network still stands', async () => {
    await go(page, 'timeline');
    await page.click('[data-test=replay-10]');
    await page.waitForSelector('[data-test=replay-bar]');
    await go(page, 'overview');
    await state_is('JOYSTICK', 'Operational');
    await page.click('[data-test=live]');
    await state_is('JOYSTICK', 'Offline');
  });

  it('asked nobody else, and had no error', () => assert.deepEqual(faults.filter((one) => !/409|503/.test(one)), []));
});
