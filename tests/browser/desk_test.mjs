// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// HIROSCO_PAGE_SERVER=… HIROSCO_PAGE=… node --test desk_test.mjs: what somebody at a desk with this page looks up, writes down and shares, against a made-up flight.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {after, before, describe, it} from 'node:test';
import {at_view, go, holds, open_browser, open_page, small, until} from './browser.mjs';

const [server_file, page_folder] = [process.env.HIROSCO_PAGE_SERVER, process.env.HIROSCO_PAGE];

async function serve(recording) {
  const process_of = spawn('node', [server_file, recording, page_folder, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
  const url = await new Promise((resolve) => process_of.stdout.once('data', (data) => resolve(String(data).trim())));
  return {url, end: () => process_of.kill()};
}

let browser, served;
before(async () => {
  browser = await open_browser({calm: true});
  served = await serve('synthetic:well');
});
after(async () => {
  served.end();
  await browser.close();
});

describe('the head of the page', () => {
  it('has the time on board as TAI, as UTC and since the flight began, and tells how late answers come', async () => {
    const {page, faults} = await open_page(browser.context, at_view(served.url, 'commands/MANIPULATOR/MOVE_TO'), small);
    const clock = () => page.evaluate(() => [document.querySelector('[data-test=clock] b').textContent, document.querySelector('[data-test=clock] .scale').textContent]);
    const seconds = (text) => text.split(':').reduce((sum, part) => 60 * sum + Number(part), 0);
    await holds(page, () => /, T\+ \d/.test(document.querySelector('[data-test=clock]').title));
    const told = {};
    for (let i = 0; i < 3; ++i) {
      const [text, scale] = await clock();
      told[scale] = seconds(text);
      await page.click('[data-test=clock]');
    }
    assert.deepEqual(Object.keys(told), ['TAI', 'UTC', 'T+']);
    const day_s = 86400, apart_s = (told.TAI - told.UTC + day_s) % day_s;
    assert.ok(apart_s > 34 && apart_s < 38, `UTC is ${apart_s} s behind`);
    assert.ok(told['T+'] > 0 && told['T+'] < 3600, `${told['T+']} s since the flight began`);
    assert.equal((await clock())[1], 'TAI');
    await holds(page, () => /last answer after \d+ ms/.test(document.querySelector('[data-test=link]').title));
    // Without a link the station answers by itself: that is no answer of the spacecraft.
    const alone = await browser.context.newPage();
    await alone.route('**/api/commands/preview', (route) => route.fulfill({json: {octets: '', permitted: null, code: null, reason: 'no link to the spacecraft'}}));
    await alone.goto(at_view(served.url, 'commands/MANIPULATOR/HOLD'));
    await holds(alone, () => /no link to the spacecraft/.test(document.body.textContent));
    assert.doesNotMatch(await alone.getAttribute('[data-test=link]', 'title'), /last answer/);
    await alone.close();
    assert.deepEqual(faults, []);
    await page.close();
  });

  it('tells that the station was replaced by one of another version, and loads the page again', async () => {
    const renewed = await serve('synthetic:renewed'), {page, faults} = await open_page(browser.context, at_view(renewed.url, 'overview'), small);
    await holds(page, () => /another version than this page.*renewed, this page of development/s.test(document.querySelector('[data-test=state-line]')?.textContent ?? ''));
    await page.click('[data-test=load-again]');
    await holds(page, () => document.querySelector('[data-test=state-head]') && !document.querySelector('[data-test=load-again]'));
    assert.deepEqual(faults.filter((one) => !/WebSocket/.test(one)), []);
    await page.close();
    renewed.end();
  });
});

describe('links', () => {
  it('show how long samples take beside their cycle, and how many came late', async () => {
    const {page, faults} = await open_page(browser.context, at_view(served.url, 'links'), small);
    await page.waitForSelector('[data-test=bars-1] svg');
    const bars = await page.locator('[data-test=bars-1] rect').evaluateAll((all) => all.map((one) => ({height: Number(one.getAttribute('height')), late: one.classList.contains('late'), words: one.textContent})));
    assert.deepEqual(bars.map((one) => one.late), new Array(9).fill(false), 'the limit was kept');
    assert.ok(bars[5].height > bars[4].height && bars[4].height > bars[2].height && bars[2].height > 0 && bars[0].height === 0, JSON.stringify(bars));
    assert.match(bars[6].words, /within 500 µs \(1 of a period\)/);
    assert.equal(await page.textContent('[data-test=p99-1]'), '500 µs');
    assert.match(await page.textContent('[data-test=bars-1]'), /half ≤ 250 µs.*max 1\.2 ms.*later than two cycles, 1\.0 ms; none beyond the limit/s);
    assert.match(await page.getAttribute('[data-test=bars-1] svg', 'aria-label'), /^\d+ samples, half of them within 250 µs, 99 % within 500 µs, longest 1\.2 ms, \d+ later than 1\.0 ms$/);
    assert.deepEqual(faults, []);
    await page.close();
  });
});

describe('the log', () => {
  let page, faults;
  before(async () => {
    ({page, faults} = await open_page(browser.context, at_view(served.url, 'events'), small));
    await page.waitForSelector('[data-test=log]');
  });
  after(() => page.close());

  const newest = () => page.textContent('[data-test=log] tr .words');
  const note = (text) => page.evaluate(async (words) => {
    const answer = await fetch('/api/faults', {method: 'POST', headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}, body: JSON.stringify({device: 'joystick', line: `tell ${words}`})});
    if (!answer.ok) throw new Error(await answer.text());
  }, text);
  const hint = () => page.textContent('.panel[aria-label=Log] > h2 small');

  it('goes on by itself while its top is in sight', async () => {
    await note('first of all');
    await holds(page, () => /first of all/.test(document.querySelector('[data-test=log] tr .words').textContent));
    const lines = await page.locator('[data-test=log] tr').count();
    await note('second');
    await holds(page, () => /second/.test(document.querySelector('[data-test=log] tr .words').textContent));
    assert.equal(await page.locator('[data-test=log] tr').count(), lines + 1, 'each packet once');
    assert.match(await hint(), /^goes on, \d+ lines/);
  });

  it('stands still for who reads further down, says so, and goes on with what came meanwhile', async () => {
    await page.evaluate(() => { document.querySelector('.panel[aria-label=Log] > .body').scrollTop = 200; });
    await page.waitForSelector('[data-test=log-newest]');
    assert.match(await hint(), /^stands still/);
    const before = await newest();
    await note('third');
    await new Promise((resolve) => setTimeout(resolve, 5000));
    assert.equal(await newest(), before);
    await page.click('[data-test=log-newest]');
    await holds(page, () => /third/.test(document.querySelector('[data-test=log] tr .words').textContent));
    await page.waitForSelector('[data-test=log-newest]', {state: 'detached'});
  });

  it('goes on with what was sought, not with what is being typed', async () => {
    await page.fill('[data-test=log-text]', 'joystick');
    await page.press('[data-test=log-text]', 'Enter');
    await holds(page, () => [...document.querySelectorAll('[data-test=log] tr .words')].every((one) => /joystick/i.test(one.textContent)));
    await page.fill('[data-test=log-text]', 'nothing has this');
    await note('fourth');
    await holds(page, () => /fourth/.test(document.querySelector('[data-test=log] tr .words').textContent));
    assert.ok(await page.locator('[data-test=log] tr').count() > 1);
    assert.deepEqual(faults, []);
  });

  it('says that it does not go on when the station does not answer', async () => {
    await page.route('**/api/log*', (route) => route.abort());
    await page.waitForSelector('[data-test=log-problem]');
    assert.match(await page.textContent('[data-test=log-problem]'), /^The log does not go on: the gateway does not answer/);
    assert.match(await hint(), /^does not go on/);
    await page.unroute('**/api/log*');
    await page.waitForSelector('[data-test=log-problem]', {state: 'detached'});
  });
});

describe('plots', () => {
  const name = 'MANIPULATOR.CUR_VALUES.POSITION[0]', view = (window) => `plots?p=${encodeURIComponent(name)}|MANIPULATOR.CUR_VALUES.POSITION%5B1%5D&w=${window}`;
  let page, faults;
  before(async () => {
    ({page, faults} = await open_page(browser.context, at_view(served.url, view(10)), small));
    await holds(page, () => document.querySelectorAll('.legend .statistics').length === 2);
  });
  after(() => page.close());

  const seconds = (text) => text.split(':').reduce((sum, part) => 60 * sum + Number(part), 0);
  const legend = () => page.textContent('.legend b');
  const asked = (path) => page.evaluate(async (of) => (await fetch(of, {headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}})).json(), path);
  const at = async (place, across, down) => {
    const box = await page.locator('.u-over').nth(place).boundingBox();
    return [box.x + across * box.width, box.y + down * box.height];
  };
  const drag = async (place, from, to) => {
    await page.mouse.move(...await at(place, ...from));
    await page.mouse.down();
    await page.mouse.move(...await at(place, ...to), {steps: 5});
    await page.mouse.up();
  };
  const zoomed = async () => (await page.textContent('.plots .toolbar > small')).split(' … ').map(seconds);

  /// [[t, value of the first curve]] as the first plot saves them.
  const samples = async () => {
    const [file] = await Promise.all([page.waitForEvent('download'), page.locator('.plots .chip', {hasText: /^CSV$/}).first().click()]);
    return readFileSync(await file.path(), 'utf8').trim().split('\n').slice(1).map((line) => line.split(',')).map(([t, , value]) => [Number(t), Number(value)]);
  };

  it('zoom to what was aimed at while they run: the axis stands still under a button that is down', async () => {
    const cursor = async () => seconds(/^[\d:.]+/.exec(await page.textContent('[data-test=cursors]'))[0]);
    await page.mouse.move(...await at(0, 0.5, 0.5));
    await page.mouse.move(...await at(0, 0.7, 0.5));
    await page.waitForSelector('[data-test=cursors]');
    await page.mouse.down();
    const aimed = await cursor();
    await page.mouse.move(...await at(0, 0.8, 0.5));
    await new Promise((resolve) => setTimeout(resolve, 4000));
    await page.mouse.move(...await at(0, 0.9, 0.5), {steps: 3});
    await page.mouse.up();
    const [from, to] = await zoomed();
    assert.ok(Math.abs(from - aimed) < 1, `from ${from}, aimed at ${aimed}`);
    assert.ok(Math.abs(to - from - 2) < 0.1, `${to - from} s, of 10 s a fifth`);
    await page.mouse.dblclick(...await at(1, 0.5, 0.5));
    await page.waitForSelector('.plots .toolbar > small', {state: 'detached'});
  });

  it('tell no value of after what they show, zoomed or paused', async () => {
    await drag(0, [0.2, 0.5], [0.6, 0.5]);
    const [, to] = await zoomed();
    await page.mouse.move(5, 300);
    await holds(page, () => !document.querySelector('.legend .at'));
    assert.ok(Math.abs(seconds((await page.getAttribute('.legend b', 'title')).replace('at ', '')) - to) < 0.002);
    const told = await legend();
    for (let now = told; now === told; await new Promise((resolve) => setTimeout(resolve, 500))) now = (await asked('/api/status')).values[name].v.toFixed(3).replace('-', '−');
    assert.equal(await legend(), told);
    await page.mouse.dblclick(...await at(0, 0.5, 0.5));
    await page.mouse.move(5, 300);
    await holds(page, (before) => document.querySelector('.legend b').textContent !== before, told);
  });

  it('tell when the least and the most was, and put the cursor there by a click', async () => {
    await page.click('[data-test=pause]');
    for (const what of ['least', 'most']) {
      const words = await page.textContent(`[data-test=${what}]`), when = /at ([\d:.]+):/.exec(await page.getAttribute(`[data-test=${what}]`, 'title'))[1];
      assert.ok(words.endsWith(`at ${when.slice(0, -2)}`), `${words}, ${when}`);
      await page.locator(`[data-test=${what}]`).first().click();
      await holds(page, (t) => document.querySelector('[data-test=cursors]')?.textContent.includes(`from ${t}`), when);
      await page.waitForSelector('.legend .at');
      const value = words.split(' at ')[0].trim(), sample = (await samples()).find(([t]) => Math.abs(t % 86400 - seconds(when)) < 0.002);
      assert.equal(await legend(), value);
      assert.equal(sample?.[1].toFixed(3).replace('-', '−'), value, `the sample at ${when}`);
    }
    const [least, most] = await Promise.all(['least', 'most'].map((what) => page.textContent(`[data-test=${what}]`)));
    assert.notEqual(least, most);
  });

  it('show what they did before by a double click in whichever of them, after zooms of any of them', async () => {
    await page.click('[aria-label="take the cursors away"]');
    const pictures = () => page.evaluate(() => [...document.querySelectorAll('.plot canvas')].map((one) => one.toDataURL()));
    await page.mouse.move(5, 300);
    await page.waitForSelector('[data-test=cursors]', {state: 'detached'});
    const first = await pictures();
    await drag(0, [0.5, 0.2], [0.503, 0.6]);
    await drag(1, [0.3, 0.5], [0.7, 0.5]);
    await drag(1, [0.3, 0.5], [0.7, 0.5]);
    await page.waitForSelector('.plots .toolbar > small');
    await holds(page, (before) => [...document.querySelectorAll('.plot canvas')].every((one, i) => one.toDataURL() !== before[i]), first);
    await page.mouse.dblclick(...await at(1, 0.5, 0.5));
    await page.waitForSelector('.plots .toolbar > small', {state: 'detached'});
    await holds(page, (before) => [...document.querySelectorAll('.plot canvas')].every((one, i) => one.toDataURL() === before[i]), first);
    assert.equal(await page.textContent('[data-test=pause]').then((text) => text.trim()), 'paused');
    await page.click('[data-test=pause]');
  });

  it('show the force at the tip as the one number that stands at its arrow', async () => {
    await go(page, 'plots?p=SUPERVISOR.MODE&w=60');
    await page.click('[data-test=pictured] button:has-text("force at the tip")', {modifiers: ['Shift']});
    const told = () => page.evaluate(() => [...document.querySelectorAll('[data-test=legend] > span')].map((one) => [one.title, one.textContent, one.querySelector('[data-test=most]')?.textContent]).at(-1));
    // The flight pushes with up to 30 N.
    await until('its greatest', async () => /^30\.0 at/.test((await told())[2] ?? ''));
    const [name, words] = await told();
    assert.equal(name, '=hypot(MANIPULATOR.TIP_FORCE[0], MANIPULATOR.TIP_FORCE[1])');
    assert.match(words, /^MANIPULATOR force at the tip [\d.]+ N/);
  });

  it('show the whole flight, also from an address', async () => {
    await page.click('.plots .toolbar .chip:has-text("whole flight")');
    await holds(page, () => location.hash.endsWith('&w=flight'));
    const {flights: [{from}]} = await asked('/api/flights');
    for (const reload of [false, true]) {
      if (reload) await page.reload();
      await holds(page, () => document.querySelector('.plots .chip.on')?.textContent === 'whole flight' && document.querySelector('.legend .statistics'));
      let began;
      for (let i = 0; i < 40 && !(began - from < 1.5); ++i, await new Promise((resolve) => setTimeout(resolve, 250))) [[began]] = await samples();
      assert.ok(began - from < 1.5 && began >= from, `${began - from} s after the flight began`);
    }
    assert.deepEqual(faults, []);
  });
});

