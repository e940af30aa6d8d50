// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The page of an arm of a URDF file, with any number of joints: the mission six_joints as the gateway tells it from its descriptors, and a
// made-up flight of it.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync, rmSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {go, holds, open_browser, open_page, small, take_hold} from './browser.mjs';
import {free_port, ground, missions, new_folder} from './flight.mjs';
import {cut_texts, faint_texts, overlapping_texts} from './looks.mjs';

const begin_t = 2145916838, seconds = 60, rate_hz = 10;
const stands = [0.2, 0.5, 1.2, -0.6, 0.7, 0.1];
const names = ['1 turn', '2 lift', '3 elbow', '4 bend', '5 roll', '6 twist'];

/// A recording for the development server: everybody Operational, the arm at rest.
function recorded(mission) {
  const messages = [];
  for (const {id, name} of mission.subsystems) {
    ['SoftwareInit', 'HardwareInit', 'PreOperational', 'SafeOperational', 'Operational'].forEach((state, i) =>
      messages.push({type: 'event', t: begin_t + 0.1 * i, apid: id, subsystem: name, id: 1, name: 'STATE_CHANGED', severity: 'info', text: `STATE=${state}`, values: {}}));
  }
  for (let i = 10; i < seconds * rate_hz; ++i) {
    const t = begin_t + i / rate_hz;
    const set = Object.fromEntries(stands.flatMap((angle, k) => ['CUR_VALUES.POSITION', 'DES_POSITION'].map((name) => [`ARM.${name}[${k}]`, [angle, t]])));
    messages.push({type: 'values', t, set});
  }
  return {mission, messages, stop: {stopped: []}};
}

