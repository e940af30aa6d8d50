// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// HIROSCO_PAGE_SERVER=… HIROSCO_PAGE=… node --test page_test.mjs: the page alone against made-up flights (ground/web/development/server.mjs): hostile telemetry, forms, keys,
// replay, accessibility, sizes.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {after, before, describe, it} from 'node:test';
import {at_view, count_clicks, go, holds, open_browser, open_page, patience_ms, serious_findings, small, take_hold, until, views} from './browser.mjs';

const [server_file, page_folder] = [process.env.HIROSCO_PAGE_SERVER, process.env.HIROSCO_PAGE];

async function serve(recording) {
  const process_of = spawn('node', [server_file, recording, page_folder, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

/// Whole, in the window, and in front: what a click would hit.
const is_in_sight = (page, what) => page.locator(what).evaluate((node) => {
  const box = node.getBoundingClientRect();
  const at = document.elementFromPoint((box.left + box.right) / 2, box.bottom - 3);
  return box.width > 0 && box.left >= 0 && box.top >= 0 && box.right <= innerWidth && box.bottom <= innerHeight && node.contains(at);
});
const sizes = [[1920, 1080], [1440, 900], [1280, 720], [1024, 768], [910, 700], [720, 1000]];

const tour_title = async (page) => (await page.textContent('[data-test=tour] h3')).replace('✓', '').trim();
async function end_tour(page) {
  await page.click('[aria-label="end the tour"]');
  await page.waitForSelector('[data-test=tour]', {state: 'detached'});
}

let browser;
before(async () => { browser = await open_browser({calm: true}); });
after(() => browser.close());

describe('a flight that means well', () => {
  let served, page, faults;
  before(async () => {
    served = await serve('synthetic');
    ({page, faults} = await open_page(browser.context, `${served.url}&tour`, small));
    await page.waitForSelector('[data-test=subsystem-MANIPULATOR]');
  });
  after(() => served.end());

  it('shows its mission by tour and 3D from the folder of that', async () => {
    await page.waitForSelector('[data-test=tour] h3');
    assert.equal(await tour_title(page), 'Move it');
    assert.equal(await page.locator('[data-test=tour] .dots i').count(), 8);
    await page.waitForSelector('[data-test=robot][data-loaded]');
    await page.click('[data-test=tour-next]');
    assert.equal(await tour_title(page), 'Couple two machines');
    await page.click('a[title=Help]');
    await page.waitForSelector('.tour_list li:nth-child(8)');
    await end_tour(page);
    assert.deepEqual(faults, []);
  });

  it('shows every view at its own address, with no error and no request to another host', async () => {
    for (const view of views) {
      await go(page, view);
      await page.waitForSelector('main .panel');
    }
    assert.deepEqual(faults, []);
  });

  it('takes the token out of the address line', () => assert.ok(!page.url().includes('token')));

  it('draws the robot when joints move, and rests when nothing does', async () => {
    await go(page, 'overview');
    await holds(page, () => Number(document.querySelector('[data-test=robot]')?.dataset.frames) > 10);
  });

  it('shows what stands around the robot, and not in black', async () => {
    await holds(page, () => document.querySelector('[data-test=robot]')?.dataset.still === 'whole');
    const bright = await page.evaluate(() => {
      const {width, height} = document.querySelector('canvas.still'), half = document.createElement('canvas');
      [half.width, half.height] = [40, 20];
      half.getContext('2d').drawImage(document.querySelector('canvas.still'), 0, height / 2, width, height / 2, 0, 0, 40, 20);
      return half.getContext('2d').getImageData(0, 0, 40, 20).data.filter((value, i) => i % 4 === 0 && value > 40).length / 800;
    });
    assert.ok(bright > 0.4, `${bright} of its lower half`);
  });

  it('goes on to draw it in whichever view it is taken along to', async () => {
    for (const view of ['timeline', 'overview', 'timeline', 'overview']) {
      await go(page, view);
      const frames = () => page.evaluate(() => Number(document.querySelector('main [data-test=robot]')?.dataset.frames));
      const first = await frames();
      await until(`it moves in ${view}`, async () => await frames() > first + 1);
    }
  });

  for (const [what, from, to] of [['the handle of the joystick', 0, 0.21], ['the fingertip', 0.55, 0.78]]) {
    it(`moves the simulated hand when ${what} is dragged`, async () => {
      await go(page, 'overview');
      await page.waitForSelector('[data-test=robot][data-loaded]');
      const hand_lines = () => page.evaluate(async () => {
        const answer = await fetch('/api/timeline?from=0&to=9e9', {headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}});
        return (await answer.json()).faults.map((one) => one.line).filter((line) => line.startsWith('hand target'));
      });
      const before = (await hand_lines()).length;
      const grip = await take_hold(page, from, to, (places) => places[places.length >> 1]);
      await page.mouse.move(grip[0] + 30, grip[1] + 4, {steps: 5});
      await until('a line of the hand', async () => (await hand_lines()).length > before);
      // However far up or down the shaft it was taken: the first move is no leap.
      for (const angle of (await hand_lines()).at(-1).split(' ').slice(2).map(Number)) assert.ok(Math.abs(angle) <= 0.4);
      await page.mouse.up();
      await until('the hand at home', async () => (await hand_lines()).at(-1).startsWith('hand target 0.0000 0.0000'));
    });
  }

  it('accepts the ends of a range and rejects what lies beyond, text, NaN and fractions of whole numbers', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    // That it is refused is said before anything is typed.
    await page.waitForSelector('[data-test=permission].no');
    assert.match(await page.textContent('[data-test=send]'), /fields to fill in$/);
    assert.ok(await page.locator('[data-test=send]').isDisabled());
    const wrong = (field) => page.locator(`label.field:has([data-test=field-${field}])`).evaluate((node) => node.classList.contains('wrong'));
    const cases = {Q1: {good: ['-2', '1', '0.5', '1e-3'], bad: ['-2.001', '1.001', 'NaN', 'Infinity', 'left', '0x1', '1 2']},
      Q2: {good: ['0.2', '2.6'], bad: ['0.19', '2.61', '-']}, STEPS: {good: ['0', '65535'], bad: ['-1', '65536', '1.5', 'NaN', 'two']}};
    for (const [field, {good, bad}] of Object.entries(cases)) {
      for (const text of good) {
        await page.fill(`[data-test=field-${field}]`, text);
        assert.equal(await wrong(field), false, `${field} ${text}`);
      }
      for (const text of bad) {
        await page.fill(`[data-test=field-${field}]`, text);
        assert.equal(await wrong(field), true, `${field} ${text}`);
        assert.ok(await page.locator('[data-test=send]').isDisabled());
      }
      await page.fill(`[data-test=field-${field}]`, good[0]);
    }
    assert.ok(await page.locator('[data-test=send]').isEnabled());
  });

  it('shows octets and the refusal before sending, and the verdict after', async () => {
    await holds(page, () => /^[0-9A-F]{2} /.test(document.querySelector('[data-test=octets]').textContent));
    await page.waitForSelector('[data-test=permission].no');
    assert.equal(await page.textContent('[data-test=send].refused'), 'Send MOVE_TO all the same');
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].failed');
    assert.match(await page.textContent('[data-test=verdict]'), /setpoint owned by a link/);
    assert.match(await page.textContent('[data-test=history]'), /MANIPULATOR MOVE_TO/);
  });

  it('sends SAFE ALL when held, and not when only touched', async () => {
    await page.click('[data-test=safe-all]');
    assert.doesNotMatch(await page.textContent('[data-test=history]'), /SAFE_ALL/);
    const box = await page.locator('[data-test=safe-all]').boundingBox();
    await page.mouse.move(box.x + 20, box.y + 15);
    await page.mouse.down();
    await holds(page, () => document.querySelector('[data-test=history]').textContent.includes('SAFE_ALL'));
    await page.mouse.up();
  });

  it('offers the legal next states only', async () => {
    await go(page, 'subsystems/MANIPULATOR');
    const legal = {'Operational': ['Safe-Operational', 'Error-Operational'], 'Pre-Operational': ['Safe-Operational', 'Error-Operational', 'Post-Operational', 'Offline'],
      'Safe-Operational': ['Operational', 'Error-Operational', 'Post-Operational', 'Offline']};
    // Both at once, as the flight goes on; of the states those that the table has.
    const shown = await holds(page, (states) => {
      const state = document.querySelector('.diagram .here text')?.textContent.trim();
      return states.includes(state) ? {state, open: [...document.querySelectorAll('.diagram .open text')].map((one) => one.textContent)} : null;
    }, Object.keys(legal));
    const {state, open} = await shown.jsonValue();
    assert.deepEqual(open.sort(), legal[state].sort());
  });

  it('plots one parameter by one click on its name', async () => {
    await go(page, 'subsystems/MANIPULATOR');
    const clicks = await count_clicks(page);
    await page.click('[data-test=values] a:has-text("CUR_VALUES.POSITION[1]")');
    await holds(page, () => document.querySelectorAll('main.plots [data-test=plot]').length === 1);
    assert.equal(await clicks(), 1);
    assert.match(await page.textContent('[data-test=legend]'), /CUR_VALUES.POSITION\[1\]/);
  });

  it('follows the keys', async () => {
    await page.keyboard.press('Escape');
    await page.locator('main').click({position: {x: 2, y: 2}});
    for (const [keys, view] of [[['g', 'l'], 'links'], [['c'], 'commands'], [['?'], 'help']]) {
      await page.evaluate(() => document.activeElement?.blur());
      for (const key of keys) await page.keyboard.press(key);
      await holds(page, (to) => location.hash.startsWith(`#/${to}`), view);
    }
    await page.evaluate(() => document.activeElement?.blur());
    await go(page, 'events');
    await page.waitForSelector('[data-search]');
    await page.keyboard.press('/');
    assert.equal(await page.evaluate(() => document.activeElement.matches('[data-search]')), true);
    await page.keyboard.press('Escape');
  });

  it('replays in the same views, framed, with telecommands locked, and comes back', async () => {
    await go(page, 'timeline');
    await page.click('[data-test=replay-30]');
    await page.waitForSelector('[data-test=replay-bar]');
    assert.equal(await page.evaluate(() => document.body.classList.contains('replaying')), true);
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    await page.waitForSelector('[data-test=command-form]');
    assert.ok(await page.locator('[data-test=send]').isDisabled());
    await page.click('[data-test=live]');
    await page.waitForSelector('[data-test=replay-bar]', {state: 'detached'});
    await page.waitForSelector('[data-test=link].good');
  });

  it('tells the values under the mouse, and what lies between two cursors', async () => {
    await go(page, 'plots?p=MANIPULATOR.CUR_VALUES.POSITION%5B0%5D&w=30');
    await page.click('[data-test=pause]');
    const over = page.locator('.u-over');
    await holds(page, () => document.querySelector('.legend .statistics'));
    const box = await over.boundingBox();
    const told = () => page.evaluate(() => Number(/(−?[\d.]+)/.exec(document.querySelector('.legend .at b').textContent)[1].replace('−', '-')));
    const values = [];
    for (const part of [0.35, 0.6]) {
      await page.mouse.move(box.x + part * box.width, box.y + box.height / 2);
      await page.waitForSelector('.legend .at');
      await page.mouse.down();
      await page.mouse.up();
      values.push(await told());
    }
    await page.waitForSelector('[data-test=delta]');
    const apart = Number((await page.textContent('[data-test=delta]')).replace('Δ ', '').replace('−', '-'));
    assert.ok(Math.abs(apart - (values[1] - values[0])) < 0.0021, `${apart}, of ${values}`);
    assert.match(await page.textContent('[data-test=cursors]'), /, 7\.\d{3} s/);
    await page.mouse.dblclick(box.x + box.width / 2, box.y + box.height / 2);
  });

  it('zooms the heights of a plot by the wheel, and shows all of them again', async () => {
    const axis = () => page.evaluate(() => document.querySelector('.legend .statistics') && document.querySelector('.plot .uplot') !== null);
    await holds(page, () => document.querySelector('.u-over'));
    assert.ok(await axis());
    const picture = () => page.locator('.plot canvas').first().evaluate((node) => node.toDataURL().length);
    const before = await picture(), box = await page.locator('.u-over').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    for (let i = 0; i < 6; ++i) await page.mouse.wheel(0, -100);
    await until('another picture', async () => await picture() !== before);
    await page.mouse.dblclick(box.x + box.width / 2, box.y + box.height / 2);
    await page.click('[data-test=pause]');
  });

  it('plots an expression, written with clicked names, beside the same of another flight, and says what is wrong with one', async () => {
    await page.click('[data-test=expression-open]');
    await page.fill('[data-test=expression]', '2 * MANIPULATOR.DES_POSITON[0]');
    await page.keyboard.press('Enter');
    assert.match(await page.textContent('[data-test=expression-wrong]'), /did you mean MANIPULATOR\.DES_POSITION\[0\]\?, at character 5/);
    await page.fill('[data-test=expression]', '2 * ');
    await page.click('.plots .group button:has-text("DES_POSITION[0]")');
    await holds(page, () => document.querySelector('[data-test=expression]').value === '2 * MANIPULATOR.DES_POSITION[0]');
    await page.selectOption('[data-test=compare]', {index: 1});
    await page.click('[data-test=expression-plot]');
    const told = () => page.evaluate(() => [...document.querySelectorAll('[data-test=legend] > span')].map((one) => [one.title, Number(one.querySelector('b').textContent.replace('−', '-')), one.querySelector('.statistics')?.textContent]));
    await until('three curves with samples', async () => { const all = await told(); return all.length === 3 && all.every(([, value, between]) => Number.isFinite(value) && between); });
    assert.deepEqual((await told()).map(([name]) => name), ['MANIPULATOR.CUR_VALUES.POSITION[0]', 'MANIPULATOR.CUR_VALUES.POSITION[0]@1', '=2 * MANIPULATOR.DES_POSITION[0]']);
    await page.selectOption('[data-test=compare]', '');
  });

  it('shows what has names for its values as words, not as heights', async () => {
    await go(page, 'plots?p=MANIPULATOR.PHASE&w=60');
    await holds(page, () => /REST/.test(document.querySelector('[data-test=state-lanes]')?.textContent));
    assert.equal(await page.locator('.u-over').count(), 0);
  });

  it('goes from minutes to milliseconds by the wheel on the timeline, and back to now', async () => {
    await go(page, 'timeline');
    const lanes = await page.locator('[data-test=timeline] svg').boundingBox();
    await page.mouse.move(lanes.x + lanes.width * 0.6, lanes.y + 30);
    const span = () => page.textContent('[data-test=span]');
    // Once by the mouse; then as the mouse would, without a picture for each of a hundred steps.
    const turn = (deltaY, wanted) => page.evaluate(async ([step, end]) => {
      const svg = document.querySelector('[data-test=timeline] svg'), box = svg.getBoundingClientRect();
      for (let i = 0; i < 400 && document.querySelector('[data-test=span]').textContent !== end; ++i) {
        svg.dispatchEvent(new WheelEvent('wheel', {deltaY: step, clientX: box.left + box.width * 0.6, clientY: box.top + 30, bubbles: true, cancelable: true}));
        await new Promise((resolve) => setTimeout(resolve, 5));
      }
    }, [deltaY, wanted]);
    const first = await span();
    await page.mouse.wheel(0, -100);
    await until('nearer', async () => await span() !== first);
    await turn(-100, '1 ms');
    assert.equal(await span(), '1 ms');
    await holds(page, () => [...document.querySelectorAll('[data-test=timeline] .tick text')].some((node) => /\.\d{4}$/.test(node.textContent)));
    await turn(100, '24 h');
    assert.equal(await span(), '24 h');
    if (await page.locator('[data-test=follow]').count()) await page.click('[data-test=follow]');
  });

  it('goes to the moment of an address', async () => {
    const at = await page.evaluate(async () => {
      const answer = await fetch('/api/status', {headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}});
      return (await answer.json()).t - 20;
    });
    await page.evaluate((t) => { location.hash = `#/overview?at=${t.toFixed(3)}`; }, at);
    await page.waitForSelector('[data-test=replay-bar]');
    await page.click('[data-test=live]');
    await page.waitForSelector('[data-test=replay-bar]', {state: 'detached'});
  });

  it('writes a telecommand for the terminal and for Python, and keeps it at hand', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    for (const [field, text] of Object.entries({Q1: '-1.5', Q2: '0.5', STEPS: '3'})) await page.fill(`[data-test=field-${field}]`, text);
    assert.equal(await page.getAttribute('[data-test=copy-tc]', 'title'), 'hirosco tc MANIPULATOR MOVE_TO Q1=-1.5 Q2=0.5 STEPS=3');
    assert.equal(await page.getAttribute('[data-test=copy-python]', 'title'), 'craft.manipulator.move_to(q1=-1.5, q2=0.5, steps=3)');
    await page.click('[data-test=favourite]');
    await page.fill('[data-test=field-Q1]', '0');
    await page.click('[data-test=favourites] a');
    await holds(page, () => document.querySelector('[data-test=field-Q1]').value === '-1.5');
    await page.click('[data-test=favourite]');
    await page.waitForSelector('[data-test=favourites]', {state: 'detached'});
  });

  it('sends a stack row by row, ends at the row that is refused, and writes it for the terminal', async () => {
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    for (const [field, text] of Object.entries({Q1: '-1', Q2: '0.5', STEPS: '4'})) await page.fill(`[data-test=field-${field}]`, text);
    await page.click('[data-test=to-stack]');
    await go(page, 'commands/MANIPULATOR/HOLD');
    await page.click('[data-test=to-stack]');
    await page.click('[data-test=to-stack]');
    await page.click('[aria-label="row 1 down"]');
    await page.fill('[data-test=stack-name]', 'two holds');
    await page.click('[data-test=stack-keep]');
    await page.click('[data-test=stack-run]');
    await holds(page, () => document.querySelectorAll('[data-test=stack-verdict]').length === 2 && document.querySelector('[data-test=stack-run]').textContent === 'Go on from row 2');
    assert.deepEqual(await page.locator('[data-test=stack-verdict]').allTextContents(), ['completed', 'failed: setpoint owned by a link (code 15)']);
    await page.click('[data-test=stack-as-text]');
    const script = await page.inputValue('[data-test=stack-text]');
    assert.deepEqual(script.split('\n').slice(2), ['set -e', 'hirosco tc MANIPULATOR HOLD', 'hirosco tc MANIPULATOR MOVE_TO Q1=-1 Q2=0.5 STEPS=4', 'hirosco tc MANIPULATOR HOLD', '']);
    await page.fill('[data-test=stack-text]', script.replace('STEPS=4', 'STEPS=-4'));
    await page.click('[data-test=stack-take]');
    assert.match(await page.textContent('[data-test=stack-problem]'), /telecommand 2, MOVE_TO: STEPS: outside/);
    await page.fill('[data-test=stack-text]', 'hirosco tc joystick set_state Pre-Operational');
    await page.click('[data-test=stack-take]');
    await holds(page, () => document.querySelector('[data-test=stack-row] .words')?.textContent === 'STATE Pre-Operational');
    await page.selectOption('[data-test=stack-open]', 'two holds');
    await holds(page, () => document.querySelectorAll('[data-test=stack-row]').length === 3);
    await page.click('[data-test=stack-empty]');
  });

  it('calls values by their names in the history, and puts them back into the form', async () => {
    await go(page, 'commands/JOYSTICK/CONFIGURE');
    await page.click('[data-test=send]');
    const sent = page.locator('[data-test=history] > li', {hasText: 'JOYSTICK CONFIGURE'});
    await until('its name', async () => /CONFIGURATION STANDALONE/.test(await sent.first().textContent()));
    await page.selectOption('[data-test=field-CONFIGURATION]', {index: 1});
    await sent.first().locator('button', {hasText: 'edit'}).click();
    await holds(page, () => document.querySelector('[data-test=field-CONFIGURATION]').value === '1');
  });

  it('wants a second click where the descriptor does', async () => {
    await go(page, 'commands/SUPERVISOR/SHUTDOWN');
    const sent = () => page.locator('[data-test=history] b', {hasText: 'SUPERVISOR SHUTDOWN'}).count();
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=send].sure');
    assert.equal(await sent(), 0);
    await page.click('[data-test=send]');
    await until('sent', async () => await sent() === 1);
  });

  it('acknowledges an alarm for everybody, with a note, and over a reload', async () => {
    const calling = (where) => where.textContent('[data-test=alarms-high] b');
    await go(page, 'events');
    await page.waitForSelector('[data-test=alarm-LOST].calls');
    const {page: other} = await open_page(browser.context, at_view(served.url, 'events'), small);
    await until('the other page is called', async () => await calling(other) === '1');
    await page.fill('[data-test=alarm-note]', 'the cable');
    await page.click('[data-test=acknowledge]');
    await until('the other page is told', async () => await calling(other) === '0');
    assert.match(await other.textContent('[data-test=alarm-LOST]'), /acknowledged by operator at [\d:]+: the cable/);
    await other.reload();
    await other.waitForSelector('[data-test=alarm-LOST]:not(.calls)');
    await other.close();
  });

  it('keeps SAFE ALL in sight in every window, and Send beside the robot', async () => {
    await go(page, 'overview');
    await page.waitForSelector('[data-test=send]');
    for (const [width, height] of sizes) {
      await page.setViewportSize({width, height});
      await holds(page, (wanted) => innerWidth === wanted, width);
      assert.ok(await is_in_sight(page, '[data-test=safe-all]'), `SAFE ALL at ${width}x${height}`);
      // In a window of one column the form stands below the picture.
      if (width > 900) assert.ok(await is_in_sight(page, '[data-test=send]'), `Send at ${width}x${height}`);
    }
    await page.setViewportSize(small);
  });

  it('has no serious finding of axe-core in any view', async () => {
    assert.deepEqual(await serious_findings(page, {contrast: false}), []);
  });
});