describe('two pages at one station', () => {
  let anna, ben;
  before(async () => {
    anna = await open_page(browser.context, at_view(served.url, 'timeline'), small);
    ben = await open_page(browser.context, at_view(served.url, 'commands/MANIPULATOR/HOLD'), small);
    await ben.page.waitForSelector('[data-test=send]');
  });
  after(async () => {
    await anna.page.close();
    await ben.page.close();
  });

  it('know of each other, by name once that is typed, and who commands', async () => {
    await holds(anna.page, () => document.querySelector('[data-test=others-count]')?.textContent === '+1');
    await anna.page.click('[data-test=commander]');
    await holds(anna.page, () => document.querySelector('[data-test=others]')?.textContent.includes('without a name'));
    await ben.page.click('[data-test=commander]');
    await ben.page.fill('[data-test=commander-menu] input', '<b>ben</b>');
    await holds(anna.page, () => document.querySelector('[data-test=others] li b')?.textContent === '<b>ben</b>');
    assert.doesNotMatch(await anna.page.textContent('[data-test=others]'), /may command.*commands|looks at the past/s);
    await ben.page.click('[data-test=command-take]');
    await holds(anna.page, () => /^<b>ben<\/b>\s*commands$/.test(document.querySelector('[data-test=others] li')?.textContent.trim()));
    const third = await open_page(browser.context, at_view(served.url, 'help'), small);
    await holds(anna.page, () => document.querySelector('[data-test=others-count]')?.textContent === '+2');
    await third.page.close();
    await holds(anna.page, () => document.querySelector('[data-test=others-count]')?.textContent === '+1');
    await anna.page.keyboard.press('Escape');
  });

  it('share the notes of a flight: as text, the newest in the list, earlier ones by a click, after a reload, too', async () => {
    await anna.page.waitForSelector('[data-test=notes-1]');
    assert.match(await anna.page.textContent('[data-test=notes-1]'), /anna.*The rail was touched/s);
    await go(ben.page, 'timeline');
    for (const text of ['<img src=x onerror=alert(1)>', 'second', 'third']) {
      await anna.page.click('[data-test=note-flight-2]');
      assert.ok(await anna.page.locator('form:has([data-test=flight-note]) button').isDisabled(), 'an empty note is none');
      await anna.page.fill('[data-test=flight-note]', text);
      await anna.page.keyboard.press('Enter');
      await anna.page.waitForSelector('[data-test=flight-note]', {state: 'detached'});
    }
    const texts = (page) => page.locator('[data-test=notes-2] li').evaluateAll((all) => all.map((one) => one.textContent.trim()));
    await holds(ben.page, () => document.querySelector('[data-test=notes-2]')?.textContent.includes('third'));
    const [more, second, third] = await texts(ben.page);
    assert.equal(more, '1 earlier');
    assert.match(second, /second$/);
    assert.match(third, /third$/);
    await ben.page.click('[data-test=notes-2] .link');
    assert.match((await texts(ben.page))[1], /<img src=x onerror=alert\(1\)>$/);
    assert.equal(await ben.page.locator('[data-test=notes-2] img').count(), 0);
    await ben.page.reload();
    await holds(ben.page, () => document.querySelector('[data-test=notes-2]')?.textContent.includes('third'));
  });

  it('have the stacks of each other at once', async () => {
    await go(anna.page, 'commands/MANIPULATOR/HOLD');
    await go(ben.page, 'commands/JOYSTICK/PASSIVITY');
    await anna.page.click('[data-test=to-stack]');
    await anna.page.fill('[data-test=stack-name]', 'calm down');
    assert.equal(await ben.page.locator('[data-test=stack-open]').count(), 0);
    await anna.page.click('[data-test=stack-keep]');
    await ben.page.waitForSelector('[data-test=stack-open]');
    await ben.page.selectOption('[data-test=stack-open]', 'calm down');
    await holds(ben.page, () => document.querySelectorAll('[data-test=stack-row]').length === 1);
    assert.match(await ben.page.textContent('[data-test=stack-row]'), /MANIPULATOR HOLD/);
    await ben.page.click('[data-test=stack-forget]');
    await anna.page.waitForSelector('[data-test=stack-open]', {state: 'detached'});
  });

  it('complain of nothing', () => assert.deepEqual([...anna.faults, ...ben.faults], []));
});

