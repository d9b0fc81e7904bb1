// SPDX-License-Identifier: MIT
// A report of `camway replay` is one file that shows requests in 3D, with the paths of both answers.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test, {after} from 'node:test';
import {pathToFileURL} from 'node:url';

import {browser, open_page} from './browser.mjs';
import {count_of, count_of_changes} from './png.mjs';
import {camway, folder, kRoot, not_run, scene_file} from './programs.mjs';

const kMostBytes = 3e6;
const kShift_m = 0.15;
const kNow = 0x0072b2;
const kRecorded = 0xe69f00;
/// Small, as each pixel is drawn by the processor.
const kWindow = {width: 900, height: 600};

/// The office as it is when someone has moved all of it, so that answers in it differ.
const moved = path.join(folder, 'moved.obj');
fs.writeFileSync(moved, fs.readFileSync(scene_file('office'), 'utf8').replace(/^v (\S+)/gm, (_, x) => `v ${Number(x) + kShift_m}`));
const report = path.join(folder, 'report.html');
camway('replay', path.join(kRoot, 'scenes/sessions/office.lcmlog'), '--scene', `office=${moved}`, '--html', report,
       '--pictures', '1', '--fail-on', 'nothing');
if (!fs.readFileSync(report, 'utf8').includes('data-review')) not_run('camway was built without its page');

after(() => browser.close());

test('a report shows a request that differs with both paths', async () => {
  const bytes = fs.statSync(report).size;
  console.log(`# the report has ${bytes} bytes`);
  assert.ok(bytes < kMostBytes);
  const page = await open_page(pathToFileURL(report).href, {window: kWindow});
  const rows = page.tab.locator('tbody tr');
  assert.equal(await rows.count(), 6);
  await page.tab.locator('th', {hasText: 'distance (m)'}).click();
  await page.tab.locator('th', {hasText: 'distance (m)'}).click();
  const column = await page.tab.locator('thead th').evaluateAll(heads => heads.findIndex(head => head.textContent.includes('distance (m)')));
  const distances = await rows.evaluateAll((rows, column) => rows.map(row => Number.parseFloat(row.cells[column].textContent)), column);
  assert.ok(distances[0] > 0 && distances.every(distance => !(distance > distances[0])), `the farthest path is the first row: ${distances}`);
  const farthest = await rows.first().locator('td').first().innerText();

  await rows.first().getByRole('button', {name: '3D'}).click();
  const review = await page.review();
  await review.ready();
  await review.shows('ok');
  const {answer, compared} = await review.state();
  assert.deepEqual([compared.name, compared.otherName], ['now', 'recorded']);
  assert.notDeepEqual(answer.segments, compared.other.segments);
  const legend = await review.tab.locator('.legend').innerText();
  assert.match(legend, /now\s+recorded/);
  // The tools above the scene have these colours, too.
  await review.tab.evaluate(() => {
    for (const tool of document.querySelectorAll('#viewport > [data-part]')) tool.style.visibility = 'hidden';
  });
  const both = await review.view();
  assert.ok(count_of(both, kNow) > 100, 'the path now is not drawn');
  assert.ok(count_of(both, kRecorded) > 20, 'the recorded path is not drawn');

  await review.tab.locator('.answers button', {hasText: 'recorded'}).click();
  assert.deepEqual((await review.state()).answer, compared.other);
  const exchanged = await review.view();
  assert.ok(count_of(exchanged, kNow) > 100 && count_of(exchanged, kRecorded) > 20, 'the paths are not exchanged');
  assert.ok(count_of_changes(both, exchanged) > 100);

  await page.button('Next').click();
  const next = await page.review();
  await next.until(({state}) => state.connection === 'review');
  assert.notDeepEqual((await next.state()).request, review_request(report, farthest));
  await page.button('Close').click();
  await page.tab.locator('iframe').waitFor({state: 'detached'});
  await page.close();
});

test('without WebGL 2 a report says so and has its floor plans', async () => {
  const page = await open_page(pathToFileURL(report).href, {without_webgl: true});
  assert.ok(await page.tab.locator('#no-webgl').isVisible());
  assert.ok(await page.tab.getByRole('button', {name: '3D'}).first().isDisabled());
  assert.ok(await page.tab.locator('figure img').evaluate(image => image.complete && image.naturalWidth > 100));
  await page.close();
});

/// The request of a review, as the file has it.
function review_request(file, number) {
  const [, text] = new RegExp(`id="review-${number}">([^<]*)<`).exec(fs.readFileSync(file, 'utf8'));
  return JSON.parse(text).request;
}
