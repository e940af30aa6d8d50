// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The page at a station that is 600 ms away, there and back, on a line that loses 2 % of what it carries: everything goes as from near, later.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';
import {bring_up, coupled, go, holds, is_coupled, open_browser, open_page} from './browser.mjs';
import {far_from} from './far.mjs';
import {fly, free_port, ground} from './flight.mjs';

describe('an operator who is far away', () => {
  let flight, station, far, browser, page, faults;
  before(async () => {
    flight = await fly({more: ['--no-ground'], wait_for: /./});
    station = await ground(flight.folder, 'rokviss', await free_port());
    far = await far_from(station.url, {delay_ms: 300, loss: 0.02});
    browser = await open_browser();
    ({page, faults} = await open_page(browser.context, far.url, {width: 1440, height: 900}));
    await coupled(page);
  });
  after(async () => {
    await browser?.close();
    far?.close();
    await station?.end();
    await flight?.end();
  });

  it('sees the robot move and no link that is called silent, and is told how late answers come', async () => {
    await holds(page, () => /answers after 0\.[6-9] s|answers after [1-3] s/.test(document.querySelector('[data-test=link]').textContent));
    const seen = await page.evaluate(() => new Promise((resolve) => {
      const poses = new Set(), links = new Set(), robot = document.querySelector('[data-test=robot]'), link = document.querySelector('[data-test=link]');
      const timer = setInterval(() => {
        poses.add(robot.dataset.pose);
        links.add(link.className);
      }, 50);
      setTimeout(() => { clearInterval(timer); resolve({poses: poses.size, links: [...links]}); }, 8000);
    }));
    assert.ok(seen.poses > 20, `${seen.poses} poses in 8 s`);
    assert.deepEqual(seen.links, ['pill link good']);
    assert.ok(far.lost() > 0, 'nothing was lost');
  });

  it('goes to another mode by two clicks, and moves the arm through all verdicts', async () => {
    await page.click('[data-test=mode]');
    await page.click('[data-test=mode-menu] .list button:has-text("standalone")');
    await page.click('[data-test=mode-go]:enabled');
    await holds(page, () => document.querySelector('[data-test=mode] b').textContent === 'standalone' && !document.querySelector('[data-test=mode-progress]'));
    await go(page, 'commands/MANIPULATOR/MOVE_TO');
    for (const [field, value] of [['Q1', '-1.5'], ['Q2', '1.4'], ['DURATION', '3']]) await page.fill(`[data-test=field-${field}]`, value);
    await page.waitForSelector('[data-test=permission].yes');
    await page.click('[data-test=send]');
    await page.waitForSelector('[data-test=verdict].completed');
  });

  it('stops everything, and brings it up again', async () => {
    const button = page.locator('[data-test=safe-all]');
    await button.dispatchEvent('pointerdown');
    await holds(page, () => !document.querySelector('[data-test=safe-all]').classList.contains('held'));
    await holds(page, () => document.querySelector('[data-test=stop-banner], [data-test=mode-stopped]'));
    await bring_up(page, 'telepresence');
    await go(page, 'overview');
    await coupled(page);
    assert.ok(await page.evaluate(is_coupled));
    assert.deepEqual(faults, []);
  });
});