describe('the robot in 3D', () => {
  let page, faults;
  before(async () => {
    ({page, faults} = await open_page(browser.context, at_view(served.url, 'overview'), small));
    await page.waitForSelector('[data-test=robot][data-loaded]');
    await holds(page, () => Number(document.querySelector('[data-test=robot]').dataset.frames) > 5);
  });
  after(() => page.close());

  /// Places in the window where the arm is drawn, far apart, from what the picture shows.
  const places_on_arm = () => page.evaluate(() => {
    const canvas = [...document.querySelectorAll('[data-test=robot] canvas.live')].at(-1), box = canvas.getBoundingClientRect(), {data, width, height} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const found = [];
    for (let y = 10; y < height - 10; y += 12) for (let x = 10; x < width - 10; x += 12) {
      const bright = (i) => data[4 * i + 3] === 255 && data[4 * i] > 60 && Math.abs(data[4 * i] - data[4 * i + 2]) < 40;
      const at = y * width + x;
      if ([at, at - 3, at + 3, at - 3 * width, at + 3 * width].every(bright)) found.push([box.left + x, box.top + y]);
    }
    return found.filter(([x, y]) => document.elementFromPoint(x, y)?.closest('[data-test=robot]'));
  });

  it('shows the plots of the joint that moves a part by one click on it, and turns by a drag', async () => {
    const [x, y] = [620, 150];  // the sky
    await page.mouse.click(x, y);
    assert.match(await page.evaluate(() => location.hash), /#\/overview/);
    const shown = new Set();
    for (const part of [0.1, 0.3, 0.5, 0.7, 0.9]) {
      await page.waitForSelector('[data-test=robot][data-loaded]');
      const places = await places_on_arm();
      assert.ok(places.length > 5, `the arm is seen at ${places.length} places`);
      const place = places[Math.floor(part * places.length)];
      await page.mouse.click(...place);
      const hash = decodeURIComponent(await page.evaluate(() => location.hash));
      if (!hash.startsWith('#/plots')) continue;
      const joint = hash.match(/CUR_VALUES\.POSITION\[(\d)\]/)?.[1];
      assert.equal(hash, `#/plots?p=MANIPULATOR.CUR_VALUES.POSITION[${joint}]+MANIPULATOR.DES_POSITION[${joint}]|MANIPULATOR.CUR_VALUES.TORQUE[${joint}]`);
      await holds(page, () => document.querySelectorAll('main.plots [data-test=plot]').length === 2);
      shown.add(joint);
      await page.goBack();
      await holds(page, () => location.hash.startsWith('#/overview'));
      await holds(page, (frames) => Number(document.querySelector('main [data-test=robot]')?.dataset.frames) > frames, await page.evaluate(() => Number(document.querySelector('[data-test=robot]').dataset.frames)));
    }
    assert.ok(shown.size > 0, 'no click on the arm showed a plot');
    const [from] = await places_on_arm();
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(from[0] + 40, from[1], {steps: 4});
    await page.mouse.up();
    assert.match(await page.evaluate(() => location.hash), /#\/overview/, 'a drag is no click');
  });

  it('is seen from where its cube is clicked, or turned by keys, and the cube goes along', async () => {
    const faces = () => page.locator('[data-test=view-cube] .face').evaluateAll((all) => all.filter((one) => one.style.display !== 'none').map((one) => one.querySelector('text').textContent));
    const becomes = (wanted) => holds(page, (names) => [...document.querySelectorAll('[data-test=view-cube] .face')].filter((one) => one.style.display !== 'none').map((one) => one.querySelector('text').textContent).join() === names, wanted);
    assert.ok((await faces()).includes('top'), `${await faces()}`);
    await page.click('[data-test=look-top] polygon');
    await becomes('top');
    await page.focus('[data-test=view-cube]');
    await page.keyboard.press('ArrowDown');
    await becomes('front,top');
    await page.keyboard.press('ArrowRight');
    await becomes('front,right,top');
    assert.match(await page.getAttribute('[data-test=view-cube]', 'aria-label'), /from the (front|right), above/);
    const [x, y] = await page.locator('[data-test=look-front-right] line').evaluate((node) => { const box = node.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; });
    await page.mouse.click(x, y);
    await becomes('front,right');
    await page.keyboard.press('Home');
    await becomes('front,left,top');
  });

  it('cuts no field of the form beside the robot where an answer stands below them', async () => {
    // Somebody else commanded here before.
    await page.evaluate(() => fetch('/api/authority', {method: 'POST', headers: {Authorization: `Bearer ${sessionStorage.getItem('hirosco-token')}`}, body: '{"action":"hand_over"}'}));
    await page.selectOption('[data-test=quick-command]', 'MOVE_TO');
    for (const [field, text] of Object.entries({Q1: '-1', Q2: '1.5', STEPS: '3'})) await page.fill(`.quick [data-test=field-${field}]`, text);
    await page.click('.quick [data-test=send]');
    await page.waitForSelector('.quick [data-test=verdict].failed');
    const hidden = await page.evaluate(() => {
      const foot = document.querySelector('.quick .foot').getBoundingClientRect().top;
      return [...document.querySelectorAll('.quick .field input')].filter((node) => node.getBoundingClientRect().bottom > foot).length;
    });
    assert.equal(hidden, 0);
    assert.ok(await page.evaluate(() => [...document.querySelectorAll('.quick, .quick *')].every((node) => node.scrollTop === 0)));
  });

  it('is saved alone as a picture, with what it is of', async () => {
    await holds(page, () => document.querySelector('[data-test=robot]')?.dataset.still === 'whole');
    const [file] = await Promise.all([page.waitForEvent('download'), page.click('[data-test=scene-picture]')]);
    assert.match(file.suggestedFilename(), /^rokviss-2026-01-01T.*\.png$/i);
    const octets = readFileSync(await file.path());
    assert.equal(octets.toString('latin1', 1, 4), 'PNG');
    const [width, height] = await page.locator('[data-test=robot]').evaluate((node) => [node.clientWidth, node.clientHeight]);
    assert.deepEqual([octets.readUInt32BE(16), octets.readUInt32BE(20)], [width, height + 22]);
    const {lower, words} = await page.evaluate(async (base64) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (one) => one.charCodeAt(0))], {type: 'image/png'}));
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [image.width, image.height];
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const share = (y, tall, least) => context.getImageData(0, y, image.width, tall).data.filter((value, i) => i % 4 === 0 && value > least).length / (image.width * tall);
      return {lower: share(image.height >> 1, image.height / 3 | 0, 40), words: share(image.height - 22, 22, 100)};
    }, octets.toString('base64'));
    assert.ok(lower > 0.3, `${lower} of its lower half is bright`);
    assert.ok(words > 0.005 && words < 0.3, `words below it: ${words}`);
  });

  it('complains of nothing', () => assert.deepEqual(faults, []));
});