async function serve(file) {
  const process_of = spawn('node', [process.env.HIROSCO_PAGE_SERVER, file, process.env.HIROSCO_PAGE, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

const tags = (page) => page.locator('.readout .tag:visible').allTextContents();

describe('the page of an arm of six joints', () => {
  const folder = new_folder();
  let browser, served, page, faults;
  before(async () => {
    browser = await open_browser({calm: true});
    const station = await ground(folder, 'six_joints', await free_port());
    const mission = await (await fetch(`${station.origin}/api/mission`, {headers: {Authorization: `Bearer ${station.token}`}})).json();
    await station.end();
    writeFileSync(join(folder, 'flight.json'), JSON.stringify(recorded(mission)));
    served = await serve(`${join(folder, 'flight.json')}:well`);
    ({page, faults} = await open_page(browser.context, served.url, {width: 1440, height: 900}));
    await page.waitForSelector('[data-test=robot][data-loaded]');
  });
  after(async () => {
    await browser?.close();
    served?.end();
    rmSync(folder, {recursive: true, force: true});
  });

  it('has the angle of each joint beside its name, and the tool’s place in three numbers', async () => {
    await holds(page, (pose) => document.querySelector('[data-test=robot]').dataset.pose === pose, stands.map((angle) => angle.toFixed(6)).join());
    await holds(page, () => document.querySelectorAll('.readout .tag:not([hidden]) b').length >= 7);
    const told = await tags(page);
    for (const [i, name] of names.entries()) assert.ok(told.some((one) => one.startsWith(`${name} ${stands[i].toFixed(3).replace('-', '−')}`)), `${name}: ${told}`);
    assert.match(told.find((one) => one.startsWith('tip')), /^tip −?\d+\.\d, −?\d+\.\d, −?\d+\.\d mm$/);
  });

  it('offers nothing to see of a force that nobody measures', async () => {
    assert.equal(await page.locator('.tools .chip', {hasText: 'Force'}).count(), 0);
    assert.equal(await page.locator('.key', {hasText: 'touched'}).count(), 0);
  });

  it('has a row for each joint that an array leads, with its own range and where it stands', async () => {
    await go(page, 'commands/ARM/MOVE_J');
    await page.waitForSelector('[data-test=slide-GOAL-5]');
    assert.deepEqual(await page.locator('.joint > span:first-child').allTextContents(), names);
    assert.deepEqual(await page.locator('[data-test=slide-GOAL-1]').evaluate((node) => [node.min, node.max, Number(node.value).toFixed(1)]), ['-2.2', '2.2', '0.5']);
    assert.equal(await page.locator('.joint .stands .is').count(), 6);
    assert.equal(await page.inputValue('[data-test=field-GOAL]'), '', 'nothing is wanted before somebody wants it');
  });

  it('writes the array when one joint is moved, the others where they stand', async () => {
    await page.fill('[data-test=slide-GOAL-2]', '0.6');
    assert.equal(await page.inputValue('[data-test=field-GOAL]'), '0.2 0.5 0.6 -0.6 0.7 0.1');
    await page.fill('[data-test=joint-GOAL-3]', '0,5');
    await page.press('[data-test=joint-GOAL-3]', 'Enter');
    await holds(page, () => document.querySelector('[data-test=field-GOAL]').value === '0.2 0.5 0.6 0.5 0.7 0.1');
    await page.fill('[data-test=field-GOAL]', '0 0 0 0 0 1');
    assert.equal(await page.inputValue('[data-test=joint-GOAL-5]'), '1');
    await page.click('[data-test=here-GOAL]');
    assert.equal(await page.inputValue('[data-test=field-GOAL]'), stands.join(' '));
  });

  it('says which joint would leave its own range where that of the telecommand is wider', async () => {
    await page.fill('[data-test=field-GOAL]', '0 2.5 0 0 0 0');
    assert.match(await page.locator('.joint.wrong').textContent(), /^2 lift.*beyond its limits, −2.20 … 2.20$/);
    assert.equal(await page.locator('.joint.wrong').count(), 1);
  });

  it('has the velocities of a jog by the same names, from no motion at all', async () => {
    await go(page, 'commands/ARM/JOG_J');
    await page.waitForSelector('[data-test=slide-VELOCITY-5]');
    assert.deepEqual(await page.locator('.joint > span:first-child').allTextContents(), names);
    await page.fill('[data-test=slide-VELOCITY-3]', '-2.5');
    assert.equal(await page.inputValue('[data-test=field-VELOCITY]'), '0 0 0 -2.5 0 0');
    assert.equal(await page.locator('[data-test=here-VELOCITY]').count(), 0);
  });

  it('pushes the tool by a button for each way, one telecommand a push', async () => {
    await go(page, 'commands/ARM/JOG_L');
    await page.click('[data-test="jog-move-y-"]');
    const pushed = page.locator('[data-test=history] > li.completed', {hasText: 'ARM JOG_L'}).first();
    await pushed.waitFor();
    assert.match(await pushed.textContent(), /LINEAR 0 −0\.005 0, ANGULAR 0 0 0, SECONDS 0\.4/);
  });

  it('names the joints of the parameters, with how far they are from their limits', async () => {
    await go(page, 'subsystems/ARM');
    const row = page.locator('.values tr', {hasText: 'CUR_VALUES.POSITION[1]'});
    assert.match(await row.locator('td').first().textContent(), /POSITION\[1\] 2 lift$/);
    assert.equal(await row.locator('.range').count(), 1);
    await go(page, 'commands/ARM/MOVE_J');
  });

  it('sends what stands there', async () => {
    await page.fill('[data-test=field-GOAL]', '0.2 0.5 0.6 0.5 0.7 0.1');
    await page.fill('[data-test=field-SPEED]', '0.5');
    await page.locator('[data-test=send]:not([disabled])').click();
    await holds(page, () => /completed/.test(document.querySelector('[data-test=verdict]')?.className ?? ''));
    const sent = await page.evaluate(async () => (await (await fetch('/api/commands', {headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}})).json()).commands[0]);
    assert.deepEqual([sent.function, sent.arguments], ['MOVE_J', {GOAL: [0.2, 0.5, 0.6, 0.5, 0.7, 0.1], SPEED: 0.5}]);
  });

  it('shows where it would go before that is sent: at which speed, how long at least, red where it cannot be', async () => {
    await go(page, 'overview');
    await page.waitForSelector('[data-test=robot][data-loaded]');
    // What was sent and done stands in the form still, and is no goal any more.
    assert.equal(await page.inputValue('.quick [data-test=field-GOAL]'), '0.2 0.5 0.6 0.5 0.7 0.1');
    await holds(page, () => [...document.querySelectorAll('.readout .tag.goal')].every((node) => node.hidden) && document.querySelector('.robot .key'));
    assert.doesNotMatch(await page.textContent('.robot .key'), /goal/);
    await page.fill('.quick [data-test=field-GOAL]', '-0.8 0.5 1.2 -0.6 0.7 0.1');
    await page.fill('.quick [data-test=field-SPEED]', '0.5');
    // 1 rad at half of 2 rad/s.
    await holds(page, () => [...document.querySelectorAll('.readout .tag.goal')].some((node) => !node.hidden && node.textContent === 'goal 6 joints at 50 %, at least 1.0 s'));
    assert.match(await page.textContent('.robot .key'), /goal, not sent/);
    await page.fill('.quick [data-test=field-GOAL]', '-0.8 2.5 1.2 -0.6 0.7 0.1');
    await holds(page, () => [...document.querySelectorAll('.readout .tag.wrong')].some((node) => node.textContent.includes('2 lift beyond its limit')));
  });

  it('leads the goal by its ball, from where the arm stands, and says in the form where to', async () => {
    await page.click('[data-test=set-goal]');
    await holds(page, (wanted) => document.querySelector('.quick [data-test=field-GOAL]').value === wanted, stands.join(' '));
    await holds(page, () => [...document.querySelectorAll('.readout .tag.goal')].some((node) => !node.hidden));
    const [x, y] = await take_hold(page, 0.3, 0.9, (places) => places[places.length >> 1]);
    await page.mouse.move(x - 40, y - 30, {steps: 3});
    await holds(page, (before) => document.querySelector('.quick [data-test=field-GOAL]').value !== before, stands.join(' '));
    await page.mouse.up();
    const led = (await page.inputValue('.quick [data-test=field-GOAL]')).split(' ').map(Number);
    assert.ok(led.length === 6 && led.every(Number.isFinite), `${led}`);
  });

  it('cuts no text, lays none on another, and has none that is faint', async () => {
    for (const view of ['overview', 'commands/ARM/MOVE_J', 'subsystems/ARM']) {
      await go(page, view);
      for (const size of [small]) {
        await page.setViewportSize(size);
        await page.waitForTimeout(300);
        const where = `${view} ${size.width}`;
        assert.deepEqual(await page.evaluate(cut_texts), [], where);
        assert.deepEqual(await page.evaluate(overlapping_texts), [], where);
        assert.deepEqual(await page.evaluate(faint_texts), [], where);
      }
    }
  });

  it('had no error and asked nobody else', () => assert.deepEqual(faults, []));

  it('has bones for links whose shapes are meshes, and fetches none', async () => {
    const text = readFileSync(join(missions, 'six_joints/page/robot_arm.urdf'), 'utf8')
        .replaceAll(/<geometry>.*?<\/geometry>/g, '<geometry><mesh filename="package://somebody/arm.stl"/></geometry><material name="m"><texture filename="arm.png"/></material>');
    const asked = [];
    browser.context.on('request', (request) => asked.push(request.url()));
    await browser.context.route('**/mission/robot_arm.urdf', (route) => route.fulfill({body: text, contentType: 'application/xml'}));
    const meshes = await open_page(browser.context, served.url, small);
    await meshes.page.waitForSelector('[data-test=robot][data-loaded]');
    await holds(meshes.page, () => Number(document.querySelector('[data-test=robot]').dataset.bones) > 6);
    assert.deepEqual(asked.filter((url) => /\.(stl|png)/.test(url)), []);
    assert.deepEqual(meshes.faults, []);
    await meshes.page.close();
  });
});