describe('a flight that does not', () => {
  let served, page, faults;
  before(async () => {
    served = await serve('hostile');
    ({page, faults} = await open_page(browser.context, `${served.url}&tour`, small));
    await page.waitForSelector('[data-test=subsystem-MANIPULATOR]');
  });
  after(() => served.end());

  it('has a general tour and a spacecraft with a module for each subsystem where its mission has no folder, and asks for no file in vain', async () => {
    await page.waitForSelector('[data-test=tour] h3');
    assert.equal(await tour_title(page), 'Look around');
    assert.equal(await page.locator('[data-test=tour] .dots i').count(), 3);
    await go(page, 'overview');
    await page.waitForSelector('[data-test=robot][data-loaded]');
    await holds(page, (count) => [...document.querySelectorAll('.readout .tag b')].filter((one) => one.textContent).length === count, 3);
    await end_tour(page);
    assert.deepEqual(faults, []);
  });

  it('runs no markup of names, texts and values, in any view', async () => {
    for (const view of views) {
      await go(page, view);
      await page.waitForSelector('main .panel');
      // Nothing is pushed out of the window, SAFE ALL least of all.
      const wide = await page.evaluate(() => [document.querySelector('header'), document.querySelector('main'), document.documentElement]
          .filter((node) => node.scrollWidth > node.clientWidth).map((node) => node.tagName));
      assert.deepEqual(wide, [], view);
    }
    // Not by the longest names of a mission in the narrowest window either.
    for (const [width, height] of sizes) {
      await page.setViewportSize({width, height});
      await holds(page, (wanted) => innerWidth === wanted, width);
      assert.ok(await is_in_sight(page, '[data-test=safe-all]'), `SAFE ALL at ${width}x${height}`);
    }
    await page.setViewportSize(small);
    await page.click('[data-test=faults]');
    await holds(page, () => document.querySelector('[data-test=faults-drawer]')?.textContent.includes('<img src=x'));
    await page.keyboard.press('Escape');
    await go(page, 'links');
    await holds(page, () => document.querySelector('svg.links')?.textContent.includes('<img src=x'));
    await go(page, 'events');
    await holds(page, () => document.querySelector('[data-test=events]')?.textContent.includes('<img src=x'));
    assert.ok(await page.evaluate(() => document.querySelector('[data-test=events]').textContent.includes('y'.repeat(1000))));
    await page.click('[data-test=log-search]');
    await holds(page, () => document.querySelector('[data-test=log]')?.textContent.includes('<img src=x'));
    assert.equal(await page.evaluate(() => window.hurt), undefined);
    assert.equal(await page.locator('img[src="x"]').count(), 0);
    assert.deepEqual(faults, []);
  });

  it('still answers after 10,000 events at once', async () => {
    await go(page, 'events');
    await page.fill('[data-search]', 'burst 9999');
    await page.evaluate(() => fetch('/api/faults', {method: 'POST', headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`},
      body: '{"device":"joystick","line":"burst"}'}));
    await holds(page, () => document.querySelector('[data-test=events]')?.textContent.includes('burst 9999'));
    await go(page, 'links');
    await page.waitForSelector('svg.links');
  });

  it('shows NaN and infinity by name', async () => {
    await go(page, 'subsystems/MANIPULATOR');
    await holds(page, () => /NaN/.test(document.querySelector('[data-test=values]')?.textContent));
    assert.match(await page.textContent('[data-test=values]'), /∞/);
  });
});

describe('a page slower than the telemetry', () => {
  it('shows less often, not later and later', async () => {
    const served = await serve('synthetic');
    const page = await browser.context.newPage();
    page.setDefaultTimeout(patience_ms);
    // Twice as long for each batch as the telemetry takes to bring another.
    await page.addInitScript(() => {
      const Real = window.Worker;
      window.batches = 0;
      window.newest_s = -Infinity;
      window.Worker = class extends Real {
        constructor(...words) {
          super(...words);
          this.addEventListener('message', ({data}) => {
            if (data.kind !== 'messages') return;
            ++window.batches;
            for (const one of data.list) if (one.type === 'values') window.newest_s = Math.max(window.newest_s, one.t);
            for (const end_ms = performance.now() + 100; performance.now() < end_ms;);
          });
        }
      };
    });
    await page.goto(at_view(served.url, 'links'));
    // As many would stand there by now if each were kept.
    await holds(page, () => window.batches >= 30);
    const batches = await page.evaluate(async () => {
      const answer = await fetch('/api/status', {headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}});
      const {t} = await answer.json();
      const first = window.batches;
      while (window.newest_s < t) await new Promise((resolve) => setTimeout(resolve));
      return window.batches - first;
    });
    await page.close();
    served.end();
    assert.ok(batches <= 5, `${batches} batches stood before the newest`);
  });
});