describe('borders between panels', () => {
  let page, faults;
  before(async () => {
    ({page, faults} = await open_page(browser.context, at_view(served.url, 'events'), small));
    await page.waitForSelector('[data-test=split-columns-0]');
  });
  after(() => page.close());

  const left = () => page.locator('main > .panel').first().evaluate((node) => Math.round(node.getBoundingClientRect().width));
  const drag = async (border, by_x, by_y) => {
    const box = await page.locator(`[data-test=${border}]`).boundingBox(), at = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(...at);
    await page.mouse.down();
    await page.mouse.move(at[0] + by_x, at[1] + by_y, {steps: 4});
    await page.mouse.up();
  };

  it('are dragged, remembered by the browser, moved by keys, and back at first by a double click', async () => {
    const at_first = await left();
    await drag('split-columns-0', -150, 0);
    assert.ok(Math.abs(await left() - (at_first - 150)) <= 2, `${await left()} after ${at_first}`);
    await page.reload();
    await page.waitForSelector('[data-test=split-columns-0]');
    assert.ok(Math.abs(await left() - (at_first - 150)) <= 2, 'after a reload');
    await page.focus('[data-test=split-columns-0]');
    await page.keyboard.press('ArrowRight');
    assert.ok(Math.abs(await left() - (at_first - 134)) <= 2, 'by a key');
    await drag('split-columns-0', -2000, 0);
    assert.ok(await left() >= 199, 'as small as it may be');
    await page.dblclick('[data-test=split-columns-0]');
    assert.equal(await left(), at_first);
    await page.reload();
    await page.waitForSelector('[data-test=split-columns-0]');
    assert.equal(await left(), at_first, 'nothing is remembered');
  });

  it('are of one view, keep their shares in another window, and are none in a narrow one', async () => {
    const width = () => page.locator('main > .panel[aria-label=Subsystems]').evaluate((node) => node.getBoundingClientRect().width);
    await go(page, 'overview');
    await page.waitForSelector('[data-test=split-columns-1]');
    await drag('split-columns-0', 100, 0);
    await drag('split-rows-0', 0, -40);
    const wide = await width();
    await page.setViewportSize({width: 1440, height: 900});
    await holds(page, (before) => Math.abs(document.querySelector('main > .panel[aria-label=Subsystems]').getBoundingClientRect().width / before - (1440 - 68 - 32) / (1280 - 68 - 32)) < 0.03, wide);
    assert.ok(await page.locator('[data-test=send]').isVisible(), 'Send stays in sight');
    await page.setViewportSize({width: 720, height: 1000});
    await page.waitForSelector('.split', {state: 'detached'});
    await page.setViewportSize(small);
    await page.waitForSelector('[data-test=split-rows-0]');
    await page.dblclick('[data-test=split-columns-0]');
    await page.dblclick('[data-test=split-rows-0]');
    assert.deepEqual(faults, []);
  });
});
