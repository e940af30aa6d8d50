// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// fill_form.mjs URL SUBSYSTEM FUNCTION FIELD=TEXT...: sends one telecommand by its form, and prints what the form asked and what became of
// it. Ends with 0 when it was completed and the page had no fault.
import {at_view, holds, open_browser, open_page, small} from './browser.mjs';

const [url, subsystem, action, ...given] = process.argv.slice(2);
const browser = await open_browser({calm: true});
try {
  const {page, faults} = await open_page(browser.context, at_view(url, `commands/${subsystem}/${action}`), small);
  for (const word of given) {
    const [name, text] = [word.slice(0, word.indexOf('=')), word.slice(word.indexOf('=') + 1)];
    const field = page.locator(`[data-test=field-${name}]`);
    await field.waitFor();
    const kind = await field.evaluate((node) => node.tagName === 'SELECT' ? 'a choice' : node.type === 'checkbox' ? 'a switch' : 'a field');
    if (kind === 'a choice') await field.selectOption(text);
    else if (kind === 'a switch') await field.setChecked(text === '1');
    else await field.fill(text);
    console.log(`${name}: ${kind}`);
  }
  await page.locator('[data-test=send]:not([disabled])').click();
  await holds(page, () => /completed|failed/.test(document.querySelector('[data-test=verdict]')?.className ?? ''));
  const verdict = await page.locator('[data-test=verdict]').getAttribute('class');
  console.log(verdict, faults.join('; '));
  process.exitCode = verdict.includes('completed') && faults.length === 0 ? 0 : 1;
} finally {
  await browser.close();
}
