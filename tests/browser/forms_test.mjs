// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Every telecommand form of every mission in this repository, on gateways that have no spacecraft. What several missions have alike is judged in
// the first of them; with HIROSCO_SLICE=whole in each.
import assert from 'node:assert/strict';
import {readdirSync, rmSync} from 'node:fs';
import {after, before, describe, it} from 'node:test';
import {at_view, open_browser, open_page, small} from './browser.mjs';
import {free_port, ground, missions, new_folder} from './flight.mjs';
import {judge_forms, judge_gateway, unseen_of} from './forms.mjs';

const names = readdirSync(missions, {withFileTypes: true}).filter((one) => one.isDirectory()).map((one) => one.name);

const seen = new Set();
let judged_fields = 0;

let browser;
before(async () => { browser = await open_browser({calm: true}); });
after(() => browser?.close());

for (const name of names) {
  describe(`the forms of ${name}`, () => {
    const folder = new_folder();
    let station, mission;
    const ask = (path, body) => fetch(`${station.origin}${path}`, {headers: {Authorization: `Bearer ${station.token}`, 'Content-Type': 'application/json'},
      ...(body ? {method: 'POST', body: JSON.stringify(body)} : {})});
    before(async () => {
      station = await ground(folder, name, await free_port());
      mission = unseen_of(await (await ask('/api/mission')).json(), process.env.HIROSCO_SLICE === 'whole' ? new Set() : seen);
    });
    after(async () => {
      await station?.end();
      rmSync(folder, {recursive: true, force: true});
    });

    it('take the ends of each range and nothing beyond, no text, no NaN', async () => {
      const {page, faults} = await open_page(browser.context, at_view(station.url, 'commands'), small);
      const judged = await judge_forms(page, mission);
      judged_fields += judged.fields;
      assert.deepEqual(judged.wrong, []);
      assert.deepEqual(faults, []);
      await page.close();
    });

    it('judge as the gateway does', async () => {
      const judged = await judge_gateway(mission, async (body) => (await ask('/api/commands/preview', body)).status);
      assert.deepEqual(judged.wrong, []);
    });
  });
}

it('judged forms', () => assert.ok(judged_fields > 0));
