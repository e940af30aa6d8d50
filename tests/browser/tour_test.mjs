// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// `hirosco tour`: the eight steps as a visitor takes them, each until the page itself says that it is done.
import assert from 'node:assert/strict';
import {cpSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {holds, open_browser, open_page, small} from './browser.mjs';
import {fly, missions, new_folder} from './flight.mjs';

describe('the tour', () => {
  // A visitor changes a line of XML: not in the sources.
  const sources = new_folder();
  for (const part of ['missions', 'subsystems', 'supervisor']) cpSync(join(dirname(missions), part), join(sources, part), {recursive: true});
  let flight, browser, page;
  const open_tour = async (mission) => {
    flight = await fly({command: 'tour', mission: join(sources, 'missions', mission)});
    await page?.close();
    ({page} = await open_page(browser.context, flight.url, small));
    await page.waitForSelector('[data-test=tour]');
  };
  before(async () => {
    browser = await open_browser({calm: true});
    await open_tour('rokviss');
  });
  after(async () => {
    await browser?.close();
    await flight?.end();
    rmSync(sources, {recursive: true, force: true});
  });

  const title = async () => (await page.textContent('[data-test=tour] h3')).replace('✓', '').trim();
  const act = (text) => page.click(`[data-test=tour-act]:has-text("${text}")`);
  const done = () => page.waitForSelector('[data-test=tour-done]');
  const next = () => page.click('[data-test=tour-next]');
  const mode_is = (name) => holds(page, (wanted) => document.querySelector('[data-test=mode] b').textContent === wanted, name);

  it('opens at its first step, on a flight that is coupled: the hand moves', async () => {
    assert.match(flight.url, /&tour$/);
    assert.equal(await title(), 'Move it');
    await mode_is('telepresence');
    assert.equal(await page.locator('[data-test=tour-done]').count(), 0);
    await act('Let the hand wander');
    await done();
    await next();
  });

  it('takes the two machines apart, moves the arm alone and couples them', async () => {
    assert.equal(await title(), 'Couple two machines');
    await act('Take apart');
    await mode_is('standalone');
    await holds(page, () => document.querySelector('[data-test=subsystem-MANIPULATOR] .state').textContent === 'Operational');
    await act('MOVE_TO');
    await holds(page, () => [...document.querySelectorAll('.toasts p')].some((one) => /MOVE_TO: completed/.test(one.textContent)));
    await act('Home, and couple');
    await done();
    await next();
  });

  it('feels the wall, unplugs the joystick and tells why all stopped', async () => {
    assert.equal(await title(), 'Feel the wall');
    await mode_is('telepresence');
    await act('Press with 43 N');
    await done();
    await next();
    await act('Unplug');
    await done();
    await next();
    assert.equal(await title(), 'Read the story');
    await page.waitForSelector('[data-test=why] li');
    await done();
    await next();
  });

  it('shows a refused telecommand with its reason', async () => {
    await act('Plug in and couple');
    await mode_is('telepresence');
    for (const [field, text] of [['Q1', '-1'], ['Q2', '1.9'], ['DURATION', '2']]) await page.fill(`[data-test=field-${field}]`, text);
    await page.waitForSelector('[data-test=permission].no');
    await page.click('[data-test=send]');
    await done();
    await next();
  });

  it('sees one changed line of XML after the next start', async () => {
    assert.equal(await title(), 'Change one line of XML');
    assert.equal(await page.getAttribute('[data-test=field-SCALE]', 'placeholder'), '0 … 0.1');
    await flight.end();
    const file = join(sources, 'subsystems/joystick/joystick.xml');
    const before = readFileSync(file, 'utf8');
    const changed = before.replace(/(name="FORCE_SCALE"[^>]*maximum=")0\.1"/, '$10.2"');
    assert.notEqual(changed, before);
    writeFileSync(file, changed);
    await open_tour('rokviss');
    assert.equal(await title(), 'Change one line of XML');
    await done();
    assert.equal(await page.getAttribute('[data-test=field-SCALE]', 'placeholder'), '0 … 0.2');
    await next();
  });

  it('finds a mission that the page has never heard of', async () => {
    assert.equal(await title(), 'A new subsystem');
    assert.equal(await page.locator('[data-test=tour-done]').count(), 0);
    await flight.end();
    await open_tour('hello');
    assert.equal(await title(), 'A new subsystem');
    await done();
    await next();
    await page.waitForSelector('[data-test=tour]', {state: 'detached'});
  });
});
